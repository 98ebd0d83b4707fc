"""Noding: lines share a vertex wherever they meet, and nothing else.

Rounds, each a function of the set of segments, never of their order or direction:

1. A segment is split at every vertex that lies on it, exactly or within ``snap``, until there is
   none. Exact splits leave nothing behind; within ``snap`` a segment bends onto the vertex, and
   its parts are looked at again. Parts only ever get shorter, so this comes to an end.
2. Where segments cross, one vertex is made at each distinct place, its coordinates rounded once,
   or the vertex taken that is there already; both segments are split. Rounding bends them by a
   unit in the last place, so step 1 follows, from now on for all vertices within such a unit
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
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...errors import LinesError
from .splitting import Splitting, Walk

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["Chains", "Crossings", "Noded", "Touches", "node", "node_again", "untouched"]


class Chains(NamedTuple):
    """Lines as chains of vertices: line ``i`` is ``offsets[i]:offsets[i + 1]``.

    Attributes
    ----------
    vertices : (k,) int32 array
    offsets : (l + 1,) int32 array
    heights : (k,) float64 array
        The line's own height at each of its vertices; NaN if it has none.
    """

    vertices: NDArray[np.int32]
    offsets: NDArray[np.int32]
    heights: NDArray[np.float64]


class Crossings(NamedTuple):
    """Where lines cross: a row for the line whose height counts and each other line there.

    Attributes
    ----------
    vertex : (c,) int32 array
    xy : (c, 2) float64 array
    line_a, line_b : (c,) int32 arrays
        The line whose height counts, and another one; the same if it crosses itself.
    height_a, height_b : (c,) float64 arrays
        The height of each line itself; NaN if it has none.
    height : (c,) float64 array
        The one taken: that of ``line_a``.
    """

    vertex: NDArray[np.int32]
    xy: NDArray[np.float64]
    line_a: NDArray[np.int32]
    line_b: NDArray[np.int32]
    height_a: NDArray[np.float64]
    height_b: NDArray[np.float64]
    height: NDArray[np.float64]


class Touches(NamedTuple):
    """Given vertices that a line passes without naming them.

    Attributes
    ----------
    vertex, line : (t,) int32 arrays
        Sorted by vertex, then by line.
    height : (t,) float64 array
        The line's own height there; NaN if it has none.
    """

    vertex: NDArray[np.int32]
    line: NDArray[np.int32]
    height: NDArray[np.float64]


class Noded(NamedTuple):
    """Lines whose steps hold no vertex but their ends and cross no other step.

    Attributes
    ----------
    new_points : (s, 3) float64 array
        Vertices made where lines cross, by x, then y; numbered behind the given ones.
    chains : Chains
    crossings : Crossings
    touches : Touches
    """

    new_points: NDArray[np.float64]
    chains: Chains
    crossings: Crossings
    touches: Touches


def untouched(chains: Chains) -> Noded:
    """Return lines that meet nowhere, as :func:`node` would; repeated vertices are dropped."""
    walk = Walk.along(chains.vertices, chains.offsets, chains.heights)
    offsets = np.searchsorted(walk.line, np.arange(len(chains.offsets))).astype(np.int32)
    none = np.empty(0, np.int32)
    nothing = np.empty(0)
    return Noded(
        np.empty((0, 3)),
        Chains(walk.vertices, offsets, walk.heights),
        Crossings(none, np.empty((0, 2)), none, none, nothing, nothing, nothing),
        Touches(none, none, nothing),
    )


def node(
    xy: NDArray[np.float64],
    chains: Chains,
    priority: NDArray[Any],
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
    chains : Chains
        Repeated vertices in a row count once.
    priority : (l,) int array
        At a vertex made by crossing lines, the height of the line with the highest priority is
        taken, among equals of the first line, and of one line its lowest; of a line without
        heights only if no other has any.
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
        New points and steps are the same for any order and direction of the lines.

    Raises
    ------
    LinesError
        If ``crossing`` is unknown, or lines cross and it is "error".

    Notes
    -----
    Time grows with the number of segments and of boxes around them that overlap.

    Examples
    --------
    >>> xy = np.array([[0.0, 0.0], [4.0, 4.0], [0.0, 4.0], [4.0, 0.0]])
    >>> chains = Chains(
    ...     np.array([0, 1, 2, 3], np.int32),
    ...     np.array([0, 2, 4], np.int32),
    ...     np.array([5.0, 7.0, 8.0, 8.0]),
    ... )
    >>> noded = node(xy, chains, np.zeros(2))
    >>> noded.new_points.tolist(), noded.chains.vertices.tolist()
    ([[2.0, 2.0, 6.0]], [0, 4, 1, 2, 4, 3])
    """
    if crossing not in ("split", "error"):
        raise LinesError(f"Invalid crossing '{crossing}': one of split, error.")
    heights = np.asarray(chains.heights, np.float64)
    walk = Walk.along(np.asarray(chains.vertices, np.int32), chains.offsets, heights)
    work = Splitting(np.ascontiguousarray(xy, np.float64), walk, float(snap), threads)
    work.split_everywhere(
        None if crossing == "split" else lambda pairs: _crossing_error(work, pairs, names)
    )
    return _account(work, np.arange(len(chains.offsets) - 1), np.asarray(priority))


def node_again(
    points: NDArray[np.float64],
    chains: Chains,
    priority: NDArray[Any],
    lines: NDArray[np.int32],
    *,
    threads: int,
) -> tuple[NDArray[np.float64], Chains]:
    """Node parts of lines that were bent by a rounding; a vertex keeps its height.

    Parameters
    ----------
    points : (n, 3) float64 array
        Distinct places.
    chains : Chains
    priority : (l,) int array
        As for :func:`node`.
    lines : (l,) int32 array
        The line that each chain is a part of: of its parts, too, the lowest height counts, for
        their order is the direction of the line.
    threads : int

    Returns
    -------
    points : (n + s, 3) float64 array
        With the vertices made where lines cross.
    chains : Chains
    """
    walk = Walk.along(chains.vertices, chains.offsets, chains.heights)
    work = Splitting(np.ascontiguousarray(points[:, :2]), walk, 0.0, threads)
    work.split_everywhere()
    noded = _account(work, lines, priority)
    return np.concatenate([points, noded.new_points]), noded.chains


# -------------------------------------------------------------------- account


class _Visits(NamedTuple):
    """Lines that come through vertices; twice along the same steps counts once."""

    vertex: NDArray[np.int32]
    line: NDArray[np.int32]
    height: NDArray[np.float64]


def _visits(walk: Walk, at: NDArray[np.int64]) -> _Visits:
    """Gather what passes the positions ``at``, in order of vertex, line and position."""
    same_before = np.append(False, walk.line[1:] == walk.line[:-1])
    before = np.where(same_before[at], walk.vertices[at - 1], -1)
    same_after = np.append(same_before[1:], False)
    after = np.where(same_after[at], walk.vertices[(at + 1) % len(walk.vertices)], -1)
    keys = (
        np.maximum(before, after),
        np.minimum(before, after),
        walk.line[at],
        walk.vertices[at],
    )
    order = np.lexsort((walk.heights[at], *keys))  # of the same steps the lowest way counts
    is_first = np.ones(len(at), np.bool_)
    is_first[1:] = np.any([np.diff(key[order]) != 0 for key in keys], axis=0)
    at = np.sort(at[order[is_first]])
    at = at[np.lexsort((walk.line[at], walk.vertices[at]))]
    return _Visits(walk.vertices[at], walk.line[at], walk.heights[at])


def _account(work: Splitting, part_of: NDArray[Any], priority: NDArray[Any]) -> Noded:
    """Return everything, the new points numbered by place; chain ``i`` is of ``part_of[i]``."""
    n_given = work.n_given
    made = work.xy[n_given:]
    order = np.lexsort((made[:, 1], made[:, 0]))
    number = np.arange(len(work.xy), dtype=np.int32)
    number[n_given + order] = np.arange(n_given, len(work.xy), dtype=np.int32)
    walk = work.walk._replace(vertices=number[work.walk.vertices])
    xy = np.concatenate([work.xy[:n_given], made[order]])
    is_crossing = np.zeros(len(xy), np.bool_)
    is_crossing[number[work.crossing_vertices]] = True
    crossings, winners = _crossings(walk, xy, is_crossing, priority, part_of)
    is_new = winners.vertex >= n_given
    passed = ~walk.is_given & (walk.vertices < n_given)
    offsets = np.searchsorted(walk.line, np.arange(len(part_of) + 1)).astype(np.int32)
    return Noded(
        np.column_stack([made[order], winners.height[is_new]]),
        Chains(walk.vertices, offsets, walk.heights),
        crossings,
        Touches(*_visits(walk, np.flatnonzero(passed))),
    )


def _crossings(
    walk: Walk,
    xy: NDArray[np.float64],
    is_crossing: NDArray[np.bool_],
    priority: NDArray[Any],
    part_of: NDArray[Any],
) -> tuple[Crossings, _Visits]:
    """Return the crossings, and whose height counts at each vertex, by vertex."""
    vertex, line, height = _visits(walk, np.flatnonzero(is_crossing[walk.vertices]))
    rank = np.where(
        np.isneginf(priority[line]), 0, part_of[line]
    )  # parts of draped lines have no order
    best = np.lexsort((line, height, rank, -priority[line], np.isnan(height), vertex))
    vertex, line, height = vertex[best], line[best], height[best]
    is_winner = np.ones(len(vertex), np.bool_)
    is_winner[1:] = np.diff(vertex) != 0
    winner = np.flatnonzero(is_winner)[np.cumsum(is_winner) - 1]
    other = np.flatnonzero(~is_winner)
    of = winner[other]
    crossings = Crossings(
        vertex[other], xy[vertex[other]], line[of], line[other], height[of], height[other],
        height[of],
    )  # fmt: skip
    return crossings, _Visits(vertex[is_winner], line[is_winner], height[is_winner])


def _crossing_error(
    work: Splitting, pairs: NDArray[np.int64], names: Sequence[str] | None
) -> LinesError:
    """Name the first crossing: by lines, then by place."""
    places = work.places_of(pairs)
    step = np.sort(work.steps.first_step[pairs], axis=1)
    lines = work.walk.line[work.steps.start[step]]
    first = np.lexsort((places[:, 1], places[:, 0], lines[:, 1], lines[:, 0]))[0]
    a, b = lines[first].tolist()
    x, y = places[first].tolist()
    heights = work.heights_at(step[first], places[[first, first]]).tolist()
    label_a, label_b = (f"line {i}" if names is None else names[i] for i in (a, b))
    whom = "itself" if a == b else label_b
    return LinesError(
        f"{label_a[0].upper()}{label_a[1:]} crosses {whom} at ({x:.12g}, {y:.12g}), "
        f"{_in_words(heights)}: crossing='split' makes a vertex there.",
        lines=sorted({a, b}),
    )


def _in_words(heights: list[float]) -> str:
    first, second = ("no height" if np.isnan(z) else f"height {z:.10g}" for z in heights)
    return f"with {first} and {second}"
