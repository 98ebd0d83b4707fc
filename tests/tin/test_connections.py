"""Vertices, edges and normals of a TIN: what they answer, beside answers by brute force."""

from fractions import Fraction

import numpy as np
import pytest

import tinsmith as ts
from tinsmith import TIN, CrsError, PointsError

SQUARE = [[0, 0, 1], [4, 0, 2], [4, 4, 3], [0, 4, 4]]


def random_tin(seed, n=60, **options):
    rng = np.random.default_rng(seed)
    return ts.triangulate(rng.integers(0, 20, (n, 3)).astype(float), duplicates="first", **options)


def lattice(n=7):
    x, y = np.meshgrid(np.arange(n), np.arange(n))
    return np.column_stack([x.ravel(), y.ravel(), (x * y).ravel()]).astype(float)


def two_parts():
    """Two squares that touch in vertex 2, a third apart, and a vertex that no triangle has."""
    points = [*SQUARE, [8, 4, 0], [8, 8, 0], [4, 8, 0], [20, 0, 0], [24, 0, 0], [20, 4, 0]]
    triangles = [[0, 1, 2], [0, 2, 3], [2, 4, 5], [2, 5, 6], [7, 8, 9]]
    return TIN.from_triangles([*points, [12, 12, 5]], triangles)


def at_utm():
    points = np.random.default_rng(3).random((80, 3)) + np.array([500_000.0, 4_000_000.0, 0])
    return ts.triangulate(points)


TINS = {
    "uniform": lambda: random_tin(0),
    "another": lambda: random_tin(1, 200),
    "lattice": lambda: ts.triangulate(lattice()),
    "UTM": lambda: at_utm(),
    "breakline": lambda: random_tin(2, breaklines=[[[1, 1.5, 0], [18, 17.5, 0]]]),
    "hole": lambda: random_tin(3, 150, holes=[[[5, 5], [14, 5], [14, 14], [5, 14]]]),
    "parts": lambda: two_parts(),
    "fan": lambda: ts.triangulate(
        [[0, 0, 0], *([np.cos(a), np.sin(a), 1] for a in np.arange(0, 6.2, 0.1))]
    ),
    "one": lambda: TIN.from_triangles(SQUARE[:3], [[0, 1, 2]]),
}
each = pytest.mark.parametrize("tin", TINS, indirect=True)


@pytest.fixture
def tin(request):
    return TINS[request.param]()


def places_about(tin):
    """Vertices, middles of triangles and edges, ties of a lattice, and places far outside."""
    rng = np.random.default_rng(5)
    box, xy = tin.bounds, tin.points[:, :2]
    low, size = (box.xmin, box.ymin), (box.width, box.height)
    return np.concatenate(
        [
            xy,
            xy[tin.triangles].mean(axis=1),
            xy[tin.edges].mean(axis=1),
            low + rng.random((100, 2)) * size,
            low + (rng.random((100, 2)) * 9 - 4) * size,
            low + (rng.random((30, 2)) * 9e6 - 4e6) * size,
        ]
    )


def nearest_by_force(points, places):
    """Return the nearest by rational numbers, among those that doubles do not rule out."""
    found = []
    for x, y in places.tolist():
        away = np.hypot(points[:, 0] - x, points[:, 1] - y)
        near = np.flatnonzero(away <= away.min() * (1 + 1e-9))
        exact = [
            (Fraction(a) - Fraction(x)) ** 2 + (Fraction(b) - Fraction(y)) ** 2
            for a, b in points[near, :2].tolist()
        ]
        found.append(int(near[exact.index(min(exact))]))
    return found


@each
def test_closest_vertex_is_the_first_of_the_nearest(tin):
    places = places_about(tin)
    assert tin.closest_vertex(places).tolist() == nearest_by_force(tin.points, places)


def test_closest_vertex_of_many_at_one_distance():
    """Twelve points of one circle, in every order, around a place as far from all of them."""
    circle = {(x * a, y * b) for x, y in ((3, 4), (4, 3), (5, 0), (0, 5))
              for a in (1, -1) for b in (1, -1)}  # fmt: skip
    for seed in range(10):
        xy = np.random.default_rng(seed).permutation(sorted(circle))
        far = [[9 + seed, 9, 0], [-9, 9, 0]]
        tin = ts.triangulate([*far, *np.column_stack([xy, xy[:, 0]])])
        assert tin.closest_vertex([[0, 0]]).tolist() == [2]


def test_closest_vertex_of_several_at_one_place_is_the_first():
    tin = TIN.from_triangles([*SQUARE[:3], *SQUARE[:3], SQUARE[3]], [[3, 4, 5], [3, 5, 6]])
    assert tin.closest_vertex([[0, 0], [3.5, 0.5], [0, 4]]).tolist() == [0, 1, 6]


def test_closest_vertex_where_doubles_cannot_tell():
    """Both squared distances round to the same double; the exact ones differ."""
    step = 2.0**-40
    tin = ts.triangulate([[1.0, 0, 0], [-1.0 - step, 0, 0], [0, 3, 0]])
    places = [[0.0, 1e-3], [-(2.0**-42), 1e9], [-(2.0**-41), 0.0], [-(2.0**-40), 0.0]]
    assert tin.closest_vertex(places[2:]).tolist() == [0, 1]
    assert tin.closest_vertex(places).tolist() == nearest_by_force(tin.points, np.array(places))


def test_closest_vertex_follows_edits():
    tin = ts.triangulate(SQUARE)
    assert tin.closest_vertex([[2.5, 1.5]]).tolist() == [1]
    tin.insert([[2, 1, 0]])
    assert tin.closest_vertex([[2.5, 1.5]]).tolist() == [4]


@each
def test_vertex_triangles_are_all_and_in_order(tin):
    for vertex in range(len(tin.points)):
        around = tin.vertex_triangles(vertex)
        holds = np.flatnonzero((tin.triangles == vertex).any(axis=1))
        assert sorted(around.tolist()) == holds.tolist()
        assert around.dtype == np.int32
        assert not around.flags.writeable
        assert_counter_clockwise(tin, vertex, around)


def assert_counter_clockwise(tin, vertex, around):
    """Each triangle is followed by the one across its second edge, if there is one."""
    for one, following in zip(around.tolist(), np.roll(around, -1).tolist(), strict=True):
        corner = tin.triangles[one].tolist().index(vertex)
        across = tin.neighbors[one, (corner + 1) % 3]
        assert across in (-1, following)


@each
def test_vertex_neighbors_are_all_and_in_order(tin):
    joined = {vertex: set() for vertex in range(len(tin.points))}
    for a, b in tin.edges.tolist():
        joined[a].add(b)
        joined[b].add(a)
    for vertex, expected in joined.items():
        neighbors = tin.vertex_neighbors(vertex)
        assert len(neighbors) == len(expected)
        assert set(neighbors.tolist()) == expected
        assert not neighbors.flags.writeable


@each
def test_neighbors_of_a_vertex_inside_turn_counter_clockwise(tin):
    boundary = set(np.concatenate(tin.rings).tolist())
    for vertex in sorted(set(tin.triangles.ravel().tolist()) - boundary):
        ring = tin.points[tin.vertex_neighbors(vertex), :2]
        angle = np.unwrap(np.arctan2(*(ring - tin.points[vertex, :2]).T[::-1]))
        assert (np.diff(angle) > 0).all()
        assert angle[-1] - angle[0] < 2 * np.pi


def test_where_parts_touch_one_comes_after_the_other():
    tin = two_parts()
    assert tin.vertex_triangles(2).tolist() == [1, 0, 2, 3]
    assert tin.vertex_neighbors(2).tolist() == [3, 0, 1, 4, 5, 6]
    assert tin.vertex_triangles(10).tolist() == []
    assert tin.vertex_neighbors(10).tolist() == []


@each
def test_edges_and_their_triangles(tin):
    n = len(tin.points)
    left = np.full((n, n), -1)
    for number, (a, b, c) in enumerate(tin.triangles.tolist()):
        left[a, b] = left[b, c] = left[c, a] = number
    a, b = np.mgrid[:n, :n]
    sides = tin.edge_triangles(a, b)
    assert np.array_equal(sides, np.stack([left, left.T], axis=-1))
    assert np.array_equal(tin.is_edge(a, b), (left >= 0) | (left.T >= 0))
    assert sides.dtype == np.int32
    assert not sides.flags.writeable


def test_edges_take_single_vertices_and_none():
    tin = TINS["one"]()
    assert tin.is_edge(0, 1).shape == ()
    assert tin.is_edge(0, [1, 2]).tolist() == [True, True]
    assert tin.is_edge(1, 1) == np.False_
    assert tin.is_edge([], []).shape == (0,)
    assert tin.edge_triangles(np.zeros((0,), int), 2).shape == (0, 2)


@each
def test_normals_stand_on_their_triangles(tin):
    normals = tin.triangle_normals
    corners = tin.points[tin.triangles]
    for k in range(3):
        side = corners[:, (k + 1) % 3] - corners[:, k]
        assert np.abs((normals * side).sum(axis=1)).max() <= 1e-7 * np.abs(side).max()
    assert np.linalg.norm(normals, axis=1) == pytest.approx(1)
    assert (normals[:, 2] > 0).all()
    assert np.degrees(np.arccos(normals[:, 2])) == pytest.approx(ts.slope(tin), abs=1e-5)
    assert not normals.flags.writeable


@each
def test_vertex_normals_are_means_by_area(tin):
    weighted = tin.triangle_normals * tin.triangle_surface_areas[:, None]
    for vertex, normal in enumerate(tin.vertex_normals):
        holds = (tin.triangles == vertex).any(axis=1)
        total = weighted[holds].sum(axis=0)
        if holds.any():
            assert normal == pytest.approx(total / np.linalg.norm(total), abs=1e-9)
        else:
            assert np.isnan(normal).all()


def test_normals_convert_elevations():
    points = [[0, 0, 0], [1, 0, 1], [0, 1, 0]]
    metres = TIN.from_triangles(points, [[0, 1, 2]], crs=32616, elevation_unit="m")
    feet = TIN.from_triangles(
        np.array(points) / (1, 1, 0.3048), [[0, 1, 2]], crs=32616, elevation_unit="ft"
    )
    assert metres.triangle_normals == pytest.approx(feet.triangle_normals)
    assert metres.vertex_normals == pytest.approx(feet.vertex_normals)
    degrees = TIN.from_triangles(points, [[0, 1, 2]], crs=4326)
    for name in ("triangle_normals", "vertex_normals"):
        with pytest.raises(CrsError, match="angles"):
            getattr(degrees, name)


@pytest.mark.parametrize("size", [1e-50, 1e75])
@pytest.mark.parametrize("rise", [0.0, 1e-300, 1.0, 1e300])
def test_normals_of_extreme_coordinates(size, rise):
    tin = TIN.from_triangles([[0, 0, 0], [size, 0, rise], [0, size, 0]], [[0, 1, 2]])
    slope = np.arctan2(rise, size)
    expected = [[-np.sin(slope), 0, np.cos(slope)]]
    assert tin.triangle_normals == pytest.approx(np.array(expected), abs=1e-12)
    assert tin.vertex_normals == pytest.approx(np.array(expected * 3), abs=1e-12)


@pytest.mark.parametrize("vertex", [-1, 4, 2**70, 1.0, True, "a", None, [1], np.array([0, 1])])
def test_what_is_no_vertex_is_refused(vertex):
    tin = TIN.from_triangles(SQUARE, [[0, 1, 2], [0, 2, 3]])
    for ask in (tin.vertex_triangles, tin.vertex_neighbors):
        with pytest.raises(PointsError, match="vertex"):
            ask(vertex)


@pytest.mark.parametrize(
    ("a", "b"),
    [(0, 4), ([0, -1], 1), (0.5, 1), ("a", 1), (None, 1), ([[0], [1, 2]], 0), (2**70, 1),
     (True, 1), ([0, 1, 2], [0, 1]), (np.ma.array([0, 1], mask=[0, 1]), 1)],
)  # fmt: skip
def test_what_are_no_edges_is_refused(a, b):
    tin = TIN.from_triangles(SQUARE, [[0, 1, 2], [0, 2, 3]])
    for ask in (tin.is_edge, tin.edge_triangles):
        with pytest.raises(PointsError, match=r"[Vv]ert"):
            ask(a, b)


@pytest.mark.parametrize("ask", ["locate", "interpolate", "closest_vertex"])
@pytest.mark.parametrize("none", [[], (), np.empty((0, 2)), np.empty(0)], ids=str)
def test_no_places_have_no_answers(ask, none):
    assert getattr(TINS["one"](), ask)(none).shape == (0,)


@pytest.mark.parametrize("ask", ["locate", "interpolate", "closest_vertex"])
@pytest.mark.parametrize(
    "wrong", [[1, 2, 3], [[1, 2, 3]], [["a", "b"]], [[np.inf, 0]], [[1e80, 0]], 7.0]
)
def test_what_are_no_queries_is_refused(ask, wrong):
    with pytest.raises(PointsError, match="Query points"):
        getattr(TINS["one"](), ask)(wrong)


def test_a_place_of_no_number_has_no_closest_vertex():
    places = np.ma.array([[0.0, 0.0], [4.0, 4.0]], mask=[[1, 0], [0, 0]])
    assert TINS["one"]().closest_vertex([[np.nan, 1], [1, np.nan], [4, 1]]).tolist() == [-1, -1, 1]
    assert TINS["one"]().closest_vertex(places).tolist() == [-1, 2]
