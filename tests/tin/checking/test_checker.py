"""Check: sound TINs pass, and every kind of damage is named; nothing ever raises."""

from __future__ import annotations

import itertools
import json
from dataclasses import FrozenInstanceError

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from support import oracles
from support.point_sets import places

import tinsmith as ts
from tinsmith.tin import TIN, CheckError, OptionError, PointsError, _kernel, check
from tinsmith.tin.checking import shape as check_shape
from tinsmith.tin.checking.findings import Findings

RNG = np.random.default_rng(21)
CLOUD = np.column_stack([RNG.random((60, 2)) * 100, RNG.random(60)])
SQUARE = [[0, 0, 0], [4, 0, 0], [4, 4, 0], [0, 4, 0]]


@pytest.fixture
def tin():
    return ts.triangulate(CLOUD)


def raster(rows, columns, spacing=1.0):
    x, y = np.meshgrid(np.arange(columns) * spacing, np.arange(rows) * spacing)
    return np.column_stack([x.ravel(), y.ravel(), np.zeros(x.size)])


def kinds(result):
    return {problem.kind for problem in result.problems}


def damaged(tin, name, at, value):
    """The TIN with one entry of one array overwritten."""
    array = getattr(tin, name).copy()
    array[at] = value
    return tin.replace(**{name: array})


def inner_edge(tin):
    """Triangle and corner of the first edge that has a triangle on both sides."""
    triangle, corner = np.argwhere(tin.neighbors >= 0)[0]
    return int(triangle), int(corner)


def flipped(tin, triangle, corner):
    """The TIN with the other diagonal in the quadrilateral at an inner edge."""
    across = tin.neighbors[triangle, corner]
    a, b, c = np.roll(tin.triangles[triangle], -corner)
    far = tin.triangles[across].sum() - b - c
    triangles = tin.triangles.copy()
    triangles[triangle], triangles[across] = (a, b, far), (a, far, c)
    return TIN.from_triangles(tin.points, triangles)


def is_convex(tin, triangle, corner):
    """Tell if the quadrilateral at an inner edge can be flipped."""
    across = tin.neighbors[triangle, corner]
    a, b, c = np.roll(tin.triangles[triangle], -corner)
    far = tin.triangles[across].sum() - b - c
    a, b, c, far = (oracles.place(tin.points[v]) for v in (a, b, c, far))
    return oracles.orientation(a, b, far) > 0 and oracles.orientation(a, far, c) > 0


def flippable(tin):
    return [
        (int(triangle), int(corner))
        for triangle, corner in np.argwhere(tin.neighbors >= 0)
        if is_convex(tin, triangle, corner)
    ]


# ------------------------------------------------------------------ sound


def test_a_sound_tin_passes_with_its_counts(tin):
    result = check(tin, points=CLOUD)
    n_hull = oracles.hull_size(CLOUD)
    assert result.ok
    assert result.problems == result.notes == ()
    assert result.counts == {
        "rows": 60,
        "vertices": 60,
        "triangles": 118 - n_hull,
        "edges": 177 - n_hull,
        "boundary_edges": n_hull,
        "constrained_edges": 0,
        "rings": 1,
        "ties": 0,
        "ties_against_rule": 0,
    }
    result.raise_if_failed()
    assert repr(result) == "<CheckResult: level 3, ok>"


def test_one_triangle_passes():
    assert check(ts.triangulate(SQUARE[:3])).ok


@pytest.mark.parametrize("spacing", [1.0, 0.1, 30.1])
def test_every_cell_of_a_raster_is_a_tie_in_order(spacing):
    result = check(ts.triangulate(raster(7, 9, spacing)))
    assert result.ok
    assert result.counts["ties"] == 6 * 8
    assert result.counts["ties_against_rule"] == 0


def test_check_never_asks_the_kernel(tin, monkeypatch):
    def refuse(*args):
        raise AssertionError("the kernel was asked")

    for name in ("grow", "orientation", "in_circle", "snap", "Locator"):
        monkeypatch.setattr(_kernel, name, refuse)
    assert check(tin, points=CLOUD).ok


# ------------------------------------------------------------------ level 1


ENTRIES_OUT_OF_RANGE = [
    ("triangles", (5, 1), 60),
    ("triangles", (5, 1), -1),
    ("neighbors", (3, 0), 10_000),
    ("neighbors", (3, 0), -2),
    ("vertex_of", 7, 60),
    ("vertex_of", 7, -1),
]


@pytest.mark.parametrize(("name", "at", "value"), ENTRIES_OUT_OF_RANGE)
def test_entries_out_of_range(tin, name, at, value):
    result = check(damaged(tin, name, at, value))
    assert kinds(result) == {"index"}
    (problem,) = result.problems
    assert problem.count == 1
    assert problem.first == (at if isinstance(at, int) else at[0],)
    assert name in problem.sentence
    assert [note.kind for note in result.notes] == ["stopped"]


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf, 1e300, 1e-300])
def test_coordinates_that_predicates_cannot_take(tin, value):
    result = check(damaged(tin, "points", (4, 1), value))
    assert kinds(result) == {"coordinates"}
    assert result.problems[0].first == (4,)


def test_elevation_that_is_not_finite(tin):
    assert kinds(check(damaged(tin, "points", (4, 2), np.nan))) == {"coordinates"}
    assert check(damaged(tin, "points", (4, 2), 1e300)).ok


WRONG_ARRAYS = {
    "points": [np.zeros((60, 2)), np.zeros(60), np.zeros((60, 3), int), np.zeros((60, 3), "U3")],
    "triangles": [np.zeros((9, 4), int), np.zeros((9, 3)), np.array(3)],
    "neighbors": [np.full((1, 3), -1), np.zeros((9, 3), bool), np.zeros(0, int)],
    "constrained": [np.zeros((1, 3), bool), np.zeros((9, 3), int)],
    "vertex_of": [np.zeros((60, 1), int), np.zeros(60)],
}


@pytest.mark.parametrize(
    ("name", "array"), [(name, array) for name, arrays in WRONG_ARRAYS.items() for array in arrays]
)
def test_arrays_of_wrong_shape_or_type(tin, name, array):
    result = check(tin.replace(**{name: array.copy()}))
    assert kinds(result) == {"shape"}
    assert any(name in problem.sentence for problem in result.problems)


def test_no_triangles(tin):
    none = np.empty((0, 3), np.int32)
    result = check(tin.replace(triangles=none, neighbors=none, constrained=none.astype(bool)))
    assert kinds(result) == {"shape"}
    assert "no triangle" in result.problems[0].sentence


def test_triangle_with_a_vertex_twice(tin):
    broken = damaged(tin, "triangles", (5, 1), tin.triangles[5, 0])
    assert "corners" in kinds(check(broken))


def test_neighbor_that_does_not_look_back(tin):
    triangle, corner = inner_edge(tin)
    result = check(damaged(tin, "neighbors", (triangle, corner), -1))
    assert kinds(result) == {"neighbors"}
    assert result.problems[0].first == (tin.neighbors[triangle, corner],)


def test_triangle_that_is_its_own_neighbor(tin):
    assert kinds(check(damaged(tin, "neighbors", (2, 0), 2))) == {"neighbors"}


def test_two_neighbors_exchanged(tin):
    assert kinds(check(tin.replace(neighbors=np.roll(tin.neighbors, 1, axis=1)))) == {"neighbors"}


def test_edge_flagged_on_one_side(tin):
    triangle, corner = inner_edge(tin)
    result = check(damaged(tin, "constrained", (triangle, corner), True))
    assert kinds(result) == {"constrained"}
    assert set(result.problems[0].first) == {triangle, int(tin.neighbors[triangle, corner])}


def test_vertex_without_triangle(tin):
    points = np.vstack([tin.points, [50.0, 50.0, 0.0]])
    result = check(tin.replace(points=points))
    assert kinds(result) == {"unused"}
    assert result.problems[0].first == (60,)


def test_edge_with_four_triangles():
    """Two pairs on one edge, each pair in agreement with itself."""
    points = np.array([[0, 0, 0], [4, 0, 0], [1, 2, 0], [1, -2, 0], [3, 2, 0], [3, -2, 0]], float)
    triangles = np.array([[0, 1, 2], [1, 0, 3], [0, 1, 4], [1, 0, 5]], np.int32)
    neighbors = np.array([[-1, -1, 1], [-1, -1, 0], [-1, -1, 3], [-1, -1, 2]], np.int32)
    pairs = TIN(
        points=points,
        triangles=triangles,
        neighbors=neighbors,
        constrained=np.zeros((4, 3), bool),
        vertex_of=np.arange(6, dtype=np.int32),
        report=ts.Report(n_rows=6, n_vertices=6, n_triangles=4),
    )
    assert kinds(check(pairs)) == {"edge"}


# ------------------------------------------------------------------ level 2


def test_clockwise_triangles(tin):
    mirrored = tin.replace(points=tin.points * [-1, 1, 1])
    result = check(mirrored)
    assert "orientation" in kinds(result)
    assert result.problems[0].count == len(tin.triangles)


def test_flat_triangle():
    points = [[0, 0, 0], [4, 0, 0], [2, 2, 0], [2, -2, 0]]
    tin = TIN.from_triangles(points, [[0, 1, 2], [1, 0, 3]])
    flat = damaged(tin, "points", (3, 1), 0.0)
    assert "orientation" in kinds(check(flat))


def test_vertex_pulled_across_an_edge(tin):
    inner = next(v for v in range(60) if v not in tin.hull)
    assert "orientation" in kinds(check(damaged(tin, "points", (inner, 0), 99.0)))


def test_missing_triangle_inside(tin):
    inner = next(t for t, corners in enumerate(tin.triangles) if not set(corners) & set(tin.hull))
    holed = TIN.from_triangles(tin.points, np.delete(tin.triangles, inner, axis=0))
    result = check(holed)
    assert kinds(result) == {"boundary", "hull"}
    assert result.counts["rings"] == 2


def test_missing_triangle_that_touches_the_hull_with_one_corner():
    points = raster(4, 4)
    tin = ts.triangulate(points)
    on_hull = np.isin(tin.triangles, tin.hull).sum(axis=1)
    touching = int(np.flatnonzero((on_hull == 1) & (tin.neighbors >= 0).all(axis=1))[0])
    result = check(TIN.from_triangles(points, np.delete(tin.triangles, touching, axis=0)))
    assert kinds(result) == {"hull"}
    assert result.counts["rings"] == 1


def test_missing_triangle_at_the_hull():
    points = raster(4, 4)
    tin = ts.triangulate(points)
    on_side = next(t for t in range(len(tin.triangles)) if (tin.neighbors[t] < 0).sum() == 1)
    result = check(TIN.from_triangles(points, np.delete(tin.triangles, on_side, axis=0)))
    assert kinds(result) == {"hull"}


def test_two_pieces():
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], float)
    pieces = TIN.from_triangles(np.vstack([corners, corners + 10]), [[0, 1, 2], [3, 4, 5]])
    assert kinds(check(pieces)) == {"boundary", "euler"}


def test_closed_surface():
    """A triangle glued to its own back has no boundary."""
    sides = TIN(
        points=np.array(SQUARE[:3], float),
        triangles=np.array([[0, 1, 2], [0, 2, 1]], np.int32),
        neighbors=np.array([[1, 1, 1], [0, 0, 0]], np.int32),
        constrained=np.zeros((2, 3), bool),
        vertex_of=np.arange(3, dtype=np.int32),
        report=ts.Report(n_rows=3, n_vertices=3, n_triangles=2),
    )
    assert kinds(check(sides)) == {"orientation", "boundary"}


def test_surface_that_covers_the_plane_twice():
    """A fan that turns twice about its hub: every triangle, edge and corner looks right."""
    angle = 2 * np.pi * np.arange(10) / 5
    boundary = np.column_stack([np.cos(angle), np.sin(angle), 0 * angle])
    fan = TIN.from_triangles(
        np.vstack([boundary, [0.0, 0.0, 0.0]]), [[10, i, (i + 1) % 10] for i in range(10)]
    )
    result = check(fan, level=2)
    assert kinds(result) == {"hull"}
    assert "winds" in result.problems[0].sentence


def test_areas_that_do_not_add_up(tin):
    """Areas follow from the rest, so the comparison itself is given a wrong boundary."""
    found = Findings()
    check_shape._check_areas(tin, [tin.hull], found)
    assert found.problems == []
    check_shape._check_areas(tin, [tin.hull[:-1]], found)
    assert [problem.kind for problem in found.problems] == ["area"]


def test_pieces_that_touch_in_one_vertex():
    points = [[0, 0, 0], [2, -1, 0], [2, 1, 0], [-2, 1, 0], [-2, -1, 0]]
    pieces = [[0, 1, 2], [0, 3, 4]]
    assert kinds(check(TIN.from_triangles(points, pieces))) == {"boundary", "euler"}
    bound = TIN.from_triangles(points, pieces, constrained=np.ones((2, 3), bool))
    assert check(bound).ok


def test_constrained_boundary_may_have_any_shape():
    """An L, and a frame: allowed only if their boundary edges are constrained."""
    points = raster(4, 4)
    whole = ts.triangulate(points)
    centre = points[whole.triangles].mean(axis=1)
    in_corner = (centre[:, 0] > 1) & (centre[:, 1] > 1)
    in_middle = (np.abs(centre[:, :2] - 1.5) < 0.5).all(axis=1)
    for removed in (in_corner, in_middle):
        used = np.unique(whole.triangles[~removed])
        number = np.searchsorted(used, whole.triangles[~removed])
        free = TIN.from_triangles(points[used], number)
        bound = TIN.from_triangles(points[used], number, constrained=free.neighbors < 0)
        assert "hull" in kinds(check(free))
        assert check(bound).ok


@pytest.mark.parametrize("n_constrained", [0, 1, 2])
def test_a_reflex_corner_needs_both_its_edges_constrained(n_constrained):
    """An arrow-head: one constrained side does not excuse the other, on either side."""
    points = [[0, 0, 0], [4, -4, 0], [2, 0, 0], [4, 4, 0]]
    triangles = [[0, 1, 2], [0, 2, 3]]
    free = TIN.from_triangles(points, triangles)
    outer = [(t, k) for t in range(2) for k in range(3) if free.neighbors[t, k] < 0]
    at_notch = [(t, k) for t, k in outer if 2 in np.delete(triangles[t], k)]
    assert len(at_notch) == 2
    for chosen in itertools.combinations(at_notch, n_constrained):
        constrained = np.zeros((2, 3), bool)
        for t, k in {*outer, *chosen} - (set(at_notch) - set(chosen)):
            constrained[t, k] = True
        result = check(TIN.from_triangles(points, triangles, constrained=constrained))
        assert kinds(result) == (set() if n_constrained == 2 else {"hull"})


# ------------------------------------------------------------------ level 3


def test_every_flip_of_a_delaunay_edge_is_found(tin):
    edges = flippable(tin)
    assert len(edges) > 50
    for triangle, corner in edges:
        result = check(flipped(tin, triangle, corner))
        assert kinds(result) == {"delaunay"}


def test_flip_in_the_last_block_of_many_is_found():
    large = ts.triangulate(np.random.default_rng(3).random((20_000, 3)))
    last = [(t, 0) for t in range(39_000, len(large.triangles)) if large.neighbors[t, 0] >= 0]
    triangle, corner = next(edge for edge in last if is_convex(large, *edge))
    result = check(flipped(large, triangle, corner))
    assert kinds(result) == {"delaunay"}
    assert result.problems[0].count == 1


def test_constrained_edges_need_not_be_delaunay(tin):
    triangle, corner = flippable(tin)[0]
    broken = flipped(tin, triangle, corner)
    a, b = sorted(
        set(broken.triangles[triangle]) & set(broken.triangles[tin.neighbors[triangle, corner]])
    )
    ends = np.stack([broken.triangles[:, [1, 2, 0]], broken.triangles[:, [2, 0, 1]]])
    flags = (ends.min(axis=0) == a) & (ends.max(axis=0) == b)
    assert flags.sum() == 2
    result = check(broken.replace(constrained=flags))
    assert result.ok
    assert result.counts["constrained_edges"] == 1


def test_tie_broken_otherwise_is_a_note():
    tin = ts.triangulate(SQUARE)
    other = flipped(tin, *inner_edge(tin))
    result = check(other)
    assert result.ok
    assert result.counts["ties_against_rule"] == 1
    assert [note.kind for note in result.notes] == ["tie"]


@given(
    places(st.integers(0, 4), 9, least=4),
    st.lists(st.integers(0, 1000), max_size=4),
)
def test_verdict_is_that_of_brute_force_after_any_flips(xy, choices):
    try:
        tin = ts.triangulate([(x, y, 0) for x, y in xy])
    except PointsError:
        assert oracles.are_collinear(xy)
        return
    for choice in choices:
        edges = flippable(tin)
        if edges:
            tin = flipped(tin, *edges[choice % len(edges)])
    places = [oracles.place(p) for p in xy]
    is_delaunay = all(
        oracles.in_circle(*(places[v] for v in triangle), p) <= 0
        for triangle in tin.triangles
        for p in places
    )
    result = check(tin)
    assert result.ok == is_delaunay
    is_by_rule = oracles.canonical(tin.triangles) == oracles.delaunay(xy)
    assert (result.ok and result.counts["ties_against_rule"] == 0) == is_by_rule


# ------------------------------------------------------------------ rows


def test_rows_are_found_again(tin):
    moved = CLOUD.copy()
    moved[7, 0] += 1e-9
    result = check(tin, points=moved)
    assert kinds(result) == {"rows"}
    assert result.problems[0].first == (7,)
    assert check(tin, level=2, points=moved).ok


def test_rows_of_a_survey_may_be_given(tin):
    assert check(tin, points=ts.Survey(points=CLOUD)).ok


def test_snapped_rows_may_be_off_by_the_snap():
    points = np.round(CLOUD, 1)
    points = np.vstack([points, points + np.array([0.3, 0.4, 0.0])])
    snapped = ts.triangulate(points, snap=0.6)
    assert len(snapped.points) <= 60
    assert check(snapped, points=points).ok
    points[3, 0] += 2.0
    assert kinds(check(snapped, points=points)) == {"rows"}


def test_other_number_of_rows(tin):
    result = check(tin, points=CLOUD[:-1])
    assert kinds(result) == {"rows"}
    assert "59" in result.problems[0].sentence


# ------------------------------------------------------------------ the result


def test_levels_look_at_no_more_than_asked(tin):
    mirrored = tin.replace(points=tin.points * [-1, 1, 1])
    assert check(mirrored, level=1).ok
    broken = flipped(tin, *flippable(tin)[0])
    assert check(broken, level=2).ok
    assert not check(broken, level=3).ok


@pytest.mark.parametrize("level", [0, 4, -1, "3", None, 2.5])
def test_other_levels_are_refused(tin, level):
    with pytest.raises(OptionError, match=r"level .* 1, 2 or 3"):
        check(tin, level=level)


def test_failed_check_raises_its_sentences(tin):
    result = check(damaged(tin, "triangles", (5, 1), 60))
    with pytest.raises(CheckError, match="outside 0 to 59") as caught:
        result.raise_if_failed()
    assert caught.value.problems == result.problems
    assert isinstance(caught.value, ts.TinsmithError)
    assert isinstance(caught.value, ValueError)


def test_result_is_plain_data(tin):
    result = check(damaged(tin, "triangles", (5, 1), 60))
    plain = json.loads(json.dumps(result.to_dict()))
    assert plain["ok"] is False
    assert plain["level"] == 3
    assert plain["problems"][0]["kind"] == "index"
    assert plain["problems"][0]["first"] == [5]
    assert plain["counts"]["triangles"] == len(tin.triangles)
    assert repr(result) == "<CheckResult: level 3, problems: 1 index>"
    with pytest.raises(FrozenInstanceError):
        result.level = 1


def test_many_faults_are_counted_and_a_few_shown(tin):
    result = check(tin.replace(neighbors=np.full_like(tin.neighbors, 10_000)))
    (problem,) = result.problems
    assert problem.count == len(tin.triangles)
    assert problem.first == (0, 1, 2, 3, 4)
