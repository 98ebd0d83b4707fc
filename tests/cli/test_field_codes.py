"""Field codes on the command line: tables, styles, tolerances, and files of instruments."""

import json
from pathlib import Path

import pytest
from click.testing import CliRunner

from tinsmith.cli import main

CODES = Path(__file__).parents[2] / "sample_data" / "codes"
JUNCTION, TABLE = CODES / "junction.csv", CODES / "words.toml"
SITE = (JUNCTION, "--crs", "EPSG:32616")


def run(*arguments, code=0):
    result = CliRunner().invoke(main, [str(one) for one in arguments])
    assert result.exit_code == code, result.output
    return result.output


def test_info_tells_the_lines_of_codes():
    plain, coded = (run("info", *SITE, *more) for more in ((), ("--codes",)))
    assert "breakline" not in plain
    assert "8 breaklines, 1 water polygon" in coded
    assert "stand for the curves of EP1, EP2, WE1" in coded
    record = json.loads(run("info", *SITE, "--code-table", TABLE, "--json"))
    assert (record["points"], record["breaklines"], record["findings"]) == (67, 9, [])


def test_build_takes_a_table_a_style_and_a_tolerance(tmp_path):
    out, report = tmp_path / "a.ply", tmp_path / "a.json"
    run("build", *SITE, "--code-table", TABLE, "-o", out, "--report", report, "-q")
    fine = json.loads(report.read_text())
    run(
        *("build", *SITE, "--code-style", "words", "--arc-tolerance", 0.2),
        *("-o", out, "--report", report, "-q"),
    )
    assert json.loads(report.read_text())["vertices"] < fine["vertices"] + 5
    assert fine["findings"] == []


def test_findings_are_in_the_report(tmp_path):
    points = tmp_path / "a.csv"
    rows = ["1,0,0,5,EP1", "2,0,9,5,EP1 Q", "3,9,9,5,CL1", "4,9,0,6,EP1 E"]
    points.write_text("p,n,e,z,d\n" + "\n".join(rows) + "\n")
    report = tmp_path / "a.json"
    run("build", points, "--codes", "-o", tmp_path / "a.ply", "--report", report, "-q")
    found = json.loads(report.read_text())["findings"]
    assert [(one["kind"], one["rows"]) for one in found] == [
        ("unknown mark", [1]),
        ("too few points", [2]),
    ]


@pytest.mark.parametrize(
    ("arguments", "code", "words"),
    [
        (("--arc-tolerance", 1), 2, "--arc-tolerance needs --codes, --code-table or --code-style."),
        (("--codes", "--arc-tolerance", -1), 2, "Invalid --arc-tolerance -1"),
        (("--code-style", "nope"), 2, "'nope' is not one of 'words'"),
        (("--code-table", "none.toml"), 1, "Cannot read 'none.toml': No such file"),
        (("--code-table", JUNCTION), 1, "is no TOML"),
    ],
)
def test_what_cannot_be_is_one_sentence(arguments, code, words, tmp_path):
    output = run("build", *SITE, *arguments, "-o", tmp_path / "a.ply", code=code)
    assert words in " ".join(output.split())
    assert not (tmp_path / "a.ply").exists()


def test_a_doubt_names_the_flag_that_settles_it(tmp_path):
    points = tmp_path / "a.csv"
    rows = [f"{i},{i % 2},{i},5,{code}" for i, code in enumerate(("EP1/B", "EP1", "EP1/E", "EP1"))]
    points.write_text("p,n,e,z,d\n" + "\n".join(rows) + "\n")
    assert "--code-style says which is meant" in run("info", points, "--codes", code=1)
    assert "1 breakline" in run("info", points, "--code-style", "slash")


def test_a_table_is_no_output(tmp_path):
    table = tmp_path / "a.toml"
    table.write_bytes(TABLE.read_bytes())
    output = run("build", *SITE, "--code-table", table, "-o", table, code=2)
    assert "it cannot be the output too" in output
    assert table.read_bytes() == TABLE.read_bytes()


def test_shots_of_an_instrument_need_the_flag_that_its_sentence_names(tmp_path):
    path = tmp_path / "a.gsi"
    path.write_text(
        "110001+00000001 84..10+00500000 85..10+00600000 86..10+00100000 88..10+00001324 \n"
        "110002+00000002 21.322+10000000 22.322+10000000 31..00+00010000 87..10+00001300 \n"
    )
    assert "--oriented says that it does" in run("info", path, code=1)
    record = json.loads(run("info", path, "--oriented", "--refraction", 0.13, "--json"))
    assert record["bounds"]["xmin"] == pytest.approx(510)
    assert "Unknown option --oriented" in run("info", *SITE, "--oriented", code=1)
