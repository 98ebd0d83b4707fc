"""Coordinate reference systems as text: looked up, written back, moved between, measured."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tinsmith.io import CrsError, LengthUnit, crs, length_unit, transform_points

pyproj = pytest.importorskip("pyproj")


@pytest.mark.parametrize("text", ["EPSG:32616", "epsg:32616", "32616", " EPSG:32616 "])
def test_codes_come_back_in_their_usual_form(text):
    assert crs.crs_text(crs.as_crs(text)) == "EPSG:32616"
    assert crs.normalised(text) == "EPSG:32616"
    assert crs.normalised(None) is None


@pytest.mark.parametrize("version", ["WKT1_GDAL", "WKT1_ESRI", "WKT2_2019"])
def test_wkt_of_a_known_crs_becomes_its_code(version):
    wkt = pyproj.CRS("EPSG:32616").to_wkt(version)
    assert crs.crs_text(crs.as_crs(wkt)) == "EPSG:32616"


def test_crs_without_a_code_keeps_its_meaning():
    text = "+proj=tmerc +lat_0=0 +lon_0=147 +k=0.9996 +x_0=500000 +y_0=1e7 +ellps=GRS80 +units=m"
    wkt = crs.normalised(text)
    assert crs.as_crs(wkt) == pyproj.CRS(text)
    assert crs.normalised(wkt) == wkt


def test_a_near_miss_takes_no_code():
    wkt = pyproj.CRS("EPSG:32616").to_wkt().replace("500000", "500001")
    assert crs.normalised(wkt).startswith("PROJCRS")


@pytest.mark.parametrize("text", ["EPSG:99999", "nonsense", "", "EPSG:", "PROJCRS[", "x" * 500])
def test_unknown_crs_is_one_short_sentence(text):
    with pytest.raises(CrsError, match="Unknown CRS") as caught:
        crs.as_crs(text)
    assert caught.value.crs == text
    assert len(str(caught.value)) < 200
    assert "\n" not in str(caught.value)


def test_label_is_short():
    assert crs.crs_label(None) == "unknown"
    assert crs.crs_label("EPSG:32616") == "EPSG:32616"
    named = pyproj.CRS("EPSG:32616").to_wkt().replace("500000", "500001")
    assert crs.crs_label(named) == "WGS 84 / UTM zone 16N"


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("EPSG:32616", LengthUnit("metre", "m", 1.0)),
        ("EPSG:2274", LengthUnit("US survey foot", "US ft", 0.30480060960121924)),
        ("EPSG:2222", LengthUnit("foot", "ft", 0.3048)),
        ("EPSG:4326", LengthUnit("degree", "°", None)),
        (None, LengthUnit("unit", "units", None)),
    ],
)
def test_units(text, expected):
    assert length_unit(text) == expected


def test_elevations_are_metres_unless_a_vertical_axis_says_otherwise():
    assert crs.elevation_unit(None) == crs.METRE
    assert crs.elevation_unit("EPSG:2274") == crs.length_unit("EPSG:2274")
    assert crs.elevation_unit("EPSG:4326") == crs.METRE
    assert crs.elevation_unit("EPSG:2274+6360").symbol == "US ft"
    assert crs.elevation_unit("EPSG:4979").symbol == "m"


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
    assert crs.fitting_utm(longitude, latitude) == f"EPSG:{code}"
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
