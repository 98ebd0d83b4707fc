"""Gaps that a surface spans are told; what is dense along lines alone is left in peace."""

import json
import re

import numpy as np
import pytest
from click.testing import CliRunner

import tinsmith as ts
from tinsmith.cli import main
from tinsmith.tin.screening.gaps import describe_gaps

RNG = np.random.default_rng(5)


def ground(xy):
    return np.column_stack([xy, 100 + 0.02 * xy[:, 0] + 0.01 * xy[:, 1]])


def grid(columns, rows, dx=10.0, dy=10.0):
    x, y = np.meshgrid(np.arange(columns) * dx, np.arange(rows) * dy)
    return np.column_stack([x.ravel(), y.ravel()])


@pytest.mark.parametrize(
    "xy",
    [
        grid(40, 40),
        grid(400, 20, 1.0, 25.0),
        np.concatenate([grid(200, 1, 1.0) + np.array([0, 40 * k]) for k in range(12)]),
    ],
    ids=["grid", "scan lines", "contours"],
)
def test_even_ground_has_no_gaps(xy):
    assert describe_gaps(ts.triangulate(ground(xy))) == []


def test_a_void_inside_is_counted_and_the_option_closes_it():
    xy = grid(60, 60)
    xy = xy[np.hypot(*(xy - 295).T) > 120]
    tin = ts.triangulate(ground(xy))
    (sentence,) = describe_gaps(tin)
    limit = float(re.search(r"max_edge=([\d.]+)", sentence)[1])
    count = int(re.search(r"There are (\d+) triangles inside", sentence)[1])
    cut = ts.triangulate(ground(xy), max_edge=limit, trim="everywhere")
    assert len(tin.triangles) - len(cut.triangles) == count
    assert describe_gaps(cut) == []


def test_a_bay_along_the_boundary_is_told_apart():
    xy = grid(60, 60)
    tin = ts.triangulate(ground(xy[(xy > 300).sum(axis=1) < 2]))
    (sentence,) = describe_gaps(tin)
    limit = float(re.search(r"max_edge=([\d.]+)", sentence)[1])
    assert "along the boundary with edges of up to " in sentence
    assert " units, " in sentence
    assert describe_gaps(tin.replace(crs="EPSG:2274")) == [sentence.replace(" units,", " US ft,")]
    cut = ts.triangulate(tin.points, max_edge=limit)
    lost = len(tin.triangles) - len(cut.triangles)
    assert f"{lost} triangles" in sentence


@pytest.mark.parametrize(("n_wide", "n_sentences"), [(5, 1), (10, 0)])
def test_an_edge_is_usual_if_more_than_five_percent_are_as_long(n_wide, n_sentences):
    """Two of three edges between columns far apart are long: 3.3 % of all, or 6.7 %."""
    steps = [1.0] * (100 - n_wide) + [10.0] * n_wide
    x, y = np.meshgrid(np.cumsum([0.0, *steps]), np.arange(8.0))
    sentences = describe_gaps(ts.triangulate(ground(np.column_stack([x.ravel(), y.ravel()]))))
    assert len(sentences) == n_sentences
    # Of the short edges the diagonals are the 95th percentile: 1.1 times 1.415, rounded up.
    assert all("`max_edge=1.6` " in sentence for sentence in sentences)


def test_edges_of_lines_are_no_gaps():
    xy = grid(60, 60)
    xy = xy[np.hypot(*(xy - 295).T) > 120]
    angle = np.linspace(0, 2 * np.pi, 40, endpoint=False)
    ring = 295 + 118 * np.column_stack([np.cos(angle), np.sin(angle)])
    tin = ts.triangulate(ground(xy), holes=[ground(ring)])
    assert describe_gaps(tin) == []


def test_a_steep_sliver_along_the_hull_is_told():
    lifted = np.vstack([ground(grid(5, 5)), [20.5, -0.001, 112.0]])
    (sentence,) = describe_gaps(ts.triangulate(lifted))
    steepest = float(re.search(r"as steep as ([\d.]+)", sentence)[1])
    assert steepest > 89
    assert "`max_edge` below" in sentence


def test_build_tells_of_gaps_with_its_flags_unless_told_how_far_to_span(tmp_path):
    xy = grid(60, 60)
    np.savetxt(tmp_path / "a.xyz", ground(xy[np.hypot(*(xy - 295).T) > 120]))
    arguments = ["build", str(tmp_path / "a.xyz"), "-o", str(tmp_path / "a.ply")]
    result = CliRunner().invoke(main, [*arguments, "--report", str(tmp_path / "r.json")])
    assert re.search(
        r"^Note +There are \d+ triangles inside .* --max-edge 16 with --trim 'everywhere'",
        result.stderr,
        re.MULTILINE,
    )
    notes = json.loads((tmp_path / "r.json").read_text())["notes"]
    assert any("over a void" in note for note in notes)
    assert "over a void" not in CliRunner().invoke(main, [*arguments, "--max-edge", "16"]).stderr
