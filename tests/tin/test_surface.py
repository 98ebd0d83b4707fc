"""Surface: measures of a TIN against plain geometry, and TINs made of given triangles."""

from __future__ import annotations

import math
from dataclasses import FrozenInstanceError
from fractions import Fraction

import numpy as np
import pytest
import scipy.spatial
from hypothesis import given
from hypothesis import strategies as st
from support import oracles
from support.point_sets import places

import tinsmith as ts
from tinsmith.tin import TIN, check

SQUARE = np.array([[0, 0, 1], [4, 0, 2], [4, 4, 3], [0, 4, 4]], float)
HALVES = [[0, 1, 2], [0, 2, 3]]


@pytest.fixture(scope="module")
def cloud():
    rng = np.random.default_rng(41)
    xy = rng.random((300, 2)) * 500 + np.array([500_000.0, 4_000_000.0])
    return np.column_stack([xy, rng.normal(100, 20, 300)])


@pytest.fixture(scope="module")
def tin(cloud):
    return ts.triangulate(cloud, crs="EPSG:32616")


def exact_area(points, triangle):
    (ax, ay), (bx, by), (cx, cy) = (oracles.place(points[v]) for v in triangle)
    return Fraction((bx - ax) * (cy - ay) - (by - ay) * (cx - ax)) / 2


def heron(points, triangle):
    a, b, c = sorted(
        math.dist(points[triangle[k]], points[triangle[(k + 1) % 3]]) for k in range(3)
    )
    return 0.25 * math.sqrt((c + (b + a)) * (a - (c - b)) * (a + (c - b)) * (c + (b - a)))


# ------------------------------------------------------------------ areas


@pytest.mark.parametrize("nothing", [[], np.empty((0, 2))])
def test_no_points_have_no_answers(nothing):
    tin = ts.triangulate([[0, 0, 1], [4, 0, 2], [0, 3, 3]])
    for query in (tin.locate, tin.interpolate, tin.closest_vertex):
        assert query(nothing).shape == (0,)


def test_areas_equal_rational_arithmetic(tin):
    wanted = [exact_area(tin.points, triangle) for triangle in tin.triangles]
    np.testing.assert_allclose(tin.triangle_areas, [float(area) for area in wanted], rtol=1e-11)
    assert math.isclose(tin.area, float(sum(wanted)), rel_tol=1e-13)


def test_area_is_that_of_the_convex_hull(tin, cloud):
    hull = scipy.spatial.ConvexHull(cloud[:, :2] - cloud[0, :2])
    assert math.isclose(tin.area, hull.volume, rel_tol=1e-12)


def test_surface_areas_equal_heron(tin):
    wanted = [heron(tin.points, triangle) for triangle in tin.triangles]
    np.testing.assert_allclose(tin.triangle_surface_areas, wanted, rtol=1e-6)
    assert math.isclose(tin.surface_area, math.fsum(wanted), rel_tol=1e-9)


@given(st.floats(-3, 3), st.floats(-3, 3))
def test_surface_area_of_a_tilted_plane(east, north):
    xy = np.random.default_rng(5).random((40, 2))
    tin = ts.triangulate(np.column_stack([xy, xy @ [east, north]]))
    assert math.isclose(
        tin.surface_area, tin.area * math.sqrt(1 + east**2 + north**2), rel_tol=1e-9
    )


def test_areas_of_a_square():
    tin = ts.triangulate(SQUARE)
    assert tin.triangle_areas.tolist() == [8.0, 8.0]
    assert tin.area == 16.0


# ------------------------------------------------------------------ hull, edges, bounds


def test_hull_is_the_convex_hull_counter_clockwise(tin, cloud):
    hull = scipy.spatial.ConvexHull(cloud[:, :2] - cloud[0, :2])
    least = list(hull.vertices).index(min(hull.vertices))
    ours = tin.hull.tolist()
    first = ours.index(min(ours))
    assert ours[first:] + ours[:first] == np.roll(hull.vertices, -least).tolist()


@given(places(st.integers(0, 5), 12))
def test_hull_keeps_collinear_points(xy):
    try:
        tin = ts.triangulate([(x, y, 0) for x, y in xy])
    except ts.PointsError:
        assert oracles.are_collinear(xy)
        return
    ring = tin.hull.tolist()
    assert len(set(ring)) == len(ring)
    assert set(ring) == oracles.hull_points(xy)


def test_hull_of_islands_is_convex_and_their_boundaries_are_rings():
    """Two squares, apart and one of them notched: each has a ring, both have one hull."""
    tin = TIN.from_triangles(
        [[0, 0, 0], [2, 0, 0], [1, 1, 0], [2, 2, 0], [0, 2, 0], [5, 0, 0], [6, 0, 0], [6, 2, 0]],
        [[0, 1, 2], [0, 2, 4], [2, 3, 4], [5, 6, 7]],
    )
    assert [sorted(ring.tolist()) for ring in tin.boundary] == [[0, 1, 2, 3, 4], [5, 6, 7]]
    first = tin.hull.tolist().index(0)
    assert np.roll(tin.hull, -first).tolist() == [0, 1, 5, 6, 7, 3, 4]
    assert [ring.tolist() for ring in tin.rings] == [ring.tolist() for ring in tin.boundary]
    assert tin.hull is tin.hull


@pytest.mark.parametrize("seed", range(20))
def test_hull_of_parts_of_a_grid_is_that_by_definition(seed):
    rng = np.random.default_rng(seed)
    whole = ts.triangulate([(x, y, 0) for x in range(5) for y in range(5)])
    kept = rng.random(len(whole.triangles)) < 0.4
    tin = TIN.from_triangles(whole.points, whole.triangles[kept])
    used = np.unique(tin.triangles)
    on_hull = oracles.hull_points(tin.points[used, :2].astype(int).tolist())
    assert sorted(tin.hull.tolist()) == used[sorted(on_hull)].tolist()
    x, y = tin.points[tin.hull, :2].T
    assert (np.roll(x, -1) * y - x * np.roll(y, -1)).sum() < 0


def test_edges_count_as_euler_says(tin):
    assert len(tin.edges) == len(tin.points) + len(tin.triangles) - 1
    assert tin.edges.shape[1] == 2


def test_bounds_are_those_of_the_vertices(tin, cloud):
    wanted = (cloud[:, 0].min(), cloud[:, 1].min(), cloud[:, 0].max(), cloud[:, 1].max())
    assert tin.bounds == ts.Bounds(*wanted)
    assert math.isclose(tin.bounds.width, np.ptp(cloud[:, 0]))
    assert math.isclose(tin.bounds.height, np.ptp(cloud[:, 1]))
    assert tin.bounds.diagonal == math.hypot(tin.bounds.width, tin.bounds.height)
    x, y = tin.bounds.center
    assert wanted[0] < x < wanted[2]
    assert math.isclose(y - wanted[1], wanted[3] - y)


def test_outer_ring_comes_first():
    """A frame whose inner ring has the lower triangle numbers."""
    outer = np.array([[-9, -9, 0], [9, -9, 0], [9, 9, 0], [-9, 9, 0]], float)
    points = np.vstack([outer / 3, outer])
    frame = []
    for k in range(4):
        n = (k + 1) % 4
        frame += [[n, k, 4 + k], [4 + k, 4 + n, n]]
    tin = TIN.from_triangles(points, frame)
    assert len(tin.rings) == 2
    assert set(tin.hull.tolist()) == {4, 5, 6, 7}
    assert set(tin.rings[1].tolist()) == {0, 1, 2, 3}
    assert tin.area == 18**2 - 6**2


# ------------------------------------------------------------------ read-only, repr


ARRAYS = ["points", "triangles", "neighbors", "constrained", "vertex_of"]
MEASURES = ["edges", "hull", "triangle_areas", "triangle_surface_areas"]


@pytest.mark.parametrize("name", ARRAYS + MEASURES)
def test_arrays_are_read_only(tin, name):
    array = getattr(tin, name)
    with pytest.raises(ValueError, match="read-only"):
        array[0] = 0


def test_attributes_are_frozen(tin):
    with pytest.raises(FrozenInstanceError):
        tin.points = np.zeros((3, 3))


def test_dtypes_and_shapes(tin):
    m = len(tin.triangles)
    assert tin.points.dtype == np.float64
    assert tin.triangles.dtype == tin.neighbors.dtype == tin.vertex_of.dtype == np.int32
    assert tin.constrained.dtype == np.bool_
    assert tin.triangles.shape == tin.neighbors.shape == tin.constrained.shape == (m, 3)
    assert not tin.constrained.any()
    assert tin.vertex_of.tolist() == list(range(300))


def test_repr_is_one_line():
    assert repr(ts.triangulate(SQUARE)) == "<TIN: 4 vertices, 2 triangles, z 1 to 4, crs unknown>"
    one = ts.triangulate(SQUARE[:3], crs="EPSG:32616")
    assert repr(one) == "<TIN: 3 vertices, 1 triangle, z 1 to 3, crs EPSG:32616>"


def test_repr_shortens_a_long_crs():
    wkt = ts.CRS.of(32616).to_wkt().replace("500000", "500001")
    text = repr(ts.triangulate(SQUARE, crs=wkt))
    assert text.endswith('crs PROJCRS["WGS 84 / UTM...>')
    assert "\n" not in text
    survey = ts.Survey(points=SQUARE, crs=wkt, source="a.csv", attributes={"code": np.arange(4)})
    assert repr(survey).startswith("<Survey: 4 points from a.csv, attributes code, crs PROJCRS")


# ------------------------------------------------------------------ from_triangles


def test_triangles_of_a_tin_make_it_again(tin):
    again = TIN.from_triangles(tin.points, tin.triangles, crs=tin.crs)
    for name in ARRAYS:
        np.testing.assert_array_equal(getattr(again, name), getattr(tin, name))
    assert again.crs == tin.crs
    assert check(again).ok


def test_clockwise_triangles_are_turned_with_their_flags(tin):
    rng = np.random.default_rng(6)
    clockwise = rng.random(len(tin.triangles)) < 0.5
    given_triangles = tin.triangles.copy()
    given_triangles[clockwise] = given_triangles[clockwise][:, ::-1]
    ends = np.sort(np.stack([np.roll(given_triangles, -1, 1), np.roll(given_triangles, -2, 1)]), 0)
    breakline = {tuple(sorted(edge)) for edge in tin.edges[::7].tolist()}
    flags = np.array(
        [
            [(int(a), int(b)) in breakline for a, b in zip(*row, strict=True)]
            for row in ends.swapaxes(0, 1)
        ]
    )
    made = TIN.from_triangles(tin.points, given_triangles, constrained=flags)
    assert check(made).ok
    assert check(made).counts["constrained_edges"] == len(breakline)
    start, end = (
        np.roll(made.triangles, -1, 1)[made.constrained],
        np.roll(made.triangles, -2, 1)[made.constrained],
    )
    assert {
        tuple(sorted(edge)) for edge in zip(start.tolist(), end.tolist(), strict=True)
    } == breakline


def test_given_arrays_are_neither_changed_nor_frozen():
    points, triangles = SQUARE.copy(), np.array([[2, 1, 0], [0, 2, 3]], np.int32)
    flags = np.zeros((2, 3), bool)
    TIN.from_triangles(points, triangles, constrained=flags)
    assert triangles.tolist() == [[2, 1, 0], [0, 2, 3]]
    points[0] = triangles[0] = flags[0] = 1


BAD_TRIANGLES = {
    "out of range": ([[0, 1, 4]], "Triangle 0 has the vertices .*0 to 3 are allowed"),
    "negative": ([[0, 1, 2], [0, -1, 2]], "Triangle 1 has the vertices"),
    "no area": ([[0, 1, 1]], "1 triangles? .*no area"),
    "pairs": ([[0, 1]], r"shape \(1, 2\)"),
    "one list": ([0, 1, 2], r"shape \(3,\)"),
    "none": (np.empty((0, 3), int), "m >= 1"),
    "ragged": ([[0, 1, 2], [0, 1]], "three integers a row"),
    "fractions": ([[0.0, 1.0, 2.0]], "must be integers"),
    "text": ([["0", "1", "2"]], "must be integers"),
    "one edge thrice": ([[0, 1, 2], [0, 2, 3], [0, 2, 3]], "more than two triangles|same side"),
    "overlap": ([[0, 1, 2], [0, 1, 3]], "same side"),
}


@pytest.mark.parametrize(("triangles", "words"), BAD_TRIANGLES.values(), ids=list(BAD_TRIANGLES))
def test_bad_triangles_are_refused(triangles, words):
    with pytest.raises(ts.PointsError, match=words):
        TIN.from_triangles(SQUARE, triangles)


def test_collinear_triangle_names_its_number():
    points = [[0, 0, 0], [1, 1, 0], [2, 2, 0], [0, 2, 0]]
    with pytest.raises(ts.PointsError, match="triangle 1, vertices") as caught:
        TIN.from_triangles(points, [[0, 2, 3], [0, 1, 2]])
    assert caught.value.rows == (1,)


@pytest.mark.parametrize(
    "flags", [[True, False, True], np.zeros((3, 3), bool), np.zeros((2, 2), bool)]
)
def test_flags_of_another_shape_are_refused(flags):
    with pytest.raises(ts.PointsError, match=r"Edge flags have shape .*\(2, 3\)"):
        TIN.from_triangles(SQUARE, HALVES, constrained=flags)


def test_ragged_flags_are_refused():
    with pytest.raises(ts.PointsError, match="three flags a row"):
        TIN.from_triangles(SQUARE, HALVES, constrained=[[True, False], [True]])


def test_points_without_triangles_are_kept_and_named_by_the_check():
    tin = TIN.from_triangles([*SQUARE.tolist(), [2, 1, 0]], HALVES)
    assert len(tin.points) == 5
    assert [problem.kind for problem in check(tin).problems] == ["unused"]
