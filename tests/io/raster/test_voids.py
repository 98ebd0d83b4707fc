"""Voids of a raster stay voids: its surface is the squares and half squares between its cells."""

import json

import numpy as np
import pytest
from click.testing import CliRunner
from support.each_value import list_seeds

import tinsmith as ts
from tinsmith.cli import main
from tinsmith.terrain.surface.voids import trace_rings

rasterio = pytest.importorskip("rasterio")

NODATA = -9999.0


def write(path, elevations, *, nodata=NODATA, transform=None, crs="EPSG:32616"):
    array = np.asarray(elevations, np.float32)
    with rasterio.open(
        path,
        "w",
        driver="GTiff",
        width=array.shape[1],
        height=array.shape[0],
        count=1,
        dtype="float32",
        crs=crs,
        transform=transform or rasterio.Affine(10, 0, 700_000, 0, -10, 4_000_000),
        nodata=nodata,
    ) as dataset:
        dataset.write(array, 1)
    return path


def hills(rows, columns):
    y, x = np.mgrid[:rows, :columns]
    return 300 + 5 * np.sin(x / 2) + 4 * np.cos(y / 3)


def expected_area(valid, cell=100.0):
    """Count whole squares of cell centres, and half ones where one of the four is missing."""
    count = sum(
        part.astype(int)
        for part in (valid[:-1, :-1], valid[1:, :-1], valid[:-1, 1:], valid[1:, 1:])
    )
    return float((count == 4).sum() + (count == 3).sum() / 2) * cell


@pytest.mark.parametrize("seed", list_seeds(40, few=12))
def test_the_surface_is_what_lies_between_cells(seed, tmp_path):
    rng = np.random.default_rng(seed)
    rows, columns = rng.integers(3, 14, 2)
    valid = rng.random((rows, columns)) < rng.choice([0.6, 0.8, 0.95])
    if expected_area(valid) == 0:
        valid[:2, :2] = True
    path = write(tmp_path / "a.tif", np.where(valid, hills(rows, columns), NODATA))
    survey = ts.read(path)
    tin = ts.triangulate(survey)
    assert tin.area == pytest.approx(expected_area(valid), rel=1e-12)
    found = ts.check(tin, points=survey)
    assert found.ok, [problem.sentence for problem in found.problems]
    middle = np.argwhere(~valid) * [-10.0, 10.0] + [3_999_995.0, 700_005.0]
    assert np.isnan(tin.interpolate(middle[:, ::-1])).all()


def test_rings_visit_no_cell_twice_and_tell_inside_by_an_odd_number():
    valid = np.random.default_rng(3).random((30, 40)) < 0.8
    rings = trace_rings(valid)
    assert all(len(set(ring.tolist())) == len(ring) >= 3 for ring in rings)
    cells = np.argwhere(valid)
    areas = [ring_area(cells[ring]) for ring in rings]
    assert sum(areas) == pytest.approx(expected_area(valid, 1.0))


def ring_area(cells):
    y, x = -cells[:, 0], cells[:, 1]
    return 0.5 * float((x * np.roll(y, -1) - np.roll(x, -1) * y).sum())


def test_a_whole_raster_has_no_extent(tmp_path):
    survey = ts.read(write(tmp_path / "a.tif", hills(8, 9)))
    assert survey.extent == ()
    assert survey.notes == []
    assert ts.triangulate(survey).area == 7 * 8 * 100


def test_voids_are_spanned_on_request(tmp_path):
    elevations = hills(12, 12)
    elevations[3:9, 4:8] = NODATA
    path = write(tmp_path / "a.tif", elevations)
    assert ts.triangulate(ts.read(path, fill=True)).area == 11 * 11 * 100
    assert ts.triangulate(ts.read(path)).area == (121 - 7 * 5 + 4 / 2) * 100


def test_voids_stay_through_windows_strides_and_other_systems(tmp_path):
    elevations = hills(30, 30)
    elevations[10:20, 10:20] = NODATA
    path = write(tmp_path / "a.tif", elevations)
    valid = elevations != NODATA
    window = ts.triangulate(ts.read(path, cells=(5, 5, 20, 20)))
    assert window.area == pytest.approx(expected_area(valid[5:25, 5:25]))
    thin = ts.triangulate(ts.read(path, stride=3))
    assert thin.area == pytest.approx(expected_area(valid[::3, ::3], 900.0))
    moved = ts.triangulate(ts.read(path, crs="EPSG:32617"))
    assert ts.check(moved).ok
    assert moved.area == pytest.approx(expected_area(valid), rel=0.01)


def test_a_sheared_raster_keeps_its_voids(tmp_path):
    transform = rasterio.Affine(10, 9, 700_000, 0, -10, 4_000_000)
    elevations = hills(15, 15)
    elevations[5:9, 6:10] = NODATA
    survey = ts.read(write(tmp_path / "a.tif", elevations, transform=transform))
    tin = ts.triangulate(survey)
    assert ts.check(tin, points=survey).ok
    assert tin.area == pytest.approx(expected_area(elevations != NODATA))


def test_cells_alone_are_left_out_and_reported(tmp_path):
    elevations = np.full((6, 6), NODATA)
    elevations[:3, :3] = 300.0
    elevations[5, 5] = 310.0
    tin = ts.triangulate(ts.read(write(tmp_path / "a.tif", elevations)))
    assert tin.report.to_dict()["left_out"] == {"outside the boundary": [9]}
    assert tin.area == 400


def test_cells_that_have_no_surface_between_them_are_refused(tmp_path):
    elevations = np.full((6, 6), NODATA)
    elevations[::2, ::2] = 300.0
    path = write(tmp_path / "a.tif", elevations)
    with pytest.raises(ts.ReadError, match="the option `fill` spans them"):
        ts.read(path)
    assert ts.triangulate(ts.read(path, fill=True)).area == 1600


def test_a_boundary_and_holes_come_on_top_of_voids(tmp_path):
    elevations = hills(21, 21)
    elevations[8:13, 8:13] = NODATA
    survey = ts.read(write(tmp_path / "a.tif", elevations))
    southwest = survey.points[:, :2].min(axis=0)
    box = np.array([[0, 0], [150, 0], [150, 150], [0, 150]]) + southwest
    tin = ts.triangulate(survey, boundary=[box])
    assert tin.area == pytest.approx(150 * 150 - 36 * 100 + 2 * 100)
    small = np.array([[20, 20], [60, 20], [60, 60], [20, 60]]) + southwest
    tin = ts.triangulate(survey, boundary=[box], holes=[small])
    assert tin.area == pytest.approx(150 * 150 - 36 * 100 + 2 * 100 - 1600)


def test_an_edited_tin_keeps_its_voids(tmp_path):
    elevations = hills(12, 12)
    elevations[3:9, 4:8] = NODATA
    tin = ts.triangulate(ts.read(write(tmp_path / "a.tif", elevations)))
    area = tin.area
    tin.insert([[700_032.0, 3_999_975.0, 301.0]])
    assert tin.area == pytest.approx(area)
    assert ts.check(tin).ok


# ------------------------------------------------------------------ nodata that is not declared


@pytest.mark.parametrize("value", [-9999.0, 0.0, 1e30])
def test_elevations_that_look_like_no_data_are_told_and_named(tmp_path, value):
    elevations = hills(12, 12)
    elevations[3:6, 4:8] = value
    path = write(tmp_path / "a.tif", elevations, nodata=None)
    notes = ts.read(path).notes
    assert len(notes) == 1
    assert "12 cells" in notes[0]
    assert "--" not in notes[0]
    seen = float(np.float32(value))
    left = ts.read(path, nodata=seen)
    assert len(left) == 144 - 12
    assert left.skipped == {"nodata cells": 12}
    assert ts.triangulate(left).area == (121 - 5 * 4 + 4 / 2) * 100


def test_nodata_that_is_no_number_is_refused(tmp_path):
    path = write(tmp_path / "a.tif", hills(4, 4))
    with pytest.raises(ts.OptionError, match="Invalid nodata 'none'"):
        ts.read(path, nodata="none")


def test_the_command_line_names_its_options(tmp_path):
    elevations = hills(12, 12)
    elevations[3:6, 4:8] = -9999
    path = str(write(tmp_path / "a.tif", elevations, nodata=None))
    out = str(tmp_path / "a.ply")
    told = CliRunner().invoke(main, ["build", path, "-o", out])
    assert "--nodata -9999" in told.stderr
    named = CliRunner().invoke(main, ["build", path, "-o", out, "--nodata", "-9999"])
    assert "--fill spans them" in named.stderr
    assert "12 nodata cells" in named.stderr
    filled = ["build", path, "-o", out, "--nodata", "-9999", "--fill", "--json"]
    facts = json.loads(CliRunner().invoke(main, filled).stdout)
    assert facts["tin"]["area"] == 12_100
