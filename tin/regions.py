"""Which part of a triangulated hull is the surface: boundary, holes, trimming at long edges."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from . import _kernel, topology
from .errors import LinesError

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["Surface", "clipped", "edge_keys", "in_rings", "is_inside", "trimmed"]


class Surface(NamedTuple):
    """Triangles over vertices, as in a TIN."""

    points: NDArray[np.float64]
    triangles: NDArray[np.int32]
    neighbors: NDArray[np.int32]
    constrained: NDArray[np.bool_]


def in_rings(xy: NDArray[np.float64], rings: Sequence[NDArray[np.float64]]) -> NDArray[np.int8]:
    """Tell where places lie: +1 inside an odd number of rings, 0 on one, -1 outside."""
    offsets = np.concatenate([[0], np.cumsum([len(ring) for ring in rings])]).astype(np.int32)
    corners = np.ascontiguousarray(np.concatenate([ring[:, :2] for ring in rings]))
    return _kernel.places_in_rings(np.ascontiguousarray(xy), corners, offsets)


def edge_keys(pairs: NDArray[np.int32], n_vertices: int) -> NDArray[np.int64]:
    """Return one number for each (k, 2) pair of vertices, whatever its direction."""
    low = pairs.min(axis=1).astype(np.int64)
    keys: NDArray[np.int64] = low * n_vertices + pairs.max(axis=1)
    return keys


def is_inside(
    surface: Surface,
    steps: NDArray[np.int32],
    boundaries: Sequence[Sequence[NDArray[np.float64]]],
    holes: Sequence[NDArray[np.float64]],
) -> NDArray[np.bool_]:
    """Tell which triangles lie inside every boundary, each of one or more rings, and in no hole.

    ``steps`` are the edges, (k, 2) vertex pairs, along which the rings run. The triangles between
    them are one region; a place in its largest triangle, compared with the rings as they were
    given, tells for all of it. (A ring's own vertices may have been rounded, the inside of the
    largest triangle is not in doubt.)
    """
    region, largest = _regions(surface, steps)
    place = _center(surface, largest)
    keep = np.ones(len(place), np.bool_)
    for rings in boundaries:
        keep &= in_rings(place, rings) > 0
    within = keep.copy()
    for number, hole in enumerate(holes):
        is_hole = in_rings(place, [hole]) > 0
        if not (within & is_hole).any():
            raise LinesError(
                f"Hole {number} lies outside the surface: it must cut away a part of it.",
                lines=[number],
            )
        keep &= ~is_hole
    chosen: NDArray[np.bool_] = keep[region]
    return chosen


def _regions(
    surface: Surface, steps: NDArray[np.int32]
) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
    n = len(surface.points)
    triangle, corner = np.nonzero(surface.constrained)
    start, end = topology.ends(surface.triangles, triangle, corner)
    own = edge_keys(np.stack([start, end], axis=1).astype(np.int32), n)
    barrier = np.zeros(surface.constrained.shape, np.bool_)
    barrier[triangle, corner] = np.isin(own, edge_keys(steps, n))
    xy = np.ascontiguousarray(surface.points[:, :2])
    return _kernel.regions(xy, surface.triangles, surface.neighbors, barrier)


def _center(surface: Surface, triangles: NDArray[np.int32]) -> NDArray[np.float64]:
    a, b, c = (surface.points[surface.triangles[triangles, k], :2] for k in range(3))
    center: NDArray[np.float64] = a + ((b - a) + (c - a)) / 3.0
    return center


def trimmed(
    surface: Surface, keep: NDArray[np.bool_], max_edge: float, *, everywhere: bool
) -> NDArray[np.bool_]:
    """Drop triangles at edges longer than ``max_edge`` that are no lines.

    From the perimeter only the triangles go that lie at a long outer edge, as long as there are
    any; everywhere all that have a long edge.
    """
    a, b, c = (surface.points[surface.triangles[:, k], :2] for k in range(3))
    sides = np.stack([np.hypot(*(c - b).T), np.hypot(*(a - c).T), np.hypot(*(b - a).T)], axis=1)
    is_long = (sides > max_edge) & ~surface.constrained
    keep = keep.copy()
    if everywhere:
        keep &= ~is_long.any(axis=1)
        return keep
    candidates = np.flatnonzero(keep & is_long.any(axis=1))
    while len(candidates):
        beside = surface.neighbors[candidates]
        is_outer = (beside == topology.NO_NEIGHBOR) | ~keep[beside]
        gone = candidates[(is_long[candidates] & is_outer).any(axis=1)]
        keep[gone] = False
        near = surface.neighbors[gone].ravel()
        near = near[near != topology.NO_NEIGHBOR]
        candidates = np.unique(near[keep[near]])
    return keep


def clipped(surface: Surface, keep: NDArray[np.bool_]) -> tuple[Surface, NDArray[np.int32]]:
    """Return the kept triangles with the vertices that they use, and the new number of each vertex.

    Vertices without a triangle have number -1. The new rim is constrained.
    """
    number = np.cumsum(keep, dtype=np.int32) - np.int32(1)
    beside = surface.neighbors[keep]
    is_outer = (beside == topology.NO_NEIGHBOR) | ~keep[beside]
    corners = surface.triangles[keep]
    is_used = np.zeros(len(surface.points), np.bool_)
    is_used[corners] = True
    vertex = np.where(is_used, np.cumsum(is_used, dtype=np.int32) - np.int32(1), np.int32(-1))
    return (
        Surface(
            surface.points[is_used],
            vertex[corners],
            np.where(is_outer, np.int32(topology.NO_NEIGHBOR), number[beside]),
            surface.constrained[keep] | is_outer,
        ),
        vertex,
    )
