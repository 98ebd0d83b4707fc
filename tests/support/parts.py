"""Surfaces in parts: data that parts find hard, and the parts, computed in any order."""

from __future__ import annotations

import pickle
from functools import cache

import numpy as np

from tinsmith.tin.tiling.boxes import widen
from tinsmith.tin.tiling.local_triangulation import triangulate_box

from .each_value import list_seeds
from .point_cells import PointCells
from .tiled import divide


def _rng(seed):
    return np.random.default_rng(seed)


def _lattice(side, step=1.0):
    x, y = np.meshgrid(np.arange(side) * step, np.arange(side) * step)
    return np.column_stack([x.ravel(), y.ravel()])


def _follow_contours():
    """Points along lines of one elevation each, as digitized contours have them."""
    lines = []
    for k in range(1, 9):
        turns = np.linspace(0, 2 * np.pi, 25 * k, endpoint=False)
        radius = 11.0 * k + 2 * np.sin(5 * turns + k)
        x, y = radius * np.cos(turns), 0.7 * radius * np.sin(turns)
        lines.append(np.column_stack([x, y, np.full(len(turns), 100.0 - 5 * k)]))
    return np.concatenate(lines)


def _lift(xy, seed=0):
    """Add a rolling surface, with noise."""
    x, y = xy.T
    noise = _rng(seed).random(len(xy)) * 3
    return np.column_stack([xy, 20 * np.sin(x / 17) * np.cos(y / 23) + 0.1 * x + noise])


def _put_level(xyz):
    """Round elevations, so that levels lie on vertices, edges and flat triangles."""
    return np.column_stack([xyz[:, :2], np.round(xyz[:, 2] / 4) * 4])


CLOUDS = {
    "uniform": _lift(_rng(1).random((900, 2)) * 100),
    "lattice": _lift(_lattice(30, 4.0)),
    "lattice of whole elevations": _put_level(_lift(_lattice(25))),
    "contours": _follow_contours(),
    "clusters": _lift(
        np.concatenate([_rng(k).normal(_rng(k).random(2) * 90, 1.5, (120, 2)) for k in range(8)])
    ),
    "duplicates": _lift(np.round(_rng(2).random((1500, 2)) * 30)),
    "levels at vertices": _put_level(_lift(_rng(3).random((900, 2)) * 100)),
    "all level": np.column_stack([_rng(4).random((300, 2)) * 100, np.full(300, 8.0)]),
    "far from the origin": _lift(_rng(5).random((700, 2)) * 30) + np.array([4e6, 5e6, 0.0]),
    "very few": _lift(_rng(6).random((5, 2)) * 10),
}


def divide_at_points(points, side, seed=0):
    """Divide points between cells whose sides go through points."""
    chosen = _rng(seed).choice(len(points), max(0, side - 1))
    return PointCells(points, *(np.unique(points[chosen, axis]) for axis in (0, 1)))


class Tiling:
    """The parts of a surface in tiles, with three rings of triangles around those of each."""

    def __init__(self, source, *, rings=3, **options):
        self.source = source
        self.keys = source.list_cells()
        self.boxes = [source.box_of(key) for key in self.keys]
        points = source.skeleton.points
        margin = float(np.ptp(points[:, :2], axis=0).max()) / 20
        self.parts = [
            triangulate_box(source, box, around=widen(box, margin), rings=rings, **options)
            for box in self.boxes
        ]

    def compute(self, compute, seed=0):
        """Return ``compute(part, box)`` of each tile, in their order, computed in another."""
        found = [None] * len(self.parts)
        for k in np.random.default_rng(seed).permutation(len(self.parts)).tolist():
            found[k] = pickle.loads(pickle.dumps(compute(self.parts[k], self.boxes[k])))
        return found


WAYS = (("even", 1), ("even", 2), ("even", 4), ("through points", 2), ("through points", 4))
"""Of tilings: 1, 4 and 16 tiles, even ones and such whose sides go through points."""

TURNS = list_seeds(2, few=1)
"""With one of them every way is that of half of the clouds, with both of all."""


@cache
def tile_cloud(name, kind, side):
    """Return the points of a cloud in tiles."""
    points = CLOUDS[name]
    if kind == "even":
        return Tiling(divide(points, side))
    return Tiling(divide_at_points(points, side, seed=side))


def find_tilings(name, turn):
    """Return a cloud in tiles in every other way, that of the next cloud in the others."""
    return [tile_cloud(name, *way) for way in WAYS[([*CLOUDS].index(name) + turn) % 2 :: 2]]
