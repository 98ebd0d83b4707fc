"""``tinsmith riverbed`` and ``tinsmith hydroflatten``: files, options, and what is refused."""

import json
from pathlib import Path

import numpy as np
import pytest
from support.commands import run, run_command

import tinsmith as ts

DATA = Path(__file__).parents[1] / "data" / "river"
FEET = ("--crs", "EPSG:26916", "--elevation-unit", "ft")
CRS = "EPSG:32616"
ORIGIN = np.array([700_000.0, 4_000_000.0])


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """Return a folder with sections, a centreline, banks, a valley and a stream."""
    monkeypatch.chdir(tmp_path)
    shape = np.array([[10.0, 5], [6, 2], [4, 2], [0, 5]])
    rows = np.concatenate([np.column_stack([np.full(4, x), shape]) for x in (0.0, 40, 90)])
    rows[:, :2] += ORIGIN
    options = {"crs": CRS, "elevation_unit": "m"}
    ts.write(ts.Features.of_lines(rows, [0, 4, 8, 12], **options), "sections.gpkg")
    line = np.array([[-1.0, 5], [91, 5]]) + ORIGIN
    ts.write(ts.Features.of_lines(line, [0, 2], crs=CRS), "line.gpkg")
    banks = np.array([[-1.0, 6], [91, 6], [-1, 4], [91, 4]]) + ORIGIN
    ts.write(ts.Features.of_lines(banks, [0, 2, 4], crs=CRS), "banks.gpkg")
    x, y = (one.ravel() for one in np.meshgrid(np.arange(0, 91, 3.0), np.arange(-10, 21, 2.0)))
    z = 9 - x / 30 + 0.1 * np.abs(y - 5)
    ground = ts.triangulate(np.column_stack([x + ORIGIN[0], y + ORIGIN[1], z]), **options)
    ts.write(ground, "ground.gpkg")
    ring = np.array([[0.0, 1], [90, 1], [90, 9], [0, 9], [0, 1]]) + ORIGIN
    ts.write(ts.Features.of_polygons(ring, [0, 5], [0, 1], crs=CRS), "stream.gpkg")
    return tmp_path


def test_bed_of_a_table_with_a_column_of_sections_is_that_of_the_library(folder):
    centreline, sections = DATA / "centreline.csv", DATA / "sections.csv"
    words = ("--by", "section", "--spacing", 25, "--omit-returns", *FEET)
    done = run_command("riverbed", sections, centreline, *words, "-o", "bed.ply", "--json")
    survey = ts.read(sections, crs="EPSG:26916", elevation_unit="ft")
    line = np.genfromtxt(centreline, delimiter=",", skip_header=1)
    made = ts.riverbed(survey, line, by="section", spacing=25, omit_returns=True)
    assert (ts.read("bed.ply").points == made.points).all()
    record = json.loads(done.stdout)
    assert any("goes back across the channel" in one for one in record["notes"])
    assert any("right to left" in one for one in record["notes"])
    assert record["tin"]["vertices"] == len(made.points)


def test_bed_of_lines_with_banks_and_thalweg(folder):
    words = ("--spacing", 5, "--banks", "banks.gpkg", "--thalweg", "line.gpkg")
    run_command("riverbed", "sections.gpkg", "line.gpkg", *words, "-o", "bed.gpkg")
    bed = ts.read("bed.gpkg")
    assert {"section", "left bank", "thalweg", "right bank"} <= set(bed.lines.names)
    assert bed.interpolate(np.add(ORIGIN, [[20, 5]]))[0] == pytest.approx(2.0)
    assert (bed.crs.label, bed.elevation_unit.symbol) == (CRS, "m")


def test_water_is_flattened_with_a_centreline_and_without(folder):
    words = ("--stream", "stream.gpkg", "--spacing", 5)
    line = ("--centreline", "line.gpkg", "--fit", "isotonic")
    done = run_command("hydroflatten", "ground.gpkg", *words, *line, "-o", "flat.gpkg", "--json")
    flat = ts.read("flat.gpkg")
    here, there = flat.interpolate(np.add(ORIGIN, [[40, 2], [40, 8]]))
    assert here == pytest.approx(there)
    notes = " ".join(json.loads(done.stdout)["notes"])
    assert "flows along the centreline" in notes
    told = run_command("hydroflatten", "ground.gpkg", *words, "-o", "flat.ply").stderr
    assert "medial axis of the water" in " ".join(told.split())


BAD = {
    "by": ("riverbed DATA LINE --spacing 9 -o a.ply", "--by"),
    "column": ("riverbed DATA LINE --by river --spacing 9 -o a.ply", "'section'"),
    "returns": ("riverbed DATA AXIS --by section --spacing 9 -o a.ply", "--omit-returns"),
    "tin": ("riverbed ground.gpkg line.gpkg --spacing 9 -o a.ply", "cross sections are needed"),
    "level": (
        "hydroflatten ground.gpkg --stream stream.gpkg --spacing 0 -o a.ply",
        "Invalid --spacing 0",
    ),
    "lines": (
        "hydroflatten ground.gpkg --stream line.gpkg --spacing 9 -o a.ply",
        "polygon",
    ),
}


@pytest.mark.parametrize("name", BAD)
def test_what_cannot_be_done_is_refused_in_a_sentence_and_writes_nothing(folder, name):
    words, sentence = BAD[name]
    places = {"DATA": DATA / "sections.csv", "LINE": "line.gpkg", "AXIS": DATA / "centreline.csv"}
    crs = FEET if "DATA" in words else ()
    done = run(*[str(places.get(one, one)) for one in words.split()], *crs)
    assert done.exit_code in (1, 2), done.output
    assert sentence in " ".join(done.output.split()), done.output
    assert not Path("a.ply").exists()
