"""Facts about lines: what was given, what became of them, what gave way to them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ..._sentences import counted
from ...tin.report import LEFT_OUT

if TYPE_CHECKING:
    from ...tin import TIN, Report, Survey
    from .console import Field

__all__ = [
    "constrained_edges",
    "elevation_symbol",
    "given_lines",
    "given_lines_text",
    "line_counts",
    "line_fields",
    "mesh_counts",
    "tin_counts",
]

_NOUNS = {
    "breaklines": ("breakline", "breaklines"),
    "boundary": ("boundary ring", "boundary rings"),
    "holes": ("hole", "holes"),
    "erase": ("part to erase", "parts to erase"),
    "water": ("water polygon", "water polygons"),
}


def constrained_edges(tin: TIN) -> int:
    """Count the constrained edges, each once."""
    on_rim = tin.constrained & (tin.neighbors < 0)
    return int((tin.constrained.sum() + on_rim.sum()) // 2)


def elevation_symbol(found: Survey | TIN) -> str:
    """Return what stands behind an elevation, with the space before it; "" if not known."""
    return "" if found.elevation_unit is None else f" {found.elevation_unit.symbol}"


def given_lines(survey: Survey) -> dict[str, int]:
    """Count the lines of a survey."""
    return {name: len(getattr(survey, name)) for name in _NOUNS}


def given_lines_text(survey: Survey) -> str:
    """Count the lines of a survey, in words."""
    return ", ".join(
        counted(number, *_NOUNS[name]) for name, number in given_lines(survey).items() if number
    )


def tin_counts(tin: TIN) -> str:
    """Count vertices and triangles, and constrained edges if there are any, in words."""
    fixed = constrained_edges(tin)
    lines = f", {counted(fixed, 'constrained edge')}" if fixed else ""
    return f"{mesh_counts(tin)}{lines}"


def mesh_counts(tin: TIN) -> str:
    """Count vertices and triangles, in words."""
    vertices = counted(len(tin.points), "vertex", "vertices")
    return f"{vertices}, {counted(len(tin.triangles), 'triangle')}"


def line_counts(report: Report) -> dict[str, Any]:
    """Count what the report lists one by one."""
    return {
        "rows": report.n_rows,
        "merged": len(report.merged_rows) - len(report.merged_vertices),
        "left_out": _left_out(report),
        "lines": report.n_lines,
        "crossings": len(report.crossings.vertices),
        "overruled": len(report.overruled.vertices),
    }


def _left_out(report: Report) -> dict[str, int]:
    counts = np.bincount(report.left_out_why, minlength=len(LEFT_OUT)).tolist()
    return {why: number for why, number in zip(LEFT_OUT, counts, strict=True) if number}


def line_fields(survey: Survey, tin: TIN) -> list[Field]:
    """Say which lines there are, where they cross, and what gave way or was left out."""
    report = tin.report
    fields = [("Lines", given_lines_text(survey))] if survey.has_lines else []
    fields += _crossing_fields(report, survey)
    if len(report.overruled.vertices):
        fields.append(("Heights", _overruled_text(report, survey)))
    if len(report.left_out_rows):
        reasons = ", ".join(f"{number:,} {why}" for why, number in _left_out(report).items())
        fields.append(("Left out", f"{counted(len(report.left_out_rows), 'row')}: {reasons}"))
    return fields


def _crossing_fields(report: Report, survey: Survey) -> list[Field]:
    met = report.crossings
    if len(met.vertices) == 0:
        return []
    places = f"at {counted(len(met.vertices), 'place')}"
    apart = np.abs(np.diff(met.heights, axis=1)[:, 0])
    worst = int(np.argmax(apart))
    if apart[worst] == 0:
        return [("Crossings", f"{places}, at equal heights")]
    up = elevation_symbol(survey)
    one, other = (
        f"{report.line_labels[line]} at {height:.3f}"
        for line, height in zip(met.lines[worst].tolist(), met.heights[worst].tolist(), strict=True)
    )
    x, y = met.xy[worst].tolist()
    return [
        ("Crossings", f"{places}, heights differ most by {apart[worst]:.3f}{up}"),
        ("", f"at x {x:.3f}, y {y:.3f}: {one}, {other}, taken {met.taken[worst]:.3f}"),
    ]


def _overruled_text(report: Report, survey: Survey) -> str:
    gave_way = report.overruled
    most = float(np.abs(gave_way.heights - gave_way.taken).max())
    number, up = len(gave_way.vertices), elevation_symbol(survey)
    return f"{number:,} gave way to lines of more weight, the most by {most:.3f}{up}"
