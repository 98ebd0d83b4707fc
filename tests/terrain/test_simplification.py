"""Simplified surfaces: near every point, no vertex needless, lines and boundary as they were."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support import surfaces
from support.point_sets import seeds
from support.simplification import errors, is_needed
from support.surfaces import UTM

import tinsmith as ts


def scattered(n=400, seed=1):
    xy = np.random.default_rng(seed).random((n, 2)) * 100
    z = 8 * np.sin(xy[:, 0] / 15) * np.cos(xy[:, 1] / 20)
    return np.column_stack([xy, z]) + UTM


def gridded(rows=14, columns=17, height=np.hypot):
    x, y = np.meshgrid(np.arange(float(columns)), np.arange(float(rows)))
    return np.column_stack([x.ravel(), y.ravel(), height(x, y).ravel()])


def with_lines():
    return surfaces.with_lines(scattered(200, 2))


def with_voids():
    points = gridded()
    inner = (np.abs(points[:, :2] - [8, 6]) < 3).all(axis=1)
    ring = [[5, 3, 0], [11, 3, 0], [11, 9, 0], [5, 9, 0]]
    outer = [[0, 0, 0], [16, 0, 0], [16, 13, 0], [0, 13, 0]]
    rings = [[[x, y, np.hypot(x, y)] for x, y, _ in one] for one in (ring, outer)]
    return ts.triangulate(ts.Survey(points=points[~inner], extent=rings))


SURFACES = {
    "scattered": lambda: ts.triangulate(scattered()),
    "gridded": lambda: ts.triangulate(gridded()),
    "with_lines": with_lines,
    "with_boundary_and_hole": lambda: surfaces.with_boundary_and_hole(scattered(200, 3)),
    "with_pond": lambda: surfaces.with_pond(scattered(200, 4)),
    "with_voids": with_voids,
    "trimmed": lambda: ts.triangulate(scattered(300, 5), max_edge=9.0),
}


@pytest.mark.parametrize("name", SURFACES)
@pytest.mark.parametrize("tolerance", [0.0, 0.2, 2.0])
def test_no_point_is_beyond_the_tolerance_and_all_is_as_it_was(name, tolerance):
    tin = SURFACES[name]()
    simple = ts.simplify(tin, tolerance=tolerance)
    assert ts.check(simple, level=3).ok
    found, told = errors(tin.points, simple), simple.report.simplification
    assert found.max() <= tolerance + 1e-9
    assert told.largest_error == pytest.approx(found.max(), abs=1e-9)
    assert told.rms_error == pytest.approx(np.sqrt(np.mean(found**2)), abs=1e-9)
    assert told.largest_error <= max(tolerance, 1e-11)
    assert_same_frame(tin, simple)


def assert_same_frame(tin, simple):
    """Vertices are some of those before in their order; lines and area are the same."""
    rows = simple.vertex_of[simple.vertex_of >= 0]
    assert (np.diff(np.unique(rows)) == 1).all()
    kept = {tuple(point) for point in tin.points.tolist()}
    assert {tuple(point) for point in simple.points.tolist()} <= kept
    assert simple.area == pytest.approx(tin.area, rel=1e-12)
    assert len(simple.rings) == len(tin.rings)
    assert simple.lines.kinds == tin.lines.kinds
    for before, after in zip(tin.lines.chains(), simple.lines.chains(), strict=True):
        assert np.array_equal(tin.points[before], simple.points[after])


@pytest.mark.parametrize("name", ["scattered", "gridded", "with_lines", "with_voids"])
def test_the_result_is_the_triangulation_of_its_points(name):
    simple = ts.simplify(SURFACES[name](), tolerance=0.7)
    lines = [simple.points[chain] for chain in simple.lines.chains()]
    extent = []
    if name == "with_voids":
        extent = [simple.points[ring] for ring in simple.rings]
        lines = []
    survey = ts.Survey(points=simple.points, breaklines=lines, extent=extent)
    built = ts.triangulate(survey)
    assert np.array_equal(built.triangles, simple.triangles)
    assert np.array_equal(built.neighbors, simple.neighbors)


@pytest.mark.parametrize("name", ["scattered", "gridded"])
def test_no_vertex_inside_is_needless(name):
    tin = SURFACES[name]()
    simple = ts.simplify(tin, tolerance=0.2)
    inner = np.setdiff1d(np.arange(len(simple.points)), np.concatenate(simple.rings))
    assert len(inner) > 5
    assert all(is_needed(simple, vertex, tin.points, 0.2) for vertex in inner.tolist())


def test_of_a_plane_its_corners_are_left():
    tin = ts.triangulate(gridded(height=lambda x, y: 2 * x - 3 * y + 7))
    for tolerance in (0.0, 1.0):
        simple = ts.simplify(tin, tolerance=tolerance)
        assert sorted(map(tuple, simple.points[:, :2].tolist())) == [
            *((0, 0), (0, 13), (16, 0), (16, 13))
        ]


def test_a_tolerance_of_zero_leaves_out_what_is_told_exactly():
    roof = ts.triangulate(gridded(height=lambda x, y: 8 - np.abs(x - 8) + 0 * y))
    simple = ts.simplify(roof, tolerance=0.0)
    assert 6 <= len(simple.points) < len(roof.points)
    assert simple.report.simplification.largest_error == 0.0
    assert errors(roof.points, simple).max() == pytest.approx(0.0, abs=1e-12)


def test_of_a_surface_that_is_needed_whole_nothing_is_left_out():
    tin = ts.triangulate(scattered(100))
    simple = ts.simplify(tin, tolerance=0.0)
    assert np.array_equal(simple.points, tin.points)
    assert np.array_equal(simple.triangles, tin.triangles)


@pytest.mark.parametrize("name", SURFACES)
def test_a_number_of_points_is_met_exactly(name):
    tin = SURFACES[name]()
    least = ts.simplify(tin, tolerance=1e9).report.simplification.required
    for points in {least, (least + len(tin.points)) // 2, len(tin.points)}:
        simple = ts.simplify(tin, points=points)
        assert len(simple.points) == points
        assert simple.report.simplification.tolerance is None
        found = errors(tin.points, simple)
        assert simple.report.simplification.largest_error == pytest.approx(found.max(), abs=1e-9)


def test_more_points_are_nearer():
    tin = ts.triangulate(scattered())
    rms = [ts.simplify(tin, points=n).report.simplification.rms_error for n in (30, 80, 200, 400)]
    assert rms == sorted(rms, reverse=True)
    assert rms[-1] == 0.0


@given(seeds, st.sampled_from([0.0, 1.0, 2.5]), st.integers(1, 4))
@settings(max_examples=25, deadline=None)
def test_order_and_threads_change_nothing(seed, tolerance, threads):
    """On small whole numbers, where nearly everything is a tie."""
    rng = np.random.default_rng(seed)
    points = gridded(8, 9, lambda x, y: rng.integers(0, 5, x.shape).astype(float))
    one = ts.simplify(ts.triangulate(points), tolerance=tolerance)
    mixed = ts.triangulate(points[rng.permutation(len(points))])
    other = ts.simplify(mixed, tolerance=tolerance, threads=threads)
    assert list_triangles(one) == list_triangles(other)
    assert errors(points, other).max() <= tolerance + 1e-12


def list_triangles(tin):
    """Return the triangles as sets of places, whatever their numbers."""
    return {frozenset(map(tuple, corners)) for corners in tin.points[tin.triangles].tolist()}


def test_points_to_be_kept_are_kept():
    tin = ts.triangulate(scattered())
    keep = [17, 230, 231]
    simple = ts.simplify(tin, tolerance=100.0, keep=keep)
    assert (simple.vertex_of[keep] >= 0).all()
    assert np.array_equal(simple.points[simple.vertex_of[keep]], tin.points[keep])
    assert simple.report.simplification.required == len(simple.points)


def test_every_row_is_accounted_for():
    points = np.vstack([scattered(60), scattered(60)[:5]])  # five twice
    survey = ts.Survey(points=points, attributes={"number": np.arange(65)})
    simple = ts.simplify(ts.triangulate(survey), tolerance=3.0)
    out = simple.report.to_dict()["left_out"]["simplified away"]
    assert out == np.flatnonzero(simple.vertex_of < 0).tolist()
    assert simple.report.n_vertices == len(simple.points) < 60
    rows = simple.attributes["number"]
    assert np.array_equal(points[rows], simple.points)
    assert simple.report.to_dict()["simplification"]["vertices"] == len(simple.points)


def test_the_result_can_be_edited_simplified_again_and_kept_in_a_file(tmp_path):
    simple = ts.simplify(with_lines(), tolerance=1.0)
    again = ts.simplify(simple, tolerance=2.0)
    assert len(again.points) < len(simple.points)
    assert len(again.report.left_out_rows) > len(simple.report.left_out_rows)
    read = ts.read(ts.write(simple, tmp_path / "simple.gpkg"))
    assert read.report.to_dict() == simple.report.to_dict()
    assert read.report.simplification == simple.report.simplification
    simple.insert([[*(UTM[:2] + 33.3), 300.0]])
    assert ts.check(simple).ok
    assert simple.report.simplification is None


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({}, "not both"),
        ({"tolerance": 1.0, "points": 9}, "not both"),
        ({"tolerance": -0.1}, "Invalid tolerance -0.1"),
        ({"tolerance": np.nan}, "Invalid tolerance nan"),
        ({"tolerance": True}, "Invalid tolerance True"),
        ({"points": 2}, "Invalid points 2: it must be a whole number from 3 on"),
        ({"points": 3}, "it must be from 4, for so many lie on lines"),
        ({"points": 239}, "to 238, for there are no more"),
        ({"points": 9.5}, "Invalid points 9.5"),
    ],
)
def test_what_cannot_be_is_refused(options, words):
    with pytest.raises(ts.OptionError, match=words):
        ts.simplify(ts.triangulate(gridded()), **options)


def test_a_vertex_that_is_none_cannot_be_kept():
    with pytest.raises(ts.PointsError, match="There is no vertex 238"):
        ts.simplify(ts.triangulate(gridded()), tolerance=1.0, keep=[238])
