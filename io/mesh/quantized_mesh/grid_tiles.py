"""The tiles of a level: a surface on the grid of the level, cut along its tiles.

What a tile holds is a function of the triangles that meet it and its neighbours alone, whatever
their order and however many others there are: vertices come in the order of their coordinates,
triangles in that of their vertices.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ....tin.topology import edge_keys
from .levels import GridMesh, cut_along_grid
from .tile import STEPS, Tile, TileName, to_cartesian

if TYPE_CHECKING:
    from ....base.arrays import Float64Array, Int64Array

FROM_CORNER = np.array([180.0, 90.0, 0.0])
"""What makes longitude and latitude count from the south-west corner of all tiles."""

_FINEST_HEIGHT_STEP = 2.0**-10
"""Metres: about a millimetre; a power of two, so that float32 holds the heights of a header."""


class Places(NamedTuple):
    """A surface on the globe.

    Attributes
    ----------
    points : (n, 3) float64 array
        Degrees, and metres above the ellipsoid; each place once, in order.
    triangles : (m, 3) int64 array
    """

    points: Float64Array
    triangles: Int64Array

    @classmethod
    def of(cls, points: Float64Array, triangles: Int64Array) -> Places:
        """Return the vertices of triangles in order, those at one place and height as one."""
        used, corners = np.unique(triangles, return_inverse=True)
        points = points[used]
        order = np.lexsort(points.T[::-1])
        is_new = np.append(True, (np.diff(points[order], axis=0) != 0).any(axis=1))[: len(order)]
        number = np.empty(len(order), np.int64)
        number[order] = np.cumsum(is_new) - 1
        triangles = number[corners.reshape(-1, 3)]
        is_whole = (triangles != np.roll(triangles, 1, axis=1)).all(axis=1)
        return cls(points[order[is_new]], triangles[is_whole])


class GridTile(NamedTuple):
    """A tile before its heights are rounded.

    Attributes
    ----------
    steps : (n, 2) int64 array
    heights : (n,) float64 array
    triangles : (m, 3) int64 array
    normals : (n, 3) float64 array
    """

    steps: Int64Array
    heights: Float64Array
    triangles: Int64Array
    normals: Float64Array

    def round(self, height_step: float) -> Tile:
        """Return the tile with heights on one grid for all tiles of the level."""
        heights = np.rint(self.heights / height_step).astype(np.int64)
        lowest = int(heights.min())
        return Tile(
            np.column_stack([self.steps, heights - lowest]),
            self.triangles,
            lowest * height_step,
            (lowest + STEPS) * height_step,
            self.normals,
        )


class LevelTiles:
    """The tiles of a level in which there are triangles.

    Parameters
    ----------
    places : Places
        From the south-west corner of all tiles.
    level : int

    Attributes
    ----------
    names : list of TileName
    ranges : (k, 2) float64 array
        The lowest and the highest of each, metres.
    """

    def __init__(self, places: Places, level: int) -> None:
        scale = STEPS * 2**level / 180.0
        mesh = _start(places, scale)
        self._mesh = mesh = cut_along_grid(mesh, STEPS)
        self._normals = _sum_normals(mesh, scale)
        tiles = mesh.steps[mesh.triangles].min(axis=1) // STEPS
        order = np.lexsort((tiles[:, 1], tiles[:, 0]))
        starts = np.flatnonzero(np.diff(tiles[order], axis=0, prepend=-1).any(axis=1))
        self._groups = np.split(order, starts[1:]) if len(order) else []
        heights = mesh.heights[mesh.triangles]
        self.names = [TileName(level, *tiles[rows[0]].tolist()) for rows in self._groups]
        ranges = [[heights[rows].min(), heights[rows].max()] for rows in self._groups]
        self.ranges = np.array(ranges, np.float64).reshape(-1, 2)

    def gather(self, k: int) -> GridTile:
        """Return a tile by its place among the names."""
        mesh, name = self._mesh, self.names[k]
        used, number = np.unique(mesh.triangles[self._groups[k]], return_inverse=True)
        plane = mesh.steps[used] - np.array([name.x, name.y]) * STEPS
        return GridTile(plane, mesh.heights[used], number.reshape(-1, 3), self._normals[used])


def _start(places: Places, scale: float) -> GridMesh:
    """Return vertices on the grid, and triangles in order, from their first vertices on."""
    used, corners = np.unique(places.triangles, return_inverse=True)
    triangles = corners.reshape(-1, 3)
    turn = (triangles.argmin(axis=1)[:, None] + np.arange(3)) % 3
    triangles = np.take_along_axis(triangles, turn, axis=1)
    triangles = triangles[np.argsort(edge_keys(triangles[:, :2], len(used)), kind="stable")]
    points = places.points[used]
    return GridMesh(np.rint(points[:, :2] * scale).astype(np.int64), points[:, 2], triangles)


def _sum_normals(mesh: GridMesh, scale: float) -> Float64Array:
    """Return the normals of vertices, in the axes of the globe."""
    points = to_cartesian(np.column_stack([mesh.steps / scale - FROM_CORNER[:2], mesh.heights]))
    a, b, c = (points[mesh.triangles[:, k]] for k in range(3))
    faces = np.cross(b - a, c - a)
    corners = mesh.triangles.ravel()
    sums = np.column_stack(
        [np.bincount(corners, np.repeat(axis, 3), len(points)) for axis in faces.T]
    ).astype(np.float64)  # whole numbers where there is no triangle
    lengths = np.linalg.norm(sums, axis=1, keepdims=True)
    return np.asarray(np.divide(sums, lengths, out=np.zeros_like(sums), where=lengths > 0))


def choose_height_step(ranges: Float64Array) -> float:
    """Return the step of heights of a level, metres, from the ranges of its tiles, (k, 2)."""
    least = max(_FINEST_HEIGHT_STEP, float(np.abs(ranges).max()) / 2**22)
    step = float(2.0 ** np.ceil(np.log2(least)))
    low, high = ranges.T
    while (np.rint(high / step) - np.rint(low / step) > STEPS).any():
        step *= 2
    return step
