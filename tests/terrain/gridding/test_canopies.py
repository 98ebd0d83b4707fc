"""Canopy height models: beside rasters of the same points, computed cell by cell."""

from __future__ import annotations

import numpy as np
import pytest

import tinsmith as ts


def make_ground(rng, *, crs="EPSG:32616", unit="m"):
    corners = [[-1, -1, 1], [41, -1, 2], [41, 41, 3], [-1, 41, 0]]
    points = np.concatenate([corners, rng.random((60, 3)) * [40, 40, 2]])
    return ts.triangulate(points, crs=crs, elevation_unit=unit)


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("spacing", [1.0, 2.5, 7.0])
def test_bands_are_those_one_computes_cell_by_cell(seed, spacing):
    rng = np.random.default_rng(seed)
    ground, points = make_ground(rng), rng.random((900, 3)) * [40, 40, 12]
    points[::3, :2] = np.round(points[::3, :2])
    made = ts.rasterize_canopy(ground, points, spacing=spacing)
    box, highest = made.grid.bounds, np.full(made.shape, np.nan)
    for x, y, z in points.tolist():
        cell = int((box.ymax - y) // spacing), int((x - box.xmin) // spacing)
        highest[cell] = np.nanmax([highest[cell], z])
    below = ts.rasterize(ground, spacing=spacing).bands["elevation"]
    assert list(made.bands) == ["dsm", "dtm", "chm"]
    np.testing.assert_array_equal(made.bands["dsm"], highest)
    np.testing.assert_array_equal(made.bands["dtm"], below)
    np.testing.assert_array_equal(made.bands["chm"], highest - below)
    assert {str(unit) for unit in made.units.values()} == {"metre"}


def test_what_is_missing_below_zero_noise_and_outside_is_told():
    ground = ts.triangulate([[0, 0, 5], [4, 0, 5], [4, 4, 5], [0, 4, 5]], crs="EPSG:32616")
    points = [[0.5, 0.5, 9], [2.5, 0.5, 4], [1.5, 1.5, 5], [-3, 1, 7], [9, 9, 9], [0.5, 3.5, 90]]
    cloud = ts.Survey(
        points=points,
        crs="EPSG:32616",
        attributes={"classification": np.array([5, 2, 2, 2, 7, 18], np.uint8)},
        skipped={"rows without an elevation": 3},
        notes=["Flown once."],
    )
    made = ts.rasterize_canopy(ground, cloud, spacing=1)
    said = list(made.notes)
    for sentence in (
        "The points above: Flown once.",
        "1 point of the class of low noise is among the points above.",
        "1 point of the class of high noise is among the points above.",
        "2 of 6 points lie outside the cells.",
        "12 of 16 cells of the ground have no point: no DSM and no height.",
        "1 of 4 cells with a height has it below 0, the lowest of -1: the DSM is below the DTM "
        "there.",
    ):
        assert sentence in said
    assert any("3 rows without an elevation" in note for note in said)
    grid = ts.Grid(ts.Bounds(-4, 0, 4, 4), (4, 8), 1.0)
    wide = ts.rasterize_canopy(ground, cloud, grid=grid)
    assert (
        "1 of 5 cells with points has no ground at the centre: no DTM and no height." in wide.notes
    )
    assert np.isnan(wide.bands["chm"][3, 1])
    assert wide.bands["dsm"][3, 1] == 7.0


def test_units_are_converted():
    ground = make_ground(np.random.default_rng(1))
    cloud = ts.Survey(points=[[5.0, 5.0, 100.0]], crs="EPSG:32616", elevation_unit="ft")
    made = ts.rasterize_canopy(ground, cloud, spacing=10.0)
    assert np.nanmax(made.bands["dsm"]) == pytest.approx(30.48)
    assert any("converted from" in note for note in made.notes)


def test_what_is_none_is_refused():
    ground = make_ground(np.random.default_rng(1))
    with pytest.raises(ts.PointsError, match="No cell has a point"):
        ts.rasterize_canopy(ground, [[500.0, 500.0, 1.0]], spacing=1.0)
    corner = ts.triangulate([[0, 0, 0], [8, 0, 0], [0, 8, 0]])
    with pytest.raises(ts.PointsError, match="No cell has both a point and ground"):
        ts.rasterize_canopy(corner, [[7.5, 7.5, 1.0]], spacing=1.0)
    with pytest.raises(ts.CrsError):
        ts.rasterize_canopy(ground, ts.Survey(points=[[5, 5, 1]], crs="EPSG:32617"), spacing=1.0)
    with pytest.raises(ts.OptionError, match="one of spacing, like and grid"):
        ts.rasterize_canopy(ground, [[5, 5, 1]])


def test_a_cloud_above_the_ground_of_its_own_class_has_what_is_known_of_both():
    rng = np.random.default_rng(8)
    survey = ts.Survey(points=make_ground(rng).points, notes=["Bad shot 7."], crs="EPSG:32616")
    made = ts.rasterize_canopy(ts.triangulate(survey), survey, spacing=2)
    assert "Bad shot 7." in made.notes
    assert "The points above: Bad shot 7." in made.notes
