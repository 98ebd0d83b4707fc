"""Blunders planted at random in smooth, rough and stepped ground: what is found, what is not."""

from __future__ import annotations

import numpy as np
import pytest

import tinsmith as ts
from tinsmith.tin.screening.heights import STRICT, find_heights

COUNT = 4_000
PLANTED = 20
SIGMA = 0.02


def smooth(xy, rng):
    z = 300 + 20 * np.sin(xy[:, 0] / 40) * np.cos(xy[:, 1] / 30)
    return z + rng.normal(0, SIGMA, len(xy))


def rough(xy, rng):
    return 300 + 0.1 * xy[:, 0] + rng.normal(0, 0.5, len(xy))


def stepped(xy, rng):
    return 300 + 4.0 * np.floor(xy[:, 0] / 50) + rng.normal(0, SIGMA, len(xy))


def sloping(xy, rng):
    return 300 + 1.2 * xy[:, 0] + rng.normal(0, SIGMA, len(xy))


def inspect(points):
    tin = ts.triangulate(points)
    judged = np.arange(len(points), dtype=np.int32)
    return find_heights(tin, judged, np.empty(0, np.int32)).found


def make(ground, seed):
    rng = np.random.default_rng(seed)
    xy = rng.random((COUNT, 2)) * 200
    return np.column_stack([xy, ground(xy, rng)]), rng


@pytest.mark.parametrize("ground", [smooth, rough, sloping])
def test_clean_ground_has_no_blunders(ground):
    """A residual of ten scales is eight deviations of normal noise, or never: none of 12,000."""
    for seed in range(3):
        points, _ = make(ground, seed)
        assert len(inspect(points).vertices) == 0


def test_along_steps_few_points_are_named_and_elsewhere_none():
    """A point at the edge that no other one beside it bears out cannot be told from a blunder.

    With random points some of those within an edge's length of a step, 200 times the noise high,
    are such: one in 50 at most, of which there are some 300.
    """
    spacing = 200 / np.sqrt(COUNT)
    for seed in range(3):
        points, _ = make(stepped, seed)
        to_step = 25 - np.abs(points[:, 0] % 50 - 25)
        beside = (to_step < 2 * spacing) & (points[:, 0] > 25) & (points[:, 0] < 175)
        found = inspect(points).vertices
        assert beside[found].all()
        assert len(found) <= beside.sum() / 50


def list_apart(points, rng):
    """Return random places inside that share no neighbour."""
    tin = ts.triangulate(points)
    inside = np.flatnonzero((np.abs(points[:, :2] - 100) < 85).all(axis=1))
    chosen, taken = [], set()
    for v in rng.permutation(inside).tolist():
        near = {v, *tin.vertex_neighbors(v).tolist()}
        if not near & taken:
            chosen.append(v)
            for w in list(near):
                taken |= {w, *tin.vertex_neighbors(w).tolist()}
        if len(chosen) == PLANTED:
            return np.array(chosen)
    raise AssertionError("no room")


@pytest.mark.parametrize("ground", [smooth, rough, sloping])
def test_planted_blunders_are_found_and_nothing_else(ground):
    """An error of twice the limit is found: its residual is that less the noise around it.

    The limit is ten scales; residuals of clean points are below eight deviations, which leaves
    two of the ten, and blunders spoil at most 7 of the 64 residuals that make a scale.
    """
    for seed in range(3):
        points, rng = make(ground, seed)
        clean = find_scales(points)
        chosen = list_apart(points, rng)
        error = 2 * STRICT * 1.25 * clean[chosen] * rng.choice([-1.0, 1.0], PLANTED)
        points[chosen, 2] += error
        found = inspect(points)
        assert set(found.vertices.tolist()) == set(chosen.tolist())
        order = np.argsort(chosen)
        left = np.abs(found.residuals - error[order])
        assert (left < STRICT * clean[chosen][order]).all()


def find_scales(points):
    from tinsmith.tin.screening.heights import _Search

    tin = ts.triangulate(points)
    judged = np.arange(len(points), dtype=np.int32)
    return _Search.start(tin, judged, np.empty(0, np.int32), None).scales


def test_blunders_on_steps_are_found_away_from_the_edges():
    for seed in range(3):
        points, rng = make(stepped, seed)
        chosen = list_apart(points, rng)
        chosen = chosen[np.abs(points[chosen, 0] % 50 - 25) < 12]
        assert len(chosen) >= 5
        points[chosen, 2] += 15.0
        found = inspect(points).vertices
        away = np.abs(points[found, 0] % 50 - 25) < 12
        assert set(found[away].tolist()) == set(chosen.tolist())


def test_two_together_are_both_found_and_their_neighbours_are_not():
    points, rng = make(smooth, 4)
    tin = ts.triangulate(points)
    first = int(list_apart(points, rng)[0])
    second = int(tin.vertex_neighbors(first)[0])
    points[[first, second], 2] += [30.0, 25.0]
    assert inspect(points).vertices.tolist() == sorted([first, second])


def test_residuals_are_those_of_the_surface_without_all_that_was_found():
    points, rng = make(smooth, 5)
    chosen = np.sort(list_apart(points, rng)[:5])
    points[chosen, 2] += 10.0
    found = inspect(points)
    assert found.vertices.tolist() == chosen.tolist()
    rest = ts.triangulate(np.delete(points, chosen, axis=0))
    expected = points[chosen, 2] - rest.interpolate(points[chosen, :2])
    np.testing.assert_allclose(found.residuals, expected, atol=1e-9)


def test_a_kerb_of_a_breakline_is_no_blunder_and_its_neighbours_are_none():
    rng = np.random.default_rng(7)
    xy = rng.random((2_000, 2)) * 100
    side = xy[:, 1] > 50.2
    points = np.column_stack([xy, 300 + 0.12 * side + rng.normal(0, 0.003, 2_000)])
    points = points[np.abs(points[:, 1] - 50) > 0.3]
    x = np.arange(0.0, 101.0, 5.0)
    bottom = np.column_stack([x, np.full(21, 50.0), np.full(21, 300.0)])
    top = np.column_stack([x, np.full(21, 50.2), np.full(21, 300.12)])
    tin = ts.triangulate(points, breaklines=[bottom, top])
    assert len(ts.blunders(tin)) == 0
    top[10, 2] += 1.0
    found = ts.blunders(ts.triangulate(points, breaklines=[bottom, top]))
    assert found["reason"].tolist() == ["line"]  # the vertex is the line's own, and no row's
    assert found["row"].tolist() == [-1]
    assert found["explanation"][0].startswith("A vertex of breakline 1: It is 1 above")
