"""Events for programs: what people read on stderr, as JSON, a line each."""

from __future__ import annotations

import json
import warnings
from pathlib import Path

import pytest
from click.testing import CliRunner

from tinsmith.cli import main
from tinsmith.cli.output import progress

SQUARE = "x,y,z\n0,0,1\n4,0,2\n4,3,3\n0,3,4\n"
TWICE = SQUARE + "0,0,9\n"


@pytest.fixture
def run(tmp_path, monkeypatch):
    """Return a function that runs a command; it returns exit code, stdout and stderr."""
    monkeypatch.chdir(tmp_path)
    Path("in.csv").write_text(SQUARE)
    Path("twice.csv").write_text(TWICE)

    def run(*arguments):
        result = CliRunner().invoke(main, arguments)
        return result.exit_code, result.stdout, result.stderr

    return run


def read_events(text):
    return [json.loads(line) for line in text.splitlines()]


def test_steps_and_summary_are_what_people_read(run):
    code, out, err = run("build", "in.csv", "-o", "a.ply", "--events")
    found = read_events(err)
    assert (code, out) == (0, "")
    told = [one["text"] for one in found if one["event"] == "step"]
    steps = list(dict.fromkeys(told))  # one that tells its fraction is told several times
    assert steps[:2] == ["Reading in.csv", "Triangulating 4 points"]
    assert steps[-1] == "Writing a.ply"
    read = run("build", "in.csv", "-o", "a.ply")[2]
    rows = [one for one in found if one["event"] == "summary" and one["label"] != "Time"]
    assert {one["label"] for one in rows} >= {"Points", "TIN", "Extent", "CRS", "Written"}
    for row in rows:
        assert row["label"] in read
        assert all(line in read for line in row["text"].splitlines())
    assert {one["event"] for one in found} == {"step", "summary"}


PAD = (
    '{"type":"FeatureCollection","crs":{"type":"name","properties":{"name":"EPSG:32616"}},'
    '"features":[{"type":"Feature","properties":{},"geometry":{"type":"Polygon",'
    '"coordinates":[[[4,4],[8,4],[8,8],[4,8],[4,4]]]}}]}'
)
SLOPES = ["--cut-slope", "2", "--fill-slope", "2"]

# Commands of long steps: the step, and its arguments behind a file of points.
LONG = {
    "refine": ("Refining", ["--max-area", "2", "-o", "out.ply"]),
    "ground": ("Finding the ground", ["-o", "out.csv"]),
    "inspect": ("Checking points", []),
    "grade": ("Grading", ["--pad", "pad.geojson", "--elevation", "8", *SLOPES, "-o", "out.ply"]),
    "contours": ("Tracing contours", ["--interval", "1", "-o", "out.geojson", "--projected"]),
    "volume": ("Measuring", ["--base", "8"]),
}


@pytest.mark.parametrize("command", LONG)
def test_long_steps_tell_how_far_they_are(run, command):
    Path("pad.geojson").write_text(PAD)
    rows = [f"{x},{y},{8 + 0.01 * x * y + 0.3 * (x % 3)}" for x in range(14) for y in range(13)]
    Path("hill.csv").write_text("\n".join(["x,y,z", *rows]))
    step, arguments = LONG[command]
    code, _, err = run(command, "hill.csv", *arguments, "--crs", "EPSG:32616", "--events")
    assert code == 0, err
    told = [one for one in read_events(err) if one["event"] == "step" and step in one["text"]]
    assert told[0]["fraction"] is None
    fractions = [one["fraction"] for one in told[1:]]
    assert fractions == sorted(set(fractions))
    assert fractions[-1] == 1.0


def test_events_and_the_result_as_json_go_to_two_streams(run):
    code, out, err = run("check", "in.csv", "--events", "--json")
    assert code == 0
    assert json.loads(out)["ok"] is True
    assert {one["event"] for one in read_events(err)} == {"step"}


def test_quiet_leaves_warnings_and_errors(run):
    assert run("build", "in.csv", "-o", "a.ply", "--events", "-q") == (0, "", "")
    code, _, err = run("build", "none.csv", "-o", "a.ply", "--events", "-q")
    assert code == 1
    (event,) = read_events(err)
    assert event == {"event": "error", "text": "There is no file 'none.csv'.", "exit_code": 1}


@pytest.mark.parametrize(
    ("arguments", "code"),
    [
        (["build", "in.csv", "--events"], 2),
        (["build", "in.csv", "-o", "a.ply", "--snap", "x", "--events"], 2),
        (["--events", "build"], 2),
        (["no-such-command", "--events"], 2),
        (["build", "twice.csv", "-o", "a.ply", "--duplicates", "error", "--events"], 1),
    ],
)
def test_the_error_is_the_last_event_and_says_what_people_read(run, arguments, code):
    exit_code, _, err = run(*arguments)
    *_, last = read_events(err)
    assert (exit_code, last["event"], last["exit_code"]) == (code, "error", code)
    if arguments[0] != "--events":
        assert last["text"] in run(*(one for one in arguments if one != "--events"))[2]


@pytest.mark.filterwarnings("default:odd")
def test_warnings_are_events(run, monkeypatch):
    def warn(*_, **__):
        warnings.warn("odd\nthings", UserWarning, stacklevel=1)
        return []

    monkeypatch.setattr("tinsmith.tin.screening.notes.describe_gaps", warn)
    found = read_events(run("build", "in.csv", "-o", "a.ply", "--events")[2])
    assert {"event": "warning", "text": "odd things"} in found
    assert "Warning: odd things" in run("build", "in.csv", "-o", "a.ply")[2]


def test_what_follows_two_dashes_is_no_flag(run):
    code, _, err = run("info", "--", "--events")
    assert (code, err) == (1, "Error: There is no file '--events'.\n")


def test_fractions_rise_to_one_in_steps_of_a_hundredth(capsys):
    with progress.Steps(events=True) as steps, steps.step("Growing") as tell:
        for k in range(100_001):
            tell(k / 100_000)
        tell(1.0)
    found = read_events(capsys.readouterr().err)
    fractions = [one["fraction"] for one in found]
    assert fractions[0] is None
    assert fractions[-1] == 1.0
    assert 50 <= len(fractions) <= 102
    assert fractions[1:] == sorted(set(fractions[1:]))
    with progress.Steps(events=True, quiet=True) as steps, steps.step("Growing") as tell:
        tell(0.5)
    assert capsys.readouterr().err == ""
