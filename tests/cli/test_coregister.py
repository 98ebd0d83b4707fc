"""``tinsmith coregister`` as people run it."""

import csv
import json

import numpy as np
import pytest
from support.commands import refuse, run

import tinsmith as ts

CRS = "EPSG:32616"
MOVE = np.array([1.5, -0.75, 0.4])


@pytest.fixture
def surfaces(tmp_path):
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(50.0), np.arange(50.0)))
    z = 9 * np.sin(x / 17 + y / 40) + 7 * np.cos(y / 13)
    points = np.column_stack([x + 500_000, y + 4_000_000, z])
    return [
        ts.write(ts.triangulate(one, crs=CRS, elevation_unit="m"), tmp_path / name)
        for one, name in ((points + MOVE, "new.gpkg"), (points, "old.gpkg"))
    ]


def test_a_surface_is_shifted_upon_another_with_statistics(tmp_path, surfaces):
    table, tin = tmp_path / "shift.csv", tmp_path / "shifted.ply"
    out = run("coregister", *surfaces, "-o", tin, "-o", table, "--json")
    assert out.exit_code == 0, out.output
    told = json.loads(out.stdout)
    np.testing.assert_allclose(told["shift"], -MOVE, atol=1e-6)
    np.testing.assert_allclose(ts.read(tin).points, ts.read(surfaces[1]).points, atol=2e-6)
    with table.open() as file:
        rows = list(csv.DictReader(file))
    assert [row["state"] for row in rows] == ["before", "after"]
    assert float(rows[1]["nmad (m)"]) < 1e-6 < float(rows[0]["nmad (m)"])
    assert "-1.5000 m east, 0.7500 m north, -0.4000 m up" in out.stderr
    assert "NMAD" in out.stderr


def test_polygons_of_unstable_ground_are_left_out(tmp_path, surfaces):
    corners = np.array([[10, 10], [30, 10], [30, 30], [10, 30], [10, 10]])
    corners = corners + np.array([500_000, 4_000_000])
    slides = ts.Features.of_polygons(corners, [0, 5], [0, 1], crs=CRS)
    layer = ts.write(slides, tmp_path / "slides.gpkg")
    cells = []
    for chosen in ((), ("--unstable", layer), ("--stable", layer)):
        out = run("coregister", *surfaces, *chosen, "-o", tmp_path / "a.ply", "--json")
        assert out.exit_code == 0, out.output
        cells.append(json.loads(out.stdout)["statistics"][1]["cells"])
    assert cells[1] < cells[0]
    assert 300 < cells[2] < 450


def test_what_cannot_be_done_is_said_and_nothing_is_written(tmp_path, surfaces):
    flat = ts.triangulate(
        ts.read(surfaces[1]).points * np.array([1, 1, 0]), crs=CRS, elevation_unit="m"
    )
    level = ts.write(flat, tmp_path / "flat.gpkg")
    path = tmp_path / "out.ply"
    said = refuse("coregister", level, level, "-o", path, code=1)
    assert "The ground does not determine a shift" in said
    assert "--spacing" in refuse("coregister", *surfaces, "--spacing", 0, "-o", path, code=2)
    assert not path.exists()
