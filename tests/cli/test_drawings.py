"""Drawings and LandXML on the command line: flags, and sentences that speak of them."""

import json

import ezdxf
import pytest
from support.commands import run_command as run

import tinsmith as ts

ROWS = [[0, 0, 5], [40, 0, 6], [0, 30, 8], [40, 30, 4], [20, 10, 7]]


@pytest.fixture
def surfaces(tmp_path):
    tin = ts.triangulate(ROWS, elevation_unit="m", crs="EPSG:32616")
    one, other = (ts.write(tin, tmp_path / f"{k}.xml", name=k) for k in ("EG", "FG"))
    head, _, tail = one.read_text().partition("</Surfaces>")
    second = other.read_text().partition("<Surfaces>")[2].partition("</Surfaces>")[0]
    path = tmp_path / "two.xml"
    path.write_text(f"{head}{second}</Surfaces>{tail}")
    return path


def test_a_surface_is_named_by_a_flag(surfaces, tmp_path):
    result = run("info", surfaces, code=1)
    assert "'EG', 'FG'" in result.output
    assert "--surface" in result.output
    assert "the option" not in result.output
    run("convert", surfaces, "--surface", "FG", "-o", tmp_path / "a.ply")
    assert len(ts.read(tmp_path / "a.ply").points) == 5


def test_units_are_told_by_flags(tmp_path):
    tin = ts.triangulate(ROWS)
    path = tmp_path / "a.xml"
    with pytest.warns(ts.LossWarning):
        ts.write(tin, path)
    text = run("info", path, code=1).output
    assert "--elevation-unit m" in text or "--elevation-unit 'm'" in text
    run("convert", path, "--unit", "ft", "--crs", "EPSG:2222", "-o", tmp_path / "b.xml")
    assert ts.read(tmp_path / "b.xml").elevation_unit.name == "foot"


def test_a_command_with_a_unit_of_its_own_names_that_of_lengths_otherwise(tmp_path):
    tin = ts.triangulate(ROWS, crs="EPSG:32616", elevation_unit="m")
    path = ts.write(tin, tmp_path / "a.xml")
    path.write_text(path.read_text().replace('linearUnit="meter"', 'linearUnit="millimeter"'))
    text = run("slope", path, "--unit", "percent", "-o", tmp_path / "s.geojson", code=1).output
    assert "--length-unit 'millimetre' or --length-unit 'metre'" in text
    text = run("info", path, code=1).output
    assert "--unit 'millimetre' or --unit 'metre'" in text
    run("slope", path, "--unit", "percent", "--length-unit", "m", "-o", tmp_path / "s.geojson")


def test_layers_and_content_of_a_drawing(tmp_path):
    document = ezdxf.new()
    document.units = 6
    space = document.modelspace()
    for k, row in enumerate(ROWS):
        space.add_point(row, dxfattribs={"layer": f"TOPO-{k % 2}"})
    space.add_3dface(ROWS[:3], dxfattribs={"layer": "TIN"})
    path = tmp_path / "a.dxf"
    document.saveas(path)
    text = run("info", path, code=1).output
    assert "--content" in text
    result = run("build", path, "--layer", "TOPO*", "--json", "-o", tmp_path / "a.ply")
    assert json.loads(result.stdout)
    assert len(ts.read(tmp_path / "a.ply").points) == 5
    run("convert", path, "--content", "surface", "-o", tmp_path / "b.ply")
    assert len(ts.read(tmp_path / "b.ply").triangles) == 1
    assert "TOPO-0" in run("info", path, "--layer", "ROAD", code=2).output


def test_breaklines_come_from_a_layer_of_a_drawing(tmp_path):
    document = ezdxf.new()
    space = document.modelspace()
    space.add_polyline3d([(5, 5, 6), (30, 20, 7)], dxfattribs={"layer": "KERB"})
    space.add_polyline3d([(5, 25, 6), (30, 25, 7)], dxfattribs={"layer": "OTHER"})
    document.saveas(tmp_path / "plan.dxf")
    survey = ts.Survey(points=ROWS, crs="EPSG:32616")
    ts.write(survey, tmp_path / "a.csv")
    run("build", tmp_path / "a.csv", "--crs", "EPSG:32616", "--breaklines",
        f"{tmp_path / 'plan.dxf'}:KERB*", "-o", tmp_path / "a.ply")  # fmt: skip
    assert int(ts.read(tmp_path / "a.ply").constrained.sum()) == 2


def test_contours_are_written_as_a_drawing(tmp_path):
    ts.write(ts.triangulate(ROWS, crs="EPSG:32616", elevation_unit="m"), tmp_path / "a.ply")
    run("contours", tmp_path / "a.ply", "--interval", "0.5", "-o", tmp_path / "c.dxf")
    layers = {one.dxf.layer for one in ezdxf.readfile(tmp_path / "c.dxf").modelspace()}
    assert layers <= {"CONTOURS", "INDEX_CONTOURS", "CONTOUR_LABELS"}
    assert layers


def test_a_drawing_of_lines_alone_is_described(tmp_path):
    document = ezdxf.new()
    document.units = 6
    document.modelspace().add_lwpolyline([(0, 0), (9, 0), (9, 5)])
    path = tmp_path / "a.dxf"
    document.saveas(path)
    assert "Points      0" in run("info", path).output
    told = json.loads(run("info", path, "--json").stdout)
    assert told["bounds"] is None
    assert told["elevation"] is None
