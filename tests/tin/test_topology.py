"""Topology: neighbours, edges and rings of triangle lists against plain dictionaries."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import tinsmith as ts
from tinsmith.tin import _kernel
from tinsmith.tin.topology import (
    NO_NEIGHBOR,
    boundary_rings,
    boundary_walks,
    edge_keys,
    edges,
    edges_at,
    ends,
    neighbors_of,
)

RNG = np.random.default_rng(31)
FAN = np.array([[4, 0, 1], [4, 1, 2], [4, 2, 3], [4, 3, 0]], np.int32)


def triangles_of(count, seed=0):
    return ts.triangulate(np.random.default_rng(seed).random((count, 3))).triangles


def directed(triangles):
    """Triangle and corner by directed edge, opposite that corner."""
    return {
        (int(triangle[(corner + 1) % 3]), int(triangle[(corner + 2) % 3])): (number, corner)
        for number, triangle in enumerate(triangles)
        for corner in range(3)
    }


def neighbors_by_dictionary(triangles):
    owner = directed(triangles)
    neighbors = np.full(np.shape(triangles), NO_NEIGHBOR)
    for (start, end), (triangle, corner) in owner.items():
        neighbors[triangle, corner] = owner.get((end, start), (NO_NEIGHBOR, 0))[0]
    return neighbors


def as_cycle(ring):
    """The ring turned so that its smallest vertex comes first."""
    ring = [int(v) for v in ring]
    least = ring.index(min(ring))
    return tuple(ring[least:] + ring[:least])


def rings_of(triangles):
    triangles = np.array(triangles, np.int32)
    neighbors = neighbors_of(triangles, int(triangles.max()) + 1)
    return sorted(as_cycle(ring) for ring in boundary_rings(triangles, neighbors))


# ------------------------------------------------------------------ neighbours


@given(st.integers(3, 60), st.integers(0, 1000), st.randoms(use_true_random=False))
def test_neighbors_equal_a_dictionary(count, seed, random):
    """Of whole triangulations, and of what is left when triangles are taken out."""
    triangles = triangles_of(count, seed)
    some = sorted(random.sample(range(len(triangles)), random.randint(1, len(triangles))))
    for part in (triangles, triangles[some]):
        np.testing.assert_array_equal(neighbors_of(part, count), neighbors_by_dictionary(part))


def test_neighbor_stands_opposite_its_corner():
    neighbors = neighbors_of(FAN, 5)
    assert neighbors.tolist() == [[-1, 1, 3], [-1, 2, 0], [-1, 3, 1], [-1, 0, 2]]
    assert neighbors.dtype == np.int32


def test_one_triangle_has_no_neighbors():
    assert neighbors_of(np.array([[0, 1, 2]], np.int32), 3).tolist() == [[-1, -1, -1]]


def test_edge_of_three_triangles_is_refused():
    book = np.array([[0, 1, 2], [1, 0, 3], [0, 1, 4]], np.int32)
    with pytest.raises(ts.PointsError, match="Edge 0-1 belongs to more than two triangles"):
        neighbors_of(book, 5)


def test_two_triangles_on_one_side_of_an_edge_are_refused():
    twice = np.array([[0, 1, 2], [0, 1, 3]], np.int32)
    with pytest.raises(ts.PointsError, match="edge 0-1 lie on the same side"):
        neighbors_of(twice, 4)


def test_repeated_triangle_is_refused():
    with pytest.raises(ts.PointsError, match="same side"):
        neighbors_of(np.array([[0, 1, 2], [1, 2, 0]], np.int32), 3)


def test_large_vertex_numbers_do_not_overflow():
    top = 2**31 - 1
    pair = np.array([[0, top - 1, top - 2], [top - 1, 0, top - 3]], np.int32)
    assert neighbors_of(pair, top).tolist() == [[-1, -1, 1], [-1, -1, 0]]


# ------------------------------------------------------------------ edges


def test_edges_are_every_pair_once():
    triangles = triangles_of(80)
    found = edges(triangles, neighbors_of(triangles, 80))
    assert len({frozenset(edge) for edge in found.tolist()}) == len(found)
    assert {frozenset(edge) for edge in found.tolist()} == {
        frozenset(edge) for edge in directed(triangles)
    }


def test_ends_are_those_of_the_edge_opposite_the_corner():
    triangles = triangles_of(20)
    for edge, (triangle, corner) in directed(triangles).items():
        start, end = ends(triangles, np.array([triangle]), np.array([corner]))
        assert (int(start[0]), int(end[0])) == edge


# ------------------------------------------------------------------ rings


def test_ring_of_a_fan():
    assert rings_of(FAN) == [(0, 1, 2, 3)]


def test_ring_of_one_triangle():
    assert rings_of([[2, 0, 1]]) == [(0, 1, 2)]


def test_rings_of_a_frame():
    """A square in a square: the outer ring counter-clockwise, the inner one clockwise."""
    outer, inner = range(4), range(4, 8)
    frame = []
    for k in range(4):
        following = (k + 1) % 4
        frame += [[outer[k], outer[following], inner[k]]]
        frame += [[outer[following], inner[following], inner[k]]]
    assert rings_of(frame) == [(0, 1, 2, 3), (4, 7, 6, 5)]


def test_rings_of_pieces_that_touch_in_one_vertex():
    assert rings_of([[0, 1, 2], [0, 3, 4]]) == [(0, 1, 2), (0, 3, 4)]


def test_rings_of_two_pieces():
    assert rings_of([[0, 1, 2], [3, 4, 5]]) == [(0, 1, 2), (3, 4, 5)]


def test_ring_that_visits_a_vertex_twice():
    """A fan with one triangle missing inside touches its own hub twice or not at all."""
    three = np.delete(FAN, 1, axis=0)
    assert rings_of(three) == [(0, 1, 4, 2, 3)]
    opposite = FAN[[0, 2]]
    assert rings_of(opposite) == [(0, 1, 4), (2, 3, 4)]


def test_closed_surface_has_no_ring():
    tetrahedron = np.array([[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]], np.int32)
    assert boundary_rings(tetrahedron, neighbors_of(tetrahedron, 4)) == []


@given(st.integers(4, 40), st.integers(0, 1000), st.randoms(use_true_random=False))
def test_rings_use_every_boundary_edge_once(count, seed, random):
    triangles = triangles_of(count, seed)
    some = sorted(random.sample(range(len(triangles)), random.randint(1, len(triangles))))
    part = triangles[some]
    neighbors = neighbors_of(part, count)
    owner = directed(part)
    boundary = sorted(edge for edge in owner if edge[::-1] not in owner)
    walked = sorted(
        (int(start), int(end))
        for ring in boundary_rings(part, neighbors)
        for start, end in zip(ring, np.roll(ring, -1), strict=True)
    )
    assert walked == boundary


def test_edges_at_corners_lie_opposite_them():
    triangles = np.array([[4, 7, 9], [7, 4, 2]], np.int32)
    is_chosen = np.array([[True, False, True], [False, True, False]])
    assert edges_at(triangles, is_chosen).tolist() == [[7, 9], [4, 7], [2, 7]]


def test_keys_of_edges_are_the_same_both_ways_and_told_apart():
    pairs = np.array([(a, b) for a in range(5) for b in range(5)], np.int32)
    keys = edge_keys(pairs, 5)
    assert keys.dtype == np.int64
    assert keys.tolist() == edge_keys(pairs[:, ::-1], 5).tolist()
    assert len(set(keys.tolist())) == 15
    large = np.array([[2**31 - 1, 2**31 - 2]], np.int32)
    assert edge_keys(large, 2**31).tolist() == [(2**31 - 2) * 2**31 + 2**31 - 1]


@pytest.mark.parametrize("number", [-1, 5])
def test_kernel_refuses_vertices_that_are_not_there(number):
    wrong = np.array([[0, 1, 2], [0, 2, number]], np.int32)
    with pytest.raises(ValueError, match="vertex numbers from 0 to n - 1"):
        _kernel.join_triangles(wrong, 5)
    with pytest.raises(ValueError, match="vertex numbers from 0 to n - 1"):
        _kernel.turns_of_triangles(np.zeros((5, 3)), wrong)


@given(st.integers(0, 1000))
def test_turns_are_those_of_orientation(seed):
    rng = np.random.default_rng(seed)
    points = rng.integers(-3, 4, (12, 3)).astype(float)
    triangles = np.array([rng.choice(12, 3, replace=False) for _ in range(30)], np.int32)
    corners = (np.ascontiguousarray(points[triangles[:, k], :2]) for k in range(3))
    wanted = _kernel.orientation(*corners)
    np.testing.assert_array_equal(_kernel.turns_of_triangles(points, triangles), wanted)


def walk_by_turning(triangles, neighbors):
    """Return the boundary edges ring by ring, each found by turning about the end of the last."""
    rings, left = [], [(t, k) for t in range(len(triangles)) for k in range(3)]
    left = [(t, k) for t, k in left if neighbors[t][k] == NO_NEIGHBOR]
    while left:
        ring, (t, k) = [], left[0]
        while (t, k) in left:
            left.remove((t, k))
            ring.append(3 * t + k)
            pivot, k = triangles[t][(k + 2) % 3], (k + 1) % 3
            while neighbors[t][k] != NO_NEIGHBOR:
                t = neighbors[t][k]
                k = (triangles[t].index(pivot) + 2) % 3
        rings.append(ring)
    return rings


@given(st.integers(3, 40), st.integers(0, 1000), st.randoms(use_true_random=False))
def test_boundary_walks_turn_about_each_vertex(count, seed, random):
    """Of what is left when triangles are taken out, where many rings touch."""
    triangles = triangles_of(count, seed)
    some = sorted(random.sample(range(len(triangles)), random.randint(1, len(triangles))))
    part = triangles[some]
    neighbors = neighbors_of(part, count)
    edges_found, offsets = boundary_walks(part, neighbors)
    rings = [ring.tolist() for ring in np.split(edges_found, offsets[1:-1])]
    assert rings == walk_by_turning(part.tolist(), neighbors.tolist())


def test_neighbors_that_are_not_mutual_are_refused():
    triangles = np.array([[0, 1, 2], [2, 1, 3]], np.int32)
    with pytest.raises(ValueError, match="neighbors of their neighbors"):
        boundary_walks(triangles, np.array([[1, 1, -1], [1, 1, 1]], np.int32))
    with pytest.raises(ValueError, match="triangles or -1"):
        boundary_walks(triangles, np.array([[2, -1, -1], [-1, -1, -1]], np.int32))
