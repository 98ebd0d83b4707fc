"""HTML representations of a survey, and of the report of what became of its rows."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ....base.checks import as_floats
from ....base.georeference import find_axes
from ....base.sentences import counted
from ....tin.report import word_reason
from .. import palette
from ..palette import parse_hex
from .drawings import Canvas
from .frame import describe_bounds, name_crs, name_units, write_html

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from ....base.arrays import Float64Array, UInt8Array
    from ....tin import Report, Survey

_GIVEN = {
    "breaklines": ("breakline", "breaklines"),
    "boundary": ("boundary ring", "boundary rings"),
    "holes": ("hole", "holes"),
    "erase": ("erased polygon", "erased polygons"),
    "water": ("water polygon", "water polygons"),
}

_EXPECTED = "header lines"
_LINE = parse_hex(palette.THUMBNAIL_LINES)
_MOST_NOTES = 5


def make_survey_html(survey: Survey) -> str:
    """Return HTML: points, lines, columns, CRS, notes, and a map of the points."""
    picture = _draw(survey) if len(survey) else None
    alt = "Map of the points, north up"
    return write_html("Survey", _describe_survey(survey), picture=picture, alt=alt)


def _describe_survey(survey: Survey) -> Iterator[tuple[str, str]]:
    yield "Points", counted(len(survey), "point")
    given = {name: len(getattr(survey, name)) for name in _GIVEN}
    if any(given.values()):
        yield "Lines", ", ".join(counted(n, *_GIVEN[name]) for name, n in given.items() if n)
    if survey.attributes:
        yield "Columns", ", ".join(survey.attributes)
    if survey.source:
        yield "From", survey.source
    yield "CRS", name_crs(survey.crs)
    yield "Units", name_units(survey.crs, survey.elevation_unit)
    yield from describe_bounds(survey.points, survey.crs)
    skipped = {what: count for what, count in survey.skipped.items() if what != _EXPECTED}
    if skipped:
        yield "Left out", ", ".join(f"{count:,} {what}" for what, count in skipped.items())
    yield from list_notes(survey.notes)


def _draw(survey: Survey) -> UInt8Array:
    given = [getattr(line, "coords", line) for line in survey.breaklines]
    given += [getattr(water, "ring", water) for water in survey.water]
    axes = find_axes(survey.crs)
    points = axes.turn(survey.points)
    lines = [axes.turn(line) for line in map(_take_plane, given) if line is not None]
    canvas = Canvas.around(np.concatenate([points[:, :2], *lines]), survey.crs)
    canvas.draw_points(points[:, :2], points[:, 2])
    for line in lines:
        canvas.draw_segments(line[:-1], line[1:], _LINE)
    return canvas.pixels


def _take_plane(line: object) -> Float64Array | None:
    """Return eastings and northings of a line; None of what is no plain array of places."""
    table = as_floats(line)
    if table is None:
        return None
    is_line = table.ndim == 2 and table.shape[1] in (2, 3) and bool(np.isfinite(table).all())
    return table[:, :2] if is_line else None


def list_notes(notes: Sequence[str]) -> Iterator[tuple[str, str]]:
    """Yield a row for each of the first notes, and one that counts the others."""
    for note in notes[:_MOST_NOTES]:
        yield "Note", note
    if len(notes) > _MOST_NOTES:
        yield "", f"and {counted(len(notes) - _MOST_NOTES, 'other note')}"


def make_report_html(report: Report) -> str:
    """Return HTML: what became of the rows, and where lines meet."""
    return write_html("Report", _describe_report(report))


def _describe_report(report: Report) -> Iterator[tuple[str, str]]:
    yield "Rows", counted(report.n_rows, "row")
    vertices = counted(report.n_vertices, "vertex", "vertices")
    yield "Surface", f"{vertices}, {counted(report.n_triangles, 'triangle')}"
    merged = len(report.merged_rows) - len(report.merged_vertices)
    if merged:
        places = counted(len(report.merged_vertices), "vertex", "vertices")
        yield "Merged", f"{counted(merged, 'row')} at {places}, elevation by {report.duplicates!r}"
    for what, rows in report.to_dict()["left_out"].items():
        yield "Left out", f"{counted(len(rows), 'row')} {word_reason(what, len(rows))}"
    if report.n_lines:
        yield "Lines", counted(report.n_lines, "line")
    if len(report.crossings.xy):
        yield "Crossings", counted(len(report.crossings.xy), "crossing")
    overruled = len(report.to_dict()["overruled"])
    if overruled:
        yield "Overruled", counted(overruled, "elevation")
    yield from list_notes(report.notes)
