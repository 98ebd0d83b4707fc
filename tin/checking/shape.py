"""Level 2 of a check: turns, boundary, overlaps, Euler count and areas."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .. import topology
from ..predicates import Columns, columns, is_last, orientation
from .boundary_sweep import Boundary, find_fault

if TYPE_CHECKING:
    from ...base.arrays import Float64Array, Int32Array
    from ..surface import TIN
    from .findings import Findings

_UNIT_ROUNDOFF = 2.0**-53


def check_shape(tin: TIN, found: Findings) -> None:
    """Check turns, boundary, overlaps, Euler count and areas."""
    xy = columns(tin.points)
    clockwise = np.flatnonzero(orientation(xy, *tin.triangles.T) <= 0)
    found.report("orientation", clockwise, "triangle", "[is|are] not counter-clockwise")
    rings = topology.boundary_rings(tin.triangles, tin.neighbors)
    found.counts["rings"] = len(rings)
    if not rings:
        found.fail("boundary", "The surface has no boundary: it closes upon itself.")
        return
    is_convex, is_free = _check_boundary(tin, xy, rings, found)
    if not (is_convex or len(clockwise)):
        # check that the boundary meets itself in vertices only, with the surface on one side of it
        fault = find_fault(find_boundary(tin))
        if fault is not None:
            what = (
                "The boundary crosses or overlaps itself, or runs through a vertex of itself"
                if fault.is_meeting
                else "Parts of the surface lie over each other"
            )
            sentence = f"{what} (westernmost: near vertex {fault.vertex})."
            found.fail("overlap", sentence, first=(fault.vertex,))
    if is_free and len(rings) > 1:
        found.fail(
            "boundary",
            f"The boundary has {len(rings)} rings: one is allowed if it is not constrained.",
        )
    _check_euler(rings, is_free, found)
    _check_areas(tin, rings, found)


def _check_boundary(
    tin: TIN, xy: Columns, rings: list[Int32Array], found: Findings
) -> tuple[bool, bool]:
    """Check that the boundary is convex where it is not constrained.

    Returns whether it is one convex ring, and whether any of it is not constrained.
    """
    here = np.concatenate(rings)
    before = np.concatenate([np.roll(ring, 1) for ring in rings])
    after = np.concatenate([np.roll(ring, -1) for ring in rings])
    triangle, corner = np.nonzero(tin.neighbors == topology.NO_NEIGHBOR)
    start, end = topology.ends(tin.triangles, triangle, corner)
    n = len(tin.points)
    keys = start * n + end
    order = np.argsort(keys)
    slots = [
        order[np.searchsorted(keys, a.astype(np.int64) * n + b, sorter=order)]
        for a, b in ((here, after), (before, here))
    ]
    is_constrained, came_constrained = (tin.constrained[triangle[at], corner[at]] for at in slots)
    is_reflex = orientation(xy, before, here, after) < 0
    is_allowed = is_constrained & came_constrained
    inwards = np.unique(here[is_reflex & ~is_allowed])
    found.report("hull", inwards, "vertex", "", before="The boundary turns inwards at ")
    is_start = is_last(xy, before, here) & is_last(xy, after, here)
    if not is_reflex.any() and np.count_nonzero(is_start) != len(rings):
        found.fail("hull", "The boundary winds about itself: a convex ring turns round once.")
    return len(rings) == 1 and not is_reflex.any(), not is_constrained.all()


def has_sound_boundary(found: Findings) -> bool:
    """Tell whether a level 2 without faults says which places lie inside the surface."""
    return found.lack("orientation", "boundary", "hull", "overlap")


def find_boundary(tin: TIN) -> Boundary:
    """Return the edges with a triangle on one side only."""
    triangle, corner = np.nonzero(tin.neighbors == topology.NO_NEIGHBOR)
    start, end = topology.ends(tin.triangles, triangle, corner)
    return Boundary(tin.points, start, end)


def _check_euler(rings: list[Int32Array], is_free: bool, found: Findings) -> None:
    """Check V - E + F + rings, which is 2 for every piece of a surface in the plane.

    The outer face is not counted; a vertex where the boundary touches itself counts each time.
    A constrained boundary may cut the surface into pieces.
    """
    counts = found.counts
    unused = sum(problem.count for problem in found.problems if problem.kind == "unused")
    boundary = np.concatenate(rings)
    touches = len(boundary) - len(np.unique(boundary))
    vertices = counts["vertices"] - unused + touches
    total = vertices - counts["edges"] + counts["triangles"] + len(rings)
    if total < 2 or total % 2 or (is_free and total > 2):
        found.fail(
            "euler",
            f"Vertices - edges + triangles + boundary rings is {total}: "
            "a surface in one piece has 2.",
        )


def _check_areas(tin: TIN, rings: list[Int32Array], found: Findings) -> None:
    """Compare the areas of all triangles with what the boundary encloses, rounding bounded."""
    corners = [tin.triangles[:, k] for k in range(3)]
    inside, inside_error = _measure_doubled_areas(tin.points, *corners)
    start = np.concatenate(rings)
    end = np.concatenate([np.roll(ring, -1) for ring in rings])
    enclosed, enclosed_error = _measure_doubled_areas(
        tin.points, np.full_like(start, start[0]), start, end
    )
    if not abs(inside - enclosed) <= inside_error + enclosed_error:
        found.fail(
            "area",
            f"The areas of the triangles add up to {inside / 2:.17g}, "
            f"but the boundary encloses {enclosed / 2:.17g}.",
        )


def _measure_doubled_areas(
    points: Float64Array, a: Int32Array, b: Int32Array, c: Int32Array
) -> tuple[float, float]:
    """Return twice the signed area of triangles, and a bound for its error.

    A term suffers four roundings; numpy's pairwise sum of n of them 16 + log2(n) more.
    """
    x, y = points[:, 0], points[:, 1]
    left = (x[b] - x[a]) * (y[c] - y[a])
    right = (y[b] - y[a]) * (x[c] - x[a])
    roundings = 4 + 16 + np.log2(len(a) + 1.0)
    size = np.abs(left).sum() + np.abs(right).sum()
    return float((left - right).sum()), float(2 * roundings * _UNIT_ROUNDOFF * size)
