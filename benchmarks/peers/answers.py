"""Is a peer's triangulation right? Compared with ours, and where it differs, checked by itself."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tinsmith.base.arrays import AnyArray, Float64Array, Int64Array
from tinsmith.tin import TIN, PointsError, check
from tinsmith.tin.checking.findings import Problem

__all__ = [
    "AS_MANY",
    "EQUAL",
    "Verdict",
    "encode_edges",
    "judge_answer",
    "make_counting_judge",
    "number_corners",
    "rank_triangles",
]

Triangles = Int64Array


EQUAL, AS_MANY = "equal", "as many triangles"


class Verdict(NamedTuple):
    """What became of the points.

    Attributes
    ----------
    is_right : bool
        A Delaunay triangulation of all the points, constrained to the lines if there are any.
    text : str
        "equal", how else it is right, or what is wrong.
    """

    is_right: bool
    text: str


def judge_answer(
    tin: TIN, answer: AnyArray, wanted: Triangles, *, steps: Triangles | None = None
) -> Verdict:
    """Judge an answer by our TIN, which has been checked, and its ranked triangles, ``wanted``.

    The answer is (m, 3) vertex numbers in the order of ``tin.points``, or (m, 3, 2) coordinates;
    ``steps`` are the (s, 2) vertices of the TIN that lines join.
    """
    triangles = answer.astype(np.int64) if answer.ndim == 2 else number_corners(answer, tin.points)
    if triangles.size and triangles.min() < 0:
        return Verdict(False, "has points that were not given")
    missing = len(wanted) - len(triangles)
    lost = len(tin.points) - len(np.unique(triangles))
    if missing or lost:
        return Verdict(False, _describe_loss(missing, len(wanted), lost, len(tin.points)))
    if np.array_equal(rank_triangles(triangles), wanted):
        return Verdict(True, EQUAL)
    return _judge_alone(tin, triangles, np.empty((0, 2), np.int64) if steps is None else steps)


def make_counting_judge(tin: TIN) -> Callable[[AnyArray], Verdict]:
    """Return a judge that only counts the triangles: for sets too large to compare."""

    def judge(answer: AnyArray) -> Verdict:
        missing = len(tin.triangles) - len(answer)
        text = _describe_loss(missing, len(tin.triangles), 0, len(tin.points))
        return Verdict(missing == 0, text or AS_MANY)

    return judge


def _describe_loss(missing: int, n_triangles: int, lost: int, n_points: int) -> str:
    parts = []
    if lost:
        parts.append(f"{lost:,} points lost ({lost / n_points:.1%})")
    if missing:
        word = "missing" if missing > 0 else "too many"
        parts.append(f"{abs(missing):,} triangles {word} ({abs(missing) / n_triangles:.1%})")
    return ", ".join(parts)


def _judge_alone(tin: TIN, triangles: Triangles, steps: Triangles) -> Verdict:
    lines = np.unique(encode_edges(steps))
    edges = encode_edges(np.stack([triangles[:, [1, 2, 0]], triangles[:, [2, 0, 1]]], axis=2))
    lost = len(lines) - np.count_nonzero(np.isin(lines, edges))
    if lost:
        return Verdict(False, f"{lost:,} edges of lines missing")
    try:
        theirs = TIN.from_triangles(tin.points, triangles, constrained=np.isin(edges, lines))
    except PointsError as error:
        return Verdict(False, f"no triangulation: {str(error).split(':')[0]}")
    result = check(theirs, level=3)
    if result.ok:
        ties = result.counts["ties_against_rule"]
        return Verdict(True, f"Delaunay; {ties:,} ties broken otherwise")
    return Verdict(False, "; ".join(_name_problem(problem) for problem in result.problems))


def _name_problem(problem: Problem) -> str:
    if problem.kind == "delaunay":
        return f"{problem.count:,} edges not Delaunay"
    return problem.sentence.rstrip(".")


def encode_edges(ends: AnyArray) -> Int64Array:
    """Return one number for each pair of vertex numbers, the same for both directions."""
    low, high = np.min(ends, axis=-1).astype(np.int64), np.max(ends, axis=-1)
    return low << 32 | high


def rank_triangles(triangles: AnyArray) -> Triangles:
    """Return triangles as sorted vertex numbers, one code each, in ascending order."""
    corners = np.sort(triangles.astype(np.int64), axis=1)
    return corners[np.lexsort(corners.T[::-1])]


def number_corners(corners: Float64Array, points: Float64Array) -> Triangles:
    """Find the vertex number of each corner by its coordinates, -1 where there is no such point."""
    order = np.lexsort((points[:, 1], points[:, 0]))
    known = _make_keys(points[order, :2])
    asked = _make_keys(corners.reshape(-1, 2))
    place = np.minimum(np.searchsorted(known, asked), len(known) - 1)
    found = np.where(known[place] == asked, order[place], -1)
    return found.reshape(-1, 3)


def _make_keys(xy: Float64Array) -> NDArray[np.complex128]:
    """Pairs as one value that sorts by x, then y."""
    return np.ascontiguousarray(xy, np.float64).view(np.complex128)[:, 0]
