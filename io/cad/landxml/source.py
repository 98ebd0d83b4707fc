"""Survey points and the source data of a surface as surveys."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ....base import optional
from ....base.errors import LinesError, ReadError
from ....base.policies import BreaklineKind
from ....base.sentences import FILE, counted
from ....tin import Breakline, Survey, Water
from ....tin.constraints.breaklines import as_ring
from ....tin.screening.nodata import describe_elevations
from ..placing import Placing, place_rows
from .content import KIND, PRIORITY
from .numbers import fault
from .surface import (
    NO_ELEVATIONS,
    describe_point_files,
    find_boundary_kind,
    name_line,
    resolve_references,
)

if TYPE_CHECKING:
    from pathlib import Path

    from ....base.arrays import AnyArray, Float64Array, Int64Array
    from ..reference import Declared, Measures
    from .content import Content, Line, Points, Surface

__all__ = ["make_survey_of_points", "make_survey_of_source"]


# ------------------------------------------------------------------ survey points


def make_survey_of_points(
    points: Points, measures: Measures, declared: Declared, path: Path
) -> Survey:
    """Return the survey points that have an elevation.

    Raises
    ------
    ReadError
        If there are none.
    """
    kept, skipped = _select_points(points)
    if not len(kept):
        why = "; ".join(f"{count:,} {what}" for what, count in skipped.items())
        raise ReadError(
            f"{FILE} has no survey point with an elevation{f' ({why})' if why else ''}."
        )
    placing = place_rows([points.rows[kept][:, [1, 0, 2]]], measures, declared, names_axes=True)
    return Survey(
        points=placing.rows[0],
        attributes=_gather_attributes(points, kept),
        crs=placing.crs,
        elevation_unit=placing.elevation_unit,
        source=path.name,
        skipped=skipped,
        notes=[
            *placing.notes,
            *_describe_states(points, kept),
            *describe_elevations(placing.rows[0][:, 2]),
        ],
    )


def _describe_states(points: Points, kept: Int64Array) -> list[str]:
    """Tell of points that are no longer there, or not yet: a design stands among the ground."""
    found = Counter(points.states[row] for row in kept.tolist())
    listed = [f"{n:,} {state}" for state, n in found.items() if state not in ("", "existing")]
    if not listed:
        return []
    return [
        f"Of {counted(len(kept), 'survey point')} {' and '.join(listed)}, by their state, are read "
        "as the others are: the attribute state tells them apart."
    ]


def _select_points(points: Points) -> tuple[Int64Array, dict[str, int]]:
    """Return the rows of points for a surface, and how many others there are."""
    is_kept = np.asarray(np.isfinite(points.rows).all(axis=1))
    counts = {"references to other points": len(points.references)}
    counts["points without elevation"] = int((~is_kept).sum()) - len(points.references)
    marked = [row for row in points.excluded if is_kept[row]]
    is_kept[marked] = False
    counts["points not for the surface"] = len(marked)
    return np.flatnonzero(is_kept), {what: n for what, n in counts.items() if n}


def _gather_attributes(points: Points, kept: Int64Array) -> dict[str, AnyArray]:
    """Return the columns that are there; a code is a description where there is no other."""
    columns = {
        "number": points.names,
        "description": points.descriptions if any(points.descriptions) else points.codes,
        "code": points.codes,
        "group": points.groups,
        "state": points.states,
    }
    return {name: np.array(values, object)[kept] for name, values in columns.items() if any(values)}


# ------------------------------------------------------------------ source data


def make_survey_of_source(
    found: Content, surface: Surface, measures: Measures, declared: Declared, path: Path
) -> Survey:
    """Return the data that a surface was made of, with its lines.

    Raises
    ------
    ReadError
        If there are none, or a line is none.
    """
    if not surface.has_source:
        raise ReadError(f"surface {surface.label} has no source data.")
    own = [part for one in surface.lines if one.element == "DataPoints" for part in one.coordinates]
    notes = _describe_parts_left_out(surface)
    points = [_turn(part, one="DataPoints") for part in own]
    attributes: dict[str, AnyArray] = {}
    if not points and not any(one.element == "Contour" for one in surface.lines):
        kept, _ = _select_points(found.points)
        points = [found.points.rows[kept][:, [1, 0, 2]]]
        attributes = _gather_attributes(found.points, kept) if len(kept) else {}
        if len(kept):
            notes.append(f"Its points are the {counted(len(kept), 'survey point')} of the file.")
    lines = [*_iterate_lines(surface), *_resolve_chains(found, surface)]
    placing = place_rows(
        [*points, *(rows for _, rows in lines)], measures, declared, names_axes=True
    )
    rows = placing.rows[: len(points)]
    survey = Survey(
        points=np.concatenate([np.empty((0, 3)), *rows]),
        attributes=attributes,
        crs=placing.crs,
        elevation_unit=placing.elevation_unit,
        source=path.name,
        notes=[*placing.notes, *notes],
    )
    try:
        return _add_lines(survey, [one for one, _ in lines], placing, len(points))
    except LinesError as error:
        raise ReadError(f"{error}") from error


def _turn(part: Float64Array, *, one: str) -> Float64Array:
    if part.shape[1] != 3:
        raise ReadError(f"{one} have no elevations.")
    return part[:, [1, 0, 2]]


def _iterate_lines(surface: Surface) -> list[tuple[Line, Float64Array]]:
    """Return the lines as easting, northing, and elevation where it counts."""
    found = []
    for line in surface.lines:
        for part in line.coordinates:
            rows = part[:, [1, 0, *range(2, part.shape[1])]]
            if line.element == "Contour":
                rows = _raise_contour(line, rows)
            elif line.element == "DataPoints" or _is_foreign_boundary(line):
                continue
            elif line.attributes.get("brkType") in NO_ELEVATIONS:
                rows = rows[:, :2]
            found.append((line, rows))
    return found


def _is_foreign_boundary(line: Line) -> bool:
    """Whether a boundary clips nothing, such as one of a texture."""
    return line.element == "Boundary" and not find_boundary_kind(line)


def _raise_contour(line: Line, rows: Float64Array) -> Float64Array:
    try:
        elevation = float(line.attributes.get("elev", "nan"))
    except ValueError:
        elevation = np.nan
    if not np.isfinite(elevation):
        shown = line.attributes.get("elev", "")[:60]
        raise fault(line.line, f"a contour has the elevation '{shown}', which is no number")
    return np.column_stack([rows[:, :2], np.full(len(rows), elevation)])


def _resolve_chains(found: Content, surface: Surface) -> list[tuple[Line, Float64Array]]:
    """Return the lines that are given by the names of survey points."""
    from .content import Line

    lines = []
    for text, attributes, number in surface.chains:
        names = dict(enumerate(text.split()))
        rows = resolve_references(np.zeros((len(names), 3)), names, found)[:, [1, 0, 2]]
        rows = rows if np.isfinite(rows).all() else rows[:, :2]
        lines.append((Line("Breakline", attributes, number), rows))
    return lines


def _add_lines(survey: Survey, lines: list[Line], placing: Placing, first: int) -> Survey:
    breaklines: list[Any] = []
    water: list[Water] = []
    rings: dict[str, list[Float64Array]] = {"outer": [], "void": [], "island": []}
    for line, rows in zip(lines, placing.rows[first:], strict=True):
        name = name_line(line)
        own = line.properties.get(KIND, "")
        if line.element == "Boundary":
            rings[find_boundary_kind(line)].append(
                as_ring(rows, f"the boundary of line {line.line}")
            )
        elif own == "water" and rows.shape[1] == 3:
            water.append(Water(rows[:, :2], float(rows[0, 2]), name=name))
        elif len(rows) > 1:
            breaklines.append(_make_breakline(line, rows, name))
    holes, left = _join_islands(rings["void"], rings["island"])
    notes = list(survey.notes)
    if left:
        notes.append(
            f"{counted(left, 'boundary', 'boundaries')} of type island in no void left out."
        )
    return replace(
        survey,
        breaklines=breaklines,
        boundary=rings["outer"],
        holes=holes,
        water=water,
        notes=notes,
    )


def _make_breakline(line: Line, rows: Float64Array, name: str) -> Breakline:
    kind: BreaklineKind = "hard"
    if line.element == "Contour" or line.properties.get(KIND) == "soft":
        kind = "soft"
    priority = line.properties.get(PRIORITY, "0")
    number = int(priority) if priority.lstrip("-").isdecimal() and len(priority) < 10 else 0
    return Breakline(rows, kind=kind, priority=number, name=name)


def _join_islands(voids: list[Float64Array], islands: list[Float64Array]) -> tuple[list[Any], int]:
    """Return each void with the islands in it, and the number of islands in none."""
    if not islands:
        return list(voids), 0
    shapely = optional.load("shapely")
    areas = [shapely.Polygon(ring[:, :2]) for ring in voids]
    polygons: list[list[Any]] = [[ring] for ring in voids]
    left = 0
    for island in islands:
        place = shapely.Point(island[0, :2])
        holder = next((k for k, area in enumerate(areas) if area.intersects(place)), None)
        if holder is None:
            left += 1
        else:
            polygons[holder].append(island)
    return [one[0] if len(one) == 1 else one for one in polygons], left


def _describe_parts_left_out(surface: Surface) -> list[str]:
    notes = []
    if surface.point_files:
        notes.append(f"{describe_point_files(surface)} Their points are missing.")
    if surface.n_walls:
        notes.append(f"{counted(surface.n_walls, 'retaining wall')} left out.")
    soft = sum(line.attributes.get("brkType") in NO_ELEVATIONS for line in surface.lines)
    if soft:
        notes.append(
            f"{counted(soft, 'breakline')} of type proximity or nondestructive draped on the "
            "surface: their own elevations do not count."
        )
    notes += _describe_foreign_boundaries(surface)
    trimmed = sum(
        line.attributes.get("edgeTrim", "true").strip().lower() in ("false", "0")
        for line in surface.lines
        if line.element == "Boundary" and find_boundary_kind(line)
    )
    if trimmed:
        notes.append(
            f"{counted(trimmed, 'boundary', 'boundaries')} without edgeTrim taken as exact edges "
            "of the surface."
        )
    return notes


def _describe_foreign_boundaries(surface: Surface) -> list[str]:
    foreign = [line.attributes.get("bndType", "") for line in surface.lines
               if _is_foreign_boundary(line)]  # fmt: skip
    if not foreign:
        return []
    types = ", ".join(f"'{name[:40]}'" for name in list(dict.fromkeys(foreign))[:5])
    return [
        f"{counted(len(foreign), 'boundary', 'boundaries')} left out, whose bndType ({types}) is "
        "neither outer, void nor island."
    ]
