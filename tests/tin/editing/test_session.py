"""Edits of a TIN in place: after any of them it is the TIN of a fresh build."""

from __future__ import annotations

import copy
import json

import numpy as np
import pytest
from support.point_sets import small_integers, tenths, utm_floats

import tinsmith as ts
from tinsmith.tin.editing.history import apply_edits
from tinsmith.tin.editing.operations import OPERATIONS


def with_elevations(kind):
    return lambda rng, n: np.c_[kind(rng, n), rng.integers(0, 50, n)]


KINDS = [with_elevations(kind) for kind in (small_integers, utm_floats, tenths)]
ARRAYS = ("points", "triangles", "neighbors", "constrained")


def require_fresh(tin):
    """A build of the points and lines that the TIN has now gives the same arrays."""
    chains = [tin.points[chain] for chain in tin.lines.chains()]
    fresh = ts.triangulate(tin.points, breaklines=chains)
    for name in ARRAYS:
        np.testing.assert_array_equal(getattr(tin, name), getattr(fresh, name), err_msg=name)


def arguments_for(operation, rng, kind, tin):
    n = len(tin.points)
    if operation == "insert":
        return {"points": kind(rng, rng.integers(1, 4))}
    if operation == "remove":
        return {"vertices": rng.choice(n, rng.integers(1, 3), replace=False)}
    if operation == "move":
        return {"vertex": int(rng.integers(n)), "point": kind(rng, 1)[0]}
    if operation == "set_elevation":
        return {"vertices": int(rng.integers(n)), "z": float(rng.integers(9))}
    if operation == "flip":
        a, b = tin.edges[rng.integers(len(tin.edges))]
        return {"a": int(a), "b": int(b)}
    if operation == "add_breakline":
        return {"coords": kind(rng, rng.integers(2, 5))}
    sources = tin.lines.sources
    return {"number": int(rng.choice(sources)) if len(sources) else 0}


def start(rng, kind):
    while True:
        try:
            return ts.triangulate(kind(rng, rng.integers(5, 25)))
        except ts.PointsError:
            continue


def state(tin):
    return {name: getattr(tin, name).copy() for name in ARRAYS} | {
        "lines": tin.lines.vertices.copy()
    }


def require_state(tin, wanted):
    for name, array in state(tin).items():
        np.testing.assert_array_equal(array, wanted[name], err_msg=name)


@pytest.mark.each_value
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", range(8))
def test_any_edits_leave_what_a_fresh_build_gives(kind, seed):
    rng = np.random.default_rng([seed, KINDS.index(kind)])
    tin = start(rng, kind)
    for _ in range(20):
        operation = str(rng.choice(list(OPERATIONS)))
        arguments = arguments_for(operation, rng, kind, tin)
        before = state(tin)
        try:
            getattr(tin, operation)(**arguments)
        except (ts.PointsError, ts.LinesError):
            require_state(tin, before)
            continue
        require_fresh(tin)
    assert ts.check(tin).ok


@pytest.mark.parametrize("kind", KINDS)
def test_edits_are_listed_taken_back_and_done_again(kind):
    rng = np.random.default_rng(KINDS.index(kind))
    tin = start(rng, kind)
    begin, states = state(tin), []
    for _ in range(12):
        operation = str(rng.choice(list(OPERATIONS)))
        states.append(state(tin))
        try:
            getattr(tin, operation)(**arguments_for(operation, rng, kind, tin))
        except (ts.PointsError, ts.LinesError):
            states.pop()
    script = json.loads(json.dumps([edit.to_dict() for edit in tin.edits]))
    assert [edit.operation for edit in tin.edits] == [entry["op"] for entry in script]
    assert [entry["op"] for entry in tin.report.to_dict()["edits"]] == [e["op"] for e in script]
    end = state(tin)
    while len(tin.edits) > 2:
        tin.undo(2)
        require_state(tin, states[len(tin.edits)])
    tin.undo(len(tin.edits))
    require_state(tin, begin)
    apply_edits(tin, script)
    require_state(tin, end)


def square(**options):
    return ts.triangulate([[0, 0, 5], [4, 0, 6], [4, 4, 7], [0, 4, 8], [2, 1, 9]], **options)


@pytest.mark.parametrize("count", [10_000, 10_001])
@pytest.mark.parametrize("size", [5, 60])
def test_many_points_at_once_give_what_a_fresh_build_gives(count, size):
    """Beyond 10,000 all are triangulated anew; some of them stand where others do."""
    rng = np.random.default_rng(count)
    before = np.c_[rng.integers(0, 20 * size, (size, 2)) + 0.5, rng.integers(0, 50, size)]
    corners = np.array([[0.0, 0, 1], [3000, 0, 2], [0, 3000, 3]])
    tin = ts.triangulate(np.concatenate([corners, before]), duplicates="last")
    new = np.c_[rng.integers(0, 150, (count, 2)), rng.integers(0, 50, count)].astype(float)
    new[:3] = np.add(before[:3], [0, 0, 100])
    tin.insert(new)
    require_fresh(tin)
    wanted = {(x, y): z for x, y, z in np.concatenate([corners, before, new]).tolist()}
    assert {(x, y): z for x, y, z in tin.points.tolist()} == wanted
    tin.insert([[7.25, 8.25, 9.0]])
    tin.remove([3])
    require_fresh(tin)
    for _ in range(3):
        tin.undo()
    assert len(tin.points) == len(np.unique(np.concatenate([corners, before])[:, :2], axis=0))


def test_vertices_behind_a_removed_one_move_up():
    tin = square()
    points = tin.points
    tin.remove([1, 4])
    np.testing.assert_array_equal(tin.points, points[[0, 2, 3]])
    assert tin.vertex_of.tolist() == [0, -1, 1, 2, -1]
    assert tin.report.to_dict()["left_out"] == {"removed by an edit": [1, 4]}
    tin.set_elevation(1, 70.0)
    assert tin.points[1].tolist() == [4, 4, 70]
    assert tin.insert([[4, 0, 1], [0, 0, 2]]).tolist() == [3, 0]
    assert tin.points[[0, 3], 2].tolist() == [2, 1]
    assert tin.vertex_of.tolist() == [0, -1, 1, 2, -1, 3, 0]


def test_arrays_handed_out_before_stay_as_they_were():
    tin = square()
    points, area = tin.points, tin.area
    tin.insert([[9, 9, 9]])
    assert len(points) == 5
    assert tin.area > area
    assert tin.bounds.xmax == 9
    assert not np.isnan(tin.interpolate([[6, 6]])).any()


@pytest.mark.parametrize(
    ("policy", "height"), [("last", 1), ("first", 9), ("lowest", 1), ("highest", 9), ("mean", 5)]
)
def test_height_of_a_vertex_that_is_there_already(policy, height):
    tin = square()
    assert tin.insert([[2, 1, 1]], duplicates=policy).tolist() == [4]
    assert tin.points[4, 2] == height


@pytest.mark.parametrize(
    ("policy", "height"), [("last", 1), ("first", 9), ("lowest", 1), ("highest", 9), ("mean", 5)]
)
def test_height_of_a_vertex_that_two_new_rows_make(policy, height):
    tin = square()
    assert tin.insert([[3, 1.5, 9], [3, 1.5, 1]], duplicates=policy).tolist() == [5, 5]
    assert tin.points[5].tolist() == [3, 1.5, height]


def test_flipping_twice_is_nothing():
    tin = ts.triangulate([[0, 0, 1], [4, 0, 2], [5, 4, 3], [0, 3, 4]])
    before = state(tin)
    (a, b) = next(edge for edge in tin.edges.tolist() if set(edge) in ({0, 2}, {1, 3}))
    tin.flip(a, b)
    assert tin.lines.names == ("flip",)
    assert set(tin.lines.vertices.tolist()) == {0, 1, 2, 3} - {a, b}
    tin.flip(*tin.lines.vertices.tolist())
    require_state(tin, before)


def test_crossing_breakline_takes_the_height_of_higher_priority_and_tells_both():
    for priority, taken in ((0, 10.0), (1, 20.0)):
        tin = ts.triangulate(
            [[0, 0, 5], [4, 0, 6], [4, 4, 7], [0, 4, 8]], breaklines=[[[0, 1, 10], [4, 1, 10]]]
        )
        tin.add_breakline([[1, 0.5, 20], [1, 3, 20]], priority=priority)
        assert tin.points[-1].tolist() == [1, 1, taken]
        (note,) = tin.edits[-1].notes
        assert "20" in note
        assert "10" in note
        require_fresh(tin)


def test_line_that_crosses_itself_gets_a_vertex_there():
    tin = square()
    tin.add_breakline([[0.5, 0.5, 1], [3.5, 3.5, 1], [3.5, 0.6, 2], [0.5, 3.4, 2]])
    require_fresh(tin)
    assert ts.check(tin).ok
    assert len(tin.edits[-1].notes) == 1


def test_draped_breakline_follows_the_surface():
    tin = square()
    wanted = tin.interpolate([[1, 2], [3, 2]])
    tin.add_breakline([[1, 2], [3, 2]])
    np.testing.assert_allclose(tin.interpolate([[1, 2], [3, 2]]), wanted, rtol=0, atol=1e-12)
    require_fresh(tin)


EARLIER_LINES = {
    "through the end of one, across another": (
        [[3, 0, 0], [4, 6, 0], [5, 4, 0]],
        [[[3, 4, 0], [0, 7, 0]], [[7, 7, 0], [3, 5, 0]]],
        [[[2, 1, 0], [4, 7, 0]]],
    ),
    "through the end of one at fractions": (
        [[1, 3, 0], [1, 4, 0], [4, 1, 0]],
        [[[3, 0, 0], [2, 4, 0]], [[0.75, 1.75, 0], [0, 1, 0]]],
        [[[3, 1, 0], [0, 2, 0]]],
    ),
    "centimetres at the size of UTM": (
        [
            [752063.7, 4024026.98, 0.0],
            [752004.1, 4024001.65, 0.0],
            [752081.33, 4024091.28, 0.0],
        ],
        [],
        [
            [[752040.46, 4024019.85, 0.0], [752009.08, 4024058.03, 0.0]],
            [[751995.64, 4024054.0399999996, 0.0], [752022.5199999999, 4024062.02, 0.0]],
            [[752094.21, 4024036.51, 0.0], [752010.55, 4024062.91, 0.0]],
            [[751990.5399999999, 4024049.2199999997, 0.0], [752027.62, 4024066.84, 0.0]],
        ],
    ),
    "out and back across a line": (
        [[500007, 4000009, -5], [500007, 4000003, 2], [500005, 4000003, -4]],
        [[[500007, 4000009, -5], [500007, 4000003, 2], [500005, 4000003, -4]]],
        [[[500010, 4000003, -2], [500005, 4000010, 2], [500010, 4000003, -3]]],
    ),
    "across a draped line": (
        [[6, 12, 0]],
        [[[2, 12, 3], [2, 4, -4]], [[4, 8], [4, 10], [3, 6], [5, 12]]],
        [[[6, 6, 4], [2, 12, -1]]],
    ),
    "draped, partly outside": (
        [[-12, -12, 1]],
        [[[-8, -16, -2], [-8, -4, -2]]],
        [[[8, 8], [-12, -12], [2, 14]]],
    ),
    "draped, at a rounding from others": (
        [[0.49999999999999933, -0.866025403784439, 1.0]],
        [
            [
                [-0.524519052838329, -0.43301270189221963, -3.0],
                [0.49999999999999944, -0.43301270189221963, 4.0],
            ]
        ],
        [
            [
                [-0.4999999999999998, 0.8660254037844387],
                [0.49999999999999933, -0.866025403784439],
                [-0.6185484040607179, 0.3083790555865533],
            ]
        ],
    ),
}


def require_same_tin(tin, fresh):
    require_state(tin, state(fresh))
    assert tin.lines.sources.tolist() == fresh.lines.sources.tolist()
    assert tin.lines.offsets.tolist() == fresh.lines.offsets.tolist()
    assert tin.report.to_dict()["crossings"] == fresh.report.to_dict()["crossings"]
    assert tin.report.to_dict()["overruled"] == fresh.report.to_dict()["overruled"]


@pytest.mark.parametrize(
    ("points", "lines", "added"), EARLIER_LINES.values(), ids=list(EARLIER_LINES)
)
def test_lines_come_one_by_one_as_they_come_together(points, lines, added):
    tin = ts.triangulate(points, breaklines=lines)
    for count, line in enumerate(added, 1):
        tin.add_breakline(line)
        require_same_tin(tin, ts.triangulate(points, breaklines=lines + added[:count]))
        assert ts.check(tin).ok
    for number in range(len(lines) + len(added) - 1, len(lines) - 1, -1):
        tin.remove_breakline(number)
    require_same_tin(tin, ts.triangulate(points, breaklines=lines))
    tin.undo(len(tin.edits) - 1)
    require_same_tin(tin, ts.triangulate(points, breaklines=lines + added[:1]))


CROSS = [[[0, 2, 10], [4, 2, 10]], [[2, 0, 20], [2, 4, 20]]]
CORNERS = [[0, 0, 5], [4, 0, 6], [4, 4, 7], [0, 4, 8]]


def crossed(**options):
    return ts.triangulate(CORNERS, breaklines=CROSS, **options)


def test_a_crossing_goes_with_its_lines():
    tin = crossed()
    made = len(tin.points) - 1
    assert tin.points[made].tolist() == [2, 2, 10]
    for edit in (lambda: tin.remove(made), lambda: tin.move(made, [1, 1, 1])):
        with pytest.raises(ts.LinesError, match="goes with them"):
            edit()
    tin.set_elevation(made, 15.0)
    require_same_tin(tin, ts.triangulate([*CORNERS, [2, 2, 15]], breaklines=CROSS))
    assert tin.vertex_of.tolist() == [0, 1, 2, 3, 4]
    tin.undo()
    tin.remove_breakline(0)
    require_same_tin(tin, ts.triangulate(CORNERS, breaklines=CROSS[1:]))
    assert len(tin.points) == 6


def test_a_moved_vertex_takes_its_line_along():
    tin = crossed()
    (vertex,) = np.flatnonzero((tin.points[:, :2] == [4, 2]).all(axis=1)).tolist()
    tin.move(vertex, [4, 3, 12])
    moved = [[CROSS[0][0], [4, 3, 12]], CROSS[1]]
    require_same_tin(tin, ts.triangulate(CORNERS, breaklines=moved))
    tin.set_elevation(vertex, 1.0)
    moved[0][1] = [4, 3, 1]
    require_same_tin(tin, ts.triangulate(CORNERS, breaklines=moved))


def test_a_line_without_a_vertex_runs_straight_on():
    line = [[0, 1, 1], [2, 3, 2], [4, 1, 3]]
    tin = ts.triangulate(CORNERS, breaklines=[line])
    tin.remove(int(tin.lines.vertices[1]))
    require_same_tin(tin, ts.triangulate(CORNERS, breaklines=[[line[0], line[2]]]))
    with pytest.raises(ts.LinesError, match="would vanish"):
        tin.remove(int(tin.lines.vertices[0]))


def test_a_failed_edit_of_lines_changes_nothing():
    tin = crossed()
    before = state(tin)
    for arguments in ({"crossing": "error"}, {"crossing": "split", "kind": "loft"}):
        with pytest.raises((ts.LinesError, ts.OptionError)):
            tin.add_breakline([[0, 1, 0], [3, 4, 0]], **arguments)
        require_state(tin, before)
    tin.insert([[1, 1.5, 1]])
    tin.undo()
    require_state(tin, before)


def test_edits_away_from_lines_build_nothing_anew(monkeypatch):
    rng = np.random.default_rng(3)
    points = np.c_[rng.random((400, 2)) * 100, rng.random(400)]
    line = [[10, 10, 1], [40, 12, 2], [40, 12.5, 2]]
    across = [[30, 2, 5], [30, 30, 6]]
    tin = ts.triangulate(points, breaklines=[line, across])
    far = np.flatnonzero(points[:, 1] > 60)
    tin.set_elevation(int(far[0]), 0.5)
    with monkeypatch.context() as patched:
        patched.setattr("tinsmith.tin.editing.changes.assemble", None)
        assert tin.insert([[70.5, 80.5, 3], points[far[1]]]).tolist() == [400, far[1]]
        tin.move(int(far[2]), [75.25, 85.5, 4])
        tin.remove([int(far[3]), int(far[4])])
        tin.set_elevation(398, -1.0)
    rows = np.vstack([points, [[70.5, 80.5, 3], points[far[1]]]])
    rows[far[0], 2] = 0.5
    rows[far[2]] = [75.25, 85.5, 4]
    rows[400, 2] = -1.0
    fresh = ts.triangulate(np.delete(rows, far[3:5], axis=0), breaklines=[line, across])
    require_same_tin(tin, fresh)
    assert np.delete(tin.vertex_of, far[3:5]).tolist() == fresh.vertex_of.tolist()
    assert [merge.rows for merge in tin.report.merges()] == [(far[1], 401)]


@pytest.mark.parametrize("lines", [[], [[[10, 10, 1], [40, 12, 2]], [[40, 12, 2], [60, 40, 3]]]])
def test_flips_build_nothing_anew_where_no_lines_meet(lines, monkeypatch):
    rng = np.random.default_rng(11)
    points = np.c_[rng.random((300, 2)) * 100, rng.random(300)]
    tin = ts.triangulate(points, breaklines=lines)
    flips = []
    with monkeypatch.context() as patched:
        patched.setattr("tinsmith.tin.editing.changes.assemble", None)
        for a, b in tin.edges[5::40].tolist():
            left, right = corners_beside(tin, a, b)
            try:
                tin.flip(a, b)
            except ts.PointsError:
                continue
            flips.append(ts.Breakline(tin.points[[left, right]], kind="soft", name="flip"))
    assert len(flips) > 10
    fresh = ts.triangulate(points, breaklines=[*map(ts.Breakline, lines), *flips])
    require_same_tin(tin, fresh)
    assert (tin.report.n_lines, tin.report.line_labels) == (
        fresh.report.n_lines,
        fresh.report.line_labels,
    )


def corners_beside(tin, a, b):
    """Return the corners left and right of an edge; -1 for one that is not there."""
    corners = {
        (t[k], t[k - 2]): t[k - 1] for t in tin.triangles.tolist() for k in range(3)
    }  # by edges that have the triangle to their left
    return corners.get((a, b), -1), corners.get((b, a), -1)


def test_a_flip_where_lines_cross_is_that_of_a_fresh_build():
    rng = np.random.default_rng(12)
    points = np.c_[rng.random((60, 2)) * 100, rng.random(60)]
    lines = [ts.Breakline([[10, 10, 1], [90, 92, 2]]), ts.Breakline([[10, 90, 5], [90, 12, 6]])]
    count = 0
    for a, b in ts.triangulate(points, breaklines=lines).edges.tolist():
        tin = ts.triangulate(points, breaklines=lines)
        left, right = corners_beside(tin, a, b)
        try:
            tin.flip(a, b)
        except (ts.PointsError, ts.LinesError):
            continue
        flip = ts.Breakline(tin.points[[left, right]], kind="soft", name="flip")
        require_same_tin(tin, ts.triangulate(points, breaklines=[*lines, flip]))
        count += 1
    assert count > 50


def test_reasons_of_the_build_are_kept_beside_those_of_edits():
    rng = np.random.default_rng(5)
    points = np.c_[rng.random((60, 2)) * 10, rng.random(60)]
    points[37, :2] = 5, 5
    ring = [[4.9, 4.9], [5.1, 4.9], [5.1, 5.1], [4.9, 5.1]]
    tin = ts.triangulate(points, erase=[ring])
    assert tin.report.to_dict()["left_out"] == {"erased": [37]}
    tin.remove(5)
    assert tin.report.to_dict()["left_out"] == {"erased": [37], "removed by an edit": [5]}
    assert tin.insert([[5, 5, 1]]).tolist() == [-1]
    assert tin.report.to_dict()["left_out"]["erased"] == [37, 60]


def test_overlapping_triangles_are_not_edited():
    tin = ts.TIN.from_triangles(
        [[0, 0, 1], [4, 0, 1], [4, 4, 1], [0, 4, 1], [3, 1, 2]], [[0, 1, 2], [2, 3, 4]]
    )
    with pytest.raises(ts.PointsError, match="overlap"):
        tin.insert([[1, 0.5, 1]])


def test_the_log_keeps_what_was_given():
    tin = square()
    points, vertices = np.array([[3.0, 3.0, 1.0]]), [0]
    tin.insert(points)
    tin.set_elevation(vertices, 3.0)
    points[0, 0], vertices[0] = 99.0, 1
    assert tin.edits[0].to_dict() == {
        "op": "insert",
        "points": [[3.0, 3.0, 1.0]],
        "duplicates": "last",
    }
    assert tin.edits[1].arguments["vertices"] == [0]


def test_water_keeps_its_level():
    pond = ts.Water([[1, 1], [3, 1], [3, 3], [1, 3]], 2.0)
    tin = ts.triangulate(CORNERS, water=[pond])
    (vertex,) = np.flatnonzero((tin.points[:, :2] == [1, 1]).all(axis=1)).tolist()
    with pytest.raises(ts.LinesError, match="stays at elevation 2"):
        tin.set_elevation(vertex, 5.0)
    assert tin.edits == ()


def test_clipped_surface_is_edited_and_stays_clipped():
    rng = np.random.default_rng(0)
    points = np.c_[rng.random((60, 2)) * 10, rng.random(60)]
    ring = [[1, 1], [9, 1], [9, 9], [5, 4], [1, 9]]
    tin = ts.triangulate(points, boundary=[ring])
    inside, outside = tin.insert([[2, 2.5, 7], [5, 9, 7]])
    assert outside == -1
    assert tin.points[inside].tolist() == [2, 2.5, 7]
    assert tin.area == pytest.approx(44.0)
    assert ts.check(tin).ok
    tin.undo()
    again = ts.triangulate(points, boundary=[ring])
    np.testing.assert_array_equal(tin.triangles, again.triangles)


def test_tin_of_existing_triangles_is_edited():
    made = square(breaklines=[[[0, 0, 5], [4, 4, 7]]])
    tin = ts.TIN.from_triangles(made.points, made.triangles, constrained=made.constrained)
    tin.insert([[3, 1, 1]])
    require_fresh(tin)
    hollow = ts.TIN.from_triangles(square().points, square().triangles[1:])
    hollow.insert([[1, 3, 1]])
    assert len(hollow.triangles) == len(square().triangles) + 1


def test_tin_that_is_not_delaunay_is_not_edited():
    """(0, 1) is seen under more than a right angle, so it must not lie beyond the diagonal."""
    tin = ts.TIN.from_triangles(
        [[0, 0, 1], [9, 0, 1], [9, 2, 1], [0, 1, 1]], [[0, 1, 2], [0, 2, 3]]
    )
    assert not ts.check(tin).ok
    with pytest.raises(ts.PointsError, match="Delaunay"):
        tin.set_elevation(0, 3.0)


@pytest.mark.parametrize(
    ("operation", "arguments", "sentence"),
    [
        ("insert", {"points": [[1, 2]]}, "shape"),
        ("insert", {"points": [[1, 2, np.nan]]}, "finite"),
        ("insert", {"points": [[1, 2, 3]], "duplicates": "newest"}, "Invalid duplicates"),
        ("insert", {"points": [[2, 1, 3]], "duplicates": "error"}, "allows none"),
        ("remove", {"vertices": 5}, "no vertex 5"),
        ("remove", {"vertices": -1}, "no vertex -1"),
        ("remove", {"vertices": 1.5}, "whole numbers"),
        ("remove", {"vertices": [[1], [2, 3]]}, r"Invalid vertices .*: whole numbers are needed"),
        ("remove", {"vertices": np.ma.masked_less([0, 3], 1)}, "whole numbers are needed"),
        ("remove", {"vertices": [3, 7, 9]}, "no vertex 7: numbers 0 to 4 are allowed"),
        ("remove", {"vertices": [1, 1]}, "twice"),
        ("remove", {"vertices": [0, 1, 2]}, "No triangle"),
        ("move", {"vertex": 0, "point": [2, 1, 0]}, "already"),
        ("move", {"vertex": 0, "point": [2, np.inf, 0]}, "finite"),
        ("move", {"vertex": 0, "point": [[1], [2, 3]]}, "no table of real numbers"),
        ("set_elevation", {"vertices": 0, "z": 10**400}, "real numbers"),
        ("set_elevation", {"vertices": [0, 1], "z": [1, 2, 3]}, "elevations"),
        ("set_elevation", {"vertices": 0, "z": np.nan}, "finite"),
        ("flip", {"a": 0, "b": 0}, "two different ends"),
        ("flip", {"a": 0, "b": 1}, "between two triangles"),
        ("add_breakline", {"coords": [[1, 1, 1]]}, "shape"),
        ("add_breakline", {"coords": [[1, 1, 1], [2, 2, np.nan]]}, "not finite"),
        ("add_breakline", {"coords": [[9, 9], [8, 9]]}, "outside"),
        ("add_breakline", {"coords": [[1, 1, 1], [1, 1, 2]]}, "one place"),
        ("remove_breakline", {"number": 0}, "no breakline 0"),
        ("undo", {"count": 1}, "0 were made"),
        ("undo", {"count": 0}, "whole number"),
    ],
)
def test_bad_edits_are_refused_in_a_sentence_and_change_nothing(operation, arguments, sentence):
    tin = square()
    before = state(tin)
    with pytest.raises((ts.PointsError, ts.LinesError, ts.OptionError), match=sentence):
        getattr(tin, operation)(**arguments)
    require_state(tin, before)
    assert tin.edits == ()


@pytest.mark.parametrize("options", [{}, {"snap": 0.5}])
def test_the_last_line_cannot_go_when_no_points_are_left(options):
    tin = ts.triangulate([[0, 0, 0]], breaklines=[[[5, 5, 1], [9, 5, 1], [9, 9, 1]]], **options)
    tin.remove(0)
    before = state(tin)
    with pytest.raises(ts.PointsError, match="0 points cannot make a TIN"):
        tin.remove_breakline(0)
    require_state(tin, before)


@pytest.mark.parametrize(
    ("script", "sentence"),
    [
        ([{"op": "explode"}], "Edit 0 has op 'explode'"),
        ([{"op": "remove", "vertex": 3}], r"Edit 0 \(remove\) has the wrong arguments"),
        (
            [{"op": "set_elevation", "vertices": 0, "z": 1}, {"op": "remove", "vertices": 77}],
            "Edit 1",
        ),
    ],
)
def test_bad_scripts_name_the_edit(script, sentence):
    with pytest.raises(ts.PointsError, match=sentence):
        apply_edits(square(), script)


def test_edits_of_earlier_versions_are_done_by_their_names_of_now():
    tin = square()
    apply_edits(tin, [{"op": "set_elevation", "vertices": 0, "z": 7.5}])
    assert tin.points[0, 2] == 7.5
    assert tin.edits[0].to_dict() == {"op": "set_elevation", "vertices": 0, "z": 7.5}
    with pytest.raises(ts.PointsError, match=r"Edit 0 has op \['set_z'\]: one of insert, "):
        apply_edits(tin, [{"op": ["set_z"]}])


def test_an_edit_is_written_in_plain_values():
    tin = ts.triangulate([[0, 0, 5], [4, 0, 6], [4, 3, 7], [0, 3, 8]])
    tin.set_elevation([1, 2], np.array([3.0, 4.0]))
    (edit,) = tin.edits
    assert edit.to_dict() == {"op": "set_elevation", "vertices": [1, 2], "z": [3, 4]}
    assert tin.points[[1, 2], 2].tolist() == [3, 4]


def test_every_operation_is_a_method_of_a_tin():
    assert all(callable(getattr(ts.TIN, name)) for name in OPERATIONS)


def test_a_vertex_is_not_moved_while_all_others_are_in_line():
    tin = ts.triangulate([[0, 0, 0], [1, 0, 0], [2, 0, 0], [1, 1, 0]])
    before = state(tin)
    with pytest.raises(ts.PointsError, match="while all others are in line: insert a point first"):
        tin.move(3, [1, 2, 0])
    require_state(tin, before)
    tin.insert([[0, 5, 5]])
    tin.move(3, [1, 2, 0])
    require_fresh(tin)


@pytest.mark.parametrize("gone", [0, 1, 2, 3])
def test_a_ring_without_one_of_its_vertices_stays_closed(gone):
    """Also without the vertex at which it closes, whose elevation is the ring's twice."""
    ring = [[2, 2, 1], [6, 2, 2], [6, 6, 3], [2, 6, 4]]
    ground = [[0, 0, 0], [9, 0, 0], [9, 9, 0], [0, 9, 0]]
    tin = ts.triangulate(ground, breaklines=[[*ring, ring[0]]])
    tin.remove(4 + gone)
    (chain,) = [*tin.lines.chains()]
    left = np.array(ring[gone + 1 :] + ring[:gone], float)
    found = tin.points[chain]
    np.testing.assert_array_equal(found[0], found[-1])
    assert sorted(found[:-1].tolist()) == sorted(left.tolist())
    fresh = ts.triangulate(ground, breaklines=[[*left, left[0]]])
    assert tin.area == fresh.area
    assert set(map(tuple, tin.points.tolist())) == set(map(tuple, fresh.points.tolist()))


@pytest.mark.parametrize(("count", "steps"), [(3, 3), (10_001, 1)])
def test_edits_after_one_that_failed_are_as_if_it_had_not_been(count, steps):
    rng = np.random.default_rng(3)
    points = np.c_[rng.integers(0, 40, (60, 2)) * 1.0, rng.integers(0, 9, 60)]
    points = points[np.unique(points[:, :2], axis=0, return_index=True)[1]]
    tin, same = (ts.triangulate(points) for _ in range(2))
    new = np.c_[rng.random((count, 2)) * 40, np.zeros(count)]
    new[count // 2] = points[5] + [0, 0, 1]

    def edit(step):
        for one in (tin, same):
            one.insert([[0.5 + step, 0.25, 9.0], [1.5, 7.25 + step, 8.0]])
            one.remove([7, len(one.points) - 2])
            one.move(3, [0.125 + step, 3.0625, 2.0])

    for step in range(steps):
        edit(step)
        with pytest.raises(ts.PointsError, match="allows none"):
            tin.insert(new, duplicates="error")
    edit(steps)
    require_state(tin, state(same))
    require_fresh(tin)


def test_lines_come_and_go_in_existing_triangles_of_a_part_of_the_hull():
    """Beyond their boundary there is no surface, before and after an edit of lines."""
    rng = np.random.default_rng(8)
    points = np.c_[rng.random((60, 2)) * 8, rng.random(60)]
    bay = [[0.5, 0.5], [7.5, 0.5], [7.5, 7.5], [4, 2], [0.5, 7.5]]
    made = ts.triangulate(points, boundary=[bay])
    tin = ts.TIN.from_triangles(made.points, made.triangles, constrained=made.constrained)
    boundary = {frozenset(made.points[ring, 0].tolist()) for ring in made.rings}
    n_given = int(tin.lines.sources.max(initial=-1)) + 1
    tin.add_breakline([[1, 1.2, 5], [6.5, 1.1, 6]], name="kerb")
    ts.check(tin).raise_if_failed()
    assert tin.area == pytest.approx(made.area, rel=1e-12)
    assert {frozenset(tin.points[ring, 0].tolist()) for ring in tin.rings} == boundary
    assert "kerb" in tin.lines.names
    number = int(tin.lines.sources[tin.lines.names.index("kerb")])
    assert number >= n_given
    tin.remove_breakline(number)
    assert "kerb" not in tin.lines.names
    assert np.array_equal(tin.points, made.points)
    assert set(map(frozenset, tin.triangles.tolist())) == set(
        map(frozenset, made.triangles.tolist())
    )


def test_rings_keep_their_numbers_when_a_breakline_comes():
    inner = [[[1, 1, 0], [2, 1, 0], [2, 2, 0]], [[5, 5, 0], [6, 5, 0], [6, 6, 0]]]
    corners = [[0, 0, 0], [9, 0, 0], [9, 9, 0], [0, 9, 0]]
    line, other = [[3, 3, 1], [4, 3.5, 1]], [[7, 1, 1], [8, 2, 1]]
    tin = ts.triangulate(corners, breaklines=[line], holes=inner)
    tin.add_breakline(other)
    fresh = ts.triangulate(corners, breaklines=[line, other], holes=inner)
    require_same_tin(tin, fresh)
    assert tin.lines.sources.tolist() == fresh.lines.sources.tolist() == [0, 1, 0, 1]


def test_a_corner_of_the_boundary_that_moves_takes_the_boundary_along():
    points = [[2, 3, 1], [7, 5, 2], [4, 8, 3], [10.5, 10.4, 9], [13, 1, 4], [1, 13, 4]]
    ring = [[0, 0, 0], [10, 0, 0], [10, 10, 0], [0, 10, 0]]
    tin = ts.triangulate(points, boundary=[ring])
    assert tin.vertex_of[3] == -1
    corner = int(np.flatnonzero((tin.points[:, :2] == [10, 10]).all(axis=1))[0])
    tin.move(corner, [12, 12, 0])
    ring[2] = [12, 12, 0]
    fresh = ts.triangulate(points, boundary=[ring])
    require_same_tin(tin, fresh)
    assert tin.vertex_of.tolist() == fresh.vertex_of.tolist()
    assert tin.vertex_of[3] >= 0
    assert tin.report.left_out_rows.tolist() == fresh.report.left_out_rows.tolist()
    assert tin.report.left_out_why.tolist() == fresh.report.left_out_why.tolist()


@pytest.mark.parametrize("lines", [[], [[[0, 0], [4, 3]]]])
@pytest.mark.parametrize(
    "edit",
    [
        lambda tin: tin.remove([]),
        lambda tin: tin.remove(np.array([])),
        lambda tin: tin.insert([]),
        lambda tin: tin.insert(np.empty((0, 3))),
        lambda tin: tin.set_elevation([], []),
        lambda tin: tin.set_elevation((), 5),
    ],
)
def test_an_edit_of_nothing_changes_nothing(edit, lines):
    tin = ts.triangulate([[0, 0, 1], [4, 0, 2], [4, 3, 3], [0, 3, 4], [2, 1, 9]], breaklines=lines)
    before = copy.copy(tin)
    made = edit(tin)
    assert made is None or made.tolist() == []
    assert np.array_equal(tin.points, before.points)
    assert np.array_equal(tin.triangles, before.triangles)
    tin.undo()
    assert len(tin.edits) == 0
