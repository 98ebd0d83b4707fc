"""Cells of the Voronoi diagram outside a polygon: what is nearest to each edge and corner.

From every place on the edge a ray goes out at right angles, from a corner that juts out a fan of
rays. All along a ray nothing is nearer than its foot, up to where a circle that touches the foot
touches the polygon at another place: there rays of two edges or corners meet, and cells end.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from ....base.arrays import BoolArray, Float64Array, Int64Array

FACET = np.pi / 90
"""Angle between the rays of a fan."""
_NONE = -1
"""Touched by a circle as large as the reach: nothing."""
_SHARE = 1e-12
"""Of a radius: by so much less something may be away by rounding."""
_FREE = 1e-9
"""Of the reach: so much less is the reach by rounding."""
_STRAIGHT = 1e-6
"""An edge goes straight on where it turns by less."""
_HALVINGS = 60


class Rays(NamedTuple):
    """Rays by the cells that they are in, and by their order along the edge of each.

    Cell ``i`` of n corners is that of the edge from corner i to the next one, n + i that of the
    corner i itself.
    """

    cell: Int64Array
    place: Float64Array
    """Distance along the edge, or angle in the fan."""
    foot: Float64Array
    """(k, 2)."""
    way: Float64Array
    """(k, 2), of unit length."""
    length: Float64Array
    other: Int64Array
    """The cell that the ray ends at, -1 at the reach."""

    @property
    def ends(self) -> Float64Array:
        """The places where the rays end, (k, 2)."""
        return np.asarray(self.foot + self.length[:, None] * self.way)

    def take(self, chosen: Any) -> Rays:
        """Return some of them."""
        return Rays(*(column[chosen] for column in self))

    def join(self, other: Rays) -> Rays:
        """Return them and others."""
        return Rays(*(np.concatenate(pair) for pair in zip(self, other, strict=True)))

    def sort(self) -> Rays:
        """Return them by cells and places."""
        return self.take(np.lexsort((self.place, self.cell)))


def find_rays(ring: Float64Array, reach: float) -> tuple[Rays, BoolArray]:
    """Return the rays between which cells are bounded by straight lines, but for facets of fans.

    ``ring`` are the corners of a polygon, (n, 2), counter-clockwise. Rays of a fan are two degrees
    apart. The rays are those of both cells that end at a place. Tells also of each ray whether all
    up to the next one are of the same cell, and end at the reach.

    Notes
    -----
    Where neighbouring rays of a cell end at the same other cell, so do all between them: the
    circles at their ends and the two edges enclose what they pass over, and no part of the polygon
    comes in. Where they end at different ones, the ray that would end at both is tried, until a
    third cell is no longer found; between rays of full length that which ends the earliest. This
    takes a few rays for each corner of the diagram.
    """
    outline = _Outline(ring, reach)
    rays = outline.trace(*outline.list_first())
    is_pair = rays.cell[1:] == rays.cell[:-1]
    before, behind = rays.take(slice(-1)).take(is_pair), rays.take(slice(1, None)).take(is_pair)
    while len(before.cell):
        places = outline.find_places_between(before, behind)
        chosen = ~np.isnan(places)
        before, behind = before.take(chosen), behind.take(chosen)
        between = outline.trace(before.cell, places[chosen])
        rays = rays.join(between)
        is_new = outline.is_new(between, before, behind)
        before, between, behind = (one.take(is_new) for one in (before, between, behind))
        before, behind = before.join(between), between.join(behind)
    rays = rays.join(outline.turn_round(rays.take(rays.other != _NONE))).sort()
    is_full = outline.are_full(rays)
    rays.length[is_full] = reach
    return rays, outline.find_free(rays)


class _Outline:
    """The edges and corners of a polygon."""

    def __init__(self, ring: Float64Array, reach: float) -> None:
        import shapely

        self._n, self._ring, self._reach = len(ring), ring, reach
        along = np.roll(ring, -1, axis=0) - ring
        self._lengths = np.hypot(*along.T)
        self._along = along / self._lengths[:, None]
        self._out = np.column_stack([self._along[:, 1], -self._along[:, 0]])
        before = np.roll(self._along, 1, axis=0)
        cross = before[:, 0] * self._along[:, 1] - before[:, 1] * self._along[:, 0]
        self._turn = np.arctan2(cross, (before * self._along).sum(axis=1))
        self._turn[np.abs(self._turn) < _STRAIGHT] = 0.0
        ends = np.stack([ring, np.roll(ring, -1, axis=0)], axis=1)
        self._tree = shapely.STRtree(shapely.linestrings(ends))

    def list_first(self) -> tuple[Int64Array, Float64Array]:
        """Return cells and places of the rays at the ends of edges, and in fans."""
        cells = [np.repeat(np.arange(self._n), 2)]
        places = [np.column_stack([np.zeros(self._n), self._lengths]).ravel()]
        for corner in np.flatnonzero(self._turn > 0).tolist():
            angle = float(self._turn[corner])
            count = int(np.ceil(angle / FACET * (1.0 - _SHARE))) + 1
            cells.append(np.full(count, self._n + corner))
            places.append(np.linspace(0.0, angle, count))
        return np.concatenate(cells), np.concatenate(places)

    def _place_rays(self, cell: Int64Array, place: Float64Array) -> tuple[Float64Array, ...]:
        """Return the feet and the ways of rays."""
        number, is_edge = cell % self._n, cell < self._n
        first = self._out[np.where(is_edge, number, number - 1)]
        angle = np.where(is_edge, 0.0, place)
        cosine, sine = np.cos(angle), np.sin(angle)
        x, y = first.T
        way = np.column_stack([x * cosine - y * sine, x * sine + y * cosine])
        foot = self._ring[number] + np.where(is_edge, place, 0.0)[:, None] * self._along[number]
        is_end = is_edge & (place == self._lengths[number])
        foot[is_end] = self._ring[(number[is_end] + 1) % self._n]
        return foot, way

    def trace(self, cell: Int64Array, place: Float64Array) -> Rays:
        """Return rays as far as they go."""
        import shapely

        foot, way = self._place_rays(cell, place)
        length, other = np.full(len(cell), self._reach), np.full(len(cell), _NONE)
        self._stop_in_notches(cell, place, length, other)
        open_ = np.flatnonzero(length > 0)
        while len(open_):
            middle = foot[open_] + length[open_, None] * way[open_]
            near, away = self._tree.query_nearest(
                shapely.points(middle), all_matches=False, return_distance=True
            )
            found = np.empty(len(open_), np.int64)
            distance = np.empty(len(open_))
            found[near[0]], distance[near[0]] = near[1], away
            is_touched = distance < length[open_] * (1.0 - _SHARE)
            open_, found = open_[is_touched], found[is_touched]
            shorter, touched = self._touch(foot[open_], way[open_], found)
            own = self._are_own(cell[open_], place[open_], found)
            is_shorter = ~own & (shorter < length[open_])
            open_ = open_[is_shorter]
            length[open_], other[open_] = shorter[is_shorter], touched[is_shorter]
        return Rays(cell, place, foot, way, length, other)

    def _stop_in_notches(
        self, cell: Int64Array, place: Float64Array, length: Float64Array, other: Int64Array
    ) -> None:
        """Give rays from corners that do not jut out no length: they end at the edge beside."""
        is_edge = cell < self._n
        is_first = is_edge & (place == 0.0)
        is_last = is_edge & (place == self._lengths[cell % self._n])
        for is_there, corner, beside in ((is_first, cell, cell - 1), (is_last, cell + 1, cell + 1)):
            stops = is_there & (self._turn[corner % self._n] < 0.0)
            length[stops], other[stops] = 0.0, beside[stops] % self._n

    def _are_own(self, cell: Int64Array, place: Float64Array, edge: Int64Array) -> BoolArray:
        """Tell which edges rays begin at."""
        number, is_edge = cell % self._n, cell < self._n
        is_before = edge == (number - 1) % self._n
        is_behind = edge == (number + 1) % self._n
        is_own = (edge == number) | (is_before & (~is_edge | (place == 0.0)))
        is_own |= is_edge & is_behind & (place == self._lengths[number])
        return np.asarray(is_own, np.bool_)

    def _touch(
        self, foot: Float64Array, way: Float64Array, edge: Int64Array
    ) -> tuple[Float64Array, Int64Array]:
        """Return how far rays go until their circles touch edges, and the cells that they touch."""
        behind = (edge + 1) % self._n
        along, out = self._along[edge], self._out[edge]
        apart = foot - self._ring[edge]
        beyond = (apart * out).sum(axis=1)
        out, beyond = out * np.sign(beyond)[:, None], np.abs(beyond)  # from either side
        with np.errstate(divide="ignore", invalid="ignore"):
            length = 2.0 * beyond / ((way - out) ** 2).sum(axis=1)
            place = ((apart + length[:, None] * way) * along).sum(axis=1)
        is_inner = (beyond > 0.0) & (place > 0.0) & (place < self._lengths[edge])
        ends = np.stack(
            [self._touch_corner(foot, way, edge), self._touch_corner(foot, way, behind)]
        )
        touched = self._n + np.where(ends[0] <= ends[1], edge, behind)
        return np.where(is_inner, length, ends.min(axis=0)), np.where(is_inner, edge, touched)

    def _touch_corner(
        self, foot: Float64Array, way: Float64Array, corner: Int64Array
    ) -> Float64Array:
        apart = self._ring[corner] - foot
        ahead = (apart * way).sum(axis=1)
        with np.errstate(divide="ignore", invalid="ignore"):
            length = (apart**2).sum(axis=1) / (2.0 * ahead)
        return np.where(ahead > 0.0, length, np.inf)

    def _reach_cells(
        self, foot: Float64Array, way: Float64Array, other: Int64Array
    ) -> Float64Array:
        """Return how far rays go until their circles touch other cells."""
        number = other % self._n
        found = np.where(
            other < self._n,
            self._touch(foot, way, number)[0],
            self._touch_corner(foot, way, number),
        )
        return np.where(other == _NONE, self._reach, found)

    def find_places_between(self, before: Rays, behind: Rays) -> Float64Array:
        """Return where in a cell, between two rays, a third one is needed; NaN for nowhere."""
        places = np.full(len(before.cell), np.nan)
        is_full = self.are_full(before) & self.are_full(behind)
        if is_full.any():
            places[is_full] = self._find_intruders(before.take(is_full), behind.take(is_full))
        is_known = self._include(before.other, behind.other)
        is_known |= self._include(behind.other, before.other)
        lacks = ~is_full & ~is_known
        places[lacks] = self._find_corners(before.take(lacks), behind.take(lacks))
        places[~self._are_apart(before, behind)] = np.nan
        return places

    def are_full(self, rays: Rays) -> BoolArray:
        return np.asarray(rays.length >= self._reach * (1.0 - _FREE), np.bool_)

    def _find_intruders(self, before: Rays, behind: Rays) -> Float64Array:
        """Return the places of rays, between others of full length, that end the earliest."""
        import shapely

        ends = np.stack([before.ends, behind.ends], axis=1)
        chords = shapely.linestrings(ends)
        near = self._reach * (1.0 - _FREE)
        chord, edge = self._tree.query(chords, predicate="dwithin", distance=near)
        own = self._are_own(before.cell[chord], np.zeros(len(chord)), edge)
        own |= self._are_own(before.cell[chord], self._lengths[before.cell[chord] % self._n], edge)
        chord, edge = chord[~own], edge[~own]
        ways = shapely.shortest_line(chords[chord], self._tree.geometries[edge])
        order = np.lexsort((shapely.length(ways), chord))
        place = np.full(len(chords), np.nan)
        first = shapely.get_coordinates(ways).reshape(-1, 2, 2)[order, 0]
        chord = chord[order]
        along = ends[chord, 1] - ends[chord, 0]
        share = ((first - ends[chord, 0]) * along).sum(axis=1) / (along**2).sum(axis=1)
        chord, at = np.unique(chord, return_index=True)
        place[chord] = before.place[chord] + share[at] * (behind.place - before.place)[chord]
        return place

    def _include(self, one: Int64Array, other: Int64Array) -> BoolArray:
        """Tell which cells are others, or those of edges at whose ends the others are."""
        is_end = (other == one + self._n) | (other == (one + 1) % self._n + self._n)
        return np.asarray((one == other) | ((one != _NONE) & (one < self._n) & is_end), np.bool_)

    def is_new(self, between: Rays, before: Rays, behind: Rays) -> BoolArray:
        """Tell which rays, amid others, are of a third kind, or of full length beside another."""
        is_known = self._include(before.other, between.other)
        is_known |= self._include(behind.other, between.other)
        is_full = self.are_full(between)
        is_beside_full = self.are_full(before) | self.are_full(behind)
        is_earlier = self.are_full(before) & self.are_full(behind) & ~is_full
        is_inner = self._are_apart(before, between) & self._are_apart(between, behind)
        return np.asarray(
            (~is_known | is_earlier | (is_full & is_beside_full)) & is_inner, np.bool_
        )

    def _are_apart(self, before: Rays, behind: Rays) -> BoolArray:
        is_edge = before.cell < self._n
        scale = np.where(is_edge, self._lengths[before.cell % self._n], 1.0)
        return np.asarray(behind.place - before.place > _SHARE * scale, np.bool_)

    def _find_corners(self, before: Rays, behind: Rays) -> Float64Array:
        """Return where rays end at both of the cells that neighbouring rays end at."""
        low, high = before.place.copy(), behind.place.copy()
        for _ in range(_HALVINGS):
            middle = 0.5 * (low + high)
            foot, way = self._place_rays(before.cell, middle)
            is_before = self._reach_cells(foot, way, before.other) <= self._reach_cells(
                foot, way, behind.other
            )
            low, high = np.where(is_before, middle, low), np.where(is_before, high, middle)
        return 0.5 * (low + high)

    def turn_round(self, rays: Rays) -> Rays:
        """Return the rays from where others end at back to the same places."""
        number, is_edge = rays.other % self._n, rays.other < self._n
        ends = rays.ends
        apart = ends - self._ring[number]
        along, first = self._along[number], self._out[number - 1]
        place = np.clip((apart * along).sum(axis=1), 0.0, self._lengths[number])
        cross = first[:, 0] * apart[:, 1] - first[:, 1] * apart[:, 0]
        angle = np.arctan2(cross, (first * apart).sum(axis=1))
        angle = np.clip(angle, 0.0, np.maximum(self._turn[number], 0.0))
        place = np.where(is_edge, place, angle)
        foot, way = self._place_rays(rays.other, place)
        length = ((ends - foot) * way).sum(axis=1)
        return Rays(rays.other, place, foot, way, length, rays.cell)

    def find_free(self, rays: Rays) -> BoolArray:
        """Tell between which rays and the next of their cells nothing is within the reach."""
        is_full = self.are_full(rays)
        free = np.append((rays.cell[1:] == rays.cell[:-1]) & is_full[1:] & is_full[:-1], False)
        place = 0.5 * (rays.place[:-1] + rays.place[1:])[free[:-1]]
        free[free] = self.are_full(self.trace(rays.cell[free], place))
        return np.asarray(free, np.bool_)
