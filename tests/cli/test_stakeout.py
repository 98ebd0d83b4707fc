"""``tinsmith stakeout`` and ``convert --to-ground``: files written, and what is refused."""

import csv
import json
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

import tinsmith as ts
from tinsmith.cli import main
from tinsmith.io.places import read_places

CRS = "EPSG:32616"
CORNER = np.array([700_000.0, 4_000_000.0])


def near(*steps):
    return CORNER + np.array(steps, float)


AT = near([10, 10], [40, 30], [500, 10])


def slope(rise):
    xy = near([0, 0], [100, 0], [100, 100], [0, 100])
    z = 300.0 + rise * (xy[:, 0] - CORNER[0])
    return ts.triangulate(np.column_stack([xy, z]), crs=CRS, elevation_unit="m")


@pytest.fixture(autouse=True)
def files(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    ts.write(slope(0.01), "design.gpkg")
    ts.write(slope(0.0), "ground.gpkg")
    road = ts.Alignment.from_points(near([0, 20], [100, 20]), start=1000.0, crs=CRS)
    ts.write(road, "road.xml")
    rows = [
        f"{101 + k},{x},{y},{word}" for k, ((x, y), word) in enumerate(zip(AT, "abc", strict=True))
    ]
    Path("at.csv").write_text("\n".join(["Pt,Easting,Northing,Desc", *rows]) + "\n")


def run(*words, code=0):
    done = CliRunner().invoke(main, list(map(str, words)))
    assert done.exit_code == code, done.output
    return done.output


def read_rows(path):
    with Path(path).open(encoding="utf-8", newline="") as file:
        return list(csv.reader(file))


def test_the_list_is_that_of_the_library_and_every_point_is_in_it():
    said = run("stakeout", "design.gpkg", "--at", "at.csv", "--ground", "ground.gpkg",
               "--line", "road.xml", "-o", "list.csv", "-o", "points.gpkg")  # fmt: skip
    header, *rows = read_rows("list.csv")
    names = [one.split(" (")[0] for one in header]
    columns = dict(zip(names, zip(*rows, strict=True), strict=True))
    road = ts.read_alignment("road.xml")
    wanted = ts.stakeout(slope(0.01), AT, ground=slope(0.0), alignment=road)
    for name in ("elevation", "cut", "fill", "station", "offset"):
        found = [float(one or "nan") for one in columns[name]]
        np.testing.assert_array_equal(found, wanted[name])
    assert columns["point"] == ("101", "102", "103")
    assert columns["description"] == ("a", "b", "c")
    assert "1 of 3 points is outside the design" in " ".join(said.split())
    layer = read_places(Path("points.gpkg"))
    np.testing.assert_array_equal(layer.coordinates, AT)


def test_lists_for_instruments_have_no_header_and_as_many_decimals_as_asked():
    run("stakeout", "design.gpkg", "--at", "at.csv", "--layout", "PNEZD", "--decimals", 2,
        "--no-header", "-o", "list.csv")  # fmt: skip
    assert read_rows("list.csv") == [
        ["101", "4000010.00", "700010.00", "300.10", "a"],
        ["102", "4000030.00", "700040.00", "300.40", "b"],
        ["103", "4000010.00", "700500.00", "", "c"],
    ]


def test_what_is_missing_is_counted_in_every_layout():
    for layout in ((), ("--layout", "PNEZ"), ("--layout", "ZR")):
        words = ("--at", "at.csv", *layout, "-o", "list.csv", "--json", "-q")
        assert json.loads(run("stakeout", "design.gpkg", *words))["missing"] == 1


def test_points_along_an_axis_are_at_its_stations_and_offsets():
    run("stakeout", "design.gpkg", "--line", "road.xml", "--interval", 25, "--offsets=-5,5",
        "--unit", "ft", "-o", "list.csv")  # fmt: skip
    header, *rows = read_rows("list.csv")
    assert header[:4] == ["point", "easting (ft)", "northing (ft)", "elevation (ft)"]
    stations = [float(row[header.index("station (ft)")]) * 0.3048 for row in rows]
    assert stations == pytest.approx(np.repeat([1000, 1025, 1050, 1075, 1100], 2))
    north = [float(row[2]) * 0.3048 for row in rows]
    assert north == pytest.approx(CORNER[1] + np.tile([25, 15], 5))


@pytest.mark.filterwarnings("default::tinsmith.LossWarning")
def test_drawings_have_labels_of_cut_and_fill_and_none_of_what_is_not_known():
    ezdxf = pytest.importorskip("ezdxf")
    words = ("--at", "at.csv", "--ground", "design.gpkg", "-o", "p.dxf")
    said = run("stakeout", "ground.gpkg", *words)
    assert "1 point of unknown elevation got the elevation 0" in said
    texts = ezdxf.readfile("p.dxf").modelspace().query("TEXT")
    by_layer = {}
    for one in texts:
        by_layer.setdefault(one.dxf.layer, []).append(one.dxf.text)
    assert by_layer["POINT_CUT_FILL"] == ["C 0.100", "C 0.400"]
    assert by_layer["POINT_ELEVATIONS"] == ["300.00", "300.00"]
    assert by_layer["POINT_NUMBERS"] == ["101", "102", "103"]


def test_coordinates_go_to_the_ground_and_back():
    factor = ts.combined_factor(slope(0.01))
    said = run("convert", "design.gpkg", "--to-ground", "-o", "ground2.gpkg", "--json")
    told = json.loads(said[said.index("{") : said.rindex("}") + 1])
    assert told["combined_factor"] == factor.combined
    found = ts.read("ground2.gpkg")
    assert found.crs == factor.ground_crs
    np.testing.assert_array_equal(found.points, factor.to_ground(slope(0.01)).points)
    run("convert", "ground2.gpkg", "--to-crs", CRS, "-o", "back.gpkg")
    back = ts.read("back.gpkg")
    assert back.crs == ts.CRS.of(CRS)
    np.testing.assert_allclose(back.points, slope(0.01).points, rtol=0, atol=1e-8)
    run("stakeout", "design.gpkg", "--at", "at.csv", "--to-ground", "--combined-factor", 0.5,
        "--factor-base", *CORNER, "-o", "list.csv")  # fmt: skip
    assert float(read_rows("list.csv")[2][1]) == CORNER[0] + 80


def test_points_of_a_survey_go_to_the_ground_with_their_lines(tmp_path):
    ring = near([0, 0], [90, 0], [90, 90], [0, 90])
    line = np.column_stack([ring[:2], [1.0, 2.0]])
    survey = ts.Survey(
        points=slope(0.0).points,
        breaklines=[ts.Breakline(line, name="kerb")],
        boundary=[ring],
        water=[ts.Water(ring, 299.3)],
        crs=CRS,
        elevation_unit="m",
        notes=["One point was left out."],
    )
    factor = ts.CombinedFactor(0.5, base=CORNER, crs=CRS)
    moved = factor.to_ground(survey)
    np.testing.assert_array_equal(moved.points, factor.to_ground(survey.points))
    np.testing.assert_array_equal(moved.breaklines[0].coords, factor.to_ground(line))
    assert moved.breaklines[0].name == "kerb"
    assert moved.water[0].z == 299.3
    assert moved.crs == factor.ground_crs
    assert moved.notes[0] == "One point was left out."
    np.testing.assert_array_equal(factor.to_grid(moved).points, survey.points)
    mean = ts.combined_factor(survey)
    wanted = ts.combined_factor(CRS, point=CORNER + 50, elevation=300.0, elevation_unit="m")
    assert mean.combined == wanted.combined


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        ((), "Points to set out are needed: one of --at, --stations and --interval."),
        (("--at", "at.csv", "--interval", 5), "--at and --interval are both given: choose one."),
        (("--stations", "1010"), "--stations needs an axis: --line FILE."),
        (("--at", "at.csv", "--offsets", "1"), "--offsets is for points at --stations"),
        (("--at", "at.csv", "--layout", "PNEZS"), "one without 'S', which needs an alignment"),
        (("--at", "at.csv", "--undulation", 3), "--undulation needs --to-ground."),
        (("--at", "at.csv", "--to-ground", "--combined-factor", 1), "needs --factor-base"),
        (("--at", "design.gpkg:triangles"), "holds polygons: points are needed"),
        (("--at", "at.csv", "--decimals", 99), "from 0 to 15"),
        (
            ("--at", "at.csv", "--to-ground", "--combined-factor", 7, "--factor-base", 0, 0),
            "Invalid --combined-factor 7.0: it must be a factor from 0.5 to 2.",
        ),
    ],
)
def test_what_cannot_be_listed_is_refused_in_a_sentence(words, sentence):
    code = 1 if "polygons" in sentence else 2
    said = run("stakeout", "design.gpkg", *words, "-o", "list.csv", code=code)
    assert sentence in " ".join(said.split())
    assert not Path("list.csv").exists()


# ------------------------------------------------------------------- places of files


def test_places_need_no_elevations_and_keep_numbers_and_descriptions(tmp_path):
    ts.write(ts.Features.of_points(AT, columns={"Point": [7, 8, 9]}, crs=CRS), "flat.geojson")
    Path("plain.txt").write_text("7,4000010,700010,300,a\n8,4000030,700040,300,b\n")
    found = read_places(Path("at.csv"), crs=CRS)
    assert found.columns["number"].tolist() == ["101", "102", "103"]
    np.testing.assert_array_equal(found.coordinates, AT)
    found = read_places(Path("flat.geojson"), crs=CRS)
    np.testing.assert_allclose(found.coordinates, AT, atol=1e-3)
    assert found.columns["number"].tolist() == [7, 8, 9]
    found = read_places(Path("plain.txt"), crs=CRS)
    np.testing.assert_array_equal(found.coordinates, AT[:2])
    assert [str(one) for one in found.columns["number"]] == ["7", "8"]


def test_places_that_are_no_lengths_or_no_points_are_refused(tmp_path):
    Path("degrees.csv").write_text("lon,lat\n-87,36\n")
    with pytest.raises(ts.CrsError, match="longitudes and latitudes by their header"):
        read_places(Path("degrees.csv"), crs=CRS)
    Path("bad.csv").write_text("id,easting,northing\n1,700010,x\n")
    with pytest.raises(ts.ReadError, match="line 2, 'x'"):
        read_places(Path("bad.csv"), crs=CRS)
    Path("plain.txt").write_text("7,4000010,700010,300,a\n8,x,700040,300,b\n")
    with pytest.raises(ts.ReadError, match="PNEZD would have coordinates that are no numbers"):
        read_places(Path("plain.txt"), crs=CRS)
    with pytest.raises(ts.ReadError, match="holds polygons: points are needed"):
        read_places(Path("design.gpkg:triangles"), crs=CRS)
