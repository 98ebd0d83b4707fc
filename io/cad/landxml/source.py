"""Survey points and the source data of a surface as surveys."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from ....base.errors import ReadError
from ....base.sentences import FILE, counted
from ..surfaces import Line
from . import content
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
    from ....base.arrays import AnyArray, Float64Array, Int64Array
    from ..drawing import Drawing
    from .content import Content, Points, Surface

_RINGS = {"outer": "boundary", "void": "hole", "island": "island"}


# ------------------------------------------------------------------ survey points


def gather_points(points: Points, frame: Drawing) -> Drawing:
    """Add the survey points that have an elevation to a drawing."""
    kept, skipped = _select_points(points)
    if not len(kept):
        why = "; ".join(f"{count:,} {what}" for what, count in skipped.items())
        raise ReadError(
            f"{FILE} has no survey point with an elevation{f' ({why})' if why else ''}."
        )
    return replace(
        frame,
        points=points.rows[kept][:, [1, 0, 2]],
        attributes=_gather_attributes(points, kept),
        skipped=skipped,
        notes=_describe_states(points, kept),
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


def gather_source(found: Content, surface: Surface, frame: Drawing) -> Drawing:
    """Add the data that a surface was made of to a drawing, with its lines."""
    if not surface.has_source:
        raise ReadError(f"surface {surface.label} has no source data.")
    own = [part for one in surface.lines if one.element == "DataPoints" for part in one.coordinates]
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
    points = [_turn(part, one="DataPoints") for part in own]
    attributes: dict[str, AnyArray] = {}
    if not points and not any(one.element == "Contour" for one in surface.lines):
        kept, _ = _select_points(found.points)
        points = [found.points.rows[kept][:, [1, 0, 2]]]
        attributes = _gather_attributes(found.points, kept) if len(kept) else {}
        if len(kept):
            notes.append(f"Its points are the {counted(len(kept), 'survey point')} of the file.")
    lines = [*_iterate_lines(surface), *_resolve_chains(found, surface)]
    drawn = [_describe_line(line, rows) for line, rows in lines]
    return replace(
        frame,
        points=np.concatenate([np.empty((0, 3)), *points]),
        attributes=attributes,
        lines=[one for one in drawn if len(one.coordinates) > 1 or one.place],
        notes=notes,
    )


def _describe_line(line: content.Line, rows: Float64Array) -> Line:
    kind, place = line.properties.get(KIND, ""), ""
    if line.element == "Boundary":
        kind, place = _RINGS[find_boundary_kind(line)], f"the boundary of line {line.line}"
    elif line.element == "Contour":
        kind = "soft"
    priority = line.properties.get(PRIORITY, "0")
    number = int(priority) if priority.lstrip("-").isdecimal() and len(priority) < 10 else 0
    known = kind if place or kind in ("soft", "water") else "hard"
    return Line(rows, known, name_line(line), priority=number, place=place)


def _turn(part: Float64Array, *, one: str) -> Float64Array:
    if part.shape[1] != 3:
        raise ReadError(f"{one} have no elevations.")
    return part[:, [1, 0, 2]]


def _iterate_lines(surface: Surface) -> list[tuple[content.Line, Float64Array]]:
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


def _is_foreign_boundary(line: content.Line) -> bool:
    """Whether a boundary clips nothing, such as one of a texture."""
    return line.element == "Boundary" and not find_boundary_kind(line)


def _raise_contour(line: content.Line, rows: Float64Array) -> Float64Array:
    try:
        elevation = float(line.attributes.get("elev", "nan"))
    except ValueError:
        elevation = np.nan
    if not np.isfinite(elevation):
        shown = line.attributes.get("elev", "")[:60]
        raise fault(line.line, f"a contour has the elevation '{shown}', which is no number")
    return np.column_stack([rows[:, :2], np.full(len(rows), elevation)])


def _resolve_chains(found: Content, surface: Surface) -> list[tuple[content.Line, Float64Array]]:
    """Return the lines that are given by the names of survey points."""
    lines = []
    for text, attributes, number in surface.chains:
        names = dict(enumerate(text.split()))
        rows = resolve_references(np.zeros((len(names), 3)), names, found)[:, [1, 0, 2]]
        rows = rows if np.isfinite(rows).all() else rows[:, :2]
        lines.append((content.Line("Breakline", attributes, number), rows))
    return lines


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
