"""Check with lines: sound chains pass, every kind of damage to them is named."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from shapely.geometry import LineString, Point
from support import constrained_oracle as oracle
from support import oracles
from support.each_value import list_seeds

import tinsmith as ts
from tinsmith.tin import TIN, LinesError, check
from tinsmith.tin.checking.chain_matching import _project, distance
from tinsmith.tin.constraints.breaklines import Lines
from tinsmith.tin.report import LEFT_OUT

RNG = np.random.default_rng(8)
CLOUD = np.column_stack([RNG.random((200, 2)) * 100, RNG.random(200)])
KERB = np.array([[10, 10, 1], [40, 35, 2], [60, 80, 3], [90, 85, 4]], float)
DITCH = np.array([[15, 80, 1], [55, 20, 0], [95, 30, 0]], float)
FIELD = [np.array([[5, 5], [70, 8], [92, 50], [60, 95], [8, 90]], float)]
POND = ts.Water([[30, 50], [45, 50], [40, 62]], 0.5)
GIVEN = ts.Survey(points=CLOUD, breaklines=[KERB, DITCH])
CLIPPED = ts.Survey(points=CLOUD, breaklines=[KERB, DITCH], boundary=FIELD, water=[POND])


@pytest.fixture
def tin():
    return ts.triangulate(GIVEN)


def kinds(result):
    return {problem.kind for problem in result.problems}


def sentences(result):
    return " ".join(problem.sentence for problem in result.problems)


def with_lines(tin, **arrays):
    """The TIN with some arrays of its lines exchanged."""
    lines = tin.lines
    own = {name: getattr(lines, name) for name in ("vertices", "offsets", "sources")}
    own = {name: array.copy() for name, array in own.items()}
    return tin.replace(lines=Lines(**(own | {"kinds": lines.kinds, "names": lines.names} | arrays)))


def with_chains(tin, chains):
    """The TIN with other chains, all hard, from sources 0, 1 ..."""
    lines = Lines(
        vertices=np.concatenate(chains).astype(np.int32),
        offsets=np.cumsum([0, *map(len, chains)]).astype(np.int32),
        kinds=("hard",) * len(chains),
        sources=np.arange(len(chains), dtype=np.int32),
        names=("",) * len(chains),
    )
    return tin.replace(lines=lines)


def surface(points, triangles, segments):
    """A TIN of the triangles of an oracle, with a chain for each segment."""
    corners = np.array(sorted(triangles))
    fixed = {frozenset(segment) for segment in segments}
    flags = [[frozenset((t[k - 2], t[k - 1])) in fixed for k in range(3)] for t in corners.tolist()]
    xyz = np.column_stack([np.array(points), np.zeros(len(points))])
    tin = TIN.from_triangles(xyz, corners, constrained=flags)
    return with_chains(tin, segments) if segments else tin


def flips_of(points, triangles):
    """Every flip of one inner edge of a convex quadrilateral: the edge, the new triangles."""
    places = [oracles.place(p) for p in points]
    left_of = {(t[k], t[(k + 1) % 3]): t for t in triangles for k in range(3)}
    for (a, b), one in left_of.items():
        other = left_of.get((b, a))
        if a > b or other is None:
            continue
        (c,), (d,) = set(one) - {a, b}, set(other) - {a, b}
        if all(oracles.orientation(*(places[v] for v in t)) > 0 for t in ((a, d, c), (d, b, c))):
            yield (a, b), (set(triangles) - {one, other}) | {(a, d, c), (d, b, c)}


# ------------------------------------------------------------------ the oracle


def test_oracle_without_segments_is_delaunay():
    for case in oracle.random_cases(1, 30):
        assert oracle.constrained_delaunay(case.points, []) == oracles.delaunay(case.points)


@pytest.mark.slow
def test_definition_and_flips_agree():
    rng = np.random.default_rng(2)
    differ = 0
    for case in oracle.random_cases(2, 80, most_points=9):
        wanted = oracle.constrained_delaunay(*case)
        assert oracle.by_flips(case, rng) == wanted
        sides = {frozenset((t[k - 1], t[k])) for t in wanted for k in range(3)}
        assert {frozenset(segment) for segment in case.segments} <= sides
        differ += wanted != oracles.delaunay(case.points)
    assert differ > 30


def test_wall_hides_a_point_of_the_circle():
    """The circle of the upper triangle holds the point below; the wall stands between."""
    points, wall = [(0, 0), (10, 0), (5, 2), (5, -1)], [(0, 1)]
    assert oracle.constrained_delaunay(points, wall) == {(0, 1, 2), (0, 3, 1)}
    assert oracle.constrained_delaunay(points, []) == {(0, 3, 2), (1, 2, 3)}


def test_clipping_keeps_what_is_inside_rings_and_outside_holes():
    x, y = np.meshgrid(np.arange(4), np.arange(4))
    points = np.column_stack([x.ravel(), y.ravel()]).tolist()
    whole = oracle.constrained_delaunay(points, [])
    assert len(oracle.clipped(points, whole)) == 18
    assert len(oracle.clipped(points, whole, boundary=[[0, 2, 14, 12]])) == 12
    assert len(oracle.clipped(points, whole, holes=[[5, 6, 10, 9]])) == 16


# ----------------------------------------------------- sound TINs, wrong edges


def require_as_oracle(cases):
    for case in cases:
        points = np.column_stack([np.array(case.points), np.zeros(len(case.points))])
        lines = [points[list(segment)] for segment in case.segments]
        tin = ts.triangulate(points, breaklines=lines)
        assert oracles.canonical(tin.triangles) == oracle.constrained_delaunay(*case)
        result = check(tin, points=points, breaklines=lines)
        assert result.problems == result.notes == ()
        assert result.counts.get("chains", 0) == len(lines)


def test_triangulated_lines_are_as_the_oracle_says_and_pass():
    require_as_oracle(oracle.random_cases(3, 150, most_points=8))


@pytest.mark.proof
def test_many_triangulated_lines_are_as_the_oracle_says_and_pass():
    require_as_oracle(oracle.random_cases(5, 1_000, most_points=12, most_segments=20))


def is_tie(points, wanted, flipped):
    """Whether the two triangles of a flip have their four corners on one circle."""
    one, other = flipped - set(wanted)
    (far,) = set(other) - set(one)
    return oracles.in_circle(*(oracles.place(points[v]) for v in (*one, far))) == 0


def test_every_flip_of_a_free_edge_is_found():
    n_flips = n_ties = 0
    for case in oracle.random_cases(4, 70, most_points=9):
        wanted = oracle.constrained_delaunay(*case)
        assert check(surface(case.points, wanted, case.segments)).ok
        for edge, flipped in flips_of(case.points, wanted):
            result = check(surface(case.points, flipped, case.segments))
            if set(edge) in map(set, case.segments):
                assert "lines" in kinds(result)
            else:
                assert kinds(result) == (
                    set() if is_tie(case.points, wanted, flipped) else {"delaunay"}
                )
                assert not result.ok or result.counts["ties_against_rule"] >= 1
                n_ties += result.ok
            n_flips += 1
    assert n_flips > 120
    assert n_ties >= 4


@pytest.mark.parametrize(
    "survey", [GIVEN, CLIPPED, replace(CLIPPED, holes=[FIELD[0] / 8 + [62, 40]])]
)
@pytest.mark.parametrize("options", [{}, {"snap": 2.0}, {"conforming": True}, {"max_edge": 12.0}])
def test_surfaces_with_lines_pass_with_all_that_was_given(survey, options):
    tin = ts.triangulate(survey, **options)
    result = check(tin, points=survey)
    assert result.problems == ()


def test_breaklines_may_be_given_besides_a_survey(tin):
    assert check(tin, points=CLOUD, breaklines=[KERB, DITCH]).ok
    survey = ts.Survey(points=CLOUD, breaklines=[KERB])
    assert check(tin, points=survey, breaklines=[DITCH]).ok
    assert kinds(check(tin, points=survey, breaklines=[DITCH + 1])) == {"lines"}


def test_lines_that_are_none_are_refused(tin):
    with pytest.raises(LinesError):
        check(tin, breaklines=[[[0, 0, 0]]])


# ------------------------------------------------------------------ level 1


CHAINS = {
    "vertices": [np.zeros((2, 2), np.int32), np.zeros(3), np.zeros(0, np.int32)],
    "offsets": [np.zeros(3), np.array([0, 5], np.int32), np.array([1, 5, 9], np.int32)],
    "sources": [np.zeros(2), np.zeros(1, np.int32), np.array([0, -1], np.int32)],
    "kinds": [("hard",), ("hard", "wall")],
    "names": [("",)],
}


@pytest.mark.parametrize(
    ("name", "value"), [(name, value) for name, values in CHAINS.items() for value in values]
)
def test_arrays_of_lines_that_do_not_fit(tin, name, value):
    value = value.copy() if isinstance(value, np.ndarray) else value
    result = check(with_lines(tin, **{name: value}), points=GIVEN)
    assert kinds(result) == {"chains"}


@pytest.mark.parametrize("value", [-1, 100_000])
def test_chain_through_no_vertex(tin, value):
    vertices = tin.lines.vertices.copy()
    vertices[4] = value
    result = check(with_lines(tin, vertices=vertices), level=1)
    assert kinds(result) == {"chains"}
    assert result.problems[0].first == (4,)


def test_chain_of_one_vertex_and_offsets_that_descend(tin):
    end = tin.lines.offsets[-1]
    for middle in (1, 0, -3, end - 1, end + 4):
        offsets = np.array([0, middle, end], np.int32)
        assert kinds(check(with_lines(tin, offsets=offsets))) == {"chains"}


def test_step_that_stays_where_it_is(tin):
    vertices = tin.lines.vertices.copy()
    vertices[3] = vertices[2]
    result = check(with_lines(tin, vertices=vertices))
    assert kinds(result) == {"chains"}
    assert result.problems[0].first == (2,)


def left_out(tin, rows, why):
    report = replace(
        tin.report, left_out_rows=np.array(rows, np.int32), left_out_why=np.array(why, np.int8)
    )
    return tin.replace(report=report)


def test_rows_left_out_are_named():
    tin = ts.triangulate(CLIPPED)
    rows, why = tin.report.left_out_rows, tin.report.left_out_why
    assert len(rows) > 5
    result = check(left_out(tin, rows[1:], why[1:]))
    assert kinds(result) == {"index"}
    assert result.problems[0].first == (rows[0],)


def test_rows_named_as_left_out_are(tin):
    result = check(left_out(tin, [3, 7], [0, 0]))
    assert kinds(result) == {"left_out"}
    assert result.problems[0].first == (3, 7)


@pytest.mark.parametrize(
    ("rows", "why"),
    [([3], []), ([200], [0]), ([-1], [0]), ([3], [len(LEFT_OUT)]), ([3], [-1]), ([7, 3], [0, 0])],
)
def test_account_of_rows_left_out_that_makes_no_sense(tin, rows, why):
    vertex_of = tin.vertex_of.copy()
    vertex_of[rows[: 1 if rows[0] < 200 else 0]] = -1
    broken = left_out(tin.replace(vertex_of=vertex_of), rows, why)
    assert "left_out" in kinds(check(broken))


# ------------------------------------------------------------------ level 3


def test_step_that_is_no_edge(tin):
    first, second = (chain.tolist() for chain in tin.lines.chains())
    result = check(with_chains(tin, [[first[0], *first[2:]], second]))
    assert kinds(result) == {"lines"}
    assert result.problems[0].first == (0,)
    assert "constrained edges inside" in sentences(result)


def test_step_along_an_edge_that_is_not_constrained(tin):
    free = next(edge for edge in tin.edges.tolist() if not set(edge) & set(tin.lines.vertices))
    chains = [chain.tolist() for chain in tin.lines.chains()]
    result = check(with_chains(tin, [*chains, free]))
    assert kinds(result) == {"lines"}
    assert result.problems[0].first == (2,)


def test_constrained_edges_of_no_line(tin):
    first, second = (chain.tolist() for chain in tin.lines.chains())
    result = check(with_chains(tin, [first[:-1], second]))
    assert kinds(result) == {"lines"}
    assert result.problems[0].count == 1
    assert check(with_chains(tin, [first[:-1], second]), level=2).ok


def test_constrained_edges_without_any_lines_are_a_note(tin):
    result = check(tin.replace(lines=Lines()))
    assert result.ok
    assert [note.kind for note in result.notes] == ["lines"]
    assert result.notes[0].count == len(tin.lines.segments())


# ------------------------------------------------------- lines that were given


def given(breaklines):
    return replace(GIVEN, breaklines=breaklines)


def test_line_that_is_not_there():
    tin = ts.triangulate(CLOUD, breaklines=[KERB])
    result = check(tin, points=GIVEN)
    assert kinds(result) == {"lines"}
    assert "missing" in sentences(result)


@pytest.mark.parametrize("vertex", [0, 1, 3])
def test_vertex_of_a_line_beside_its_chain(tin, vertex):
    for far in (1e-9, 1.0):
        moved = KERB.copy()
        moved[vertex, 1] += far
        result = check(tin, points=given([moved, DITCH]))
        assert kinds(result) == {"lines"}
        assert all(problem.first == (0,) for problem in result.problems)


def test_vertex_that_the_chain_does_not_have(tin):
    more = np.insert(KERB, 1, [20, 25, 0], axis=0)
    assert kinds(check(tin, points=given([more, DITCH]))) == {"lines"}
    on_the_line = np.insert(KERB, 1, [25, 22.5, 0], axis=0)
    assert kinds(check(tin, points=given([on_the_line, DITCH]))) == {"lines"}


def test_vertex_that_only_the_chain_has(tin):
    assert kinds(check(tin, points=given([np.delete(KERB, 1, axis=0), DITCH]))) == {"lines"}


def test_direction_and_order_of_vertices(tin):
    assert kinds(check(tin, points=given([KERB[::-1], DITCH]))) == {"lines"}
    assert kinds(check(tin, points=given([KERB[[0, 2, 1, 3]], DITCH]))) == {"lines"}


def test_lines_exchanged(tin):
    result = check(tin, points=given([DITCH, KERB]))
    assert kinds(result) == {"lines"}
    assert result.problems[0].first == (0, 1)


def test_line_that_goes_on_or_ends_before(tin):
    longer = np.vstack([KERB, [95, 90, 0]])
    for other in (longer, KERB[:-1], KERB[1:]):
        assert kinds(check(tin, points=given([other, DITCH]))) == {"lines"}


def test_kind_of_a_line(tin):
    soft = ts.Breakline(KERB, kind="soft")
    assert kinds(check(tin, points=given([soft, DITCH]))) == {"lines"}


def test_part_of_a_line_that_is_missing_inside():
    """Chains cut where nothing allows it: flags gone too, so that all but the given line fits."""
    tin = ts.triangulate(CLOUD, breaklines=[KERB])
    chain = tin.lines.vertices
    at = 1
    gone = {frozenset(chain[at : at + 2].tolist())}
    flags = tin.constrained.copy()
    for triangle, corner in np.argwhere(flags):
        corners = np.roll(tin.triangles[triangle], -corner).tolist()
        flags[triangle, corner] = frozenset(corners[1:]) not in gone
    lines = Lines(
        vertices=chain.copy(),
        offsets=np.array([0, at + 1, len(chain)], np.int32),
        kinds=("hard", "hard"),
        sources=np.zeros(2, np.int32),
        names=("", ""),
    )
    cut = tin.replace(constrained=flags, lines=lines)
    assert "lines" not in kinds(check(cut))
    result = check(cut, points=given([KERB]))
    assert "missing" in sentences(result)
    assert "ends inside the surface, before its end" in sentences(result)


def test_closed_line_and_one_that_meets_itself():
    ring = np.array([[20, 20, 1], [80, 25, 1], [50, 80, 1], [20, 20, 1]], float)
    eight = np.array([[10, 10, 0], [90, 90, 0], [90, 10, 0], [10, 90, 0], [10, 10, 0]], float)
    back = np.array([[10, 50, 0], [90, 52, 0], [10, 50, 0], [50, 10, 0]], float)
    for line in (ring, eight, back):
        tin = ts.triangulate(CLOUD, breaklines=[line])
        assert check(tin, points=given([line])).ok
        turned = np.roll(line[:-1], 1, axis=0)
        assert kinds(check(tin, points=given([turned]))) == {"lines"}


def test_parts_in_water_and_outside_are_no_loss():
    tin = ts.triangulate(CLIPPED)
    assert len(tin.lines) > len(CLIPPED.breaklines) + 2
    assert check(tin, points=CLIPPED).ok
    no_pond = replace(CLIPPED, water=[])
    assert "missing" in sentences(check(tin, points=no_pond))


@pytest.mark.parametrize("seed", list_seeds(60, few=20))
def test_dirty_lines_on_a_small_grid_or_at_utm_pass(seed):
    """Crossing, overlapping, touching themselves and points; cut by a boundary, holes and water."""
    rng = np.random.default_rng(seed)
    size, origin = (8, 0) if seed % 2 else (100, [500_000, 4_000_000])

    def places(count):
        xy = rng.integers(0, size + 1, (count, 2)) if seed % 2 else rng.random((count, 2)) * size
        return np.column_stack([xy + origin, rng.random(count)]).astype(float)

    corners = np.array([[0, 0], [1, 0], [1, 1], [0, 1]]) * size
    points = np.vstack([places(40), np.column_stack([corners + origin, np.zeros(4)])])
    box = corners * 0.5 + size * 0.25 + origin
    survey = ts.Survey(
        points=points,
        breaklines=[places(int(rng.integers(2, 7))) for _ in range(4)],
        boundary=[box] if rng.random() < 0.5 else [],
        water=[ts.Water((box - origin) / 4 + size / 3 + origin, 1.0)] if rng.random() < 0.5 else [],
    )
    tin = ts.triangulate(survey, snap=float(rng.choice([0, 0, 0.01 * size])))
    result = check(tin, points=survey)
    assert result.problems == ()


# ------------------------------------------------- rows and lines that are nearly right


def test_a_row_moved_further_than_the_snap_is_named():
    points = np.array([[0, 0, 1], [10, 0, 1], [10, 10, 1], [0, 10, 1], [4, 5, 2.0]])
    tin = ts.triangulate(points, snap=0.5)
    for share, is_sound in ((0.0, True), (0.98, True), (1.02, False), (1.5, False), (3.0, False)):
        moved = points.copy()
        moved[4, 0] += share * 0.5
        result = check(tin, points=moved)
        assert (kinds(result) == set()) == is_sound, share
        assert kinds(result) <= {"rows"}


def straight_line_of_points():
    """A line along four points of the surface, given as its two ends."""
    grid = [[x, y, 1.0] for x in range(0, 60, 10) for y in range(0, 40, 10)]
    line = np.array([[0, 10, 1.0], [50, 10, 1.0]])
    return np.array(grid), line


def test_a_chain_whose_vertices_are_out_of_order_is_refused():
    points, line = straight_line_of_points()
    tin = ts.triangulate(points, breaklines=[line])
    (chain,) = tin.lines.chains()
    assert len(chain) == 6
    assert check(tin, points=points, breaklines=[line]).ok
    for order in ([0, 2, 1, 3, 4, 5], [0, 1, 2, 4, 3, 5], [0, 1, 2, 1, 2, 3, 4, 5]):
        result = check(with_chains(tin, [chain[order]]), points=points, breaklines=[line])
        assert kinds(result) & {"lines"}, order


def test_the_course_of_a_line_is_looked_at_in_order():
    """Steps back along a line are edges, and lie on it: their order alone is wrong."""
    points, line = straight_line_of_points()
    tin = ts.triangulate(points, breaklines=[line])
    (chain,) = tin.lines.chains()
    back = with_chains(tin, [chain[[0, 1, 2, 3, 2, 3, 4, 5]]])
    assert not check(back, points=points, breaklines=[line]).ok


def test_measures_along_and_from_segments():
    rng = np.random.default_rng(6)
    p, a, b = rng.uniform(-10, 10, (3, 300, 2))
    b[:20] = a[:20]  # no length
    lines = [LineString([one, other]) for one, other in zip(a, b, strict=True)]
    exact = [line.distance(Point(place)) for line, place in zip(lines, p, strict=True)]
    np.testing.assert_allclose(distance(p, a, b), exact, rtol=1e-9, atol=1e-12)
    on = a + rng.random((300, 1)) * (b - a)
    assert distance(on, a, b).max() < 1e-12
    along = _project(p[20:], a[20:], b[20:])
    way = (b - a)[20:] / np.hypot(*(b - a)[20:].T)[:, None]
    across = p[20:] - (a[20:] + along[:, None] * way)  # from its foot, at a right angle
    np.testing.assert_allclose((across * way).sum(axis=1), 0, atol=1e-9)
