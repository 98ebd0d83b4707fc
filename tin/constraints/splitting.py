"""Splitting: cut the segments of lines where they touch and cross, and keep what is known."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...base.errors import LinesError
from .. import _kernel
from .polylines import Polylines

if TYPE_CHECKING:
    from ...base.arrays import AnyArray, BoolArray, Float64Array, Int32Array, Int64Array

MOST_ROUNDS = 1000  # cascades of roundings end after a few

_FREE_ROUNDS = 12
"""Rounds after which lines that cross near an end of one of them meet at that end."""
_NEAR = 4.0
"""How near that is: spacings of the largest coordinate, along x and along y."""


class Segments(NamedTuple):
    """Segments of all polylines, and the distinct edges along which they run.

    Two lines that share a part have four segments on three edges. What touches or crosses an edge
    is found once, and splits all of its segments::

        line 0    u ---> v ---> w             position   0  1  2   3  4  5
        line 1           v <--- w <--- x      vertex     u  v  w   x  w  v

        start     0    1    3    4            edges      u-v  v-w  w-x
        edge      u-v  v-w  w-x  v-w
        backward  no   no   yes  yes
    """

    start: Int64Array
    """(s,), position from which each segment goes."""
    edge: Int64Array
    """(s,), the edge of each segment, to which others may belong."""
    is_backward: BoolArray
    """(s,), whether it goes from the edge's second end to the first."""
    keys: Int64Array
    """(m,), of the edges, ascending: both vertex numbers in one."""
    ends: Int32Array
    """(m, 2), vertices of each edge, the first by x, then y, in front."""
    first_segment: Int64Array
    """(m,), the first segment along each edge."""

    @classmethod
    def along(cls, polylines: Polylines, xy: Float64Array) -> Segments:
        """Take the polylines apart."""
        start = polylines.starts()
        a, b = (polylines.vertices[at].astype(np.int64) for at in (start, start + 1))
        keys, first_segment, edge = np.unique(
            _make_keys(np.minimum(a, b), np.maximum(a, b)), return_index=True, return_inverse=True
        )
        ends = np.stack(_split_keys(keys), axis=1).astype(np.int32)
        swapped = is_before(xy[ends[:, 1]], xy[ends[:, 0]])
        ends[swapped] = ends[swapped, ::-1]
        return cls(start, edge, ends[edge, 0] != a, keys, ends, first_segment)


def drop_repeats(polylines: Polylines, elevations: Float64Array) -> tuple[Polylines, Float64Array]:
    """Count repeated vertices in a row once, by their lowest elevation.

    Where a polyline closes, too: snapping may have merged the first vertex with the next ones.
    """
    moves = np.ones(len(polylines.vertices), np.bool_)
    moves[1:] = np.diff(polylines.vertices) != 0
    first = polylines.offsets[:-1][polylines.lengths > 0]
    moves[first] = True
    starts = np.flatnonzero(moves)
    lowest = np.minimum.reduceat(elevations, starts) if len(starts) else elevations
    ends = _find_closing_ends(polylines, elevations)
    run = np.searchsorted(starts, ends, side="right") - 1
    lowest[run] = lowest[run].min(axis=0)
    return polylines.choose_positions(moves), lowest


def _find_closing_ends(polylines: Polylines, elevations: Float64Array) -> Int64Array:
    """Return where polylines begin and end that close with one elevation, (2, c).

    Others keep both of their elevations: a ramp may end above its begin.
    """
    offsets = polylines.offsets.astype(np.int64)
    ends = np.stack([offsets[:-1], offsets[1:] - 1])[:, polylines.lengths > 0]
    (a, b), (z_a, z_b) = polylines.vertices[ends], elevations[ends]
    return ends[:, (a == b) & (z_a == z_b)]


def _make_keys(first: AnyArray, second: AnyArray) -> Int64Array:
    """Make one number of two below 2^31."""
    key: Int64Array = (first.astype(np.int64) << 32) | second
    return key


def _split_keys(keys: Int64Array) -> tuple[Int64Array, Int64Array]:
    return keys >> 32, keys & 0xFFFFFFFF


def _is_in(keys: Int64Array, known: Int64Array) -> BoolArray:
    """Tell which of the keys are among the known ones; both ascend."""
    if len(known) == 0:
        return np.zeros(len(keys), np.bool_)
    at = np.minimum(np.searchsorted(known, keys), len(known) - 1)
    found: BoolArray = known[at] == keys
    return found


class Splitting:
    """Polylines that are being split, and what is known about them.

    ``xy`` are the vertices, (n, 2), first the given ones, then those made where lines cross, which
    are ``crossing_vertices``. Of each position ``elevations`` has the line's own, NaN if it has
    none, and ``is_given`` tells whether the line names the vertex itself.
    """

    def __init__(
        self,
        xy: Float64Array,
        polylines: Polylines,
        elevations: Float64Array,
        snap: float,
        threads: int,
    ) -> None:
        self.xy = xy
        self.n_given = len(self.xy)
        self.polylines, self.elevations = drop_repeats(polylines, elevations)
        self.is_given = np.ones(len(self.elevations), np.bool_)
        self.segments = Segments.along(self.polylines, self.xy)
        self.crossing_vertices = np.empty(0, np.int32)
        self._snap = snap
        self._threads = threads
        self._is_rounded = False  # whether vertices within a rounding of an edge are on it
        self._untouched = np.empty(0, np.int64)  # edges that the first vertices do not touch
        self._n_touched = 0  # the number of those vertices
        self._uncrossed = np.empty(0, np.int64)  # edges that do not cross one another

    def split_everywhere(self, refuse: Callable[[Int64Array], LinesError] | None = None) -> None:
        """Split segments where they touch and cross until nothing does.

        ``refuse`` makes the error of pairs of edges that cross, if they must not.
        """
        self.split_at_touches()
        for number in range(MOST_ROUNDS):
            pairs = self.find_crossings()
            if len(pairs) == 0:
                return
            if refuse is not None:
                raise refuse(pairs)
            self.split_at_crossings(pairs, at_ends=number >= _FREE_ROUNDS)
            self.split_at_touches()
        raise explain_endless()

    # ---------------------------------------------------------------- touches

    def split_at_touches(self) -> None:
        """Split segments at the vertices on them until there is none."""
        for _ in range(MOST_ROUNDS):
            edge, vertex = self._find_touches()
            bends = self._snap > 0 or self._is_rounded
            if len(edge) and bends:
                edge, vertex = self._keep_shortening(edge, vertex)
            if len(edge):
                self._split(edge, vertex, bends=bends)
            if len(edge) == 0 or not bends:  # exact splits leave no touches
                self._untouched = self.segments.keys
                self._n_touched = len(self.xy)
                return
        raise explain_endless()

    def _find_touches(self) -> tuple[Int64Array, Int32Array]:
        """Ask new edges about all vertices, known ones about new vertices."""
        if self._n_touched == 0:
            return self._find_contacts()
        is_known = _is_in(self.segments.keys, self._untouched)
        found = []
        for asked, first in ((~is_known, 0), (is_known, self._n_touched)):
            numbers = np.flatnonzero(asked)
            ends = self.segments.ends[numbers]
            if len(numbers) and first < len(self.xy):
                pairs = _kernel.touches(
                    self.xy, ends, self._snap, first, self._is_rounded, self._threads
                )
                found.append((numbers[pairs[:, 0]], pairs[:, 1]))
        if not found:
            return np.empty(0, np.int64), np.empty(0, np.int32)
        edge, vertex = (np.concatenate(column) for column in zip(*found, strict=True))
        return edge, vertex

    def _find_contacts(self) -> tuple[Int64Array, Int32Array]:
        """Ask all edges about all, and note those that cross none."""
        ends = self.segments.ends
        crossings, touches = _kernel.contacts(self.xy, ends, self._snap, self._threads)
        crossed = np.zeros(len(ends), np.bool_)
        crossed[crossings.ravel()] = True
        touched = np.zeros(len(ends), np.bool_)
        touched[touches[:, 0]] = True
        self._uncrossed = self.segments.keys[~crossed]
        self._untouched = self.segments.keys[~touched]
        self._n_touched = len(self.xy)
        return touches[:, 0].astype(np.int64), touches[:, 1]

    def _keep_shortening(
        self, edge: Int64Array, vertex: Int32Array
    ) -> tuple[Int64Array, Int32Array]:
        """Keep all touches of an edge if that leaves shorter parts, else only the nearest.

        ::

                   p                    a-p, p-q and q-b are all shorter than a-b: both are kept.
            a ---------- q ---- b       If a part were not, only q would be, as it is the nearest
                                        to the line, and a-q and q-b would be looked at again.
        """
        edge, vertex = self._sort_along(edge, vertex, bends=True)
        a, b, p = self._get_ends_and_points(edge, vertex)
        is_first = np.append(True, np.diff(edge) != 0)
        before = np.where(is_first[:, None], a, np.roll(p, 1, axis=0))
        after = np.where(np.roll(is_first, -1)[:, None], b, np.roll(p, -1, axis=0))
        whole = _measure_square(a, b)
        grows = (_measure_square(before, p) >= whole) | (_measure_square(p, after) >= whole)
        keep = ~np.isin(edge, edge[grows])
        u, v = b - a, p - a
        area: Float64Array = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
        nearest = np.lexsort((p[:, 1], p[:, 0], np.abs(area), edge))
        keep[nearest[is_first]] = True  # both orders are by edge first
        return edge[keep], vertex[keep]

    # ---------------------------------------------------------------- crossings

    def find_crossings(self) -> Int64Array:
        """Return the pairs of distinct edges that cross, (c, 2)."""
        is_known = _is_in(self.segments.keys, self._uncrossed)
        if is_known.all():
            return np.empty((0, 2), np.int64)
        order = np.argsort(~is_known, kind="stable")
        pairs = _kernel.crossings(
            self.xy, self.segments.ends[order], int(is_known.sum()), self._threads
        )
        if len(pairs) == 0:
            self._uncrossed = self.segments.keys
        crossing: Int64Array = np.sort(order[pairs], axis=1)
        return crossing

    def split_at_crossings(self, pairs: Int64Array, *, at_ends: bool = False) -> None:
        """Split the edges of all pairs where they cross, or at an end that is near to it."""
        points = self.find_crossing_points(pairs)
        if at_ends:
            points = self._move_to_ends(pairs, points)
        order = np.lexsort((points[:, 1], points[:, 0]))
        is_first = np.append(True, (np.diff(points[order], axis=0) != 0).any(axis=1))
        distinct = points[order[is_first]]
        vertices = _kernel.vertices_at(self.xy, distinct)
        is_new = vertices < 0
        vertices[is_new] = len(self.xy) + np.arange(is_new.sum(), dtype=np.int32)
        self.xy = np.concatenate([self.xy, distinct[is_new]])
        self.crossing_vertices = np.union1d(self.crossing_vertices, vertices)
        number = np.empty(len(points), np.int32)
        number[order] = vertices[np.cumsum(is_first) - 1]
        vertex = np.repeat(number, 2)
        edge = pairs.ravel()
        inside = (self.segments.ends[edge] != vertex[:, None]).all(axis=1)
        split, at = _split_keys(np.unique(_make_keys(edge[inside], vertex[inside])))
        # Of every pair at least one is split: the others do not cross one another.
        uncrossed = np.ones(len(self.segments.keys), np.bool_)
        uncrossed[split] = False
        self._uncrossed = self.segments.keys[uncrossed]
        self._split(split, at.astype(np.int32), bends=False)
        self._is_rounded = True

    def _move_to_ends(self, pairs: Int64Array, points: Float64Array) -> Float64Array:
        """Replace crossings a few roundings from ends of their edges by the nearest of these ends.

        Three lines can pass a crossing on for ever, each time by one rounding: where a bends onto
        b, c crosses what is left of a, where c bends onto b, a crosses what is left of c.
        """
        ends = self.xy[self.segments.ends[pairs]].reshape(-1, 4, 2)
        spacing = np.spacing(np.abs(ends).max(axis=(1, 2)))[:, None]
        far = np.abs(ends - points[:, None]).max(axis=2) / spacing
        nearest = np.lexsort((ends[..., 1], ends[..., 0], far), axis=1)[:, 0]
        rows = np.arange(len(points))
        is_near = far[rows, nearest] <= _NEAR
        moved: Float64Array = np.where(is_near[:, None], ends[rows, nearest], points)
        return moved

    def find_crossing_points(self, pairs: Int64Array) -> Float64Array:
        """Return where the edges of each pair cross, (c, 2)."""
        return _kernel.intersections(self.xy, self.segments.ends, pairs.astype(np.int32))

    # ---------------------------------------------------------------- splitting

    def _split(
        self,
        edge: Int64Array,
        vertex: Int32Array,
        *,
        bends: bool,
    ) -> None:
        """Split every segment along an edge at the vertices given with it.

        The vertices of an edge are one run of rows, from its first end to its second; a segment
        that goes backwards reads its run from the end::

            row                 4  5  6             edge a-b is split at r, s, t
            vertex              r  s  t

            a -> r -> s -> t -> b   nth 0 1 2   row 4 5 6
            b -> t -> s -> r -> a   nth 0 1 2   row 6 5 4     (is_backward)
        """
        segments = self.segments
        edge, vertex = self._sort_along(edge, vertex, bends=bends)
        count = np.bincount(edge, minlength=len(segments.keys))
        first = np.cumsum(count) - count
        segment = np.repeat(np.arange(len(segments.start)), count[segments.edge])
        nth = np.arange(len(segment)) - np.searchsorted(segment, segment)
        on = segments.edge[segment]
        row = first[on] + np.where(segments.is_backward[segment], count[on] - 1 - nth, nth)
        at, vertex = segments.start[segment], vertex[row]
        elevations = self.interpolate_elevations(segment, self.xy[vertex])
        self.elevations = np.insert(self.elevations, at + 1, elevations)
        self.is_given = np.insert(self.is_given, at + 1, values=False)
        self.polylines = self.polylines.insert(at, vertex)
        self.segments = Segments.along(self.polylines, self.xy)

    def _sort_along(
        self, edge: Int64Array, vertex: Int32Array, *, bends: bool
    ) -> tuple[Int64Array, Int32Array]:
        """Sort by edge, then from its first end to the second.

        Rounding is monotone: exact places and rounded crossings are in order by x and by y. Where
        lines bend, the projection decides; of two places across an upright or level edge, which
        are then equally far along it, the coordinates.
        """
        a, b, p = self._get_ends_and_points(edge, vertex)
        x, y = (np.sign(b - a) * p).T
        keys = (*p.T, y, x, _project(a, b, p)) if bends else (y, x)
        order = np.lexsort((*keys, edge))
        return edge[order], vertex[order]

    def _get_ends_and_points(
        self, edge: Int64Array, vertex: Int32Array
    ) -> tuple[Float64Array, ...]:
        first, second = self.segments.ends[edge].T
        return self.xy[first], self.xy[second], self.xy[vertex]

    def interpolate_elevations(self, segment: Int64Array, points: Float64Array) -> Float64Array:
        """Interpolate the elevations of segments at places on them; the same both ways."""
        start, backward = self.segments.start[segment], self.segments.is_backward[segment]
        first, second = self.segments.ends[self.segments.edge[segment]].T
        a, b = self.xy[first], self.xy[second]
        z_a = self.elevations[start + backward]
        z_b = self.elevations[start + ~backward]
        return interpolate_linearly(z_a, z_b, _project(a, b, points) / _measure_square(a, b))


def explain_endless() -> LinesError:
    """Return the error for lines that do not come to an end."""
    return LinesError(
        f"The lines still meet at new places after {MOST_ROUNDS} rounds of splitting: "
        "too many run within a rounding of one another; leave some of them out."
    )


# -------------------------------------------------------------------- measures


def interpolate_linearly(
    start: Float64Array, end: Float64Array, share: Float64Array
) -> Float64Array:
    """Return elevations between two, never beyond either; halved so that nothing overflows."""
    between = 2.0 * (start / 2 + share * (end / 2 - start / 2))
    return np.clip(between, np.minimum(start, end), np.maximum(start, end))


def _project(a: Float64Array, b: Float64Array, p: Float64Array) -> Float64Array:
    along: Float64Array = ((p - a) * (b - a)).sum(axis=1)
    return along


def _measure_square(a: Float64Array, b: Float64Array) -> Float64Array:
    square: Float64Array = ((b - a) ** 2).sum(axis=1)
    return square


def is_before(p: Float64Array, q: Float64Array) -> BoolArray:
    """Tell which places come before others by x, then y."""
    before: BoolArray = (p[:, 0] < q[:, 0]) | ((p[:, 0] == q[:, 0]) & (p[:, 1] < q[:, 1]))
    return before
