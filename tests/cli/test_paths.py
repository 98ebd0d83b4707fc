"""Files in and out: what must not be overwritten, and standard input and output in their place."""

import json
import os
import subprocess
import sys
import threading
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

import tinsmith as ts
from tinsmith.cli import main

SQUARE = "x,y,z\n0,0,1\n4,0,2\n4,3,3\n0,3,4\n"
RING = [[1, 1], [3, 1], [3, 2], [1, 2], [1, 1]]
HOLE = {
    "type": "Polygon",
    "coordinates": [RING],
    "crs": {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::32616"}},
}
PROGRAM = (sys.executable, "-m", "tinsmith")


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("s.csv").write_text(SQUARE)
    Path("hole.geojson").write_text(json.dumps(HOLE))
    Path("e.json").write_text('[{"op": "remove", "vertices": [1]}]')
    ts.write(ts.triangulate(ts.read("s.csv")), "ok.ply")
    return tmp_path


def invoke(*arguments, **how):
    return CliRunner().invoke(main, [str(one) for one in arguments], **how)


def contents():
    return {path.name: path.read_bytes() for path in Path().iterdir() if path.is_file()}


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ("build s.csv -o x.ply --report s.csv", "does not end in .json"),
        ("build s.csv -o ./s.csv", "'s.csv' is the input"),
        ("build s.csv -o sub/../s.csv", "is the input"),
        ("build s.csv -o link.csv", "is the input"),
        ("build link.csv -o s.csv", "is the input"),
        ("build s.csv -o hard.csv", "is the input"),
        ("build s.csv --holes hole.geojson -o hole.geojson", "is the file of --holes"),
        ("build s.csv --holes hole.geojson:hole -o hole.geojson", "is the file of --holes"),
        (
            "build s.csv --breaklines hole.geojson -o x.ply --report hole.geojson",
            "does not end in .json",
        ),
        ("edit ok.ply e.json -o e.json", "is the script"),
        ("edit ok.ply e.json -o y.ply --report ok.ply", "does not end in .json"),
        ("edit ok.ply e.json -o y.ply --report e.json", "is the script"),
        ("build s.csv -o a.ply --report a.ply", "does not end in .json"),
        ("build s.csv -o a.ply -o sub/../a.ply", "named twice as output"),
        ("build s.csv -o a.ply -o sub/link.ply", "named twice as output"),
        ("refine ok.ply -o ok.ply", "is the input"),
        ("convert ok.ply -o ok.ply", "is the input"),
        ("info ok.ply --plot ok.ply", "is the input"),
        ("view ok.ply -o ok.ply", "is the input"),
        ("compare s.csv -o s.csv", "is the input"),
        ("build dem.tif -o x.ply --report dem.tif.aux.xml", "does not end in .json"),
        ("build s.csv --holes h.shp -o x.ply --report h.dbf", "does not end in .json"),
    ],
)
def test_nothing_that_is_read_or_written_is_overwritten(folder, arguments, words):
    Path("sub").mkdir()
    Path("sub/link.ply").symlink_to("../a.ply")
    Path("link.csv").symlink_to("s.csv")
    Path("hard.csv").hardlink_to("s.csv")
    for name in ("dem.tif", "dem.tif.aux.xml", "h.shp", "h.dbf"):
        Path(name).write_text(name)
    before = contents()
    result = invoke(*arguments.split())
    assert result.exit_code == 2
    assert words in result.stderr
    assert contents() == before


def test_other_files_of_the_same_stem_are_free(folder):
    Path("s.dat").write_text("old")
    assert invoke("build", "s.csv", "-o", "s.ply", "-o", "s.dat", "-q").exit_code == 0
    assert Path("s.dat").read_text() != "old"  # outputs that are there are replaced


def test_capitals_count_where_the_system_tells_them_apart(folder, monkeypatch):
    from tinsmith.cli import paths

    assert invoke("build", "s.csv", "-o", "a.ply", "-o", "A.ply", "-q").exit_code == 0
    monkeypatch.setattr(paths, "_ignores_case", lambda _: True)
    result = invoke("build", "s.csv", "-o", "b.ply", "-o", "B.ply", "-q")
    assert result.exit_code == 2
    assert "named twice" in result.stderr


@pytest.mark.parametrize(
    "arguments",
    [
        ("build", "none.csv", "-o", "none/a.ply"),
        ("build", "none.csv", "-o", "a.ply", "--report", "none/r.json"),
        ("edit", "none.ply", "e.json", "-o", "a.ply", "--report", "none/r.json"),
        ("info", "none.ply", "--plot", "none/p.png"),
        ("view", "none.ply", "-o", "none/p.png"),
        ("compare", "none.csv", "-o", "none/p.png"),
    ],
)
def test_a_missing_folder_is_found_before_anything_is_read(folder, arguments):
    result = invoke(*arguments)
    assert result.exit_code == 1
    assert "there is no folder 'none'" in result.stderr


def test_a_folder_that_may_not_be_written_to_is_found_before_anything_is_read(folder, monkeypatch):
    from tinsmith.base import atomic

    monkeypatch.setattr(atomic.os, "access", lambda path, mode: mode != os.W_OK | os.X_OK)
    result = invoke("build", "none.csv", "-o", "a.ply")
    assert result.exit_code == 1
    assert "may not be written to" in result.stderr


def test_long_names_have_room_for_the_temporary_file(folder):
    name = "ü" * 120 + ".ply"  # 244 bytes of 255
    assert invoke("build", "s.csv", "-o", name, "-q").exit_code == 0
    result = invoke("build", "s.csv", "-o", "a" * 300 + ".ply")
    assert result.exit_code == 1
    assert "File name too long" in result.stderr


def test_python_may_write_onto_the_source(folder):
    tin = ts.read("ok.ply")
    points = tin.points.copy()
    ts.write(tin, "ok.ply")
    np.testing.assert_array_equal(ts.read("ok.ply").points, points)


# ------------------------------------------------------------------ pipes


def many_points(n=20_000):
    rng = np.random.default_rng(1)
    xyz = rng.random((n, 3)) * [999, 999, 50] + [752_000, 4_024_000, 300]
    return "".join(f"{x:.3f} {y:.3f} {z:.4f}\n" for x, y, z in xyz)


def piped(command, text, *arguments):
    return subprocess.run(
        ["bash", "-c", command.replace("tinsmith", f'"{PROGRAM[0]}" -m tinsmith'), *arguments],
        input=text,
        capture_output=True,
        text=True,
        check=False,
        timeout=600,
    )


@pytest.mark.parametrize(
    "command",
    [
        "tinsmith info - --json",
        "tinsmith info /dev/stdin --format xyz --json",
        "cat | tinsmith info /dev/stdin --json",
        "tinsmith info <(cat) --format xyz --json",
        "cat > p.xyz; tinsmith info - --json < p.xyz",
    ],
)
def test_a_pipe_is_read_from_its_first_byte(folder, command):
    result = piped(command, many_points())
    assert result.returncode == 0, result.stderr
    assert json.loads(result.stdout)["points"] == 20_000


def test_a_named_pipe_is_read_from_its_first_byte_in_python(folder):
    os.mkfifo("pipe.xyz")
    text = many_points()
    writer = threading.Thread(target=Path("pipe.xyz").write_text, args=(text,))
    writer.start()
    survey = ts.read("pipe.xyz")
    writer.join()
    Path("file.xyz").write_text(text)
    np.testing.assert_array_equal(survey.points, ts.read("file.xyz").points)
    assert survey.source == "pipe.xyz"


@pytest.mark.slow
def test_lines_and_scripts_come_from_pipes(folder):
    pytest.importorskip("pyogrio")
    result = piped(
        "tinsmith build s.csv --crs EPSG:32616 --holes <(cat) -o a.ply",
        Path("hole.geojson").read_text(),
    )
    assert result.returncode == 0, result.stderr
    assert ts.read("a.ply").area == 12 - 2
    result = piped("tinsmith edit ok.ply - -o b.ply", Path("e.json").read_text())
    assert result.returncode == 0, result.stderr
    assert len(ts.read("b.ply").points) == 3


def test_faults_of_a_pipe_speak_of_the_pipe(folder):
    os.mkfifo("pipe.csv")
    writer = threading.Thread(target=Path("pipe.csv").write_text, args=("x,y,z\n0,0,two\n",))
    writer.start()
    with pytest.raises(ts.ReadError, match=r"^'pipe\.csv'.*line 2") as caught:
        ts.read("pipe.csv")
    writer.join()
    assert caught.value.file == Path("pipe.csv")


@pytest.mark.parametrize("name", ["/dev/null", "/dev/zero", "/dev/full"])
def test_devices_are_refused(folder, name):
    with pytest.raises(ts.ReadError, match="is a device or a terminal"):
        ts.read(name)


def test_empty_and_closed_standard_input(folder):
    result = piped("tinsmith info - < /dev/null", "")
    assert (result.returncode, result.stderr) == (
        1,
        "Error: 'standard input' is empty: there are no points in it.\n",
    )
    result = piped("tinsmith info - <&-", "")
    assert result.returncode == 1
    assert "closed" in result.stderr or "empty" in result.stderr


@pytest.mark.parametrize("name", ["xyz", "ply", "geojson"])
def test_standard_output_gets_what_a_file_would(folder, name):
    options = ["--projected"] if name == "geojson" else []
    written = f"a.{name}"
    arguments = ("convert" if name == "xyz" else "build", "s.csv", *options, "-q")
    assert invoke(*arguments, "-o", written).exit_code == 0
    result = invoke(*arguments, "-o", "-", "--output-format", name)
    assert result.exit_code == 0
    assert result.stdout_bytes == Path(written).read_bytes()


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ("build s.csv -o -", "needs --output-format"),
        ("build s.csv -o - --output-format ply --json", "both write to standard output"),
        ("build s.csv -o - -o - --output-format ply", "'-' is named twice"),
        ("edit - - -o a.ply", "'-' is named twice"),
        ("build s.csv -o a.ply --report -", "'-' is a standard stream"),
        ("build s.csv -o a.ply --holes -", "'-' is a standard stream"),
        ("info ok.ply --plot -", "'-' is a standard stream"),
    ],
)
def test_standard_streams_where_they_make_no_sense(folder, arguments, words):
    result = invoke(*arguments.split())
    assert result.exit_code == 2
    assert words in result.stderr


def test_a_file_may_be_called_like_an_option_or_a_stream(folder):
    Path("-").write_text(SQUARE)
    Path("--top").write_text(SQUARE)
    assert json.loads(invoke("info", "./-", "--json", "--format", "csv").stdout)["points"] == 4
    found = invoke("info", "--json", "--format", "csv", "--", "--top").stdout
    assert json.loads(found)["points"] == 4


def test_a_terminal_gets_no_bytes(folder):
    pty = pytest.importorskip("pty")
    terminal, other_end = pty.openpty()
    arguments = ["build", "s.csv", "-o", "-", "--output-format", "ply"]
    result = subprocess.run(
        [*PROGRAM, *arguments], stdout=other_end, stderr=subprocess.PIPE, text=True, check=False
    )
    os.close(terminal)
    os.close(other_end)
    assert result.returncode == 2
    assert "is binary" in result.stderr


def test_a_file_that_vanishes_is_a_sentence(folder, monkeypatch):

    def vanished(path, **_):
        raise FileNotFoundError(2, "No such file or directory", str(path))

    monkeypatch.setattr("tinsmith.io.registry.format.load_function", lambda _: vanished)
    with pytest.raises(ts.ReadError, match=r"There is no file 's\.csv'"):
        ts.read("s.csv")
