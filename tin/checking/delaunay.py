"""Level 3 of a check: every edge is Delaunay that is not constrained, or every one at all."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .. import topology
from ..predicates import Columns, blocks, columns, in_circle, is_last

if TYPE_CHECKING:
    from ...arrays import BoolArray, Int64Array
    from ..surface import TIN
    from .findings import Findings

__all__ = ["check_delaunay", "mark_illegal_edges"]


def check_delaunay(tin: TIN, found: Findings, *, conforming: bool = False) -> None:
    """Check every inner edge against the triangle across; constrained ones if it is conforming."""
    xy = columns(tin.points)
    wrong, against_rule = [], []
    n_ties = 0
    for block in blocks(len(tin.triangles)):
        triangle, *quad = _gather_quadrilaterals(tin, block, conforming)
        side = in_circle(xy, *quad)
        tied = np.flatnonzero(side == 0)
        n_ties += len(tied)
        wrong.append(triangle[side > 0])
        is_against = _is_against_rule(xy, *(corner[tied] for corner in quad))
        against_rule.append(triangle[tied[is_against]])
    found.report(
        "delaunay",
        np.concatenate(wrong),
        "{count} [edge is|edges are] not Delaunay: the far corner lies in the circle of a "
        "triangle at "
        "[it|them] (first: [triangle|triangles] {first}).",
    )
    found.note(
        "tie",
        np.concatenate(against_rule),
        "{count} [edge joins|edges join] four cocircular points the other way than tinsmith "
        "would, which is "
        "Delaunay too (first: [triangle|triangles] {first}).",
    )
    found.counts["ties"] = n_ties
    found.counts["ties_against_rule"] = sum(len(triangles) for triangles in against_rule)


def mark_illegal_edges(tin: TIN) -> BoolArray:
    """Mark the edges that triangulating the vertices and lines of a surface anew would not make.

    Parameters
    ----------
    tin : TIN
        Of any triangles, as files have them.

    Returns
    -------
    (m, 3) bool array
        Of the edge opposite each corner: inner ones that are not constrained, and not Delaunay or
        the other diagonal of four cocircular points. Each is marked in one of its two triangles. A
        triangulation with these edges constrained, too, is that of ``tin``.
    """
    xy = columns(tin.points)
    marks = np.zeros((len(tin.triangles), 3), np.bool_)
    for block in blocks(len(tin.triangles)):
        triangle, *quad = _gather_quadrilaterals(tin, block, conforming=False)
        side = in_circle(xy, *quad)
        is_illegal = side > 0
        tied = np.flatnonzero(side == 0)
        is_illegal[tied] = _is_against_rule(xy, *(corner[tied] for corner in quad))
        own, opposite = triangle[is_illegal], quad[0][is_illegal]
        marks[own, np.argmax(tin.triangles[own] == opposite[:, None], axis=1)] = True
    return marks


def _gather_quadrilaterals(tin: TIN, block: slice, conforming: bool) -> tuple[Int64Array, ...]:
    """Return triangle, its corners from the one opposite an inner edge, and the far corner.

    Every edge comes once, and only if both triangles are counter-clockwise does its sign mean
    anything: level 2 tells.
    """
    own = np.arange(block.start, block.stop)[:, None]
    is_once = tin.neighbors[block] > own
    if not conforming:
        is_once &= ~tin.constrained[block]
    row, corner = np.nonzero(is_once)
    triangle = row + block.start
    a = tin.triangles[triangle, corner].astype(np.int64)
    b, c = topology.ends(tin.triangles, triangle, corner)
    across = tin.triangles[tin.neighbors[triangle, corner]]
    far = across[:, 0].astype(np.int64) + across[:, 1] + across[:, 2] - b - c
    return triangle, a, b, c, far


def _is_against_rule(
    xy: Columns,
    a: Int64Array,
    b: Int64Array,
    c: Int64Array,
    far: Int64Array,
) -> BoolArray:
    """Tell where the diagonal b-c of a cocircular quad ends at its lexicographically last point.

    The rule lifts that point above the others' plane, so the other diagonal is the lower one.
    """
    last_end = np.where(is_last(xy, b, c), b, c)
    last_opposite = np.where(is_last(xy, a, far), a, far)
    return is_last(xy, last_end, last_opposite)
