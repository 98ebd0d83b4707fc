"""Voronoi cells against half-planes cut one by one, SciPy, GEOS, and nearest neighbours."""

from __future__ import annotations

from collections import Counter
from fractions import Fraction

import numpy as np
import pytest
import scipy.spatial
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from support.point_sets import places

from tinsmith import TIN, Bounds, LinesError, OptionError, triangulate

UTM = np.array([742_000.0, 4_030_000.0])


def flat(xy):
    xy = np.asarray(xy, float)
    return np.column_stack([xy, np.zeros(len(xy))])


def scattered(n=400, seed=3, size=100.0):
    return np.random.default_rng(seed).uniform(0, size, (n, 2)) + UTM


def grid(columns, rows, spacing=1.0, corner=(0.0, 0.0)):
    x, y = np.meshgrid(np.arange(columns), np.arange(rows))
    return np.column_stack([x.ravel(), y.ravel()]) * spacing + corner


def circle(n, radius=1.0):
    turn = np.linspace(0, 2 * np.pi, n, endpoint=False)
    return radius * np.column_stack([np.cos(turn), np.sin(turn)])


def rings(diagram):
    return [
        diagram.coords[begin:end]
        for begin, end in zip(diagram.offsets[:-1], diagram.offsets[1:], strict=True)
    ]


def cut_exactly(points, corners):
    """The cell of each point: the corners' polygon cut by every bisector, in fractions."""
    places = [(Fraction(float(x)), Fraction(float(y))) for x, y in points]
    region = [(Fraction(float(x)), Fraction(float(y))) for x, y in corners]
    cells = []
    for i, (px, py) in enumerate(places):
        cell = region
        for j, (qx, qy) in enumerate(places):
            if i != j:
                nx, ny = qx - px, qy - py
                limit = nx * (px + qx) / 2 + ny * (py + qy) / 2
                cell = cut_by(cell, nx, ny, limit)
        cells.append(cell)
    return cells


def cut_by(cell, nx, ny, limit):
    """The part of a convex polygon where nx x + ny y <= limit."""
    kept = []
    for (ax, ay), (bx, by) in zip(cell, cell[1:] + cell[:1], strict=True):
        a, b = nx * ax + ny * ay - limit, nx * bx + ny * by - limit
        if a <= 0:
            kept.append((ax, ay))
        if (a < 0 < b) or (b < 0 < a):
            t = a / (a - b)
            kept.append((ax + t * (bx - ax), ay + t * (by - ay)))
    return kept


def exact_area(cell):
    pairs = zip(cell, cell[1:] + cell[:1], strict=True)
    return float(sum(ax * by - ay * bx for (ax, ay), (bx, by) in pairs) / 2)


def assert_sound(diagram, points):
    """Rings convex, counter-clockwise, without repeats, each with its vertex; they fill the box."""
    box = shapely.Polygon(diagram.boundary)
    size = max(box.bounds[2] - box.bounds[0], box.bounds[3] - box.bounds[1])
    tolerance = 1e-13 * size + 4 * np.spacing(np.abs(diagram.boundary).max())
    assert diagram.areas.sum() == pytest.approx(box.area, rel=1e-11)
    for ring, (x, y) in zip(rings(diagram), np.asarray(points)[:, :2], strict=True):
        assert len(ring) >= 3
        step = np.roll(ring, -1, axis=0) - ring
        length = np.hypot(*step.T)
        assert (length > 0).all()
        to_vertex = np.array([x, y]) - ring
        side = step[:, 0] * to_vertex[:, 1] - step[:, 1] * to_vertex[:, 0]
        assert (side >= -tolerance * (length + np.hypot(*to_vertex.T))).all()


def assert_nearest(diagram, points, count=2000, seed=5):
    """Random places lie in the cell of the vertex nearest to them."""
    box = shapely.Polygon(diagram.boundary).bounds
    places = np.random.default_rng(seed).uniform(box[:2], box[2:], (count, 2))
    nearest = scipy.spatial.cKDTree(points).query(places)[1]
    held = shapely.covers(diagram.to_shapely()[nearest], shapely.points(places))
    assert held.all()


# ------------------------------------------------------------------ second opinions


@settings(max_examples=25)
@given(
    places(st.integers(0, 6), 14),
    st.sampled_from([0, 1, 2.5]),
)
def test_cells_on_small_grids_are_those_cut_by_every_bisector(places, pad):
    points = np.array(places, float)
    if np.linalg.matrix_rank(points - points[0]) < 2:
        return
    diagram = triangulate(flat(points)).voronoi(pad=pad)
    exact = cut_exactly(points, diagram.boundary)
    np.testing.assert_allclose(diagram.areas, [exact_area(cell) for cell in exact], atol=1e-12)
    for ring, cell in zip(rings(diagram), exact, strict=True):
        corners = np.array(cell, float)
        far = np.hypot(*(ring[:, None] - corners[None]).T)
        assert far.min(axis=0).max() < 1e-12
        assert far.min(axis=1).max() < 1e-12
    assert_sound(diagram, points)


def test_cells_at_utm_coordinates_are_those_cut_exactly():
    points = scattered(40)
    diagram = triangulate(flat(points)).voronoi()
    exact = [exact_area(cell) for cell in cut_exactly(points, diagram.boundary)]
    np.testing.assert_allclose(diagram.areas, exact, rtol=0, atol=1e-7)


def test_corners_of_bounded_cells_are_scipys():
    points = scattered(500) - UTM
    diagram = triangulate(flat(points)).voronoi(pad=1e6)
    peer = scipy.spatial.Voronoi(points)
    compared = 0
    for ring, region in zip(rings(diagram), peer.point_region, strict=True):
        corners = peer.regions[region]
        if -1 in corners or np.abs(peer.vertices[corners]).max() > 1e5:
            continue
        theirs = peer.vertices[corners]
        assert len(ring) == len(theirs)
        np.testing.assert_allclose(
            ring[np.lexsort(ring.T)], theirs[np.lexsort(theirs.T)], rtol=1e-7
        )
        compared += 1
    assert compared > 450


def test_areas_are_those_of_geos():
    points = scattered(300)
    diagram = triangulate(flat(points)).voronoi(pad=5)
    box = shapely.Polygon(diagram.boundary)
    cells = shapely.voronoi_polygons(shapely.MultiPoint(points), extend_to=box, ordered=True)
    theirs = shapely.area(shapely.intersection(shapely.get_parts(cells), box))
    np.testing.assert_allclose(diagram.areas, theirs, rtol=1e-6)


def test_edges_of_the_triangulation_join_the_cells_that_share_a_side():
    points = scattered(120)
    tin = triangulate(flat(points))
    cells = tin.voronoi(pad=1e4).to_shapely()
    pairs = shapely.STRtree(cells).query(cells, predicate="intersects").T
    one, other = pairs[pairs[:, 0] < pairs[:, 1]].T
    sides = shapely.length(shapely.intersection(cells[one], cells[other]))
    sharing = {tuple(pair) for pair in np.stack([one, other], axis=1)[sides > 1e-6].tolist()}
    assert sharing <= {tuple(sorted(edge)) for edge in tin.edges.tolist()}
    # Cells of a hull edge may meet beyond the boundary only.
    missing = {tuple(sorted(edge)) for edge in tin.edges.tolist()} - sharing
    on_hull = set(tin.hull.tolist())
    assert all(set(edge) <= on_hull for edge in missing)


CASES = {
    "scattered": scattered(),
    "raster": grid(20, 15, 10.0, UTM),
    "raster of tenths": grid(12, 12, 0.1, UTM),
    "clusters": np.concatenate(
        [scattered(60, seed, 1e-2) + np.array([seed * 50, 0]) for seed in range(6)]
    ),
    "one far outlier": np.concatenate([scattered(50), [UTM + 1e6]]),
    "two rails": np.concatenate([grid(60, 1), grid(60, 1, 1.0, (0.37, 1e-3))]),
    "circle": circle(64),
    "circle and its centre": np.concatenate([circle(64), [[0, 0]]]),
    "star of degree 500": np.concatenate([circle(500, 100.0), [[3.0, 4.0]]]),
    "hull with collinear points": np.concatenate([grid(9, 1), [[4.0, 5.0], [4.0, 1.0]]]),
    "nearly collinear": np.concatenate([grid(9, 1), [[4.5, 1e-9]]]),
    "survey tracks": np.concatenate([grid(200, 1, 0.05), grid(200, 1, 0.05, (0.01, 30.0))]),
}


@pytest.mark.parametrize("pad", [0.0, None])
@pytest.mark.parametrize("name", CASES)
def test_cells_hold_what_is_nearest(name, pad):
    points = CASES[name]
    diagram = triangulate(flat(points)).voronoi(pad=pad)
    assert_sound(diagram, points)
    assert_nearest(diagram, points)


@pytest.mark.parametrize("scale", [1e-9, 1e9])
def test_scaled_points_have_scaled_cells(scale):
    points = scattered(100) - UTM
    areas = triangulate(flat(points)).voronoi(pad=0).areas
    scaled = triangulate(flat(points * scale)).voronoi(pad=0).areas
    np.testing.assert_allclose(scaled / scale**2, areas, rtol=1e-6)


# ------------------------------------------------------------------ tiling


def assert_tiles(diagram):
    """Two cells walk each side, once each way; sides that only one walks lie on the box."""
    low, high = diagram.boundary.min(axis=0), diagram.boundary.max(axis=0)
    walks = Counter(
        (tuple(a), tuple(b))
        for ring in rings(diagram)
        for a, b in zip(ring.tolist(), np.roll(ring, -1, axis=0).tolist(), strict=True)
    )
    for (a, b), times in walks.items():
        on_wall = any(a[k] == b[k] and a[k] in (low[k], high[k]) for k in range(2))
        assert on_wall or walks[b, a] == times
    assert (diagram.areas >= 0).all()
    assert diagram.areas.sum() == pytest.approx(np.prod(high - low), rel=1e-12)


ULP = np.spacing(1.0)
HARD = {
    "two hull vertices a rounding apart": [
        [-0.18787969354847417, 1.4601214758378258],
        [1.1206314478250745, 0.3921423623286639],
        [1.1206314478250745, 0.39214236232866406],
    ],
    "four vertices a rounding apart": [
        [1, 1], [1 + ULP, 1], [1, 1 + ULP], [1 + ULP, 1 + ULP], [7, 3], [2, 9]
    ],
    "one flat triangle": [[0, 0], [1, 1 / 3], [2, np.nextafter(2 / 3, 1)]],
    "on a slanted line but for rounding": [[x / 7, x / 21] for x in range(12)],
    "on a line but for one": [[0, 0], [1, 1], [2, 2], [3, 3], [0, 1e-12]],
    "on a circle but for rounding": circle(12, 1 / 3),
    "a raster of tenths at UTM size": grid(4, 3, 0.1, UTM),
    "from the tiny to the huge": [[1e-55, 0], [3, 1e-50], [1e40, 2e40], [-7e60, 5], [0, -1e60]],
    "on the box, with a corner where four meet": [[0, 0], [2, 0], [2, 2], [0, 2]],
    "whose circumcentre is a corner of the box": [[0, 1], [1, 0], [4, 1], [1, 4]],
}  # fmt: skip


@pytest.mark.parametrize("pad", [0.0, None])
@pytest.mark.parametrize("name", HARD)
def test_cells_tile_the_box_and_are_the_exact_ones_rounded(name, pad):
    points = np.asarray(HARD[name], float)
    diagram = triangulate(flat(points)).voronoi(pad=pad)
    assert_tiles(diagram)
    rounding = 8 * np.spacing(np.abs(diagram.boundary).max())
    perimeter = 2 * np.ptp(diagram.boundary, axis=0).sum()
    for ring, area, cell in zip(
        rings(diagram), diagram.areas, cut_exactly(points, diagram.boundary), strict=True
    ):
        assert abs(area - exact_area(cell)) <= rounding * perimeter
        corners = np.array([[float(x), float(y)] for x, y in cell])
        for corner in ring:
            assert np.abs(corners - corner).max(axis=1).min() <= rounding


@pytest.mark.parametrize("name", [*CASES])
@pytest.mark.parametrize("pad", [0.0, None])
def test_cells_tile_the_box(name, pad):
    assert_tiles(triangulate(flat(CASES[name])).voronoi(pad=pad))


def test_corners_are_the_doubles_nearest_to_the_exact_ones_where_the_box_cuts():
    points = scattered(9, 11)
    diagram = triangulate(flat(points)).voronoi(pad=0)
    for ring, cell in zip(rings(diagram), cut_exactly(points, diagram.boundary), strict=True):
        assert set(map(tuple, ring.tolist())) <= {(float(x), float(y)) for x, y in cell}


def test_a_hull_vertex_with_thousands_of_neighbours_takes_no_quadratic_time():
    turn = np.linspace(0.1, 1.4, 4000)
    arc = 100 * np.column_stack([np.cos(turn), np.sin(turn)])
    diagram = triangulate(flat(np.concatenate([[[0.3, 0.2]], arc]))).voronoi()
    assert_tiles(diagram)
    assert np.diff(diagram.offsets)[0] > 3000


# ------------------------------------------------------------------ ties


def test_cells_of_a_raster_are_squares_that_share_their_corners():
    diagram = triangulate(flat(grid(5, 4))).voronoi(pad=0.5)
    np.testing.assert_array_equal(diagram.areas, 1.0)
    np.testing.assert_array_equal(np.diff(diagram.offsets), 4)
    assert len(np.unique(diagram.coords, axis=0)) == 6 * 5


def test_cocircular_points_share_one_corner():
    points = [[5, 0], [4, 3], [3, 4], [0, 5], [-3, 4], [-5, 0], [-4, -3], [0, -5], [4, -3]]
    diagram = triangulate(flat(points)).voronoi()
    at_centre = (diagram.coords == 0).all(axis=1)
    np.testing.assert_array_equal(np.add.reduceat(at_centre, diagram.offsets[:-1]), 1)


@settings(max_examples=200)
@given(st.integers(1, 500), st.integers(1, 500), st.integers(1, 500))
def test_the_four_cells_of_a_trapezoid_have_one_corner_though_it_is_rounded(half, more, height):
    """Symmetric trapezoids are cocircular; the centre's northing is a fraction of any kind."""
    low, high = half + more, half
    points = np.array([[-low, 0], [low, 0], [high, height], [-high, height]])
    diagram = triangulate(flat(points)).voronoi(pad=1e6)
    wall = (np.abs(diagram.coords) > 5e5).any(axis=1)
    assert len(np.unique(diagram.coords[~wall], axis=0)) == 1
    np.testing.assert_array_equal(np.add.reduceat(~wall, diagram.offsets[:-1]), 1)


# ------------------------------------------------------------------ the smallest


def test_three_points():
    diagram = triangulate([[0, 0, 0], [2, 0, 0], [0, 2, 0]]).voronoi(pad=1)
    assert len(diagram) == 3
    np.testing.assert_allclose(diagram.areas, [4, 6, 6])
    assert repr(diagram) == "<Voronoi: 3 cells, 12 corners, area 16>"


def test_default_pad_is_a_tenth_of_the_longer_side():
    diagram = triangulate([[0, 0, 0], [20, 0, 0], [0, 10, 0]]).voronoi()
    np.testing.assert_array_equal(diagram.boundary, [[-2, -2], [22, -2], [22, 12], [-2, 12]])


def test_arrays_are_read_only():
    diagram = triangulate([[0, 0, 0], [2, 0, 0], [0, 2, 0]]).voronoi()
    names = ("coords", "offsets", "part_offsets", "boundary", "areas")
    assert not any(getattr(diagram, name).flags.writeable for name in names)


# ------------------------------------------------------------------ which points


def test_constraints_clipping_and_other_triangles_have_no_part():
    points = flat(scattered(60))
    plain = triangulate(points)
    x, y = plain.bounds.center
    ring = [[x - 30, y - 30], [x + 30, y - 30], [x + 30, y + 30]]
    lined = triangulate(points, boundary=[ring])
    expected = triangulate(lined.points).voronoi(pad=3)
    np.testing.assert_array_equal(lined.voronoi(pad=3).coords, expected.coords)
    np.testing.assert_array_equal(lined.voronoi(pad=3).offsets, expected.offsets)


def test_the_first_of_several_vertices_at_one_place_has_the_cell():
    points = [[0, 0, 1], [4, 0, 1], [4, 0, 2], [0, 4, 1], [0, 0, 3], [4, 4, 9]]
    tin = TIN.from_triangles(points, [[0, 1, 3]])
    diagram = tin.voronoi(pad=0)
    np.testing.assert_array_equal(diagram.areas, [4, 4, 0, 4, 0, 4])
    np.testing.assert_array_equal(shapely.area(diagram.to_shapely()), diagram.areas)
    assert shapely.is_empty(diagram.to_shapely()).tolist() == [
        False,
        False,
        True,
        False,
        True,
        False,
    ]


def test_after_an_edit_the_diagram_is_that_of_the_vertices_there_are():
    tin = triangulate(flat(grid(3, 3)))
    before = tin.voronoi(pad=0.5)
    tin.insert([[0.5, 0.5, 0.0]])
    assert len(before) == 9
    areas = tin.voronoi(pad=0.5).areas
    assert len(areas) == 10
    assert areas[9] == pytest.approx(0.5)


# ------------------------------------------------------------------ boundary

COMB = np.array([[0, 0], [10, 0], [10, 10], [7, 10], [7, 2], [3, 2], [3, 10], [0, 10]], float)


@pytest.mark.parametrize("turned", [False, True], ids=["counter-clockwise", "clockwise"])
def test_a_concave_boundary_clips_and_can_cut_a_cell_in_two(turned):
    points = np.array([[1, 1], [9, 1], [5, 8], [1, 4], [9, 4]], float)
    ring = COMB[::-1] if turned else COMB
    diagram = triangulate(flat(points)).voronoi(boundary=ring)
    comb = shapely.Polygon(COMB)
    corners = [[-50, -50], [50, -50], [50, 50], [-50, 50]]
    exact = [
        shapely.Polygon(np.array(cell, float)).intersection(comb)
        for cell in cut_exactly(points, corners)
    ]
    np.testing.assert_allclose(diagram.areas, [cell.area for cell in exact], rtol=1e-12)
    shapes = diagram.to_shapely()
    assert [shape.geom_type for shape in shapes].count("MultiPolygon") == 1
    assert shapes[2].geom_type == "MultiPolygon"
    assert len(diagram.part_offsets) == len(diagram.offsets) + 1
    for mine, theirs in zip(shapes, exact, strict=True):
        assert mine.symmetric_difference(theirs).area < 1e-12
    starts, ends = diagram.part_offsets[:-1], diagram.part_offsets[1:]
    parts = [diagram.coords[begin:end] for begin, end in zip(starts, ends, strict=True)]
    assert all(shapely.Polygon(part).exterior.is_ccw for part in parts)


def test_cells_outside_the_boundary_are_empty_and_the_others_fill_it():
    points = scattered(500)
    ring = UTM + np.array([[20, 20], [60, 25], [40, 40], [70, 80]])
    diagram = triangulate(flat(points)).voronoi(boundary=ring)
    assert 0 < np.count_nonzero(diagram.areas) < 200
    assert diagram.areas.sum() == pytest.approx(shapely.Polygon(ring).area, rel=1e-9)
    shapes = diagram.to_shapely()
    np.testing.assert_allclose(shapely.area(shapes), diagram.areas, atol=1e-9)
    assert (shapely.is_empty(shapes) == (np.diff(diagram.offsets) == 0)).all()


def test_a_boundary_far_from_the_points_is_shared_among_the_nearest():
    points = np.array([[0, 0], [2, 0], [0, 2], [2, 2]], float)
    ring = [[100, 0], [110, 0], [110, 2], [100, 2]]
    diagram = triangulate(flat(points)).voronoi(boundary=ring)
    np.testing.assert_allclose(diagram.areas, [0, 10, 0, 10], atol=1e-9)


def test_bounds_that_hold_all_are_the_box_and_smaller_ones_clip():
    tin = triangulate(flat(grid(4, 4)))
    wide, narrow = Bounds(-1, -1, 4, 4), Bounds(0.5, 0.5, 2.5, 2.5)
    np.testing.assert_array_equal(tin.voronoi(boundary=wide).coords, tin.voronoi(pad=1).coords)
    inner = np.zeros((4, 4))
    inner[1:3, 1:3] = 1.0
    np.testing.assert_allclose(tin.voronoi(boundary=narrow).areas, inner.ravel(), atol=1e-12)


@pytest.mark.parametrize(
    ("options", "error", "says"),
    [
        ({"pad": -1.0}, OptionError, "Invalid pad -1.0: it must be a distance >= 0"),
        ({"pad": np.nan}, OptionError, "Invalid pad nan"),
        ({"pad": "wide"}, OptionError, "Invalid pad 'wide'"),
        ({"pad": 1.0, "boundary": Bounds(0, 0, 1, 1)}, OptionError, "only bounds are padded"),
        ({"boundary": [[0, 0], [1, 1]]}, LinesError, "The boundary has"),
        ({"boundary": [[0, 0], [1, 0], [np.nan, 1]]}, LinesError, "The boundary"),
        ({"boundary": [[0, 0], [2, 2], [2, 0], [0, 2]]}, LinesError, "no simple ring"),
        ({"boundary": [[0, 0], [1, 1], [2, 2]]}, LinesError, "no simple ring"),
        ({"boundary": Bounds(0, 0, 0, 1)}, LinesError, "The boundary"),
        ({"boundary": "square"}, LinesError, "The boundary"),
    ],
)
def test_bad_options_are_refused_with_a_sentence(options, error, says):
    tin = triangulate([[0, 0, 0], [2, 0, 0], [0, 2, 0]])
    with pytest.raises(error, match=says):
        tin.voronoi(**options)
