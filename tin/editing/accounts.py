"""Lines and report of a TIN as edits leave them: vertices and rows are called by other numbers."""

from __future__ import annotations

from dataclasses import fields, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.sentences import height
from ..constraints import Lines
from ..report import LEFT_OUT, Report, Unmended

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ...base.arrays import Int32Array, Int64Array
    from ..constraints import Breakline
    from ..report import Edit
    from ..triangulation import Triangulation

_MERGES = [one.name for one in fields(Report) if one.name.startswith("merged_")] + [
    "vertex_elevations"
]


def add_chain(lines: Lines, vertices: list[int], line: Breakline) -> Lines:
    """Return lines, all of them breaklines, and a further one through some vertices."""
    return Lines(
        vertices=np.append(lines.vertices, np.array(vertices, np.int32)),
        offsets=np.append(lines.offsets, np.int32(len(lines.vertices) + len(vertices))),
        kinds=(*lines.kinds, line.kind),
        sources=np.append(lines.sources, np.int32(len(lines))),
        names=(*lines.names, line.name),
    )


def renumber_vertices(
    report: Report, number: Int32Array, n_rows: int, n_vertices: int, n_triangles: int
) -> Report:
    """Return a report with vertex ``v`` of the lines' account called ``number[v]``."""
    crossings, overruled = report.crossings, report.overruled
    return replace(
        report,
        n_rows=n_rows,
        n_vertices=n_vertices,
        n_triangles=n_triangles,
        crossings=crossings._replace(vertices=number[crossings.vertices]),
        overruled=overruled._replace(vertices=number[overruled.vertices]),
    )


def renumber_rows(report: Report, rows: Int64Array, n_rows: int) -> Report:
    """Return a report with row ``i`` called ``rows[i]``; those between were removed."""
    if len(rows) == n_rows:
        return report
    is_lost = np.ones(n_rows, np.bool_)
    is_lost[rows] = False
    is_lost[rows[report.left_out_rows]] = True
    numbered = replace(
        report,
        n_rows=n_rows,
        merged_rows=rows[report.merged_rows].astype(np.int32),
        left_out_rows=rows[report.left_out_rows].astype(np.int32),
    )
    return account_for_removed(numbered, np.where(is_lost, np.int32(-1), np.int32(0)))


def account_for_removed(
    report: Report, vertex_of: Int32Array, why: str = "removed by an edit"
) -> Report:
    """Return a report with the rows that have no vertex; those that are new, and why."""
    lost = np.flatnonzero(vertex_of < 0).astype(np.int32)
    codes = np.full(len(lost), LEFT_OUT.index(why), np.int8)
    before = np.isin(lost, report.left_out_rows)
    codes[before] = report.left_out_why[np.searchsorted(report.left_out_rows, lost[before])]
    return replace(report, left_out_rows=lost, left_out_why=codes)


def account_for_edits(
    report: Report, vertex_of: Int32Array, n_vertices: int, n_triangles: int, edits: Sequence[Edit]
) -> Report:
    """Return the report of a TIN that was not built by us, whose rows have these vertices."""
    edited = replace(
        report,
        n_rows=len(vertex_of),
        n_vertices=n_vertices,
        n_triangles=n_triangles,
        merged_vertices=vertex_of[report.merged_rows[report.merged_offsets[:-1]]],
        edits=edits,
        unmended=Unmended.none(),
        simplification=None,
    )
    return account_for_removed(edited, vertex_of)


def account_for_fewer_vertices(
    report: Report,
    surface: Triangulation,
    number_of: Int32Array,
    vertex_of: Int32Array,
    why: str,
    **changes: Any,
) -> Report:
    """Return a report with vertex ``v`` called ``number_of[v]``, whose rows have these vertices."""
    counts = (len(vertex_of), len(surface.points), len(surface.triangles))
    fewer = replace(
        renumber_vertices(report, number_of, *counts),
        merged_vertices=vertex_of[report.merged_rows[report.merged_offsets[:-1]]],
        unmended=Unmended.none(),
        **changes,
    )
    return account_for_removed(fewer, vertex_of, why)


def replace_merges(report: Report, merges: Report | None) -> Report:
    """Return a report with the merges of another one, or with none."""
    account = Report(n_rows=0, n_vertices=0, n_triangles=0) if merges is None else merges
    return replace(report, **{name: getattr(account, name) for name in _MERGES})


def describe_crossings(report: Report, label: str) -> list[str]:
    """Return where a line crosses others, a sentence each."""
    own = [i for i, name in enumerate(report.line_labels) if name == label]
    is_own = np.isin(report.crossings.lines, own).any(axis=1)
    return [_describe_crossing(report, row, own) for row in np.flatnonzero(is_own).tolist()]


def _describe_crossing(report: Report, row: int, own: list[int]) -> str:
    crossings = report.crossings
    lines = crossings.lines[row]
    mine = int(lines[1] in own and lines[0] not in own)
    first, second = lines[[mine, 1 - mine]].tolist()
    other = "itself" if first == second else report.line_labels[second]
    (x, y), elevations = crossings.xy[row].tolist(), crossings.elevations[row].tolist()
    return (
        f"The breakline crosses {other} at x {x:.6f}, y {y:.6f}: its elevation there is "
        f"{height(elevations[mine])}, the other's {height(elevations[1 - mine])}; "
        f"{height(crossings.vertex_elevations[row])} was taken."
    )
