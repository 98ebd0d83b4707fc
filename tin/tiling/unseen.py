"""What a task has not seen, and what of it may put an end to a triangle.

A triangle of some points and segments is one of the whole if it meets no other segment, and its
closed circumscribed disc holds no other point, and no end of another segment. What segments hide
from all of the triangle does not count: see :mod:`.visibility`. Where there is too much to be seen,
less is told: beyond an edge that is a segment all in the disc is hidden, of which it is a chord;
beyond other segments, what is in the shadow of one::

             . - ~ - .
          .     p     .       p does not count if the edge a-b is a segment, nor if a longer one
         a-------------b      runs between them: no line of sight from the triangle to p misses it
          .           .
            ` - c - `
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from .. import _kernel
from .circles import Discs
from .sources import NumberedPoints, NumberedSegments
from .visibility import Views, are_met, are_seen

if TYPE_CHECKING:
    from ...base.arrays import BoolArray, Float64Array, Int8Array, Int64Array
    from .sources import PointSource, SegmentSource

_FEW, _ROUNDS_OF_FEW = 64, 4
"""What is taken for one disc in each of the first rounds; from then on twice as much each time.

A triangle between several lines is of the whole though its disc holds any number of points that
only all of these lines together hide: then nothing that is taken changes it.
"""

_MOST_SCREENS = 8

_SLACK = 2.0**-48
"""Of distances, relative to all that they are computed from: far more than their roundings."""


class UnsettledTriangles(NamedTuple):
    """Triangles that something unseen may put an end to.

    Attributes
    ----------
    corners : (k, 3, 2) float64 array
        Counter-clockwise.
    hiding : (k, 3) bool array
        Whether the edge opposite each corner is a segment.
    discs : Discs
    screens : (s, 2, 2) float64 array
        The ends of all segments that are known.
    views : Views
        What is seen from each of them, as far as it is known.
    most : int
        What is taken for one disc: the deepest, which change the triangle most.
    """

    corners: Float64Array
    hiding: BoolArray
    discs: Discs
    screens: Float64Array
    views: Views
    most: int

    def choose(self, which: BoolArray) -> UnsettledTriangles:
        """Return some of the triangles."""
        return UnsettledTriangles(
            self.corners[which],
            self.hiding[which],
            self.discs.choose(which),
            self.screens,
            self.views.choose(which),
            self.most,
        )

    def are_deciding(self, k: int, places: Float64Array) -> BoolArray:
        """Tell which places, (f, 2), are in the disc of a triangle and not hidden from it."""
        view = self.views.corners[k]
        is_deciding = np.ones(len(places), np.bool_) if view is None else are_seen(view, places)
        is_deciding[is_deciding] = _are_in_disc(self.corners[k], places[is_deciding])
        if view is None:
            is_deciding[is_deciding] = ~self.find_hidden(k, places[is_deciding][:, None])
        return is_deciding

    def find_hidden(self, k: int, figures: Float64Array) -> BoolArray:
        """Tell what is hidden from a triangle, of the hulls of (f, p, 2) places each, exactly."""
        is_hidden = _are_beyond_edges(self.corners[k], self.hiding[k], figures)
        for screen in self._choose_screens(k) if len(figures) else ():
            left = np.flatnonzero(~is_hidden)
            is_hidden[left] = _are_in_shadow(self.corners[k], screen, figures[left])
        return is_hidden

    def _choose_screens(self, k: int) -> Float64Array:
        """Return the longest of the segments whose bounds meet those of a disc."""
        center, radius = self.discs.centers[k], self.discs.radii[k]
        low, high = self.screens.min(axis=1), self.screens.max(axis=1)
        is_near = ((low <= center + radius) & (high >= center - radius)).all(axis=1)
        near = self.screens[is_near]
        lengths = np.hypot(*(near[:, 1] - near[:, 0]).T)
        chosen: Float64Array = near[np.argsort(-lengths, kind="stable")[:_MOST_SCREENS]]
        return chosen


def count_taken(rounds: int) -> int:
    """Return what is taken for one disc after so many rounds."""
    return _FEW << max(0, rounds - _ROUNDS_OF_FEW)


def find_unseen_points(
    source: PointSource, unsettled: UnsettledTriangles, seen: Int64Array
) -> tuple[NumberedPoints, BoolArray]:
    """Return unseen points that may change triangles, and of which triangles none may.

    Of a disc that holds many, those are taken that lie deepest.
    """
    if not len(unsettled.corners):
        return NumberedPoints.none(), np.ones(0, np.bool_)
    some, is_open = _examine(unsettled, source.read_some(unsettled.views.discs), seen)
    left = unsettled.choose(is_open)
    rest, is_clear = _examine(left, source.read_discs(left.views.discs), seen)
    is_safe = is_open.copy()
    is_safe[is_open] = is_clear
    return NumberedPoints.join([some, rest]), is_safe


def _examine(
    unsettled: UnsettledTriangles, found: NumberedPoints, seen: Int64Array
) -> tuple[NumberedPoints, BoolArray]:
    """Return which of some points may change triangles, and of which triangles none may."""
    count = len(unsettled.corners)
    is_safe = np.ones(count, np.bool_)
    found = found.choose(seen[np.searchsorted(seen, found.numbers) % len(seen)] != found.numbers)
    found = found.choose(np.argsort(found.points[:, 0], kind="stable"))
    x, y = np.ascontiguousarray(found.points[:, :2].T)
    boxes = np.array([_bound_view(unsettled, k) for k in range(count)]).reshape(-1, 2, 2)
    begins = np.searchsorted(x, boxes[:, 0, 0], "left")
    ends = np.searchsorted(x, boxes[:, 1, 0], "right")
    is_wanted = np.zeros(len(found.numbers), np.bool_)
    for k in np.flatnonzero(begins < ends).tolist():
        across = y[begins[k] : ends[k]]
        near = begins[k] + np.flatnonzero((across >= boxes[k, 0, 1]) & (across <= boxes[k, 1, 1]))
        near = near[unsettled.are_deciding(k, found.points[near, :2])] if len(near) else near
        if len(near):
            distances = np.hypot(*(found.points[near, :2] - unsettled.discs.centers[k]).T)
            is_wanted[_take_deepest(near, distances, unsettled.most)] = True
            is_safe[k] = False
    return found.choose(is_wanted).sort(), is_safe


def find_unseen_segments(
    lines: SegmentSource, unsettled: UnsettledTriangles, seen: NumberedSegments
) -> tuple[NumberedSegments, BoolArray]:
    """Return unseen segments that may change triangles, and of which triangles none may."""
    discs = unsettled.discs
    is_safe = np.ones(len(discs.radii), np.bool_)
    if not len(is_safe):
        return NumberedSegments.none(), is_safe
    found = lines.read_discs(unsettled.views.discs)
    found = found.choose(~found.are_among(seen))
    ends = found.ends_in_plane
    low, high = (np.ascontiguousarray(pick(axis=1).T) for pick in (ends.min, ends.max))
    is_wanted = np.zeros(len(ends), np.bool_)
    for k in range(len(is_safe) if len(ends) else 0):
        (west, south), (east, north) = _bound_view(unsettled, k)
        is_near = (low[0] <= east) & (high[0] >= west) & (low[1] <= north) & (high[1] >= south)
        near = np.flatnonzero(is_near)
        if len(near):
            near = near[_are_deciding(unsettled, k, ends[near])]
            distances, _ = _measure_distances(ends[near], discs.centers[k])
            is_wanted[_take_deepest(near, distances, unsettled.most)] = True
            is_safe[k] = not len(near)
    return found.choose(is_wanted), is_safe


def _bound_view(unsettled: UnsettledTriangles, k: int) -> tuple[Float64Array, Float64Array]:
    """Return the corners of a box in which all lies that may be seen from a triangle."""
    discs = unsettled.views.discs
    reach = discs.radii[k] * (1 + _SLACK) + _SLACK * float(np.abs(discs.centers[k]).max())
    return discs.centers[k] - reach, discs.centers[k] + reach


def _are_deciding(unsettled: UnsettledTriangles, k: int, ends: Float64Array) -> BoolArray:
    """Tell which segments, (f, 2, 2), meet a triangle, or end in its disc where it is seen from.

    Where it is not known what is seen, all count that meet the disc and are not hidden.
    """
    if unsettled.views.corners[k] is None:
        distances, roundings = _measure_distances(ends, unsettled.discs.centers[k])
        radius = unsettled.discs.radii[k]
        is_near = (distances <= radius * (1 + _SLACK) + roundings) | np.isinf(radius)
        is_near[is_near] = ~unsettled.find_hidden(k, ends[is_near])
        return np.asarray(is_near)
    are_deciding = are_met(unsettled.corners[k], ends)
    for end in (0, 1):
        left = np.flatnonzero(~are_deciding)
        are_deciding[left] = unsettled.are_deciding(k, ends[left, end])
    return are_deciding


def _take_deepest(rows: Int64Array, distances: Float64Array, most: int) -> Int64Array:
    return rows[np.argsort(distances, kind="stable")[:most]]


def _are_in_disc(corners: Float64Array, places: Float64Array) -> BoolArray:
    """Tell which places lie in the closed circumscribed disc of a triangle, exactly."""
    a, b, c = (np.broadcast_to(corner, places.shape).copy() for corner in corners)
    return np.asarray(_kernel.in_circle(a, b, c, np.ascontiguousarray(places)) >= 0)


def _are_beyond_edges(corners: Float64Array, hiding: BoolArray, figures: Float64Array) -> BoolArray:
    """Tell what lies beyond an edge that is a segment; it may end at its line."""
    is_beyond = np.zeros(len(figures), np.bool_)
    for k in np.flatnonzero(hiding).tolist():
        start, end = corners[(k + 1) % 3], corners[(k + 2) % 3]
        sides = [_turn(start, end, places) for places in np.moveaxis(figures, 1, 0)]
        is_beyond |= (np.max(sides, axis=0) <= 0) & (np.min(sides, axis=0) < 0)
    return is_beyond


def _are_in_shadow(corners: Float64Array, screen: Float64Array, figures: Float64Array) -> BoolArray:
    """Tell what lies beyond a segment from which each line to a corner meets the segment.

    The shadow of a segment is convex, as is what sees the triangle through it.
    """
    start, end = screen
    is_hidden = np.zeros(len(figures), np.bool_)
    turns = _turn(start, end, corners)
    if (turns.max() > 0 and turns.min() < 0) or not turns.any():
        return is_hidden
    side = 1 if turns.max() > 0 else -1
    is_hidden[:] = True
    for places in np.moveaxis(figures, 1, 0):
        is_hidden &= _turn(start, end, places) == -side
        for corner in corners:
            one, other = (_turn(corner, at, places) for at in (start, end))
            is_hidden &= one * other <= 0
    return is_hidden


def _turn(start: Float64Array, end: Float64Array, places: Float64Array) -> Int8Array:
    """Return the side of a line on which places lie: +1 left, 0 on it, -1 right."""
    a, b = (np.broadcast_to(one, places.shape).copy() for one in (start, end))
    return _kernel.orientation(a, b, np.ascontiguousarray(places))


def _measure_distances(
    ends: Float64Array, center: Float64Array
) -> tuple[Float64Array, Float64Array]:
    """Return distances of segments, (k, 2, 2), from a place, and how far rounding puts them off."""
    start, end = ends[:, 0] - center, ends[:, 1] - center
    along = end - start
    with np.errstate(all="ignore"):
        share = -(start * along).sum(axis=1) / (along * along).sum(axis=1)
    share = np.clip(np.nan_to_num(share), 0.0, 1.0)
    distances = np.hypot(*(start + share[:, None] * along).T)
    size = np.abs(ends).max(axis=(1, 2)) + np.abs(center).max(initial=0.0)
    return np.asarray(distances), np.asarray(_SLACK * size)
