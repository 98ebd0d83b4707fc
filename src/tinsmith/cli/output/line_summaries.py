"""What is told of lines: those given, where they cross, what was overruled or left out."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.sentences import counted
from ...tin.report import LEFT_OUT, word_reason

if TYPE_CHECKING:
    from collections.abc import Iterable

    from ...tin import TIN, Report, Survey
    from .console import Row

_NOUNS = {
    "breaklines": ("breakline", "breaklines"),
    "boundary": ("boundary ring", "boundary rings"),
    "holes": ("hole", "holes"),
    "erase": ("part to erase", "parts to erase"),
    "water": ("water polygon", "water polygons"),
}


def find_elevation_symbol(found: Survey | TIN) -> str:
    """Return what stands behind an elevation, with the space before it; "" if not known."""
    return "" if found.elevation_unit is None else f" {found.elevation_unit.symbol}"


def count_given_lines(survey: Survey) -> dict[str, int]:
    """Count the lines of a survey."""
    return {name: len(getattr(survey, name)) for name in _NOUNS}


def describe_given_lines(survey: Survey) -> str:
    """Count the lines of a survey, in words."""
    return ", ".join(
        counted(number, *_NOUNS[name])
        for name, number in count_given_lines(survey).items()
        if number
    )


def summarise_news(made: TIN, known: Iterable[str]) -> list[Row]:
    """Return the notes of a report that were not told in other words or before."""
    reported = set(known)
    return [("Note", note) for note in made.report.notes if note not in reported]


def count_lines(report: Report) -> dict[str, Any]:
    """Count what the report lists one by one."""
    return {
        "rows": report.n_rows,
        "merged": len(report.merged_rows) - len(report.merged_vertices),
        "left_out": _count_left_out(report),
        "lines": report.n_lines,
        "crossings": len(report.crossings.vertices),
        "overruled": len(report.overruled.vertices),
    }


def _count_left_out(report: Report) -> dict[str, int]:
    counts = np.bincount(report.left_out_why, minlength=len(LEFT_OUT)).tolist()
    return {why: number for why, number in zip(LEFT_OUT, counts, strict=True) if number}


def summarise_lines(survey: Survey, tin: TIN) -> list[Row]:
    """Say which lines there are, where they cross, and what was overruled or left out."""
    report = tin.report
    rows = [("Lines", describe_given_lines(survey))] if survey.has_lines else []
    rows += _summarise_crossings(report, survey)
    if len(report.overruled.vertices):
        rows.append(("Elevations", _describe_overruled(report, survey)))
    if len(report.left_out_rows):
        reasons = ", ".join(
            f"{number:,} {word_reason(why, number)}"
            for why, number in _count_left_out(report).items()
        )
        rows.append(("Left out", f"{counted(len(report.left_out_rows), 'row')}: {reasons}"))
    return rows


def _summarise_crossings(report: Report, survey: Survey) -> list[Row]:
    crossings = report.crossings
    if len(crossings.vertices) == 0:
        return []
    places = f"at {counted(len(crossings.vertices), 'place')}"
    apart = np.abs(np.diff(crossings.elevations, axis=1)[:, 0])
    worst = int(np.argmax(apart))
    if apart[worst] == 0:
        return [("Crossings", f"{places}, at equal elevations")]
    up = find_elevation_symbol(survey)
    one, other = (
        f"{report.line_labels[line]} at {height:.3f}"
        for line, height in zip(
            crossings.lines[worst].tolist(), crossings.elevations[worst].tolist(), strict=True
        )
    )
    x, y = crossings.xy[worst].tolist()
    taken = crossings.vertex_elevations[worst]
    return [
        ("Crossings", f"{places}, elevations differ most by {apart[worst]:.3f}{up}"),
        ("", f"at x {x:.3f}, y {y:.3f}: {one}, {other}, taken {taken:.3f}"),
    ]


def _describe_overruled(report: Report, survey: Survey) -> str:
    overruled = report.overruled
    most = float(np.abs(overruled.elevations - overruled.vertex_elevations).max())
    number, up = len(overruled.vertices), find_elevation_symbol(survey)
    told = f"{number:,} overruled by lines of higher priority, the most by {most:.3f}{up}"
    lines, counts = np.unique(overruled.lines[overruled.lines >= 0], return_counts=True)
    if len(lines) and counts.max() > 1:  # more than where two lines cross
        told += "; --walls keeps both along a wall"
    return told
