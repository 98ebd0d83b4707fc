"""Profiles of tiles along an alignment: the bytes of those of the surface in memory."""

import numpy as np

import tinsmith as ts


def test_a_profile_along_an_alignment_has_the_bytes_of_memory(tmp_path):
    rng = np.random.default_rng(4)
    points = np.column_stack([rng.uniform(0, 90, (600, 2)), rng.uniform(0, 9, 600)])
    source = ts.write(ts.Survey(points=points, crs="EPSG:32616"), tmp_path / "points.csv")
    jump = ts.StationEquation(60.0, ahead=500.0)
    corners = [[5, 5], [50, 20], [85, 80]]
    how = {"start": 10.0, "crs": "EPSG:32616", "equations": [jump]}
    road = ts.Alignment.from_points(corners, radii=20, transitions=5, **how)
    cloud = ts.tiles(source, crs="EPSG:32616")
    tiled = cloud.profile(tmp_path / "tiled.csv", road, interval=10.0, tiles=4)
    tin = ts.triangulate(ts.read(source, crs="EPSG:32616"))
    whole = ts.write(ts.profile(tin, road, interval=10.0), tmp_path / "whole.csv")
    assert tiled.read_bytes() == whole.read_bytes()
    assert "written_station" in whole.read_text()
