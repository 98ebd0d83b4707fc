"""Requirements: what a record must be to fit a TIN, before anything uses it."""

from __future__ import annotations

from typing import Any, get_args

import numpy as np

from .....base.errors import PointsError
from .....base.policies import (
    CrossingPolicy,
    DuplicatePolicy,
    LineKind,
    SimplificationHold,
    TrimPolicy,
)
from .....tin.building.constrained import LineOptions
from .....tin.building.inputs import BuildInputs
from .....tin.constraints.breaklines import Lines
from .....tin.constraints.constraint_set import LineSet
from .....tin.constraints.constraint_table import ConstraintTable
from .....tin.editing.operations import OPERATIONS
from .....tin.report import (
    LEFT_OUT,
    UNMENDED_WHY,
    Crossings,
    Edit,
    Overruled,
    Report,
    Simplification,
    Unmended,
)

__all__ = [
    "require",
    "require_edits",
    "require_inputs",
    "require_lines",
    "require_numbers",
    "require_report",
]


def require(is_so: Any, what: str) -> None:
    """Raise unless something is so.

    Raises
    ------
    PointsError
    """
    if not is_so:
        raise PointsError(f"The record does not fit the TIN ({what}).")


def require_numbers(array: Any, dtype: Any, least: int, end: int, what: str) -> None:
    """Require whole numbers from ``least`` up to, not including, ``end``."""
    require(isinstance(array, np.ndarray) and array.dtype == dtype and array.ndim == 1, what)
    require(not len(array) or (array.min() >= least and array.max() < end), what)


def _require_floats(array: Any, shape: tuple[int, ...], what: str) -> None:
    require(isinstance(array, np.ndarray) and array.dtype == np.float64, what)
    require(array.shape == shape and np.isfinite(array).all(), what)


def _require_offsets(offsets: Any, dtype: Any, count: int, end: int, what: str) -> None:
    require_numbers(offsets, dtype, 0, end + 1, what)
    require(len(offsets) == count + 1 and offsets[0] == 0 and offsets[-1] == end, what)
    require((np.diff(offsets) >= 0).all(), what)


def _require_texts(texts: Any, what: str) -> None:
    require(isinstance(texts, list | tuple) and all(type(one) is str for one in texts), what)


def _require_counts(counts: Any, what: str) -> None:
    require(isinstance(counts, dict), what)
    require(all(type(k) is str and type(v) is int for k, v in counts.items()), what)


def _require_distance(value: Any, what: str) -> None:
    require(type(value) in (int, float) and value >= 0, what)


def _require_kinds(kinds: Any, names: Any) -> None:
    _require_texts(kinds, "kinds of lines")
    _require_texts(names, "names of lines")
    require(type(kinds) is tuple and type(names) is tuple, "kinds of lines")
    require({*kinds} <= {*get_args(LineKind)} and len(names) == len(kinds), "kinds of lines")


def require_lines(lines: Any, n_vertices: int) -> None:
    """Require lines whose chains are of vertices that there are."""
    require(isinstance(lines, Lines), "the lines are none")
    _require_kinds(lines.kinds, lines.names)
    require_numbers(lines.vertices, np.int32, 0, n_vertices, "vertices of lines")
    _require_offsets(lines.offsets, np.int32, len(lines.kinds), len(lines.vertices), "lines")
    require_numbers(lines.sources, np.int32, -1, 2**31, "sources of lines")
    require(len(lines.sources) == len(lines.kinds), "sources of lines")


def require_edits(edits: Any) -> None:
    """Require edits of operations that there are; their arguments are judged as they are done."""
    require(isinstance(edits, list | tuple), "the edits are none")
    for edit in edits:
        require(isinstance(edit, Edit) and edit.operation in OPERATIONS, "the edits are none")
        require(isinstance(edit.arguments, dict), "the edits are none")
        require(all(type(name) is str for name in edit.arguments), "the edits are none")
        _require_texts(edit.notes, "the edits are none")


# ----------------------------------------------------------------------- inputs


def require_inputs(inputs: Any, n_rows: int) -> None:
    """Require inputs of so many rows, whose points are still to be filled in."""
    require(isinstance(inputs, BuildInputs), "the inputs are none")
    _require_line_set(inputs.lines)
    masked = inputs.is_masked
    if masked is not None:
        require(isinstance(masked, np.ndarray) and masked.dtype == np.bool_, "masked rows")
        require(masked.shape == (n_rows,), "masked rows")
    for rings in (inputs.boundary, inputs.extent, *_list_regions(inputs)):
        _require_rings(rings)
    _require_rings_of_lines(inputs)
    require(type(inputs.max_edge) is float and inputs.max_edge > 0, "the longest edge")
    require(inputs.trim in get_args(TrimPolicy), "an option")
    require({type(inputs.conforming), type(inputs.has_own_boundary)} == {bool}, "an option")
    _require_options(inputs.options)
    require(type(inputs.from_raster) is bool, "where points come from")
    _require_counts(inputs.skipped, "what was skipped")
    _require_texts(inputs.notes, "notes")
    require(isinstance(inputs.source, str), "the source")


def _require_rings_of_lines(inputs: BuildInputs) -> None:
    """Require for each line that is a ring the ring that it is."""
    if inputs.has_own_boundary:
        return  # of existing triangles, whose rings are those of the surface
    rings = {
        "boundary": len(inputs.boundary) + len(inputs.extent),
        "hole": sum(map(len, inputs.holes)),
    }
    for kind, source in zip(inputs.lines.kinds, inputs.lines.sources.tolist(), strict=True):
        require(source < rings.get(kind, source + 1), "rings of lines")


def _list_regions(inputs: BuildInputs) -> list[Any]:
    require(isinstance(inputs.holes, list) and isinstance(inputs.erase, list), "holes")
    return [*inputs.holes, *inputs.erase]


def _require_rings(rings: Any) -> None:
    require(isinstance(rings, list), "a ring")
    for ring in rings:
        require(isinstance(ring, np.ndarray) and ring.ndim == 2 and len(ring) >= 3, "a ring")
        _require_floats(ring, (len(ring), ring.shape[1]), "a ring")
        require(ring.shape[1] in (2, 3), "a ring")


def _require_options(options: Any) -> None:
    require(isinstance(options, LineOptions), "the options are none")
    require(type(options.threads) is int and options.threads >= 1, "threads")
    require(options.duplicates in get_args(DuplicatePolicy), "an option")
    require(options.crossing in get_args(CrossingPolicy), "an option")
    _require_distance(options.snap, "snap")


def _require_line_set(lines: Any) -> None:
    require(isinstance(lines, LineSet) and isinstance(lines.table, ConstraintTable), "lines")
    _require_kinds(lines.kinds, lines.names)
    require(isinstance(lines.xy, np.ndarray) and lines.xy.ndim == 2, "coordinates of lines")
    count, rows = len(lines.kinds), len(lines.xy)
    _require_floats(lines.xy, (rows, 2), "coordinates of lines")
    _require_offsets(lines.offsets, np.int64, count, rows, "lines")
    require((np.diff(lines.offsets) >= 2).all(), "lines of one vertex")
    require_numbers(lines.sources, np.int32, -1, 2**31, "sources of lines")
    require(len(lines.sources) == count, "sources of lines")
    for array, length in ((lines.elevations, rows), (lines.priorities, count)):
        require(isinstance(array, np.ndarray) and array.dtype == np.float64, "elevations of lines")
        require(array.shape == (length,), "elevations of lines")


# ----------------------------------------------------------------------- the report


def require_report(report: Any, n_rows: int, n_vertices: int, n_triangles: int) -> None:
    """Require a report of so many rows, vertices and triangles."""
    require(isinstance(report, Report), "the report is none")
    counts = (report.n_rows, report.n_vertices, report.n_triangles, report.n_lines)
    require({type(count) for count in counts} == {int}, "counts of the report")
    require(counts[:3] == (n_rows, n_vertices, n_triangles), "counts of the report")
    require(report.duplicates in get_args(DuplicatePolicy), "an option")
    _require_distance(report.snap, "snap")
    _require_merges(report, n_vertices)
    require_numbers(report.left_out_rows, np.int32, 0, n_rows, "rows left out")
    require_numbers(report.left_out_why, np.int8, 0, len(LEFT_OUT), "rows left out")
    require(len(report.left_out_why) == len(report.left_out_rows), "rows left out")
    require(type(report.line_labels) is tuple, "labels of lines")
    _require_texts(report.line_labels, "labels of lines")
    _require_accounts(report, n_vertices)
    require(type(report.from_raster) is bool, "where points come from")
    _require_counts(report.skipped, "what was skipped")
    _require_texts(report.notes, "notes")
    require(isinstance(report.source, str), "the source")
    require_edits(report.edits)
    _require_unmended(report.unmended)
    _require_simplification(report.simplification)


def _require_merges(report: Report, n_vertices: int) -> None:
    require_numbers(report.merged_vertices, np.int32, -1, n_vertices, "merged vertices")
    require_numbers(report.merged_rows, np.int32, 0, report.n_rows, "merged rows")
    groups, rows = len(report.merged_vertices), len(report.merged_rows)
    _require_offsets(report.merged_offsets, np.int32, groups, rows, "merged rows")
    _require_floats(report.merged_elevations, (rows,), "merged elevations")
    _require_floats(report.merged_shifts, (rows,), "merged elevations")
    _require_floats(report.vertex_elevations, (groups,), "merged elevations")


def _require_accounts(report: Report, n_vertices: int) -> None:
    """Require crossings, and elevations that were overruled, of lines that there are."""
    crossings, overruled = report.crossings, report.overruled
    require(isinstance(crossings, Crossings) and isinstance(overruled, Overruled), "crossings")
    labels = len(report.line_labels)
    for account, axes in ((crossings, (2,)), (overruled, ())):
        require_numbers(account.vertices, np.int32, -1, n_vertices, "crossings")
        shape = (len(account.vertices), *axes)
        require(isinstance(account.lines, np.ndarray) and account.lines.shape == shape, "crossings")
        require_numbers(account.lines.ravel(), np.int32, -1, labels, "crossings")
        _require_floats(account.elevations, shape, "crossings")
        _require_floats(account.vertex_elevations, shape[:1], "crossings")
    _require_floats(crossings.xy, (len(crossings.vertices), 2), "crossings")


def _require_unmended(unmended: Any) -> None:
    require(isinstance(unmended, Unmended), "triangles that are not mended")
    require_numbers(unmended.triangles, np.int32, 0, 2**31 - 1, "triangles that are not mended")
    require_numbers(unmended.why, np.int8, 0, len(UNMENDED_WHY), "triangles that are not mended")
    _require_floats(unmended.angles, unmended.triangles.shape, "triangles that are not mended")
    require(len(unmended.why) == len(unmended.triangles), "triangles that are not mended")


def _require_simplification(found: Any) -> None:
    if found is None:
        return
    require(isinstance(found, Simplification), "what was simplified")
    counts = (*found[:4], found.forced_edges)
    require(found.hold in (None, *get_args(SimplificationHold)), "what was simplified")
    require({type(count) for count in counts} == {int}, "what was simplified")
    errors = {
        found.largest_error,
        found.rms_error,
        0.0 if found.tolerance is None else found.tolerance,
        0.0 if found.surface_error is None else found.surface_error,
    }
    require({type(one) for one in errors} == {float}, "what was simplified")
