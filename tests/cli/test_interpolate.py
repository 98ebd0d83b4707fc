"""``tinsmith interpolate`` as people run it."""

import csv
import json
from pathlib import Path

import numpy as np
import pytest
from support.commands import refuse, run

import tinsmith as ts

SITE = str(Path(__file__).parents[2] / "sample_data" / "site_survey.csv")


@pytest.fixture
def surface(tmp_path):
    points = np.random.default_rng(1).random((80, 3)) * [100, 100, 10]
    return ts.write(ts.triangulate(points, crs="EPSG:32616"), tmp_path / "tin.ply")


def places(tmp_path, text):
    path = tmp_path / "places.csv"
    path.write_text(text)
    return path


TABLE = 'id,Easting,Northing,remark\n007,50.50,40,"a, b"\n008,60,70.0,\n009,-5,0,far\n'


def test_all_columns_are_kept_as_they_stand(tmp_path, surface):
    out = run("interpolate", surface, "--at", places(tmp_path, TABLE), "-o", tmp_path / "out.csv")
    assert out.exit_code == 0, out.output
    assert "1 outside the surface" in out.stderr
    assert "By the header Easting is the easting" in out.stderr
    rows = list(csv.reader((tmp_path / "out.csv").read_text().splitlines()))
    assert rows[0] == ["id", "Easting", "Northing", "remark", "elevation (unknown)"]
    assert [row[:4] for row in rows[1:]] == [
        ["007", "50.50", "40", "a, b"],
        ["008", "60", "70.0", ""],
        ["009", "-5", "0", "far"],
    ]
    found = [float(row[4]) if row[4] else np.nan for row in rows[1:]]
    wanted = ts.read(surface).interpolate([[50.5, 40], [60, 70], [-5, 0]])
    np.testing.assert_array_equal(found, wanted)


@pytest.mark.parametrize(
    ("header", "crs"),
    [
        ("X (Northing),Y (Easting)", "EPSG:32616"),
        ("Hochwert,Rechtswert", "EPSG:32616"),
        ("X,Y", "EPSG:3844"),
    ],
)
def test_columns_of_places_are_named_as_in_survey_text(tmp_path, header, crs):
    corner = {"EPSG:32616": (752_600, 4_024_100), "EPSG:3844": (586_000, 330_000)}[crs]
    points = np.random.default_rng(1).random((80, 3)) * [100, 100, 10] + [*corner, 0]
    tin = ts.triangulate(points, crs=crs)
    file = ts.write(tin, tmp_path / "tin.ply")
    rows = "".join(f"{corner[1] + 10 * k},{corner[0] + 50}\n" for k in range(3, 7))
    out = run(
        *("interpolate", file, "--at", places(tmp_path, f"{header}\n{rows}")),
        *("-o", tmp_path / "out.csv"),
    )
    assert out.exit_code == 0, out.output
    found = [float(r[2]) for r in csv.reader((tmp_path / "out.csv").read_text().splitlines()[1:])]
    wanted = tin.interpolate([[corner[0] + 50, corner[1] + 10 * k] for k in range(3, 7)])
    np.testing.assert_allclose(found, wanted, atol=1e-9)


@pytest.mark.parametrize("header", ["-X,Y", "X (km x10),Y", "E,N (offset)", "Easting,Y"])
def test_columns_of_places_that_say_more_are_refused(tmp_path, surface, header):
    text = places(tmp_path, f"{header}\n10,20\n30,40\n")
    said = refuse("interpolate", surface, "--at", text, "-o", tmp_path / "out.csv")
    assert "easting and northing is open" in str(said)


def test_method_extrapolation_name_and_json(tmp_path, surface):
    out = run(
        *("interpolate", surface, "--at", places(tmp_path, TABLE), "--method", "natural"),
        *("--extrapolate", "nearest", "--column", "z", "-o", tmp_path / "out.json", "--json"),
    )
    assert out.exit_code == 0, out.output
    facts = json.loads(out.stdout)
    assert (facts["points"], facts["outside"], facts["method"]) == (3, 0, "natural")
    rows = json.loads((tmp_path / "out.json").read_text())["rows"]
    wanted = ts.read(surface).interpolate(
        [[50.5, 40], [60, 70], [-5, 0]], method="natural", extrapolate="nearest"
    )
    np.testing.assert_array_equal([row["z"] for row in rows], wanted)


def test_places_in_degrees_need_their_crs(tmp_path):
    table = places(tmp_path, "lon,lat\n-84.19,36.3327\n")
    files = ("interpolate", SITE, "--crs", "EPSG:32616", "--at", table, "-o", tmp_path / "o.csv")
    out = run(*files)
    assert out.exit_code == 1
    assert "longitudes and latitudes by their header" in out.stderr
    assert not (tmp_path / "o.csv").exists()
    out = run(*files, "--at-crs", "EPSG:4326", "--extrapolate", "nearest")
    assert out.exit_code == 0, out.output
    assert "transformed from EPSG:4326" in out.stderr


def test_columns_and_delimiter_by_name(tmp_path, surface):
    table = places(tmp_path, "a|b,c\n50|40\n")
    out = run(
        *("interpolate", surface, "--at", table, "--at-delimiter", "|"),
        *("--at-columns", "a", "b,c", "-o", tmp_path / "o.csv", "-q"),
    )
    assert out.exit_code == 0, out.output
    assert (tmp_path / "o.csv").read_text().startswith('a,"b,c",elevation')


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("", "is empty"),
        ("x y\n1 2\n", "no delimiter"),
        ("x;y,z\n1;2,3\n", "commas and semicolons"),
        ("a,b\n1,2\n", "easting and northing is open"),
        ("x,easting,y\n1,2,3\n", "easting and northing is open"),
        ("x,x,y\n1,2,3\n", "'x' twice"),
        ("x,,y\n1,2,3\n", "a column without a name"),
        (
            "x,y\n1,2\n3\n",
            "1 row with more or fewer cells than the 2 of the header (first: line 3)",
        ),
        ("x,y\n1,2\n3,nan\n", "1 row whose y is no finite number (first: line 3, 'nan')"),
        ("x,y\n1,2\n1_0,3\n", "whose x is no finite number"),
        ("x,y,elevation\n1,2,3\n", "a column 'elevation' already"),
        ('x,y\n1,"2\n', "line 2"),
    ],
)
def test_places_that_cannot_be_read(tmp_path, surface, text, sentence):
    path = tmp_path / "o.csv"
    said = refuse("interpolate", surface, "--at", places(tmp_path, text), "-o", path, code=1)
    assert sentence in said
    assert not path.exists()


def test_bytes_that_are_no_text(tmp_path, surface):
    table = tmp_path / "places.csv"
    table.write_bytes(b"x,y\n1,\xff\n")
    out = run("interpolate", surface, "--at", table, "-o", tmp_path / "o.csv")
    assert out.exit_code == 1
    assert "no text in UTF-8" in out.stderr


def test_inputs_are_never_overwritten(tmp_path, surface):
    table = places(tmp_path, TABLE)
    out = run("interpolate", surface, "--at", table, "-o", table)
    assert out.exit_code == 2
    assert table.read_text() == TABLE
