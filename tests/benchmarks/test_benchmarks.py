"""Benchmarks: every one runs at a tiny size and its answers hold; no timing is looked at."""

from __future__ import annotations

import json
from fractions import Fraction
from itertools import pairwise

import numpy as np
import pytest
from support import oracles

import tinsmith as ts
from benchmarks.__main__ import SECTIONS, main
from benchmarks.answers import contours, interpolation, profiles, rasters, volumes
from benchmarks.compiled import PeerMissingError, build, build_harness
from benchmarks.datasets.edits import BATCH, EDIT_TASKS, INSERT_ALL, WHAT, make_edit_task
from benchmarks.datasets.lines import LINE_DATASETS, make_lines
from benchmarks.datasets.points import DATASETS, UTM_CORNER, make_points
from benchmarks.datasets.tasks import read_task, write_task
from benchmarks.measure import OURS, Outcome, Result, alternate, is_installed
from benchmarks.peers.answers import EQUAL, Verdict, judge_answer, rank_triangles
from benchmarks.peers.edit_tools import ALL_EDIT_TOOLS, BUILD, EDIT_TOOLS, OPENED, WITH_ARRAYS
from benchmarks.peers.line_tools import ALL_LINE_TOOLS, CGAL_INDICES, LINE_TOOLS
from benchmarks.peers.programs import find_present, run_program
from benchmarks.peers.tool_process import ToolFailedError, ToolProcess
from benchmarks.peers.triangulators import CDT, CGAL, DELAUNAY32, DETRIA, KERNEL, TOOLS, is_exact
from benchmarks.report import page
from benchmarks.report.__main__ import format_file
from benchmarks.report.goals import judge_goals as goals_of
from benchmarks.report.page import write_report
from benchmarks.sections import edits, kernel, lines, locate, readers, writers

N = 2_000


def distances(points):
    """Distance of each place to its nearest other one."""
    from scipy.spatial import KDTree

    local = points[:, :2] - UTM_CORNER
    return KDTree(local).query(local, k=2)[0][:, 1]


# -------------------------------------------------------------------- data sets


@pytest.mark.parametrize("name", DATASETS)
def test_data_sets_are_large_distinct_and_repeatable(name):
    points = make_points(name, N)
    assert points.shape[1] == 3
    assert 0.98 * N <= len(points) <= N
    assert len(np.unique(points[:, :2], axis=0)) == len(points)
    assert np.abs(points[:, 0] - 500_000).max() < 100_000
    assert np.abs(points[:, 1] - 4_000_000).max() < 100_000
    np.testing.assert_array_equal(points, make_points(name, N))


@pytest.mark.parametrize("name", DATASETS)
def test_tinsmith_is_right_on_every_data_set(name):
    points = make_points(name, 600)
    tin = ts.triangulate(points)
    ts.check(tin, level=3, points=points).raise_if_failed()
    assert len(tin.triangles) == 2 * len(points) - 2 - oracles.hull_size(points)


def test_raster_has_exact_spacing_and_runs_from_north_to_south():
    x, y, _ = make_points("raster", N).T
    assert set(np.diff(np.unique(x))) == set(np.diff(np.unique(y))) == {30.0}
    assert (np.diff(y) <= 0).all()


def test_decimal_raster_holds_the_doubles_nearest_to_decimals():
    x, y, _ = make_points("decimal raster", N).T
    np.testing.assert_array_equal(x, [float(f"{value:.1f}") for value in x])
    np.testing.assert_array_equal(y, [float(f"{value:.1f}") for value in y])
    assert len(set(np.diff(np.unique(x)))) > 1  # 0.1 is no binary number


def test_scan_lines_are_rounded_to_cm_and_near_their_lines():
    points = make_points("scan lines", N)
    np.testing.assert_array_equal(points[:, :2], np.round(points[:, :2], 2))
    across = points[:, 1] - np.round(points[:, 1])
    assert 0.0 < np.abs(across).max() <= 0.051


def test_clusters_are_narrow_and_wide():
    near = distances(make_points("clusters", N))
    assert near.min() < 0.02
    assert near.max() > 100.0


@pytest.mark.parametrize(("name", "apart"), [("contour lines", 100.0), ("survey tracks", 200.0)])
def test_lines_are_dense_along_and_sparse_across(name, apart):
    points = make_points(name, 50_000)
    assert np.median(distances(points)) < apart / 2


def test_rails_are_two_parallel_lines():
    xy = make_points("rails", N)[:, :2] - UTM_CORNER
    first, second = np.split(xy, 2)
    np.testing.assert_allclose(np.hypot(*(second - first).T), 1.435, atol=1e-8)
    np.testing.assert_allclose(np.hypot(*np.diff(first, axis=0).T), 0.2, atol=1e-8)


def test_circle_is_one_circle():
    xy = make_points("circle", N)[:, :2] - UTM_CORNER
    np.testing.assert_allclose(np.hypot(*xy.T), 1000.0, atol=1e-8)


def test_few_circles_are_seven():
    xy = make_points("few circles", N)[:, :2]
    for ring in np.split(xy, 7):
        radius = np.hypot(*(ring - (ring.min(axis=0) + ring.max(axis=0)) / 2).T)
        assert np.ptp(radius) < 0.01 * radius.max()


def test_dense_corner_holds_one_percent_in_one_metre():
    xy = make_points("dense corner", N)[:, :2] - UTM_CORNER
    assert np.count_nonzero(((xy >= 1.0) & (xy <= 2.0)).all(axis=1)) == N // 100


# ----------------------------------------------------------------------- verdicts


@pytest.fixture(scope="module")
def tin():
    return ts.triangulate(make_points("uniform", 300))


def judged(tin, answer):
    return judge_answer(tin, answer, rank_triangles(tin.triangles))


def test_verdict_accepts_any_order_of_triangles_and_corners(tin):
    shuffled = np.roll(tin.triangles[::-1], 1, axis=1)
    assert judged(tin, shuffled) == Verdict(True, EQUAL)
    assert judged(tin, tin.points[shuffled, :2]) == Verdict(True, EQUAL)


def test_verdict_names_missing_triangles_and_points(tin):
    found = judged(tin, tin.triangles[1:])
    assert not found.is_right
    assert found.text.startswith("1 triangles missing")
    around = (tin.triangles == np.setdiff1d(np.arange(300), tin.hull)[0]).any(axis=1)
    assert judged(tin, tin.triangles[~around]).text.startswith("1 points lost")


def test_verdict_names_points_that_were_not_given(tin):
    corners = tin.points[tin.triangles, :2] + [1e-9, 0.0]
    assert judged(tin, corners) == Verdict(False, "has points that were not given")


def flipped(tin):
    """Exchange the diagonal of the first two triangles that make a convex quadrangle."""
    xy = tin.points[:, :2]
    for t, (a, b, c) in enumerate(tin.triangles):
        other = tin.neighbors[t, 0]
        if other < 0:
            continue
        (d,) = set(tin.triangles[other]) - {b, c}
        turns = [
            np.cross(np.append(xy[q] - xy[p], 0), np.append(xy[r] - xy[p], 0))[2]
            for p, q, r in ((a, b, d), (a, d, c))
        ]
        if min(turns) > 0:
            made = tin.triangles.copy()
            made[t], made[other] = (a, b, d), (a, d, c)
            return made
    raise AssertionError


def test_verdict_tells_a_wrong_edge_from_a_broken_tie(tin):
    assert judged(tin, flipped(tin)) == Verdict(False, "1 edges not Delaunay")
    grid = ts.triangulate(make_points("raster", 300))
    assert judged(grid, flipped(grid)) == Verdict(True, "Delaunay; 1 ties broken otherwise")


def test_a_wrong_answer_of_an_exact_tool_is_a_failure():
    wrong = Verdict(False, "3 triangles missing")
    assert kernel._accept("SciPy", wrong) is wrong
    for tool in (OURS, KERNEL, CGAL, "Triangle"):
        with pytest.raises(AssertionError, match="3 triangles missing"):
            kernel._accept(tool, wrong)


# ------------------------------------------------------------------------- kernel


@pytest.mark.slow
def test_every_tool_triangulates():
    outcome = kernel.run([("raster", 300)], repeats=2)
    found = {result.tool: result for result in outcome.results}
    present = kernel.find_tools(kernel.ALL_TOOLS, TOOLS, "points", Outcome())
    assert list(found) == [*present, kernel.WORK]
    assert {OURS, KERNEL} <= set(present)
    assert found[OURS].note == found[KERNEL].note == EQUAL
    for tool in present:
        assert found[tool].count == 289
        assert len(found[tool].runs) == 2
        if is_exact(tool, TOOLS):
            assert found[tool].extra["is_right"], f"{tool}: {found[tool].note}"
    assert found[kernel.WORK].extra["searches"] > 0


def test_a_tool_that_exceeds_the_limit_is_described(tmp_path):
    points = make_points("uniform", 300)
    with ToolProcess(OURS, points, tmp_path, limit=0.0) as process:
        with pytest.raises(ToolFailedError, match="no answer within 0 s"):
            process.run()
        with pytest.raises(ToolFailedError, match="its process ended"):
            process._answer(60.0)


def test_a_tool_answers_the_same_at_every_run(tmp_path, tin):
    with ToolProcess(KERNEL, tin.points, tmp_path, limit=60.0) as process:
        assert process.run() > 0
        assert process.run() > 0
        np.testing.assert_array_equal(process.triangles(), tin.triangles)


def test_a_missing_cgal_is_said(monkeypatch, tmp_path):
    monkeypatch.setattr(build, "BUILT", tmp_path / "harness")
    monkeypatch.setattr(build.shutil, "which", lambda name: None)
    with pytest.raises(PeerMissingError, match=r"g\+\+ is not installed"):
        build_harness("cgal_points")
    outcome = Outcome()
    assert kernel.find_tools([OURS, CGAL], TOOLS, "points", outcome) == [OURS]
    assert outcome.skipped == ["CGAL: skipped, g++ is not installed."]


@pytest.mark.parametrize("tool", [DELAUNAY32, CDT, DETRIA])
def test_a_missing_source_is_said_with_what_fetches_it(monkeypatch, tmp_path, tool):
    monkeypatch.setattr(build, "BUILT", tmp_path / "harness")
    monkeypatch.setattr(build.shutil, "which", lambda name: name)
    monkeypatch.setenv(f"{tool.upper()}_SOURCE", str(tmp_path / "none"))
    outcome = Outcome()
    assert kernel.find_tools([OURS, tool], LINE_TOOLS, "lines", outcome) == [OURS]
    (said,) = outcome.skipped
    address, version = build.SOURCES[tool.lower()]
    assert "its source is not in" in said
    assert f"git clone {address} " in said
    assert f" checkout {version}, " in said


@pytest.mark.slow
def test_every_tool_is_either_here_or_named():
    outcome = Outcome()
    present = kernel.find_tools(kernel.ALL_TOOLS, TOOLS, "points", outcome)
    assert len(present) + len(outcome.skipped) == len(kernel.ALL_TOOLS)


# -------------------------------------------------------------------------- lines


@pytest.mark.parametrize("name", LINE_DATASETS)
def test_lines_do_not_cross_and_are_given_twice_the_same(name):
    import shapely

    task = make_lines(name, N)
    assert 0.95 * N <= len(task.vertices) <= 1.2 * N
    assert len(np.unique(task.vertices, axis=0)) == len(task.vertices)
    drawn = shapely.MultiLineString([line[:, :2] for line in task.breaklines()])
    assert drawn.is_simple
    pairs = shapely.MultiLineString(list(task.vertices[task.segments]))
    assert len(drawn.geoms) < len(pairs.geoms) or name == "long lines"
    assert drawn.equals(pairs)
    cut = shapely.MultiLineString(list(task.vertices[task.steps]))
    assert cut.length == pytest.approx(drawn.length, rel=1e-12)


def test_nested_rings_lie_each_in_the_next():
    import shapely

    rings = [shapely.Polygon(line) for line in make_lines("nested rings", 20 * N).breaklines()]
    assert len(rings) == 20 * N // 140
    assert all(b.contains_properly(a) for a, b in pairwise(rings))
    heights = [line[0, 2] for line in make_lines("nested rings", N).breaklines()]
    assert (np.diff(heights) < 0).all()


@pytest.mark.slow
def test_steps_of_raster_lines_are_cut_where_points_are_on_them_exactly():
    task = make_lines("raster lines", N)
    exact = [[Fraction(x), Fraction(y)] for x, y in task.vertices.tolist()]
    wanted = set()
    for start, end in task.segments.tolist():
        (ax, ay), (bx, by) = exact[start], exact[end]
        on = [i for i, (x, y) in enumerate(exact)
              if (bx - ax) * (y - ay) == (by - ay) * (x - ax)
              and min(ax, bx) <= x <= max(ax, bx) and min(ay, by) <= y <= max(ay, by)]  # fmt: skip
        on.sort(key=lambda i: abs(exact[i][0] - ax) + abs(exact[i][1] - ay))
        wanted |= {frozenset(pair) for pair in pairwise(on)}
    assert {frozenset(step) for step in task.steps.tolist()} == wanted
    assert len(wanted) > len(task.segments)


def test_tasks_survive_their_file(tmp_path):
    for task in (make_lines("hills", N), make_edit_task("mixed edits", 300)):
        write_task(task, tmp_path / "task.npz")
        for array, found in zip(task, read_task(type(task), tmp_path / "task.npz"), strict=True):
            np.testing.assert_array_equal(array, found)


@pytest.mark.slow
def test_every_tool_holds_the_lines():
    outcome = lines.run(1_000, names=["raster lines", "nested rings"], repeats=1)
    present = kernel.find_tools(ALL_LINE_TOOLS, LINE_TOOLS, "lines", Outcome())
    assert [r.tool for r in outcome.results] == 2 * present
    assert {OURS} <= set(present)
    for result in outcome.results:
        assert result.seconds > 0
        assert result.extra["is_right"] or result.tool == "Triangle", result


def test_verdict_names_edges_of_lines_that_are_missing():
    corners = [[0, 0, 0], [9, 0, 0], [9, 4, 0], [0, 5, 0]]
    tin = ts.triangulate(corners, breaklines=[[corners[0], corners[2]]])
    other = np.array([[0, 1, 3], [1, 2, 3]])
    wanted, steps = rank_triangles(tin.triangles), np.array([[2, 0]])
    assert judge_answer(tin, tin.triangles, wanted, steps=steps) == Verdict(True, EQUAL)
    lost = Verdict(False, "1 edges of lines missing")
    assert judge_answer(tin, other, wanted, steps=steps) == lost


def test_verdict_lets_an_edge_be_wrong_only_for_a_line():
    corners = np.array([[0, 0, 0], [9, 0, 0], [9, 4, 0], [0, 5, 0.0]])
    free = ts.triangulate(corners)
    pair = [1, 3] if [0, 2] in np.sort(free.edges, axis=1).tolist() else [0, 2]
    a, b = (i for i in range(4) if i not in pair)
    crossed = np.array([[*pair, a], [*pair, b]])
    wanted = rank_triangles(free.triangles)
    assert not judge_answer(free, crossed, wanted).is_right
    assert judge_answer(free, crossed, wanted, steps=np.array([pair])).is_right


# -------------------------------------------------------------------------- edits


def test_points_after_edits_are_those_of_edits_one_by_one():
    task = make_edit_task("mixed edits", 100)
    points = task.points.tolist()
    assert set(task.script[:, 0]) == {0.0, 1.0, 2.0, 3.0}
    for what, number, vertex, *xyz in task.script.tolist():
        at = int(vertex)
        if WHAT[int(what)] == "insert":
            points.append(xyz)
            continue
        assert points[at] == task.points[int(number)].tolist()
        if WHAT[int(what)] == "remove":
            del points[at]
        else:
            points[at] = xyz
    np.testing.assert_array_equal(task.afterwards(), points)


def test_batch_is_as_many_points_again():
    task = make_edit_task(BATCH, 300)
    assert set(task.script[:, 0]) == {INSERT_ALL}
    assert len(task.afterwards()) == len(np.unique(task.afterwards()[:, :2], axis=0)) == 600


@pytest.mark.slow
def test_every_tool_edits():
    outcome = edits.run(400, repeats=1)
    present = kernel.find_tools(ALL_EDIT_TOOLS, EDIT_TOOLS, "edits", Outcome())
    assert {OURS, OPENED, WITH_ARRAYS, BUILD} <= set(present)
    assert {r.tool for r in outcome.results} == set(present)
    assert len({r.task for r in outcome.results}) == len(EDIT_TASKS) + 1
    for result in outcome.results:
        assert result.seconds > 0
        assert result.extra["is_right"] or result.tool == "startinpy", result


# -------------------------------------------------------------------------- goals


def test_goals_take_the_quicker_way_of_cgal_and_the_worse_data_set():
    times = {
        ("nested rings", OURS): 2.0,
        ("nested rings", CGAL): 5.0,
        ("nested rings", CGAL_INDICES): 4.0,
        ("hills", OURS): 1.0,
        ("hills", CGAL): 0.5,
        ("hills", CGAL_INDICES): float("nan"),
    }
    results = [Result("lines", *key, 1_000_000, seconds) for key, seconds in times.items()]
    (row,) = goals_of(results)
    assert row[1:] == ["hills (worst of 2)", "\u2265 1", "1.5", "0.50", "\u2717"]
    (row,) = goals_of(results[:3])
    assert row[1:] == ["nested rings", "\u2265 1", "1.5", "2.00", "\u2713"]


# ------------------------------------------------------------------ other sections


def test_tools_take_turns():
    order = []
    calls = {name: lambda name=name: order.append(name) or name for name in "ABC"}
    answers, runs = alternate(calls, 2)
    assert order == list("ABCABC")
    assert answers == {"A": "A", "B": "B", "C": "C"}
    assert {len(seconds) for seconds in runs.values()} == {2}


@pytest.mark.parametrize(
    ("run", "tasks"),
    [
        (locate.run, 2),
        (readers.run, 6),
        (writers.run, 11),
        (profiles.run, 2),
        (interpolation.run, 5),
        (rasters.run, 1),
        (volumes.run, 1),
        (contours.run, 1),
    ],
)
def test_section_runs_and_its_answers_agree(run, tasks):
    outcome = run(500, repeats=1)
    ours = [result for result in outcome.results if result.tool == OURS]
    assert len({result.task for result in ours}) == len(ours)
    assert len(ours) == tasks - sum("skipped, rasterio" in line for line in outcome.skipped)
    for result in outcome.results:
        assert 450 <= result.count <= 50_000
        assert result.seconds > 0


def test_a_missing_program_is_said_and_a_failing_one_too():
    outcome = Outcome()
    assert find_present({"A": "sh", "B": "no-such-program"}, outcome) == ["A"]
    assert outcome.skipped == ["B: skipped, no-such-program is not installed."]
    with pytest.raises(RuntimeError, match="sh failed: no such thing"):
        run_program(["sh", "-c", "echo no such thing >&2; exit 3"])


def test_volumes_that_do_not_add_up_are_an_error(monkeypatch):
    measured = volumes._measure_exactly
    monkeypatch.setattr(
        volumes, "_measure_exactly", lambda *tins: measured(*tins)._replace(cut=1.0)
    )
    with pytest.raises(AssertionError, match="cut and fill are off by"):
        volumes.run(500, repeats=1)


def test_a_raster_with_other_cells_is_an_error():
    wanted = np.ones((4, 4))
    rasters._require_same("a tool", wanted, wanted + 1e-9)
    with pytest.raises(AssertionError, match="Mismatched elements: 16 / 16"):
        rasters._require_same("a tool", wanted, wanted + 1e-3)
    with pytest.raises(AssertionError, match="a tool has other cells inside"):
        rasters._require_same("a tool", wanted, np.where(np.eye(4) > 0, np.nan, wanted))


# ------------------------------------------------------------------------- report


def test_the_page_has_a_part_for_every_section():
    assert list(page.SECTIONS) == list(SECTIONS)


@pytest.mark.slow
def test_report_is_a_page_data_and_a_plot(tmp_path, capsys):
    arguments = ["kernel", "writers", "--points", "300", "--only", "circle", "--repeats", "1",
                 "--tools", OURS, KERNEL, "--output", str(tmp_path)]  # fmt: skip
    main(arguments)
    page = (tmp_path / "benchmarks.md").read_text(encoding="utf-8")
    data = json.loads((tmp_path / "benchmarks.json").read_text(encoding="utf-8"))
    assert "| circle, 300 |" in page
    assert format_file(tmp_path / "benchmarks.json") == page
    assert "## Writers" in page
    assert "## Readers" not in page
    tools = [r["tool"] for r in data["results"] if r["section"] == "kernel"]
    assert tools == [OURS, KERNEL, kernel.WORK]
    assert data["command"].startswith("python -m benchmarks kernel writers --points 300")
    assert (tmp_path / "benchmarks.png").exists() == is_installed("matplotlib")
    assert str(tmp_path / "benchmarks.md") in capsys.readouterr().out


@pytest.mark.slow
def test_report_has_lines_and_edits(tmp_path):
    arguments = ["lines", "edits", "--points", "400", "--only", "hills", "--repeats", "1",
                 "--output", str(tmp_path)]  # fmt: skip
    main(arguments)
    page = (tmp_path / "benchmarks.md").read_text(encoding="utf-8")
    assert "| hills, 980 |" in page
    assert "short lines, " not in page
    assert "| mixed edits, TIN of 400 points | tinsmith | 100 |" in page
    assert (tmp_path / "benchmarks-lines.png").exists() == is_installed("matplotlib")
    assert ("benchmarks-lines.png" in page) == is_installed("matplotlib")


def test_answers_have_a_page_of_their_own_that_says_what_is_compared(tmp_path):
    outcome = Outcome()
    figures = {
        contours.TASK: {OURS: 0.2, contours.MATPLOTLIB: 1.5},
        rasters.label_task(1_000_000): {OURS: 1.0, rasters.FILES: 2.0, rasters.GDAL: 9.0},
        volumes.TASK: {OURS: 5.5},
    }
    for task, seconds in figures.items():
        for tool, value in seconds.items():
            outcome.results.append(Result("answers", task, tool, 1_000_000, value, (value,), ""))
    written = write_report(outcome, {"machine": "one"}, "a command", tmp_path / "answers.md")
    assert written == [tmp_path / "answers.md"]
    assert list(tmp_path.iterdir()) == written
    page = written[0].read_text(encoding="utf-8")
    assert "| contours: 72 levels | matplotlib | 1,000,000 | 1.50 s | 7.50 |" in page
    assert "```sh\na command\n```" in page
    assert "- Contours beside matplotlib on the same TIN" in page
    assert "The same lines must come of the TIN: as many, as long." in " ".join(page.split())
    reached = [row[-2:] for row in goals_of(outcome.results)]
    assert reached == [["7.50", "\u2713"], ["4.50", "\u2717"], ["5.50", "\u2717"]]


def test_too_few_points_are_refused(capsys):
    with pytest.raises(SystemExit):
        main(["--points", "10"])
    assert "at least 200 are needed" in capsys.readouterr().err
