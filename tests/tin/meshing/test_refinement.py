"""Refined meshes: good angles and sizes, the old surface, its lines, and nothing else."""

from itertools import pairwise

import numpy as np
import pytest
import triangle
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely.geometry import LineString, Point, Polygon
from support import oracles, surfaces
from support.surfaces import UTM

import tinsmith as ts
from tinsmith.tin.meshing import refinement
from tinsmith.tin.meshing.refinement import _interpolate, refine
from tinsmith.tin.report import UNMENDED_WHY


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
    return surfaces.with_lines(uniform(150, 2))


def with_boundary_and_hole():
    return surfaces.with_boundary_and_hole(uniform(200, 3))


def with_pond():
    return surfaces.with_pond(uniform(200, 4))


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
    """Return the smallest angle between edges of boundary and lines that meet."""
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
    for x, y, _ in new[~inside]:  # beside the boundary by a rounding
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


@pytest.mark.parametrize("make", SURFACES)
@pytest.mark.parametrize("limits", [{"min_angle": 20}, {"min_angle": 30}, {"max_area": 6.0}])
def test_the_triangles_of_the_core_are_those_of_all_points_triangulated(make, limits, monkeypatch):
    own = refine(make(), **limits)
    find, has_mesh = refinement._find_points, []

    def find_points_alone(*given):
        found = find(*given)
        has_mesh.append(found.mesh is not None)
        return found._replace(mesh=None)

    monkeypatch.setattr(refinement, "_find_points", find_points_alone)
    fresh = refine(make(), **limits)
    # what lies between the parts of a boundary of several rings is not always filled
    assert has_mesh == [make not in (with_boundary_and_hole, touching_corners, trimmed)]
    for name in ("points", "triangles", "neighbors", "constrained"):
        np.testing.assert_array_equal(getattr(own, name), getattr(fresh, name), err_msg=name)
    np.testing.assert_array_equal(own.lines.vertices, fresh.lines.vertices)
    assert own.report.notes == fresh.report.notes
    np.testing.assert_array_equal(own.report.unmended.triangles, fresh.report.unmended.triangles)


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
    angles = angles_of_triangle(tin, options)
    return len(angles), angles.min()


def angles_of_triangle(tin, options):
    """Refine with Triangle; return the smallest angle of each of its triangles."""
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
    return corner_angles(mesh).min(axis=1)


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


def require_told(mesh, min_angle):
    """The report lists the triangles below the least angle, all of them and no other."""
    told = mesh.report.unmended
    small = corner_angles(mesh).min(axis=1)
    np.testing.assert_array_equal(told.triangles, np.flatnonzero(small < min_angle - 1e-7))
    np.testing.assert_allclose(told.angles, small[told.triangles], rtol=1e-6, atol=1e-6)
    groups = told.to_list()
    assert sum(group["count"] for group in groups) == len(told.triangles)
    for group in groups:
        assert any(f"{group['count']:,} triangle" in note for note in mesh.report.notes)
        assert any(group["why"] in note for note in mesh.report.notes)


def two_lines(degrees, length=40.0):
    way = np.radians(degrees)
    return ts.triangulate(
        [[0, 0, 0], [100, 0, 0], [100, 100, 0], [0, 100, 0]],
        breaklines=[
            [[50, 50, 0], [50 + length, 50, 0]],
            [[50, 50, 0], [50 + length * np.cos(way), 50 + length * np.sin(way), 0]],
        ],
    )


@pytest.mark.parametrize("degrees", [0.1, 1, 5, 10, 15])
@pytest.mark.parametrize("min_angle", [20, 30])
def test_what_stays_lies_across_a_small_angle_and_is_no_more_than_in_triangle(degrees, min_angle):
    tin = two_lines(degrees)
    mesh = refine(tin, min_angle=min_angle)
    require_sound(mesh)
    require_told(mesh, min_angle)
    assert set(mesh.report.unmended.why) == {0}
    left = mesh.triangles[mesh.report.unmended.triangles]
    middle = mesh.points[left, :2].mean(axis=1) - 50
    way = np.degrees(np.arctan2(*middle.T[::-1]))
    assert ((way > 0) & (way < degrees)).all()
    on_lines = set(np.concatenate([*mesh.lines.chains()][:2]).tolist())
    for corners in left.tolist():  # the shortest side goes from line to line
        assert sum(v in on_lines for v in corners) >= 2
    theirs = angles_of_triangle(tin, f"q{min_angle}")
    assert len(left) <= np.count_nonzero(theirs < min_angle - 1e-7)


def test_lines_at_a_small_angle_are_split_at_powers_of_two():
    mesh = refine(two_lines(10, length=41.3), min_angle=25, max_edge=15.0)
    first, second = [*mesh.lines.chains()][:2]
    radii = [np.hypot(*(mesh.points[chain, :2] - 50).T) for chain in (first, second)]
    for own in radii:
        inner = np.sort(own)[1:-1]
        assert len(inner) >= 2
        exponents = np.log2(inner[inner < 17])
        np.testing.assert_allclose(exponents, np.round(exponents), atol=1e-9)
    assert len(mesh.points) < 150  # without circles the lines cut each other on and on


def test_no_more_points_than_triangle_puts():
    for make, options in ((random_points, "q25"), (with_lines, "q25"), (square, "q25a30")):
        tin = make()
        area = 30.0 if "a" in options else None
        ours = refine(tin, min_angle=25, max_area=area)
        theirs, _ = triangles_of_triangle(tin, options)
        assert len(ours.triangles) <= 1.1 * theirs


def test_the_report_says_where_only_shorter_edges_would_help():
    strip = [[0, 0, 0], [1e-3, 0, 0], [1e-3, 1e-7, 0], [0, 1e-7, 0]]
    mesh = refine(ts.triangulate(np.add(UTM, strip)), min_angle=33)
    require_sound(mesh)
    told = mesh.report.unmended
    np.testing.assert_array_equal(told.triangles, np.arange(len(mesh.triangles)))
    assert {group["why"] for group in told.to_list()} <= set(UNMENDED_WHY[1:])


def test_a_mesh_without_small_angles_has_nothing_unmended():
    mesh = refine(random_points(), min_angle=20)
    require_told(mesh, 20)
    assert len(mesh.report.unmended.triangles) == 0
    assert mesh.report.to_dict()["unmended"] == []


def test_an_edit_makes_the_list_of_what_stays_void():
    mesh = refine(two_lines(5), min_angle=30)
    assert len(mesh.report.unmended.triangles) > 0
    mesh.insert([[20.0, 30.0, 0.0]])
    assert len(mesh.report.unmended.triangles) == 0


NARROW = {
    "a triangle with a hole of rounding width": (
        [
            [491.6666666666666, 499.99999999999994, 1.0],
            [497.66666666666663, 492.0, -2.0],
            [505.0000000000001, 506.6666666666666, -2.0],
        ],
        {
            "holes": [
                [
                    [502.3333333333334, 492.00000000000006, 3.0],
                    [492.00000000000006, 502.3333333333334, 3.0],
                    [502.33333333333337, 492.00000000000006, 2.0],
                ]
            ]
        },
        {"min_angle": 30.0, "max_area": 108.88888888889008},
    ),
    "lines over a slanted line but for rounding": (
        [
            [66666.66666666666, 23.099999999999998, 619.03],
            [0.30000000000000004, 0.6666666666666663, 334.04],
            [33333.33333333334, 15.400000000000002, 426.47],
            [66666.66666666666, 15.400000000000002, 241.0],
            [0.09999999999999998, 0.3333333333333335, 16.11],
            [0.09999999999999999, 0.33333333333333315, 112.93],
            [33333.33333333336, 7.699999999999999, 84.38],
            [66666.6666666667, 15.400000000000002, 774.91],
            [33333.33333333336, 15.4, 536.27],
        ],
        {
            "breaklines": [
                [
                    [66666.6666666667, 15.400000000000002, 8.0],
                    [0.09999999999999998, 0.3333333333333335, 3.0],
                ],
                [
                    [0.09999999999999999, 0.33333333333333315, 6.0],
                    [33333.33333333336, 7.699999999999999, 2.0],
                ],
                [
                    [0.09999999999999999, 0.33333333333333315, 5.0],
                    [66666.6666666667, 15.400000000000002, 4.0],
                ],
            ]
        },
        {"min_angle": 33.0, "max_area": 1333329333.3363345},
    ),
}


@pytest.mark.parametrize("name", NARROW)
def test_boundaries_and_lines_that_are_nearly_collinear(name):
    points, lines, limits = NARROW[name]
    tin = ts.triangulate(points, **lines)
    mesh = refine(tin, **limits)
    require_sound(mesh)
    n = len(tin.points)
    np.testing.assert_array_equal(mesh.points[:n], tin.points)
    small = ts.tin.quality(mesh).min_angle < limits["min_angle"] - 1e-6
    assert set(np.flatnonzero(small)) <= set(mesh.report.unmended.triangles.tolist())


@pytest.mark.parametrize("angle", [0.01, 1, 10, 30, 59])
def test_small_angles_of_the_input_stay_between_their_lines(angle):
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


@settings(max_examples=50)
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
        ({"max_area": -1.0}, "Invalid max_area -1.0"),
        ({"max_edge": 0.0}, "Invalid max_edge 0.0"),
        ({"max_edge": float("inf")}, "Invalid max_edge inf"),
        ({"max_vertices": 0}, "Invalid max_vertices 0"),
        ({"max_vertices": 1.5}, "Invalid max_vertices 1.5"),
    ],
)
def test_bad_options_are_told_in_a_sentence(options, words):
    with pytest.raises(ts.OptionError, match=f"{words}: it must be "):
        refine(random_points(), **options)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"max_vertices": 5}, "more than 5 vertices"),
        ({"max_area": 1e-9}, "more than 10,000,000 vertices"),
        ({"max_edge": 0.5, "max_vertices": 2000}, "more than 2,000 vertices"),
    ],
)
def test_bad_limits_are_told_in_a_sentence(options, words):
    with pytest.raises(ts.PointsError, match=words):
        refine(random_points(), **options)


@pytest.mark.parametrize("make", [square, with_boundary_and_hole, touching_corners])
def test_places_beside_the_rim_have_the_height_of_the_nearest_edge(make):
    """A rounding outside, and at random places outside: each edge of the boundary in turn."""
    tin = make()
    rng = np.random.default_rng(4)
    low, high = tin.points[:, :2].min(axis=0), tin.points[:, :2].max(axis=0)
    places = rng.uniform(low - 20, high + 20, (60, 2))
    rings = [tin.points[np.append(ring, ring[0])] for ring in tin.rings]
    ends = [pair for ring in rings for pair in pairwise(ring)]
    middles = np.array([0.3 * a[:2] + 0.7 * b[:2] for a, b in ends])
    outward = np.array([[b[1] - a[1], a[0] - b[0]] for a, b in ends])
    places = np.concatenate([places, middles + 1e-7 * outward])
    found = _interpolate(tin, places)
    within = tin.interpolate(places)
    for place, z, inside in zip(places, found, within, strict=True):
        if not np.isnan(inside):
            assert z == inside
            continue
        distances = [LineString([a[:2], b[:2]]).distance(Point(place)) for a, b in ends]
        nearest = np.flatnonzero(np.array(distances) <= min(distances) + 1e-9)
        heights = []
        for k in nearest:
            a, b = ends[k]
            line = LineString([a[:2], b[:2]])
            share = line.project(Point(place)) / line.length
            heights.append(a[2] + share * (b[2] - a[2]))
        assert min(abs(z - height) for height in heights) < 1e-6
