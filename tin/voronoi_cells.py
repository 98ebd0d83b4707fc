r"""Voronoi cells within a box, from the Delaunay triangulation, as arrays.

A half-edge is an edge of a triangle as that triangle walks it, counter-clockwise; it is numbered
``3 * triangle + opposite corner``. Half-edges of the outer side of the hull follow::

          left triangle            Each is dual to one side of its start's cell: the part of the
              . c .                bisector between two circumcentres, walked with the cell on the
           start -> end            left. It ends at the circumcentre of the triangle on its left,
             \  .                  and begins where its twin, end -> start, ends.
          right triangle
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from . import _kernel, topology
from .topology import NO_NEIGHBOR

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ._kernel import Growth
    from .types import Bounds

__all__ = ["Rings", "cells_in_box", "signed_areas"]

_OUTSIDE = -1


class Rings(NamedTuple):
    """Rings one after the other, ring i between ``offsets[i]`` and ``offsets[i + 1]``."""

    coords: NDArray[np.float64]
    offsets: NDArray[np.int64]


class _HalfEdges(NamedTuple):
    start: NDArray[np.int64]
    left: NDArray[np.int64]
    twin: NDArray[np.int64]


class _Triangles(NamedTuple):
    """Twice the areas (m,) and circumcentres (m, 2), equal for cocircular neighbours."""

    doubled: NDArray[np.float64]
    centres: NDArray[np.float64]


class _Sides(NamedTuple):
    """Where the side of each half-edge ends, as a row of ``places``, and whether it is seen."""

    places: NDArray[np.float64]
    ends: NDArray[np.int64]
    on_wall: NDArray[np.bool_]
    seen: NDArray[np.bool_]


def cells_in_box(xy: NDArray[np.float64], growth: Growth, box: Bounds) -> Rings:
    """Return the Voronoi cell of each place within a box that holds them all.

    1. Turn about every vertex: its half-edges in order, by walking from twin to twin.
    2. Circumcentres, one for all triangles of a circle, which exact predicates find.
    3. Sides that leave the box are cut at its walls; those that never enter it fall away.
    4. What is left of the sides, end to end, is the cell; a corner of the box belongs to the
       nearest vertex.

    Parameters
    ----------
    xy : (n, 2) float64 array
        Distinct places.
    growth : Growth
        Their Delaunay triangulation.
    box : Bounds

    Returns
    -------
    Rings
        n rings, counter-clockwise, the first corner not repeated; no two corners in a row equal.
    """
    edges = _half_edges(growth.triangles, growth.neighbors)
    order = _turning_order(edges, len(xy), len(growth.triangles))
    sides = _sides(xy, growth.triangles, edges, box)
    rings = _without_repeats(*_walked(edges, sides, order), len(xy))
    return _with_area(_with_corners(rings, xy, box))


def signed_areas(rings: Rings) -> NDArray[np.float64]:
    """Return the area of each ring, positive counter-clockwise, 0 for an empty one."""
    count = np.diff(rings.offsets)
    ring = np.repeat(np.arange(len(count)), count)
    relative = rings.coords - rings.coords[rings.offsets[:-1][ring]]
    following = relative[_following(rings.offsets)]
    doubled = relative[:, 0] * following[:, 1] - relative[:, 1] * following[:, 0]
    return np.asarray(0.5 * np.bincount(ring, doubled, minlength=len(count)), np.float64)


# ---------------------------------------------------------------- around a vertex


def _half_edges(triangles: NDArray[np.int32], neighbors: NDArray[np.int32]) -> _HalfEdges:
    across = neighbors.ravel()
    n_inner = across.size
    start, end = topology.directed_edges(triangles)
    rim = np.flatnonzero(across == NO_NEIGHBOR)
    met = np.flatnonzero(across != NO_NEIGHBOR)
    corner = np.argmax(neighbors[across[met]] == (met // 3)[:, None], axis=1)
    twin = np.empty(n_inner + len(rim), np.int64)
    twin[met] = 3 * across[met].astype(np.int64) + corner
    twin[rim] = n_inner + np.arange(len(rim))
    twin[n_inner:] = rim
    return _HalfEdges(
        start=np.concatenate([start.ravel(), end.ravel()[rim]]),
        left=np.concatenate([np.arange(n_inner) // 3, np.full(len(rim), _OUTSIDE)]),
        twin=twin,
    )


def _turning_order(edges: _HalfEdges, n_vertices: int, n_triangles: int) -> NDArray[np.int64]:
    """Return the half-edges by start, and counter-clockwise around it; on the hull from the hull.

    How far each is from the last one is counted by doubling: as many rounds as the logarithm of
    the largest degree.
    """
    number = np.arange(len(edges.start))
    inner = number[: 3 * n_triangles]
    first = np.empty(n_vertices, np.int64)
    first[edges.start] = number
    rim = edges.twin[len(inner) :]
    first[edges.start[rim]] = rim
    following = number.copy()
    following[inner] = edges.twin[inner + np.where(inner % 3 == 0, 2, -1)]
    following = np.where(following == first[edges.start], number, following)
    to_last = (following != number).astype(np.int64)
    while (beyond := to_last[following]).any():
        to_last += beyond
        following = following[following]
    begin = np.cumsum(np.bincount(edges.start, minlength=n_vertices))
    order = np.empty_like(number)
    order[begin[edges.start] - 1 - to_last] = number
    return order


# ---------------------------------------------------------------- circumcentres


def _circles(
    xy: NDArray[np.float64], triangles: NDArray[np.int32], edges: _HalfEdges
) -> _Triangles:
    """Return areas and circumcentres, taken from the corner between the two shorter sides.

    There the rounding of the area is least, relative to the longest side. An area that rounds to
    nothing leaves no circumcentre: NaN, which is nowhere.
    """
    corners = [xy[triangles[:, k]] for k in range(3)]
    lengths = [((corners[k - 2] - corners[k - 1]) ** 2).sum(axis=1) for k in range(3)]
    apex = np.argmax(lengths, axis=0)
    rows = np.arange(len(triangles))
    origin, one, other = (xy[triangles[rows, (apex + k) % 3]] for k in range(3))
    u, w = one - origin, other - origin
    doubled = u[:, 0] * w[:, 1] - u[:, 1] * w[:, 0]
    weighted = u * (w**2).sum(axis=1)[:, None] - w * (u**2).sum(axis=1)[:, None]
    turned = np.stack([-weighted[:, 1], weighted[:, 0]], axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        centres = origin + turned / (2.0 * doubled)[:, None]
    return _Triangles(doubled, centres[_on_one_circle(xy, triangles, edges)])


def _on_one_circle(
    xy: NDArray[np.float64], triangles: NDArray[np.int32], edges: _HalfEdges
) -> NDArray[np.int64]:
    """Return for each triangle the first one of those on the same circle, exactly."""
    inner = np.arange(triangles.size)
    once = inner[edges.twin[: triangles.size] > inner]
    once = once[edges.left[edges.twin[once]] != _OUTSIDE]
    twin = edges.twin[once]
    opposite = triangles.ravel()[twin]
    a, b, c = (xy[triangles[once // 3, k]] for k in range(3))
    tied = _kernel.in_circle(a, b, c, xy[opposite]) == 0
    return _first_of_group(once[tied] // 3, twin[tied] // 3, len(triangles))


def _first_of_group(
    one: NDArray[np.int64], other: NDArray[np.int64], count: int
) -> NDArray[np.int64]:
    """Join pairs to groups, and return for each member the smallest of its group."""
    first = np.arange(count)
    while True:
        low, high = np.minimum(first[one], first[other]), np.maximum(first[one], first[other])
        if (low == high).all():
            return first
        np.minimum.at(first, high, low)
        while (first != first[first]).any():
            first = first[first]


# ---------------------------------------------------------------- the walls of the box


def _sides(
    xy: NDArray[np.float64], triangles: NDArray[np.int32], edges: _HalfEdges, box: Bounds
) -> _Sides:
    circles = _circles(xy, triangles, edges)
    low, high = np.array([box.xmin, box.ymin]), np.array([box.xmax, box.ymax])
    within = np.all((circles.centres >= low) & (circles.centres <= high), axis=1)
    is_in = np.append(within, False)[edges.left]
    crossing = ~(is_in & is_in[edges.twin])
    one = np.flatnonzero(crossing & (edges.twin > np.arange(len(edges.twin))))
    other = edges.twin[one]
    middle, normal = _bisectors(xy[edges.start[one]], xy[edges.start[other]])
    until, last = _at_wall(middle, normal, low, high)
    since, first = _at_wall(middle, -normal, low, high)
    begin = np.maximum(-since, -_reach(xy, triangles, circles.doubled, edges, other))
    end = np.minimum(until, _reach(xy, triangles, circles.doubled, edges, one))
    seen = np.ones(len(edges.twin), np.bool_)
    seen[one] = seen[other] = is_in[one] | is_in[other] | (begin < end)
    ends = edges.left.copy()
    for half, row in ((one, len(within)), (other, len(within) + len(one))):
        ends[half] = np.where(is_in[half], ends[half], row + np.arange(len(one)))
    return _Sides(np.concatenate([circles.centres, last, first]), ends, ~is_in, seen)


def _bisectors(
    start: NDArray[np.float64], end: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the middles of edges, and the edges turned to the left."""
    step = end - start
    return start + 0.5 * step, np.stack([-step[:, 1], step[:, 0]], axis=1)


def _reach(
    xy: NDArray[np.float64],
    triangles: NDArray[np.int32],
    doubled: NDArray[np.float64],
    edges: _HalfEdges,
    half: NDArray[np.int64],
) -> NDArray[np.float64]:
    """Return how far along its bisector the circumcentre on the left of each half-edge lies.

    In lengths of the edge: half the cotangent of the angle opposite. Infinite on the outer side
    of the hull, and where the triangle's area rounds to nothing.
    """
    reach = np.full(len(half), np.inf)
    is_met = edges.left[half] != _OUTSIDE
    half = half[is_met]
    apex = xy[triangles.ravel()[half]]
    one, other = xy[edges.start[half]] - apex, xy[edges.start[edges.twin[half]]] - apex
    with np.errstate(divide="ignore"):
        twice = (one * other).sum(axis=1) / np.maximum(doubled[edges.left[half]], 0.0)
    reach[is_met] = 0.5 * twice
    return reach


def _at_wall(
    middle: NDArray[np.float64],
    normal: NDArray[np.float64],
    low: NDArray[np.float64],
    high: NDArray[np.float64],
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return where rays from inside a box meet its wall: how far along, and the place."""
    wall = np.where(normal > 0, high, low)
    along = np.full(normal.shape, np.inf)
    np.divide(wall - middle, normal, out=along, where=normal != 0)
    axis = np.argmin(along, axis=1)
    rows = np.arange(len(along))
    reach = along[rows, axis]
    places = np.clip(middle + normal * reach[:, None], low, high)
    places[rows, axis] = wall[rows, axis]
    return reach, places


# ---------------------------------------------------------------- rings


def _walked(
    edges: _HalfEdges, sides: _Sides, order: NDArray[np.int64]
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Return the corners of the cells: ends of sides, and beginnings of those that enter the box.

    The second array tells the cell of each.
    """
    order = order[sides.seen[order]]
    before = edges.twin[order]
    stops = np.stack([sides.ends[before], sides.ends[order]], axis=1).ravel()
    is_corner = np.stack([sides.on_wall[before], np.ones(len(order), np.bool_)], axis=1).ravel()
    cell = np.repeat(edges.start[order], 2)
    return sides.places[stops[is_corner]], cell[is_corner]


def _without_repeats(coords: NDArray[np.float64], cell: NDArray[np.int64], n_cells: int) -> Rings:
    """Drop corners that equal the one after them."""
    differs = (coords != coords[_following(_offsets(cell, n_cells))]).any(axis=1)
    return Rings(coords[differs], _offsets(cell[differs], n_cells))


def _with_area(rings: Rings) -> Rings:
    """Empty the rings of fewer than three corners: cells of the width of a rounding."""
    counts = np.diff(rings.offsets)
    left = np.where(counts >= 3, counts, 0)
    return Rings(rings.coords[np.repeat(left > 0, counts)], np.append(0, np.cumsum(left)))


def _offsets(cell: NDArray[np.int64], n_cells: int) -> NDArray[np.int64]:
    return np.concatenate([[0], np.cumsum(np.bincount(cell, minlength=n_cells))])


def _following(offsets: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return for each corner the number of the next one in its ring."""
    following = np.arange(1, offsets[-1] + 1)
    is_full = np.diff(offsets) > 0
    following[offsets[1:][is_full] - 1] = offsets[:-1][is_full]
    return following


def _with_corners(rings: Rings, xy: NDArray[np.float64], box: Bounds) -> Rings:
    """Add each corner of the box to the cell of the nearest vertex."""
    coords, offsets = rings
    for x in (box.xmin, box.xmax):
        for y in (box.ymin, box.ymax):
            corner = np.array([x, y])
            owner = int(np.argmin(((xy - corner) ** 2).sum(axis=1)))
            part = slice(offsets[owner], offsets[owner + 1])
            if (coords[part] == corner).all(axis=1).any():
                continue
            ring = _around_mean(np.concatenate([coords[part], [corner]]))
            coords = np.concatenate([coords[: part.start], ring, coords[part.stop :]])
            offsets = offsets + (np.arange(len(offsets)) > owner)
    return Rings(coords, offsets)


def _around_mean(coords: NDArray[np.float64]) -> NDArray[np.float64]:
    """Sort the corners of a convex polygon counter-clockwise."""
    x, y = (coords - coords[0] - (coords - coords[0]).mean(axis=0)).T
    turned: NDArray[np.float64] = coords[np.argsort(np.arctan2(y, x), kind="stable")]
    return turned
