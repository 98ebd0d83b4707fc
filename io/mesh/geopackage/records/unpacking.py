"""Unpacking: the TIN of a record; what is read may come from anyone, and is compared first."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from .....base.crs import CRS, Unit
from .....base.errors import PointsError, TinsmithError
from .....base.records import require, require_fields, require_indices
from .....tin import topology
from .....tin.building.inputs import BuildInputs
from .....tin.building.version import Version
from .....tin.editing.origin import Origin
from .....tin.surface import TIN
from .....tin.triangulation import Triangulation
from .....tin.validation.points import as_points
from .....tin.validation.triangles import as_flags, as_triangles, turn_counter_clockwise
from .columns import unpack_columns
from .packing import CLASSES, take_rows

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    from .....base.arrays import AnyArray, BoolArray, Float64Array, Int32Array
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
    origin = Origin(inputs, given, tuple(unpack(document["edits"])))
    origin._require_sound(version)
    tin = TIN._of(
        version,
        crs=unpack(document["crs"]),
        elevation_unit=unpack(document["elevation_unit"]),
        row_attributes=unpack_columns(
            document.get("attributes", []), unpack, len(version.vertex_of)
        ),
    )
    if inputs is not None:
        inputs = replace(inputs, crs=tin.crs, elevation_unit=tin.elevation_unit)
    tin._resume(origin._replace(inputs=inputs))
    return tin


def _unpack_version(document: Any, mesh: Iterable[Any], unpack: Any) -> Version:
    points, triangles, constrained = mesh
    xyz = as_points(points)
    corners, flags = as_triangles(triangles, len(xyz)), as_flags(constrained, len(triangles))
    turned, flags = turn_counter_clockwise(xyz, corners, flags)
    neighbors = topology.neighbors_of(turned, len(xyz))
    version = Version(
        triangulation=Triangulation(xyz, turned, neighbors, flags),
        **{name: unpack(document[name]) for name in ("vertex_of", "lines", "report")},
    )
    version._require_sound()
    return version


def _unpack_inputs(document: Mapping[str, Any], version: Version, unpack: Any) -> BuildInputs:
    inputs, count = unpack(document["inputs"]), document["n_rows"]
    numbers, values = unpack(document["rows"])
    require(type(count) is int and 0 <= count <= len(version.vertex_of), "too many rows")
    require(isinstance(inputs, BuildInputs), "the inputs are none")
    inputs._require_sound(count)
    require_indices(numbers, count, "rows")
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
            value = CLASSES[tree["type"]](**own)
            require_fields(value, CLASSES | {"CRS": CRS, "Unit": Unit})
            return value
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
