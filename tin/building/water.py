"""Water in a surface: shores are level, and what lies within them goes."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ..constraints import (
    ABOVE_ALL,
    LineSet,
    Polylines,
    build_mesh,
    find_crossings,
    gather_odd,
    walk_regions,
)
from ..predicates import orientation
from ..report import Overruled
from ..topology import edge_keys
from ..triangulation import Triangulation

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from ...base.arrays import BoolArray, Float64Array, Int32Array, Int64Array
    from ..constraints import Crossing

_OUTSIDE = -1
"""Region beyond the hull of all shores."""


def leave_out_water(
    points: Float64Array,
    polylines: Polylines,
    lines: LineSet,
    overruled: Overruled,
    *,
    threads: int,
) -> tuple[Polylines, BoolArray, Overruled]:
    """Put shores at the elevation of their water, in place, and leave out what is in it.

    Returns the polylines without the segments in water, but for those of boundaries and holes,
    which lie on it; (n,) flags of the vertices in water, which go; and what is overruled, with the
    elevations that the water overrules. Where several waters meet the last one tells the level.
    """
    wet = np.zeros(len(points), np.bool_)
    is_water = np.asarray(lines.priorities == ABOVE_ALL, np.bool_)
    if not is_water.any():
        return polylines, wet, overruled
    segments, line_of = polylines.segments(), polylines.segment_lines()
    along = np.flatnonzero(is_water[line_of])
    shores = along, line_of[along].astype(np.int64)
    levelled = _pair_ends(segments, shores)
    if _span_area(points[np.unique(levelled[:, 0])]):
        is_ring = lines.table.is_kind("boundary", "hole")[line_of]
        cover = _Cover(points, segments, shores, threads)
        in_water, held = cover.find_segments(is_ring)
        wet = cover.find_vertices(levelled)
        wet[segments[is_ring]] = False
        levelled = np.unique(np.concatenate([levelled, held]), axis=0)
        polylines = polylines.keep((is_ring | ~in_water) & ~wet[segments].any(axis=1))
    levels = lines.elevations[lines.offsets[:-1]]
    return polylines, wet, _set_levels(points, levelled, levels, overruled)


def _pair_ends(segments: Int32Array, shores: tuple[Int64Array, Int64Array]) -> Int64Array:
    """Return the ends of segments along shores with their waters, in order, (k, 2)."""
    along, waters = shores
    return np.unique(np.stack([segments[along].ravel(), np.repeat(waters, 2)], axis=1), axis=0)


def _span_area(points: Float64Array) -> bool:
    """Tell whether places do not all lie on one line."""
    x, y = (np.ascontiguousarray(points[:, k]) for k in (0, 1))
    rows = np.arange(len(points))
    ends = np.zeros_like(rows), np.full_like(rows, min(1, len(rows) - 1))
    return bool(orientation((x, y), *ends, rows).any())


def _set_levels(
    points: Float64Array, pairs: Int64Array, levels: Float64Array, overruled: Overruled
) -> Overruled:
    """Give vertices the levels of their waters, one after the other as the waters are given."""
    vertex, water = pairs.T  # by vertices, then by waters
    level = levels[water]
    is_first = np.append(True, vertex[1:] != vertex[:-1])[: len(vertex)]
    before = np.where(is_first, points[vertex, 2], np.roll(level, 1))
    points[vertex, 2] = level[np.searchsorted(vertex, vertex, side="right") - 1]
    wrong = np.flatnonzero(before != level)
    wrong = wrong[np.lexsort((vertex[wrong], water[wrong]))]
    return Overruled(
        np.append(overruled.vertices, vertex[wrong]).astype(np.int32),
        np.append(overruled.lines, np.full(len(wrong), -1, np.int32)),
        np.append(overruled.elevations, before[wrong]),
        np.append(overruled.vertex_elevations, level[wrong]),
    )


class _Cover:
    """The triangulation of all shores alone, and the regions between them.

    What lies strictly within a water is in it. On a shore, those are the waters that hold a region
    beside it, less those whose shores run there. Of all regions beside one is enough: that which
    the fewest waters hold.
    """

    def __init__(
        self,
        points: Float64Array,
        segments: Int32Array,
        shores: tuple[Int64Array, Int64Array],
        threads: int,
    ) -> None:
        """Of all vertices and segments; ``shores`` are segments along shores, and their waters."""
        along, waters = shores
        self._segments = segments
        self._used = np.unique(segments[along])
        number = np.full(len(points), -1, np.int32)
        number[self._used] = np.arange(len(self._used), dtype=np.int32)
        own = number[segments]
        self._is_own = np.asarray((own >= 0).all(axis=1), np.bool_)
        edges = own[self._is_own]
        lines = Polylines.whole(edges.ravel(), np.arange(0, edges.size + 1, 2))
        mesh = build_mesh(points[self._used], lines, threads=threads)
        self._surface = Triangulation(points[self._used], *mesh.arrays(threads))
        self._keys = edge_keys(own, len(self._used))
        self._shores = np.unique(np.stack([self._keys[along], waters], axis=1), axis=0)
        self._divide(gather_odd(self._keys[along], waters))
        self._places = self._locate(points)

    def _divide(self, toggles: dict[int, list[int]]) -> None:
        """Find the regions between shores, and how many waters hold each."""
        surface = self._surface
        corners = surface.triangles[:, [1, 2, 2, 0, 0, 1]].reshape(-1, 2)
        keys = edge_keys(corners, len(self._used))
        is_barrier = np.isin(keys, np.fromiter(toggles, np.int64, len(toggles)))
        self._region = surface.find_regions(is_barrier.reshape(-1, 3))[0]
        here, across = np.repeat(self._region, 3), surface.neighbors.ravel()
        there = np.where(across < 0, _OUTSIDE, self._region[across])
        is_hull, is_left = across < 0, is_barrier & (across >= 0)
        ways = find_crossings(
            np.concatenate([there[is_hull], here[is_left]]),
            np.concatenate([here[is_hull], there[is_left]]),
            np.concatenate([keys[is_hull], keys[is_left]]),
        )
        self._walk = partial(_walk, ways, toggles)
        self._count = np.zeros(int(self._region.max()) + 2, np.int64)  # the last is the outside
        for region, held_by in self._walk():
            self._count[region] = len(held_by)
        beside = np.where(self._count[there] < self._count[here], there, here)
        order = np.argsort(keys, kind="stable")
        self._edges = keys[order], beside[order]
        vertices, around = corners.ravel(), np.repeat(beside, 2)
        order = np.lexsort((self._count[around], vertices))
        self._around = around[order][np.unique(vertices[order], return_index=True)[1]]

    def _locate(self, points: Float64Array) -> Int32Array:
        """Return the region around each vertex, of those on shores one beside it."""
        xy, shores = points[:, :2], self._surface.points[:, :2]
        near = ((xy >= shores.min(axis=0)) & (xy <= shores.max(axis=0))).all(axis=1)
        near[self._used] = False
        places = np.full(len(points), _OUTSIDE, np.int32)
        locator = self._surface.locator
        triangle = locator.locate(np.ascontiguousarray(xy[near]))
        places[near] = np.where(triangle < 0, _OUTSIDE, self._region[triangle])
        places[self._used] = self._around
        return places

    def find_segments(self, is_listed: BoolArray) -> tuple[BoolArray, Int64Array]:
        """Tell which segments are in water, and return the ends of some with these waters.

        Of the segments ``is_listed`` those in water are listed: the pairs are (k, 2).
        """
        edges, beside = self._edges
        is_used = np.isin(self._segments, self._used)
        inner = np.where(is_used[:, 0], self._segments[:, 1], self._segments[:, 0])
        place = self._places[inner]
        place[self._is_own] = beside[np.searchsorted(edges, self._keys[self._is_own])]
        keys = np.where(self._is_own, self._keys, -1)
        found = _Items.of(place, keys, self._shores)
        in_water = self._are_within(found)
        pairs = [np.zeros((0, 2), np.int64)]
        for item, waters in self._visit(found, is_listed & in_water):
            held = np.array(sorted(waters - found.shores_at(item)), np.int64)
            ends = np.repeat(self._segments[item], len(held))
            pairs.append(np.stack([ends, np.tile(held, 2)], axis=1))
        return in_water, np.concatenate(pairs)

    def find_vertices(self, on_shores: Int64Array) -> BoolArray:
        """Tell which vertices are in water; ``on_shores`` has vertices with waters, (k, 2)."""
        return self._are_within(_Items.of(self._places, np.arange(len(self._places)), on_shores))

    def _are_within(self, items: _Items) -> BoolArray:
        within = np.asarray(self._count[items.place] > 0, np.bool_)
        for item, waters in self._visit(items, within & (items.low < items.high)):
            within[item] = not waters <= items.shores_at(item)
        return within

    def _visit(self, items: _Items, is_chosen: BoolArray) -> Iterator[tuple[int, set[int]]]:
        """Yield chosen items with the waters that hold their regions."""
        chosen = np.flatnonzero(is_chosen)
        chosen = chosen[np.argsort(items.place[chosen], kind="stable")]
        if len(chosen) == 0:
            return
        begins = np.searchsorted(items.place[chosen], np.arange(len(self._count))).tolist()
        for region, waters in self._walk():
            for item in chosen[begins[region] : begins[region + 1]].tolist():
                yield item, waters


class _Items(NamedTuple):
    """Vertices or segments: a region beside each, and the shores that run there."""

    place: Int32Array
    low: Int64Array
    high: Int64Array
    waters: Int64Array

    @classmethod
    def of(cls, place: Int32Array, keys: Int64Array, shores: Int64Array) -> _Items:
        """Make them of their keys; ``shores`` are pairs of a key and a water, sorted."""
        low, high = (np.searchsorted(shores[:, 0], keys, side=side) for side in ("left", "right"))
        return cls(place, low, high, shores[:, 1])

    def shores_at(self, item: int) -> set[int]:
        """Return the waters whose shores run at an item."""
        return set(self.waters[self.low[item] : self.high[item]].tolist())


def _walk(
    ways: Mapping[int, Sequence[Crossing]], toggles: Mapping[int, Sequence[int]]
) -> Iterator[tuple[int, set[int]]]:
    """Yield all regions with the waters that hold each, but for what lies outside."""
    seen = set()

    def enters(region: int) -> bool:
        is_new = region not in seen
        seen.add(region)
        return is_new

    waters: set[int] = set()
    for region in walk_regions(_OUTSIDE, waters, ways, toggles, enters):
        if region != _OUTSIDE:
            yield region, waters
