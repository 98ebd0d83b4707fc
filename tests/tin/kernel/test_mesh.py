"""The mesh that can be changed: after any changes it is what a fresh triangulation would be."""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise

import numpy as np
import pytest
from support.point_sets import small_integers, tenths, utm_floats

import tinsmith as ts
from tinsmith.tin import _kernel


def nearly_a_circle(rng, n):
    angle = rng.random(n) * 2 * np.pi
    return np.round(np.c_[np.cos(angle), np.sin(angle)] * 1000, 0)


KINDS = [small_integers, utm_floats, tenths, nearly_a_circle]


def turn(a, b, c):
    ax, ay, bx, by, cx, cy = (Fraction(float(v)) for v in (*a, *b, *c))
    value = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    return (value > 0) - (value < 0)


def are_collinear(xy):
    far = [q for q in xy[1:] if tuple(q) != tuple(xy[0])]
    return all(turn(xy[0], far[0], q) == 0 for q in far) if far else True


def cross(p, q, r, s):
    return turn(p, q, r) * turn(p, q, s) < 0 and turn(r, s, p) * turn(r, s, q) < 0


def is_between(p, q, v):
    return turn(p, q, v) == 0 and min(p, q) < v < max(p, q)


def grown(xy):
    return _kernel.grow(np.column_stack([xy, np.zeros(len(xy))]))


def mesh_of(xy):
    made = grown(xy)
    flags = np.zeros(made.triangles.shape, np.bool_)
    return _kernel.Mesh(np.ascontiguousarray(xy, float), made.triangles, made.neighbors, flags)


def require_fresh(mesh, xy):
    triangles, neighbors, fixed = mesh.arrays()
    fresh = grown(np.asarray(xy, float))
    np.testing.assert_array_equal(triangles, fresh.triangles)
    np.testing.assert_array_equal(neighbors, fresh.neighbors)
    assert not fixed.any()


def require_same(found, wanted):
    for one, other in zip(found, wanted, strict=True):
        np.testing.assert_array_equal(one, other)


def points_for(rng, kind, least, most):
    while True:
        xy = np.unique(kind(rng, rng.integers(least, most)), axis=0)
        if len(xy) >= least and not are_collinear(xy):
            return xy


@pytest.mark.each_value
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", range(15))
def test_inserting_and_removing_in_any_order_leaves_a_fresh_triangulation(kind, seed):
    rng = np.random.default_rng([seed, KINDS.index(kind)])
    xy = points_for(rng, kind, 3, 25)
    mesh = mesh_of(xy)
    slot_of = {tuple(q): i for i, q in enumerate(xy)}
    for _ in range(30):
        if rng.random() < 0.5:
            (place,) = kind(rng, 1)
            (slot,) = mesh.insert(np.array([place]))
            assert slot_of.setdefault(tuple(place), int(slot)) == slot
        else:
            gone = list(slot_of)[rng.integers(len(slot_of))]
            rest = [q for q in slot_of if q != gone]
            is_removed = mesh.remove(np.array([slot_of[gone]], np.int32))
            assert is_removed == (not are_collinear(np.array(rest)))
            if is_removed:
                del slot_of[gone]
        require_fresh(mesh, sorted(slot_of, key=slot_of.__getitem__))


def lines_for(rng, places, count):
    chosen = []
    for _ in range(count):
        i, j = (int(v) for v in rng.choice(len(places), 2, replace=False))
        if not any(cross(places[i], places[j], places[a], places[b]) for a, b in chosen):
            chosen.append((i, j))
    return chosen


def forced(places, segments, alive):
    number = {v: i for i, v in enumerate(alive)}
    mesh = mesh_of(np.array([places[v] for v in alive]))
    pairs = np.array([(number[a], number[b]) for a, b in segments], np.int32)
    _, blocked = mesh.force(pairs)
    assert len(blocked) == 0
    return mesh.arrays()


@pytest.mark.each_value
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", range(15))
def test_fixed_edges_whatever_their_order_and_what_comes_and_goes_between(kind, seed):
    rng = np.random.default_rng([seed, KINDS.index(kind), 1])
    xy = points_for(rng, kind, 4, 40)
    places = [tuple(q) for q in xy]
    segments = lines_for(rng, places, 15)
    pairs = np.array(segments, np.int32)
    mesh = mesh_of(xy)
    passed, blocked = mesh.force(pairs)
    assert len(blocked) == 0
    between = [
        (k, v)
        for k, (a, b) in enumerate(segments)
        for v in range(len(places))
        if is_between(places[a], places[b], places[v])
    ]
    assert sorted(map(tuple, passed.reshape(-1, 2).tolist())) == between
    wanted = mesh.arrays()
    order = rng.permutation(len(pairs))
    other = mesh_of(xy)
    other.force(np.ascontiguousarray(pairs[order][:, ::-1]))
    require_same(other.arrays(), wanted)
    tin = ts.TIN.from_triangles(
        np.column_stack([xy, np.zeros(len(xy))]), wanted[0], constrained=wanted[2]
    )
    assert ts.check(tin, level=3).ok

    held = {v for segment in segments for v in segment} | {v for _, v in between}
    free = [v for v in range(len(places)) if v not in held]
    gone = [v for v in free[:8] if mesh.remove(np.array([v], np.int32))]
    alive = [v for v in range(len(places)) if v not in gone]
    require_same(mesh.arrays(), forced(places, segments, alive))
    for v in gone:
        assert mesh.put(v, *places[v]) == v
    require_same(mesh.arrays(), wanted)

    assert mesh.release(steps_of(segments, between, places)) > 0
    require_fresh(mesh, xy)


def steps_of(segments, between, places):
    steps = set()
    for k, (a, b) in enumerate(segments):
        way = sorted([a, b, *(v for own, v in between if own == k)], key=places.__getitem__)
        steps |= set(pairwise(way))
    return np.array(sorted(steps), np.int32)


def test_point_on_a_fixed_edge_splits_it():
    mesh = mesh_of(np.array([[0.0, 0], [4, 0], [4, 4], [0, 4]]))
    mesh.force(np.array([[0, 2]], np.int32))
    mesh.insert(np.array([[2.0, 2.0]]))
    triangles, _, fixed = mesh.arrays()
    edges = {
        tuple(sorted((int(t[(k + 1) % 3]), int(t[(k + 2) % 3]))))
        for t, flags in zip(triangles, fixed, strict=True)
        for k in range(3)
        if flags[k]
    }
    assert edges == {(0, 4), (2, 4)}


def test_lists_without_a_row_are_handed_over_as_arrays_without_a_row():
    """Under UndefinedBehaviorSanitizer this shows a copy from a list that has no memory yet."""
    mesh = mesh_of([[0, 0], [4, 0], [4, 3], [0, 3]])
    passed, blocked = mesh.force(np.zeros((0, 2), np.int32))
    for found in (passed, blocked, mesh.illegal_fixed_edges(), mesh.fixed_neighbors(0)):
        assert found.dtype == np.int32
        assert found.size == 0


def test_edge_in_the_way_of_another_is_told_and_nothing_breaks():
    xy = np.array([[0.0, 0], [4, 0], [4, 4], [0, 4]])
    mesh = mesh_of(xy)
    mesh.force(np.array([[0, 2]], np.int32))
    _, blocked = mesh.force(np.array([[1, 3]], np.int32))
    assert blocked.tolist() == [0]
    assert mesh.crossed(np.array([[1, 3]], np.int32)).reshape(-1, 3)[:, 1:].tolist() in (
        [[0, 2]],
        [[2, 0]],
    )


@pytest.mark.parametrize("seed", range(8))
def test_crossed_edges_are_those_that_brute_force_finds(seed):
    rng = np.random.default_rng(seed)
    xy = points_for(rng, KINDS[seed % 4], 8, 40)
    mesh = mesh_of(xy)
    places = [tuple(q) for q in xy]
    edges = ts.TIN.from_triangles(np.column_stack([xy, np.zeros(len(xy))]), mesh.arrays()[0]).edges
    pairs = np.array([rng.choice(len(xy), 2, replace=False) for _ in range(10)], np.int32)
    found = mesh.crossed(pairs).reshape(-1, 3)
    for k, (a, b) in enumerate(pairs.tolist()):
        wanted = {
            tuple(sorted(edge))
            for edge in edges.tolist()
            if cross(places[a], places[b], places[edge[0]], places[edge[1]])
        }
        assert {tuple(sorted(edge)) for edge in found[found[:, 0] == k, 1:].tolist()} == wanted


def test_long_segment_across_many_triangles():
    rng = np.random.default_rng(5)
    xy = np.concatenate([[[0.0, 0.5], [1.0, 0.5]], rng.random((20_000, 2)) * [0.8, 1] + [0.1, 0]])
    mesh = mesh_of(xy)
    mesh.force(np.array([[0, 1]], np.int32))
    triangles, _, fixed = mesh.arrays()
    tin = ts.TIN.from_triangles(
        np.column_stack([xy, np.zeros(len(xy))]), triangles, constrained=fixed
    )
    assert ts.check(tin).ok
    assert np.count_nonzero(fixed) == 2
    assert mesh.release(np.array([[0, 1]], np.int32)) == 1
    require_fresh(mesh, xy)


def test_regions_between_barriers():
    mesh = mesh_of(np.array([[0.0, 0], [4, 0], [4, 4], [0, 4], [1, 1], [3, 1], [3, 3], [1, 3]]))
    ring = np.array([[4, 5], [5, 6], [6, 7], [7, 4]], np.int32)
    mesh.force(ring)
    triangles, neighbors, fixed = mesh.arrays()
    xy = np.array([[0.0, 0], [4, 0], [4, 4], [0, 4], [1, 1], [3, 1], [3, 3], [1, 3]])
    points = np.column_stack([xy, np.zeros(len(xy))])
    region, largest = _kernel.regions(points, triangles, neighbors, fixed)
    is_inner = (triangles >= 4).all(axis=1)
    assert len(largest) == 2
    assert len(set(region[is_inner])) == len(set(region[~is_inner])) == 1
    assert region[largest].tolist() == [0, 1]


@pytest.mark.parametrize(
    ("call", "sentence"),
    [
        (lambda mesh: mesh.remove(np.array([9], np.int32)), "no such vertex"),
        (lambda mesh: mesh.remove(np.array([-1], np.int32)), "no such vertex"),
        (lambda mesh: mesh.force(np.array([[0, 4]], np.int32)), "no such vertex"),
        (lambda mesh: mesh.put(0, 1.0, 1.0), "slot"),
    ],
)
def test_wrong_numbers_are_refused(call, sentence):
    with pytest.raises(ValueError, match=sentence):
        call(mesh_of(np.array([[0.0, 0], [4, 0], [4, 4], [0, 4]])))


def test_fixed_vertex_is_not_removed():
    mesh = mesh_of(np.array([[0.0, 0], [4, 0], [4, 4], [0, 4], [1, 2]]))
    mesh.force(np.array([[0, 4]], np.int32))
    with pytest.raises(ValueError, match="fixed edge"):
        mesh.remove(np.array([4], np.int32))
