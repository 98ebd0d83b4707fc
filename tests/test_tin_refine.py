"""Refined meshes: good angles and sizes, the old surface, its lines, and nothing else."""

from itertools import pairwise

import numpy as np
import oracles
import pytest
import triangle
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely.geometry import LineString, Point, Polygon

import tinsmith as ts
from tinsmith.tin.refine import refine

UTM = np.array([500_000.0, 4_000_000.0, 300.0])


def uniform(n, seed=1):
    return np.random.default_rng(seed).random((n, 3)) * [100, 100, 5] + UTM


def random_points():
    return ts.triangulate(uniform(400))


def raster():
    x, y = np.meshgrid(np.arange(12.0), np.arange(9.0))
    return ts.triangulate(np.column_stack([x.ravel(), y.ravel(), (x * y).ravel()]))


def square():
    return ts.triangulate([[0, 0, 0], [100, 0, 0], [100, 100, 7], [0, 100, 7]])


def with_lines():
    points = uniform(150, 2)
    line = np.add(UTM, [[10, 10, 1], [50, 60, 2], [90, 20, 3]])
    wall = np.add(UTM, [[0, 80, 9], [100, 81, 9]])
    return ts.triangulate(points, breaklines=[line, ts.Breakline(wall, kind="soft", name="wall")])


def with_boundary_and_hole():
    corner = UTM[:2]
    return ts.triangulate(
        uniform(200, 3),
        boundary=[np.add(corner, [[5, 5], [95, 5], [95, 40], [40, 40], [40, 95], [5, 95]])],
        holes=[np.add(corner, [[20, 20], [30, 20], [30, 30], [20, 30]])],
    )


def with_pond():
    ring = np.add(UTM[:2], [[30, 30], [70, 35], [60, 70], [35, 60]])
    return ts.triangulate(uniform(200, 4), water=[ts.Water(ring, 301.0)])


def touching_corners():
    points = [[0, 0, 0], [4, 0, 1], [2, 2, 2], [4, 4, 3], [0, 4, 4]]
    return ts.tin.TIN.from_triangles(points, [[0, 1, 2], [2, 3, 4]])


def trimmed():
    return ts.triangulate(uniform(300, 5), max_edge=9.0)


SURFACES = [
    random_points,
    raster,
    square,
    with_lines,
    with_boundary_and_hole,
    with_pond,
    touching_corners,
    trimmed,
]


def corner_angles(tin):
    """Angles by the law of cosines, which refinement does not use."""
    xy = (tin.points[:, :2] - tin.points[0, :2])[tin.triangles]
    side = [np.hypot(*(xy[:, (k + 2) % 3] - xy[:, (k + 1) % 3]).T) for k in range(3)]
    cosines = [
        (side[k - 2] ** 2 + side[k - 1] ** 2 - side[k] ** 2) / (2 * side[k - 2] * side[k - 1])
        for k in range(3)
    ]
    return np.degrees(np.arccos(np.clip(cosines, -1, 1))).T


def require_sound(tin):
    result = ts.check(tin, level=3)
    assert result.ok, [problem.sentence for problem in result.problems]


@pytest.mark.parametrize("make", SURFACES)
@pytest.mark.parametrize("min_angle", [20, 25, 30])
def test_angles_are_reached_and_the_mesh_is_sound(make, min_angle):
    tin = make()
    refined = refine(tin, min_angle=min_angle)
    require_sound(refined)
    given_angles = smallest_between_segments(tin)
    least = corner_angles(refined).min()
    assert least >= min(min_angle, given_angles) - 1e-6


def smallest_between_segments(tin):
    """Return the smallest angle between edges of rim and lines that meet."""
    ways = {}
    segments = tin.constrained | (tin.neighbors < 0)
    for t, k in np.argwhere(segments):
        a, b = tin.triangles[t, (k + 1) % 3], tin.triangles[t, (k + 2) % 3]
        for here, there in ((a, b), (b, a)):
            dx, dy = tin.points[there, :2] - tin.points[here, :2]
            ways.setdefault(here, set()).add(np.degrees(np.arctan2(dy, dx)) % 360)
    smallest = 360.0
    for found in ways.values():
        order = sorted(found)
        gaps = [b - a for a, b in pairwise([*order, order[0] + 360])]
        smallest = min(smallest, *gaps)
    return smallest


@pytest.mark.parametrize("make", SURFACES)
def test_sizes_are_kept(make):
    tin = make()
    largest = tin.area / len(tin.triangles) / 3
    longest = np.sqrt(largest) * 1.5
    refined = refine(tin, max_area=largest, max_edge=longest)
    require_sound(refined)
    assert refined.triangle_areas.max() <= largest * (1 + 1e-9)
    ends = refined.points[refined.edges, :2]
    assert np.hypot(*(ends[:, 1] - ends[:, 0]).T).max() <= longest * (1 + 1e-9)


@pytest.mark.parametrize("make", SURFACES)
def test_given_points_stay_and_new_ones_lie_on_the_surface(make):
    tin = make()
    refined = refine(tin, min_angle=28, max_area=tin.area / len(tin.triangles) / 3)
    n = len(tin.points)
    assert len(refined.points) > n
    np.testing.assert_array_equal(refined.points[:n], tin.points)
    np.testing.assert_array_equal(refined.vertex_of, tin.vertex_of)
    outline = sum(LineString(tin.points[[*ring, ring[0]], :2]).length for ring in tin.rings)
    rounding = np.spacing(np.abs(tin.points[:, :2]).max())
    assert refined.area == pytest.approx(tin.area, rel=1e-12, abs=outline * rounding)
    new = refined.points[n:]
    on_surface = tin.interpolate(new[:, :2])
    inside = ~np.isnan(on_surface)
    np.testing.assert_allclose(new[inside, 2], on_surface[inside], rtol=0, atol=1e-7)
    rim = [LineString(tin.points[[*ring, ring[0]], :2]) for ring in tin.rings]
    for x, y, _ in new[~inside]:  # beside the rim by a rounding
        assert min(line.distance(Point(x, y)) for line in rim) < 1e-9
    assert np.isfinite(new).all()


@pytest.mark.parametrize("make", [with_lines, with_boundary_and_hole, with_pond])
def test_lines_keep_their_vertices_names_and_course(make):
    tin = make()
    refined = refine(tin, max_edge=3.0)
    own = len(tin.lines)
    assert refined.lines.kinds[:own] == tin.lines.kinds
    assert refined.lines.names[:own] == tin.lines.names
    for before, after in zip(tin.lines.chains(), refined.lines.chains(), strict=False):
        kept = [v for v in after.tolist() if v in set(before.tolist())]
        assert kept == before.tolist()
        course = LineString(tin.points[before, :2])
        for x, y, z in refined.points[after]:
            assert course.distance(Point(x, y)) < 1e-9
            share = course.project(Point(x, y))
            along = np.concatenate(
                [[0], np.cumsum(np.hypot(*np.diff(tin.points[before, :2], axis=0).T))]
            )
            assert z == pytest.approx(np.interp(share, along, tin.points[before, 2]), abs=1e-6)


def test_a_rim_without_a_line_becomes_the_boundary():
    refined = refine(random_points())
    assert refined.lines.kinds == ("boundary",)
    ring = refined.points[refined.lines.vertices, :2]
    assert Polygon(ring).area == pytest.approx(refined.area, rel=1e-12)
    assert refined.constrained[refined.neighbors < 0].all()


def test_flags_without_a_line_become_soft_breaklines():
    plain = square()
    flags = np.zeros((2, 3), bool)
    triangle_, corner = np.argwhere(plain.neighbors >= 0)[0]
    flags[triangle_, corner] = True
    other = plain.neighbors[triangle_, corner]
    flags[other, np.flatnonzero(plain.neighbors[other] == triangle_)[0]] = True
    tin = ts.tin.TIN.from_triangles(plain.points, plain.triangles, constrained=flags)
    refined = refine(tin, max_edge=20.0)
    require_sound(refined)
    assert refined.lines.kinds == ("soft", "boundary")
    diagonal = refined.points[next(refined.lines.chains())]
    assert len(diagonal) > 5
    np.testing.assert_array_equal(
        diagonal[:, 0], np.sort(diagonal[:, 0])[:: 1 if diagonal[0, 0] < diagonal[-1, 0] else -1]
    )


@pytest.mark.parametrize("make", [random_points, raster])
@pytest.mark.parametrize("min_angle", [25, 33])
def test_the_order_of_the_points_does_not_matter(make, min_angle):
    tin = make()
    order = np.random.default_rng(8).permutation(len(tin.points))
    shuffled = ts.triangulate(tin.points[order])
    own, other = refine(tin, min_angle=min_angle), refine(shuffled, min_angle=min_angle)
    assert set(map(bytes, own.points)) == set(map(bytes, other.points))


def test_the_result_is_what_its_points_and_lines_give():
    refined = refine(with_lines(), max_area=20.0)
    lines = [
        ts.Breakline(refined.points[chain])
        for kind, chain in zip(refined.lines.kinds, refined.lines.chains(), strict=True)
        if kind != "boundary"
    ]
    ring = refined.points[refined.lines.vertices[refined.lines.offsets[-2] : -1]]
    fresh = ts.triangulate(refined.points, breaklines=lines, boundary=[ring])
    np.testing.assert_array_equal(fresh.points, refined.points)
    np.testing.assert_array_equal(fresh.triangles, refined.triangles)


def test_a_refined_mesh_can_be_edited_and_refined_again():
    refined = refine(with_boundary_and_hole())
    refined.insert(np.add(UTM, [[33.0, 15.0, 1.0]]))
    require_sound(refined)
    again = refine(refined, min_angle=25)
    require_sound(again)
    assert corner_angles(again).min() > 15


def test_a_mesh_that_is_good_stays_as_it_is():
    refined = refine(random_points(), min_angle=25)
    again = refine(refined, min_angle=25)
    np.testing.assert_array_equal(again.points, refined.points)
    np.testing.assert_array_equal(again.triangles, refined.triangles)
    untouched = refine(random_points(), min_angle=0)
    np.testing.assert_array_equal(untouched.points, random_points().points)


def test_the_report_goes_on():
    points = np.concatenate([uniform(50), np.add(uniform(50)[:3], [0, 0, 1])])
    tin = ts.triangulate(points, duplicates="highest")
    report = refine(tin).report
    assert [merge.rows for merge in report.merges()] == [(0, 50), (1, 51), (2, 52)]
    assert "Refinement added" in report.notes[-1]
    assert report.n_rows == 53


# ------------------------------------------------------------------- beside Triangle


def triangles_of_triangle(tin, options):
    """Refine with Triangle; return its triangles and its smallest angle."""
    segments = tin.constrained | (tin.neighbors < 0)
    t, k = np.nonzero(segments)
    graph = {
        "vertices": tin.points[:, :2] - tin.points[0, :2],
        "segments": np.column_stack([tin.triangles[t, (k + 1) % 3], tin.triangles[t, (k + 2) % 3]]),
    }
    if len(tin.rings) > 1:
        inner = [Polygon(tin.points[ring, :2]).representative_point() for ring in tin.rings[1:]]
        graph["holes"] = np.array([[p.x, p.y] for p in inner]) - tin.points[0, :2]
    made = triangle.triangulate(graph, f"p{options}Q")
    mesh = ts.tin.TIN.from_triangles(
        np.column_stack([made["vertices"], np.zeros(len(made["vertices"]))]), made["triangles"]
    )
    return len(made["triangles"]), corner_angles(mesh).min()


@pytest.mark.parametrize("make", [random_points, square, with_lines, with_boundary_and_hole])
@pytest.mark.parametrize("min_angle", [20, 25, 30])
@pytest.mark.parametrize("area", [None, 4.0])
def test_as_good_as_triangle_with_as_few_triangles(make, min_angle, area):
    tin = make()
    refined = refine(tin, min_angle=min_angle, max_area=area)
    count, least = triangles_of_triangle(tin, f"q{min_angle}" + (f"a{area}" if area else ""))
    assert len(refined.triangles) <= 1.3 * count
    assert corner_angles(refined).min() >= min(min_angle, least) - 1e-6


# ------------------------------------------------------------------------ always ends


@pytest.mark.parametrize("angle", [0.01, 1, 10, 30, 59])
def test_small_angles_of_the_input_stay_alone(angle):
    ways = np.radians([0, angle, 90, 200])
    tips = np.column_stack([np.cos(ways), np.sin(ways), ways]) * [100, 70, 1]
    tin = ts.triangulate(
        [[0, 0, 0], *tips, [-90, 90, 2], [-90, -90, 2], [90, -90, 2], [90, 90, 2]],
        breaklines=[[[0, 0, 0], tip] for tip in tips],
    )
    refined = refine(tin, min_angle=25, max_area=100.0)
    require_sound(refined)
    assert len(refined.points) < 20_000
    bad = corner_angles(refined).min(axis=1) < 25 - 1e-6
    middle = refined.points[refined.triangles[bad], :2].mean(axis=1)
    assert (np.abs(np.degrees(np.arctan2(*middle.T[::-1])) - angle / 2) < max(angle, 1)).all()


def test_needles_far_from_the_origin():
    tin = ts.triangulate(np.add(UTM, [[0.1, 0, 0], [100, 0, 0], [70, 1e-6, 0]]))
    refined = refine(tin, min_angle=33)
    require_sound(refined)
    assert len(refined.points) < 20_000


small = st.tuples(st.integers(0, 6), st.integers(0, 6))


@settings(max_examples=150, deadline=None)
@given(
    st.sets(small, min_size=4, max_size=25),
    st.lists(st.tuples(small, small), max_size=3),
    st.sampled_from([15, 20, 25, 30, 33]),
)
def test_any_small_survey_ends_sound(places, lines, min_angle):
    points = [[x, y, (x * 7 + y * 3) % 5] for x, y in sorted(places)]
    breaklines = [[[*a, 1.0], [*b, 2.0]] for a, b in lines if a != b]
    try:
        tin = ts.triangulate(points, breaklines=breaklines)
    except ts.PointsError:
        ends = [p for line in breaklines for p in line]
        assert oracles.are_collinear([*places, *ends])
        return
    refined = refine(tin, min_angle=min_angle)
    require_sound(refined)
    assert len(refined.points) < 20_000
    if min_angle <= 20 and smallest_between_segments(tin) >= 60:
        assert corner_angles(refined).min() >= min_angle - 1e-6


# -------------------------------------------------------------------------- bad input


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"min_angle": 34}, "Invalid min_angle 34"),
        ({"min_angle": -1}, "Invalid min_angle -1"),
        ({"min_angle": float("nan")}, "Invalid min_angle nan"),
        ({"min_angle": "25"}, "Invalid min_angle '25'"),
        ({"max_area": 0}, "Invalid max_area 0"),
        ({"max_area": -1.0}, "Invalid max_area -1"),
        ({"max_edge": 0.0}, "Invalid max_edge 0.0"),
        ({"max_edge": float("inf")}, "Invalid max_edge inf"),
        ({"max_vertices": 0}, "Invalid max_vertices 0"),
        ({"max_vertices": 1.5}, "Invalid max_vertices 1.5"),
        ({"max_vertices": 5}, "more than 5 vertices"),
        ({"max_area": 1e-9}, "more than 10,000,000 vertices"),
        ({"max_edge": 0.5, "max_vertices": 2000}, "more than 2,000 vertices"),
    ],
)
def test_bad_limits_are_told_in_a_sentence(options, words):
    with pytest.raises(ts.PointsError, match=words):
        refine(random_points(), **options)
