"""Coregistration: known shifts of analytic and of real surfaces, and what does not tell one."""

from __future__ import annotations

import numpy as np
import pytest

import tinsmith as ts

CRS = "EPSG:32616"
WEST_SOUTH = np.array([500_000.0, 4_000_000.0, 0.0])


def hills(x, y):
    return 9 * np.sin(x / 17 + y / 40) + 7 * np.cos(y / 13) + 0.03 * x


def make_points(function, *, side=60.0, step=1.0, seed=None):
    """Return points of a function of east and north: a lattice, or scattered with a seed."""
    axis = np.arange(0, side + step / 2, step)
    x, y = (one.ravel() for one in np.meshgrid(axis, axis))
    if seed is not None:
        x, y = np.random.default_rng(seed).random((2, len(x))) * side
    return np.column_stack([x, y, function(x, y)]) + WEST_SOUTH


def build(points, **how):
    return ts.triangulate(points, **{"crs": CRS, "elevation_unit": "m"} | how)


@pytest.fixture(scope="module")
def ground():
    return build(make_points(hills))


@pytest.mark.parametrize(
    "shift", [(0.0, 0.0, 0.0), (0.0, 0.0, 2.0), (0.3, -0.7, 0.05), (5.25, 3.5, -20.0)]
)
def test_a_surface_that_was_moved_comes_back(ground, shift):
    """The oracle is the move itself; the shifted surface has the points of the first."""
    moved = build(make_points(hills) + shift)
    found = ts.coregister(moved, ground)
    np.testing.assert_allclose(found.shift, np.negative(shift), atol=1e-6)
    np.testing.assert_allclose(found.tin.points, ground.points, atol=2e-6)
    assert ts.check(found.tin).ok
    before, after = found.statistics["nmad"]
    assert after <= 1e-6
    assert after <= before + 1e-9
    assert found.statistics["state"].tolist() == ["before", "after"]


def test_the_real_dem_comes_back():
    tin = ts.triangulate(ts.read("sample_data/jacksboro.tif"))
    shift = np.array([45.0, -80.0, -12.0])
    moved = tin.transform(lambda points: points + shift, crs=tin.crs)
    found = ts.coregister(moved, tin)
    np.testing.assert_allclose(found.shift, -shift, atol=1e-5)


def test_two_samples_of_one_ground_with_errors_lie_upon_each_other(ground):
    """Of independent points: the shift is right to a tenth of their distance."""
    rng = np.random.default_rng(5)
    shift = np.array([2.4, -1.3, 0.8])
    clouds = []
    for seed in (1, 2):
        points = make_points(hills, step=0.7, seed=seed)
        points[:, 2] += rng.normal(size=len(points)) * 0.05
        clouds.append(points)
    found = ts.coregister(build(clouds[0] + shift), build(clouds[1]))
    np.testing.assert_allclose(found.shift, -shift, atol=0.05)
    before, after = found.statistics["nmad"]
    assert after < 0.15 < before


def test_what_has_changed_has_no_weight_and_may_be_left_out_by_polygons(ground):
    shift = np.array([1.5, 0.75, -0.25])
    points = make_points(hills)
    fill = (points[:, :2] - WEST_SOUTH[:2] > [35, 30]).all(axis=1)
    points[fill, 2] += 6.0
    moved = build(points + shift)
    for chosen in ({}, {"unstable": [ring(33, 28, 65, 65)]}, {"stable": [ring(2, 2, 30, 58)]}):
        found = ts.coregister(moved, ground, **chosen)
        np.testing.assert_allclose(found.shift, -shift, atol=2e-3)
    assert "on stable ground" in found.notes[-1]
    assert found.statistics["cells"][1] < 30 * 60


def ring(west, south, east, north):
    corners = np.array([[west, south], [east, south], [east, north], [west, north]], float)
    return corners + WEST_SOUTH[:2]


def test_polygons_may_be_features_or_named(ground):
    corners = ring(10, 10, 50, 50)
    layer = ts.Features.of_polygons([*corners, corners[0]], [0, 5], [0, 1], crs=CRS)
    moved = build(make_points(hills) + np.array([1, 1, 1]))
    cells = {
        float(ts.coregister(moved, ground, stable=one).statistics["cells"][1])
        for one in (layer, [corners], {"a": corners}, layer.to_shapely())
    }
    assert len(cells) == 1
    other = ts.Features.of_polygons([*corners, corners[0]], [0, 5], [0, 1], crs="EPSG:32617")
    with pytest.raises(ts.CrsError, match="stable polygons"):
        ts.coregister(moved, ground, stable=other)
    with pytest.raises(ts.OptionError, match="stable polygons"):
        ts.coregister(moved, ground, stable=[])
    with pytest.raises(ts.LinesError):
        ts.coregister(moved, ground, unstable=[[[0, 0], [1, 1]]])


def test_feet_above_metres_are_shifted_in_their_own_unit(ground):
    points = make_points(hills) + np.array([1.5, -2.0, 3.0])
    points[:, 2] /= 0.3048
    found = ts.coregister(build(points, elevation_unit="ft"), ground)
    np.testing.assert_allclose(found.shift, [-1.5, 2.0, -3.0 / 0.3048], atol=1e-5)
    assert str(found.tin.elevation_unit) == "foot"
    assert str(found.statistics.units["nmad"]) == "metre"
    assert any("converted" in note for note in found.notes)


def test_statistics_are_those_of_the_cells(ground):
    """Before, of surfaces one above the other: the differences of elevations at centres."""
    rng = np.random.default_rng(2)
    points = make_points(hills)
    points[:, 2] += rng.normal(size=len(points)) * 0.2
    found = ts.coregister(build(points), ground, spacing=1.0)
    apart = [ts.rasterize(one, spacing=1.0).bands["elevation"] for one in (build(points), ground)]
    apart = (apart[0] - apart[1])[1:-1, 1:-1].ravel()
    apart = apart[np.isfinite(apart)]
    wanted = {
        "mean": apart.mean(),
        "median": np.median(apart),
        "nmad": 1.4826 * np.median(np.abs(apart - np.median(apart))),
        "standard_deviation": apart.std(),
        "rms": np.sqrt((apart**2).mean()),
        "cells": len(apart),
    }
    for name, value in wanted.items():
        assert found.statistics[name][0] == pytest.approx(value), name


def test_a_build_keeps_its_lines_and_options(ground):
    line = np.array([[10.0, 10, 0], [40, 50, 0]]) + WEST_SOUTH
    survey = ts.Survey(points=make_points(hills) + np.array([1, 0, 0]), crs=CRS, elevation_unit="m")
    broken = ts.triangulate(survey, breaklines=[ts.Breakline(line[:, :2], kind="soft")])
    found = ts.coregister(broken, ground, unstable=[ring(5, 5, 45, 55)])
    assert len(found.tin.lines) == len(broken.lines) > 0


@pytest.mark.parametrize("noise", [0.0, 0.05])
@pytest.mark.parametrize(
    "function",
    [
        lambda x, _: 0 * x,
        lambda x, y: 0.1 * x + 0.2 * y,
        lambda x, _: 5 * np.sin(x / 6),
        lambda x, y: 5 * np.sin((x + y) / 9),
    ],
)
def test_ground_that_does_not_tell_a_shift_is_refused(function, noise):
    rng = np.random.default_rng(3)
    surfaces = []
    for move in ((1.0, 2.0, 0.5), (0.0, 0.0, 0.0)):
        points = make_points(function) + move
        points[:, 2] += noise * rng.normal(size=len(points))
        surfaces.append(build(points))
    with pytest.raises(ts.PointsError, match=r"not determine a shift|shift is not determined"):
        ts.coregister(*surfaces)


def test_errors_alone_are_refused():
    """Two surfaces with nothing in common, of slopes in all directions."""
    rng = np.random.default_rng(4)
    surfaces = [build(make_points(lambda x, _: rng.normal(size=len(x)))) for _ in range(2)]
    with pytest.raises(ts.PointsError, match=r"determine a shift|shift is not determined|No shift"):
        ts.coregister(*surfaces)


def test_surfaces_apart_few_cells_and_other_references_are_refused(ground):
    far = build(make_points(hills) + np.array([500, 0, 0]))
    with pytest.raises(ts.PointsError, match="do not meet"):
        ts.coregister(far, ground)
    beside = build(make_points(hills) + np.array([58, 0, 0]))
    with pytest.raises(ts.PointsError, match="100 are needed"):
        ts.coregister(beside, ground)
    with pytest.raises(ts.PointsError, match="100 are needed"):
        ts.coregister(ground, ground, spacing=10.0)
    with pytest.raises(ts.CrsError):
        ts.coregister(build(make_points(hills), crs="EPSG:32617"), ground)
    with pytest.raises(ts.CrsError, match="not known"):
        ts.coregister(ts.triangulate(make_points(hills)), ground)
    degrees = ts.triangulate(
        (make_points(hills) - WEST_SOUTH) * [1e-5, 1e-5, 1], crs="EPSG:4326", elevation_unit="m"
    )
    with pytest.raises(ts.CrsError, match="a projected CRS is needed"):
        ts.coregister(degrees, degrees)
    with pytest.raises(ts.OptionError, match="spacing"):
        ts.coregister(ground, ground, spacing=0)


def test_notes_of_both_surfaces_arrive():
    surveys = [
        ts.Survey(points=make_points(hills), crs=CRS, elevation_unit="m", notes=[f"{name} is old."])
        for name in ("one", "other")
    ]
    found = ts.coregister(*map(ts.triangulate, surveys))
    for made in (found, found.tin, found.statistics):
        told = " ".join(made.notes)
        assert "one is old." in told
        assert "other is old." in told


def test_it_tells_how_far_it_is(ground):
    told = []
    ts.coregister(build(make_points(hills) + np.array([1, 2, 3])), ground, progress=told.append)
    assert told == sorted(told)
    assert told[-1] == 1.0


def test_elevations_that_overflow_are_refused(ground):
    high = ground.transform(lambda points: points * np.array([1, 1, 1e160]), crs=CRS)
    with pytest.raises(ts.PointsError, match="overflow"):
        ts.coregister(high, high)
