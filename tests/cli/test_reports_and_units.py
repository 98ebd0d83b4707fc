"""Reports are JSON by name, a unit of lengths is taken for every file, coordinates are whole."""

import json

import pytest
from support.commands import refuse, run_command

import tinsmith as ts
from tinsmith.base.sentences import coordinate, height

LOCAL = "1,1000,5000,100,CP\n2,1000,5050,101,GS\n3,1050,5000,100.5,GS\n4,1050,5050,102,GS\n"


@pytest.fixture
def local(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    path = tmp_path / "local.csv"
    path.write_text(LOCAL)
    return path


def test_the_unit_that_a_warning_advises_is_taken(local):
    bare = ts.triangulate(ts.read(local, columns="PNEZD"))
    with pytest.warns(ts.LossWarning, match="option `unit` names one"):
        ts.write(bare, "bare.xml")
    told = run_command("build", local, "--columns", "PNEZD", "--unit", "ft", "-o", "ft.xml")
    assert "no units" not in told.stderr
    assert 'linearUnit="foot"' in (local.parent / "ft.xml").read_text()
    assert ts.read(local, columns="PNEZD", unit="ft").elevation_unit == ts.read(
        local, columns="PNEZD", elevation_unit="ft"
    ).elevation_unit  # fmt: skip


def test_a_unit_that_the_crs_has_not_is_refused(local):
    said = refuse(
        "build", local, "--columns", "PNEZD", "--unit", "ft", "--crs", "EPSG:32616", "-o", "x.xml"
    )
    assert "the unit of EPSG:32616" in said
    with pytest.raises(ts.base.errors.OptionError, match="metre, the unit of EPSG:32616"):
        ts.read(local, columns="PNEZD", unit="ft", crs="EPSG:32616")


def test_a_report_is_json_by_its_name(local):
    said = refuse("build", local, "--columns", "PNEZD", "--report", "r.csv", "-o", "x.gpkg", code=2)
    assert "does not end in .json" in said
    assert not (local.parent / "r.csv").exists()
    run_command("build", local, "--columns", "PNEZD", "--report", "r.JSON", "-o", "x.gpkg")
    assert json.loads((local.parent / "r.JSON").read_text())["rows"] == 4


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (4_024_250.1254, "4024250.125"),
        (752_690.0, "752690"),
        (-86.1234567, "-86.1234567"),
        (0.0, "0"),
        (3e-9, "3e-09"),
        (1e200, "1e+200"),
        (float("inf"), "inf"),
    ],
)
def test_coordinates_in_sentences_are_good_to_the_millimetre(value, text):
    assert coordinate(value) == text


@pytest.mark.parametrize(
    ("value", "text"), [(4025.12345, "4025.123"), (318.25, "318.25"), (-0.5, "-0.5")]
)
def test_elevations_in_sentences_are_good_to_the_millimetre(value, text):
    assert height(value) == text


def test_a_crossing_is_told_with_its_full_place():
    points = [
        [752_690, 4_024_225, 1],
        [752_700, 4_024_225, 1],
        [752_690, 4_024_300, 2],
        [752_710, 4_024_310, 2],
    ]
    tin = ts.triangulate(points)
    with pytest.raises(ts.base.errors.PointsError, match="x 752700, y 4024225 already"):
        tin.move(0, [752_700, 4_024_225, 1])
