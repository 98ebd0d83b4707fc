"""Bands against fractions, shapely and the area of the surface."""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise

import numpy as np
import pytest
import shapely
from support.each_value import list_seeds
from support.isolines import area_between

import tinsmith as ts


def polygons_of(features):
    rings, polygons, parts = features.offsets
    found = []
    for first, last in pairwise(parts):
        members = []
        for k in range(first, last):
            loops = [
                features.coordinates[rings[r] : rings[r + 1]]
                for r in range(polygons[k], polygons[k + 1])
            ]
            members.append(shapely.Polygon(loops[0], loops[1:]))
        found.append(shapely.MultiPolygon(members))
    return found


def exact_areas(tin, bounds):
    return [
        float(sum(area_between(tin.points[t], low, high) for t in tin.triangles))
        for low, high in bounds
    ]


def bound(value):
    return None if np.isnan(value) else Fraction(float(value))


def require_a_partition(tin, found):
    polygons = polygons_of(found)
    assert all(polygon.is_valid for polygon in polygons)
    parts = [part for polygon in polygons for part in polygon.geoms]
    assert all(part.exterior.is_ccw for part in parts)
    assert not any(hole.is_ccw for part in parts for hole in part.interiors)
    assert sum(polygon.area for polygon in polygons) == pytest.approx(tin.area, rel=1e-10)
    assert found.columns["area"] == pytest.approx([one.area for one in polygons], rel=1e-9)
    tree = shapely.STRtree(parts)
    for a, b in tree.query(parts, predicate="intersects").T:
        assert a >= b or parts[a].intersection(parts[b]).area < 1e-9


def integer_tin(rng):
    side = int(rng.integers(3, 8))
    x, y = np.meshgrid(np.arange(side), np.arange(side))
    z = rng.integers(0, int(rng.integers(2, 6)), side * side)
    points = np.column_stack([x.ravel(), y.ravel(), z]).astype(float)
    kept = rng.random(len(points)) < rng.choice([0.75, 1.0])
    return ts.triangulate(points[kept], max_edge=rng.choice([None, 1.5]))


@pytest.mark.parametrize("seed", list_seeds(150, few=40))
def test_bands_of_small_integer_grids_are_those_of_fractions(seed):
    rng = np.random.default_rng(seed)
    try:
        tin = integer_tin(rng)
    except ts.PointsError:  # all triangles were trimmed
        tin = ts.triangulate([[0, 0, 1], [1, 0, 0], [0, 1, 2]])
    found = ts.contour_bands(tin, interval=float(rng.choice([1.0, 0.5, 0.75])))
    require_a_partition(tin, found)
    bounds = zip(*(map(bound, found.columns[name]) for name in ("from", "to")), strict=True)
    assert found.columns["area"] == pytest.approx(exact_areas(tin, bounds), rel=1e-12)


@pytest.mark.parametrize("seed", list_seeds(8, few=3))
def test_bands_of_survey_points_tile_the_surface(seed):
    rng = np.random.default_rng(seed)
    n = int(rng.integers(10, 500))
    xy = np.array([500_000, 4_000_000]) + np.round(rng.uniform(0, 100, (n, 2)), 3)
    tin = ts.triangulate(np.column_stack([xy, np.round(rng.uniform(300, 310, n), 2)]))
    require_a_partition(tin, ts.contour_bands(tin, interval=0.5))


def test_bands_of_explicit_levels_are_open_below_and_above():
    tin = ts.triangulate([[0, 0, 0], [10, 0, 0], [10, 10, 20], [0, 10, 20]])
    found = ts.contour_bands(tin, levels=[15, 5])
    assert found.columns["area"] == pytest.approx([25, 50, 25])
    assert np.array_equal(found.columns["from"], [np.nan, 5, 15], equal_nan=True)
    assert np.array_equal(found.columns["to"], [5, 15, np.nan], equal_nan=True)


def test_a_flat_surface_at_a_level_is_one_band_above_it():
    tin = ts.triangulate([[0, 0, 5], [10, 0, 5], [10, 10, 5], [0, 10, 5]])
    found = ts.contour_bands(tin, interval=1)
    assert (found.columns["from"][0], found.columns["to"][0]) == (5, 6)
    assert found.columns["area"].tolist() == [100]


def test_islands_are_holes_of_the_band_around_them():
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(7.0), np.arange(7.0)))
    z = np.where((x == 3) & (y == 3), 9.0, 0.0)
    tin = ts.triangulate(np.column_stack([x, y, z]))
    low, _ = polygons_of(ts.contour_bands(tin, levels=[4.5]))
    assert len(low.geoms) == 1
    assert len(low.geoms[0].interiors) == 1


def test_bands_do_not_depend_on_the_order_of_triangles():
    rng = np.random.default_rng(3)
    tin = integer_tin(rng)
    expected = ts.contour_bands(tin, interval=0.5)
    triangles = tin.triangles[rng.permutation(len(tin.triangles))]
    found = ts.contour_bands(ts.TIN.from_triangles(tin.points, triangles), interval=0.5)
    assert np.array_equal(found.coordinates, expected.coordinates)
    for one, other in zip(found.offsets, expected.offsets, strict=True):
        assert np.array_equal(one, other)


# ------------------------------------------------------------------ rounding


@pytest.mark.parametrize("seed", range(10))
def test_vertices_a_rounding_from_a_level_leave_bands_whole(seed):
    """Crossings near such vertices fell together: bands lost holes, and a fifth of their area."""
    rng = np.random.default_rng(seed)
    xy = np.array([500_000.0, 4_000_000.0]) + rng.integers(0, 12, (150, 2))
    z = 300 + rng.integers(0, 4, 150) + rng.choice([0, 1e-13, -1e-13, 5.7e-14], 150)
    tin = ts.triangulate(np.column_stack([xy, z]))
    found = ts.contour_bands(tin, interval=0.5)
    require_a_partition(tin, found)
    assert all("met themselves" not in note for note in found.notes)


def test_polygons_of_slivers_thinner_than_rounding_are_mended_and_told():
    rng = np.random.default_rng(2)
    along = np.sort(rng.uniform(0, 100, 120))
    across = 0.37 * along + rng.normal(0, 1e-8, 120)
    points = np.column_stack([500_000 + along, 4_000_000 + across, rng.uniform(300, 310, 120)])
    found = ts.contour_bands(ts.triangulate(points), interval=0.5)
    assert all(polygon.is_valid for polygon in polygons_of(found))
    assert "met themselves within the rounding of coordinates" in found.notes[-1]


def test_bands_of_points_a_rounding_apart_add_up():
    """They were refused: segments around them cross, so that no rings went through them."""
    rng = np.random.default_rng(4)
    xy = rng.uniform(0, 1, (120, 2))
    xy[:60] = xy[0] + rng.integers(-4, 5, (60, 2)) * 2.0**-52
    tin = ts.triangulate(np.column_stack([xy, rng.uniform(300, 310, 120)]))
    bands = ts.contour_bands(tin, interval=0.5)
    assert shapely.is_valid(bands.to_shapely()).all()
    assert bands.columns["area"].sum() == pytest.approx(tin.area, rel=1e-12)
    assert "crossed themselves" in bands.notes[-1]


def test_a_sliver_along_which_the_surface_jumps_loses_no_band():
    """Three shots on a line but for a rounding: rings through them had lost a polygon."""
    points = [[0.6, 0.2, 4.0], [3.0, 0.6, 4.0], [4.2, 0.8, 1.0], [4.0, -1.7, 3.0]]
    utm = np.round(np.array(points) + np.array([512_345.0, 5_403_217.0, 0.0]), 1)
    tin = ts.TIN.from_triangles(utm, [[3, 2, 1], [0, 1, 2]])
    under = ts.stage_storage(tin, levels=[0.0, 1, 2, 3, 4, 5, 6])["area"]
    bands = ts.contour_bands(tin, interval=1)
    assert shapely.is_valid(bands.to_shapely()).all()
    found = dict(zip(bands.columns["from"].tolist(), bands.columns["area"].tolist(), strict=True))
    for level, area in enumerate(np.diff(under).tolist()):
        assert found.get(float(level), 0.0) == pytest.approx(area, abs=1e-6)


@pytest.mark.each_value
@pytest.mark.parametrize("origin", [(0.0, 0.0), (500_000.0, 4_000_000.0)])
@pytest.mark.parametrize("digits", [None, 2])
@pytest.mark.parametrize("degrees", [30.0, 71.1])
def test_bands_of_a_turned_grid_tile_it(degrees, digits, origin):
    """They were refused: slivers of the hull made rings that were mended to other areas."""
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(60.0), np.arange(60.0)))
    turn = np.deg2rad(degrees)
    east = x * np.cos(turn) - y * np.sin(turn) + origin[0]
    north = x * np.sin(turn) + y * np.cos(turn) + origin[1]
    points = np.column_stack([east, north, np.sin(x / 9) * 3 + np.cos(y / 7) * 2])
    tin = ts.triangulate(points if digits is None else points.round(digits))
    bands = ts.contour_bands(tin, interval=0.2)
    require_a_partition(tin, bands)
    assert not any("met themselves" in note or "crossed" in note for note in bands.notes)
    under = ts.stage_storage(tin, levels=[*bands.columns["from"], 100.0])["area"]
    np.testing.assert_allclose(bands.columns["area"], np.diff(under), rtol=1e-9, atol=1e-7)


def test_bands_along_a_slanted_line_tile_the_surface():
    """The points of y = x / 3 in doubles make slivers behind slivers."""
    x = np.arange(300.0)
    points = np.vstack([np.column_stack([x, x / 3, np.sin(x)]), [[150.0, 600.0, 0.0]]])
    tin = ts.triangulate(points)
    bands = ts.contour_bands(tin, interval=0.2)
    require_a_partition(tin, bands)
    assert not any("met themselves" in note or "crossed" in note for note in bands.notes)


def test_bands_that_have_no_area_once_made_valid_are_refused():
    """Points on one line, rounded: no polygon has an area once it is made valid."""
    points = [
        *(
            [6.908707451270402, 22.798734589192325, 426.27],
            [19.198162329613456, 63.3539356877244, 850.97],
        ),
        *(
            [20.02963292916463, 66.09778866624328, 294.08],
            [21.027857645219118, 69.39193022922309, 54.98],
        ),
        *(
            [29.53847443582438, 97.47696563822045, 894.96],
            [30.658991681177696, 101.17467254788639, 388.37],
        ),
        *(
            [60.010759520297086, 198.03550641698038, 487.09],
            [61.216687157802305, 202.0150676207476, 785.14],
        ),
        *(
            [78.5377284183638, 259.1745037806005, 376.94],
            [90.8528355854534, 299.8143574319962, 0.65],
        ),
    ]
    tin = ts.triangulate(points)
    with pytest.raises(ts.PointsError, match="too thin for coordinates of this size"):
        ts.contour_bands(tin, levels=[246.26, 383.798, 450.59799999999996, 798.306])
