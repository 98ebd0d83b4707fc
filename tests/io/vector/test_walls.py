"""Walls of vector files: a second elevation along a line in columns; units, gaps, refusals."""

import numpy as np
import pytest
from support.commands import run

import tinsmith as ts

CRS = "EPSG:32616"
ORIGIN = np.array([500_000.0, 4_000_000.0])
PATH = np.array([[5.0, 0], [5, 10]]) + ORIGIN
GROUND = np.array([[0.0, 0, 8], [4, 5, 8], [0, 10, 8], [10, 0, 5], [6, 5, 5], [10, 10, 5]])
GROUND[:, :2] += ORIGIN


def write(path, *, z=None, crs=CRS, count=1, **columns):
    rows = PATH if z is None else np.column_stack([PATH, np.full(2, z)])
    coordinates = np.concatenate([rows + 0.0 for _ in range(count)])
    offsets = 2 * np.arange(count + 1)
    ts.write(ts.Features.of_lines(coordinates, offsets, columns=columns, crs=crs), path)
    return path


@pytest.mark.parametrize("suffix", [".gpkg", ".shp", ".fgb"])
@pytest.mark.parametrize(
    ("z", "columns"),
    [
        (None, {"top": [8.0], "foot": [5.0]}),
        (None, {"top": ["8"], "bottom": ["5.0"]}),
        (8.0, {"foot": [5.0]}),
        (5.0, {"top": [8.0]}),
        (1.0, {"top": [8.0], "foot": [5.0]}),
        (None, {"TOP": [8.0], "Bottom": [5.0], "foot": [5.0]}),
    ],
)
def test_two_elevations_along_one_line_make_a_wall(tmp_path, suffix, z, columns):
    path = write(tmp_path / f"walls{suffix}", z=z, **columns)
    lines = ts.read_lines(path, walls=True)
    assert [sorted(set(line.coords[:, 2])) for line in lines] == [[8.0], [5.0]]
    assert [line.name for line in lines] == ["wall", "wall, foot"]
    wall = ts.triangulate(GROUND, breaklines=lines, walls=0.01)
    found = wall.interpolate(np.array([[5, 4], [5.01, 4]]) + ORIGIN)
    assert found == pytest.approx([8.0, 5.0], abs=1e-4)


def test_lines_without_values_stay_as_they_are(tmp_path):
    path = write(tmp_path / "walls.gpkg", z=7.0, count=2, top=[np.nan, 8.0], name=["a", "b"])
    found = ts.read_lines(path, walls=True)
    assert [line.name for line in found] == ["a", "b", "b, foot"]
    assert [float(line.coords[0, 2]) for line in found] == [7.0, 8.0, 7.0]
    assert len(ts.read_lines(path)) == 2


def test_columns_that_are_not_used_are_told(tmp_path):
    path = write(tmp_path / "walls.gpkg", z=7.0, top=[8.0], foot=[5.0])
    notes = []
    ts.read_lines(path, notes=notes)
    assert any("'top' and 'foot' are not used" in note for note in notes)


def test_levels_are_converted_to_the_unit_of_the_points(tmp_path):
    path = write(tmp_path / "walls.gpkg", crs="EPSG:32616+5703", top=[8.0], foot=[5.0])
    notes = []
    found = ts.read_lines(path, walls=True, target_unit="ft", crs=CRS, notes=notes)
    assert [line.coords[0, 2] for line in found] == pytest.approx([8 / 0.3048, 5 / 0.3048])
    assert any("converted from metre to foot" in note for note in notes)
    named = write(tmp_path / "feet.gpkg", top_ft=[8.0])
    assert len(ts.read_lines(named, walls=True)) == 1


@pytest.mark.parametrize(
    ("z", "columns", "text"),
    [
        (None, {"top": [8.0]}, "without its foot"),
        (None, {"top": [np.nan], "foot": [5.0]}, "without its top"),
        (None, {"top": ["high"], "foot": ["5"]}, "has the top 'high'"),
        (None, {"top": [5.0], "foot": [8.0]}, "foot lies above its top, by up to 3"),
        (9.0, {"top": [8.0]}, "foot lies above its top"),
        (None, {"top": [8.0], "foot": [5.0], "bottom": [4.0]}, "several columns"),
        (None, {"top": [np.inf], "foot": [5.0]}, "number"),
    ],
)
def test_what_is_no_wall_is_refused(tmp_path, z, columns, text):
    path = write(tmp_path / "walls.gpkg", z=z, **columns)
    with pytest.raises(ts.ReadError, match=text):
        ts.read_lines(path, walls=True)


def test_the_command_makes_walls_of_columns(tmp_path):
    path = write(tmp_path / "walls.gpkg", top=[8.0], foot=[5.0], name=["east"])
    points = tmp_path / "points.csv"
    rows = [",".join(map(str, row)) for row in GROUND.tolist()]
    points.write_text("\n".join(["x,y,z", *rows]) + "\n")
    given = ("--crs", CRS, "--elevation-unit", "m", "--breaklines", path)
    done = run("build", points, *given, "--walls", 0.01, "-o", tmp_path / "a.ply")
    assert done.exit_code == 0, done.output
    assert "1 wall: of breaklines along one line" in done.output.replace("\n", " ")
    made = ts.read(tmp_path / "a.ply")
    assert made.interpolate(np.array([[5.01, 4]]) + ORIGIN)[0] == pytest.approx(5.0, abs=1e-4)
    done = run("build", points, *given, "-o", tmp_path / "b.ply")
    assert "are not used" in done.output


def test_the_overruled_elevation_of_a_second_line_names_walls(tmp_path):
    rows = np.column_stack([PATH, [8.0, 8.0]])
    both = np.concatenate([rows, rows - [0, 0, 3]])
    ts.write(ts.Features.of_lines(both, [0, 2, 4], crs=CRS), tmp_path / "pair.gpkg")
    points = tmp_path / "points.csv"
    points.write_text("x,y,z\n" + "\n".join(",".join(map(str, r)) for r in GROUND.tolist()) + "\n")
    given = ("--crs", CRS, "--breaklines", tmp_path / "pair.gpkg", "-o", tmp_path / "a.ply")
    done = run("build", points, *given)
    assert done.exit_code == 0, done.output
    assert "--walls keeps both along a wall" in done.output
