"""Tasks that are squares of a quadtree: where these lie follows from all points, not from tiles."""

from __future__ import annotations

from dataclasses import asdict
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.errors import PointsError
from ...terrain.simplification.pyramid import Node, Quadtree, make_finest
from ..division import Tile
from ..tasks import TileJob

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from ...base.arrays import Int64Array
    from ...base.types import Bounds
    from ...terrain.simplification.pyramid import Mesh
    from ...tin.tiling import LocalTriangulation
    from ..reading import StoredPoints


def settle_quadtree(points: StoredPoints, node_points: int) -> dict[str, Any]:
    """Return the squares over all points as plain values.

    Raises
    ------
    PointsError
        If all points lie on one line.
    """
    if not (points.bounds.width > 0 and points.bounds.height > 0):
        raise PointsError("All points lie on one line: there is no surface.")
    return asdict(Quadtree.over(points.bounds, points.count, node_points))


def divide_points(
    options: Mapping[str, Any],
    counts: Int64Array,
    bounds: Bounds,
    *,
    most: int,
    fewest_tiles: int,
) -> list[Tile]:
    """Return squares that have few enough points, or are of the finest level."""
    tree = Quadtree(**options["quadtree"])
    sums = np.zeros((len(counts) + 1, len(counts) + 1), np.int64)
    sums[1:, 1:] = counts.cumsum(axis=0).cumsum(axis=1)
    tiles = [_make_tile(Node(0, 0, 0), tree, sums, bounds)]
    while True:
        large = [
            tile
            for tile in tiles
            if (tile.count > most or len(tiles) < fewest_tiles)
            and as_node(tile).level < tree.levels
        ]
        if not large:
            return tiles
        largest = max(large, key=lambda tile: tile.count)
        tiles.remove(largest)
        parts = [_make_tile(child, tree, sums, bounds) for child in as_node(largest).children]
        tiles += [part for part in parts if _meet(part.box, bounds)]


def _make_tile(node: Node, tree: Quadtree, sums: Int64Array, bounds: Bounds) -> Tile:
    """Return a square as a tile, with the points in it as far as the lattice of counts tells."""
    box, side = tree.find_box(node), len(sums) - 1
    ends = []
    for low, high, first, extent in (
        (box.ymin, box.ymax, bounds.ymin, bounds.height),
        (box.xmin, box.xmax, bounds.xmin, bounds.width),
    ):
        share = (np.array([low, high]) - first) / extent
        ends.append(np.clip(np.rint(share * side), 0, side).astype(int).tolist())
    (south, north), (west, east) = ends
    count = sums[north, east] - sums[south, east] - sums[north, west] + sums[south, west]
    return Tile(node.key, box, int(count))


def _meet(box: Bounds, other: Bounds) -> bool:
    """Tell whether two closed boxes have a place in common."""
    across = box.xmin <= other.xmax and other.xmin <= box.xmax
    return across and box.ymin <= other.ymax and other.ymin <= box.ymax


def as_node(tile: Tile) -> Node:
    """Return the square that a tile is."""
    return Node(*map(int, tile.key.split(".")))


def divide_job(job: TileJob) -> list[TileJob]:
    """Return the quarters of a square that was too large, none if it is of the finest level."""
    node, tree = as_node(job.tile), Quadtree(**job.options["quadtree"])
    if node.level == tree.levels:
        return []
    return [
        TileJob(
            job.folder,
            job.points,
            Tile(child.key, tree.find_box(child), job.tile.count // 4),
            job.product,
            job.options,
            job.duplicates,
        )
        for child in node.children
    ]


def list_finest(
    local: LocalTriangulation, root: Node, tree: Quadtree, tolerance: float
) -> Iterator[tuple[Node, Mesh]]:
    """Yield the finest squares in a square, with the surface in them within a tolerance."""
    corners = local.points[local.triangles, :2]
    (west, south), (east, north) = corners.min(axis=1).T, corners.max(axis=1).T
    for node in root.list_descendants(tree.levels):
        box = tree.find_box(node)
        across = (west <= box.xmax) & (east >= box.xmin)
        rows = np.flatnonzero(across & (south <= box.ymax) & (north >= box.ymin))
        mesh = make_finest(local.points, local.triangles[rows], box, tolerance)
        if mesh is not None:
            yield node, mesh
