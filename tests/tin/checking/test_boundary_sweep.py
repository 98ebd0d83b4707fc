"""Rims of surfaces: the sweep against pairs of edges and winding numbers in rational arithmetic."""

from __future__ import annotations

import itertools
from fractions import Fraction

import numpy as np
import pytest
from support.line_oracle import is_inside
from support.oracles import orientation, place

import tinsmith as ts
from tinsmith.tin import TIN, check
from tinsmith.tin.checking.boundary_sweep import Boundary, find_fault, find_sides

UTM = np.array([500_000.0, 4_000_000.0])
SQUARE = np.array([[0, 0], [6, 0], [6, 6], [0, 6]], float)
RIGHT = SQUARE / 3 + [6, 2]  # its side lies on the square's


def boundary_of(*rings):
    """Closed rings as a boundary; corners at one place are one vertex."""
    corners = np.concatenate([np.asarray(ring, float) for ring in rings])
    points, vertex_of = np.unique(corners, axis=0, return_inverse=True)
    vertex_of = vertex_of.reshape(-1)
    ends = np.cumsum([len(ring) for ring in rings])
    following = np.arange(1, len(corners) + 1)
    following[ends - 1] = np.append(0, ends[:-1])
    return Boundary(points, vertex_of, vertex_of[following])


# ------------------------------------------------------------------ second opinion


def meets_in_vertices_only(edges):
    """No two edges share a place other than an end of both."""
    for (a, b), (c, d) in itertools.combinations(edges, 2):
        turns = [orientation(a, b, c), orientation(a, b, d)]
        others = [orientation(c, d, a), orientation(c, d, b)]
        if turns[0] * turns[1] < 0 and others[0] * others[1] < 0:
            return False
        if {a, b} == {c, d}:
            return False
        for p, (q, r), turn in ((c, (a, b), turns[0]), (d, (a, b), turns[1])):
            if turn == 0 and min(q, r) < p < max(q, r):
                return False
        for p, (q, r), turn in ((a, (c, d), others[0]), (b, (c, d), others[1])):
            if turn == 0 and min(q, r) < p < max(q, r):
                return False
    return True


def winding(p, edges):
    """How often the edges go round p, counted along the ray north."""
    count = 0
    for a, b in edges:
        if a[0] <= p[0] < b[0]:
            count += orientation(a, b, p) < 0
        elif b[0] <= p[0] < a[0]:
            count -= orientation(b, a, p) < 0
    return -count


def is_sound(boundary):
    """The definition: edges meet in vertices, and no surface lies on the right of any."""
    places = [place(p) for p in boundary.points.tolist()]
    edges = [(places[i], places[j]) for i, j in zip(boundary.start, boundary.end, strict=True)]
    if not meets_in_vertices_only(edges):
        return False
    tiny = Fraction(1, 10**6)
    for a, b in edges:
        x, y = Fraction(a[0] + b[0]) / 2, Fraction(a[1] + b[1]) / 2
        right = (x + tiny * (b[1] - a[1]), y - tiny * (b[0] - a[0]))
        if winding(right, edges) != 0:
            return False
    return True


def random_ring(rng, size):
    """A rectangle, a triangle, or anything with five corners; either way round."""
    while True:
        kind = rng.integers(0, 5)
        if kind < 3:
            (x, u), (y, v) = (np.sort(rng.choice(size + 1, 2, replace=False)) for _ in range(2))
            ring = np.array([[x, y], [u, y], [u, v], [x, v]], float)
        else:
            ring = rng.integers(0, size + 1, (3 if kind == 3 else 5, 2)).astype(float)
        if (ring != np.roll(ring, 1, axis=0)).any(axis=1).all():
            return ring[:: rng.choice([-1, 1])]


@pytest.mark.each_value
@pytest.mark.parametrize("origin", [np.zeros(2), UTM])
@pytest.mark.parametrize("size", [3, 5, 9])
def test_any_rings_on_a_small_grid(size, origin):
    rng = np.random.default_rng(size)
    verdicts = []
    for _ in range(250):
        rings = [random_ring(rng, size) for _ in range(rng.integers(1, 4))]
        boundary = boundary_of(*(ring + origin for ring in rings))
        verdicts.append(find_fault(boundary) is None)
        assert verdicts[-1] == is_sound(boundary_of(*rings))
        if verdicts[-1]:
            require_sides(boundary, rings, size, origin)
    assert 20 < sum(verdicts) < 230


def require_sides(boundary, rings, size, origin):
    x, y = np.meshgrid(np.arange(0, size + 1, 0.5), np.arange(-1, size + 2, 0.5))
    xy = np.column_stack([x.ravel(), y.ravel()])
    exact = [[place(p) for p in ring.tolist()] for ring in rings]
    wanted = [is_inside(place(p), exact) for p in xy.tolist()]
    assert find_sides(boundary, xy + origin).tolist() == wanted


# ------------------------------------------------------------------ by name


def test_rings_that_may_be():
    hole = SQUARE[::-1] / 3 + 2
    assert find_fault(boundary_of(SQUARE)) is None
    assert find_fault(boundary_of(SQUARE, hole)) is None
    assert find_fault(boundary_of(SQUARE, hole, SQUARE / 9 + 2.5)) is None  # an island in the hole
    assert find_fault(boundary_of(SQUARE, SQUARE + 6)) is None  # corners touch
    assert find_fault(boundary_of(SQUARE, [[0, 0], [1, 2], [2, 1]])) is None  # a hole at a corner


@pytest.mark.parametrize(
    ("rings", "is_meeting"),
    [
        ([SQUARE[::-1]], False),
        ([SQUARE, SQUARE / 3 + 2], False),
        ([SQUARE, SQUARE[::-1] / 3 + 7], False),
        ([SQUARE, SQUARE[::-1] / 3 + 2, SQUARE[::-1] / 9 + 2.5], False),
        ([SQUARE, SQUARE + 3], True),
        ([SQUARE, RIGHT], True),
        ([SQUARE, SQUARE[::-1] / 3], True),
        ([SQUARE, [[6, 3], [8, 2], [8, 4]]], True),
        ([SQUARE, SQUARE], True),
        ([[[0, 0], [6, 6], [6, 0], [0, 6]]], True),
    ],
)
def test_rings_that_may_not(rings, is_meeting):
    fault = find_fault(boundary_of(*rings))
    assert fault is not None
    assert fault.is_meeting == is_meeting


def test_sides_of_nothing_and_of_corners():
    boundary = boundary_of(SQUARE, SQUARE[::-1] / 3 + 2)
    assert find_sides(boundary, np.empty((0, 2))).tolist() == []
    assert find_sides(boundary, boundary.points).tolist() == [0] * 8
    xy = np.array([[1, 1], [3, 3], [3, 0], [2, 3], [6, 3], [7, 3], [-1, -1]], float)
    assert find_sides(boundary, xy).tolist() == [1, -1, 0, 0, 0, -1, -1]


def test_near_misses_are_told_apart():
    """A corner a unit in the last place beside an edge that no double runs along."""
    slant = np.array([[0, 0], [3, 1], [3, 5], [0, 5]]) + UTM
    corner = np.array([1.5, 0.5]) + UTM
    below, above = (corner.copy() for _ in range(2))
    below[1] = np.nextafter(below[1], 0)
    above[1] = np.nextafter(above[1], 1e9)
    feet = np.array([[1, -4], [2, -4]]) + UTM
    touching, apart, across = (
        find_fault(boundary_of(slant, [*feet, tip])) for tip in (corner, below, above)
    )
    assert touching.is_meeting
    assert across.is_meeting
    assert apart is None


def star(count):
    angle = 2 * np.pi * np.arange(count) / count
    radius = np.where(np.arange(count) % 2, 1.0, 0.5)
    return np.column_stack([np.cos(angle), np.sin(angle)]) * radius[:, None]


def test_long_teeth_on_all_sides():
    """Boxes about the edges overlap all over; the edges do not."""
    teeth = star(4_000)
    assert find_fault(boundary_of(teeth)) is None
    broken = teeth.copy()
    broken[[101, 103]] = broken[[103, 101]]
    assert find_fault(boundary_of(broken)) is not None


# ------------------------------------------------------------------ within check


def bound(points, triangles):
    """A TIN whose boundary is constrained all round."""
    xyz = np.column_stack([np.asarray(points, float), np.zeros(len(points))])
    free = TIN.from_triangles(xyz, triangles)
    return TIN.from_triangles(xyz, triangles, constrained=free.neighbors < 0)


def kinds(result):
    return {problem.kind for problem in result.problems}


def strip(inner, outer, turns, count=40):
    """A ring of quads about the origin, the radii growing with every turn."""
    angle = np.linspace(0, 2 * np.pi * turns, count)
    way = np.column_stack([np.cos(angle), np.sin(angle)])
    growth = (1 + 0.2 * angle)[:, None]
    points = np.concatenate([way * inner * growth, way * outer * growth])
    quads = np.arange(count - 1)
    lower = np.stack([quads, quads + count, quads + count + 1], axis=1)
    upper = np.stack([quads, quads + count + 1, quads + 1], axis=1)
    return bound(points, np.concatenate([lower, upper]))


def test_strip_that_runs_under_itself():
    """A ramp: every triangle and every vertex looks right, only the turns overlap."""
    assert check(strip(1.0, 1.5, 0.9), level=2).ok
    assert check(strip(1.0, 1.5, 1.8), level=2).ok  # a spiral beside itself
    assert kinds(check(strip(1.0, 3.0, 1.8), level=2)) == {"overlap"}


def test_pieces_over_each_other():
    both = np.vstack([SQUARE, SQUARE / 3 + 2])
    result = check(bound(both, [[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]]), level=2)
    assert kinds(result) == {"overlap"}
    assert "over each other" in result.problems[0].sentence


def test_pieces_that_cross_or_touch():
    triangles = [[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]]
    for far, is_allowed in (([3, 3], False), ([6, 2], False), ([6, 6], True), ([7, 0], True)):
        result = check(bound(np.vstack([SQUARE, SQUARE / 3 + far]), triangles), level=2)
        assert kinds(result) == (set() if is_allowed else {"overlap"})


def test_boundary_of_a_clipped_surface_is_found_sound():
    rng = np.random.default_rng(0)
    points = np.column_stack([rng.random((400, 2)) * 100, rng.random(400)])
    field = [[2, 2], [95, 10], [50, 40], [90, 90], [5, 95]]
    tin = ts.triangulate(points, boundary=[field], holes=[[[20, 20], [30, 20], [25, 30]]])
    assert len(tin.rings) == 2
    assert check(tin, points=points).ok


def test_rows_said_to_be_outside_lie_outside():
    rng = np.random.default_rng(0)
    points = np.column_stack([rng.random((400, 2)) * 100, rng.random(400)])
    tin = ts.triangulate(points, boundary=[[[20, 20], [80, 25], [50, 80]]])
    assert check(tin, points=points).ok
    row = int(tin.report.left_out_rows[3])
    moved = points.copy()
    moved[row, :2] = tin.points[tin.triangles[50], :2].mean(axis=0)
    result = check(tin, points=moved)
    assert kinds(result) == {"rows"}
    assert result.problems[0].first == (row,)
