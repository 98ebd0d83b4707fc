"""Growth: the kernel's triangles against brute force, other libraries and exact checks."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.spatial
import triangle as triangle_library
from hypothesis import given
from hypothesis import strategies as st
from support import oracles
from support.kernel_datasets import require_same_growth, with_heights
from support.point_sets import hard_places, places

import tinsmith as ts
from tinsmith.tin import _kernel, check, topology

UTM_CORNER = np.array([500_000.0, 4_000_000.0])


def grown(xy):
    return ts.triangulate(with_heights(xy))


def require_sound(xy):
    """Triangulate, check all levels, and count as Euler does; return the TIN."""
    tin = grown(xy)
    result = check(tin, points=with_heights(xy))
    result.raise_if_failed()
    assert result.counts["ties_against_rule"] == 0
    n = len({tuple(p) for p in np.asarray(xy, float).tolist()})
    assert len(tin.points) == n
    assert len(tin.triangles) == 2 * n - 2 - oracles.hull_size(xy)
    np.testing.assert_array_equal(
        tin.neighbors, topology.neighbors_of(tin.triangles, len(tin.points))
    )
    return tin


def require_same_by_every_way(xy, every_threads=(2, 3, 5)):
    """Methods, threads and vector paths must agree in every array, entry by entry."""
    points = np.ascontiguousarray(with_heights(xy))
    wanted = _kernel.grow(points)
    ways = [{"method": method} for method in _kernel.Method]
    ways += [{"method": _kernel.Method.GROWTH, "threads": threads} for threads in every_threads]
    ways += [{"method": _kernel.Method.GROWTH, "path": path} for path in _kernel.VECTOR_PATHS]
    for way in ways:
        require_same_growth(_kernel.grow(points, **way), wanted)


# ------------------------------------------------------------------ brute force


def require_brute_force(xy, *threads):
    wanted = oracles.delaunay(xy)
    if not wanted:
        with pytest.raises(ts.PointsError, match="at least three"):
            grown(xy)
        return
    assert oracles.canonical(grown(xy).triangles) == wanted
    require_same_by_every_way(xy, threads or (2, 3, 5))


several_threads = st.sampled_from([2, 3, 5])


@given(places(st.integers(0, 4), 9), several_threads)
def test_small_grids_equal_brute_force(xy, threads):
    require_brute_force(xy, threads)


MIXED = [0.0, 1e-60, -1e-60, 0.1, 0.2, 0.1 + 0.2, 1.0, 5e5, 1e75, -1e75]


@given(places(st.sampled_from(MIXED), 7), several_threads)
def test_mixed_magnitudes_equal_brute_force(xy, threads):
    require_brute_force(xy, threads)


@given(hard_places(9), several_threads)
def test_hard_coordinates_equal_brute_force(xy, threads):
    require_brute_force(np.unique(xy, axis=0), threads)


def test_whole_grid_equals_brute_force():
    require_brute_force([(x, y) for x in range(4) for y in range(4)])


def random_small_sets(rng):
    """One set of each kind, without end."""
    while True:
        n = int(rng.integers(3, 10))
        yield rng.integers(0, 5, (n, 2)).astype(float)
        yield rng.integers(0, 3, (n, 2)).astype(float)
        yield rng.choice([-1, 1], (n, 2)) * 10.0 ** rng.uniform(-59, 74, (n, 2))
        yield np.column_stack([rng.random(n), rng.random(n) * 1e-15])
        yield rng.integers(0, 4, (n, 2)) * 0.1 + [5e5, 4e6]
        yield rng.integers(-2, 3, (n, 2)) * 10.0 ** rng.integers(-50, 50, (n, 2))


@pytest.mark.proof
@pytest.mark.parametrize("seed", range(4))
def test_thousands_of_small_sets_equal_brute_force(seed):
    rng = np.random.default_rng(seed)
    for _, xy in zip(range(6_000), random_small_sets(rng), strict=False):
        distinct = np.unique(xy, axis=0)
        if len(distinct) >= 3:
            require_brute_force(rng.permutation(distinct))


# ------------------------------------------------------------------ other libraries


@pytest.mark.parametrize("n", [10, 100, 1000, 5000])
def test_general_position_equals_scipy(n):
    xy = np.random.default_rng(n).random((n, 2))
    theirs = np.sort(scipy.spatial.Delaunay(xy).simplices, axis=1)
    ours = np.sort(grown(xy).triangles, axis=1)
    assert set(map(tuple, ours.tolist())) == set(map(tuple, theirs.tolist()))


@pytest.mark.parametrize("n", [10, 100, 1000, 5000])
def test_general_position_equals_triangle(n):
    xy = np.random.default_rng(n + 1).normal(size=(n, 2))
    theirs = oracles.canonical(triangle_library.triangulate({"vertices": xy})["triangles"])
    assert oracles.canonical(grown(xy).triangles) == theirs


# ------------------------------------------------------------------ one set, one TIN


def integer_grid(rng):
    return np.unique(rng.integers(0, 40, (700, 2)), axis=0).astype(float)


def raster(rng):
    return np.stack(np.meshgrid(np.arange(30) * 30.1 + 5e5, np.arange(25) * 30.1 + 4e6), -1)


def utm_cloud(rng):
    return np.round(rng.random((800, 2)) * 300, 1) + UTM_CORNER


@pytest.mark.parametrize("cloud", [integer_grid, raster, utm_cloud])
def test_shuffled_rows_give_the_same_triangles(cloud):
    rng = np.random.default_rng(3)
    xy = np.unique(cloud(rng).reshape(-1, 2), axis=0)
    tin = require_sound(xy)
    wanted = oracles.ranked_triangles(tin.points, tin.triangles)
    for _ in range(20):
        shuffled = grown(rng.permutation(xy))
        found = oracles.ranked_triangles(shuffled.points, shuffled.triangles)
        np.testing.assert_array_equal(found, wanted)


@given(
    places(st.integers(0, 6), 30),
    st.integers(-40, 40),
    st.tuples(st.integers(-(2**40), 2**40), st.integers(-(2**40), 2**40)),
)
def test_moved_and_scaled_points_give_the_same_triangles(xy, exponent, shift):
    xy = np.array(xy, float)
    try:
        wanted = grown(xy)
    except ts.PointsError:
        assert oracles.are_collinear(xy)
        return
    for moved in (xy * 2.0**exponent, xy + shift):
        found = grown(moved)
        np.testing.assert_array_equal(
            oracles.ranked_triangles(found.points, found.triangles),
            oracles.ranked_triangles(wanted.points, wanted.triangles),
        )


@given(places(st.integers(0, 6), 30))
def test_turned_and_mirrored_points_give_valid_tins(xy):
    xy = np.array(xy, float)
    try:
        n_triangles = len(grown(xy).triangles)
    except ts.PointsError:
        assert oracles.are_collinear(xy)
        return
    for turned in (xy[:, ::-1] * [-1, 1], -xy, xy * [-1, 1], xy[:, ::-1]):
        assert len(require_sound(turned).triangles) == n_triangles


# ------------------------------------------------------------------ hard cases


def points_on_a_circle():
    angle = np.linspace(0, 2 * np.pi, 400, endpoint=False)
    return 1000 * np.column_stack([np.cos(angle), np.sin(angle)])


def integer_points_on_a_circle():
    """All points with x^2 + y^2 = 5^2 * 13 * 17, exactly cocircular, and the centre."""
    radius_squared = 5**2 * 13 * 17
    size = range(-75, 76)
    on_circle = [(x, y) for x in size for y in size if x * x + y * y == radius_squared]
    return np.array([*on_circle, (0, 0)], float)


def two_parallel_rails():
    x = np.arange(300) * 0.25
    return np.concatenate([np.column_stack([x, 0 * x]), np.column_stack([x, 0 * x + 50])])


def cluster_and_far_outlier():
    cluster = np.random.default_rng(4).random((300, 2))
    return np.concatenate([cluster, [[1e6, 1e6]]])


def cluster_and_outlier_beyond_all_grids():
    cluster = np.random.default_rng(5).random((60, 2))
    return np.concatenate([cluster, [[1e70, -1e60]]])


def near_collinear_chain():
    rng = np.random.default_rng(6)
    return np.column_stack([np.sort(rng.random(300)), 1e-15 * rng.random(300)])


def near_collinear_chain_at_utm():
    """On a slanted line but for the rounding of the coordinates."""
    step = np.arange(400.0)
    return np.column_stack([500_000 + 0.1 * step, 4_000_000 + 0.3 * step])


def spiral():
    angle = np.sqrt(np.arange(1, 600)) * 1.7
    return np.column_stack([angle * np.cos(angle), angle * np.sin(angle)])


def point_almost_on_a_hull_edge():
    return [(0, 0), (1, 0), (1, 1), (0, 1), (0.5, 2.0**-150)]


def point_just_outside_a_hull_edge():
    return [(0, 0), (1, 0), (1, 1), (0, 1), (0.5, -(2.0**-150))]


def lattice_line_and_one_point():
    line = [(x, 2 * x) for x in range(200)]
    return [*line, (70, 141)]


def lattice_line_and_one_point_far_off():
    return [*((x, 0) for x in range(200)), (100, 10**6)]


def raster_of_tenths():
    x, y = np.meshgrid(np.arange(40) * 0.1, np.arange(30) * 0.1)
    return np.column_stack([x.ravel(), y.ravel()])


def raster_of_tenths_about_the_origin():
    x, y = np.meshgrid(np.arange(-20, 20) * 0.1, np.arange(-15, 15) * 0.1)
    return np.column_stack([x.ravel(), y.ravel()])


def slanted_raster():
    x, y = np.meshgrid(np.arange(40), np.arange(30))
    return np.column_stack([(0.8 * x - 0.6 * y).ravel(), (0.6 * x + 0.8 * y).ravel()])


def long_thin_raster():
    x, y = np.meshgrid(np.arange(500) * 1e-3, np.arange(3) * 1000.0)
    return np.column_stack([x.ravel(), y.ravel()])


def contour_lines():
    angle = np.linspace(0, 2 * np.pi, 120, endpoint=False)
    rings = [
        (radius + 3 * np.sin(3 * angle + radius)) * np.array([np.cos(angle), np.sin(angle)])
        for radius in (20, 40, 60, 80)
    ]
    return np.concatenate([ring.T for ring in rings])


def largest_coordinates():
    return np.random.default_rng(9).integers(-9, 10, (80, 2)) * 1e74


def smallest_coordinates():
    return np.random.default_rng(10).integers(-9, 10, (80, 2)) * 1e-60


def largest_beside_smallest():
    return [
        (0, 0),
        (1e75, 0),
        (0, 1e75),
        (1e-60, 1e-60),
        (1, 1),
        (1e-60, 0),
        (0, 1),
        (2e-60, 1e-60),
    ]


def three_huge_points_almost_on_a_line():
    return [(2e15, -2e21), (1e29, -1e35), (0, 2e11)]


def two_far_clusters():
    rng = np.random.default_rng(11)
    return np.concatenate([rng.random((200, 2)), rng.random((200, 2)) + 10 * UTM_CORNER])


def hexagonal_lattice():
    x, y = np.meshgrid(np.arange(30), np.arange(30))
    return np.column_stack([(2 * x + y % 2).ravel(), (y * 2).ravel()])


def three_points():
    return [(0, 0), (3, 1), (1, 2)]


def triangle_of_many_collinear_points():
    edge = np.arange(60)
    return np.unique(
        np.concatenate(
            [
                np.column_stack(pair)
                for pair in [(edge, 0 * edge), (0 * edge, edge), (edge, 59 - edge)]
            ]
        ),
        axis=0,
    )


HARD_CASES = [
    points_on_a_circle,
    integer_points_on_a_circle,
    two_parallel_rails,
    cluster_and_far_outlier,
    cluster_and_outlier_beyond_all_grids,
    near_collinear_chain,
    near_collinear_chain_at_utm,
    spiral,
    point_almost_on_a_hull_edge,
    point_just_outside_a_hull_edge,
    lattice_line_and_one_point,
    lattice_line_and_one_point_far_off,
    raster_of_tenths,
    raster_of_tenths_about_the_origin,
    slanted_raster,
    long_thin_raster,
    contour_lines,
    largest_coordinates,
    smallest_coordinates,
    largest_beside_smallest,
    three_huge_points_almost_on_a_line,
    two_far_clusters,
    hexagonal_lattice,
    three_points,
    triangle_of_many_collinear_points,
]


@pytest.mark.parametrize("case", HARD_CASES, ids=lambda case: case.__name__)
def test_hard_case(case):
    xy = np.asarray(case(), float)
    tin = require_sound(xy)
    require_same_by_every_way(xy)
    shuffled = grown(np.random.default_rng(0).permutation(xy))
    np.testing.assert_array_equal(
        oracles.ranked_triangles(shuffled.points, shuffled.triangles),
        oracles.ranked_triangles(tin.points, tin.triangles),
    )


def test_no_point_is_lost_at_utm_coordinates():
    """10,000 points 0.1 m apart on average, where floating point alone loses hundreds."""
    xy = np.random.default_rng(12).random((10_000, 2)) * 10 + UTM_CORNER
    tin = require_sound(xy)
    assert len(tin.points) == 10_000
    assert len(np.unique(tin.triangles)) == 10_000


def test_duplicates_are_one_vertex():
    xy = np.random.default_rng(13).integers(0, 12, (500, 2))
    tin = require_sound(xy)
    np.testing.assert_array_equal(tin.points[tin.vertex_of, :2], xy)


def test_every_method_treats_duplicates_alike():
    require_same_by_every_way(np.random.default_rng(13).integers(0, 12, (500, 2)))


def test_vertices_keep_the_order_of_the_rows():
    xy = np.random.default_rng(14).random((200, 2))
    np.testing.assert_array_equal(grown(xy).points[:, :2], xy)


def test_triangles_come_in_the_same_order_every_time():
    xy = np.random.default_rng(15).random((500, 2))
    np.testing.assert_array_equal(grown(xy).triangles, grown(xy).triangles)


# ------------------------------------------------------------------ size


def uniform(rng, n):
    return rng.random((n, 2))


def scan_lines(rng, n):
    """Rows of points 0.5 m apart, jittered by some centimetres and rounded to centimetres."""
    side = int(n**0.5)
    x, y = np.meshgrid(np.arange(side) * 0.5, np.arange(side) * 0.5)
    xy = np.column_stack([x.ravel(), y.ravel()]) + rng.normal(0, 0.05, (side * side, 2))
    return np.round(xy, 2) + UTM_CORNER


def square_raster(rng, n):
    side = int(n**0.5)
    x, y = np.meshgrid(np.arange(side) * 30.1 + 5e5, np.arange(side) * 30.1 + 4e6)
    return np.column_stack([x.ravel(), y.ravel()])


@pytest.mark.proof
@pytest.mark.parametrize("cloud", [uniform, scan_lines, square_raster])
def test_a_million_points_pass_the_check(cloud):
    points = with_heights(cloud(np.random.default_rng(16), 1_000_000))
    tin = ts.triangulate(points)
    result = check(tin, points=points)
    result.raise_if_failed()
    assert result.counts["ties_against_rule"] == 0
    assert len(tin.triangles) == 2 * len(tin.points) - 2 - result.counts["boundary_edges"]


def rough_clouds(rng, n):
    """One cloud of each kind that strains an index or a predicate."""
    angle, step = rng.random(n) * 7, np.arange(n)
    radius = 10 ** rng.uniform(-20, 20, n)
    x = rng.random(n)
    yield np.concatenate(
        [
            rng.normal(rng.random(2) * 1e4, 10 ** rng.uniform(-6, 2), (n // 5 + 1, 2))
            for _ in "12345"
        ]
    )
    yield np.column_stack([x, (step % 2) * rng.choice([1e-9, 1, 1e6])])
    yield np.column_stack([0.1 * step, 0.3 * step + rng.integers(-1, 2, n) * 1e-16])
    yield rng.integers(0, rng.integers(2, 50), (n, 2))
    yield np.column_stack([radius * np.cos(angle), radius * np.sin(angle)])
    yield rng.choice([-1, 1], (n, 2)) * 2.0 ** rng.uniform(-199, 249, (n, 2))
    yield np.round(rng.normal(size=(n, 2)), 1) + UTM_CORNER
    yield np.column_stack([x, x * x])
    yield rng.random((n, 2)) * np.array([1, 10 ** rng.uniform(-15, 0)])
    yield np.concatenate([np.column_stack([x, 0 * x]), np.column_stack([0 * x, rng.random(n)])])


@pytest.mark.proof
@pytest.mark.parametrize("n", [12, 30, 100, 500])
def test_rough_clouds_pass_the_check(n):
    rng = np.random.default_rng(n)
    for _ in range(min(20, 1_000 // n)):  # growth on a parabola takes quadratic time
        for xy in rough_clouds(rng, n):
            require_sound(xy)
            require_same_by_every_way(xy)
