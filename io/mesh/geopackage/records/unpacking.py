"""Unpacking: the TIN of a record; what is read may come from anyone, and is compared first."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from .....base.crs import CRS, Unit
from .....base.errors import PointsError, TinsmithError
from .....tin import topology
from .....tin.editing.origin import Origin
from .....tin.editing.version import Version
from .....tin.surface import TIN
from .....tin.triangulation import Triangulation
from .....tin.validation.points import as_points
from .....tin.validation.triangles import as_flags, as_triangles, turn_counter_clockwise
from .columns import unpack_columns
from .packing import CLASSES, take_rows
from .requirements import (
    require,
    require_edits,
    require_inputs,
    require_lines,
    require_numbers,
    require_report,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    from .....base.arrays import AnyArray, BoolArray, Float64Array, Int32Array
    from .....tin.building.inputs import BuildInputs
    from .packing import Record

__all__ = ["unpack_tin"]

_DEEPEST = 16
"""Levels of a tree; the deepest that is written has 9."""


def unpack_tin(
    record: Record,
    points: Float64Array,
    triangles: Int32Array,
    constrained: BoolArray,
) -> TIN:
    """Return the TIN of a record and of its points, triangles and flags.

    Raises
    ------
    PointsError
        If the record is not one that :func:`pack_tin` made of these points and triangles.
    """
    try:
        return _unpack_tin(record, points, triangles, constrained)
    except PointsError:
        raise
    except (TypeError, ValueError, LookupError, AttributeError, TinsmithError) as error:
        raise PointsError(f"The record does not fit the TIN ({error}).") from error


def _unpack_tin(record: Record, *mesh: AnyArray) -> TIN:
    document, unpack = record.document, _Unpacker(record.arrays).unpack
    version = _unpack_version(document, mesh, unpack)
    inputs, given = None, None
    if "inputs" in document:
        inputs = _unpack_inputs(document, version, unpack)
    if "given" in document:
        before = document["given"]
        given = _unpack_version(before, unpack(before["mesh"]), unpack)
    edits = unpack(document["edits"])
    require_edits(edits)
    tin = TIN(
        **{name: getattr(version.triangulation, name) for name in _MESH},
        vertex_of=version.vertex_of,
        report=version.report,
        lines=version.lines,
        crs=unpack(document["crs"]),
        elevation_unit=unpack(document["elevation_unit"]),
        row_attributes=unpack_columns(
            document.get("attributes", []), unpack, len(version.vertex_of)
        ),
    )
    if inputs is not None:
        inputs = replace(inputs, crs=tin.crs, elevation_unit=tin.elevation_unit)
    tin._resume(Origin(inputs, given, tuple(edits)))
    return tin


_MESH = ("points", "triangles", "neighbors", "constrained")


def _unpack_version(document: Any, mesh: Iterable[Any], unpack: Any) -> Version:
    points, triangles, constrained = mesh
    xyz = as_points(points)
    corners, flags = as_triangles(triangles, len(xyz)), as_flags(constrained, len(triangles))
    turned, flags = turn_counter_clockwise(xyz, corners, flags)
    neighbors = topology.neighbors_of(turned, len(xyz))
    vertex_of, lines = unpack(document["vertex_of"]), unpack(document["lines"])
    report = unpack(document["report"])
    require_numbers(vertex_of, np.int32, -1, len(xyz), "vertices of the rows")
    require_lines(lines, len(xyz))
    require_report(report, len(vertex_of), len(xyz), len(turned))
    return Version(
        triangulation=Triangulation(
            points=xyz, triangles=turned, neighbors=neighbors, constrained=flags
        ),
        vertex_of=vertex_of,
        report=report,
        lines=lines,
    )


def _unpack_inputs(document: Mapping[str, Any], version: Version, unpack: Any) -> BuildInputs:
    inputs, count = unpack(document["inputs"]), document["n_rows"]
    numbers, values = unpack(document["rows"])
    require(type(count) is int and 0 <= count <= len(version.vertex_of), "too many rows")
    require_inputs(inputs, count)
    require_numbers(numbers, np.int32, 0, count, "rows")
    require(isinstance(values, np.ndarray) and values.shape == (len(numbers), 3), "rows")
    rows = take_rows(version, count)
    rows[numbers] = values
    whole: BuildInputs = replace(
        inputs, points=as_points(rows) if inputs.is_masked is None else rows
    )
    return whole


class _Unpacker:
    """Makes values of trees."""

    def __init__(self, arrays: Mapping[str, AnyArray]) -> None:
        self._arrays = arrays

    def unpack(self, tree: Any, depth: int = 0) -> Any:
        """Return the value of a tree."""
        require(depth < _DEEPEST, "it is too deep")
        if not isinstance(tree, dict):
            return tree
        if "type" in tree:
            own = {k: self.unpack(v, depth + 1) for k, v in tree.items() if k != "type"}
            return CLASSES[tree["type"]](**own)
        ((kind, content),) = tree.items()
        if kind in ("list", "tuple"):
            items = [self.unpack(one, depth + 1) for one in content]
            return items if kind == "list" else tuple(items)
        if kind == "map":
            return {key: self.unpack(one, depth + 1) for key, one in content.items()}
        return self._unpack_leaf(kind, content)

    def _unpack_leaf(self, kind: str, content: Any) -> Any:
        if kind == "array":
            return self._arrays[content]
        makers: dict[str, Callable[[Any], Any]] = {"number": float, "crs": CRS.of, "unit": Unit.of}
        return makers[kind](content)
