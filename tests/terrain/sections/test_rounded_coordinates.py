"""Sections where coordinates are rounded: stations once, boundaries without gaps."""

import numpy as np
import pytest

import tinsmith as ts

ANGLE = np.radians(22.92)
ALONG = np.array([np.cos(ANGLE), np.sin(ANGLE)])
LEFT = np.array([-np.sin(ANGLE), np.cos(ANGLE)])
START = np.array([500_000.0, 5_400_000.0])


def make_road(decimals):
    """Return a design with a crown every 5 m from station 20 to 180, with rounded coordinates."""
    rows = [
        [*(START + station * ALONG + offset * LEFT), 400 + 0.01 * station - 0.025 * abs(offset)]
        for station in range(20, 181, 5)
        for offset in (-10.0, -5.5, 0.0, 5.5, 10.0)
    ]
    points = np.round(rows, decimals)
    corner = (np.arange(32)[:, None] * 5 + np.arange(4)).ravel()
    triangles = np.concatenate(
        [
            np.stack([corner, corner + 5, corner + 6], axis=1),
            np.stack([corner, corner + 6, corner + 1], axis=1),
        ]
    )
    return ts.TIN.from_triangles(points, triangles, crs="EPSG:25832", elevation_unit="m")


def axis(length=200.0):
    return np.array([START, START + length * ALONG])


@pytest.mark.parametrize("decimals", [3, 4, 6, 9])
def test_a_section_on_the_boundary_is_whole(decimals):
    table = ts.cross_sections(make_road(decimals), axis(), interval=20, width=40)
    for station in (20.0, 180.0):
        own = np.abs(table["station"] - station) < 1e-6
        offsets, z = table["offset"][own], table["elevation"][own]
        has = np.isfinite(z)
        first, last = np.flatnonzero(has)[[0, -1]]
        assert has[first : last + 1].all()
        reach = 2e-3 if decimals == 3 else 1e-3
        assert [offsets[first], offsets[last]] == pytest.approx([-10.0, 10.0], abs=reach)
        true = 400 + 0.01 * station - 0.025 * np.abs(offsets[has])
        assert z[has] == pytest.approx(true, abs=1e-3)


@pytest.mark.parametrize("decimals", [3, 6])
def test_a_profile_along_the_boundary_has_no_gap(decimals):
    side = np.array([START + 20 * ALONG + 10 * LEFT, START + 180 * ALONG + 10 * LEFT])
    for line in (side, side[::-1]):
        table = ts.profile(make_road(decimals), line)
        assert np.isfinite(table["elevation"]).all()
        assert not [note for note in table.notes if "There is no surface" in note]
    draped = ts.drape(make_road(decimals), side)
    assert np.isfinite(draped.coordinates[:, 2]).all()


def test_a_section_beside_the_boundary_by_more_than_rounding_has_no_surface():
    road = make_road(6)
    beside = ts.cross_sections(road, axis(), stations=[19.999, 100], width=40)
    own = beside["station"] < 20
    assert np.isnan(beside["elevation"][own]).all()


@pytest.mark.parametrize("excess", [3.743e-11, -3.743e-11, 1e-9, -1e-9, 0.0])
def test_the_last_station_is_there_once(excess):
    line = axis(200.0 + excess)
    length = float(np.hypot(*(line[1] - line[0])))
    road = make_road(6)
    table = ts.cross_sections(road, line, interval=20, width=30)
    stations = np.unique(table["station"])
    assert len(stations) == 11
    assert stations[-1] == length
    assert np.round(stations, 6).tolist() == [20.0 * k for k in range(11)]
    given = ts.cross_sections(
        road, line, interval=20, stations=[200.0, 100.0, 100.0 + 1e-10], width=30
    )
    assert np.unique(given["station"]).tolist() == stations.tolist()
    lines = ts.section_lines(road, line, interval=20, width=30)
    assert set(lines.columns["station"].tolist()) <= set(stations.tolist())
    run = ts.profile(road, line, interval=7)
    added = run["station"][run["crossed"] == "station"]
    assert len(np.unique(added.round(6))) == len(added)
    assert run["station"][-1] == length
    ends = ts.profile(road, line, interval=100)["station"]
    assert np.count_nonzero(np.abs(ends - 200.0) < 1e-6) == 1


def test_stations_that_coordinates_tell_apart_stay():
    table = ts.cross_sections(
        make_road(6), axis(200.25), stations=[100.0, 100.01], interval=200, width=30
    )
    assert np.unique(table["station"]).round(6).tolist() == [0.0, 100.0, 100.01, 200.0, 200.25]


def test_whole_numbers_are_taken_as_they_are():
    square = [[0, 0, 0], [4, 0, 4], [4, 4, 8], [0, 4, 4]]
    tin = ts.TIN.from_triangles(square, [[0, 1, 2], [0, 2, 3]])
    beside = ts.profile([tin, tin.copy()], [[-1, 4.0005], [2, 2], [5, 4.0005]])
    assert np.isfinite(beside["elevation_1"]).any()
    near = ts.drape(tin, [[0, 4.0001], [4, 4.0001], [4, 3]], outside="nan")
    assert np.isnan(near.coordinates[0, 2])
