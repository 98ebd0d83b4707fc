"""Hillshade against the law of cosines, gdaldem's formula, and places located one by one."""

from __future__ import annotations

import math

import numpy as np
import pytest

import tinsmith as ts
from tinsmith.base.results.gridded import locate_centers
from tinsmith.base.types import Bounds, Grid
from tinsmith.terrain.surface.normals import as_light, shade, sum_normals


def plane(east, north, **about):
    x, y = (axis.ravel().astype(float) for axis in np.meshgrid(np.arange(9), np.arange(9)))
    return ts.triangulate(np.column_stack([x, y, east * x + north * y]), **about)


def gdal_shade(east, north, azimuth, altitude, factor=1.0):
    """The formula of gdaldem (Horn): slope and aspect of the gradient against the sun's angles."""
    east, north = east * factor, north * factor
    rise, turn = math.radians(altitude), math.radians(azimuth)
    steepness = math.atan(math.hypot(east, north))
    aspect = math.atan2(-east, -north)
    cosine = math.sin(rise) * math.cos(steepness) + (
        math.cos(rise) * math.sin(steepness) * math.cos(turn - aspect)
    )
    return round(1 + 254 * max(0.0, cosine))


@pytest.mark.parametrize("smooth", [False, True])
@pytest.mark.parametrize(
    ("azimuth", "altitude", "factor"), [(315, 45, 1), (0, 30, 2), (100, 60, 0.5), (-45, 90, 1)]
)
@pytest.mark.parametrize(("east", "north"), [(0, 0), (1, 0), (-0.5, 2), (3, 3), (0.1, -0.7)])
def test_a_plane_has_the_light_of_gdaldem(east, north, azimuth, altitude, factor, smooth):
    made = ts.hillshade(
        plane(east, north),
        spacing=0.5,
        azimuth=azimuth,
        altitude=altitude,
        exaggeration=factor,
        smooth=smooth,
    )
    expected = gdal_shade(east, north, azimuth, altitude, factor)
    found = np.unique(made.bands["hillshade"])
    assert np.abs(found.astype(int) - expected).max() <= (0 if expected in found else 1)
    assert len(found) == 1


def test_slopes_are_those_of_the_true_surface():
    feet = plane(0.5, 0.2, crs="EPSG:2274", elevation_unit="m")
    factor = 3937 / 1200
    assert set(ts.hillshade(feet, spacing=1.0).bands["hillshade"].ravel()) == {
        gdal_shade(0.5 * factor, 0.2 * factor, 315, 45)
    }


def test_every_cell_has_the_light_of_the_triangle_at_its_centre():
    random = np.random.default_rng(2)
    tin = ts.triangulate(random.uniform(0, 50, (80, 3)))
    made = ts.hillshade(tin, spacing=0.7)
    band = made.bands["hillshade"]
    rows, columns = band.shape
    for _ in range(300):
        row, column = random.integers(rows), random.integers(columns)
        x = made.grid.bounds.xmin + (column + 0.5) * 0.7
        y = made.grid.bounds.ymax - (row + 0.5) * 0.7
        triangle = tin.locate([[x, y]])[0]
        if triangle < 0:
            assert band[row, column] == 0
            continue
        a, b, c = tin.points[tin.triangles[triangle]]
        normal = np.cross(b - a, c - a)
        gradient = -normal[:2] / normal[2]
        assert abs(int(band[row, column]) - gdal_shade(*gradient, 315, 45)) <= 1


def test_blocks_are_seamless(monkeypatch):
    tin = plane(0.3, -0.2)
    whole = ts.hillshade(tin, spacing=0.25).bands["hillshade"]
    monkeypatch.setattr("tinsmith.terrain.gridding.hillshades._BLOCK_CELLS", 100)
    np.testing.assert_array_equal(ts.hillshade(tin, spacing=0.25).bands["hillshade"], whole)


def test_smooth_light_lies_between_that_of_the_corners():
    roof = ts.triangulate([[0, 0, 0], [4, 0, 3], [4, 4, 3], [0, 4, 0], [8, 0, 0], [8, 4, 0]])
    flat = ts.hillshade(roof, spacing=0.25).bands["hillshade"]
    smooth = ts.hillshade(roof, spacing=0.25, smooth=True).bands["hillshade"]
    assert len(np.unique(flat)) == 2
    assert len(np.unique(smooth)) > 5
    level = gdal_shade(0, 0, 315, 45)  # the ridge
    assert level in smooth
    assert smooth.max() <= max(flat.max(), level) + 20  # a normal in between may face the light


@pytest.mark.parametrize("seed", range(4))
def test_smooth_light_is_that_of_normals_mixed_by_shares_of_the_triangle(seed):
    """Cell by cell: the corners' normals, each by the share of the triangle opposite to it."""
    rng = np.random.default_rng(seed)
    xy = rng.random((60, 2)) * 40 + [500_000, 4_000_000]
    tin = ts.triangulate(np.column_stack([xy, rng.random(60) * 9]))
    made = ts.hillshade(tin, spacing=0.5, smooth=True)
    unit = sum_normals(tin, "vertex")
    unit /= np.linalg.norm(unit, axis=1, keepdims=True)
    x, y = locate_centers(made.grid, *map(slice, (0, 0), made.grid.shape))
    places = np.column_stack([one.ravel() for one in np.meshgrid(x, y)])
    found = tin.locate(places)
    sides = tin.points[tin.triangles[found], :2] - places[:, None]
    first, second = np.roll(sides, -1, axis=1), np.roll(sides, -2, axis=1)
    shares = first[..., 0] * second[..., 1] - first[..., 1] * second[..., 0]
    normals = (shares[..., None] * unit[tin.triangles[found]]).sum(axis=1)
    wanted = np.where(found < 0, 0, shade(normals, as_light(315.0, 45.0)))
    assert (found < 0).any()
    np.testing.assert_array_equal(made.bands["hillshade"].ravel(), wanted)


def test_the_grid_begins_at_multiples_of_the_spacing():
    tin = plane(0, 0)
    shifted = ts.triangulate(tin.points + np.array([500_000.3, 4_000_000.7, 0]))
    made = ts.hillshade(shifted, spacing=2.0)
    assert made.grid.bounds == Bounds(500_000.0, 4_000_000.0, 500_010.0, 4_000_010.0)
    assert max(ts.hillshade(shifted).shape) in range(800, 2100)


def test_a_grid_of_ones_own():
    grid = Grid(Bounds(-1.0, -1.0, 2.0, 1.0), (2, 3), 1.0)
    made = ts.hillshade(plane(0, 0), grid=grid)
    assert made.grid == grid
    assert made.bands["hillshade"].tolist() == [[0, 181, 181], [0, 0, 0]]
    assert made.nodata == 0


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"spacing": 0}, "spacing 0"),
        ({"spacing": -1}, "spacing -1"),
        ({"spacing": math.nan}, "spacing nan"),
        ({"spacing": "x"}, "spacing 'x'"),
        ({"spacing": 1e-6}, "number of cells"),
        ({"altitude": 91}, "altitude 91"),
        ({"azimuth": math.inf}, "azimuth inf"),
        ({"exaggeration": 0}, "exaggeration 0"),
        ({"grid": 3}, "grid 3"),
        ({"spacing": 1, "grid": Grid(Bounds(0, 0, 1, 1), (1, 1), 1.0)}, "spacing 1"),
        ({"grid": Grid(Bounds(0, 0, 1e6, 1e6), (10**6, 10**6), 1.0)}, "number of cells 1000000"),
    ],
)
def test_what_cannot_be_drawn(given, words):
    with pytest.raises(ts.OptionError) as caught:
        ts.hillshade(plane(0, 0), **given)
    assert words in str(caught.value)
