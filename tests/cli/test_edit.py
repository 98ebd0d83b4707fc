"""``tinsmith edit`` as a user runs it."""

from __future__ import annotations

import json

import numpy as np
import pytest
from click.testing import CliRunner

import tinsmith as ts
from tinsmith.cli import main

POINTS = "x,y,z\n0,0,5\n4,0,6\n4,4,7\n0,4,8\n2,1,9\n"
SCRIPT = [
    {"op": "insert", "points": [[3, 3, 1]]},
    {"op": "remove", "vertices": [4]},
    {"op": "move", "vertex": 4, "point": [1, 3, 2]},
    {"op": "set_elevation", "vertices": [0], "z": 50.0},
    {"op": "add_breakline", "coords": [[0.5, 0.5, 1], [3, 1, 2]]},
]


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "points.csv").write_text(POINTS)
    return tmp_path


def run(folder, script, *arguments):
    text = script if isinstance(script, str) else json.dumps(script)
    (folder / "script.json").write_text(text)
    return CliRunner().invoke(
        main, ["edit", "points.csv", "script.json", "-o", "out.ply", *arguments]
    )


def test_edits_are_those_of_python(folder):
    result = run(folder, SCRIPT, "--report", "report.json")
    assert result.exit_code == 0, result.stderr
    tin = ts.triangulate(np.genfromtxt("points.csv", delimiter=",", skip_header=1))
    for edit in SCRIPT:
        edit = dict(edit)
        getattr(tin, edit.pop("op"))(**edit)
    written = ts.read("out.ply")
    np.testing.assert_array_equal(written.points, tin.points)
    np.testing.assert_array_equal(written.triangles, tin.triangles)
    np.testing.assert_array_equal(written.constrained, tin.constrained)
    report = json.loads((folder / "report.json").read_text())
    assert [edit["op"] for edit in report["edits"]] == [edit["op"] for edit in SCRIPT]


def test_report_of_a_run_is_a_script(folder):
    run(folder, SCRIPT, "--report", "report.json")
    wanted = (folder / "out.ply").read_bytes()
    result = run(folder, (folder / "report.json").read_text())
    assert result.exit_code == 0, result.stderr
    assert (folder / "out.ply").read_bytes() == wanted


@pytest.mark.parametrize(
    ("script", "sentence"),
    [
        ("[{", "not JSON (line 1"),
        ("{}", "holds something else"),
        ("[3]", "holds something else"),
        ([{"op": "explode"}], "Edit 0 has op 'explode'"),
        ([{"op": "remove", "vertices": [99]}], "no vertex 99"),
        ([{"op": "remove"}], "wrong arguments"),
        ([{"op": "set_elevation", "vertices": [0], "z": "high"}], "Edit 0"),
        ([{"op": "insert", "points": "here"}], "Edit 0"),
    ],
)
def test_bad_script_is_one_sentence_and_writes_nothing(folder, script, sentence):
    result = run(folder, script)
    assert result.exit_code == 1
    assert sentence in " ".join(result.stderr.split())
    assert "Traceback" not in result.stderr
    assert "bug in tinsmith" not in result.stderr
    assert not (folder / "out.ply").exists()


def test_missing_script_is_named(folder):
    result = CliRunner().invoke(main, ["edit", "points.csv", "nowhere.json", "-o", "out.ply"])
    assert result.exit_code == 1
    assert "nowhere.json" in result.stderr


def test_json_tells_files_surface_and_report(folder):
    facts = json.loads(run(folder, SCRIPT, "--json").stdout)
    tin = ts.read(folder / "out.ply")
    assert (facts["input"], facts["script"]) == ("points.csv", "script.json")
    assert facts["outputs"] == ["out.ply"]
    assert facts["tin"]["vertices"] == len(tin.points)
    assert facts["tin"]["triangles"] == len(tin.triangles)
    assert len(facts["report"]["edits"]) == len(SCRIPT)


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"\xff\xfe[]", "'script.json' is not text in UTF-8: a list of edits is needed"),
        (b"[1", "'script.json' is not JSON (line 1: Expecting ',' delimiter): a list of edits"),
        (b"[1]", "'script.json' holds something else: a list of edits is needed"),
        (b"{}", "'script.json' holds something else: a list of edits is needed"),
    ],
)
def test_a_script_that_is_none_is_refused(folder, content, words):
    (folder / "script.json").write_bytes(content)
    result = CliRunner().invoke(main, ["edit", "points.csv", "script.json", "-o", "out.ply"])
    assert result.exit_code == 1
    assert words in result.stderr


def test_a_script_may_begin_with_a_byte_order_mark(folder):
    (folder / "script.json").write_bytes(b"\xef\xbb\xbf[]")
    result = CliRunner().invoke(main, ["edit", "points.csv", "script.json", "-o", "out.ply"])
    assert result.exit_code == 0
    assert "Edits       none" in result.stderr


TABLE = """op;vertex;easting;northing;elevation;line;name
insert;;3;3;1;;

remove;4;;;;;
move;4;1;3;2;;
set_elevation;0;;;50;;
add_breakline;;0.5;0.5;1;1;kerb
add_breakline;;3;1;2;1;
"""


def test_a_table_is_the_script(folder):
    named = [*SCRIPT[:-1], SCRIPT[-1] | {"name": "kerb"}]
    assert run(folder, named).exit_code == 0
    wanted = (folder / "out.ply").read_bytes()
    (folder / "edits.csv").write_text(TABLE)
    result = CliRunner().invoke(main, ["edit", "points.csv", "edits.csv", "-o", "table.ply"])
    assert result.exit_code == 0, result.stderr
    assert (folder / "table.ply").read_bytes() == wanted


def test_rows_one_behind_the_other_are_one_edit(folder):
    rows = ["op,vertex,x,y,z", "remove,3", "remove,4", "insert,,1,1,1", "insert,,2,2,2"]
    (folder / "edits.csv").write_text("\n".join(rows))
    result = CliRunner().invoke(
        main, ["edit", "points.csv", "edits.csv", "-o", "out.ply", "--report", "report.json"]
    )
    assert result.exit_code == 0, result.stderr
    edits = json.loads((folder / "report.json").read_text())["edits"]
    assert edits[0]["vertices"] == [3, 4]
    assert len(edits[1]["points"]) == 2


@pytest.mark.parametrize(
    ("table", "words"),
    [
        ("", "no column op"),
        ("op,colour\nremove,3", "the column 'colour'"),
        ("op,vertex\nremov,3", "line 2: op is 'remov'"),
        ("op,vertex\n\nremove,", "line 3: remove needs vertex, and vertex is missing"),
        ("op,vertex,x\nremove,3,5", "and x is not for it"),
        ("op,vertex\nremove,three", "vertex is 'three': a whole number is needed"),
        ("op,vertex\nremove,3,4", "there are 3 values for 2 columns"),
        ("op,x,y,z\nadd_breakline,1,1,1\nadd_breakline,2,2", "all vertices of a line"),
        ("op,vertex\nremove,99", "Edit 0 (remove)"),
    ],
)
def test_a_table_that_is_none_is_refused(folder, table, words):
    (folder / "edits.csv").write_text(table)
    result = CliRunner().invoke(main, ["edit", "points.csv", "edits.csv", "-o", "out.ply"])
    assert result.exit_code == 1
    assert words in result.stderr
    assert not (folder / "out.ply").exists()


def test_edits_of_a_file_are_taken_back(folder):
    (folder / "script.json").write_text(json.dumps(SCRIPT))
    for arguments in (
        ["points.csv", "script.json", "-o", "edited.gpkg"],
        ["edited.gpkg", "--undo", "2", "-o", "before.gpkg"],
        ["before.gpkg", "--undo", "3", "-o", "first.ply"],
    ):
        result = CliRunner().invoke(main, ["edit", *arguments])
        assert result.exit_code == 0, result.stderr
    assert "Undone" in result.stderr
    assert len(ts.read("before.gpkg").edits) == 3
    np.testing.assert_array_equal(
        ts.read("first.ply").points, ts.triangulate(ts.read("points.csv")).points
    )
    result = CliRunner().invoke(main, ["edit", "before.gpkg", "--undo", "4", "-o", "no.ply"])
    assert result.exit_code == 1
    assert "tells of 3 edits, and 4 cannot be taken back" in result.stderr
    assert CliRunner().invoke(main, ["edit", "points.csv", "-o", "no.ply"]).exit_code == 2
