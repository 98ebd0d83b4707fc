"""Lines across flowing water, square to its centreline, and where they would meet."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ....base.errors import OptionError

if TYPE_CHECKING:
    from ....base.arrays import BoolArray, Float64Array, Int64Array
    from .centrelines import Centreline
    from .waters import Waters

_HALVINGS = 52
_FINEST = 1e-6
"""Of the spacing and of the width of the water: nodes are farther apart, steps larger."""
_MOST_SAMPLES = 200_000
"""Of shores, on which the nearest station is looked for."""
_ROUNDINGS = 4096.0
"""Of the largest coordinate: how far a place may be from being nearest to its own station."""
_MOST_NODES = 1_000_000
"""So many stations get a line across; more are a slip of the spacing."""


class Rays(NamedTuple):
    """Straight lines away from stations of a centreline, square to it."""

    nodes: Int64Array
    """(r,), the station of each, by its number."""
    starts: Float64Array
    """(r, 2), on the centreline."""
    ways: Float64Array
    """(r, 2), unit vectors."""

    def places_at(self, rays: Int64Array, distances: Float64Array) -> Float64Array:
        """Return places on rays."""
        return self.starts[rays] + distances[:, None] * self.ways[rays]


class StationJumps(NamedTuple):
    """Places on shores at which the station that is the nearest changes by a step."""

    places: Float64Array
    """(c, 2)."""
    spans: Float64Array
    """(c, 2), from which station to which."""


class CrossLines(NamedTuple):
    """Stations, and lines across the water at them."""

    stations: Float64Array
    """(n,), ascending."""
    groups: Int64Array
    """(n,), ascending; those of one group have one level, since places nearest to them touch."""
    nodes: Int64Array
    """(p,), of each line."""
    lines: Float64Array
    """(p, 2, 2), from the centreline, or from an island, to a shore."""
    starts_inside: BoolArray
    """(p,), whether a line begins on the centreline."""
    corners: Float64Array
    """(c, 2), places on shores where the nearest station changes by a step."""


def find_nodes(centreline: Centreline, spacing: float) -> Float64Array:
    """Return the stations of vertices, and between them no more than a spacing apart."""
    lengths = np.diff(centreline.stations)
    if lengths.sum() / spacing > _MOST_NODES:
        least = float(lengths.sum()) / _MOST_NODES
        allowed = f"{least:.3g} or more here, where at most {_MOST_NODES:,} lines across are made"
        raise OptionError("spacing", spacing, allowed)
    counts = np.maximum(np.ceil(np.round(lengths / spacing, 9)), 1).astype(int)
    pieces = [
        np.linspace(start, stop, count + 1)[:-1]
        for start, stop, count in zip(
            centreline.stations[:-1], centreline.stations[1:], counts, strict=True
        )
    ]
    return np.concatenate([*pieces, centreline.stations[-1:]])


def make_cross_lines(waters: Waters, centreline: Centreline, spacing: float) -> CrossLines:
    """Make lines across the water, square to the centreline, that do not meet.

    Places in the water belong to the station of the centreline that is nearest. Where it turns,
    those on the inner side of stations before and behind the bend touch: they become one group.
    """
    import shapely

    shore = shapely.get_coordinates(waters.shape)
    reach = 1.0 + float(shapely.distance(shapely.points(shore), centreline.line).max())
    near = _ROUNDINGS * float(np.spacing(np.abs(centreline.points).max() + reach))
    apart = max(near, _FINEST * min(spacing, waters.width))
    jumps = find_station_jumps(waters, centreline, spacing, apart)
    stations = _join(find_nodes(centreline, spacing), jumps.spans.ravel(), apart)
    rays = _make_normals(centreline, stations, near)
    of, begins, ends = _cut_rays(rays, waters, centreline, reach=reach, near=near)
    groups, is_inner = _group(stations, jumps.spans, 2.0 * apart)
    kept = (ends - begins > near) & ~is_inner[rays.nodes[of]]
    chosen = of[kept]
    starts = rays.places_at(chosen, begins[kept])
    inside = begins[kept] <= near
    starts[inside] = rays.starts[chosen[inside]]
    lines = np.stack([starts, rays.places_at(chosen, ends[kept])], axis=1)
    return CrossLines(stations, groups, rays.nodes[chosen], lines, inside, jumps.places)


def find_station_jumps(
    waters: Waters, centreline: Centreline, spacing: float, apart: float
) -> StationJumps:
    """Find where shores meet the medial axis of the centreline.

    Along a shore the nearest station goes from one segment to the next, or to a vertex between
    them, without a step, or it leaves them out: where it changes is found by halving.
    """
    import shapely

    rings = shapely.get_rings(shapely.get_parts(waters.shape))
    length = float(shapely.length(rings).sum())
    step = max(min(0.5 * spacing, waters.width / 4.0), length / _MOST_SAMPLES)
    paths = [shapely.get_coordinates(one) for one in shapely.segmentize(rings, step)]
    start = np.concatenate([path[:-1] for path in paths])
    way = np.concatenate([np.diff(path, axis=0) for path in paths])

    def measure(of: Int64Array, share: Float64Array) -> tuple[Float64Array, Int64Array]:
        places = shapely.points(start[of] + share[:, None] * way[of])
        stations = np.asarray(shapely.line_locate_point(centreline.line, places))
        segment = centreline.find_segments(stations)
        after = stations - centreline.stations[segment] <= apart
        before = centreline.stations[segment + 1] - stations <= apart
        return stations, 2 * segment - after + before

    every = np.arange(len(start))
    label = measure(every, np.zeros(len(every)))[1]
    last = measure(every, np.ones(len(every)))[1]
    share = np.zeros(len(every))
    active = np.flatnonzero(label != last)
    places, spans = [], []
    while len(active):
        low, high = share[active], np.ones(len(active))
        for _ in range(_HALVINGS):
            middle = 0.5 * (low + high)
            is_same = measure(active, middle)[1] == label[active]
            low, high = np.where(is_same, middle, low), np.where(is_same, high, middle)
        (one, _), (other, found) = measure(active, low), measure(active, high)
        steps = np.abs(other - one) > 4.0 * apart
        spans.append(np.sort(np.column_stack([one, other])[steps], axis=1))
        places.append(start[active[steps]] + high[steps, None] * way[active[steps]])
        share[active], label[active] = high, found
        active = active[(found != last[active]) & (high < 1.0)]
    empty = np.empty((0, 2))
    return StationJumps(np.concatenate([empty, *places]), np.concatenate([empty, *spans]))


def _join(nodes: Float64Array, others: Float64Array, apart: float) -> Float64Array:
    """Return stations in order, without others that are too near to one before."""
    near = np.clip(np.searchsorted(nodes, others), 1, len(nodes) - 1)
    gaps = np.minimum(np.abs(nodes[near - 1] - others), np.abs(nodes[near] - others))
    more = np.unique(others[gaps > apart])
    more = more[np.append(True, np.diff(more) > apart)] if len(more) else more
    return np.sort(np.concatenate([nodes, more]))


def _make_normals(centreline: Centreline, stations: Float64Array, near: float) -> Rays:
    """Return rays to both sides at stations, at vertices square to both segments."""
    segment = centreline.find_segments(stations)
    at_vertex = (stations - centreline.stations[segment] <= near) & (segment > 0)
    nodes = np.concatenate([np.arange(len(stations)), np.flatnonzero(at_vertex)])
    of = np.concatenate([segment, segment[at_vertex] - 1])
    along = centreline.directions[of]
    left = np.column_stack([-along[:, 1], along[:, 0]])
    starts = centreline.places_at(stations)[nodes]
    return Rays(
        np.concatenate([nodes, nodes]),
        np.concatenate([starts, starts]),
        np.concatenate([left, -left]),
    )


def _cut_rays(
    rays: Rays, waters: Waters, centreline: Centreline, *, reach: float, near: float
) -> tuple[Int64Array, Float64Array, Float64Array]:
    """Return the parts of rays in the water, where their own station is the nearest.

    They are the ray of each, and the distances from which to which it goes along it.
    """
    import shapely

    every = np.arange(len(rays.nodes))
    whole = shapely.linestrings(
        np.stack([rays.starts, rays.places_at(every, np.full(len(every), reach))], axis=1)
    )
    pieces, of = shapely.get_parts(shapely.intersection(whole, waters.shape), return_index=True)
    is_line = (shapely.get_dimensions(pieces) == 1) & ~shapely.is_empty(pieces)
    pieces, of = pieces[is_line], of[is_line]
    ends = [shapely.get_coordinates(shapely.get_point(pieces, k)) for k in (0, -1)]
    away = np.stack(
        [((end.reshape(-1, 2) - rays.starts[of]) * rays.ways[of]).sum(axis=1) for end in ends], 1
    )
    away = np.maximum(np.sort(away, axis=1), 0.0)
    is_own = np.ones(len(of), np.bool_)
    for distances in away.T:
        places = shapely.points(rays.places_at(of, distances))
        is_own &= shapely.distance(places, centreline.line) >= distances - near
    return of[is_own], away[is_own, 0], away[is_own, 1]


def _group(
    stations: Float64Array, spans: Float64Array, near: float
) -> tuple[Int64Array, BoolArray]:
    """Return the group of each station, and which are within a span, not at its ends.

    Spans hold the stations between their ends, and the next ones outwards where an end is none.
    """
    first = np.searchsorted(stations, spans[:, 0] + near, side="right") - 1
    last = np.searchsorted(stations, spans[:, 1] - near, side="left")
    first, last = np.clip([first, last], 0, len(stations) - 1)
    change = np.zeros(len(stations) + 1, np.int64)
    np.add.at(change, first, 1)
    np.add.at(change, np.maximum(last, first), -1)
    is_joined = np.cumsum(change)[:-1] > 0  # to the next one
    groups = np.concatenate([[0], np.cumsum(~is_joined[:-1])])
    is_inner = is_joined & np.append(False, is_joined[:-1])
    return groups.astype(np.int64), is_inner
