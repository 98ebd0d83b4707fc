"""Surfaces to write: with lines, attributes of their reference, and ugly corners."""

from __future__ import annotations

import numpy as np

import tinsmith as ts

from .point_sets import whole_number_grid

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


def stretch_triangles(tin, factors):
    """Return the triangles of a TIN stretched about its corner: Delaunay no longer, as of files."""
    corner = tin.points.min(axis=0) * (1.0, 1.0, 0.0)
    points = (tin.points - corner) * (*factors, 1.0) + corner
    return ts.TIN.from_triangles(
        points,
        tin.triangles,
        crs=tin.crs,
        elevation_unit=tin.elevation_unit,
        attributes=tin.attributes,
    )


UTM = np.array([500_000.0, 4_000_000.0, 300.0])
"""The corner of the points, within 100 by 100, of the surfaces below."""


def with_lines(points):
    """Triangulate points with a breakline and a soft one."""
    line = np.add(UTM, [[10, 10, 1], [50, 60, 2], [90, 20, 3]])
    wall = np.add(UTM, [[0, 80, 9], [100, 81, 9]])
    return ts.triangulate(points, breaklines=[line, ts.Breakline(wall, kind="soft", name="wall")])


def with_boundary_and_hole(points):
    """Triangulate points within a boundary with a reflex corner, around a square hole."""
    corner = UTM[:2]
    return ts.triangulate(
        points,
        boundary=[np.add(corner, [[5, 5], [95, 5], [95, 40], [40, 40], [40, 95], [5, 95]])],
        holes=[np.add(corner, [[20, 20], [30, 20], [30, 30], [20, 30]])],
    )


def with_pond(points):
    """Triangulate points with a pond of one elevation."""
    ring = np.add(UTM[:2], [[30, 30], [70, 35], [60, 70], [35, 60]])
    return ts.triangulate(points, water=[ts.Water(ring, 301.0)])


def scatter(n):
    """Return n points of a site of 100 by 80 m."""
    rng = np.random.default_rng(3)
    return rng.random((n, 3)) * [100, 80, 5] + [500_000.1, 4_000_000.2, 300]


def survey_site(points, breaklines, attributes, *, pond=""):
    """Return a survey of that site, with a boundary, a hole and a pond."""
    ring = [[500_005, 4_000_005], [500_090, 4_000_005], [500_090, 4_000_070], [500_005, 4_000_070]]
    hole = [[500_050, 4_000_030], [500_060, 4_000_030], [500_055, 4_000_040]]
    shore = [[500_020, 4_000_020], [500_030, 4_000_020], [500_025, 4_000_030]]
    return ts.Survey(
        points=points,
        breaklines=breaklines,
        boundary=[ring],
        holes=[hole],
        water=[ts.Water(shore, 301.5, name=pond)],
        attributes=attributes,
        crs="EPSG:32616",
        elevation_unit="m",
    )


def triangulate_whole_numbers(side, relief, rng):
    """Make a TIN of a square grid with whole elevations: flats, pits and equal slopes."""
    return ts.triangulate(whole_number_grid(rng, side, side, relief))
