"""Point location and linear interpolation."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.interpolate import LinearNDInterpolator
from scipy.spatial import Delaunay
from support import oracles
from support.point_sets import places, seeds

import tinsmith as ts
from tinsmith.tin import TIN, PointsError, _kernel
from tinsmith.tin.predicates import LARGEST_ELEVATION

UTM = (500_000.0, 4_000_000.0)


def rng(seed=0):
    return np.random.default_rng(seed)


def uniform_points(n, seed=0, size=1000.0):
    return rng(seed).random((n, 3)) * [size, size, 50.0] + [*UTM, 100.0]


def locate_by_definition(tin, xy):
    """The first triangle with the place on or left of its three edges, by rational numbers."""
    corners = [[oracles.place(tin.points[v]) for v in triangle] for triangle in tin.triangles]
    found = []
    for query in xy:
        p = oracles.place(query)
        holds = (
            t
            for t, (a, b, c) in enumerate(corners)
            if min(oracles.orientation(*e, p) for e in ((a, b), (b, c), (c, a))) >= 0
        )
        found.append(next(holds, -1))
    return found


def height_by_definition(tin, triangle, query):
    """Barycentric interpolation by rational numbers."""
    p = oracles.place(query)
    corners = [oracles.place(tin.points[v]) for v in tin.triangles[triangle]]
    heights = [Fraction(float(tin.points[v, 2])) for v in tin.triangles[triangle]]

    def area(a, b, c):
        return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])

    whole = area(*corners)
    weights = [area(p, corners[(k + 1) % 3], corners[(k + 2) % 3]) for k in range(3)]
    return sum(Fraction(w) / whole * z for w, z in zip(weights, heights, strict=True))


def telling_places(tin):
    """Vertices, edge midpoints, centroids, and places around and beyond the bounds."""
    xy = tin.points[:, :2]
    middles = xy[tin.edges].mean(axis=1)
    centroids = xy[tin.triangles].mean(axis=1)
    b = tin.bounds
    step = max(b.width, b.height) / 4
    around = np.stack(
        np.meshgrid(
            np.linspace(b.xmin - step, b.xmax + step, 7),
            np.linspace(b.ymin - step, b.ymax + step, 7),
        ),
        axis=-1,
    ).reshape(-1, 2)
    return np.concatenate([xy, middles, centroids, around])


def square_ring():
    """A square of side 3 with a square hole of side 1 in its middle."""
    outer = [(0, 0), (3, 0), (3, 3), (0, 3)]
    inner = [(1, 1), (2, 1), (2, 2), (1, 2)]
    points = [(x, y, x + 2 * y) for x, y in outer + inner]
    sides = [((k, (k + 1) % 4, 4 + k), ((k + 1) % 4, 4 + (k + 1) % 4, 4 + k)) for k in range(4)]
    return TIN.from_triangles(points, [t for pair in sides for t in pair])


def comb(n_teeth):
    """Triangular teeth on a common bar: deep notches between them."""
    base = [(2.0 * k, 0.0, 0.0) for k in range(n_teeth + 1)]
    tips = [(2.0 * k + 1.0, 9.0, 1.0) for k in range(n_teeth)]
    foot = [(float(n_teeth), -1.0, 0.0)]
    teeth = [(k, k + 1, n_teeth + 1 + k) for k in range(n_teeth)]
    bar = [(k + 1, k, 2 * n_teeth + 1) for k in range(n_teeth)]
    return TIN.from_triangles(base + tips + foot, teeth + bar)


def two_parts():
    left = [(0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
    right = [(x + 5, y, 2) for x, y, _ in left]
    return TIN.from_triangles(left + right, [(4, 5, 6), (4, 6, 7), (0, 1, 2), (0, 2, 3)])


def parts_that_touch_unconnected():
    """Two surfaces along the line x = 1 that share no vertex number; one has a vertex there."""
    points = [
        *[(0, 0, 0), (1, 0, 0), (1, 2, 0), (0, 2, 0)],
        *[(1, 0, 0), (2, 0, 0), (2, 2, 0), (1, 2, 0), (1, 1, 0)],
    ]
    return TIN.from_triangles(points, [(4, 5, 8), (5, 6, 8), (6, 7, 8), (0, 1, 2), (0, 2, 3)])


SURFACES = {
    "one triangle": lambda: TIN.from_triangles([(0, 0, 1), (4, 0, 2), (0, 4, 3)], [(0, 1, 2)]),
    "ring": square_ring,
    "comb": lambda: comb(9),
    "two parts": two_parts,
    "touching parts": parts_that_touch_unconnected,
    "raster": lambda: ts.triangulate([(x, y, x * y % 5) for x in range(7) for y in range(7)]),
    "utm raster": lambda: ts.triangulate(
        [(UTM[0] + 0.1 * x, UTM[1] + 0.1 * y, x) for x in range(6) for y in range(6)]
    ),
    "random": lambda: ts.triangulate(uniform_points(60, size=1.0)),
    "thin at utm": lambda: ts.triangulate(
        np.c_[UTM[0] + 1e-9 * rng(3).random(40), UTM[1] + 100 * rng(4).random(40), np.arange(40.0)]
    ),
    "huge": lambda: ts.triangulate(rng(5).random((40, 3)) * [1e70, 1e70, 1]),
    "tiny": lambda: ts.triangulate(rng(6).random((40, 3)) * [1e-55, 1e-55, 1]),
    "uneven": lambda: ts.triangulate(
        np.c_[
            10.0 ** rng(7).uniform(-30, 30, 40), 10.0 ** rng(8).uniform(-30, 30, 40), np.zeros(40)
        ]
    ),
}


@pytest.fixture(params=SURFACES, scope="module")
def tin(request):
    return SURFACES[request.param]()


class TestAgainstDefinition:
    def test_the_smallest_triangle_that_holds_the_place(self, tin):
        xy = telling_places(tin)
        np.testing.assert_array_equal(tin.locate(xy), locate_by_definition(tin, xy))

    def test_every_vertex_is_on_the_surface_at_its_own_height(self, tin):
        used = np.unique(tin.triangles)
        np.testing.assert_array_equal(
            tin.interpolate(tin.points[used, :2]), tin.points[used, 2], strict=True
        )

    def test_heights(self, tin):
        xy = telling_places(tin)
        found = tin.locate(xy)
        heights = tin.interpolate(xy)
        np.testing.assert_array_equal(np.isnan(heights), found < 0)
        span = np.ptp(tin.points[:, 2])
        for query, triangle, height in zip(xy, found, heights, strict=True):
            if triangle >= 0:
                expected = float(height_by_definition(tin, triangle, query))
                assert height == pytest.approx(expected, rel=1e-15, abs=1e-11 * span)

    def test_heights_stay_between_those_of_the_corners(self, tin):
        xy = telling_places(tin)
        found = tin.locate(xy)
        inside = found >= 0
        z = tin.points[tin.triangles[found[inside]], 2]
        heights = tin.interpolate(xy)[inside]
        assert (heights >= z.min(axis=1)).all()
        assert (heights <= z.max(axis=1)).all()

    def test_order_and_number_of_places_do_not_matter(self, tin):
        xy = telling_places(tin)
        together = tin.locate(xy)
        shuffle = rng().permutation(len(xy))
        np.testing.assert_array_equal(tin.locate(xy[shuffle]), together[shuffle])
        np.testing.assert_array_equal([tin.locate([p])[0] for p in xy], together)
        heights = tin.interpolate(xy)
        np.testing.assert_array_equal(tin.interpolate(xy[shuffle]), heights[shuffle])
        np.testing.assert_array_equal([tin.interpolate([p])[0] for p in xy], heights)


small_place = st.tuples(st.integers(0, 6), st.integers(0, 6))


@settings(max_examples=150)
@given(
    places(st.integers(0, 6), 20),
    places(st.integers(-1, 13), 40, least=1, unique=False),
    st.sampled_from([(0.0, 1.0), (UTM[0], 1.0), (UTM[0], 0.1), (-3.0, 0.7)]),
)
def test_places_on_a_small_grid(points, queries, frame):
    origin, step = frame
    xyz = [(origin + step * x, origin + step * y, x - y) for x, y in points]
    try:
        tin = ts.triangulate(xyz)
    except PointsError:
        assert oracles.are_collinear(xyz)
        return
    xy = [(origin + step * x / 2, origin + step * y / 2) for x, y in queries]
    np.testing.assert_array_equal(tin.locate(xy), locate_by_definition(tin, xy))


@settings(max_examples=25)
@given(seeds, st.floats(0.1, 0.9))
def test_surface_with_triangles_torn_out(seed, share):
    random = rng(seed)
    whole = ts.triangulate(np.c_[random.integers(0, 12, (50, 2)), np.zeros(50)])
    kept = whole.triangles[random.random(len(whole.triangles)) < share]
    if len(kept) == 0:
        return
    torn = TIN.from_triangles(whole.points, kept)
    xy = random.integers(-1, 25, (80, 2)) / 2
    np.testing.assert_array_equal(torn.locate(xy), locate_by_definition(torn, xy))


class TestAgainstScipy:
    def test_triangles(self):
        points = uniform_points(3000, seed=1) - [*UTM, 0]
        scipy_tin = Delaunay(points[:, :2])
        tin = TIN.from_triangles(points, scipy_tin.simplices)
        xy = rng(2).random((10_000, 2)) * 1100 - 50
        np.testing.assert_array_equal(tin.locate(xy), scipy_tin.find_simplex(xy))

    def test_heights(self):
        points = uniform_points(3000, seed=1) - [*UTM, 0]
        xy = rng(2).random((10_000, 2)) * 1100 - 50
        expected = LinearNDInterpolator(points[:, :2], points[:, 2])(xy)
        np.testing.assert_allclose(
            ts.triangulate(points).interpolate(xy), expected, rtol=0, atol=1e-8
        )


class TestInterpolate:
    def test_plane_at_utm_size(self):
        points = uniform_points(5000)
        away = points[:, :2] - UTM
        points[:, 2] = 0.25 * away[:, 0] - 0.5 * away[:, 1] + 7
        tin = ts.triangulate(points)
        xy = rng(1).random((20_000, 2)) * 1000 + UTM
        heights = tin.interpolate(xy)
        away = xy - UTM
        inside = ~np.isnan(heights)
        assert inside.sum() > 19_000
        expected = 0.25 * away[:, 0] - 0.5 * away[:, 1] + 7
        np.testing.assert_allclose(heights[inside], expected[inside], rtol=0, atol=1e-9)

    def test_level_surface_is_exactly_level(self):
        points = uniform_points(2000)
        points[:, 2] = 123.456
        heights = ts.triangulate(points).interpolate(rng(1).random((5000, 2)) * 900 + UTM + 50)
        assert set(heights.tolist()) == {123.456}

    def test_both_triangles_of_an_edge_agree(self):
        tin = ts.triangulate(uniform_points(500))
        start, end = tin.points[tin.edges[:, 0]], tin.points[tin.edges[:, 1]]
        part = rng(1).random((len(start), 1))
        on_edge = start + part * (end - start)
        heights = tin.interpolate(on_edge[:, :2])
        beyond = np.isnan(heights)  # rounded outwards from an edge of the hull
        assert beyond.sum() <= len(tin.hull)
        np.testing.assert_allclose(heights[~beyond], on_edge[~beyond, 2], rtol=0, atol=1e-7)

    def test_largest_heights_do_not_overflow(self):
        top = LARGEST_ELEVATION
        tin = TIN.from_triangles([(0, 0, -top), (4, 0, top), (0, 4, top)], [(0, 1, 2)])
        assert tin.interpolate([(2, 0), (0, 0), (4, 0)]).tolist() == [0.0, -top, top]


class TestOutside:
    def test_hole_and_rim(self):
        tin = square_ring()
        assert tin.locate([(1.5, 1.5)]).tolist() == [-1]
        assert (tin.locate([(1, 1), (1.5, 1), (2, 1.5), (3, 3), (0, 1.5)]) >= 0).all()
        assert np.isnan(tin.interpolate([(1.5, 1.5), (-1, 0)])).all()

    def test_notches(self):
        tin = comb(50)
        middle = np.arange(50) * 2.0 + 1.0
        assert (tin.locate(np.c_[middle, np.full(50, 8.9)]) == np.arange(50)).all()
        assert (tin.locate(np.c_[middle + 1.0, np.full(50, 0.1)]) == -1).all()

    def test_gap_between_parts(self):
        tin = two_parts()
        assert tin.locate([(0.9, 0.5), (3, 0.5), (5.9, 0.5)]).tolist() == [2, -1, 0]

    def test_one_unit_in_the_last_place_beyond_the_hull(self):
        tin = ts.triangulate([(x, y, 0) for x in range(5) for y in range(5)])
        beyond = np.nextafter(4.0, 5.0)
        assert tin.locate([(4.0, 2.5), (beyond, 2.5)]).tolist()[1] == -1
        assert tin.locate([(4.0, 2.5)])[0] >= 0

    def test_nan_is_nowhere_and_disturbs_no_other(self):
        tin = ts.triangulate(uniform_points(100))
        xy = uniform_points(50, seed=1)[:, :2]
        alone = tin.locate(xy)
        xy_with_nan = np.insert(
            xy, [0, 20, 50], [[np.nan, UTM[1]], [UTM[0], np.nan], [np.nan] * 2], 0
        )
        with_nan = np.isnan(xy_with_nan).any(axis=1)
        found = tin.locate(xy_with_nan)
        assert (found[with_nan] == -1).all()
        np.testing.assert_array_equal(found[~with_nan], alone)
        assert np.isnan(tin.interpolate(xy_with_nan)[with_nan]).all()


class TestUnevenData:
    @pytest.mark.parametrize("kind", ["clusters", "tracks", "spiral", "far outlier"])
    def test_centroids_are_found(self, kind):
        random = rng(9)
        n = 4000
        if kind == "clusters":
            xy = random.random((20, 2))[random.integers(0, 20, n)] * 1e5 + random.normal(
                size=(n, 2)
            )
        elif kind == "tracks":
            xy = np.c_[random.random(n) * 1e4, random.integers(0, 5, n) * 1e3]
            xy[:, 1] += 50 * np.sin(xy[:, 0] / 500)
        elif kind == "spiral":
            turn = np.linspace(0, 60, n)
            xy = np.exp(turn / 4)[:, None] * np.c_[np.cos(turn), np.sin(turn)]
        else:
            xy = random.random((n, 2)) * 1e-9
            xy[0] = 1e9
        tin = ts.triangulate(np.c_[xy, np.zeros(n)])
        centroids = tin.points[tin.triangles, :2].mean(axis=1)
        found = tin.locate(centroids)
        # The mean of a sliver's corners may be rounded out of it: compare where they differ.
        differ = np.flatnonzero(found != np.arange(len(found)))
        assert len(differ) < 0.02 * len(found)
        some = differ[:: max(1, len(differ) // 3)]
        np.testing.assert_array_equal(found[some], locate_by_definition(tin, centroids[some]))


class TestInput:
    @pytest.mark.parametrize("query", ["locate", "interpolate"])
    def test_nothing_asked(self, query):
        tin = ts.triangulate(uniform_points(10))
        assert getattr(tin, query)(np.empty((0, 2))).shape == (0,)

    @pytest.mark.parametrize(
        ("query", "xy"),
        [
            ("locate", (0.0, 0.0)),  # for interpolate it is one place
            *[(q, xy) for q in ("locate", "interpolate") for xy in ([[0, 0, 0]], [[[0, 0]]], 3.0)],
        ],
    )
    def test_wrong_shape(self, query, xy):
        tin = ts.triangulate(uniform_points(10))
        with pytest.raises(PointsError, match=r"\(k, 2\) is needed"):
            getattr(tin, query)(xy)

    @pytest.mark.parametrize("value", [np.inf, -np.inf, 1e80, 1e-70])
    def test_out_of_range(self, value):
        tin = ts.triangulate(uniform_points(10))
        with pytest.raises(PointsError, match="exact range"):
            tin.locate([(0, 0), (value, 0)])

    def test_types_and_layouts(self):
        tin = ts.triangulate([(x, y, x) for x in range(9) for y in range(9)])
        xy = rng(1).integers(-1, 10, (30, 2))
        expected = tin.locate(xy.astype(float))
        assert expected.dtype == np.int32
        assert tin.interpolate(xy).dtype == np.float64
        for given_xy in (xy, xy.tolist(), np.asfortranarray(xy, float), xy.astype(np.float32)):
            np.testing.assert_array_equal(tin.locate(given_xy), expected)


class TestUnsoundSurface:
    """A surface damaged behind the library's back may answer oddly, but answers."""

    points = np.array([(x, y, 0) for x in range(6) for y in range(6)], np.float64)

    def whole(self):
        tin = ts.triangulate(self.points)
        return tin.points, tin.triangles.copy(), tin.neighbors.copy()

    def xy(self):
        return rng(1).random((500, 2)) * 7 - 1

    @pytest.mark.parametrize("seed", range(5))
    def test_neighbors_that_lie_do_not_matter(self, seed):
        points, triangles, neighbors = self.whole()
        lies = rng(seed).integers(-(2**31), 2**31, neighbors.shape, np.int32)
        lies[::2] = rng(seed).integers(0, len(triangles), lies[::2].shape)
        sound = _kernel.Locator(points, triangles, neighbors).locate(self.xy())
        found = _kernel.Locator(points, triangles, lies).locate(self.xy())
        np.testing.assert_array_equal(found, sound)

    def test_neighbors_in_a_circle(self):
        points, triangles, neighbors = self.whole()
        neighbors[:] = (np.arange(len(triangles)) ^ 1)[:, None]
        found = _kernel.Locator(points, triangles, neighbors).locate(self.xy())
        np.testing.assert_array_equal(found, ts.triangulate(self.points).locate(self.xy()))

    def test_triangles_without_area_hold_nothing(self):
        points = np.array([(0, 0, 0), (1, 1, 0), (2, 2, 0), (2, 0, 0)], np.float64)
        triangles = np.array([(0, 1, 2), (1, 1, 1), (0, 3, 2)], np.int32)
        locator = _kernel.Locator(points, triangles, np.full((3, 3), -1, np.int32))
        assert locator.locate(np.array([(1.0, 1.0), (3.0, 3.0)])).tolist() == [2, -1]

    @pytest.mark.parametrize("vertex", [-1, 36, 2**31 - 1])
    def test_corners_out_of_range(self, vertex):
        points, triangles, neighbors = self.whole()
        triangles[7, 1] = vertex
        with pytest.raises(ValueError, match="vertex numbers from 0 to n - 1"):
            _kernel.Locator(points, triangles, neighbors)

    def test_neighbors_of_another_surface(self):
        points, triangles, neighbors = self.whole()
        with pytest.raises(ValueError, match="same number of rows"):
            _kernel.Locator(points, triangles, neighbors[1:])

    def test_no_triangles(self):
        none = np.empty((0, 3), np.int32)
        locator = _kernel.Locator(np.empty((0, 3)), none, none)
        assert locator.locate(np.zeros((2, 2))).tolist() == [-1, -1]

    @pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf, 1e100])
    def test_coordinates_out_of_range(self, value):
        points, triangles, neighbors = self.whole()
        points = points.copy()
        points[20, 1] = value
        with pytest.raises(ValueError, match="within the exact range"):
            _kernel.Locator(points, triangles, neighbors)


def test_threads_share_one_surface():
    tin = ts.triangulate(uniform_points(5000))
    xy = uniform_points(40_000, seed=1)[:, :2]
    expected = tin.locate(xy)
    with ThreadPoolExecutor(4) as pool:
        for found in pool.map(tin.locate, [xy] * 8):
            np.testing.assert_array_equal(found, expected)


def test_elevations_in_needles_stay_within_those_of_their_corners():
    """Rounded weights must not lift a place above the highest corner of its triangle."""
    rng = np.random.default_rng(11)
    n_inside = 0
    for _ in range(300):
        base = rng.random(2) * 1e5 if rng.random() < 0.5 else rng.random(2)
        way = rng.random(2) * 10.0 ** rng.integers(-3, 3)
        far = base + way
        third = base + way * rng.random() + rng.integers(-9, 10, 2) * np.spacing(base)
        level = rng.choice([0.1, 1 / 3, 318.37, 1e4 / 7])
        elevations = level + rng.integers(0, 2, 3) * rng.choice([0.0, 0.1, 1e-13])
        try:
            tin = ts.triangulate(np.column_stack([[base, far, third], elevations]))
        except PointsError:
            continue
        weights = rng.dirichlet([0.3] * 3, 200)
        found = tin.interpolate(weights @ tin.points[:, :2])
        found = found[np.isfinite(found)]
        n_inside += len(found)
        assert (found >= elevations.min()).all()
        assert (found <= elevations.max()).all()
    assert n_inside > 1000
