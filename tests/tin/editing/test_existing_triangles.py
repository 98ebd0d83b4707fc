"""Edits of triangles that were there already: lines keep their say, names and kinds."""

from __future__ import annotations

import numpy as np
import pytest

import tinsmith as ts
from tinsmith.tin.editing import mesh_editor
from tinsmith.tin.predicates import LARGEST_ELEVATION

CORNERS = [[0, 0, 0], [8, 0, 0], [8, 8, 0], [0, 8, 0], [1, 4, 10], [7, 4, 10]]
ARRAYS = ("points", "triangles", "neighbors", "constrained")


def with_a_flagged_edge():
    """A square whose only line, from (1, 4) to (7, 4), is a flag of an edge."""
    made = ts.triangulate(CORNERS, breaklines=[CORNERS[4:]])
    return ts.TIN.from_triangles(made.points, made.triangles, constrained=made.constrained)


@pytest.mark.parametrize(("priority", "elevation"), [(-1, 10.0), (0, 10.0), (1, 20.0), (2, 20.0)])
def test_a_flagged_edge_has_the_priority_of_a_line_that_says_nothing(priority, elevation):
    tin = with_a_flagged_edge()
    across = [[4, 1, 20], [4, 7, 20]]
    tin.add_breakline(across, priority=priority)
    fresh = ts.triangulate(
        CORNERS,
        breaklines=[
            ts.Breakline(CORNERS[4:], kind="soft"),
            ts.Breakline(across, priority=priority),
        ],
    )
    for name in ARRAYS:
        np.testing.assert_array_equal(getattr(tin, name), getattr(fresh, name), err_msg=name)
    (crossing,) = np.flatnonzero((tin.points[:, :2] == [4, 4]).all(axis=1))
    assert tin.points[crossing, 2] == elevation
    assert tin.lines.kinds == fresh.lines.kinds == ("soft", "hard")
    assert tin.lines.sources.tolist() == fresh.lines.sources.tolist() == [0, 1]


@pytest.mark.parametrize(
    "operation", ["insert", "remove", "move", "set_elevation", "add_breakline"]
)
def test_a_part_of_a_hull_stays_one_after_any_edit(operation):
    """The notch of an L is no surface, and a further line is known by its number and name."""
    axis = np.arange(7.0)
    x, y = (part.ravel() for part in np.meshgrid(axis, axis))
    z = np.sin(x) + np.cos(2 * y)
    ell = [[0, 0], [6, 0], [6, 2], [2, 2], [2, 6], [0, 6]]
    made = ts.triangulate(np.column_stack([x, y, z]), boundary=[ell])
    tin = ts.TIN.from_triangles(made.points, made.triangles)
    assert tin.area == made.area == 20.0
    at = int(np.flatnonzero((tin.points[:, :2] == [1, 1]).all(axis=1))[0])
    arguments = {
        "insert": {"points": [[0.5, 0.25, 3.0]]},
        "remove": {"vertices": [at]},
        "move": {"vertex": at, "point": [1.25, 1.125, 5.0]},
        "set_elevation": {"vertices": [at], "z": 7.0},
        "add_breakline": {"coords": [[0.5, 0.5, 1], [5.5, 1.5, 2]], "name": "wall"},
    }
    before = tin.points[tin.vertex_of]
    getattr(tin, operation)(**arguments[operation])
    own = tin.vertex_of[: len(before)]
    stays = np.delete(np.arange(len(before)), at)
    np.testing.assert_array_equal(tin.points[own[stays], :2], before[stays, :2])
    assert own[at] == -1 if operation == "remove" else own[at] >= 0
    assert len(tin.vertex_of) == len(before) + (operation == "insert")
    assert tin.area == pytest.approx(20.0, rel=1e-14)
    assert len(tin.rings) == 1
    assert ts.check(tin).ok
    assert np.isnan(tin.interpolate([[4.0, 4.0]])).all()
    if operation == "add_breakline":
        assert "wall" in tin.lines.names
        assert tin.lines.kinds[tin.lines.names.index("wall")] == "hard"


@pytest.mark.parametrize("is_whole", [True, False])
def test_only_a_whole_hull_grows_with_points_outside(is_whole):
    """Collinear vertices along the sides make no hull less whole."""
    axis = np.arange(4.0)
    x, y = (part.ravel() for part in np.meshgrid(axis, axis))
    made = ts.triangulate(np.column_stack([x, y, x * y]))
    middle = made.points[made.triangles, :2].mean(axis=1)
    inner = np.abs(middle - 1.5).sum(axis=1).argmin()
    chosen = made.triangles if is_whole else np.delete(made.triangles, inner, axis=0)
    tin = ts.TIN.from_triangles(made.points, chosen)
    area = tin.area
    tin.insert([[5.0, 1.5, 2.0]])
    assert tin.area == area + (3.0 if is_whole else 0.0)
    assert ts.check(tin).ok


def test_an_edit_of_no_vertex_changes_nothing():
    for tin in (ts.triangulate(CORNERS), with_a_flagged_edge()):
        before = {name: getattr(tin, name).copy() for name in ARRAYS}
        none = np.empty(0, np.int64)
        tin.set_elevation(none, 5.0)
        tin.remove(none)
        tin.insert(np.empty((0, 3)))
        for name in ARRAYS:
            np.testing.assert_array_equal(getattr(tin, name), before[name], err_msg=name)
        assert [edit.operation for edit in tin.edits] == ["set_elevation", "remove", "insert"]
        tin.undo(3)
        assert tin.edits == ()


def test_what_may_cross_is_split_or_error():
    tin = ts.triangulate(CORNERS)
    with pytest.raises(ts.OptionError, match=r"Invalid crossing 'both'"):
        tin.add_breakline(CORNERS[4:], crossing="both")
    assert tin.edits == ()


# ----------------------------------------------------- the mesh and its vertex numbers


def edit_both(tin, rows, rng):
    """Edit a TIN and the table of its rows, each in its own way."""
    kind = rng.choice(["insert", "insert", "onto", "remove", "move", "set_elevation"])
    own = [r for r in range(4, len(rows)) if rows[r] is not None]
    row = int(rng.choice(own))
    vertex = int(tin.vertex_of[row])
    sharing = [r for r in own if tin.vertex_of[r] == vertex]
    place, changed = [*rng.uniform(0, 9, 2), 7.0], rows[row]
    if kind == "insert":
        new = [place, [*rng.uniform(0, 9, 2), 6.0]]
        found = tin.insert(new)
        assert tin.points[found].tolist() == new
        rows += new
    elif kind == "onto":
        new = [[*rows[row][:2], 40.0], [*rows[row][:2], 20.0]]
        assert tin.insert(new, duplicates="highest").tolist() == [vertex, vertex]
        sharing += [len(rows), len(rows) + 1]
        rows += new
        changed = [*rows[row][:2], max(40.0, rows[row][2])]
    elif kind == "remove" and len(own) > 8:
        tin.remove([vertex])
        changed = None
    elif kind == "move":
        tin.move(vertex, place)
        changed = place
    else:
        tin.set_elevation([vertex], 3.5)
        changed = [*rows[row][:2], 3.5]
    for r in sharing:
        rows[r] = changed


def require_build_of(tin, rows, lines):
    """Arrays, vertices of rows and merges are those of the rows that are there."""
    there = [r for r, one in enumerate(rows) if one is not None]
    fresh = ts.triangulate([rows[r] for r in there], breaklines=lines)
    for name in ARRAYS:
        np.testing.assert_array_equal(getattr(tin, name), getattr(fresh, name), err_msg=name)
    expected = np.full(len(rows), -1)
    expected[there] = fresh.vertex_of
    np.testing.assert_array_equal(tin.vertex_of, expected)
    merges = [m._replace(rows=tuple(there[r] for r in m.rows)) for m in fresh.report.merges()]
    assert list(tin.report.merges()) == merges
    assert len(tin.points) == tin.report.n_vertices == fresh.report.n_vertices
    gone = [r for r, one in enumerate(rows) if one is None]
    assert tin.report.to_dict()["left_out"].get("removed by an edit", []) == gone


@pytest.mark.each_value
@pytest.mark.parametrize("has_line", [False, True])
@pytest.mark.parametrize("seed", range(6))
def test_rows_and_vertices_of_many_edits_are_those_of_a_fresh_build(seed, has_line):
    rng = np.random.default_rng(seed)
    corners = [[-9.0, -9, 0], [30, -9, 0], [30, 30, 0], [-9, 30, 0]]
    inner = np.c_[rng.permutation(30) % 10, rng.permutation(30), rng.random(30)]
    table = np.vstack([corners, inner])
    lines = [[[-5, -8, 1], [25, -8, 2]]] if has_line else []
    tin, rows = ts.triangulate(table, breaklines=lines), table.tolist()
    for _ in range(25):
        edit_both(tin, rows, rng)
        require_build_of(tin, rows, lines)


# ---------------------------------------------------------------- what no build needs


def test_taking_back_all_edits_of_existing_triangles_gives_them_again():
    tin = with_a_flagged_edge()
    before = {name: getattr(tin, name) for name in ARRAYS}
    lines, report = tin.lines, tin.report
    tin.insert([[3.0, 1.0, 1.0]])
    tin.undo()
    for name in ARRAYS:
        assert getattr(tin, name) is before[name], name
    assert tin.lines is lines
    assert tin.report is report


@pytest.mark.parametrize("roundings", [1, 5, 1000, 1025, 5000])
@pytest.mark.parametrize("across", [1.0, -1.0])
def test_a_vertex_moved_beside_a_line_is_where_a_fresh_build_has_it(roundings, across):
    """Nearer than some roundings all is built anew; the result is the same."""
    corners = [[0, 0, 0], [900, 0, 0], [900, 900, 0], [0, 900, 0], [200, 200, 5], [300, 700, 6]]
    line = [[100, 450.0, 10], [800, 450.0, 10]]
    place = [400.0, 450.0 + across * roundings * np.spacing(900.0), 7.0]
    moved, inserted = (ts.triangulate(corners, breaklines=[line]) for _ in range(2))
    moved.move(4, place)
    inserted.insert([place])
    for tin, rows in (
        (moved, [*corners[:4], place, corners[5]]),
        (inserted, [*corners, place]),
    ):
        fresh = ts.triangulate(rows, breaklines=[line])
        for name in ARRAYS:
            np.testing.assert_array_equal(getattr(tin, name), getattr(fresh, name), err_msg=name)
        assert ts.check(tin).ok


def test_the_mean_of_the_largest_elevations_of_either_sign_is_between():
    largest = LARGEST_ELEVATION
    tin = ts.triangulate([[0, 0, largest], [4, 0, 0], [0, 4, 0]])
    tin.insert([[0, 0, -largest]], duplicates="mean")
    assert tin.points[0, 2] == 0.0
    tin.insert([[4, 0, largest]], duplicates="mean")
    assert tin.points[1, 2] == largest / 2


@pytest.mark.parametrize("strict", [True, False])
def test_new_rows_at_one_place_are_merged_as_by_a_build(strict):
    policy = "error" if strict else "mean"
    tin = ts.triangulate(CORNERS[:4], duplicates=policy)
    new = [[2, 3, 1], [2, 3, 4], [5, 5, 2], [2, 3, 7]]
    if strict:
        with pytest.raises(ts.PointsError, match="rows repeat the place of another"):
            tin.insert(new, duplicates="last")
        assert len(tin.points) == 4
        return
    assert tin.insert(new, duplicates="last").tolist() == [4, 4, 5, 4]
    assert tin.points[4:].tolist() == [[2, 3, 7], [5, 5, 2]]
    assert tin.vertex_of.tolist() == [0, 1, 2, 3, 4, 4, 5, 4]


@pytest.mark.parametrize("lines", [[], [[[1.5, 1.5, 1], [6.5, 6.25, 2]]]])
@pytest.mark.parametrize("removed", [False, True])
def test_many_rows_at_once_are_as_one_by_one(monkeypatch, lines, removed):
    """They are triangulated together with the others, unless lines or gaps are there."""
    monkeypatch.setattr(mesh_editor, "_LARGE_BATCH", 10)
    rng = np.random.default_rng(3)
    first = np.r_[CORNERS[:4], np.c_[rng.uniform(0, 8, (20, 2)), rng.random(20)]]
    new = np.c_[rng.integers(0, 9, (40, 2)), rng.random(40)]  # some at one place
    tin, slowly = (ts.triangulate(first, breaklines=lines) for _ in range(2))
    if removed:
        tin.remove([7])
        slowly.remove([7])
    tin.insert(new, duplicates="highest")
    for row in new:
        slowly.insert([row], duplicates="highest")
    for name in (*ARRAYS, "vertex_of"):
        np.testing.assert_array_equal(getattr(tin, name), getattr(slowly, name), err_msg=name)
    assert tin.lines.vertices.tolist() == slowly.lines.vertices.tolist()
    assert ts.check(tin).ok
