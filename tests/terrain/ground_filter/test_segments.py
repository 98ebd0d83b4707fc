"""Segments of lowest points, against sets that are joined one link at a time."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial import Delaunay

from tinsmith.terrain.ground_filter.parameters import Parameters
from tinsmith.terrain.ground_filter.segments import Links, link, list_continuing

PARAMETERS = Parameters(
    building=40.0,
    cell=1.0,
    terrain_slope=0.1,
    iteration_angle=20.0,
    iteration_distance=1.4,
    edge_length=5.0,
    tolerance=0.3,
    horizontal_tolerance=1.0,
    noise_depth=1.0,
    returns="last",
)


def around(points, margin=200.0):
    low, high = points.min(axis=0) - margin, points.max(axis=0) + margin
    return np.array([[x, y, 0.0] for x in (low[0], high[0]) for y in (low[1], high[1])])


def list_plainly(links, is_ground):
    """Judge segments as the paper and pencil would: sets, joined link by link."""
    segments = [{i} for i in range(len(is_ground))]
    pairs = list(zip(*(part.tolist() for part in links), strict=True))
    for one, other, _, is_even in pairs:
        if is_even and not is_ground[one] and not is_ground[other]:
            joined = segments[one] | segments[other]
            for i in joined:
                segments[i] = joined
    found = np.zeros(len(is_ground), bool)
    for i in np.flatnonzero(~is_ground):
        contacts = [
            (other if is_ground[other] else one, rise if is_ground[other] else -rise, is_even)
            for one, other, rise, is_even in pairs
            if is_ground[one] != is_ground[other] and {one, other} & segments[i]
        ]
        even = sum(is_even for *_, is_even in contacts)
        up = sum(not is_even and rise > 0 for _, rise, is_even in contacts)
        found[i] = even >= 2 and even + up >= 0.4 * len(contacts)
    return found


@pytest.mark.parametrize("seed", range(12))
def test_segments_against_sets(seed):
    rng = np.random.default_rng(seed)
    points = np.column_stack([rng.uniform(0, 14, (80, 2)), rng.integers(0, 3, 80) * 0.7])
    is_ground = rng.uniform(size=80) < 0.5
    links = link(points, around(points), PARAMETERS)
    assert (list_continuing(links, is_ground) == list_plainly(links, is_ground)).all()


@pytest.mark.parametrize("seed", range(4))
def test_links_are_the_short_edges_of_the_tin(seed):
    rng = np.random.default_rng(seed)
    points = rng.uniform(0, 30, (60, 3))
    ring = around(points)
    links = link(points, ring, PARAMETERS)
    expected = set()
    for corners in Delaunay(np.concatenate([points, ring])[:, :2]).simplices.tolist():
        for a, b in zip(corners, corners[1:] + corners[:1], strict=True):
            if max(a, b) < 60 and np.hypot(*(points[a] - points[b])[:2]) <= 5.0:
                expected.add((min(a, b), max(a, b)))
    pairs = zip(links.one.tolist(), links.other.tolist(), strict=True)
    assert {(min(pair), max(pair)) for pair in pairs} == expected
    assert len(links.one) == len(expected)
    length = np.hypot(*(points[links.other] - points[links.one])[:, :2].T)
    assert (links.rise == points[links.other, 2] - points[links.one, 2]).all()
    assert (links.is_even == (np.abs(links.rise) <= 0.15 + 0.1 * length)).all()


def make_links(*rows):
    one, other, rise, is_even = zip(*rows, strict=True)
    return Links(np.array(one), np.array(other), np.array(rise), np.array(is_even))


def test_one_even_contact_is_too_few():
    is_ground = np.array([True, True, False])
    links = make_links((0, 2, 0.0, True), (1, 2, -3.0, False))
    assert not list_continuing(links, is_ground).any()


@pytest.mark.parametrize(("rise", "continues"), [(-3.0, True), (3.0, False)])
def test_steps_down_speak_against_a_segment_and_steps_up_for_it(rise, continues):
    is_ground = np.array([True] * 6 + [False])
    steps = [(i, 6, rise, False) for i in range(2, 6)]
    links = make_links((0, 6, 0.0, True), (1, 6, 0.0, True), *steps)
    assert list_continuing(links, is_ground).tolist() == [False] * 6 + [continues]
    turned = make_links(*((6, i, -z, even) for i, _, z, even in zip(*links, strict=True)))
    assert list_continuing(turned, is_ground).tolist() == [False] * 6 + [continues]


def test_no_links_continue_nothing():
    points = np.array([[0.0, 0.0, 1.0]])
    links = link(points, around(points), PARAMETERS)
    assert len(links.one) == 0
    assert list_continuing(links, np.array([False])).tolist() == [False]
