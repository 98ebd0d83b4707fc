"""``tinsmith alignment`` and ``tinsmith sections``: files written, and what is refused."""

import json
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

import tinsmith as ts
from tinsmith.cli import main

CORNERS = [[0, 0], [60, 5], [100, 60], [180, 50]]


@pytest.fixture
def road(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    rise = ts.VerticalAlignment([ts.VerticalPoint(100, 2.0), ts.VerticalPoint(400, 5.0)], "design")
    how = {"start": 100.0, "crs": "EPSG:32616", "elevation_unit": "m", "verticals": [rise]}
    made = ts.Alignment.from_points(CORNERS, radii=20, transitions=6, name="Main", **how)
    ts.write(made, "road.xml")
    for name, slope in (("ground", 0.0), ("design", 0.05)):
        square = np.array([[-50.0, -90], [250, -90], [250, 150], [-50, 150]])
        z = slope * square[:, 0]
        tin = ts.triangulate(np.column_stack([square, z]), crs="EPSG:32616", elevation_unit="m")
        ts.write(tin, f"{name}.gpkg")
    np.savetxt("at.csv", [[1, 30, 1], [2, 120, 70]], "%g", ",", header="id,x,y", comments="")
    return made


def run(*words, code=0):
    done = CliRunner().invoke(main, list(map(str, words)))
    assert done.exit_code == code, done.output
    return done.output


def test_elements_points_and_offsets_are_those_of_the_library(road):
    run("alignment", "road.xml", "-o", "elements.csv", "-o", "road.gpkg", "-o", "again.xml")
    rows = Path("elements.csv").read_text().splitlines()
    assert len(rows) == 1 + len(road.elements)
    assert ts.read_alignment("again.xml").length == pytest.approx(road.length, abs=1e-9)
    run("alignment", "road.xml", "--interval", 20, "--offset", -3, "-o", "stakes.csv")
    wanted = ts.read_alignment("road.xml").tabulate_points(20.0, offset=-3.0)
    found = np.genfromtxt("stakes.csv", delimiter=",", names=True, deletechars="")
    for name in ("station", "x", "y", "elevation"):
        column = next(one for one in found.dtype.names if one.split("_(")[0] == name)
        np.testing.assert_array_equal(found[column], wanted[name])
    run("alignment", "road.xml", "--at", "at.csv", "-o", "offsets.csv")
    offsets = Path("offsets.csv").read_text().splitlines()
    assert offsets[0].startswith("id,x,y,station")
    assert len(offsets) == 3


def test_quantities_are_those_of_the_library(road):
    said = run(
        *("sections", "ground.gpkg", "design.gpkg", "--line", "road.xml", "--interval", 20),
        *("--width", 12, "--shrink-factor", 0.9, "-o", "q.csv", "-o", "q.png"),
    )
    surfaces = [ts.read_tin(f"{name}.gpkg") for name in ("ground", "design")]
    table = ts.section_volumes(
        *surfaces, ts.read_alignment("road.xml"), interval=20, width=12, shrink_factor=0.9
    )
    found = np.genfromtxt("q.csv", delimiter=",", skip_header=1)
    np.testing.assert_array_equal(found, np.column_stack(list(table.columns.values())))
    assert f"{table['fill_total'][-1]:,.2f}" in said


def test_profiles_run_along_an_alignment(road):
    run("profile", "ground.gpkg", "--line", "road.xml", "--interval", 20, "-o", "p.csv")
    assert Path("p.csv").read_text().splitlines()[1].startswith("0,100.0,")


def test_degrees_are_never_taken_for_lengths(road):
    Path("gps.csv").write_text("longitude,latitude\n-87.1,36.2\n")
    told = run("alignment", "road.xml", "--at", "gps.csv", "-o", "offsets.csv", code=1)
    assert "longitudes and latitudes by their header" in told
    assert not Path("offsets.csv").exists()


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["alignment", "none.xml"], "none.xml"),
        (["alignment", "ground.gpkg"], "5 layers"),
        (["alignment", "road.xml", "--alignment", "Side"], "'Main'"),
        (["alignment", "road.xml", "--offset", 3], "--interval"),
        (["alignment", "road.xml", "--at", "at.csv", "--interval", 5], "choose one"),
        (["alignment", "road.xml", "--crs", "EPSG:32617"], "no arcs there"),
        (["alignment", "road.xml", "-o", "road.xml"], "input"),
        (["alignment", "road.xml", "--tolerance", 0, "-o", "road.gpkg"], "--tolerance"),
        (["sections", "ground.gpkg", "design.gpkg"], "--line FILE"),
        (["sections", "ground.gpkg", "design.gpkg", "--line", "road.xml"], "--interval"),
        (
            [
                *("sections", "ground.gpkg", "design.gpkg", "--line", "road.xml"),
                *("--interval", 5, "--width", 4, "--start", 7),
            ],
            "stations of its own",
        ),
    ],
)
def test_what_cannot_be_is_refused(words, said, road):
    done = CliRunner().invoke(main, list(map(str, words)))
    assert done.exit_code in (1, 2), done.output
    assert said in done.output
    assert "Traceback" not in done.output


SECTIONS = (
    *("sections", "ground.gpkg", "design.gpkg", "--line", "road.xml"),
    *("--interval", 10, "--width", 12),
)


def test_drawn_sections_are_those_of_the_library(road):
    options = (
        "--scale",
        100,
        "--paper",
        "A3",
        "--orientation",
        "landscape",
        "--date",
        "2026-11-27",
        "--exaggeration",
        2,
    )
    outputs = ("-o", "road.pdf", "-o", "road.svg", "-o", "road.dxf", "-o", "road.csv")
    done = CliRunner().invoke(main, [str(one) for one in (*SECTIONS, *options, *outputs, "--json")])
    assert done.exit_code == 0, done.output
    record = json.loads(done.stdout)
    assert (record["scale"], record["paper"]) == (100, [420.0, 297.0])
    assert record["sheets"] > 1
    ground, design = (ts.read_tin(f"{name}.gpkg") for name in ("ground", "design"))
    made = ts.section_sheets(
        {"ground": ground, "design": design}, ts.read_alignment("road.xml"), interval=10, width=12,
        scale=100, paper="A3", orientation="landscape", date="2026-11-27", exaggeration=2,
        title="Cross sections: design",
    )  # fmt: skip
    pages = [file.name for file in made.list_files("road.svg")]
    assert record["outputs"] == ["road.csv", "road.pdf", *pages, "road.dxf"]
    made.save("own.pdf")
    assert Path("own.pdf").read_bytes() == Path("road.pdf").read_bytes()
    assert {*made.notes} <= {*record["notes"]}
    assert len(record["notes"]) == len({*record["notes"]})


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["-o", "q.csv", "--scale", 200], "--scale is for drawn sections"),
        (["-o", "q.csv", "--title", "Road"], "--title is for drawn sections"),
        (["-o", "q.pdf", "--scale", 1], "--scale '1:1': it must be 1:"),
        (["-o", "q.pdf", "--paper", "B9"], "--paper"),
        (["-o", "q.pdf", "--exaggeration", 0], "--exaggeration"),
        (["-o", "q.pdf", "-o", "q.pdf"], "q.pdf"),
        (["-o", "q.jpg"], "q.jpg"),
    ],
)
def test_sheets_that_cannot_be_are_refused(words, said, road):
    done = CliRunner().invoke(main, [str(one) for one in (*SECTIONS, *words)])
    assert done.exit_code in (1, 2), done.output
    assert said in done.output
    assert not list(Path().glob("q.*"))


def test_a_page_never_overwrites_an_input(road):
    Path("road-01.svg").write_bytes(Path("ground.gpkg").read_bytes())
    words = ["road-01.svg", *SECTIONS[2:], "--scale", 100, "--paper", "A4", "-o", "road.svg"]
    done = CliRunner().invoke(main, ["sections", *map(str, words), "--format", "gpkg"])
    assert done.exit_code == 2, done.output
    assert "cannot be the output too" in done.output
    assert Path("road-01.svg").read_bytes() == Path("ground.gpkg").read_bytes()
