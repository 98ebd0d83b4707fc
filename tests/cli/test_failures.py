"""Whatever goes wrong: one sentence, the right exit code, no traceback, nothing half-written."""

import json
import os
import re
import resource
import signal
import subprocess
import sys
from io import StringIO
from pathlib import Path

import click
import numpy as np
import pytest
from click.testing import CliRunner

import tinsmith as ts
from tinsmith.cli import group, main

SQUARE = "x,y,z\n0,0,1\n4,0,2\n4,3,3\n0,3,4\n"
PROGRAM = (sys.executable, "-m", "tinsmith")


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def build(text, *options):
    """Build a file of this text; return exit code, stdout, stderr."""
    Path("in.csv").write_text(text)
    result = CliRunner().invoke(main, ["build", "in.csv", "-o", "out.ply", *options])
    assert "Traceback" not in result.output
    return result.exit_code, result.stdout, result.stderr


def assert_wrong_usage(code, stdout, stderr, *words):
    assert code == 2, stderr
    usage, _, sentence = stderr.partition("Error: ")
    assert usage.startswith("Usage: ")
    assert_sentence(1, stdout, f"Error: {sentence}", *words)


def assert_sentence(code, stdout, stderr, *words):
    assert code == 1, stderr
    assert stdout == ""
    assert stderr.startswith("Error: ")
    assert stderr.count("\n") == 1
    assert stderr.endswith(".\n")
    assert not stderr.endswith("..\n")
    for word in words:
        assert word in stderr
    assert not any(path.is_file() for path in Path().glob("*.ply"))


def names():
    return sorted(path.name for path in Path().iterdir())


def program(*arguments, **options):
    return subprocess.run(
        [*PROGRAM, *map(str, arguments)],
        capture_output=True,
        text=True,
        check=False,
        timeout=600,
        **options,
    )


# ------------------------------------------------------------------ points that make no TIN


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("x,y,z\n0,0,1\n4,nan,2\n4,3,3\n0,3,4\n", ["line 3"]),
        ("x,y,z\n0,0,1\n4,0,2\n4,inf,3\n0,3,4\n", ["line 4"]),
        ("x,y,z\n0,0,1\n-Infinity,0,2\n4,1,3\n0,3,4\n", ["line 3"]),
        ("", ["empty"]),
        ("x,y,z\n", ["no row"]),
        ("x,y,z\n0,0,1\n4,0,2\n", ["2 points", "three"]),
        ("x,y,z\n0,0,1\n1,1,2\n2,2,3\n3,3,4\n", ["collinear"]),
        ("x,y,z\n5,5,1\n5,5,2\n5,5,3\n", ["one place"]),
        ("x,y,z\n0,0,1\n1e200,0,2\n4,1,3\n", ["range"]),
        ("x,y,z\n0,0,1\n4,0,two\n4,3,3\n0,3,4\n", ["line 3", "two"]),
        ("x,y,z\n0,0,1\n4,0,2\n4,3\n0,3,4\n", ["line 4"]),
        ("one,two\n1,2\n3,4\n5,6\n", ["column"]),
        ("%PDF-1.7 no table at all\n", ["PDF"]),
    ],
    ids=[
        "nan",
        "infinity",
        "minus infinity",
        "empty file",
        "header only",
        "two points",
        "collinear",
        "all duplicates",
        "beyond the exact range",
        "text for a number",
        "truncated row",
        "two columns",
        "another kind of file",
    ],
)
def test_points_that_make_no_tin(folder, text, words):
    assert_sentence(*build(text), *words)


def test_duplicates_refused_on_request(folder):
    text = SQUARE + "4,3,3.5\n"
    assert_sentence(*build(text, "--duplicates", "error"), "3.5", "rows 2, 4", "counted from 0")


def test_rows_at_fault_are_named_by_point_number(folder):
    rows = ["101,0,0,1,GS", "102,0,4,2,GS", "107,3,4,3,GS", "109,3,0,4,GS", "120,3,4,3.5,GS"]
    text = "Point,Northing,Easting,Elevation,Description\n" + "\n".join(rows) + "\n"
    assert_sentence(*build(text, "--duplicates", "error"), "point numbers: 107, 120")


def test_duplicates_of_different_height_are_told(folder):
    code, _, stderr = build(SQUARE + "4,3,3.5\n")
    assert code == 0
    assert "1 row at 1 place" in stderr
    assert "0.500" in stderr


def test_decimal_commas_are_understood(folder):
    text = "x;y;z\n0,5;0,25;1,125\n4,5;0,25;2,5\n4,5;3,75;3\n"
    assert build(text)[0] == 0
    np.testing.assert_array_equal(
        ts.io.read("out.ply").points, [[0.5, 0.25, 1.125], [4.5, 0.25, 2.5], [4.5, 3.75, 3]]
    )


def test_columns_that_the_file_does_not_have(folder):
    wanted = "easting=x,northing=y,elevation=depth"
    assert_wrong_usage(*build(SQUARE, "--columns", wanted), "depth", "x, y, z")
    assert_wrong_usage(*build(SQUARE, "--columns", "PENZD"), "--columns", "5 columns")


def test_columns_by_role_take_names_and_numbers(folder):
    assert build(SQUARE, "--columns", "easting=2,northing=x,elevation=z")[0] == 0
    np.testing.assert_array_equal(ts.io.read("out.ply").bounds.height, 4.0)


def test_assumed_layout_is_told(folder):
    rows = "1,4024240,752700,5,GS\n2,4024240,752704,6,GS\n3,4024243,752704,7,MH\n"
    code, _, stderr = build(rows, "--crs", "EPSG:32616")
    assert code == 0
    assert re.search(
        r"^Note +No header: the columns are taken as number, northing", stderr, re.MULTILINE
    )


def test_a_layout_that_may_be_two_is_refused(folder):
    rows = "1,4024240,752700,5,GS\n2,4024240,752704,6,GS\n3,4024243,752704,7,MH\n"
    assert_sentence(*build(rows), "PNEZD", "PENZD")
    assert build(rows, "--columns", "PNEZD")[0] == 0


def test_bad_rows_and_nodata_are_left_out_on_request(folder):
    rows = SQUARE + "1,1,x\n2,2,-9999\n"
    assert_sentence(*build(rows), "line 6")
    code, _, stderr = build(rows, "--skip-bad", "--nodata", "-9999")
    assert code == 0
    assert re.search(r"^Note +1 bad row is left out \(line 6", stderr, re.MULTILINE)
    assert re.search(
        r"^Note +Left out by the reader: 1 bad row, 1 nodata point\.$", stderr, re.MULTILINE
    )
    assert "4 vertices" in stderr


@pytest.mark.each_value
@pytest.mark.parametrize("flag", ["--crs", "--to-crs", "--source-crs"])
@pytest.mark.parametrize("crs", ["EPSG:999999", "", "no such", "EPSG:5703", "EPSG:4978"])
def test_an_unknown_crs_is_wrong_usage(folder, flag, crs):
    """Also one of elevations alone, or of the earth's centre."""
    assert_wrong_usage(*build(SQUARE, flag, crs), f"Invalid {flag}: ", f"'{crs}'")


COMMANDS_WITH_A_CRS = [
    [name]
    for name in ("build", "check", "convert", "hillshade", "info", "raster", "refine", "slope")
] + [
    ["contours", "--interval", "1"],
    ["compare"],
    ["diff", "in.csv"],
    ["drape", "in.csv"],
    ["edit", "in.csv"],
    ["interpolate", "in.csv"],
    ["profile", "--line", "in.csv"],
    ["view"],
    ["volume", "--base", "0"],
]


@pytest.mark.parametrize("arguments", COMMANDS_WITH_A_CRS, ids=lambda given: given[0])
def test_an_unknown_crs_is_wrong_usage_of_every_command(folder, arguments):
    Path("in.csv").write_text(SQUARE)
    result = CliRunner().invoke(main, [*arguments[:1], "in.csv", *arguments[1:], "--crs", "EPSG:1"])
    assert result.exit_code == 2
    assert "Error: Invalid --crs: unknown CRS 'EPSG:1'" in result.stderr


def test_a_crs_that_does_not_fit_the_data_is_no_wrong_usage(folder):
    assert_sentence(*build(SQUARE, "--to-crs", "EPSG:32616"), "CRS")


@pytest.mark.parametrize("flag", ["--format", "--output-format"])
def test_an_unknown_format_is_wrong_usage(folder, flag):
    assert_wrong_usage(*build(SQUARE, flag, "nosuch"), f"Invalid {flag}: unknown format 'nosuch'")


def test_levels_beyond_all_bounds_are_wrong_usage(folder):
    """Cells of a chequerboard, each crossed by 99,000 levels."""
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(120), np.arange(120)))
    rows = np.column_stack([x, y, (x + y) % 2 * 9_900])
    np.savetxt("in.csv", rows, "%d", delimiter=",", header="x,y,z", comments="")
    for product in ([], ["--bands"]):
        command = ["contours", "in.csv", "--interval", "0.1", "-o", "out.geojson", *product]
        result = CliRunner().invoke(main, command)
        assert result.exit_code == 2
        words = "Error: Invalid --interval 0.1: it must be so large that there are at most 2,147,"
        assert words in result.stderr
        assert not Path("out.geojson").exists()


def test_bad_snap(folder):
    assert_wrong_usage(*build(SQUARE, "--snap", "-1"), "Invalid --snap -1")


def test_raster_option_on_a_text_file(folder):
    assert_sentence(*build(SQUARE, "--band", "2"), "band")


# ------------------------------------------------------------------ files that are not right


@pytest.mark.parametrize("command", ["build", "info", "check", "view", "convert"])
@pytest.mark.parametrize(("name", "word"), [("none.csv", "no file"), ("sub", "folder")])
def test_missing_input_and_folder_as_input(folder, command, name, word):
    Path("sub").mkdir()
    output = [] if command in {"info", "check"} else ["-o", "out.png"]
    if command in {"build", "convert"}:
        output = ["-o", "out.ply"]
    result = CliRunner().invoke(main, [command, name, *output])
    assert_sentence(result.exit_code, result.stdout, result.stderr, name, word)


@pytest.mark.parametrize(
    ("output", "words"),
    [
        ("none/out.ply", ["none"]),
        ("out.tif", [".tif"]),
        ("sub.ply", ["folder"]),
    ],
)
def test_output_that_cannot_be(folder, output, words):
    Path("sub.ply").mkdir()
    Path("in.csv").write_text(SQUARE)
    result = CliRunner().invoke(main, ["build", "in.csv", "-o", output])
    assert_sentence(result.exit_code, result.stdout, result.stderr, *words)
    assert names() == ["in.csv", "sub.ply"]


def test_truncated_tin_and_raster(folder):
    points = np.random.default_rng(7).random((50, 3))
    ts.io.write(ts.triangulate(points), "whole.ply")
    whole = Path("whole.ply").read_bytes()
    Path("whole.ply").unlink()
    Path("cut.dat").write_bytes(whole[: len(whole) // 2])
    result = CliRunner().invoke(main, ["info", "cut.dat"])
    assert_sentence(result.exit_code, result.stdout, result.stderr, "cut.dat")


def test_truncated_raster(folder):
    pytest.importorskip("rasterio")
    whole = (Path(__file__).parents[2] / "sample_data" / "jacksboro.tif").read_bytes()
    Path("cut.tif").write_bytes(whole[: len(whole) // 2])
    result = CliRunner().invoke(main, ["info", "cut.tif"])
    assert_sentence(result.exit_code, result.stdout, result.stderr, "cut.tif")


def test_failed_write_leaves_the_old_file_and_no_other(folder):
    """A limit on the size of files stands for a disk that is full."""
    Path("in.csv").write_text(SQUARE + "".join(f"{i % 70},{i // 70},1\n" for i in range(5000)))
    Path("out.ply").write_text("old")
    limit = 20_000
    result = program(
        *("build", "in.csv", "-o", "out.ply"),
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit)),
    )
    assert (result.returncode, result.stdout) == (1, "")
    assert result.stderr == "Error: Cannot write 'out.ply': File too large.\n"
    assert Path("out.ply").read_text() == "old"
    assert names() == ["in.csv", "out.ply"]


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs /dev/full")
def test_standard_output_on_a_full_disk(folder):
    with Path("/dev/full").open("w") as full:
        result = subprocess.run(
            [*PROGRAM, "formats"], stdout=full, stderr=subprocess.PIPE, text=True, check=False
        )
    assert result.returncode == 1
    assert result.stderr == "Error: Cannot write to standard output: No space left on device.\n"


def test_closed_pipe_is_quiet(folder):
    reader, writer = os.pipe()
    os.close(reader)
    result = subprocess.run(
        [*PROGRAM, "formats"], stdout=writer, stderr=subprocess.PIPE, text=True, check=False
    )
    os.close(writer)
    assert result.stderr == ""
    assert result.returncode == 1


@pytest.mark.parametrize(
    ("raised", "code"),
    [(BrokenPipeError(), 1), (KeyboardInterrupt(), 130), (click.Abort(), 130), (None, 0)],
)
def test_exit_codes_of_what_ends_a_command(monkeypatch, raised, code):
    def end(*_, **__):
        if raised is not None:
            raise raised

    monkeypatch.setattr(click.Group, "main", end)
    silenced = []
    monkeypatch.setattr(group, "silence", silenced.append)
    with pytest.raises(SystemExit) as caught:
        main.main(["formats"])
    assert caught.value.code == code
    assert silenced == ([sys.stdout] if isinstance(raised, BrokenPipeError) else [])


# ------------------------------------------------------------------ standard streams


def shell(command):
    """Run a command line of the shell, in which `tinsmith` is this program."""
    script = f'tinsmith() {{ "{sys.executable}" -m tinsmith "$@"; }}\n{command}'
    return subprocess.run(
        ["bash", "-c", script], capture_output=True, text=True, check=False, timeout=600
    )


def test_a_result_with_nowhere_to_go_is_a_failure(folder):
    Path("in.csv").write_text(SQUARE)
    result = shell("tinsmith info in.csv >&-")
    assert result.returncode == 1
    assert result.stderr == "Error: Cannot write to standard output: it is closed.\n"


@pytest.mark.parametrize("streams", ["2>&-", ">&- 2>&-", ">&- 2>&- <&-", "2>/dev/full"])
def test_a_build_needs_no_standard_stream(folder, streams):
    Path("in.csv").write_text(SQUARE)
    result = shell(f"tinsmith build in.csv -o out.ply {streams}")
    assert (result.returncode, result.stdout, result.stderr) == (0, "", "")
    assert len(ts.read("out.ply").triangles) == 2  # nothing that was said went into the file


@pytest.mark.parametrize("streams", ["2>&-", "2>/dev/full"])
def test_an_error_that_cannot_be_told_keeps_its_exit_code(folder, streams):
    assert shell(f"tinsmith info none.csv {streams}").returncode == 1


@pytest.mark.parametrize(
    ("arguments", "code", "word"),
    [
        (["info", "none.csv", "--json"], 1, "There is no file 'none.csv'."),
        (["--json", "info"], 2, "--json"),
        (["check", "in.csv", "--level", "9", "--json"], 2, "'--level'"),
        (["build", "in.csv", "-o", "out.zzz", "--json"], 2, ".zzz"),
    ],
)
def test_failures_are_json_on_request(folder, arguments, code, word):
    Path("in.csv").write_text(SQUARE)
    result = CliRunner().invoke(main, arguments)
    found = json.loads(result.stdout)
    assert set(found) == {"error", "exit_code"}
    assert (result.exit_code, found["exit_code"]) == (code, code)
    assert word in found["error"]
    assert found["error"] in result.stderr


def test_a_file_called_json_is_no_option(folder):
    result = CliRunner().invoke(main, ["info", "--", "--json"])
    assert (result.exit_code, result.stdout) == (1, "")


def test_no_second_object_follows_the_answer(folder):
    """The answer of check is on stdout, with what is wrong; the failure is on stderr alone."""
    Path("twice.obj").write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n")
    whole = Path("twice.obj").read_text()
    Path("twice.obj").write_text(whole.replace("v 0 1 0", "v 0.9 0.2 0"))
    result = CliRunner().invoke(main, ["check", "twice.obj", "--json"])
    assert result.exit_code == 1
    assert isinstance(json.loads(result.stdout), dict)


# ------------------------------------------------------------------ sentences


@pytest.mark.parametrize(
    ("arguments", "code", "words"),
    [
        (["build", "in.csv", "-o", "a.ply", "--snap", "nan"], 2, "Invalid --snap nan"),
        (["build", "in.csv", "-o", "a.ply", "--max-edge", "0"], 2, "Invalid --max-edge 0.0"),
        (["refine", "in.csv", "-o", "a.ply", "--max-side", "-1"], 2, "Invalid --max-side -1.0"),
        (["build", "in.csv", "-o", "a.ply", "--stride", "2"], 1, "its options are --columns, "),
        (["build", "in.csv", "-o", "a.ply", "--crs", "EPSG:4326"], 1, "give --crs 'EPSG:"),
        (["build", "in.csv", "-o", "a.geojson"], 1, "with --projected."),
    ],
)
def test_sentences_name_flags_and_no_python(folder, arguments, code, words):
    Path("in.csv").write_text(SQUARE)
    result = CliRunner().invoke(main, arguments)
    assert result.exit_code == code
    assert words in result.stderr
    assert "None" not in result.stderr
    assert not re.search(r"\w=", result.stderr)


def test_names_of_files_are_no_options(folder):
    """Only what a sentence marks as an option becomes a flag."""
    result = CliRunner().invoke(main, ["info", "crs=EPSG.csv"])
    assert result.stderr == "Error: There is no file 'crs=EPSG.csv'.\n"


def test_numbers_in_sentences_are_plain(folder):
    code, _, stderr = build("x,y,z\n0,0,1\n1e200,0,2\n4,1,3\n")
    assert code == 1
    assert "x 1e+200" in stderr
    assert "np.float64" not in stderr


def test_names_of_lines_keep_their_capitals():
    lines = [ts.Breakline([[0, 0, 1], [1e200, 0, 1]], name="Kerb NORTH")]
    with pytest.raises(ts.LinesError, match=r"^Breakline 0 'Kerb NORTH' has a vertex outside"):
        ts.triangulate([[0, 0, 0], [1, 0, 0], [0, 1, 0]], breaklines=lines)


def test_one_thing_is_singular(folder):
    _, _, stderr = build("x,y,z\n0,0,1\n4,0,2\n4,3,3\n")
    assert "3 vertices, 1 triangle\n" in stderr
    result = CliRunner().invoke(main, ["convert", "out.ply", "-o", "out.obj"])
    assert "a TIN of 1 triangle from" in result.stderr


def test_a_name_that_would_break_the_line_is_escaped(folder):
    result = CliRunner().invoke(main, ["info", "no\nsuch\x1b[31m.csv"])
    assert result.stderr.startswith("Error: There is no file 'no")
    assert result.stderr.count("\n") == 1
    assert "\x1b" not in result.stderr
    Path("new\nline.csv").write_text(SQUARE)
    result = CliRunner().invoke(main, ["build", "new\nline.csv", "-o", "out.ply"])
    assert "4 from new\\nline.csv\n" in result.stderr


def test_format_that_cannot_be_written_is_refused_by_name(folder):
    Path("in.csv").write_text(SQUARE)
    arguments = ["build", "in.csv", "-o", "out.ply", "--output-format", "raster"]
    result = CliRunner().invoke(main, arguments)
    said = "Error: Cannot write 'out.ply': the format 'raster' can be read ("
    assert result.stderr.startswith(said)
    assert "), not written; a TIN can be written to .csv, " in result.stderr
    assert not Path("out.ply").exists()


# ------------------------------------------------------------------ wrong usage


@pytest.mark.parametrize(
    ("name", "fault"), [("out.foo", "has the unknown suffix '.foo'"), ("out", "has no suffix")]
)
def test_an_output_of_no_known_suffix_is_wrong_usage(folder, name, fault):
    Path("in.csv").write_text(SQUARE)
    result = CliRunner().invoke(main, ["build", "in.csv", "-o", name])
    assert result.exit_code == 2
    assert f"Error: '{name}' {fault}: .csv, " in result.stderr
    assert result.stderr.endswith("; --output-format names one whatever the suffix.\n")
    assert names() == ["in.csv"]


@pytest.mark.parametrize(
    "arguments",
    [
        [],
        ["nonsense"],
        ["build"],
        ["build", "in.csv"],
        ["build", "in.csv", "-o", "in.csv"],
        ["build", "in.csv", "-o", "a.ply", "-o", "a.ply"],
        ["build", "in.csv", "-o", "a.ply", "--kind", "hull"],
        ["build", "in.csv", "-o", "a.ply", "--duplicates", "most"],
        ["build", "in.csv", "-o", "a.ply", "--snap", "wide"],
        ["build", "in.csv", "-o", "a.ply", "--columns", "easting=x,northing"],
        ["check", "in.csv", "--level", "4"],
    ],
)
def test_wrong_usage_exits_with_two(folder, arguments):
    Path("in.csv").write_text(SQUARE)
    result = CliRunner().invoke(main, arguments)
    assert result.exit_code == 2
    assert "Usage:" in result.stderr
    assert result.stdout == ""
    assert Path("in.csv").read_text() == SQUARE


# ------------------------------------------------------------------ interruption and bugs


SIGNALLED_WHILE_WRITING = """
import os, sys
from tinsmith.cli import main
from tinsmith.io.vector.geojson import features

def write_long(texts):
    for batch in range(100_000):
        if batch == 10 and len(os.listdir()) == 2:  # the input, and what is written
            os.kill(os.getpid(), int(sys.argv.pop()))
        yield 0.0, ["{}"]

features.Texts.iterate = write_long
main(["build", "in.csv", "--crs", "EPSG:32616", "-o", "out.geojson"])
"""


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_signal_while_writing_leaves_nothing(folder, number):
    Path("in.csv").write_text(SQUARE)
    run = subprocess.run(
        [sys.executable, "-c", SIGNALLED_WHILE_WRITING, str(int(number))],
        capture_output=True,
        text=True,
        check=False,
        timeout=600,
        preexec_fn=lambda: signal.signal(number, signal.SIG_DFL),
    )
    assert (run.returncode, run.stdout) == (128 + number, "")
    assert run.stderr == "Interrupted; nothing was written.\n"
    assert names() == ["in.csv"]


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_signal_inside_a_finalizer_is_not_lost(number):
    # Python drops what is raised there: the program would go on as if nobody had stopped it.
    program = f"""
import signal, time
from tinsmith.cli.output.streams import Terminated, raise_for_signals

class Finalized:
    def __del__(self):
        signal.raise_signal({int(number)})

signal.signal(signal.SIGTERM, signal.SIG_DFL)
signal.signal(signal.SIGHUP, signal.SIG_DFL)
signal.signal(signal.SIGINT, signal.default_int_handler)
try:
    with raise_for_signals():
        Finalized()
        time.sleep(20)
except (Terminated, KeyboardInterrupt) as error:
    print(getattr(error, "number", int(signal.SIGINT)))
"""
    run = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, timeout=600, check=False
    )
    assert (run.stdout, run.stderr, run.returncode) == (f"{int(number)}\n", "", 0)


def test_another_exception_in_a_finalizer_is_told_as_usual():
    program = """
from tinsmith.cli.output.streams import raise_for_signals

class Finalized:
    def __del__(self):
        raise ValueError("told")

with raise_for_signals():
    Finalized()
"""
    run = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, timeout=600, check=False
    )
    assert "Exception ignored in" in run.stderr
    assert "ValueError: told" in run.stderr


def test_interrupt_after_the_first_file_names_it(folder, monkeypatch):
    from tinsmith import io

    write = io.write

    def interrupted(obj, path, **options):
        if path.name == "second.ply":
            raise KeyboardInterrupt
        return write(obj, path, **options)

    monkeypatch.setattr(io, "write", interrupted)
    Path("in.csv").write_text(SQUARE)
    arguments = ["build", "in.csv", "-o", "first.ply", "-o", "second.ply"]
    result = CliRunner().invoke(main, arguments)
    assert result.exit_code == 130
    assert result.stderr == "Interrupted; already written: first.ply.\n"


def test_bug_is_one_sentence_that_tells_how_to_see_more(folder, monkeypatch):
    monkeypatch.setattr("tinsmith.io.reading.read_with_fallbacks", lambda *_, **__: {}["nothing"])
    result = CliRunner().invoke(main, ["info", "in.csv"])
    assert result.exit_code == 1
    assert result.stderr.startswith("Error: A bug in tinsmith: KeyError: 'nothing'")
    assert "TINSMITH_DEBUG=1" in result.stderr
    monkeypatch.setenv("TINSMITH_DEBUG", "1")
    assert isinstance(CliRunner().invoke(main, ["info", "in.csv"]).exception, KeyError)


@pytest.mark.parametrize(
    ("error", "sentence"),
    [
        (MemoryError(), "not enough memory"),
        (OSError(28, "No space left on device", "x.ply"), "'x.ply': No space left on device"),
    ],
)
def test_system_errors_are_sentences(folder, monkeypatch, error, sentence):
    def fail(*_, **__):
        raise error

    monkeypatch.setattr("tinsmith.io.reading.read_with_fallbacks", fail)
    result = CliRunner().invoke(main, ["info", "in.csv"])
    assert_sentence(result.exit_code, result.stdout, result.stderr, sentence)


def test_warning_of_a_library_is_one_line(folder, monkeypatch):
    import warnings

    from tinsmith.io import reading

    read = reading.read_with_fallbacks

    def warned(*arguments, **options):
        with warnings.catch_warnings():
            warnings.simplefilter("always")
            warnings.warn("the datum\nis old", UserWarning, stacklevel=1)
        return read(*arguments, **options)

    monkeypatch.setattr(reading, "read_with_fallbacks", warned)
    Path("in.csv").write_text(SQUARE)
    result = CliRunner().invoke(main, ["info", "in.csv"])
    assert result.stderr == "Warning: the datum is old\n"


# ------------------------------------------------------------------ as a program


def test_program_separates_stdout_from_stderr(folder):
    Path("in.csv").write_text(SQUARE)
    result = program("build", "in.csv", "-o", "out.ply", "--json")
    assert result.returncode == 0
    assert json.loads(result.stdout)["tin"]["triangles"] == 2
    assert "2 triangles" in result.stderr
    assert "\x1b" not in result.stderr


def test_program_fails_with_a_sentence(folder):
    result = program("info", "none.csv")
    assert (result.returncode, result.stdout) == (1, "")
    assert result.stderr == "Error: There is no file 'none.csv'.\n"


def test_terminal_without_the_letters_gets_escapes(folder):
    environment = {**os.environ, "PYTHONIOENCODING": "iso8859-5"}
    Path("höhe.csv").write_text(SQUARE)
    assert program("build", "höhe.csv", "-o", "höhe.ply", env=environment).returncode == 0
    result = program("info", "höhe.ply", env=environment)
    assert (result.returncode, result.stderr) == (0, "")
    assert "h\\xf6he.ply" in result.stdout


def test_help_loads_no_heavy_library(folder):
    code = (
        "import sys; from tinsmith.cli import main\n"
        "try: main(['--help'])\n"
        "except SystemExit: pass\n"
        "print(sorted({'numpy', 'pandas', 'rich', 'pyproj', 'pyvista'} & set(sys.modules)))"
    )
    result = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True
    )
    assert result.stdout.splitlines()[-1] == "[]"


STEPS = """
import time
from tinsmith.cli.output import progress as steps
steps.PATIENCE = 0.0
with steps.Steps(quiet={quiet}) as shown, shown.step("Growing") as progress:
    progress(0.2)
    while shown._bar is not None and not shown._bar.live.is_started:
        time.sleep(0.01)
    progress(0.9)
    if shown._bar is not None:
        shown._bar.refresh()
"""


def test_progress_shows_the_fraction_done(monkeypatch):
    from rich.console import Console
    from rich.progress import Progress

    from tinsmith.cli.output import progress as steps

    bar = Progress(console=Console(file=StringIO()))
    monkeypatch.setattr(steps, "_make_progress_bar", lambda: bar)
    monkeypatch.setattr(steps, "_is_terminal", lambda: True)
    with steps.Steps() as shown, shown.step("Growing") as progress:
        seen = []
        for fraction in (0.2, 0.9, 1.0):
            progress(fraction)
            seen.append(bar.tasks[0].percentage)
    assert seen == [20, 90, 100]


@pytest.mark.parametrize(("quiet", "is_shown"), [(False, True), (True, False)])
def test_progress_is_shown_on_a_terminal_unless_quiet(quiet, is_shown):
    pty = pytest.importorskip("pty")
    terminal, other_end = pty.openpty()
    environment = {**os.environ, "TERM": "xterm", "COLUMNS": "100"}
    subprocess.run(
        [sys.executable, "-c", STEPS.format(quiet=quiet)],
        stderr=other_end,
        env=environment,
        check=True,
    )
    os.write(other_end, b".")
    assert (b"Growing" in os.read(terminal, 65536)) is is_shown
    os.close(terminal)
    os.close(other_end)


def test_progress_is_silent_in_a_pipe():
    result = subprocess.run(
        [sys.executable, "-c", STEPS.format(quiet=False)],
        capture_output=True,
        text=True,
        check=True,
    )
    assert result.stderr == ""
