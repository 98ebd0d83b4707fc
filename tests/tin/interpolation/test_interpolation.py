"""Interpolation by every method: against definitions in rational numbers, SciPy, closed forms."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.interpolate import CloughTocher2DInterpolator
from scipy.spatial import Delaunay
from support import oracles
from support.natural_oracle import laplace_weights, sibson_weights
from support.point_sets import places, seeds

import tinsmith as ts
from tinsmith.base.errors import OptionError, PointsError
from tinsmith.tin import TIN

UTM = (500_000.0, 4_000_000.0)
METHODS = ("linear", "nearest", "laplace", "natural", "c1")
PLANAR = ("linear", "laplace", "natural", "c1")
WEIGHTS = {"natural": sibson_weights, "laplace": laplace_weights}


def rng(seed=0):
    return np.random.default_rng(seed)


def uniform(n, seed=0, size=100.0):
    return rng(seed).random((n, 3)) * [size, size, 10.0]


def expected(weights, sites, elevations, p):
    """The weighted mean by definition; None where the definition has no bounded cell."""
    shares = weights([oracles.place(site) for site in sites], oracles.place(p))
    return float(sum(w * Fraction(float(z)) for w, z in zip(shares, elevations, strict=True)))


def strictly_inside(tin, xy):
    """Places within the hull, at no vertex and not on its edges."""
    hull = shapely.Polygon(tin.points[tin.hull, :2])
    places = shapely.points(xy)
    inside = shapely.contains_properly(hull, places)
    taken = {tuple(p) for p in tin.points[:, :2].tolist()}
    return xy[[ok and tuple(p) not in taken for ok, p in zip(inside, xy.tolist(), strict=True)]]


def places_of(tin):
    """Edge midpoints, centroids, places between."""
    xy = tin.points[:, :2]
    middles = xy[tin.edges].mean(axis=1)
    centroids = xy[tin.triangles].mean(axis=1)
    return np.concatenate(
        [middles, centroids, rng(1).random((9, 2)) * np.ptp(xy, axis=0) + xy.min(axis=0)]
    )


# ---------------------------------------------------------------- natural neighbours


@pytest.mark.parametrize("method", ["natural", "laplace"])
@settings(max_examples=15, deadline=None)
@given(
    places(st.integers(0, 5), 12, least=4),
    seeds,
)
def test_weights_are_those_of_the_definition_on_small_grids(method, sites, seed):
    if oracles.are_collinear(sites):
        return
    z = rng(seed).random(len(sites)) * 10
    tin = ts.triangulate(np.column_stack([np.array(sites, float), z]))
    xy = strictly_inside(tin, places_of(tin))
    found = tin.interpolate(xy, method=method)
    wanted = [expected(WEIGHTS[method], sites, z, p) for p in xy]
    np.testing.assert_allclose(found, wanted, rtol=0, atol=1e-10)


@pytest.mark.each_value
@pytest.mark.parametrize("method", ["natural", "laplace"])
@pytest.mark.parametrize("shift", [(0.0, 0.0), UTM])
def test_weights_are_those_of_the_definition_on_uneven_points(method, shift):
    points = rng(4).random((14, 3)) ** [[3, 1, 1]] * [100, 100, 10] + [*shift, 0]
    tin = ts.triangulate(points)
    xy = strictly_inside(tin, places_of(tin))
    wanted = [expected(WEIGHTS[method], points[:, :2], points[:, 2], p) for p in xy]
    np.testing.assert_allclose(tin.interpolate(xy, method=method), wanted, rtol=0, atol=1e-9)


@pytest.mark.each_value
@pytest.mark.parametrize("method", ["natural", "laplace"])
@pytest.mark.parametrize("offset", [1e-3, 1e-6, 1e-9, 2.0**-30])
def test_slivers_along_the_hull_take_no_digits(method, offset):
    """Points a hair off a straight line, at map coordinates: circles of enormous radius."""
    x = np.arange(8.0)
    bent = np.column_stack([x, offset * x * (7 - x)])
    points = np.concatenate([bent, [[1.5, 4.0], [5.5, 5.0]]]) + UTM
    z = rng(3).random(len(points))
    tin = ts.triangulate(np.column_stack([points, z]))
    xy = strictly_inside(tin, places_of(tin))
    wanted = [expected(WEIGHTS[method], points, z, p) for p in xy]
    np.testing.assert_allclose(tin.interpolate(xy, method=method), wanted, rtol=0, atol=1e-9)


ROUNDINGS_APART = {
    "off a line, circles of 1e31": (
        [
            [33333.333333333314, 0.09999999999999999],
            [0.10000000000000002, 10799999.999999998],
            [0.20000000000000004, 10799999.999999996],
            [33333.33333333333, 0.10000000000000005],
            [66666.66666666672, 0.10000000000000005],
            [0.2000000000000001, 10800000.0],
            [0.20000000000000004, 5400000.000000001],
        ],
        [50044.43500677012, 0.10000000000000005],
    ),
    "two neighbours a rounding apart, far away": (
        [
            [0.2999999999999999, 0.9999999999999996],
            [10800000.000000004, 10800000.000000006],
            [16199999.999999994, 10799999.999999994],
            [10800000.000000006, 10799999.999999996],
            [10800000.000000006, 16199999.999999994],
        ],
        [13500000.0, 10800000.0],
    ),
}


@pytest.mark.parametrize("method", ["natural", "laplace"])
@pytest.mark.parametrize("case", ROUNDINGS_APART)
def test_points_a_rounding_apart_take_no_digits(method, case):
    sites, place = ROUNDINGS_APART[case]
    z = rng(1).random(len(sites)) * 100
    tin = ts.triangulate(np.column_stack([sites, z]))
    wanted = expected(WEIGHTS[method], sites, z, place)
    assert float(tin.interpolate(place, method=method)) == pytest.approx(wanted, abs=1e-8)


@pytest.mark.parametrize("method", ["natural", "laplace"])
def test_next_to_an_edge_of_the_hull_the_limit_is_linear(method):
    points = np.array([[0, 0, 1], [4, 0, 3], [2, 5, 100]], float)
    tin = ts.triangulate(points)
    for away in (1e-3, 1e-9, 1e-15, 1e-60):
        found = tin.interpolate([[1.0, away]], method=method)
        assert found == pytest.approx(1.5 + 19.6 * away, abs=1e-12)  # three make a plane


@pytest.mark.parametrize("method", ["natural", "laplace"])
def test_natural_neighbours_do_not_depend_on_the_triangles_given(method):
    points = uniform(60, seed=5)
    tin = ts.triangulate(points)
    fan = ts.triangulate(points * [[1, 1e-3, 1]])  # Delaunay of other places
    other = TIN.from_triangles(points, fan.triangles)
    assert len(np.setdiff1d(other.triangles, tin.triangles)) == 0
    xy = strictly_inside(tin, rng(6).random((300, 2)) * 100)
    xy = xy[other.locate(xy) >= 0]
    assert len(xy) > 200
    # The hull of the squeezed points is the same; only what lies within differs.
    assert {tuple(sorted(e)) for e in other.edges.tolist()} != {
        tuple(sorted(e)) for e in tin.edges.tolist()
    }
    np.testing.assert_allclose(
        other.interpolate(xy, method=method), tin.interpolate(xy, method=method), atol=1e-10
    )


def test_sibson_on_a_raster_is_the_same_whichever_way_squares_are_cut():
    x, y = np.meshgrid(np.arange(6.0), np.arange(6.0))
    points = np.column_stack([x.ravel(), y.ravel(), rng(8).random(36)])
    turned = points[:, [1, 0, 2]]
    xy = rng(9).random((200, 2)) * 5
    np.testing.assert_allclose(
        ts.triangulate(points).interpolate(xy, method="natural"),
        ts.triangulate(turned).interpolate(xy[:, ::-1], method="natural"),
        atol=1e-13,
    )


@pytest.mark.parametrize("method", ["natural", "laplace"])
def test_a_hub_of_many_neighbours_is_no_limit(method):
    angle = np.linspace(0, 2 * np.pi, 5000, endpoint=False)
    ring = np.column_stack([100 * np.cos(angle), 100 * np.sin(angle), np.zeros(5000)])
    ring[:, 2] = 7
    tin = ts.triangulate(ring)
    np.testing.assert_allclose(tin.interpolate(rng(1).random((20, 2)) * 50, method=method), 7.0)


# ---------------------------------------------------------------- what all methods have in common


@pytest.mark.parametrize("method", PLANAR)
@pytest.mark.parametrize("shift", [(0.0, 0.0), UTM])
def test_planes_are_reproduced(method, shift):
    points = uniform(400, seed=2)
    points[:, :2] += shift
    plane = lambda xy: 0.5 * (xy[:, 0] - shift[0]) - 0.25 * (xy[:, 1] - shift[1]) + 300  # noqa: E731
    points[:, 2] = plane(points)
    tin = ts.triangulate(points)
    xy = places_of(tin)
    xy = xy[tin.locate(xy) >= 0]
    np.testing.assert_allclose(tin.interpolate(xy, method=method), plane(xy), rtol=0, atol=2e-9)


@pytest.mark.parametrize("method", METHODS)
def test_vertices_keep_their_elevations_to_the_last_bit(method):
    for points in (uniform(300) + np.array([*UTM, 1e9]), raster_points(12)):
        tin = ts.triangulate(points)
        np.testing.assert_array_equal(
            tin.interpolate(tin.points[:, :2], method=method), tin.points[:, 2]
        )


def raster_points(n):
    x, y = np.meshgrid(np.arange(float(n)), np.arange(float(n)))
    return np.column_stack([x.ravel(), y.ravel(), rng(0).random(n * n)])


@pytest.mark.parametrize("method", METHODS)
def test_inside_there_is_an_elevation_and_outside_none(method):
    outer = [(0, 0), (3, 0), (3, 3), (0, 3)]
    inner = [(1, 1), (2, 1), (2, 2), (1, 2)]
    points = np.array([(x, y, x * y) for x, y in outer + inner], float)
    tin = ts.triangulate(points, holes=[np.array(inner, float)])
    xy = rng(1).random((500, 2)) * 5 - 1
    found = tin.interpolate(xy, method=method)
    np.testing.assert_array_equal(np.isnan(found), tin.locate(xy) < 0)
    assert np.isnan(found).sum() > 100


@pytest.mark.parametrize("method", METHODS)
def test_any_number_of_threads_gives_the_same_bits(method):
    tin = ts.triangulate(uniform(2000))
    xy = rng(1).random((5000, 2)) * 110
    one = tin.interpolate(xy, method=method, threads=1, extrapolate="nearest")
    for threads in (2, 5, None):
        again = tin.interpolate(xy, method=method, threads=threads, extrapolate="nearest")
        np.testing.assert_array_equal(again, one)


@pytest.mark.parametrize("method", METHODS)
def test_one_place_is_a_number(method):
    tin = ts.triangulate(uniform(50))
    place = [50.0, 50.0]
    found = tin.interpolate(place, method=method)
    assert np.ndim(found) == 0
    assert float(found) == tin.interpolate([place], method=method)[0]
    assert float(tin.interpolate(np.array(place), method=method)) == float(found)


def test_nothing_and_nan_are_places():
    tin = ts.triangulate(uniform(50))
    for method in METHODS:
        assert tin.interpolate([], method=method).shape == (0,)
        places = [[np.nan, 50.0], [50.0, 50.0]]
        found = tin.interpolate(places, method=method, extrapolate="nearest")
        assert np.isnan(found).tolist() == [True, False]


def test_elevations_of_any_size_do_not_overflow():
    points = uniform(40)
    points[:, 2] = np.where(np.arange(40) % 2, 1e300, -1e300)
    tin = ts.triangulate(points)
    xy = tin.points[tin.triangles, :2].mean(axis=1)
    for method in METHODS:
        assert np.isfinite(tin.interpolate(xy, method=method)).all()


def test_wrong_words_are_refused():
    tin = ts.triangulate(uniform(10))
    with pytest.raises(OptionError, match=r"Invalid method 'cubic'.*one of linear, nearest"):
        tin.interpolate([[1, 1]], method="cubic")
    with pytest.raises(OptionError, match="Invalid method"):
        tin.interpolate([[1, 1]], method=["linear"])
    with pytest.raises(OptionError, match="Invalid extrapolate 'linear'"):
        tin.interpolate([[1, 1]], extrapolate="linear")
    with pytest.raises(OptionError, match="Invalid threads 0"):
        tin.interpolate([[1, 1]], threads=0)
    with pytest.raises(PointsError, match="shape"):
        tin.interpolate([1, 2, 3])


def test_edits_are_seen_by_every_method():
    tin = ts.triangulate(raster_points(5))
    before = {method: tin.interpolate([[1.5, 1.6]], method=method)[0] for method in METHODS}
    tin.insert([[1.5, 1.6, 99.0]])
    for method in METHODS:
        assert tin.interpolate([[1.5, 1.6]], method=method)[0] == 99.0 != before[method]


# ---------------------------------------------------------------- hard and soft breaklines


def roof(kind="hard"):
    """Two planes that meet in a ridge; scattered points on both."""
    xy = rng(3).random((200, 2)) * 100
    z = 50 - np.abs(xy[:, 0] - 50)
    ridge = ts.Breakline([[50, 0, 50], [50, 30, 50], [50, 100, 50]], kind=kind)
    return ts.triangulate(np.column_stack([xy, z]), breaklines=[ridge])


@pytest.mark.parametrize("method", ["natural", "laplace", "c1"])
def test_nothing_is_smoothed_across_a_hard_breakline(method):
    tin = roof()
    xy = rng(4).random((2000, 2)) * 100
    xy = xy[tin.locate(xy) >= 0]
    np.testing.assert_allclose(
        tin.interpolate(xy, method=method), 50 - np.abs(xy[:, 0] - 50), rtol=0, atol=1e-9
    )


@pytest.mark.parametrize("method", ["natural", "laplace", "c1"])
def test_a_soft_breakline_is_smoothed(method):
    at_ridge = roof("soft").interpolate([[50.0, 60.0], [50.5, 60.0]], method=method)
    assert (np.array([49.0, 48.5]) < at_ridge + 10).all()
    hard = roof().interpolate([[50.5, 60.0]], method=method)
    assert abs(at_ridge[1] - hard[0]) > 1e-3


@pytest.mark.parametrize("method", ["linear", "laplace", "natural", "c1"])
def test_a_hard_breakline_is_linear_from_both_sides(method):
    xy = rng(5).random((300, 2)) * 100
    line = np.array([[10, 20, 5], [60, 45, 9], [95, 40, 2]], float)
    tin = ts.triangulate(np.column_stack([xy, rng(6).random(300) * 20]), breaklines=[line])
    for start, end in ((0, 1), (1, 2)):
        a, b = line[start], line[end]
        across = np.array([-(b - a)[1], (b - a)[0]]) / np.hypot(*(b - a)[:2])
        for share in np.linspace(0.01, 0.99, 25):
            at = a + share * (b - a)
            near = [at[:2] + 1e-10 * side * across for side in (-1, 0, 1)]
            # Vertices inserted on the way are no part of the line given.
            np.testing.assert_allclose(tin.interpolate(near, method=method), at[2], atol=1e-6)


@pytest.mark.parametrize("weights", ["natural", "laplace"])
def test_a_line_across_everything_leaves_the_vertices_of_one_side(weights):
    """Then the neighbours are those of the side's own Voronoi diagram."""
    left = np.column_stack([rng(1).random((12, 2)) * [49, 100], rng(2).random(12) * 9])
    right = left * [-1, 1, 3] + [100, 0, 0]
    line = np.array([[50, -10, 4], [50, 20, 8], [50, 55, 1], [50, 110, 6]], float)
    tin = ts.triangulate(np.concatenate([left, right]), breaklines=[line])
    side = np.concatenate([left, line])
    xy = strictly_inside(ts.triangulate(side), rng(3).random((40, 2)) * [50, 100])
    wanted = [expected(WEIGHTS[weights], side[:, :2], side[:, 2], p) for p in xy]
    np.testing.assert_allclose(tin.interpolate(xy, method=weights), wanted, rtol=0, atol=1e-9)


@pytest.mark.parametrize("method", ["natural", "laplace", "c1"])
def test_around_the_end_of_a_line_the_surface_is_continuous(method):
    xy = rng(5).random((300, 2)) * 100
    line = np.array([[30, 50, 5], [50, 50, 9]], float)
    tin = ts.triangulate(np.column_stack([xy, rng(6).random(300)]), breaklines=[line])
    angle = np.linspace(0, 2 * np.pi, 2001)
    for radius in (3.0, 1e-3):
        circle = np.column_stack([50 + radius * np.cos(angle), 50 + radius * np.sin(angle)])
        jumps = np.abs(np.diff(tin.interpolate(circle, method=method)))
        assert jumps.max() < 0.2 * radius


# ---------------------------------------------------------------- C1


def test_gradients_are_those_of_scipy_s_minimum_norm_network():
    points = uniform(200, seed=7)
    delaunay = Delaunay(points[:, :2])
    peer = CloughTocher2DInterpolator(delaunay, points[:, 2], tol=1e-14, maxiter=10_000)
    tin = TIN.from_triangles(points, delaunay.simplices)
    edges = tin.edges
    for share in (0.25, 0.5, 0.8):
        xy = (1 - share) * points[edges[:, 0], :2] + share * points[edges[:, 1], :2]
        inside = tin.locate(xy) >= 0
        both = inside & np.isfinite(peer(xy))
        assert both.sum() > 0.9 * len(xy)
        np.testing.assert_allclose(
            tin.interpolate(xy[both], method="c1"), peer(xy[both]), rtol=0, atol=1e-8
        )


def slopes_across(tin, method, edges, step=1e-8):
    """One-sided slopes across edges, at a third of their length, on both sides."""
    a, b = tin.points[edges[:, 0], :2], tin.points[edges[:, 1], :2]
    at = a + (b - a) / 3
    normal = np.column_stack([-(b - a)[:, 1], (b - a)[:, 0]])
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    here = tin.interpolate(at, method=method)
    ahead = (tin.interpolate(at + step * normal, method=method) - here) / step
    behind = (here - tin.interpolate(at - step * normal, method=method)) / step
    return ahead, behind


def inner_edges(tin):
    sides = tin.edge_triangles(tin.edges[:, 0], tin.edges[:, 1])
    return tin.edges[(sides >= 0).all(axis=1)]


def test_the_slope_breaks_at_no_edge():
    tin = ts.triangulate(
        raster_points(8) + np.column_stack([rng(1).random((64, 2)) / 3, np.zeros(64)])
    )
    ahead, behind = slopes_across(tin, "c1", inner_edges(tin))
    # Second derivatives are large in slivers: what is left shrinks with the step.
    np.testing.assert_allclose(ahead, behind, atol=1e-4)
    ahead, behind = slopes_across(tin, "linear", inner_edges(tin))
    assert np.abs(ahead - behind).max() > 0.1


def test_beside_a_breakline_the_slope_breaks_at_no_other_edge():
    xy = rng(5).random((100, 2)) * 10
    line = np.array([[1, 2, 0], [6, 4.5, 3], [9.5, 4, 1]], float)
    tin = ts.triangulate(np.column_stack([xy, rng(6).random(100)]), breaklines=[line])
    edges = inner_edges(tin)
    on_line = {tuple(sorted(e)) for e in tin.lines.steps().tolist()}
    is_line = np.array([tuple(sorted(e)) in on_line for e in edges.tolist()])
    ahead, behind = slopes_across(tin, "c1", edges)
    np.testing.assert_allclose(ahead[~is_line], behind[~is_line], atol=3e-4)
    assert np.abs(ahead - behind)[is_line].max() > 0.1


def test_c1_comes_closer_to_a_smooth_surface_than_linear():
    def hills(xy):
        return np.sin(xy[:, 0] / 15) * np.cos(xy[:, 1] / 20)

    points = uniform(3000)
    points[:, 2] = hills(points)
    tin = ts.triangulate(points)
    xy = rng(2).random((5000, 2)) * 80 + 10
    errors = {m: np.sqrt(np.mean((tin.interpolate(xy, method=m) - hills(xy)) ** 2)) for m in PLANAR}
    assert errors["c1"] < 0.4 * errors["linear"]


# ---------------------------------------------------------------- outside


@pytest.mark.parametrize("method", ["linear", "natural", "laplace", "c1"])
def test_outside_the_nearest_place_of_the_boundary_counts(method):
    outer = np.array([(0, 0), (30, 0), (30, 30), (0, 30)], float)
    inner = outer / 3 + 10
    points = np.column_stack([rng(1).random((80, 2)) * 30, rng(2).random(80)])
    tin = ts.triangulate(
        points,
        boundary=np.column_stack([outer, [1, 2, 3, 4]]),
        holes=[np.column_stack([inner, [5, 6, 7, 8]])],
    )
    xy = rng(3).random((400, 2)) * 60 - 15
    outside = tin.locate(xy) < 0
    found = tin.interpolate(xy[outside], method=method, extrapolate="nearest")
    segments = np.concatenate([np.stack([r, np.roll(r, -1)], 1) for r in tin.rings])
    for p, z in zip(xy[outside], found, strict=True):
        a, b = tin.points[segments[:, 0]], tin.points[segments[:, 1]]
        along = b[:, :2] - a[:, :2]
        t = np.clip(((p - a[:, :2]) * along).sum(1) / (along**2).sum(1), 0, 1)
        away = np.hypot(*(a[:, :2] + t[:, None] * along - p).T)
        best = np.argmin(away)
        assert z == pytest.approx(a[best, 2] + t[best] * (b - a)[best, 2], abs=1e-12)
    assert outside.sum() > 200


def test_outside_the_nearest_vertex_counts_for_the_nearest():
    tin = ts.triangulate(uniform(30))
    xy = rng(1).random((50, 2)) * 300 - 100
    found = tin.interpolate(xy, method="nearest", extrapolate="nearest")
    np.testing.assert_array_equal(found, tin.points[tin.closest_vertex(xy), 2])


@pytest.mark.parametrize("method", METHODS)
def test_extrapolation_changes_nothing_inside(method):
    tin = ts.triangulate(uniform(100))
    xy = rng(1).random((300, 2)) * 100
    plain = tin.interpolate(xy, method=method)
    inside = ~np.isnan(plain)
    np.testing.assert_array_equal(
        tin.interpolate(xy, method=method, extrapolate="nearest")[inside], plain[inside]
    )


@pytest.mark.parametrize("method", METHODS)
def test_outside_the_westernmost_of_the_nearest_places_counts(method):
    """In the middle of a hole four places are as near; the order of triangles decided which."""
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(4.0), np.arange(4.0)))
    whole = ts.triangulate(np.column_stack([x, y, np.arange(16.0) ** 2]))
    middles = whole.points[whole.triangles][:, :, :2].mean(axis=1)
    kept = whole.triangles[~(np.abs(middles - 1.5) < 0.5).all(axis=1)]
    places = [[1.5, 1.5], [1.25, 1.5], [-1.0, -1.0], [1.5, -2.0]]
    found = set()
    for seed in range(40):
        order = rng(seed).permutation(16)
        number = np.argsort(order)
        triangles = number[kept[rng(seed).permutation(len(kept))]]
        tin = TIN.from_triangles(whole.points[order], triangles)
        found.add(tuple(tin.interpolate(places, method=method, extrapolate="nearest").tolist()))
    assert len(found) == 1
    (one,) = found
    if method != "c1":
        wanted = [25.0, 25.0, 0.0, 1.0] if method == "nearest" else [53.0, 53.0, 0.0, 2.5]
        assert one == pytest.approx(wanted)


@pytest.mark.parametrize("mirror", ["east", "north"])
def test_places_as_near_by_exact_distances_are_tied(mirror):
    """Of two sides like a roof, whose rounded distances from below its middle differ."""
    places = np.array([[20.0, 500_000.0 + down] for down in np.linspace(0.0, 9.0, 64)])
    roof = [[16, 500_000, 3], [20, 500_012, 0], [20, 500_016, 0], [24, 500_000, 1]]
    points, triangles = np.array(roof, float), [[0, 1, 2], [1, 3, 2]]
    if mirror == "north":
        places, points = places[:, ::-1], points[:, [1, 0, 2]]
        triangles = [one[::-1] for one in triangles]
    tin = TIN.from_triangles(points, triangles)
    share = ((places - points[0, :2]) @ (points[1] - points[0])[:2]) / 160
    wanted = 3 - 3 * share  # on the western or the southern side
    found = tin.interpolate(places, extrapolate="nearest")
    np.testing.assert_allclose(found, wanted, rtol=0, atol=1e-9)


def test_the_nearest_vertex_inside_is_the_westernmost_of_several():
    """Between the points of a lattice, whatever their order."""
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(5.0), np.arange(5.0)))
    points = np.column_stack([x, y, np.arange(25.0)])
    places = np.column_stack([x[x < 4] + 0.5, y[x < 4]])
    for seed in range(10):
        tin = ts.triangulate(points[rng(seed).permutation(25)])
        np.testing.assert_array_equal(tin.interpolate(places, method="nearest"), points[x < 4, 2])
