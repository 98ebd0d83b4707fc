"""Level 3 of a check: rows and lines that were given are in the surface.

**How far may a chain run beside its line?** A line is cut where it meets others. A cut moves it by
no more than one unit: ``snap``, or the rounding of a crossing, at most a unit in the last place of
the largest coordinate; the parts are straight again, and are cut again. A vertex of the d-th such
generation lies within one unit of a segment whose ends belong to earlier ones, and no place on a
segment is further from the line than both its ends. So it lies within d units of the line, or
d + 1 if the line's own vertices were moved by ``snap`` first; and d is at most the number m of
vertices between two vertices of the line. Allowed are m + 1 units.

Of a part of a line that is left out, outside the surface or in water, the number of cuts is not
known: 16 more are allowed for, where that matters. It must lie outside the surface or in water, by
its vertices and the middles between them, and the chain must end at the boundary or at water.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...base.sentences import counted, inflect
from ..report import LEFT_OUT
from .boundary_sweep import find_sides
from .chain_matching import UNSEEN_CUTS, distance, walk_along
from .shape import find_boundary, has_sound_boundary

if TYPE_CHECKING:
    from ...base.arrays import BoolArray, Float64Array
    from ..constraints import LineSet
    from ..surface import TIN
    from .findings import Findings

_ROUNDING = 4 * 2.0**-53
_UNITS_OF_ROUNDING = 4  # one for a crossing or a bend; the rest for measuring the distance
_OUTSIDE = ("outside the boundary", "in a hole", "trimmed")


def check_rows(tin: TIN, rows: Float64Array, found: Findings) -> None:
    """Check that every input row is at its vertex, or within the distance of snapping.

    Those left out are named in the report, as level 1 tells; if they are said to be outside the
    surface, they are.
    """
    if len(rows) != len(tin.vertex_of):
        there = inflect(f"There [is|are] {counted(len(rows), 'row')}", len(rows))
        found.fail("rows", f"{there}, but the TIN was made of {len(tin.vertex_of):,}.")
        return
    moved = np.abs(tin.points[tin.vertex_of, :2] - rows[:, :2])
    moved[tin.vertex_of < 0] = 0.0
    is_moved = np.hypot(moved[:, 0], moved[:, 1]) > tin.report.snap * (1 + _ROUNDING)
    what = f"[is not where its|are not where their] vertex is, within snap {tin.report.snap:g}"
    found.report("rows", is_moved, "row", what)
    if not has_sound_boundary(found):
        return
    codes = [LEFT_OUT.index(reason) for reason in _OUTSIDE]
    outside = tin.report.left_out_rows[np.isin(tin.report.left_out_why, codes)]
    slack = (1 + UNSEEN_CUTS) * _measure_unit(tin, rows)
    found.report(
        "rows",
        outside[_is_inside(tin, rows[outside, :2], slack)],
        "row",
        "[is|are] left out as outside the surface, but [lies|lie] inside",
    )


def check_given_lines(tin: TIN, given: LineSet, found: Findings) -> None:
    """Check that every line is there as chains of its source, vertices in order, parts in place.

    Chains and boundary of the TIN are sound; lines are as the caller gave them, draped ones without
    elevations. Chains of further lines are not looked at.
    """
    xy, snap = tin.points[:, :2], tin.report.snap
    unit = _measure_unit(tin, given.xy)
    walk = walk_along(xy, tin.lines, given, snap=snap * (1 + _ROUNDING), unit=unit)
    found.report("lines", walk.lost, "line", "[has|have] chains that do not begin on [it|them]")
    # vertices between those given lie on the line, in order
    vertices, before, after = walk.between.T
    p, a, b = xy[vertices], given.xy[before], given.xy[after]
    cuts = np.bincount(before, minlength=len(given.xy))
    cuts[np.array(walk.gap_rows, np.int64)] += UNSEEN_CUTS
    allowed = (1 + cuts[before]) * unit
    along = ((p - a) * (b - a)).sum(axis=1) / np.hypot(*(b - a).T)
    is_same = np.append(False, np.diff(before) == 0)[: len(before)]
    is_wrong = is_same & (np.append(0.0, np.diff(along))[: len(before)] < -2 * allowed)
    is_wrong |= distance(p, a, b) > allowed
    astray = np.unique(given.line_of[before[is_wrong]])
    found.report("lines", astray, "line", "[has|have] chains that leave their course")
    most = int(cuts.max()) if len(before) else 0
    slack = (1 + most + UNSEEN_CUTS) * unit
    # what is left out of lines lies outside the surface or in water
    is_wrong = _is_on_land(tin, np.array(walk.gap_points).reshape(-1, 2), given, slack)
    found.report(
        "lines",
        np.unique(np.array(walk.gap_lines, np.int64)[is_wrong]),
        "line",
        "[has|have] parts inside the surface that are missing",
    )
    # chains end with their line, at the boundary or at water
    vertices = np.array(walk.end_vertices, np.int64)
    is_wet = np.repeat([kind == "water" for kind in tin.lines.kinds], np.diff(tin.lines.offsets))
    shore = tin.lines.vertices[is_wet.astype(np.bool_)]
    loose = np.flatnonzero(~np.isin(vertices, np.append(find_boundary(tin).start, shore)))
    is_wrong = _is_on_land(tin, xy[vertices[loose]], given, slack)
    found.report(
        "lines",
        np.unique(np.array(walk.end_lines, np.int64)[loose[is_wrong]]),
        "line",
        "[ends|end] inside the surface, before [its|their] end",
    )


def _measure_unit(tin: TIN, xy: Float64Array) -> float:
    """Return by how much one cut may move a line."""
    largest = max(np.abs(tin.points[:, :2]).max(), np.abs(xy[:, :2]).max(initial=0.0))
    return float(tin.report.snap + _UNITS_OF_ROUNDING * np.spacing(largest))


def _is_inside(tin: TIN, points: Float64Array, slack: float) -> BoolArray:
    """Tell which places lie inside the surface, further than ``slack`` from its boundary."""
    low, high = tin.points[:, :2].min(axis=0), tin.points[:, :2].max(axis=0)
    candidates = np.flatnonzero(((points > low) & (points < high)).all(axis=1))
    is_inside = np.zeros(len(points), np.bool_)
    if len(candidates):
        boundary = find_boundary(tin)
        a, b = boundary.points[boundary.start, :2], boundary.points[boundary.end, :2]
        for number in candidates[find_sides(boundary, points[candidates]) > 0]:
            is_inside[number] = distance(points[number], a, b).min() > slack
    return is_inside


def _is_on_land(tin: TIN, points: Float64Array, given: LineSet, slack: float) -> BoolArray:
    """Tell which places lie inside the surface and in no water, further in than ``slack``."""
    is_on_land = _is_inside(tin, points, slack)
    is_on_land[is_on_land] = ~_is_in_water(points[is_on_land], given, slack)
    return is_on_land


def _is_in_water(points: Float64Array, given: LineSet, slack: float) -> BoolArray:
    """Tell which places lie in water, or within ``slack`` of its shore."""
    shores = [
        given.xy[given.offsets[line] : given.offsets[line + 1]]
        for line, kind in enumerate(given.kinds)
        if kind == "water"
    ]
    in_water = [any(_is_in_ring(point, shore, slack) for shore in shores) for point in points]
    return np.array(in_water, np.bool_)


def _is_in_ring(point: Float64Array, ring: Float64Array, slack: float) -> bool:
    """Tell if a place lies in a closed ring, or nearly."""
    a, b = ring[:-1], ring[1:]
    if distance(point, a, b).min() <= slack:
        return True
    spans = (a[:, 1] <= point[1]) != (b[:, 1] <= point[1])
    a, b = a[spans], b[spans]
    crossing = a[:, 0] + (point[1] - a[:, 1]) * (b[:, 0] - a[:, 0]) / (b[:, 1] - a[:, 1])
    return bool(np.count_nonzero(crossing > point[0]) % 2)
