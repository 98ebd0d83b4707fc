"""Conforming: steps of lines are split until every edge of the surface is Delaunay."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .errors import LinesError
from .pieces import Pieces
from .regions import edge_keys

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from . import _kernel

__all__ = ["conform"]

_MOST_ROUNDS = 200


def conform(
    mesh: _kernel.Mesh, points: NDArray[np.float64], pieces: Pieces
) -> tuple[NDArray[np.float64], Pieces]:
    """Split steps that are not Delaunay, in the mesh too.

    A step is halved; next to a vertex of the lines it is cut at a power of two from there [1]_, so
    that steps that meet under an acute angle do not split each other for ever.

    Parameters
    ----------
    mesh : Mesh
        With the steps of all pieces fixed.
    points : (n, 3) float64 array
        Of every slot of the mesh.
    pieces : Pieces

    Returns
    -------
    points : (n + s, 3) float64 array
        With the new vertices, heights linear along the steps.
    pieces : Pieces

    Raises
    ------
    LinesError
        If a step is too short to be split.

    References
    ----------
    .. [1] J. Ruppert, A Delaunay Refinement Algorithm for Quality 2-Dimensional Mesh Generation,
       Journal of Algorithms 18 (1995), doi:10.1006/jagm.1995.1021.
    """
    n_given = len(points)
    for _ in range(_MOST_ROUNDS):
        steps = _once(pieces, len(points))
        bad = steps[~mesh.is_delaunay(steps)]
        if not len(bad):
            return points, pieces
        middle = _split_points(points, bad, n_given)
        mesh.release(bad)
        vertex = mesh.insert(np.ascontiguousarray(middle[:, :2]))
        points = np.concatenate([points, middle])
        halves = np.concatenate(
            [np.stack([bad[:, 0], vertex], 1), np.stack([vertex, bad[:, 1]], 1)]
        )
        passed, blocked = mesh.force(np.ascontiguousarray(halves))
        if len(passed) or len(blocked):
            raise LinesError(
                "The lines cannot be made conforming: they come closer to each other than "
                "coordinates can tell apart."
            )
        pieces = _with_middles(pieces, bad, vertex, len(points))
    raise LinesError(
        f"The lines are not conforming after {_MOST_ROUNDS} rounds of splitting: they meet under "
        "too small angles."
    )


def _once(pieces: Pieces, n: int) -> NDArray[np.int32]:
    steps, _ = pieces.steps()
    steps = np.sort(steps, axis=1)
    _, first = np.unique(edge_keys(steps, n), return_index=True)
    return np.ascontiguousarray(steps[first])


def _split_points(
    points: NDArray[np.float64], steps: NDArray[np.int32], n_given: int
) -> NDArray[np.float64]:
    start, end = points[steps[:, 0]], points[steps[:, 1]]
    length = np.hypot(*(end - start)[:, :2].T)
    shell = np.exp2(np.round(np.log2(length / 2))) / length
    is_given = steps < n_given
    share = np.where(is_given[:, 0], shell, np.where(is_given[:, 1], 1 - shell, 0.5))
    share = np.where(is_given.all(axis=1), 0.5, share)
    middle = start + share[:, None] * (end - start)
    stuck = (middle[:, :2] == start[:, :2]).all(axis=1) | (middle[:, :2] == end[:, :2]).all(axis=1)
    if stuck.any():
        x, y, _ = middle[np.argmax(stuck)]
        raise LinesError(
            f"The lines cannot be made conforming at x {x!r}, y {y!r}: an edge there is too short "
            "to be split."
        )
    return np.asarray(middle, np.float64)


def _with_middles(
    pieces: Pieces, split: NDArray[np.int32], vertex: NDArray[np.int32], n: int
) -> Pieces:
    """Put a vertex between the ends of some steps, wherever a piece takes them."""
    keys = edge_keys(split, n)
    order = np.argsort(keys)
    steps, _ = pieces.steps()
    own = edge_keys(steps, n)
    slot = np.minimum(np.searchsorted(keys, own, sorter=order), len(keys) - 1)
    hit = np.flatnonzero(keys[order[slot]] == own)
    is_start = np.ones(len(pieces.vertices), np.bool_)
    is_start[pieces.offsets[1:] - 1] = False
    after = np.flatnonzero(is_start)[hit] + 1
    added = np.searchsorted(after, pieces.offsets, side="left")
    added[-1] = len(after)
    return Pieces(
        np.insert(pieces.vertices, after, vertex[order[slot[hit]]]).astype(np.int32),
        (pieces.offsets + added).astype(np.int32),
        pieces.lines,
    )
