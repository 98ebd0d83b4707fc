"""``tinsmith compare``: the table, the picture, JSON, and what it refuses."""

from __future__ import annotations

import json
from pathlib import Path

import matplotlib.image
import numpy as np
import pytest
from click.testing import CliRunner

import tinsmith as ts
from tinsmith.cli import main
from tinsmith.cli.commands.surfaces.compare import _sample_points
from tinsmith.terrain import comparison_picture
from tinsmith.terrain.drawing.palette import TRIANGULATIONS

SAMPLES = Path(__file__).parents[2] / "sample_data"
SURVEY = SAMPLES / "site_survey.csv"


def run(*arguments, code=0):
    result = CliRunner().invoke(main, ["compare", *(str(one) for one in arguments)])
    assert result.exit_code == code, result.output
    return result


@pytest.fixture(scope="module")
def few(tmp_path_factory):
    """A file of 40 random points, in which the improved algorithm makes faults."""
    path = tmp_path_factory.mktemp("few") / "few.csv"
    table = np.random.default_rng(9).random((40, 3))
    np.savetxt(path, table, delimiter=",", header="easting,northing,elevation", comments="")
    return path


@pytest.fixture(scope="module")
def compared(few):
    """The comparison of the few points, and what the command says of it, as text and as JSON."""
    return ts.tin.compare(ts.read(few)), run(few).stdout, json.loads(run(few, "--json").stdout)


def row(output, label):
    """The cells of a row of the table."""
    lines = [line for line in output.splitlines() if line.startswith(label)]
    assert len(lines) == 1, output
    return lines[0][len(label) :].replace(" %", "%").replace(" ms", "ms").split()


def test_table_tells_what_the_library_says(compared):
    expected, shown, _ = compared
    counts = [f"{len(one.triangles):,}" for one in expected.outcomes]
    assert row(shown, "Triangles") == counts
    assert row(shown, "Tests") == [f"{one.tests:,}" for one in expected.outcomes]
    assert row(shown, "Overlapping")[1] != "0.00%"
    assert row(shown, "Gaps, area")[0] == "0.00%"
    assert row(shown, "  no removal")[-1] == "-"
    assert f"2n - 2 - h = {expected.expected} triangles" in shown


def test_json_is_the_comparison(few, compared):
    expected, _, facts = compared
    expected = expected.to_dict()
    for one, other in zip(facts["outcomes"], expected["outcomes"], strict=True):
        for name in ("triangles", "tests", "violating", "overlapping", "gap", "overlap"):
            assert one[name] == other[name]
    assert facts["input"] == str(few)
    assert facts["points"] == 40


def test_sample_is_the_same_every_time_and_part_of_the_points():
    facts = [json.loads(run(SURVEY, "--sample", 30, "--json").stdout) for _ in range(2)]
    assert facts[0]["points"] == 30
    assert facts[0]["hull_points"] == facts[1]["hull_points"]
    assert facts[0]["area"] == facts[1]["area"] < ts.triangulate(ts.read(SURVEY)).area


def test_sampled_points_keep_their_order():
    points = ts.read(SURVEY).points
    rows = {tuple(point): row for row, point in enumerate(points.tolist())}
    taken = [rows[tuple(point)] for point in _sample_points(points, 200).tolist()]
    assert taken == sorted(set(taken))
    assert len(taken) == 200


@pytest.mark.slow
def test_picture_marks_what_is_at_fault(tmp_path):
    table, picture = tmp_path / "points.csv", tmp_path / "out.png"
    np.savetxt(table, np.random.default_rng(1).random((75, 3)), delimiter=",", header="x,y,z")
    assert f"Written     {picture}" in run(table, "-o", picture).stdout
    pixels = (matplotlib.image.imread(picture)[..., :3] * 255).round().astype(int)
    upper, lower = np.array_split(pixels, 2)
    violating, gap = TRIANGULATIONS["violating"], TRIANGULATIONS["gap"]
    original, improved, only_one = np.array_split(upper, 3, axis=1)
    ties, exact, _ = np.array_split(lower[: int(0.9 * len(lower))], 3, axis=1)
    assert share(original, violating) == share(exact, violating) == 0.0
    assert share(ties, violating) == share(ties, gap) == 0.0
    assert share(ties, TRIANGULATIONS["sound"]) > 0.5
    assert share(improved, violating) > 0.001
    assert share(only_one, gap) > 0.5
    assert share(exact, gap) == 0.0
    assert share(exact, TRIANGULATIONS["sound"]) > 0.5


def share(pixels, color):
    wanted = [int(color[k : k + 2], 16) for k in (1, 3, 5)]
    return (np.abs(pixels - wanted) <= 2).all(axis=-1).mean()


@pytest.mark.slow
def test_picture_is_the_same_bytes_every_time(few, tmp_path):
    paths = [tmp_path / "a.png", tmp_path / "b.png"]
    for path in paths:
        run(few, "-o", path, "--quiet")
    assert paths[0].read_bytes() == paths[1].read_bytes()


def test_panels_are_captioned_with_counts():
    comparison = ts.tin.compare(np.random.default_rng(9).random((40, 3)))
    titles = [axes.get_title() for axes in comparison_picture(comparison, title="x").axes]
    for title, outcome in zip(titles, comparison.outcomes, strict=True):
        assert title.startswith(f"{outcome.name}: {len(outcome.triangles)} of ")
        assert f"{outcome.overlapping.sum()} overlapping" in title


def test_more_points_than_the_limit_name_the_way_out(tmp_path):
    path = tmp_path / "many.csv"
    np.savetxt(path, np.random.default_rng(1).random((2_501, 3)), delimiter=",", header="x,y,z")
    message = run(path, code=1).stderr
    assert "2,501 points" in message
    assert "--sample" in message


@pytest.mark.parametrize(
    ("arguments", "code", "words"),
    [
        (("--sample", "41"), 1, "40 points of the file"),
        (("--sample", "2"), 2, "x>=3"),
        (("-o", "out.svg"), 2, "must end in .png"),
        (("-o", "none/out.png"), 1, "none"),
    ],
)
def test_wrong_options_are_told(few, arguments, code, words, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert words in run(few, *arguments, code=code).stderr
    assert list(tmp_path.iterdir()) == []


def test_input_is_not_overwritten(few):
    assert "is the input" in run(few, "-o", few, code=2).stderr


def test_tin_is_refused(tmp_path):
    path = tmp_path / "tin.ply"
    ts.io.write(ts.triangulate([[0, 0, 0], [4, 0, 0], [0, 4, 0]]), path)
    assert "needs points" in run(path, code=1).stderr
