"""Areas of use of CRSs, against pyproj's own and intervals of degrees worked out plainly."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pyproj
import pytest

from tinsmith.base.crs import CRS
from tinsmith.tin.screening.area_of_use import AreaOfUse, _convert_to_degrees, _measure_width

UTM_16 = "EPSG:32616"
NEW_ZEALAND = "EPSG:4167"  # 160.6 E to 171.2 W: across the antimeridian
MAIN_ISLANDS = "EPSG:2193"
FIJI = "EPSG:3460"  # 176.81 E to 178.15 W


def area_of(source, target=None):
    return AreaOfUse.of(CRS.of(source), CRS.of(target) if target else None)


def limits_of(code):
    area = pyproj.CRS(code).area_of_use
    return area.west, area.south, area.east, area.north


def projected(code, degrees):
    move = pyproj.Transformer.from_crs(pyproj.CRS(code).geodetic_crs, code, always_xy=True)
    return np.column_stack(move.transform(*np.transpose(degrees)))


@pytest.mark.parametrize(
    ("source", "target", "narrower"),
    [
        (NEW_ZEALAND, MAIN_ISLANDS, MAIN_ISLANDS),
        (MAIN_ISLANDS, NEW_ZEALAND, MAIN_ISLANDS),
        ("EPSG:4326", NEW_ZEALAND, NEW_ZEALAND),
        (FIJI, "EPSG:4326", FIJI),
        (UTM_16, "EPSG:3857", UTM_16),
    ],
)
def test_the_narrowest_area_is_named(source, target, narrower):
    west, south, east, north = limits_of(narrower)
    label = area_of(source, target).label
    assert label == (
        f"{source} and {target} (longitude {west:g} to {east:g}, latitude {south:g} to {north:g})"
    )


def test_a_crs_without_an_area_counts_for_nothing():
    local = (
        'ENGCRS["site",EDATUM["site"],CS[Cartesian,2],AXIS["x",east],AXIS["y",north],UNIT["m",1]]'
    )
    assert AreaOfUse.of(None, None) is None
    assert AreaOfUse.of(CRS.of(local), None) is None
    only_target = AreaOfUse.of(None, CRS.of(UTM_16))
    assert only_target.source == only_target.targets[0] == CRS.of(UTM_16)
    assert area_of(UTM_16, UTM_16).targets == (CRS.of(UTM_16),)


@pytest.mark.parametrize("code", ["EPSG:4326", NEW_ZEALAND, "EPSG:4267", "EPSG:4258"])
@pytest.mark.parametrize("margin", [0.0, 2.0])
def test_places_are_within_as_far_as_the_margin(code, margin):
    west, south, east, north = limits_of(code)
    width = (east - west) % 360 or 360
    rng = np.random.default_rng(7)
    places = np.column_stack([rng.uniform(-180, 180, 4000), rng.uniform(-95, 95, 4000)])
    edge = rng.uniform(-3, 3, (400, 2))  # near the corners too
    corners = np.array([[west, south], [east, north], [west, north], [east, south]])
    places = np.concatenate([places, np.resize(corners, (400, 2)) + edge])
    lon, lat = places.T
    beyond = np.minimum((west - lon) % 360, (lon - east) % 360)
    in_width = (lon - west) % 360 <= width
    expected = (in_width | (beyond <= margin)) & (lat >= south - margin)
    expected &= (lat <= min(north + margin, 90)) & (lat >= -90)
    found = area_of(code).covers(places, margin=margin)
    np.testing.assert_array_equal(found, expected)
    assert 0 < found.sum() < len(found)


def test_a_place_that_no_angle_belongs_to_is_not_covered():
    xy = np.array([[500000.0, 4000000.0], [1e300, 1e300], [np.inf, 0.0], [np.nan, np.nan]])
    assert area_of(UTM_16).covers(xy).tolist() == [True, False, False, False]
    turns = np.array([[0.0, 0.0], [360.0, 0.0], [361.0, 0.0], [-361.0, 0.0]])
    assert area_of("EPSG:4326").covers(turns).tolist() == [True, True, False, False]


@pytest.mark.parametrize(
    ("code", "place"),
    [
        ("EPSG:27561", (2.3, 49.5)),  # grads from Paris
        ("EPSG:2056", (7.4, 46.9)),
        ("EPSG:2277", (-97.7, 30.3)),  # US survey feet
        ("EPSG:25832+5783", (9.0, 50.0)),
    ],
)
def test_places_in_other_units_and_from_other_meridians(code, place):
    horizontal = code.partition("+")[0]
    base = pyproj.CRS(horizontal).geodetic_crs
    from_greenwich = pyproj.Transformer.from_crs("EPSG:4326", horizontal, always_xy=True)
    assert base is not None
    xy = np.array([from_greenwich.transform(*place), from_greenwich.transform(place[0] + 30, 20)])
    assert area_of(code).covers(xy).tolist() == [True, False]


def test_all_areas_must_hold_a_place():
    xy = projected(MAIN_ISLANDS, [[172.0, -43.0], [167.9, -47.0]])
    assert area_of(MAIN_ISLANDS, "EPSG:4326").covers(xy).all()
    assert not area_of(MAIN_ISLANDS, UTM_16).covers(xy).any()


@pytest.mark.parametrize(("inside", "most"), [(0, False), (5, False), (6, True), (10, True)])
def test_more_than_half_must_be_covered(inside, most):
    xy = np.tile(projected(UTM_16, [[-87.0, 40.0]]), (10, 1))
    xy[inside:] = [4.0e6, 5.0e5]
    assert area_of(UTM_16).covers_most(xy) is most


def test_points_spread_over_all_tell_what_most_are():
    """The first hundred lie elsewhere, and are a small part of all."""
    there = projected(UTM_16, [[-87.0, 40.0]])
    xy = np.concatenate([np.tile([[4.0e6, 5.0e5]], (100, 1)), np.tile(there, (900, 1))])
    assert area_of(UTM_16).covers_most(xy)
    assert not area_of(UTM_16).covers_most(xy[::-1][850:])


@pytest.mark.parametrize(
    ("code", "reach", "is_local"),
    [
        (UTM_16, 19_999.0, True),
        (UTM_16, 20_001.0, False),
        ("EPSG:2277", 65_000.0, True),  # feet
        ("EPSG:2277", 66_000.0, False),
        ("EPSG:3857", 5_000.0, False),  # there its origin lies in its area
        ("EPSG:4326", 1.0, False),
    ],
)
def test_a_local_grid_lies_about_an_origin_that_is_no_place(code, reach, is_local):
    xy = np.array([[0.0, 0.0], [reach, 10.0], [20.0, -reach]])
    assert area_of(code).is_local(xy) is is_local
    assert not area_of(code).is_local(np.empty((0, 2)))


def test_rows_outside_are_found_wherever_they_stand():
    rng = np.random.default_rng(3)
    xy = projected(
        UTM_16, np.column_stack([rng.uniform(-88, -86, 3000), rng.uniform(30, 45, 3000)])
    )
    area = area_of(UTM_16)
    assert area.find_outside(xy).tolist() == area.find_outside(xy[:0]).tolist() == []
    for k, away in enumerate(([9e6, 0], [-9e6, 0], [0, 2e7], [0, -3e7])):
        rows = sorted(rng.choice(3000, k + 1, replace=False).tolist())
        moved = xy.copy()
        moved[rows] += away
        assert area.find_outside(moved).tolist() == rows


@pytest.mark.parametrize(
    ("crs", "place", "angles"),
    [
        ("EPSG:4807", (0.0, 50.0), (2.337229167, 45.0)),  # grads from Paris
        ("EPSG:4807", (-10.0, 40.0), (2.337229167 - 9.0, 36.0)),
        ("EPSG:4326", (10.0, 40.0), (10.0, 40.0)),
        ("EPSG:32616", (500_000.0, 0.0), (-87.0, 0.0)),
        ("EPSG:32616+5703", (500_000.0, 0.0), (-87.0, 0.0)),
        ("EPSG:27572", (600_000.0, 2_200_000.0), (2.337229167, 46.8)),  # metres from Paris
    ],
)
def test_angles_are_degrees_from_greenwich(crs, place, angles):
    found = np.concatenate(_convert_to_degrees(CRS.of(crs), np.array([place])))
    assert found == pytest.approx(angles, abs=1e-6)


@pytest.mark.parametrize(
    ("west", "east", "south", "north", "size"),
    [(0, 10, 0, 20, 200), (0, 10, -2, 2, 40), (170, -170, 0, 5, 100), (-180, 180, -90, 90, 64800)],
)
def test_areas_are_compared_by_their_size_in_degrees(west, east, south, north, size):
    area = SimpleNamespace(west=west, east=east, south=south, north=north)
    assert _measure_width(area) == size
