"""Footprint: the ground that a surface covers, and the water in it, as polygons."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...base import optional
from ..drawing import find_line_edges

if TYPE_CHECKING:
    from ...base.arrays import AnyArray, BoolArray, Float64Array, Int32Array, Int64Array
    from ...tin import TIN


class Footprint(NamedTuple):
    """Polygons that tile a surface."""

    faces: AnyArray
    """Of ``shapely.Polygon``."""
    is_water: BoolArray
    """(k,)."""


class Pieces(NamedTuple):
    """A footprint in cells: what of it lies in each, of every polygon apart."""

    corners: Float64Array
    """(n, 2), of the polygons, piece after piece."""
    owners: Int64Array
    """(n,), the piece that each is of."""
    cells: Int64Array
    """(k, 2), column and row of each piece."""
    centers: Float64Array
    """(k, 2), means of their corners."""


def find_footprint(tin: TIN) -> Footprint:
    """Return the polygons between the boundary of a surface and the edges of its water.

    Water is flat and has water's edges around it; which polygons are water is told by their own
    triangles, since rings may be cut by the boundary.
    """
    shapely = optional.load("shapely")
    edges = find_line_edges(tin).of("water")
    rings = [np.append(ring, ring[0]) for ring in tin.boundary]
    boundary = [np.column_stack([ring[:-1], ring[1:]]) for ring in rings]
    pairs = np.unique(np.sort(np.concatenate([edges, *boundary]), axis=1), axis=0)
    lines = shapely.linestrings(tin.points[pairs][:, :, :2])
    faces = shapely.get_parts(shapely.polygonize(lines))
    inside = tin.locate(shapely.get_coordinates(shapely.point_on_surface(faces)))
    faces, inside = faces[inside >= 0], inside[inside >= 0]
    return Footprint(faces, _find_water(tin, faces, inside, edges))


def _find_water(tin: TIN, faces: AnyArray, triangles: Int32Array, edges: Int32Array) -> BoolArray:
    """Tell which faces are water: flat, along a shore, and in a ring of it if all are closed."""
    shapely = optional.load("shapely")
    shores = {tuple(place) for place in tin.points[np.unique(edges)][:, :2].tolist()}
    heights = tin.points[tin.triangles[triangles], 2]
    is_flat = np.ptp(heights, axis=1) == 0
    rings = _list_water_rings(tin)
    is_water = np.zeros(len(faces), np.bool_)
    for k in np.flatnonzero(is_flat).tolist():
        outer = shapely.get_coordinates(shapely.get_exterior_ring(faces[k])).tolist()
        if not any(tuple(a) in shores and tuple(b) in shores for a, b in pairwise(outer)):
            continue
        inside = shapely.contains_properly(rings, shapely.point_on_surface(faces[k]))
        is_water[k] = inside.sum() % 2 == 1 if len(rings) else True
    return is_water


def _list_water_rings(tin: TIN) -> AnyArray:
    """Return the closed rings of water as polygons; none if one of them is cut."""
    shapely = optional.load("shapely")
    kinds = zip(tin.lines.chains(), tin.lines.kinds, strict=True)
    chains = [chain for chain, kind in kinds if kind == "water"]
    if not all(len(chain) > 3 and chain[0] == chain[-1] for chain in chains):
        return np.empty(0, object)
    return np.array([shapely.Polygon(tin.points[chain, :2]) for chain in chains], object)


# ---------------------------------------------------------------- in cells


def cut_into_pieces(faces: AnyArray, side: float) -> Pieces:
    """Cut polygons into what lies in each cell of a square grid, of a side in CRS units.

    Halved again and again, so that the time is in proportion to the corners and the logarithm of
    the number of cells.
    """
    shapely = optional.load("shapely")
    west, south, east, north = shapely.total_bounds(faces)
    columns = max(1, int(np.ceil((east - west) / side)))
    rows = max(1, int(np.ceil((north - south) / side)))
    todo: list[tuple[Any, int, int, int, int]] = [(face, 0, 0, columns, rows) for face in faces]
    shapes, cells = [], []
    while todo:
        shape, left, low, right, top = todo.pop()
        if shapely.is_empty(shape) or shapely.get_num_coordinates(shape) == 0:
            continue
        if right - left <= 1 and top - low <= 1:
            shapes.append(shape)
            cells.append((left, low))
            continue
        for half in _halve(left, low, right, top):
            x, y = west + side * half[0], south + side * half[1]
            far = west + side * half[2], south + side * half[3]
            todo.append((shapely.clip_by_rect(shape, x, y, *far), *half))
    return _gather(shapes, cells)


def _halve(left: int, low: int, right: int, top: int) -> list[tuple[int, int, int, int]]:
    if right - left >= top - low:
        middle = (left + right) // 2
        return [(left, low, middle, top), (middle, low, right, top)]
    middle = (low + top) // 2
    return [(left, low, right, middle), (left, middle, right, top)]


def _gather(shapes: list[Any], cells: list[tuple[int, int]]) -> Pieces:
    shapely = optional.load("shapely")
    corners, owners = shapely.get_coordinates(shapes, return_index=True)
    counts = np.bincount(owners, minlength=len(shapes))
    sums = np.column_stack([np.bincount(owners, corners[:, axis], len(shapes)) for axis in (0, 1)])
    return Pieces(corners, owners, np.array(cells, np.int64).reshape(-1, 2), sums / counts[:, None])
