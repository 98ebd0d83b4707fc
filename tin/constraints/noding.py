"""Noding: lines share a vertex wherever they meet, and nothing else.

Rounds, each a function of the set of segments, never of their order or direction:

1. A segment is split at every vertex that lies on it, exactly or within ``snap``, until there is
   none. Exact splits leave nothing behind; within ``snap`` a segment bends onto the vertex, and
   its parts are looked at again. Parts only ever get shorter, so this comes to an end.
2. Where segments cross, one vertex is made at each distinct place, its coordinates rounded once,
   or the vertex taken that is there already; both segments are split. Rounding bends them by a
   unit in the last place, so round 1 follows, from now on for all vertices within such a unit
   [1]_: else nearly parallel lines would cross again and again, between ever more vertices.
   Both are repeated until nothing crosses.

Only what is new is looked at again: segments since the last round, and vertices.

References
----------
.. [1] J. D. Hobby, Practical segment intersection with finite precision output, Computational
   Geometry 13 (1999), doi:10.1016/S0925-7721(99)00021-8.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...base.errors import LinesError, choice
from ...base.policies import CrossingPolicy
from ...base.sentences import coordinate, height
from ..report import Crossings
from .polylines import Polylines
from .splitting import Splitting, drop_repeats

if TYPE_CHECKING:
    from ...base.arrays import AnyArray, BoolArray, Float64Array, Int32Array, Int64Array


class Visits(NamedTuple):
    """Lines that come through vertices; twice along the same segments counts once."""

    vertex: Int32Array
    line: Int32Array
    """(t,), sorted by vertex, then by line."""
    elevation: Float64Array
    """(t,), the line's own elevation there; NaN if it has none."""


class Noded(NamedTuple):
    """Lines whose segments hold no vertex but their ends and cross no other segment."""

    new_points: Float64Array
    """(s, 3), vertices made where lines cross, by x, then y; numbered behind the given ones."""
    polylines: Polylines
    elevations: Float64Array
    """(k,), the line's own elevation at each of its vertices; NaN if it has none."""
    crossings: Crossings
    """A row for the line whose elevation counts, which is named first, and each other line there;
    the same line twice if it crosses itself."""
    touches: Visits
    """Given vertices that a line passes without naming them."""


def accept_noded(polylines: Polylines, elevations: Float64Array) -> Noded:
    """Return lines that meet nowhere, as :func:`node` would; repeated vertices are dropped."""
    none = np.empty(0, np.int32)
    return Noded(
        np.empty((0, 3)),
        *drop_repeats(polylines, elevations),
        Crossings.none(),
        Visits(none, none, np.empty(0)),
    )


def node(
    xy: Float64Array,
    polylines: Polylines,
    elevations: Float64Array,
    priority: AnyArray,
    *,
    snap: float = 0.0,
    crossing: str = "split",
    threads: int = 1,
    names: Sequence[str] | None = None,
) -> Noded:
    """Make lines share a vertex wherever they cross, touch or overlap.

    Parameters
    ----------
    xy : (n, 2) float64 array, CRS units
        Distinct places, those of the lines and all others that they may pass.
    polylines : Polylines
        Repeated vertices in a row count once.
    elevations : (k,) float64 array
        The line's own elevation at each of its vertices; NaN if it has none.
    priority : (l,) int array
        At a vertex made by crossing lines, the elevation of the line with the highest priority is
        taken, among equals of the first line, and of one line its lowest; of a line without
        elevations only if no other has any.
    snap : float
        A vertex within this distance bends a line onto itself, CRS units. Not one that is also
        within it of an end of the segment.
    crossing : {"split", "error"}
        Whether lines may cross.
    threads : int
    names : sequence of str, optional
        Of the lines, for sentences; default "line 0", "line 1" ...

    Returns
    -------
    Noded
        New points and segments are the same for any order and direction of the lines.

    Raises
    ------
    OptionError
        If ``crossing`` is unknown.
    LinesError
        If lines cross and it is "error".

    Notes
    -----
    Time grows with the number of segments and of boxes around them that overlap.

    Examples
    --------
    >>> xy = np.array([[0.0, 0.0], [4.0, 4.0], [0.0, 4.0], [4.0, 0.0]])
    >>> polylines = Polylines.of_chains([[0, 1], [2, 3]])
    >>> noded = node(xy, polylines, np.array([5.0, 7.0, 8.0, 8.0]), np.zeros(2))
    >>> noded.new_points.tolist(), noded.polylines.vertices.tolist()
    ([[2.0, 2.0, 6.0]], [0, 4, 1, 2, 4, 3])
    """
    choice("crossing", crossing, CrossingPolicy)
    work = Splitting(
        np.ascontiguousarray(xy, np.float64), polylines, elevations, float(snap), threads
    )
    work.split_everywhere(
        None if crossing == "split" else lambda pairs: _explain_crossing(work, pairs, names)
    )
    return _number_and_account(work, np.asarray(priority))


def node_again(
    points: Float64Array, polylines: Polylines, priority: AnyArray, *, threads: int
) -> tuple[Float64Array, Polylines]:
    """Node parts of lines that were bent by a rounding; a vertex keeps its elevation.

    Of several parts of one line, too, the lowest elevation counts, for their order is the direction
    of the line; else ``priority``, (l,), of each as for :func:`node`. Returns the points, (n, 3),
    with the vertices made where lines cross, and the lines.
    """
    xy = np.ascontiguousarray(points[:, :2])
    work = Splitting(xy, polylines, points[polylines.vertices, 2], 0.0, threads)
    work.split_everywhere()
    noded = _number_and_account(work, priority)
    return np.concatenate([points, noded.new_points]), noded.polylines


# -------------------------------------------------------------------- account


def _gather_visits(work: Splitting, at: Int64Array) -> Visits:
    """Gather what passes the positions ``at``, in order of vertex, line and position.

    A line may come through a vertex several times. Twice between the same neighbours, forwards or
    back, is one visit, with the lower of the elevations::

            b
            |            a line  a v b ... b v a ... c v d  comes through v three times,
        c - v - d        which are two visits: a-v-b and c-v-d
            |
            a
    """
    vertices, line = work.polylines.vertices, work.polylines.owners.astype(np.int32)
    same_before = np.append(False, line[1:] == line[:-1])
    before = np.where(same_before[at], vertices[at - 1], -1)
    same_after = np.append(same_before[1:], False)
    after = np.where(same_after[at], vertices[(at + 1) % len(vertices)], -1)
    keys = (np.maximum(before, after), np.minimum(before, after), line[at], vertices[at])
    order = np.lexsort((work.elevations[at], *keys))  # the lowest counts
    is_first = np.ones(len(at), np.bool_)
    is_first[1:] = np.any([np.diff(key[order]) != 0 for key in keys], axis=0)
    at = np.sort(at[order[is_first]])
    at = at[np.lexsort((line[at], vertices[at]))]
    return Visits(vertices[at], line[at], work.elevations[at])


def _number_and_account(work: Splitting, priority: AnyArray) -> Noded:
    """Return everything, the new points numbered by place."""
    n_given = work.n_given
    made = work.xy[n_given:]
    order = np.lexsort((made[:, 1], made[:, 0]))
    number = np.arange(len(work.xy), dtype=np.int32)
    number[n_given + order] = np.arange(n_given, len(work.xy), dtype=np.int32)
    work.polylines = work.polylines.renumber(number)
    work.xy = np.concatenate([work.xy[:n_given], made[order]])
    is_crossing = np.zeros(len(work.xy), np.bool_)
    is_crossing[number[work.crossing_vertices]] = True
    crossings, winners = _gather_crossings(work, is_crossing, priority)
    is_new = winners.vertex >= n_given
    passed = ~work.is_given & (work.polylines.vertices < n_given)
    return Noded(
        np.column_stack([made[order], winners.elevation[is_new]]),
        work.polylines,
        work.elevations,
        crossings,
        _gather_visits(work, np.flatnonzero(passed)),
    )


def _gather_crossings(
    work: Splitting, is_crossing: BoolArray, priority: AnyArray
) -> tuple[Crossings, Visits]:
    """Return the crossings, and whose elevation counts at each vertex, by vertex.

    The visits are sorted by vertex, at each the one that counts in front::

        vertex      7  7  7  9  9
        line        2  0  3  1  4
        is_winner   x        x
        winner      0  0  0  3  3            the row of the winner at the same vertex
        crossings   (2, 0) (2, 3) (1, 4)     a pair for each other visit, the winner in front
    """
    at = np.flatnonzero(is_crossing[work.polylines.vertices])
    vertex, line, elevation = _gather_visits(work, at)
    part_of = work.polylines.lines[line]
    rank = np.where(np.isneginf(priority[line]), 0, part_of)  # draped lines have no order
    best = np.lexsort((line, elevation, rank, -priority[line], np.isnan(elevation), vertex))
    vertex, line, elevation = vertex[best], line[best], elevation[best]
    is_winner = np.ones(len(vertex), np.bool_)
    is_winner[1:] = np.diff(vertex) != 0
    winner = np.flatnonzero(is_winner)[np.cumsum(is_winner) - 1]
    other = np.flatnonzero(~is_winner)
    pair = np.stack([winner[other], other], axis=1)
    crossings = Crossings(
        vertex[other], work.xy[vertex[other]], line[pair], elevation[pair], elevation[winner[other]]
    )
    return crossings, Visits(vertex[is_winner], line[is_winner], elevation[is_winner])


def _explain_crossing(
    work: Splitting, pairs: Int64Array, names: Sequence[str] | None
) -> LinesError:
    """Name the first crossing: by lines, then by place."""
    points = work.find_crossing_points(pairs)
    segment = np.sort(work.segments.first_segment[pairs], axis=1)
    lines = work.polylines.owners[work.segments.start[segment]]
    first = np.lexsort((points[:, 1], points[:, 0], lines[:, 1], lines[:, 0]))[0]
    a, b = lines[first].tolist()
    x, y = points[first].tolist()
    elevations = work.interpolate_elevations(segment[first], points[[first, first]]).tolist()
    label_a, label_b = (f"line {i}" if names is None else names[i] for i in (a, b))
    whom = "itself" if a == b else label_b
    return LinesError(
        f"{label_a[0].upper()}{label_a[1:]} crosses {whom} at ({coordinate(x)}, {coordinate(y)}), "
        f"{_describe_elevations(elevations)}: `crossing='split'` makes a vertex there.",
        lines=sorted({a, b}),
    )


def _describe_elevations(elevations: list[float]) -> str:
    first, second = (
        "no elevation" if np.isnan(z) else f"elevation {height(z)}" for z in elevations
    )
    return f"with {first} and {second}"
