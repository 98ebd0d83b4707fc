"""Edits of a TIN in place: after any of them it is the TIN of a fresh build."""

from __future__ import annotations

import json

import numpy as np
import pytest

import tinsmith as ts
from tinsmith.tin.editing import OPERATIONS, apply_edits


def small_integers(rng, n):
    return np.c_[rng.integers(0, 8, (n, 2)), rng.integers(0, 50, n)].astype(float)


def utm_floats(rng, n):
    return np.c_[rng.random((n, 2)) * 100 + [5e5, 4e6], rng.integers(0, 50, n)]


def tenths(rng, n):
    return np.c_[np.round(rng.random((n, 2)) * 3, 1), rng.integers(0, 50, n)]


KINDS = [small_integers, utm_floats, tenths]
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
    if operation == "set_z":
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


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", range(8))
def test_any_edits_leave_what_a_fresh_build_gives(kind, seed):
    rng = np.random.default_rng([seed, KINDS.index(kind)])
    tin = start(rng, kind)
    for _ in range(20):
        operation = str(rng.choice(OPERATIONS))
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
        operation = str(rng.choice(OPERATIONS))
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


def test_vertices_behind_a_removed_one_move_up():
    tin = square()
    points = tin.points
    tin.remove([1, 4])
    np.testing.assert_array_equal(tin.points, points[[0, 2, 3]])
    assert tin.vertex_of.tolist() == [0, -1, 1, 2, -1]
    assert tin.report.to_dict()["left_out"] == {"removed by an edit": [1, 4]}
    tin.set_z(1, 70.0)
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
        assert tin.points[tin.vertex_of[3] + 5].tolist() == [1, 1, taken] or [1, 1, taken] in (
            tin.points.tolist()
        )
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
        tin.set_z(0, 3.0)


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
        ("remove", {"vertices": [1, 1]}, "twice"),
        ("remove", {"vertices": [0, 1, 2]}, "No triangle"),
        ("move", {"vertex": 0, "point": [2, 1, 0]}, "already"),
        ("move", {"vertex": 0, "point": [2, np.inf, 0]}, "finite"),
        ("set_z", {"vertices": [0, 1], "z": [1, 2, 3]}, "heights"),
        ("set_z", {"vertices": 0, "z": np.nan}, "finite"),
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
    with pytest.raises((ts.PointsError, ts.LinesError), match=sentence):
        getattr(tin, operation)(**arguments)
    require_state(tin, before)
    assert tin.edits == ()


@pytest.mark.parametrize(
    ("script", "sentence"),
    [
        ([{"op": "explode"}], "Edit 0 has op 'explode'"),
        ([{"op": "remove", "vertex": 3}], r"Edit 0 \(remove\) has the wrong arguments"),
        ([{"op": "set_z", "vertices": 0, "z": 1}, {"op": "remove", "vertices": 77}], "Edit 1"),
    ],
)
def test_bad_scripts_name_the_edit(script, sentence):
    with pytest.raises(ts.PointsError, match=sentence):
        apply_edits(square(), script)
