"""Storage: all that a TIN is, as values that JSON holds and arrays, and the TIN of them again.

Report, lines, inputs and edits become trees of plain values; ``_CLASSES`` names the only classes
that are made of such trees. What is read may come from anyone: numbers of rows and vertices are
compared with what is there before anything uses them.
"""

from __future__ import annotations

import math
from dataclasses import fields, is_dataclass, replace
from typing import TYPE_CHECKING, Any, NamedTuple, get_args

import numpy as np

from ....crs import CRS, Unit
from ....errors import PointsError, TinsmithError
from ....policies import LineKind
from ....tin import topology
from ....tin.building.constrained import LineOptions
from ....tin.building.inputs import BuildInputs
from ....tin.constraints.breaklines import Lines
from ....tin.constraints.constraint_set import LineSet
from ....tin.constraints.constraint_table import ConstraintTable
from ....tin.editing.origin import Origin
from ....tin.editing.version import Version
from ....tin.report import Crossings, Edit, Overruled, Report, Unmended
from ....tin.surface import TIN
from ....tin.triangulation import Triangulation
from ....tin.validation.points import as_points
from ....tin.validation.triangles import as_flags, as_triangles, turn_counter_clockwise

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    from numpy.typing import NDArray

__all__ = ["Record", "pack_tin", "unpack_tin"]

_CLASSES: dict[str, Any] = {
    kind.__name__: kind
    for kind in (
        *(BuildInputs, ConstraintTable, Crossings, Edit, LineOptions, Lines, LineSet),
        *(Overruled, Report, Unmended),
    )
}
_DEEPEST = 16
"""Levels of a tree; the deepest that is written has 9."""

_NO_ROWS = np.empty((0, 3))


class Record(NamedTuple):
    """What is known of a TIN beside its points, triangles and flags.

    Attributes
    ----------
    document : dict
        What JSON holds; ``{"array": name}`` stands for an array.
    arrays : dict of str to array
    """

    document: dict[str, Any]
    arrays: dict[str, NDArray[Any]]


def pack_tin(tin: TIN) -> Record:
    """Return report, lines, reference, inputs and edits of a TIN as plain values and arrays."""
    version, origin = tin._snapshot()
    packer = _Packer()
    document: dict[str, Any] = {
        "crs": packer.pack(tin.crs),
        "elevation_unit": packer.pack(tin.elevation_unit),
        **_pack_version(version, packer),
        "edits": packer.pack(origin.edits),
    }
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
    differing = (_take_rows(version, len(rows)).view(np.int64) != rows.view(np.int64)).any(axis=1)
    numbers = np.flatnonzero(differing).astype(np.int32)
    return {
        "inputs": packer.pack(replace(inputs, points=_NO_ROWS, crs=None, elevation_unit=None)),
        "n_rows": len(rows),
        "rows": packer.pack([numbers, rows[numbers]]),
    }


def _take_rows(version: Version, count: int) -> NDArray[np.float64]:
    """Return the vertices of the first rows; for rows without a vertex, any."""
    return np.ascontiguousarray(version.triangulation.points[version.vertex_of[:count]])


class _Packer:
    """Makes trees of plain values, and gathers arrays."""

    def __init__(self) -> None:
        self.arrays: dict[str, NDArray[Any]] = {}

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
        if name in _CLASSES:
            return {
                "type": name,
                **{key: self.pack(getattr(value, key)) for key in _list_keys(value)},
            }
        if isinstance(value, list | tuple):
            plain = list if isinstance(value, list) else tuple
            return {plain.__name__: [self.pack(one) for one in value]}
        return {"map": {str(key): self.pack(one) for key, one in dict(value).items()}}


def _list_keys(value: Any) -> list[str]:
    """Return the names of what a record holds."""
    return [one.name for one in fields(value)] if is_dataclass(value) else list(value._fields)


# ----------------------------------------------------------------------- and back


def unpack_tin(
    record: Record,
    points: NDArray[np.float64],
    triangles: NDArray[np.int32],
    constrained: NDArray[np.bool_],
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


def _unpack_tin(record: Record, *mesh: NDArray[Any]) -> TIN:
    document, unpack = record.document, _Unpacker(record.arrays).unpack
    version = _unpack_version(document, mesh, unpack)
    inputs, given = None, None
    if "inputs" in document:
        inputs = _unpack_inputs(document, version, unpack)
    if "given" in document:
        before = document["given"]
        given = _unpack_version(before, unpack(before["mesh"]), unpack)
    edits = unpack(document["edits"])
    _require(all(isinstance(one, Edit) for one in edits), "the edits are none")
    tin = TIN(
        **{name: getattr(version.triangulation, name) for name in _MESH},
        vertex_of=version.vertex_of,
        report=version.report,
        lines=version.lines,
        crs=unpack(document["crs"]),
        elevation_unit=unpack(document["elevation_unit"]),
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
    _require_numbers(vertex_of, np.int32, -1, len(xyz), "vertices of the rows")
    _require_lines(lines, len(xyz))
    _require_report(report, vertex_of, len(xyz), len(turned))
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
    _require(isinstance(inputs, BuildInputs), "the inputs are none")
    _require(isinstance(count, int) and 0 <= count <= len(version.vertex_of), "too many rows")
    _require_numbers(numbers, np.int32, 0, count, "rows")
    rows = _take_rows(version, count)
    rows[numbers] = values
    _require_line_set(inputs.lines)
    masked = inputs.is_masked
    _require(masked is None or (masked.dtype == bool and len(masked) == count), "masked rows")
    regions = [ring for region in (*inputs.holes, *inputs.erase) for ring in region]
    for ring in (*inputs.boundary, *inputs.extent, *regions):
        _require_floats(ring, (len(ring), 2), "a ring")
    whole: BuildInputs = replace(inputs, points=as_points(rows) if masked is None else rows)
    return whole


class _Unpacker:
    """Makes values of trees."""

    def __init__(self, arrays: Mapping[str, NDArray[Any]]) -> None:
        self._arrays = arrays

    def unpack(self, tree: Any, depth: int = 0) -> Any:
        """Return the value of a tree."""
        _require(depth < _DEEPEST, "it is too deep")
        if not isinstance(tree, dict):
            return tree
        if "type" in tree:
            own = {k: self.unpack(v, depth + 1) for k, v in tree.items() if k != "type"}
            return _CLASSES[tree["type"]](**own)
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


def _require(is_so: Any, what: str) -> None:
    if not is_so:
        raise PointsError(f"The record does not fit the TIN ({what}).")


def _require_numbers(array: Any, dtype: Any, least: int, end: int, what: str) -> None:
    """Require whole numbers from ``least`` up to, not including, ``end``."""
    _require(isinstance(array, np.ndarray) and array.dtype == dtype and array.ndim == 1, what)
    _require(not len(array) or (array.min() >= least and array.max() < end), what)


def _require_floats(array: Any, shape: tuple[int, ...], what: str) -> None:
    _require(isinstance(array, np.ndarray) and array.dtype == np.float64, what)
    _require(array.shape == shape and np.isfinite(array).all(), what)


def _require_offsets(offsets: Any, dtype: Any, count: int, end: int, what: str) -> None:
    _require_numbers(offsets, dtype, 0, end + 1, what)
    _require(len(offsets) == count + 1 and offsets[0] == 0 and offsets[-1] == end, what)
    _require((np.diff(offsets) >= 0).all(), what)


def _require_names(kinds: Any, names: Any) -> None:
    _require(isinstance(kinds, tuple) and {*kinds} <= {*get_args(LineKind)}, "kinds of lines")
    _require(isinstance(names, tuple) and len(names) == len(kinds), "names of lines")
    _require(all(isinstance(name, str) for name in names), "names of lines")


def _require_lines(lines: Any, n_vertices: int) -> None:
    _require(isinstance(lines, Lines), "the lines are none")
    _require_names(lines.kinds, lines.names)
    _require_numbers(lines.vertices, np.int32, 0, n_vertices, "vertices of lines")
    _require_offsets(lines.offsets, np.int32, len(lines.kinds), len(lines.vertices), "lines")
    _require_numbers(lines.sources, np.int32, -1, 2**31, "sources of lines")
    _require(len(lines.sources) == len(lines.kinds), "sources of lines")


def _require_line_set(lines: Any) -> None:
    _require(isinstance(lines, LineSet) and isinstance(lines.table, ConstraintTable), "lines")
    _require_names(lines.kinds, lines.names)
    count, rows = len(lines.kinds), len(lines.xy)
    _require_floats(lines.xy, (rows, 2), "coordinates of lines")
    _require_offsets(lines.offsets, np.int64, count, rows, "lines")
    _require((np.diff(lines.offsets) >= 2).all(), "lines of one vertex")
    _require_numbers(lines.sources, np.int32, -1, 2**31, "sources of lines")
    for array, length in ((lines.elevations, rows), (lines.priorities, count)):
        _require(array.dtype == np.float64 and array.shape == (length,), "elevations of lines")
    _require(len(lines.sources) == count, "sources of lines")


def _require_report(report: Any, vertex_of: NDArray[np.int32], n: int, m: int) -> None:
    _require(isinstance(report, Report), "the report is none")
    counts = (report.n_rows, report.n_vertices, report.n_triangles)
    _require(counts == (len(vertex_of), n, m), "counts of the report")
    groups, rows = len(report.merged_vertices), len(report.merged_rows)
    _require_numbers(report.merged_vertices, np.int32, -1, n, "merged vertices")
    _require_numbers(report.merged_rows, np.int32, 0, len(vertex_of), "merged rows")
    _require_offsets(report.merged_offsets, np.int32, groups, rows, "merged rows")
    _require_floats(report.merged_elevations, (rows,), "merged elevations")
    _require_floats(report.merged_shifts, (rows,), "merged elevations")
    _require_floats(report.vertex_elevations, (groups,), "merged elevations")
    _require_numbers(report.left_out_rows, np.int32, 0, len(vertex_of), "rows left out")
    _require_numbers(report.left_out_why, np.int8, 0, 127, "rows left out")
    _require(len(report.left_out_why) == len(report.left_out_rows), "rows left out")
    labels = len(report.line_labels)
    for account in (report.crossings, report.overruled):
        _require_numbers(account.vertices, np.int32, -1, n, "crossings")
        _require_numbers(account.lines.ravel(), np.int32, -1, labels, "crossings")
        _require({len(part) for part in account} == {len(account.vertices)}, "crossings")
    _require(isinstance(report.unmended, Unmended), "triangles that are not mended")
    _require_numbers(report.unmended.triangles, np.int32, 0, 2**31, "triangles not mended")
