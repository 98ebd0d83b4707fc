"""Conforming: segments of lines are split until every edge of the surface is Delaunay.

Rounds, each a function of the sets of points and segments:

1. Every segment that is not Delaunay is split. A segment is halved; next to a vertex that was
   there before it is cut at a power of two from there [1]_, so that segments that meet under an
   acute angle do not split each other for ever.
2. A split point is rounded to coordinates, so its segment bends, by a unit in the last place. If it
   meets another vertex or segment then, all lines are noded again, exactly, and the points are
   triangulated anew.

A round makes segments shorter and never joins any. How many it takes depends on angles and
distances, not on the number of points; so new vertices are limited in number.

References
----------
.. [1] J. Ruppert, A Delaunay Refinement Algorithm for Quality 2-Dimensional Mesh Generation,
   Journal of Algorithms 18 (1995), doi:10.1006/jagm.1995.1021.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...base.errors import LinesError
from ...base.sentences import counted, inflect
from .. import _kernel
from ..topology import edge_keys
from .noding import node_again
from .pslg import build_mesh
from .splitting import interpolate_linearly, is_before

if TYPE_CHECKING:
    from ...base.arrays import AnyArray, Float64Array, Int32Array
    from .polylines import Polylines

_MOST_ROUNDS = 1000  # from the largest coordinate to the smallest are some 450 halvings
_LEAST_LIMIT = 20_000  # of new vertices, for any few lines
_NEW_PER_VERTEX = 50  # the limit for many


def conform(
    mesh: _kernel.Mesh,
    points: Float64Array,
    polylines: Polylines,
    priorities: AnyArray,
    *,
    threads: int,
) -> tuple[_kernel.Mesh, Float64Array, Polylines]:
    """Split segments that are not Delaunay.

    The mesh is that of the points, (n, 3), with the segments of all lines, which are noded, fixed;
    it is not to be used any more. ``priorities``, (l,), of the lines tell whose elevation counts
    where two meet anew. Returns mesh, points and lines with the new vertices, whose elevations are
    linear along the segments. Raises LinesError if a segment is too short to be split, or too many
    vertices would be needed.
    """
    n_given, most = len(points), max(_LEAST_LIMIT, _NEW_PER_VERTEX * len(points))
    for _ in range(_MOST_ROUNDS):
        # the segments that are not Delaunay, as pairs of ends, in order of their places
        ends = mesh.illegal_fixed_edges().reshape(-1, 2)
        start, end = points[ends[:, 0], :2], points[ends[:, 1], :2]
        is_backward = is_before(end, start)
        ends = np.where(is_backward[:, None], ends[:, ::-1], ends)
        start, end = points[ends[:, 0], :2], points[ends[:, 1], :2]
        order = np.lexsort((*end.T, *start.T))
        bad = np.ascontiguousarray(ends[order])
        if not len(bad):
            return mesh, points, polylines
        if len(points) + len(bad) - n_given > most:
            raise _explain_hopeless(f"{most} new vertices", points, bad)
        middle = _place_split_points(points, bad, n_given)
        splits_before = mesh.fixed_splits
        mesh.release(bad)
        vertex = mesh.insert(np.ascontiguousarray(middle[:, :2]))
        is_noded = bool((vertex == len(points) + np.arange(len(middle))).all())
        points = np.concatenate([points, middle])
        # put a vertex between the ends of these segments, wherever a line takes them
        keys = edge_keys(bad, len(points))
        order = np.argsort(keys)
        own = edge_keys(polylines.segments(), len(points))
        slot = np.minimum(np.searchsorted(keys, own, sorter=order), len(keys) - 1)
        hit = np.flatnonzero(keys[order[slot]] == own)
        polylines = polylines.insert(polylines.starts()[hit], vertex[order[slot[hit]]])
        halves = np.stack([bad[:, 0], vertex, vertex, bad[:, 1]], axis=1).reshape(-1, 2)
        passed, blocked = mesh.force(np.ascontiguousarray(halves))
        is_noded &= mesh.fixed_splits == splits_before and not (len(passed) or len(blocked))
        if not is_noded:
            # a split point fell on a vertex or another segment, or something is in the way of the
            # halves: the lines are noded exactly, the vertices triangulated without gaps
            alive = mesh.alive()
            number_of = (np.cumsum(alive) - 1).astype(np.int32)
            points, polylines = points[alive], polylines.renumber(number_of)
            priority = priorities[polylines.lines]
            points, polylines = node_again(points, polylines, priority, threads=threads)
            mesh = build_mesh(points, polylines, threads=threads)
    raise _explain_hopeless(f"{_MOST_ROUNDS} rounds of splitting", points, bad)


def _explain_hopeless(what: str, points: Float64Array, bad: Int32Array) -> LinesError:
    x, y, _ = points[bad[0, 0]].tolist()
    run = inflect("still [runs|run] too close to others, or [meets|meet] them", len(bad))
    return LinesError(
        f"The lines are not conforming after {what}: {counted(len(bad), 'segment')} (first: at "
        f"x {x!r}, y {y!r}) {run} under too small an angle."
    )


def _place_split_points(points: Float64Array, segments: Int32Array, n_given: int) -> Float64Array:
    start, end = points[segments[:, 0]], points[segments[:, 1]]
    length = np.hypot(*(end - start)[:, :2].T)
    shell = np.exp2(np.round(np.log2(length / 2))) / length
    is_given = segments < n_given
    share = np.where(is_given[:, 0], shell, np.where(is_given[:, 1], 1 - shell, 0.5))
    share = np.where(is_given.all(axis=1), 0.5, share)
    middle = np.empty_like(start)
    # round to 0 what is too small for the predicates
    xy = start[:, :2] + share[:, None] * (end - start)[:, :2]
    smallest, _ = _kernel.EXACT_RANGE
    middle[:, :2] = np.where(np.abs(xy) < smallest, 0.0, xy)
    middle[:, 2] = interpolate_linearly(start[:, 2], end[:, 2], share)
    _require_between(middle[:, :2], start[:, :2], end[:, :2])
    return middle


def _require_between(middle: Float64Array, start: Float64Array, end: Float64Array) -> None:
    stuck = (middle == start).all(axis=1) | (middle == end).all(axis=1)
    if stuck.any():
        x, y = middle[np.argmax(stuck)].tolist()
        raise LinesError(
            f"The lines cannot be made conforming at x {x!r}, y {y!r}: a segment there is too "
            "short to be split."
        )
