"""Conforming TINs: every edge Delaunay, whatever the rounding of split points does to lines."""

from __future__ import annotations

import numpy as np
import pytest

import tinsmith as ts
from tinsmith.tin.constraints import conforming

NONE = np.empty((0, 3))

FAR_APART = [
    [[0, 0, 0], [1e70, 1e70, 1]],
    [[0, 1e-55, 0], [1e70, 1e69, 0]],
    [[1e-55, 0, 0], [1e70, 9e69, 1]],
]


def require_conforming(tin, points=None, lines=()):
    ts.check(tin, points=points, breaklines=lines, conforming=True).raise_if_failed()


def faces(tin):
    return {frozenset(map(tuple, rows)) for rows in tin.points[tin.triangles].tolist()}


def test_split_point_on_another_segment():
    """Rounded, the middle of one line lies on another one, which it splits."""
    lines = [
        [[1 / 6, 1.0, 5.0], [0.0, 0.0, -5.0]],
        [[0.5, 0.75, -2.0], [0.0, 1.0, -1.0]],
        [[0.0, 2 / 3], [0.0, 1.0], [0.5, 0.75]],
    ]
    require_conforming(ts.triangulate(NONE, breaklines=lines, conforming=True), lines=lines)


def test_split_points_of_two_segments_at_one_place():
    points = [
        [499.9999999999999, 508.3333333333332, 0.0],
        [508.0000000000001, 497.6666666666666, 2.0],
    ]
    line = [
        [506.5904785324072, 509.7137127514814, -5.0],
        [493.3333333333333, 495.00000000000006, 3.0],
        [493.33333333333326, 494.9999999999999, -4.0],
        [506.5904785324072, 509.7137127514814, 1.0],
    ]
    tin = ts.triangulate(points, breaklines=[line], conforming=True)
    require_conforming(tin, points, [line])


def test_split_point_at_a_vertex_that_is_there():
    points = [
        [11.999999999999996, 12.000000000000002, 1],
        [12.000000000000007, 11.999999999999998, 0],
    ]
    line = [[11.999999999999995, 12.0, 1.0], [12.0, 12.000000000000004, 4.0]]
    require_conforming(ts.triangulate(points, breaklines=[line], conforming=True), points, [line])


def test_draped_rings_among_lines_of_ordinary_fractions():
    lines = [
        [[0.126266888929234, 0.36871122780773674], [0.8261743514597943, 0.4346365376320648]],
        [
            [0.0005686324696293488, 0.936975817109502, -1.0],
            [0.66459299625531, 0.28648688849131454, -3.0],
        ],
        [
            [0.40811083643408996, 0.15968274322058096, -4.0],
            [0.8859344508505368, 0.936975817109502, -2.0],
        ],
    ]
    rings = [
        [
            [0.2527565769925852, 0.4537765117057846],
            [0.34737323524948444, 0.3134982398888508],
            [0.6682504114790553, 0.4637664163984147],
        ],
        [
            [0.44325154166008307, 0.5033165313640438],
            [0.2219100870648562, 0.5033165313640438],
            [0.66459299625531, 0.28648688849131454],
        ],
    ]
    tin = ts.triangulate(NONE, breaklines=lines, boundary=rings, conforming=True)
    require_conforming(tin, lines=lines)


def test_split_point_on_a_segment_that_shares_its_other_half():
    """A shore and a boundary ring run along each other but for a rounding."""
    tin = ts.triangulate(
        [[0.0, 1 / 3, -2.0]],
        breaklines=[ts.Breakline([[0.1, 0.8], [0.06666666666666667, 0.1]], kind="soft")],
        boundary=[[[0.0, 0.4], [0.0, 0.3], [0.8, 0.9]], [[0.2, 0.1], [0.7, 0.4], [0.0, 0.4]]],
        water=[ts.Water([[0.0, 0.4], [0.2, 0.1], [0.0, 3.0]], 4.0)],
        conforming=True,
    )
    require_conforming(tin)


def test_magnitudes_far_apart_come_to_an_end():
    tin = ts.triangulate(NONE, breaklines=FAR_APART, conforming=True)
    require_conforming(tin, lines=FAR_APART)
    assert len(tin.points) > 300


def test_lines_that_would_need_too_many_vertices_are_refused(monkeypatch):
    monkeypatch.setattr(conforming, "_LEAST_LIMIT", 200)
    monkeypatch.setattr(conforming, "_NEW_PER_VERTEX", 1)
    with pytest.raises(ts.LinesError, match=r"not conforming after 200 new vertices: \d+ segment"):
        ts.triangulate(NONE, breaklines=FAR_APART, conforming=True)


def test_rounds_are_limited(monkeypatch):
    monkeypatch.setattr(conforming, "_MOST_ROUNDS", 3)
    with pytest.raises(ts.LinesError, match="not conforming after 3 rounds of splitting"):
        ts.triangulate(NONE, breaklines=FAR_APART, conforming=True)


@pytest.mark.parametrize("seed", range(5))
def test_same_for_any_order_of_rows_and_direction_of_lines(seed):
    """The middle of a segment is the same from both ends, whatever their numbers."""
    rng = np.random.default_rng(seed)
    points = np.c_[rng.random((20, 2)) * 10 / 3, rng.integers(0, 9, 20)]
    lines = [np.c_[rng.random((3, 2)) * 10 / 3, rng.integers(0, 9, 3)] for _ in range(3)]
    tin = ts.triangulate(points, breaklines=lines, conforming=True)
    other = ts.triangulate(
        points[rng.permutation(20)], breaklines=[line[::-1] for line in lines], conforming=True
    )
    assert len(tin.points) > len(ts.triangulate(points, breaklines=lines).points)
    assert faces(tin) == faces(other)


def test_elevation_where_a_line_folds_back_on_itself_has_no_direction():
    line = [
        [0.8177492862984986, 2.7985726447850454, 1.0],
        [0.7009599389946548, 2.4131677986823608, -5.0],
        [0.746337581631955, 2.562914019385451, -5.0],
    ]
    point = [[32578.0669116157, 110859.35563720524, -3.0]]
    tins = [ts.triangulate(point, breaklines=[way], conforming=True) for way in (line, line[::-1])]
    assert faces(tins[0]) == faces(tins[1])


def test_elevation_where_parts_of_one_line_cross_anew_has_no_direction():
    """Water cuts the line, which folds back on itself, into parts that cross once split."""
    there = [0.0049410027624890995, 100.00164700092083]
    draped = [there, [0.8690177204266133, 100.28967257347554]]
    line = [
        [2.653223443325734, 100.88440781444191, 0.0],
        [*there, 3.0],
        [0.6555955232764222, 100.21853184109214, -4.0],
        [*there, 4.0],
    ]
    lake = ts.Water([[0.8, 100.3], [0.6, 100.3], [0.7, 100.1]], 0.0)
    tins = [
        ts.triangulate(NONE, breaklines=[draped, way], water=[lake], conforming=True)
        for way in (line, line[::-1])
    ]
    assert faces(tins[0]) == faces(tins[1])


def test_vertices_made_in_water_and_lines_keep_their_numbers():
    """Points in water leave gaps in the numbers, which splitting closes."""
    rng = np.random.default_rng(1)
    points = np.c_[rng.random((60, 2)) * 10, rng.random(60)]
    pond = ts.Water([[3, 3], [7, 3.1], [6.9, 7], [3.1, 6.9]], 0.5)
    line = [[0, 1, 1], [10, 1.3, 2]]
    tin = ts.triangulate(points, breaklines=[line], water=[pond], conforming=True)
    require_conforming(tin, ts.Survey(points=points, water=[pond]), [line])
    assert (tin.vertex_of < 0).any()
    np.testing.assert_allclose(tin.interpolate([[5.0, 5.0]]), 0.5)


def test_check_asks_constrained_edges_too_if_they_are_to_conform():
    points = [[0, 0, 1], [10, 0, 1], [5, 1, 1], [5, -1, 1]]
    plain = ts.triangulate(points, breaklines=[[[0, 0, 1], [10, 0, 1]]])
    assert ts.check(plain).ok
    (problem,) = ts.check(plain, conforming=True).problems
    assert problem.kind == "delaunay"
    assert problem.count == 1
    assert ts.check(plain, level=2, conforming=True).ok


# ------------------------------------------------- the same campaign, without conforming


def test_draped_line_over_a_nearly_collinear_hull_loses_no_vertex():
    """The boundary, bent by a rounding, would leave a whole vertex outside."""
    lines = [
        [
            [23.100000000000005, 10799999.999999994, -4.0],
            [7.700000000000001, 5400000.000000002, 1.0],
        ],
        [[1.9999999999999987, 33333.333333333336], [23.10000000000001, 10800000.000000002]],
        [
            [0.9999999999999998, 33333.33333333334, 1.0],
            [2.000000000000001, 33333.33333333333, -1.0],
        ],
    ]
    tin = ts.triangulate(NONE, breaklines=lines)
    ts.check(tin, breaklines=lines).raise_if_failed()
    there = set(map(tuple, tin.points[:, :2].tolist()))
    assert all(tuple(v[:2]) in there for line in (lines[0], lines[2]) for v in line)


def test_check_follows_a_draped_line_that_returns_along_itself():
    there = [512345.06000000006, 5403214.769999999]
    lines = [
        [there, [512498.91, 5403385.78], there],
        [
            [512373.62000000005, 5403285.140000001, -2.0],
            [512508.1, 5403220.77, -5.0],
            [512391.92, 5403338.34, 5.0],
        ],
    ]
    tin = ts.triangulate(NONE, breaklines=lines)
    ts.check(tin, breaklines=lines).raise_if_failed()


def test_elevation_of_snapped_parts_of_a_draped_line_has_no_direction():
    ridge = [[975.79, -218.69, 3.0], [0.96, 0.27, -4.0], [-871.98, 489.54, 1.0]]
    draped = [[-52.0, -39.0], [812.25, 583.31], [0.0, -65.0]]
    tins = [
        ts.triangulate(NONE, breaklines=[ridge[::way], draped[::way]], snap=99.0) for way in (1, -1)
    ]
    assert faces(tins[0]) == faces(tins[1])


def test_ring_with_two_elevations_where_it_closes_has_the_lower_one_both_ways():
    ring = [[0, 0, 3.0], [0, 0, 1.0], [9, 1, 0.0], [8, 9, 4.0]]
    for corners in (ring, [ring[0], *ring[:0:-1]]):
        tin = ts.triangulate([[-5, -5, 0], [15, -5, 0], [0, 20, 0]], holes=[corners])
        assert (0.0, 0.0, 1.0) in set(map(tuple, tin.points.tolist()))
        (note,) = tin.report.notes
        assert note == (
            "1 ring closes with more than one elevation (first: hole ring 0 at x 0, y 0, 1 to 3): "
            "the lowest was taken."
        )


def test_rings_with_one_elevation_where_they_close_have_no_note():
    ring = [[0, 0, 1.0], [9, 1, 0.0], [9, 1, 5.0], [8, 9, 4.0], [0, 0, 1.0]]
    corners = [[-5, -5, 0], [15, -5, 0], [0, 20, 0]]
    assert not ts.triangulate(corners, holes=[ring, [v[:2] for v in ring]]).report.notes


def test_elevation_at_a_crossing_of_a_ring_is_the_same_wherever_the_ring_begins():
    """The lower of two elevations at its first corner, not one for each direction."""
    ring = [[1000, 935, 5.0], [1000, 935, 0.0], [0, 0, 0.0], [967, 1056, 0.0]]
    other = [[940, 0], [0, 0], [1000, 1065]]
    tins = [ts.triangulate(NONE, holes=[ring[n:] + ring[:n], other]) for n in range(4)]
    assert tins[0].points[:, 2].max() == 0.0
    for tin in tins[1:]:
        assert faces(tin) == faces(tins[0])


def test_elevation_at_a_crossing_of_a_ring_whose_first_corners_snap_together():
    """One elevation at the merged corner for both directions, wherever the ring begins."""
    ring = [[0, 0, 2.0], [0.1, 0, 0.0], [10, 0, 0.0], [10, 10, 0.0], [0, 10, 0.0]]
    other = [[-1, 4, 0.0], [1, 4, 0.0], [1, 6, 0.0], [-1, 6, 0.0]]
    for n in range(5):
        for corners in (ring[n:] + ring[:n], (ring[n:] + ring[:n])[::-1]):
            tin = ts.triangulate(NONE, boundary=[corners], holes=[other], snap=0.5)
            assert tin.points[:, 2].tolist() == [0.0] * 8


# ------------------------------------------------- which way along a line, with a large snap


def test_check_finds_a_line_cut_in_a_cascade_whose_begin_was_trimmed():
    """Its part from (8064, 0) is bent onto (59, 20), (70, 23) and (78, 26), a snap each."""
    lines = [
        [[59.0, 20.0, 1.0], [70.0, 23.0, 0.0]],
        [[8064.0, 0.0, 0.0], [0.0, 16.0, 0.0], [0.0, 62298.0, 0.0], [78.0, 26.0, 0.0]],
    ]
    tin = ts.triangulate(NONE, breaklines=lines, snap=4.4, max_edge=85.0)
    chain = tin.points[tin.lines.vertices[tin.lines.offsets[1] :][:4], :2].tolist()
    assert chain == [[78.0, 26.0], [70.0, 23.0], [59.0, 20.0], [0.0, 16.0]]
    ts.check(tin, breaklines=lines).raise_if_failed()


def test_check_finds_both_ways_of_a_line_that_returns_through_trimmed_parts():
    """The second chain begins where the first, a likely but wrong part of the line, did not end."""
    lines = [
        [[59.0, 20.0, 1.0], [70.0, 23.0, 0.0]],
        [[8064.0, 0.0, 0.0], [0.0, 16.0, 0.0], [88998.0, 0.0, 0.0], [78.0, 26.0, 0.0]],
    ]
    survey = ts.Survey(points=[[91.0, 30.0, 0.0]], breaklines=list(map(ts.Breakline, lines)))
    tin = ts.triangulate(survey, snap=4.4, max_edge=85.0)
    assert tin.lines.sources.tolist() == [0, 1, 1]
    ts.check(tin, points=survey).raise_if_failed()


def test_check_does_not_take_the_first_vertex_within_snap_for_the_line_s_own():
    """(0, 187732) is within snap of (0, 0), too, which became (0, -144288), outside."""
    survey = ts.Survey(
        points=[[-148336.7, 0.0, 0.0], [0.0, -144288.0, 1.0]],
        breaklines=[ts.Breakline([[0, 15226533.0, 0], [0, 0, 2.0], [0, 187732.0, 0]])],
        boundary=[[[-148337.0, 0.0], [0.0, 0.0], [0.0, 183972197.0]]],
    )
    tin = ts.triangulate(survey, snap=194760.0)
    assert tin.lines.sources.tolist()[:2] == [0, 0]
    ts.check(tin, points=survey).raise_if_failed()


def test_check_finds_a_draped_part_that_snaps_back_behind_the_one_before():
    """What is in the needle of its second segment, 1e-8 long, became an edge of length 0.4."""
    lines = [
        [[512345.2, 0.0, 0.0], [512345.0, 5403210.4, 0.0], [512345.5, 0.0, 5.0]],
        [[512345.4, 0.0], [512345.0, 5403210.2], [512345.2, 5403210.2]],
    ]
    tin = ts.triangulate(NONE, breaklines=lines, snap=0.25)
    assert tin.lines.sources.tolist() == [0, 1, 1]
    ts.check(tin, breaklines=lines).raise_if_failed()


def test_check_finds_which_of_two_vertices_equally_near_became_the_line_s_own():
    """The first of them is the line's last vertex, too, to which the second chain leads."""
    x, y = 512345.0, 5403210.0
    lines = [
        [[x + 0.2, 0.0, 0.0], [x, y + 0.4, 0.0], [x + 0.5, y, 5.0]],
        [[x + 0.4, y], [x, y + 0.2], [x + 0.2, y + 0.2]],
    ]
    tin = ts.triangulate(NONE, breaklines=lines, snap=0.25)
    assert tin.lines.sources.tolist() == [0, 1, 1]
    ts.check(tin, breaklines=lines).raise_if_failed()


def test_check_lets_the_next_chain_have_the_line_s_last_vertex():
    """The first chain ends within snap of it, where water that reaches far beyond takes over."""
    points = [[13681.0, 16113500.0, 0.0]]
    line = [[14882659.0, 0.0, 4.0], [0.0, 0.0, 4.0]]
    ring = [
        [0.0, -1.3152300785109916e53],
        [1.0, 1884057.0],
        [-14201.0, 1.2028957737263383e46],
    ]
    lake = ts.Water(ring, 1.0)
    tin = ts.triangulate(points, breaklines=[line], water=[lake], snap=329226.0)
    assert tin.lines.kinds == ("hard", "hard", "water")
    survey = ts.Survey(points=np.array(points), breaklines=[ts.Breakline(line)], water=[lake])
    ts.check(tin, points=survey).raise_if_failed()


def test_check_follows_a_line_back_to_where_it_left_the_surface():
    """Between two chains the line goes from the second one's first place into water and back."""
    corner = [41114.701223856886, 13705.000407952295]
    line = [[0.0, 9.0], corner, [40.0, 133.0], corner, [0.0, 0.0]]
    lakes = [
        ts.Water([[0.0, 150.0], [40.0, 131.0], [72694.0, 24231.0]], 0.0),
        ts.Water([[41.0, 134.0], [23206.0, 7735.5], corner], 0.0),
    ]
    tin = ts.triangulate(NONE, breaklines=[line], water=lakes)
    survey = ts.Survey(points=NONE, breaklines=[ts.Breakline(line)], water=lakes)
    ts.check(tin, points=survey).raise_if_failed()


def test_check_still_loses_a_chain_that_is_on_no_part_of_its_line():
    lines = [[[0.0, 0.0, 0.0], [10.0, 0.0, 0.0]], [[0.0, 5.0, 0.0], [10.0, 5.0, 0.0]]]
    tin = ts.triangulate(NONE, breaklines=lines, snap=0.01)
    moved = [lines[0], [[0.0, 6.0, 0.0], [10.0, 6.0, 0.0]]]
    result = ts.check(tin, breaklines=moved)
    assert [problem.kind for problem in result.problems] == ["lines"]


@pytest.mark.parametrize("ring", [[[0, 0], [0, 0], [5, 5]], [[0, 0], [5, 5], [0, 0]]])
def test_ring_of_two_corners_is_refused_wherever_it_begins(ring):
    with pytest.raises(ts.LinesError, match="two corners: a ring needs three"):
        ts.triangulate([[-9, -9, 0], [15, -5, 0], [0, 20, 0]], holes=[ring])


@pytest.mark.parametrize("length", [1.0, 3.0, 5.7, 6.0, 1e-3, 12345.6])
def test_segments_are_split_on_shells_around_the_given_end_or_in_the_middle(length):
    """Lines that meet at a small angle are split as far from it: at powers of two."""
    direction = np.array([0.6, 0.8])
    points = np.zeros((4, 3))
    points[[1, 3], :2] = length * direction
    points[[1, 3], 2] = 8.0
    both, first, second, none = [0, 1], [0, 3], [2, 1], [2, 3]
    for reverse in (False, True):
        segments = np.array(
            [pair[::-1] if reverse else pair for pair in (both, first, second, none)]
        )
        split = conforming._place_split_points(points, segments.astype(np.int32), 2)
        along = split[:, :2] @ direction
        assert along[[0, 3]] == pytest.approx(length / 2)
        for distance in (along[1], length - along[2]):
            assert np.log2(distance) == pytest.approx(round(np.log2(distance)), abs=1e-9)
            assert length / 2 / 2**0.5 * 0.999 <= distance <= length / 2 * 2**0.5 * 1.001
        np.testing.assert_allclose(split[:, 2], 8.0 * along / length, rtol=1e-12)
        np.testing.assert_allclose(split[:, :2], along[:, None] * direction, rtol=1e-12)
