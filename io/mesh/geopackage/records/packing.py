"""Packing: report, lines, inputs and edits of a TIN as trees of plain values, and arrays."""

from __future__ import annotations

import math
from dataclasses import fields, is_dataclass, replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from .....base.crs import CRS, Unit
from .....tin.building.inputs import BuildInputs
from .....tin.building.options import BuildOptions
from .....tin.constraints.breaklines import Lines
from .....tin.constraints.constraint_set import LineSet
from .....tin.constraints.constraint_table import ConstraintTable
from .....tin.report import Crossings, Edit, Overruled, Report, Simplification, Unmended
from .columns import pack_columns

if TYPE_CHECKING:
    from .....base.arrays import AnyArray, Float64Array
    from .....tin.building.version import Version
    from .....tin.surface import TIN

__all__ = ["CLASSES", "Record", "pack_tin", "take_rows"]

CLASSES: dict[str, Any] = {
    kind.__name__: kind
    for kind in (
        *(BuildInputs, BuildOptions, ConstraintTable, Crossings, Edit, Lines, LineSet),
        *(Overruled, Report, Simplification, Unmended),
    )
}
"""The only classes that are made of trees."""

_NO_ROWS = np.empty((0, 3))


class Record(NamedTuple):
    """What is known of a TIN beside its points, triangles and flags."""

    document: dict[str, Any]
    """What JSON holds; ``{"array": name}`` stands for an array."""
    arrays: dict[str, AnyArray]


def pack_tin(tin: TIN) -> Record:
    """Return report, lines, reference, inputs and edits of a TIN as plain values and arrays."""
    version, origin = tin._settle()
    packer = _Packer()
    document: dict[str, Any] = {
        "crs": packer.pack(tin.crs),
        "elevation_unit": packer.pack(tin.elevation_unit),
        **_pack_version(version, packer),
        "edits": packer.pack(origin.edits),
    }
    if tin.row_attributes:
        document["attributes"] = pack_columns(tin.row_attributes, packer.pack)
    if origin.inputs is not None:
        document |= _pack_inputs(origin.inputs, version, packer)
    if origin.given is not None:
        mesh = origin.given.triangulation
        arrays = (mesh.points, mesh.triangles, mesh.constrained)
        document["given"] = {
            **_pack_version(origin.given, packer),
            "mesh": packer.pack(list(arrays)),
        }
    return Record(document, packer.arrays)


def _pack_version(version: Version, packer: _Packer) -> dict[str, Any]:
    return {
        "vertex_of": packer.pack(version.vertex_of),
        "lines": packer.pack(version.lines),
        "report": packer.pack(version.report),
    }


def _pack_inputs(inputs: BuildInputs, version: Version, packer: _Packer) -> dict[str, Any]:
    """Return the inputs; of their rows only those that differ from the vertices made of them."""
    rows = inputs.points
    differing = (take_rows(version, len(rows)).view(np.int64) != rows.view(np.int64)).any(axis=1)
    numbers = np.flatnonzero(differing).astype(np.int32)
    return {
        "inputs": packer.pack(replace(inputs, points=_NO_ROWS, crs=None, elevation_unit=None)),
        "n_rows": len(rows),
        "rows": packer.pack([numbers, rows[numbers]]),
    }


def take_rows(version: Version, count: int) -> Float64Array:
    """Return the vertices of the first rows; for rows without a vertex, any."""
    return np.ascontiguousarray(version.triangulation.points[version.vertex_of[:count]])


class _Packer:
    """Makes trees of plain values, and gathers arrays."""

    def __init__(self) -> None:
        self.arrays: dict[str, AnyArray] = {}

    def pack(self, value: Any) -> Any:
        """Return a value as a tree."""
        if isinstance(value, np.ndarray):
            name = str(len(self.arrays))
            self.arrays[name] = value
            return {"array": name}
        if isinstance(value, np.generic):
            value = value.item()
        if isinstance(value, float) and not math.isfinite(value):
            return {"number": repr(value)}
        if value is None or isinstance(value, bool | int | float | str):
            return value
        return self._pack_whole(value)

    def _pack_whole(self, value: Any) -> dict[str, Any]:
        name = type(value).__name__
        if isinstance(value, CRS | Unit):
            return {name.lower(): value.text if isinstance(value, Unit) else str(value)}
        if name in CLASSES:
            return {
                "type": name,
                **{key: self.pack(getattr(value, key)) for key in _list_keys(value)},
            }
        if isinstance(value, list | tuple):
            plain = list if isinstance(value, list) else tuple
            return {plain.__name__: [self.pack(one) for one in value]}
        return {"map": {str(key): self.pack(one) for key, one in dict(value).items()}}


def _list_keys(value: Any) -> list[str]:
    """Return the names of what a record holds; lines of the text that was read are left there."""
    names = [one.name for one in fields(value)] if is_dataclass(value) else list(value._fields)
    return [name for name in names if name != "row_sources"]
