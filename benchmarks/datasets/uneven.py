"""Data whose products once took time out of proportion, each made for a size."""

from __future__ import annotations

import numpy as np

import tinsmith as ts
from tinsmith.base.arrays import Float64Array

from .points import SEED

__all__ = [
    "make_clusters",
    "make_fan",
    "make_ground",
    "make_nested_waters",
    "make_overlapping_waters",
    "make_sawtooth",
]


def make_clusters(count: int) -> Float64Array:
    """Return two equal clusters of points in unit squares, a million units apart."""
    rng = np.random.default_rng(SEED)
    cluster = rng.random((count // 2, 3))
    return np.concatenate([cluster, cluster + np.array([1e6, 1e6, 0.0])])


def make_fan(count: int, seed: int = SEED) -> Float64Array:
    """Return points on a circle, and its middle, which is joined to them all."""
    angle = np.sort(np.random.default_rng(seed).random(count)) * 2 * np.pi
    rim = np.column_stack([100 * np.cos(angle), 100 * np.sin(angle), 5 + np.sin(5 * angle)])
    return np.concatenate([rim, [[0.0, 0.0, 9.0]]])


def make_ground() -> Float64Array:
    """Return 2,000 points in a square of a kilometre, and its corners."""
    rng = np.random.default_rng(SEED)
    points = rng.random((2000, 3)) * [1000.0, 1000.0, 10.0]
    corners = [[0.0, 0.0, 0.0], [1000.0, 0.0, 0.0], [1000.0, 1000.0, 0.0], [0.0, 1000.0, 0.0]]
    return np.concatenate([points, corners])


def make_overlapping_waters(count: int) -> list[ts.Water]:
    """Return squares of 60 units at one level, some dozens of which lie over each place."""
    number = np.arange(count)
    corners = 100.0 + 700.0 / count * np.column_stack([number, number * 7919 % count])
    square = np.array([[0.0, 0.0], [60.0, 0.0], [60.0, 60.0], [0.0, 60.0]])
    return [ts.Water(corner + square, 1.0) for corner in corners]


def make_nested_waters(count: int) -> list[ts.Water]:
    """Return octagons in each other, the innermost one first."""
    angle = np.arange(8) * np.pi / 4
    octagon = np.column_stack([np.cos(angle), np.sin(angle)])
    return [ts.Water(500.0 + 490.0 * k / count * octagon, 1.0) for k in range(1, count + 1)]


def make_sawtooth(count: int) -> Float64Array:
    """Return the ring of a pad whose southern edge has so many corners; teeth keep their form."""
    depth = 620.0 / count
    edge = np.where(np.arange(count) % 2, 400.0 + depth, 400.0)
    path = np.column_stack([np.linspace(300.0, 600.0, count), edge])
    return np.concatenate([path, [[600.0, 600.0], [300.0, 600.0]]])
