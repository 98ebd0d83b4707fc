"""Points move between coordinate reference systems, and elevations between units."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tinsmith import CRS, PointsError
from tinsmith.base.crs import METRE
from tinsmith.io import CrsError, LengthUnit, length_unit, transform_points
from tinsmith.io.reprojection import transformation as crs
from tinsmith.io.reprojection.transformation import reproject

pyproj = pytest.importorskip("pyproj")


def test_units_of_eastings():
    assert length_unit("EPSG:2274") == LengthUnit.of("US survey foot")
    assert length_unit(32616) == METRE
    assert length_unit("EPSG:4326").metres is None
    assert length_unit(None).metres is None


def test_degrees_are_told_apart():
    assert crs.is_geographic("EPSG:4326")
    assert crs.is_geographic("EPSG:4326+5773")
    assert not crs.is_geographic("EPSG:32616")
    assert not crs.is_geographic(None)


@pytest.mark.parametrize(
    ("longitude", "latitude", "code"),
    [
        (-84.2, 36.4, 32616),
        (147.3, -42.9, 32755),
        (-180.0, 10.0, 32601),
        (179.99, 10.0, 32660),
        (180.0, -1.0, 32701),
        (0.0, 0.0, 32631),
        (10.0, 88.0, 32661),
        (0.0, 84.0, 32661),
        (0.0, math.nextafter(84.0, 0.0), 32631),
        (0.0, -80.0, 32731),
        (0.0, math.nextafter(-80.0, -90.0), 32761),
        (10.0, -88.0, 32761),
    ],
)
def test_fitting_zone_holds_the_place(longitude, latitude, code):
    assert crs.find_utm_zone(longitude, latitude) == f"EPSG:{code}"
    area = pyproj.CRS(code).area_of_use
    assert area.south <= latitude <= area.north
    assert area.west <= longitude <= area.east or abs(longitude) == 180.0


def test_points_move_there_and_back():
    rng = np.random.default_rng(3)
    points = np.stack(
        [rng.uniform(-86, -83, 50), rng.uniform(34, 37, 50), rng.uniform(0, 900, 50)], 1
    )
    moved = transform_points(points, "EPSG:4326", "EPSG:32616")
    x, y = pyproj.Proj("EPSG:32616")(points[:, 0], points[:, 1])
    assert np.allclose(moved[:, :2], np.stack([x, y], 1), rtol=0, atol=1e-6)
    assert np.array_equal(moved[:, 2], points[:, 2])
    assert moved.flags.c_contiguous
    back = transform_points(moved, "EPSG:32616", "EPSG:4326")
    assert np.allclose(back, points, rtol=0, atol=1e-9)


def test_northing_first_authorities_do_not_turn_the_axes():
    """EPSG:31467 lists northing before easting; coordinates stay easting, northing."""
    moved = transform_points(np.array([[9.0, 50.0, 0.0]]), "EPSG:4314", "EPSG:31467")
    assert 3.4e6 < moved[0, 0] < 3.6e6
    assert 5.5e6 < moved[0, 1] < 5.6e6


def test_no_points_stay_none():
    assert transform_points(np.empty((0, 3)), "EPSG:4326", "EPSG:32616").shape == (0, 3)


def test_points_without_an_image_are_counted():
    points = np.array([[-84.0, 36.0, 1.0], [5e5, 4e6, 1.0], [5e5, 4e6, 2.0]])
    with pytest.raises(CrsError, match=r"^2 points .*first: point 1"):
        transform_points(points, "EPSG:4326", "EPSG:32616")


SUMMIT = np.array([[751_428.0, 4_020_862.0, 1_032.0]])


@pytest.mark.parametrize(
    ("source", "unit", "target", "elevation"),
    [
        ("EPSG:32616", None, "EPSG:2274", 3385.82),
        ("EPSG:32616", None, "EPSG:2222", 1032 / 0.3048),
        ("EPSG:32616", None, "EPSG:32617", 1032.0),
        ("EPSG:32616", None, "EPSG:4326", 1032.0),
        ("EPSG:32616", "ft", "EPSG:32617", 1032 * 0.3048),
        ("EPSG:32616", "ft", "EPSG:2274", 1032 * 0.3048 * 3937 / 1200),
        ("EPSG:32616", "US survey foot", "EPSG:2274", 1032.0),
        ("EPSG:32616", "cm", "EPSG:32617", 10.32),
        ("EPSG:32616+5703", None, "EPSG:2274", 3385.82),
        ("EPSG:32616+5703", None, "EPSG:2274+6360", 3385.82),
        ("EPSG:32616+6360", None, "EPSG:2274+5703", 1032 * 1200 / 3937),
        ("EPSG:32616+6360", "m", "EPSG:2274+5703", 1032.0),
        ("EPSG:32616", None, "EPSG:2274+5703", 1032.0),
        ("EPSG:32616", "ft", "EPSG:2274+5703", 1032 * 0.3048),
        ("EPSG:32616+6360", None, "EPSG:4326", 1032 * 1200 / 3937),
    ],
)
def test_elevations_change_their_unit_with_the_crs(source, unit, target, elevation):
    moved = transform_points(SUMMIT, source, target, elevation_unit=unit)
    assert moved[0, 2] == pytest.approx(elevation, rel=1e-12)
    flat = transform_points(SUMMIT, source, target)
    assert np.array_equal(moved[:, :2], flat[:, :2])


@pytest.mark.parametrize("target", ["EPSG:2274", "EPSG:2222", "EPSG:4326", "EPSG:2274+6360"])
def test_a_summit_comes_back_from_every_unit(target):
    there = transform_points(SUMMIT, "EPSG:32616", target)
    assert transform_points(there, target, "EPSG:32616") == pytest.approx(SUMMIT, rel=1e-9)


def test_a_conversion_is_told_and_so_is_what_was_assumed_for_it():
    metres, feet = CRS.of(32616), CRS.of(2274)
    assumed = reproject(SUMMIT, metres, feet, unit=None)
    assert "not told: taken to be metre" in assumed.note
    assert assumed.unit is None
    known = reproject(SUMMIT, metres, feet, unit=METRE)
    assert known.note == "Elevations were converted from metre to US survey foot."
    assert known.unit == LengthUnit.of("US survey foot")
    assert reproject(SUMMIT, metres, CRS.of(32617), unit=None).note is None


@pytest.mark.parametrize("points", [(), "EPSG:32616", np.zeros((2, 2, 2)), [[1.0, 2.0]]])
def test_what_is_no_points_is_not_transformed(points):
    with pytest.raises(PointsError, match=r"\.$"):
        transform_points(points, "EPSG:32616", "EPSG:4326")


@pytest.mark.parametrize("systems", [(None, "EPSG:4326"), ("EPSG:32616", None)])
def test_both_systems_are_needed(systems):
    with pytest.raises(CrsError, match="both are needed"):
        transform_points([[1.0, 2.0, 3.0]], *systems)
