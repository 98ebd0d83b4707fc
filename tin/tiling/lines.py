"""All lines of a survey, cut where they meet on one machine, for tasks that see parts of them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...base.errors import LinesError, OptionError
from ...base.types import Bounds
from .. import _kernel
from ..building import find_ring_groups, merge_rows
from ..constraints import ABOVE_ALL, BELOW_ALL, HOLES, Polylines, node
from .boxes import list_sides, widen
from .rings import Rings
from .skeleton import reduce_to_hull
from .sources import NumberedPoints, NumberedSegments

if TYPE_CHECKING:
    from ...base.arrays import AnyArray, BoolArray, Float64Array, Int32Array, Int64Array
    from ..building import BuildInputs, BuildOptions
    from ..constraints import LineSet
    from .circles import Discs


class _Index(NamedTuple):
    """Bounds of segments in the ``order`` of their western sides, and the largest width."""

    order: Int64Array
    west: Float64Array
    south: Float64Array
    east: Float64Array
    north: Float64Array
    width: float


@dataclass(frozen=True, eq=False, kw_only=True)
class NodedLines:
    """Segments in memory, of which a task gets those near it: a :class:`.SegmentSource`.

    Attributes
    ----------
    vertices : NumberedPoints
        With the elevations that they have in the surface.
    segments : (k, 2) int32 array
        The places of their ends among the vertices.
    are_rings : (k,) bool array
        Whether each is a segment of the boundary or of a hole.
    rings : Rings or None
    """

    vertices: NumberedPoints
    segments: Int32Array
    are_rings: BoolArray
    rings: Rings | None = None

    @cached_property
    def skeleton(self) -> NumberedPoints:
        """The vertices of the convex hull of all lines."""
        return reduce_to_hull(self.vertices)

    def read_box(self, box: Bounds) -> NumberedSegments:
        """Return the segments whose bounds meet a box."""
        low, high = self._bounds
        meets = (low[:, 0] <= box.xmax) & (high[:, 0] >= box.xmin)
        meets &= (low[:, 1] <= box.ymax) & (high[:, 1] >= box.ymin)
        return self._choose(meets)

    def read_discs(self, discs: Discs) -> NumberedSegments:
        """Return the segments whose bounds meet those of any disc."""
        index = self._index
        meets = np.zeros(len(self.segments), np.bool_)
        reach = (discs.radii + _SLACK * np.abs(discs.centers).max(axis=1, initial=0.0))[:, None]
        reach = reach * (1 + _SLACK)
        low, high = discs.centers - reach, discs.centers + reach
        begins = np.searchsorted(index.west, low[:, 0] - index.width, "left")
        ends = np.searchsorted(index.west, high[:, 0], "right")
        for k in np.flatnonzero(begins < ends).tolist():
            some = slice(begins[k], ends[k])
            meets[some] |= (
                (index.east[some] >= low[k, 0])
                & (index.south[some] <= high[k, 1])
                & (index.north[some] >= low[k, 1])
            )
        return self._choose(np.sort(index.order[meets]))

    @cached_property
    def _index(self) -> _Index:
        low, high = self._bounds
        order = np.argsort(low[:, 0], kind="stable")
        (west, south), (east, north) = low[order].T.copy(), high[order].T.copy()
        width = float((east - west).max(initial=0.0)) * (1 + _SLACK)
        return _Index(order, west, south, east, north, width)

    @cached_property
    def _bounds(self) -> tuple[Float64Array, Float64Array]:
        ends = self.vertices.points[self.segments, :2]
        return ends.min(axis=1), ends.max(axis=1)

    def _choose(self, which: BoolArray | Int64Array) -> NumberedSegments:
        starts, ends = self.segments[which].T
        return NumberedSegments(
            self.vertices.choose(starts), self.vertices.choose(ends), self.are_rings[which]
        )


_ALL_OVER = "for a surface in tiles: vertices change one after the other, all over the surface"

_SLACK = 2.0**-40
_ROUNDINGS = 2.0**-42
"""Of coordinates: a thousand units in the last place."""


def require_local(inputs: BuildInputs) -> None:
    """Refuse what cannot be told of a part of a surface from what lies near it.

    Raises
    ------
    OptionError
        If triangles are dropped by their edges, lines are made to conform, or rows are merged
        within a distance.
    LinesError
        If points within water go.
    """
    options, lines = inputs.options, inputs.lines
    if options.max_edge is not None:
        raise OptionError(
            "max_edge",
            options.max_edge,
            "None for a surface in tiles: what it drops from the rim inwards no tile can tell",
        )
    if options.conforming:
        raise OptionError("conforming", True, f"False {_ALL_OVER}")
    if options.snap > 0:
        raise OptionError("snap", options.snap, f"0 {_ALL_OVER}")
    if (lines.priorities == ABOVE_ALL).any() or inputs.has_own_boundary:
        raise LinesError(
            "Water and existing triangles are not available for surfaces in tiles: a hole is."
        )


def choose_near(points: NumberedPoints, lines: LineSet) -> NumberedPoints:
    """Return the points, of a chunk of all, that lines may pass, and maybe others.

    Those are on a line, or so near that a line may be bent onto them where lines cross: vertices
    there are rounded to doubles.
    """
    xy, rows = points.points[:, :2], len(points.numbers)
    if not rows or not len(lines.xy):
        return NumberedPoints.none()
    distance = _ROUNDINGS * max(float(np.abs(one).max()) for one in (xy, lines.xy))
    ends = list_segments_near(lines, widen(Bounds.of(xy), 4 * distance)).reshape(-1, 2)
    if not len(ends):
        return NumberedPoints.none()
    together = np.ascontiguousarray(np.concatenate([xy, ends]))
    segments = rows + np.arange(len(ends), dtype=np.int32).reshape(-1, 2)
    touched = _kernel.touches(together, segments.astype(np.int32), distance)[:, 1]
    is_near = np.ones(rows, np.bool_)
    for axis in (0, 1):
        places = np.sort(ends[:, axis])
        low = np.searchsorted(places, xy[:, axis] - 2 * distance, "left")
        is_near &= low < np.searchsorted(places, xy[:, axis] + 2 * distance, "right")
    is_near[touched[touched < rows]] = True
    return points.choose(is_near)


def list_segments_near(lines: LineSet, box: Bounds) -> Float64Array:
    """Return the ends of all segments whose bounds meet a box, (k, 2, 2)."""
    own = Polylines.whole(np.arange(len(lines.xy), dtype=np.int32), lines.offsets).segments()
    ends: Float64Array = lines.xy[own]
    west, south, east, north = list_sides(box)
    meets = ((ends.min(axis=1) <= (east, north)) & (ends.max(axis=1) >= (west, south))).all(axis=1)
    return np.asarray(ends[meets])


class MeetingLines(NamedTuple):
    """Lines that share vertices wherever they meet, and the points that they pass.

    Attributes
    ----------
    points : (v, 3) float64 array
        Distinct places, with the elevations that they have in the surface; maybe some that no line
        passes.
    numbers : (v,) int64 array
        Of the first point at each place; -1 if there is none.
    polylines : Polylines
    """

    points: Float64Array
    numbers: Int64Array
    polylines: Polylines


def node_lines(near: NumberedPoints, inputs: BuildInputs, *, first_number: int) -> NodedLines:
    """Cut lines where they meet, as :func:`tinsmith.triangulate` does.

    Parameters
    ----------
    near : NumberedPoints
        Those that :func:`choose_near` returns of all points, in order of numbers: a line is cut
        where it passes one of them.
    inputs : BuildInputs
        Their lines, rings and options count.
    first_number : int
        From here on vertices are numbered that no point has; above the number of any point.

    Raises
    ------
    OptionError, LinesError
        As :func:`require_local`; if lines have no elevations, or cross and must not.
    """
    made = let_meet(near, inputs)
    is_ring = inputs.lines.table.is_kind("boundary", "hole")
    groups = np.where(is_ring, find_ring_groups(inputs, inputs.lines), -1)
    rings = _gather_rings(made.points, made.polylines, groups)
    return gather_lines(made, groups >= 0, rings, first_number=first_number)


def let_meet(near: NumberedPoints, inputs: BuildInputs) -> MeetingLines:
    """Give lines a vertex where they meet, or pass points: see :func:`node_lines`."""
    require_local(inputs)
    lines, options = inputs.lines, inputs.options
    draped = np.unique(lines.line_of[np.isnan(lines.elevations)])
    if len(draped):
        raise LinesError(
            f"{lines.title(int(draped[0]))} has no elevations: it must be draped before.",
            lines=draped[:5].tolist(),
        )
    places, vertex_of = _find_places(np.concatenate([near.points[:, :2], lines.xy]))
    of_points, of_lines = vertex_of[: len(near.numbers)], vertex_of[len(near.numbers) :]
    numbers, elevations = _describe(near, of_points, len(places), options)
    _set_line_elevations(elevations, of_lines, lines)
    noded = node(
        places,
        Polylines.whole(of_lines, lines.offsets),
        lines.elevations,
        lines.priorities,
        crossing=options.crossing,
        names=lines.labels(),
    )
    return MeetingLines(
        np.concatenate([np.column_stack([places, elevations]), noded.new_points]),
        np.append(numbers, np.full(len(noded.new_points), -1)),
        noded.polylines,
    )


def _find_places(xy: Float64Array) -> tuple[Float64Array, Int32Array]:
    """Return distinct places, and which of them each row has."""
    xy = xy + 0.0  # no zero has a sign
    places, place_of = np.unique(xy, axis=0, return_inverse=True)
    return np.ascontiguousarray(places), place_of.ravel().astype(np.int32)


def _describe(
    near: NumberedPoints, place_of: Int32Array, count: int, options: BuildOptions
) -> tuple[Int64Array, Float64Array]:
    """Return the number and the elevation that the points at each place give; -1 and NaN."""
    numbers, elevations = np.full(count, -1, np.int64), np.full(count, np.nan)
    first = np.full(count, len(place_of), np.int32)
    np.minimum.at(first, place_of, np.arange(len(place_of), dtype=np.int32))
    merged = merge_rows(near.points, first[place_of], options.duplicates, near.numbers)
    is_there = first < len(place_of)
    numbers[is_there] = near.numbers[first[is_there]]
    elevations[is_there] = merged.points[merged.vertex_of[first[is_there]], 2]
    return numbers, elevations


def _set_line_elevations(elevations: Float64Array, vertex_of: Int32Array, lines: LineSet) -> None:
    """Give vertices the elevation of the line that counts most there, its lowest, in place."""
    best = lines.find_best_rows(vertex_of)
    priority = lines.priorities[lines.line_of[best]]
    counts = (priority > BELOW_ALL) | np.isnan(elevations[vertex_of[best]])
    elevations[vertex_of[best[counts]]] = lines.elevations[best[counts]]


def gather_lines(
    made: MeetingLines, is_ring: BoolArray, rings: Rings | None, *, first_number: int
) -> NodedLines:
    """Name the vertices, and leave out those that are on no line; ``is_ring`` is of each line."""
    polylines, numbers = made.polylines, made.numbers.copy()
    is_new = numbers < 0
    numbers[is_new] = first_number + np.arange(np.count_nonzero(is_new))
    alone = polylines.vertices[np.repeat(polylines.lengths == 1, polylines.lengths)]
    segments = np.concatenate([polylines.segments(), np.stack([alone, alone], axis=1)])
    used, ends = np.unique(segments, return_inverse=True)
    are_rings = is_ring[polylines.segment_lines()]
    return NodedLines(
        vertices=NumberedPoints(made.points[used], numbers[used]),
        segments=ends.reshape(-1, 2).astype(np.int32),
        are_rings=np.append(are_rings, np.zeros(len(alone), np.bool_)),
        rings=rings,
    )


def _gather_rings(points: Float64Array, polylines: Polylines, groups: Int64Array) -> Rings | None:
    if (groups < 0).all():
        return None
    found: dict[int, list[AnyArray]] = {group: [] for group in range(HOLES)}
    found |= {group: [] for group in range(HOLES, int(groups.max()) + 1)}
    for line, chain in zip(polylines.lines.tolist(), polylines, strict=True):
        if groups[line] >= 0:
            found[int(groups[line])].append(points[chain, :2])
    boundary, extent, *holes = found.values()
    return Rings(boundary=boundary, extent=extent, holes=holes)
