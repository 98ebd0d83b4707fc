"""Lines in a TIN: breaklines, boundaries, holes, erased parts, water, long edges."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
import shapely

import tinsmith as ts
from tinsmith.tin.report import LEFT_OUT

NONE = np.empty((0, 3))
ARRAYS = ("points", "triangles", "neighbors", "constrained")


def terrain(n=400, seed=0, size=100.0):
    rng = np.random.default_rng(seed)
    xy = rng.random((n, 2)) * size
    return np.c_[xy, np.round(5 * np.sin(xy[:, 0] / 15) + xy[:, 1] / 20, 3)]


def polygon(ring):
    return shapely.Polygon(np.asarray(ring)[:, :2])


def hull_of(points):
    return shapely.MultiPoint(points[:, :2]).convex_hull


def edges_of(tin, *, constrained):
    return {
        frozenset(tuple(tin.points[int(t[(k + j) % 3]), :2]) for j in (1, 2))
        for t, flags in zip(tin.triangles, tin.constrained, strict=True)
        for k in range(3)
        if flags[k] or not constrained
    }


def triangle_set(tin):
    return {frozenset(map(tuple, tin.points[t].tolist())) for t in tin.triangles}


def cross_of(a=10.0, b=12.0):
    return [[[5, 50, a], [95, 50.5, a]], [[50.25, 5, b], [50.75, 95, b]]]


# ------------------------------------------------------- what a breakline does


def test_breakline_is_edges_of_the_surface():
    line = [[10, 10, 1.0], [60, 70, 2.0], [90, 20, 3.0]]
    tin = ts.triangulate(terrain(), breaklines=[line])
    (chain,) = tin.lines.chains()
    way = tin.points[chain]
    assert [p.tolist() for p in way if p.tolist() in line] == line
    steps = {frozenset(map(tuple, pair)) for pair in zip(way[:-1, :2], way[1:, :2], strict=True)}
    assert steps == edges_of(tin, constrained=True)
    assert ts.check(tin, points=terrain()).ok


def test_height_between_vertices_of_a_breakline_is_the_lines_own():
    tin = ts.triangulate(terrain(), breaklines=[[[10, 10, 100.0], [90, 80, 200.0]]])
    share = np.linspace(0, 1, 50)
    places = np.array([10, 10]) + share[:, None] * [80, 70]
    np.testing.assert_allclose(tin.interpolate(places), 100 + 100 * share, rtol=0, atol=1e-6)


@pytest.mark.parametrize("seed", range(5))
def test_result_is_a_function_of_the_sets_of_points_and_lines(seed):
    rng = np.random.default_rng(seed)
    points = terrain(200, seed)
    lines = [np.c_[rng.random((k, 2)) * 100, rng.random(k)] for k in rng.integers(2, 6, 8)]
    wanted = ts.triangulate(points, breaklines=lines)
    order = rng.permutation(len(points))
    turned = [lines[i][:: rng.choice([-1, 1])] for i in rng.permutation(len(lines))]
    found = ts.triangulate(points[order], breaklines=turned)

    def plan(tin):
        return {frozenset(map(tuple, tin.points[t, :2].tolist())) for t in tin.triangles}

    assert plan(found) == plan(wanted)
    assert edges_of(found, constrained=True) == edges_of(wanted, constrained=True)
    assert ts.check(found, points=points[order]).ok


@pytest.mark.parametrize("threads", [1, 2, 5])
def test_result_is_the_same_for_every_number_of_threads(threads):
    points, lines = terrain(3_000), cross_of()
    wanted = ts.triangulate(points, breaklines=lines, threads=1)
    found = ts.triangulate(points, breaklines=lines, threads=threads)
    for name in ARRAYS:
        np.testing.assert_array_equal(getattr(found, name), getattr(wanted, name))


def test_soft_breakline_keeps_its_kind():
    soft = ts.Breakline([[10, 10, 1], [90, 90, 1]], kind="soft", name="crease")
    tin = ts.triangulate(terrain(), breaklines=[soft, [[10, 90, 1], [20, 60, 1]]])
    assert tin.lines.kinds == ("soft", "hard")
    assert tin.lines.names == ("crease", "")
    assert tin.lines.sources.tolist() == [0, 1]


def test_closed_breakline_stays_closed():
    ring = [[20, 20, 1], [80, 20, 1], [50, 80, 1], [20, 20, 1]]
    (chain,) = ts.triangulate(terrain(), breaklines=[ring]).lines.chains()
    assert chain[0] == chain[-1]


def test_lines_alone_make_a_surface():
    tin = ts.triangulate(np.empty((0, 3)), breaklines=[[[0, 0, 1], [4, 0, 2], [4, 4, 3]]])
    assert len(tin.triangles) == 1
    assert ts.check(tin).ok


# ------------------------------------------------------------------ dirty lines


@pytest.mark.parametrize(
    ("priorities", "taken"), [((0, 0), 10.0), ((0, 1), 12.0), ((1, 0), 10.0), ((-1, 0), 12.0)]
)
def test_crossing_takes_the_higher_priority_or_the_first_and_reports_both(priorities, taken):
    lines = [
        ts.Breakline(line, priority=priority)
        for line, priority in zip(cross_of(), priorities, strict=True)
    ]
    tin = ts.triangulate(terrain(), breaklines=lines)
    (met,) = tin.report.to_dict()["crossings"]
    assert met["lines"] == ["breakline 0", "breakline 1"]
    assert met["elevations"] == pytest.approx([10, 12])
    assert met["elevation"] == pytest.approx(taken)
    vertex = tin.points[met["vertex"]]
    assert vertex.tolist() == [*met["place"], met["elevation"]]
    wanted = shapely.LineString(cross_of()[0]).intersection(shapely.LineString(cross_of()[1]))
    assert vertex[:2] == pytest.approx([wanted.x, wanted.y], abs=1e-9)
    assert all(met["vertex"] in chain for chain in tin.lines.chains())
    assert ts.check(tin).ok


def test_crossing_is_refused_if_asked_for():
    with pytest.raises(ts.LinesError, match=r"(?i)breakline 0.*breakline 1.*10.*12"):
        ts.triangulate(terrain(), breaklines=cross_of(), crossing="error")


def test_line_on_points_takes_them_in_and_reports_their_heights():
    points = np.array([[0, 0, 1], [10, 0, 1], [10, 10, 1], [0, 10, 1], [5, 5, 7.0], [3, 3, 2.0]])
    tin = ts.triangulate(points, breaklines=[[[0, 0, 1], [10, 10, 1]]])
    (chain,) = tin.lines.chains()
    assert tin.points[chain, :2].tolist() == [[0, 0], [3, 3], [5, 5], [10, 10]]
    assert tin.points[chain, 2].tolist() == [1, 2, 7, 1]
    overruled = tin.report.to_dict()["overruled"]
    told = sorted((one["of"], round(one["elevation"], 9), one["taken"]) for one in overruled)
    assert told == [("breakline 0", 1, 2), ("breakline 0", 1, 7)]


def test_vertex_of_a_line_on_a_point_gives_it_its_height():
    points = np.array([[0, 0, 1], [10, 0, 1], [10, 10, 1], [0, 10, 1.0]])
    tin = ts.triangulate(points, breaklines=[[[0, 0, 9], [10, 10, 8]]])
    assert tin.points[:, 2].tolist() == [9, 1, 8, 1]
    overruled = tin.report.to_dict()["overruled"]
    assert [(one["of"], one["elevation"], one["taken"]) for one in overruled] == [
        ("points", 1, 9),
        ("points", 1, 8),
    ]


def test_overlapping_and_repeated_lines_are_one_edge():
    line = [[10, 10, 1], [90, 10, 2]]
    tin = ts.triangulate(terrain(), breaklines=[line, line[::-1], [[30, 10, 1], [70, 10, 1]], line])
    assert len(tin.lines) == 4
    assert ts.check(tin).ok


def test_line_that_crosses_itself_gets_a_vertex_there():
    knot = [[10, 10, 1], [90, 90, 2], [90, 10, 3], [10, 90, 4]]
    tin = ts.triangulate(terrain(), breaklines=[knot])
    assert len(tin.report.crossings.vertices) == 1
    assert ts.check(tin).ok
    with pytest.raises(ts.LinesError, match="itself"):
        ts.triangulate(terrain(), breaklines=[knot], crossing="error")


def test_line_is_bent_onto_points_within_snap():
    points = np.array([[0, 0, 1], [10, 0, 1], [10, 10, 1], [0, 10, 1], [5, 5.04, 7.0]])
    line = [[1, 5, 0], [9, 5, 0]]
    assert len(ts.triangulate(points, breaklines=[line]).lines.vertices) == 2
    tin = ts.triangulate(points, breaklines=[line], snap=0.1)
    assert tin.points[tin.lines.vertices].tolist() == [[1, 5, 0], [5, 5.04, 7], [9, 5, 0]]
    assert ts.check(tin).ok


# ------------------------------------------------------ boundary, holes, erasing

CONCAVE = [[10, 10], [90, 10], [90, 90], [50, 40], [10, 90]]


def test_boundary_cuts_exactly_and_tells_who_is_out():
    points = terrain()
    tin = ts.triangulate(points, boundary=[CONCAVE])
    assert tin.area == pytest.approx(polygon(CONCAVE).area, rel=1e-12)
    inside = shapely.contains_xy(polygon(CONCAVE), points[:, 0], points[:, 1])
    np.testing.assert_array_equal(tin.vertex_of >= 0, inside)
    np.testing.assert_array_equal(tin.report.left_out_rows, np.flatnonzero(~inside))
    assert {LEFT_OUT[code] for code in tin.report.left_out_why} == {"outside the boundary"}
    assert ts.check(tin, points=points).ok
    for vertex, row in zip(tin.vertex_of[inside], points[inside], strict=True):
        assert tin.points[vertex].tolist() == row.tolist()


def test_draped_boundary_leaves_the_surface_as_it_was():
    points = terrain()
    whole, tin = ts.triangulate(points), ts.triangulate(points, boundary=[CONCAVE])
    ring = polygon(CONCAVE).exterior
    along = np.array(
        [ring.interpolate(s, normalized=True).coords[0] for s in np.linspace(0, 1, 300)]
    )
    inner = along + 1e-7 * (np.array([50, 25]) - along)
    np.testing.assert_allclose(tin.interpolate(inner), whole.interpolate(inner), atol=1e-5)


def test_boundary_with_heights_is_that_of_the_surface():
    ring = [[10, 10, 50], [90, 10, 51], [90, 90, 52], [10, 90, 53]]
    tin = ts.triangulate(terrain(), boundary=[ring])
    assert {tuple(p) for p in tin.points[tin.boundary[0]].tolist()} >= {
        tuple(map(float, p)) for p in ring
    }


def test_several_boundaries_and_a_ring_within_a_ring():
    left, right = [[5, 5], [40, 5], [40, 95], [5, 95]], [[60, 5], [95, 5], [95, 95], [60, 95]]
    island = [[65, 20], [90, 20], [90, 80], [65, 80]]
    tin = ts.triangulate(terrain(), boundary=[left, right, island])
    wanted = polygon(left).area + polygon(right).area - polygon(island).area
    assert tin.area == pytest.approx(wanted, rel=1e-12)
    assert ts.check(tin).ok


def test_boundary_beyond_the_points_ends_where_they_end():
    points = terrain()
    ring = [[-50, -50], [50, -20], [150, 60], [40, 45], [20, 180]]
    tin = ts.triangulate(points, boundary=[ring])
    assert tin.area == pytest.approx(hull_of(points).intersection(polygon(ring)).area, rel=1e-9)
    assert any("outside the surface" in note for note in tin.report.notes)
    assert ts.check(tin).ok


def test_holes_are_cut_out():
    holes = [[[20, 20], [40, 20], [40, 40], [20, 40]], [[60, 60, 9], [80, 60, 9], [70, 80, 9]]]
    tin = ts.triangulate(terrain(), boundary=[[*CONCAVE[:3], [10, 90]]], holes=holes)
    wanted = polygon([*CONCAVE[:3], [10, 90]]).difference(
        shapely.union_all([polygon(h) for h in holes])
    )
    assert tin.area == pytest.approx(wanted.area, rel=1e-12)
    assert len(tin.rings) == 3
    assert np.isnan(tin.interpolate([[30, 30]])).all()
    assert ts.check(tin).ok


def test_erased_points_are_spanned():
    points, ring = terrain(), [[30, 30], [70, 30], [70, 70], [30, 70]]
    tin = ts.triangulate(points, erase=[ring])
    inside = shapely.contains_xy(polygon(ring), points[:, 0], points[:, 1])
    alone = ts.triangulate(points[~inside])
    assert triangle_set(tin) == triangle_set(alone)
    assert tin.report.to_dict()["left_out"] == {"erased": np.flatnonzero(inside).tolist()}


# ------------------------------------------------------------------------ water


def test_water_is_flat_and_nothing_stands_in_it():
    pond = [[30, 30], [70, 35], [60, 70], [35, 60]]
    points = terrain()
    tin = ts.triangulate(points, water=[ts.Water(pond, 2.5, name="pond")], breaklines=cross_of())
    places = np.array(shapely.MultiPoint(points[:, :2]).intersection(polygon(pond)).geoms)
    xy = np.array([[p.x, p.y] for p in places])
    assert len(xy) > 20
    np.testing.assert_array_equal(tin.interpolate(xy), 2.5)
    inside = shapely.contains_xy(polygon(pond), points[:, 0], points[:, 1])
    assert tin.report.to_dict()["left_out"] == {"in water": np.flatnonzero(inside).tolist()}
    middle = shapely.LineString(cross_of()[0]).intersection(polygon(pond)).centroid
    for chain, kind in zip(tin.lines.chains(), tin.lines.kinds, strict=True):
        if kind == "hard":
            assert shapely.LineString(tin.points[chain, :2]).distance(middle) > 5
    assert ts.check(tin, points=points).ok


def test_breakline_meets_the_shore_at_the_height_of_the_water():
    pond = [[40, 40], [60, 40], [60, 60], [40, 60]]
    line = ts.Breakline([[5, 50, 90], [95, 50, 90]], priority=7)
    tin = ts.triangulate(terrain(), water=[ts.Water(pond, 2.5)], breaklines=[line])
    np.testing.assert_array_equal(tin.interpolate([[40, 50], [60, 50]]), 2.5)
    assert [met["elevations"] for met in tin.report.to_dict()["crossings"]] == [
        [90, 2.5],
        [90, 2.5],
    ]


def test_line_beside_water_within_a_rounding_is_kept():
    """The rounded middle of the line lies in the water, which its ends and itself only pass."""
    line = [[51145.338198906, 35801.8367392342, 1.0], [94041.46643103092, 65829.12650172165, 5.0]]
    lakes = [
        ts.Water(
            [
                [0, 0],
                [92284.28620065398, 64599.10034045778],
                [71730.88144296753, 50211.717010077264],
            ],
            0.0,
        ),
        ts.Water([[0, 0], [0, 112761], [0, 102198]], 2.0),
    ]
    tin = ts.triangulate(NONE, breaklines=[line], water=lakes)
    assert tin.lines.kinds == ("hard", "water", "water")
    assert tin.points[tin.lines.vertices[:2]].tolist() == line


def test_line_from_shore_to_shore_of_narrow_water_stays_where_it_is_outside():
    """Four corners on a slanted line but for roundings: their diagonal, in exact fractions."""
    rng = np.random.default_rng(2)
    far = [[-1e4, -1e4, 0], [1e4, -1e4, 0], [0, 1e4, 0]]
    outside = []
    while len(outside) < 100:
        x = 1000 * rng.random(4)
        ring = np.column_stack([x, x * 0.7 + 0.1 + rng.integers(-3, 4, 4) * np.spacing(700.0)])
        a, b, c, d = ring
        sides = {turn(a, c, b), turn(a, c, d)}
        if 0 in sides or is_crossing(a, b, c, d) or is_crossing(b, c, d, a):
            continue
        line = [[*a, 5], [*c, 5]]
        tin = ts.triangulate(far, breaklines=[line], water=[ts.Water(ring, 1)])
        outside.append(len(sides) == 1)
        assert ("hard" in tin.lines.kinds) == outside[-1]
    assert 20 < sum(outside) < 80


def turn(a, b, c):
    """Return the sign of the turn from a over b to c."""
    (ax, ay), (bx, by), (cx, cy) = ([Fraction(v) for v in place] for place in (a, b, c))
    area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    return (area > 0) - (area < 0)


def is_crossing(a, b, c, d):
    return turn(a, b, c) * turn(a, b, d) <= 0 and turn(c, d, a) * turn(c, d, b) <= 0


# ------------------------------------------------------------- long edges, conforming


def test_trimming_from_the_perimeter_keeps_long_edges_inside():
    points = np.concatenate([terrain(300), [[300, 50, 0]]])
    ring = [[20, 20], [80, 20], [80, 80], [20, 80]]
    options = {"max_edge": 25.0, "erase": [ring]}
    tin = ts.triangulate(points, **options)
    everywhere = ts.triangulate(points, trim="everywhere", **options)
    assert tin.vertex_of[-1] == everywhere.vertex_of[-1] == -1
    assert tin.report.to_dict()["left_out"]["trimmed"][-1] == len(points) - 1
    assert len(tin.rings) == 1
    assert len(everywhere.rings) > 1
    for one in (tin, everywhere):
        assert ts.check(one).ok
        length = np.hypot(*(one.points[one.edges[:, 0], :2] - one.points[one.edges[:, 1], :2]).T)
        assert (length.max() > 25.0) == (one is tin)
        rim = np.concatenate(
            [one.points[r, :2] - one.points[np.roll(r, -1), :2] for r in one.rings]
        )
        assert np.hypot(*rim.T).max() <= 25.0


def test_conforming_surface_is_delaunay_without_its_flags():
    lines = [*cross_of(), [[20, 20, 1], [21, 80, 1], [22, 20, 1]]]
    plain = ts.triangulate(terrain(), breaklines=lines)
    tin = ts.triangulate(terrain(), breaklines=lines, conforming=True)
    assert not ts.check(ts.TIN.from_triangles(plain.points, plain.triangles)).ok
    assert ts.check(ts.TIN.from_triangles(tin.points, tin.triangles)).ok
    assert ts.check(tin).ok
    assert len(tin.points) > len(plain.points)
    for chain, line in zip(tin.lines.chains(), lines, strict=True):
        way, given = shapely.LineString(tin.points[chain, :2]), shapely.LineString(line)
        assert way.hausdorff_distance(shapely.force_2d(given)) < 1e-9


# --------------------------------------------------------------------- bad input

NAN = float("nan")
BOW_TIE = [[10, 10], [90, 90], [90, 10], [10, 90]]


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        ({"breaklines": [[[1, 1, 1]]]}, r"(?i)breakline.*shape \(1, 3\)"),
        ({"breaklines": [[[1, 1, 1], [2, NAN, 1]]]}, "not finite"),
        ({"breaklines": [[[1, 1, 1], [2, np.inf, 1]]]}, "not finite"),
        ({"breaklines": [[[1, 1, 1], [2, 1e300, 1]]]}, "exact range"),
        ({"breaklines": [["a", "b"]]}, "no table of real numbers"),
        ({"breaklines": 5}, "sequence of lines"),
        ({"breaklines": [[[1, 1, 1], [1, 1, 2]]]}, "Breakline 0 has all its vertices at one"),
        ({"boundary": [[[1, 1], [2, 2]]]}, "Boundary ring 0"),
        ({"boundary": [[[1, 1], [2, 2], [1, 1]]]}, "three"),
        ({"boundary": [BOW_TIE]}, "Boundary 0 crosses itself"),
        ({"holes": [BOW_TIE]}, "Hole 0 crosses itself"),
        ({"water": [ts.Water(BOW_TIE, 1.0)]}, "Water 0 crosses itself"),
        ({"holes": [[[200, 200], [210, 200], [205, 210]]]}, "Hole 0 lies outside"),
        ({"boundary": [[[200, 200], [210, 200], [205, 210]]]}, "leave no triangle"),
        ({"max_edge": 1e-3}, "No triangle is left"),
        ({"water": [[[1, 1], [2, 2], [1, 2]]]}, r"tinsmith\.Water"),
        ({"erase": [[[-99, -99], [199, -99], [199, 199], [-99, 199]]]}, "points"),
    ],
)
def test_bad_lines_are_refused_in_one_sentence(options, sentence):
    with pytest.raises((ts.LinesError, ts.PointsError), match=sentence) as caught:
        ts.triangulate(terrain(), **options)
    assert str(caught.value).count("\n") == 0


@pytest.mark.parametrize(
    ("make", "sentence"),
    [
        (lambda: ts.Water([[1, 1], [2, 2], [1, 2]], NAN), "finite number"),
        (lambda: ts.Water([[1, 1], [2, 2]], 1.0), "k >= 3"),
    ],
)
def test_bad_values_are_refused_in_one_sentence(make, sentence):
    with pytest.raises(ts.LinesError, match=sentence):
        make()


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        ({"max_edge": -1}, "Invalid max_edge -1: it must be a length > 0"),
        ({"max_edge": NAN}, "Invalid max_edge nan: it must be a length > 0"),
        ({"trim": "inside"}, "Invalid trim 'inside': it must be one of perimeter, everywhere"),
        ({"crossing": "ignore"}, "Invalid crossing 'ignore': it must be one of split, error"),
    ],
)
def test_bad_options_are_refused_in_one_sentence(options, sentence):
    with pytest.raises(ts.OptionError, match=sentence) as caught:
        ts.triangulate(terrain(), **options)
    assert [(caught.value.option, caught.value.value)] == list(options.items())


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        ({"kind": "sharp"}, "Invalid kind 'sharp': it must be one of hard, soft"),
        (
            {"priority": 0.5},
            "Invalid priority 0.5: it must be a whole number from -900719",
        ),
        ({"name": ["a"]}, r"Invalid name \['a'\]: it must be text"),
    ],
)
def test_bad_options_of_a_breakline_are_refused_in_one_sentence(options, sentence):
    with pytest.raises(ts.OptionError, match=sentence):
        ts.Breakline([[1, 1, 1], [2, 2, 2]], **options)


# ------------------------------------------------------------------ found by trying


def small_grid():
    xy = np.stack(np.meshgrid(np.arange(5.0), np.arange(6.0)), axis=-1).reshape(-1, 2)
    return np.c_[xy, np.full(len(xy), 0.5)]


@pytest.mark.parametrize("order", [(0, 1), (1, 0)])
def test_ponds_that_overlap_and_share_a_corner(order):
    ponds = [[[0, 2], [0, 0], [2, 1], [3, 1]], [[0, 0], [3, 0], [2, 5]]]
    tin = ts.triangulate(small_grid(), water=[ts.Water(ponds[i], 1.0) for i in order])
    union = shapely.union_all([polygon(pond) for pond in ponds])
    inner = np.array([[1.0, 1.2], [1.8, 2.0], [2.0, 0.6]])
    assert shapely.contains_xy(union, inner[:, 0], inner[:, 1]).all()
    np.testing.assert_array_equal(tin.interpolate(inner), 1.0)
    assert ts.check(tin).ok


@pytest.mark.parametrize("option", ["holes", "boundary"])
def test_ring_across_a_pond_cuts_it(option):
    pond = ts.Water([[0, 2], [0, 0], [2, 1], [3, 1]], 1.0)
    ring = [[0.5, 0.5], [4, 1], [4, 4], [1, 4]]
    tin = ts.triangulate(small_grid(), water=[pond], **{option: [ring]})
    inside = polygon(ring).area
    assert tin.area == pytest.approx(20 - inside if option == "holes" else inside, rel=1e-12)
    assert ts.check(tin).ok


@pytest.mark.parametrize("seed", range(12))
def test_boundary_across_the_rim_leaves_no_sliver(seed):
    rng = np.random.default_rng(seed)
    points = np.c_[rng.random((30, 2)) * 100, rng.random(30)]
    ring = [[20, 20], [110, 20], [110, 110], [20, 110]]
    tin = ts.triangulate(points, boundary=[ring], breaklines=[rng.random((3, 2)) * 140 - 20])
    assert tin.area == pytest.approx(hull_of(points).intersection(polygon(ring)).area, rel=1e-9)
    assert ts.check(tin).ok


# ------------------------------------------------------------- at the very limits


@pytest.mark.parametrize("trim", ["perimeter", "everywhere"])
def test_an_edge_exactly_as_long_as_the_longest_allowed_stays(trim):
    """Four 3-4-5 triangles: the edges of 4 are at the limit, not beyond it."""
    points = [[0, 0, 1], [4, 0, 1], [4, 6, 1], [0, 6, 1], [2, 3, 2]]
    whole = ts.triangulate(points)
    assert len(whole.triangles) == 4
    assert len(ts.triangulate(points, max_edge=6.0, trim=trim).triangles) == 4
    assert len(ts.triangulate(points, max_edge=4.0, trim=trim).triangles) == 2
    with pytest.raises(ts.TinsmithError):
        ts.triangulate(points, max_edge=np.nextafter(4.0, 0), trim=trim)


def test_corners_of_a_boundary_within_water_have_its_level():
    pond = [[30, 30], [70, 30], [70, 70], [30, 70]]
    ring = [[5, 5], [50, 50], [95, 5], [95, 95], [5, 95]]
    tin = ts.triangulate(terrain(), boundary=[ring], water=[ts.Water(pond, 2.5)])
    xy = tin.points[:, :2]
    (corner,) = np.flatnonzero((xy == (50, 50)).all(axis=1))
    assert tin.points[corner, 2] == 2.5
    inside = ((xy >= 30) & (xy <= 70)).all(axis=1)
    assert (tin.points[inside, 2] == 2.5).all()
    assert ts.check(tin).ok


@pytest.mark.parametrize(
    ("line", "sentence"),
    [
        ([["a", "b"], ["c", "d"]], "A breakline is no table of real numbers."),
        ([[1, 2], [3]], "A breakline is no table of real numbers."),
        ({"a": [0, 1], "b": [2, 3]}, "columns 'a', 'b', and none of them is called easting"),
    ],
)
def test_what_is_no_line_is_told_of_the_line(line, sentence):
    with pytest.raises(ts.LinesError) as caught:
        ts.Breakline(line)
    assert sentence in str(caught.value)
    assert "table" not in str(caught.value).replace(sentence, "")


def test_equal_coordinates_are_equal_bytes():
    line = ts.Breakline([[-0.0, 1.0, -0.0], [2.0, -0.0, 3.0]])
    assert not np.signbit(line.coords).any()
    assert not line.coords.flags.writeable
    with pytest.raises(
        ts.LinesError, match=r"has 2 vertices that are not finite .*vertex 1, \[nan"
    ):
        ts.Breakline([[0, 0, 0], [np.nan, 1, 2], [3, np.inf, 4]])


def test_draped_lines_cross_alike_in_any_order():
    """Their elevations at a crossing differ by roundings of the surface's; one of them counts."""
    crossings = 0
    for seed in range(12):
        rng = np.random.default_rng(seed)
        points = np.c_[rng.random((60, 2)) * 100, rng.random(60) * 50]
        lines = [rng.random((2, 2)) * 80 + 10 for _ in range(4)]
        tin = ts.triangulate(points, breaklines=lines)
        other = ts.triangulate(points, breaklines=lines[::-1])
        crossings += len(tin.report.crossings.vertices)
        rows, same = (one.points[np.lexsort(one.points.T)] for one in (tin, other))
        np.testing.assert_array_equal(rows, same)
    assert crossings > 10


@pytest.mark.parametrize("first", range(4))
def test_a_crossing_that_rounds_to_a_given_vertex_is_that_vertex(first):
    """Lines through (1/3, 1/3), which is no double: the nearest double is a point, on neither."""
    third = 1.0 / 3.0
    points = [[third, third, 7], [3, 0, 1], [3, 3, 2], [-3, -3, 3]]
    points = np.roll(points, first, axis=0)
    lines = [[[0, 1, 0], [1, -1, 0]], [[-1, 1, 5], [3, -1, 5]]]
    tin = ts.triangulate(points, breaklines=lines)
    assert ts.check(tin, points=ts.Survey(points=points, breaklines=lines)).ok
    assert len(np.unique(tin.points[:, :2], axis=0)) == len(tin.points) == 8
    (place,) = tin.report.crossings.xy
    assert place.tolist() == [third, third]
    assert tin.report.crossings.vertices.tolist() == [first]


def test_lines_are_shown_in_one_line():
    assert repr(ts.Breakline([[0, 0, 1], [1, 1, 2]])) == "<Breakline: hard, 2 vertices>"
    draped = ts.Breakline([[0, 0], [1, 1], [2, 0]], kind="soft", name="kerb")
    assert repr(draped) == "<Breakline: soft, 3 vertices, draped, 'kerb'>"
    tin = ts.triangulate(
        [[0, 0, 0], [9, 0, 0], [9, 9, 0], [0, 9, 0]], breaklines=[[[1, 1, 1], [2, 2, 2]]]
    )
    assert repr(tin.lines) == ("<Lines: 1 hard, 0 soft, 0 boundary, 0 hole, 0 water; 2 vertices>")


def test_a_draped_line_ends_at_the_hull_where_a_crossing_was_rounded_beyond_it():
    """Where two parts of the line cross, on the hull but for a rounding, it was left out whole."""
    points = [[0, 2, 0], [1 / 3, 2 + 1 / 3, 0]]
    draped = ts.Breakline(np.array([[1, 1], [0, 2.3], [1, 3], [0, 2]]))
    low = ts.Breakline(np.array([[0.0, 0, 0], [1, 0, 2]]), kind="soft")
    tin = ts.triangulate(points, breaklines=[draped, low])
    given = ts.Survey(points=points, breaklines=[draped, low])
    assert ts.check(tin, points=given).ok
    inside = polygon([[0, 0], [1, 0], [1 / 3, 2 + 1 / 3], [0, 2]]).buffer(1e-12)
    kept = shapely.LineString(draped.coords[:, :2]).intersection(inside).length
    found = [tin.points[chain][:, :2] for chain in tin.lines.chains()]
    drawn = sum(
        np.hypot(*np.diff(xy, axis=0).T).sum()
        for xy, name in zip(found, tin.lines.kinds, strict=True)
        if name == "hard"
    )
    assert drawn == pytest.approx(kept, rel=1e-9)
