r"""What is seen from a triangle: the triangles around it that lines of sight reach.

A point puts an end to a constrained triangle only if it lies in its circumscribed disc and is seen
from its inside: some line of sight crosses no segment. The known segments are all of the whole, and
the triangles between them cover the convex hull of everything. So a line of sight in the whole
crosses only edges of them that are no segments, and only triangles that meet the disc, which is
convex: it ends in one that :func:`.find_seen` reaches, in its inside, on its sides or at its
corners. A point elsewhere is hidden, if not by one segment then by several together::

         \    .p  /
          \ .  . /        p is seen neither past the one segment nor past the other, and
        ---\----/---      neither alone hides it from all of the triangle below
           a\  /b
             \/c

Of a segment that is not known the ends are vertices, for which the same holds. Between them it may
only hide what lies behind, unless it meets the triangle itself.
"""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from .. import _kernel
from .circles import Discs

if TYPE_CHECKING:
    from ...base.arrays import BoolArray, Float64Array, Int8Array, Int32Array

_MOST_SEEN = 1_000
"""Triangles that lines of sight go through before it is given up to follow them: some ten is
usual."""
_SLACK = 2.0**-44
"""Of coordinates, for roundings."""


class Views(NamedTuple):
    """What is seen from each of some triangles within its disc.

    Attributes
    ----------
    corners : tuple of (m, 3, 2) float64 arrays, or None
        Of the triangles that are seen from each; None where these are too many to be followed.
    discs : Discs
        In which all lies that is seen: the triangles' own ones, or smaller ones.
    """

    corners: tuple[Float64Array | None, ...]
    discs: Discs

    @classmethod
    def unknown(cls, discs: Discs) -> Views:
        """Return views of which nothing is known but the discs of the triangles."""
        return cls((None,) * len(discs.radii), discs)

    def choose(self, which: BoolArray) -> Views:
        """Return some of them."""
        corners = tuple(self.corners[k] for k in np.flatnonzero(which).tolist())
        return Views(corners, self.discs.choose(which))


def find_views(
    places: Float64Array,
    triangles: Int32Array,
    neighbors: Int32Array,
    fixed: BoolArray,
    chosen: Int32Array,
    discs: Discs,
) -> Views:
    """Find what is seen from chosen triangles of a triangulation; ``discs`` are theirs."""
    seen = _kernel.find_seen(
        places,
        triangles,
        neighbors,
        fixed,
        np.ascontiguousarray(chosen),
        np.ascontiguousarray(discs.centers),
        np.ascontiguousarray(discs.radii),
        _MOST_SEEN,
    )
    corners: list[Float64Array | None] = [
        places[triangles[seen.triangles[begin:end]]]
        for begin, end in pairwise(seen.offsets.tolist())
    ]
    for k in seen.failed.tolist():
        corners[k] = None
    centers, radii = discs.centers.copy(), discs.radii.copy()
    for k, one in enumerate(corners):
        if one is not None:
            center, radius = _bound(one.reshape(-1, 2), discs.centers[k], discs.radii[k])
            if radius < radii[k]:
                centers[k], radii[k] = center, radius
    return Views(tuple(corners), Discs(centers, radii))


def _bound(
    corners: Float64Array, center: Float64Array, radius: float
) -> tuple[Float64Array, float]:
    """Return a disc around the part of the bounds of places that lies in those of a disc."""
    low = np.maximum(corners.min(axis=0), center - radius)
    high = np.minimum(corners.max(axis=0), center + radius)
    middle = (low + high) / 2
    size = float(np.abs([low, high, center]).max())
    half = float(np.hypot(*(high - low))) / 2
    return middle, half * (1 + _SLACK) + _SLACK * size


def are_seen(corners: Float64Array, places: Float64Array) -> BoolArray:
    """Tell which places lie in any of some closed triangles, (m, 3, 2), exactly."""
    return _kernel.are_in_triangles(
        np.ascontiguousarray(corners.reshape(-1, 2)), np.ascontiguousarray(places)
    )


def are_met(corners: Float64Array, ends: Float64Array) -> BoolArray:
    """Tell which segments, (k, 2, 2), meet a closed triangle, (3, 2), exactly.

    Of convex figures that do not meet, one lies beyond a side of the other.
    """
    is_apart = np.zeros(len(ends), np.bool_)
    for k in range(3):
        start, end = corners[k], corners[(k + 1) % 3]
        sides = [_turn(start, end, ends[:, one]) for one in (0, 1)]
        is_apart |= np.max(sides, axis=0) < 0
    sides = [_turn(ends[:, 0], ends[:, 1], corner) for corner in corners]
    is_apart |= (np.min(sides, axis=0) > 0) | (np.max(sides, axis=0) < 0)
    return ~is_apart


def _turn(start: Float64Array, end: Float64Array, places: Float64Array) -> Int8Array:
    """Return the side of a line on which places lie: +1 left, 0 on it, -1 right."""
    return _kernel.orientation(*map(np.ascontiguousarray, np.broadcast_arrays(start, end, places)))
