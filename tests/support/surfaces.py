"""Surfaces to write: with lines, attributes of their reference, and ugly corners."""

from __future__ import annotations

import numpy as np

import tinsmith as ts

ORIGIN = np.array([745_000.0, 4_033_000.0, 0.0])


def hills(n=300, seed=3, size=300.0, *, crs="EPSG:32616", unit="US survey foot", lines=True):
    """Make a TIN of rolling ground with a breakline and a soft one."""
    rng = np.random.default_rng(seed)
    xy = rng.uniform(0, size, (n, 2))
    z = 200 + 20 * np.sin(xy[:, 0] / 40) * np.cos(xy[:, 1] / 60)
    kerb = [[0.1, 0.1, 210], [0.4, 0.6, 220], [0.9, 0.7, 215]]
    ditch = [[0.1, 0.9, 190], [0.8, 0.85, 191]]
    scale = (size, size, 1.0)
    given = [
        ts.Breakline(np.array(kerb) * scale + ORIGIN, name="kerb"),
        ts.Breakline(np.array(ditch) * scale + ORIGIN, name="ditch", kind="soft"),
    ]
    points = np.column_stack([xy, z]) + ORIGIN
    tin = ts.triangulate(points, crs=crs, breaklines=given if lines else [])
    return tin.replace(elevation_unit=unit) if unit else tin


def punched(seed):
    """Make a TIN of small numbers with holes, parts and parts that touch in a vertex."""
    rng = np.random.default_rng(seed)
    xy = np.unique(rng.integers(0, 12, (60, 2)), axis=0)
    whole = ts.triangulate(np.column_stack([xy, rng.uniform(0, 5, len(xy))]).astype(float))
    keep = rng.random(len(whole.triangles)) < 0.6
    return ts.TIN.from_triangles(whole.points, whole.triangles[keep])
