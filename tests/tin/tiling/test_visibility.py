"""What is seen from triangles: against lines of sight drawn at random, and a plain twin."""

from __future__ import annotations

from fractions import Fraction
from itertools import combinations

import numpy as np
import pytest
from support.each_value import list_seeds

import tinsmith as ts
from tinsmith.tin import _kernel
from tinsmith.tin.tiling.circles import Discs, bound_discs
from tinsmith.tin.tiling.visibility import are_met, are_seen, find_views

EVERYWHERE = 1e9


def make_surface(seed, n_points, n_lines, length=0.4, *, decimals=3):
    """Return a triangulation of the unit square with short lines that cross each other."""
    rng = np.random.default_rng(seed)
    points = np.round(np.column_stack([rng.random((n_points, 2)), np.zeros(n_points)]), decimals)
    middles, angles = rng.random((n_lines, 2)), rng.random(n_lines) * np.pi
    away = length / 2 * np.column_stack([np.cos(angles), np.sin(angles)])
    lines = [
        np.round([[*(m - d), 0.0], [*(m + d), 0.0]], decimals)
        for m, d in zip(middles, away, strict=True)
    ]
    return ts.triangulate(points, breaklines=lines)


def find_seen(tin, chosen, discs, most=10_000):
    """Return the triangles that are seen from each chosen one; None where they are too many."""
    seen = _kernel.find_seen(
        np.ascontiguousarray(tin.points[:, :2]),
        tin.triangles,
        tin.neighbors,
        tin.constrained,
        np.array(chosen, np.int32),
        np.ascontiguousarray(discs.centers),
        np.ascontiguousarray(discs.radii),
        most,
    )
    found = np.split(seen.triangles, seen.offsets[1:-1])
    return [None if k in seen.failed else {*one.tolist()} for k, one in enumerate(found)]


def turn(a, b, c):
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def are_apart(ones, others):
    """Tell whether a line parts two sets of places: whether their hulls have no place in common.

    Else a place of one lies in the hull of three of the other, or segments between places cross.
    """
    for few, many in ((ones, others), (others, ones)):
        for corners in combinations(many, min(3, len(many))):
            if any(holds(corners, place) for place in few):
                return False
    return not any(
        meet(*one, *other) for one in combinations(ones, 2) for other in combinations(others, 2)
    )


def holds(corners, place):
    """Tell whether a place lies in the hull of one to three others."""
    a, b, c = (*corners, corners[-1], corners[-1])[:3]
    turns = [turn(a, b, place), turn(b, c, place), turn(c, a, place)]
    if turn(a, b, c):
        return min(turns) >= 0 or max(turns) <= 0
    low, high = (tuple(pick(one[k] for one in corners) for k in (0, 1)) for pick in (min, max))
    return not any(turns) and all(low[k] <= place[k] <= high[k] for k in (0, 1))


def meet(a, b, c, d):
    """Tell whether two segments cross; where one ends on the other, `holds` tells."""
    return turn(a, b, c) * turn(a, b, d) < 0 and turn(c, d, a) * turn(c, d, b) < 0


def find_seen_plainly(tin, start):
    """Return the same without a disc: of all edges in a row it is asked whether a line crosses."""
    xy = [tuple(map(Fraction, place)) for place in tin.points[:, :2].tolist()]
    found, waiting = {start}, [(start, k, (), ()) for k in range(3)]
    while waiting:
        triangle, k, lefts, rights = waiting.pop()
        beyond = int(tin.neighbors[triangle, k])
        if beyond < 0 or tin.constrained[triangle, k]:
            continue
        corners = tin.triangles[triangle].tolist()
        lefts = {*lefts, xy[corners[(k + 2) % 3]]}
        rights = {*rights, xy[corners[(k + 1) % 3]]}
        if not are_apart([*lefts], [*rights]):
            continue
        found.add(beyond)
        entered = tin.neighbors[beyond].tolist().index(triangle)
        waiting += [(beyond, (entered + step) % 3, lefts, rights) for step in (1, 2)]
    return found


@pytest.mark.each_value
@pytest.mark.parametrize("decimals", [1, 3])
@pytest.mark.parametrize("seed", range(3))
def test_what_is_seen_is_what_the_twin_sees(seed, decimals):
    tin = make_surface(seed, 9, 5, decimals=decimals)
    chosen = np.arange(0, len(tin.triangles), 2)
    far = Discs(np.full((len(chosen), 2), 0.5), np.full(len(chosen), EVERYWHERE))
    for start, seen in zip(chosen.tolist(), find_seen(tin, chosen, far), strict=True):
        assert seen == find_seen_plainly(tin, start)


def walk(tin, start, place, direction, disc):
    """Return the triangles along a line of sight, up to a segment or the end of the disc."""
    found, here, entered = [start], start, -1
    center, radius = disc
    while True:
        corners = tin.points[tin.triangles[here], :2]
        sides = [turn(place, place + direction, corner) for corner in corners]
        out = [k for k in range(3) if sides[(k + 1) % 3] < 0 < sides[(k + 2) % 3]]
        if len(out) != 1 or out[0] == entered:  # through a corner
            return found
        a, b = corners[(out[0] + 1) % 3], corners[(out[0] + 2) % 3]
        share = turn(place, place + direction, a)
        at = a + (b - a) * share / (share - turn(place, place + direction, b))
        beyond = int(tin.neighbors[here, out[0]])
        is_far = np.hypot(*(at - center)) > radius
        if beyond < 0 or tin.constrained[here, out[0]] or is_far:
            return found
        entered = tin.neighbors[beyond].tolist().index(here)
        found.append(here := beyond)


@pytest.mark.parametrize("seed", list_seeds(5, few=2))
def test_every_line_of_sight_in_the_disc_is_followed(seed):
    tin = make_surface(seed, 300, 60, 0.2)
    rng = np.random.default_rng(seed)
    discs = bound_discs(tin.points, tin.triangles)
    chosen = rng.choice(len(tin.triangles), 150)
    seen = find_seen(tin, chosen, discs.choose(chosen))
    drawn = 0
    for start, found in zip(chosen.tolist(), seen, strict=True):
        for shares, angle in zip(rng.dirichlet([1, 1, 1], 60), rng.random(60) * 7, strict=True):
            place = shares @ tin.points[tin.triangles[start], :2]
            direction = np.array([np.cos(angle), np.sin(angle)])
            disc = discs.centers[start], discs.radii[start]
            way = walk(tin, start, place, direction, disc)
            assert found >= {*way}
            drawn += len(way) - 1
    assert drawn > 1_000


def test_points_that_several_segments_hide_are_not_seen():
    """The picture of the module."""
    lines = [[[-3, 3, 0], [0, -1, 0]], [[3, 3, 0], [0, -1, 0]], [[-2.25, 2, 0], [2.25, 2, 0]]]
    below = [[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 4.0, 0.0]]
    tin = ts.triangulate([*below, [-9, 9, 0], [9, 9, 0], [0, -9, 0]], breaklines=lines)
    start = int(tin.locate([[0.0, 0.2]])[0])
    (seen,) = find_seen(tin, [start], Discs(np.zeros((1, 2)), np.full(1, EVERYWHERE)))
    corners = tin.points[tin.triangles[[*seen]], :2]
    places = np.array([[0.0, 1.5], [0.0, 4.0], [-2.5, 0.0], [0.0, 2.0], [0.0, 2.0 + 1e-9]])
    assert are_seen(corners, places).tolist() == [True, False, False, True, False]


def test_too_much_is_given_up():
    tin = make_surface(1, 300, 0)
    far = Discs(np.full((2, 2), 0.5), np.array([EVERYWHERE, 0.0]))
    assert find_seen(tin, [0, 1], far, most=5)[0] is None
    views = find_views(
        np.ascontiguousarray(tin.points[:, :2]),
        tin.triangles,
        tin.neighbors,
        tin.constrained,
        np.array([0, 1], np.int32),
        far,
    )
    assert views.corners[0] is None
    assert views.discs.radii[0] == EVERYWHERE
    assert views.corners[1] is not None


def test_views_lie_in_their_discs():
    tin = make_surface(2, 400, 80, 0.2)
    discs = bound_discs(tin.points, tin.triangles)
    chosen = np.arange(len(tin.triangles), dtype=np.int32)
    places = np.ascontiguousarray(tin.points[:, :2])
    views = find_views(places, tin.triangles, tin.neighbors, tin.constrained, chosen, discs)
    assert (views.discs.radii <= discs.radii).all()
    assert (views.discs.radii < discs.radii).any()
    asked = np.random.default_rng(1).random((500, 2))
    for k, corners in enumerate(views.corners):
        is_in = np.hypot(*(asked - discs.centers[k]).T) <= discs.radii[k]
        wanted = asked[is_in][are_seen(corners, asked[is_in])]
        far = np.hypot(*(wanted - views.discs.centers[k]).T)
        assert (far <= views.discs.radii[k]).all()


def test_segments_meet_a_triangle_where_its_hull_meets_theirs():
    rng = np.random.default_rng(3)
    corners = np.array([[0.0, 0.0], [4.0, 0.0], [1.0, 3.0]])
    ends = rng.integers(-2, 6, (400, 2, 2)).astype(float)
    exact = [[tuple(map(Fraction, place)) for place in one.tolist()] for one in ends]
    own = [tuple(map(Fraction, place)) for place in corners.tolist()]
    wanted = [not are_apart([*dict.fromkeys(one)], own) for one in exact]
    assert are_met(corners, ends).tolist() == wanted
    assert 100 < sum(wanted) < 300


def test_what_does_not_go_together_is_refused():
    tin = make_surface(1, 20, 0)
    places = np.ascontiguousarray(tin.points[:, :2])
    given = [places, tin.triangles, tin.neighbors, tin.constrained]
    one = [np.zeros(1, np.int32), np.zeros((1, 2)), np.ones(1)]
    for wrong in (
        [*given, np.array([10**6], np.int32), *one[1:], 5],
        [*given, one[0], np.zeros((2, 2)), one[2], 5],
        [*given, *one, 0],
        [*given[:3], tin.constrained[:-1], *one, 5],
    ):
        with pytest.raises(ValueError, match="do not go together"):
            _kernel.find_seen(*wrong)
    with pytest.raises(ValueError, match="three corners"):
        _kernel.are_in_triangles(np.zeros((4, 2)), np.zeros((1, 2)))
