"""``tinsmith build --from-contours`` as people run it."""

import json
from pathlib import Path

import geopandas
import numpy as np
import pytest
from shapely.geometry import LineString
from support.commands import run

import tinsmith as ts

SITE = str(Path(__file__).parents[2] / "sample_data" / "site_survey.csv")
ANGLES = np.linspace(0, 2 * np.pi, 40, endpoint=False)


def rings(*, with_z):
    """Return rings of an oblong hill, by elevation."""
    found = {}
    for level in (0.0, 10.0, 20.0, 30.0):
        x, y = (90 - level) * np.cos(ANGLES), (50 - level) * np.sin(ANGLES)
        coords = np.column_stack([x, y, np.full(40, level)])[:, : 3 if with_z else 2]
        found[level] = LineString(np.vstack([coords, coords[:1]]))
    return found


def write(path, *, with_z=False, column="elevation"):
    lines = rings(with_z=with_z)
    columns = {} if with_z else {column: list(lines)}
    frame = geopandas.GeoDataFrame(columns, geometry=list(lines.values()), crs="EPSG:32616")
    frame.to_file(path)
    return path


@pytest.mark.parametrize(
    ("how", "options"),
    [({"with_z": True}, []), ({}, []), ({"column": "KOTE2"}, ["--z-field", "KOTE2"])],
)
def test_contours_become_a_surface_without_flats(tmp_path, how, options):
    path = write(tmp_path / "contours.gpkg", **how)
    out = run("build", "--from-contours", path, *options, "-o", tmp_path / "a.gpkg", "--json")
    assert out.exit_code == 0, out.output
    assert "Contours" in out.stderr
    tin = ts.read(tmp_path / "a.gpkg")
    z = tin.points[tin.triangles, 2]
    assert not (z == z[:, :1]).all(axis=1).any()
    assert 30 < tin.points[:, 2].max() < 40
    added = tin.attributes["origin"] == "added"
    assert added.sum() == json.loads(out.stdout)["tin"]["vertices"] - 160
    assert not np.isin(tin.points[added, 2], [0, 10, 20, 30]).any()


def test_a_build_tells_of_flats_if_the_points_look_like_contours(tmp_path):
    path = write(tmp_path / "contours.gpkg", with_z=True)
    out = run("build", path, "--lines-as", "breaklines", "-o", tmp_path / "a.ply")
    assert out.exit_code == 0, out.output
    assert "are flat, for the points look like those of contours" in out.stderr
    out = run("build", SITE, "-o", tmp_path / "b.ply")
    assert "look like those of contours" not in out.stderr


def test_what_are_no_contours_is_refused(tmp_path):
    out = run("build", "--from-contours", SITE, "-o", tmp_path / "a.ply")
    assert out.exit_code == 1
    assert "has no lines: --from-contours needs contour lines" in out.stderr
    path = write(tmp_path / "contours.gpkg", with_z=True)
    out = run("build", "--from-contours", path, "--lines-as", "points", "-o", tmp_path / "a.ply")
    assert out.exit_code == 2
    slope = LineString([[0, 0, 1], [5, 5, 2], [5, 9, 3]])
    frame = geopandas.GeoDataFrame(geometry=[slope], crs="EPSG:32616")
    frame.to_file(tmp_path / "slope.gpkg")
    out = run("build", "--from-contours", tmp_path / "slope.gpkg", "-o", tmp_path / "a.ply")
    assert out.exit_code == 1
    assert "of 1 line 0 are level: these are not contours" in out.stderr
    assert not (tmp_path / "a.ply").exists()
