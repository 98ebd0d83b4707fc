"""Edges of any triangles that their (constrained) Delaunay triangulation does not have."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .. import topology
from ..predicates import Columns, blocks, columns, in_circle, is_last

if TYPE_CHECKING:
    from ...base.arrays import BoolArray, Int64Array
    from .triangulation import Triangulation


def mark_illegal_edges(surface: Triangulation) -> BoolArray:
    """Mark the edges that triangulating the vertices and lines of a surface anew would not make.

    Returns flags of the edge opposite each corner, (m, 3): inner ones that are not constrained, and
    not Delaunay or the other diagonal of four cocircular points. Each is marked in one of its two
    triangles. A triangulation with these edges constrained, too, is ``surface``.
    """
    xy = columns(surface.points)
    marks = np.zeros((len(surface.triangles), 3), np.bool_)
    for block in blocks(len(surface.triangles)):
        triangle, *quad = gather_quadrilaterals(surface, block, conforming=False)
        side = in_circle(xy, *quad)
        is_illegal = side > 0
        tied = np.flatnonzero(side == 0)
        is_illegal[tied] = is_against_rule(xy, *(corner[tied] for corner in quad))
        own, opposite = triangle[is_illegal], quad[0][is_illegal]
        marks[own, np.argmax(surface.triangles[own] == opposite[:, None], axis=1)] = True
    return marks


def gather_quadrilaterals(
    surface: Triangulation, block: slice, conforming: bool
) -> tuple[Int64Array, ...]:
    """Return triangle, its corners from the one opposite an inner edge, and the far corner.

    Every edge comes once, and only if both triangles are counter-clockwise does its sign mean
    anything: level 2 tells.
    """
    own = np.arange(block.start, block.stop)[:, None]
    is_once = surface.neighbors[block] > own
    if not conforming:
        is_once &= ~surface.constrained[block]
    row, corner = np.nonzero(is_once)
    triangle = row + block.start
    a = surface.triangles[triangle, corner].astype(np.int64)
    b, c = topology.ends(surface.triangles, triangle, corner)
    across = surface.triangles[surface.neighbors[triangle, corner]]
    far = across[:, 0].astype(np.int64) + across[:, 1] + across[:, 2] - b - c
    return triangle, a, b, c, far


def is_against_rule(
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
