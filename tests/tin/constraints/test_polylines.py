"""Polylines against the same operations on plain lists of vertices."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from tinsmith.tin.constraints.polylines import Polylines
from tinsmith.tin.topology import find_offsets, find_owners


def random_chains(rng):
    return [rng.integers(0, 50, rng.integers(1, 7)).tolist() for _ in range(rng.integers(0, 8))]


def lists_of(polylines):
    return [chain.tolist() for chain in polylines]


def parts(chain, is_kept):
    """Walk the runs of kept segments of one chain."""
    part = []
    for a, b, keeps in zip(chain, chain[1:], is_kept, strict=False):
        if keeps:
            part = [*(part or [a]), b]
        elif part:
            yield part
            part = []
    if part:
        yield part


@pytest.mark.parametrize("seed", range(20))
def test_segments_and_their_lines(seed):
    chains = random_chains(np.random.default_rng(seed))
    polylines = Polylines.of_chains(chains)
    pairs = [list(pair) for chain in chains for pair in pairwise(chain)]
    owners = [number for number, chain in enumerate(chains) for _ in chain[1:]]
    assert polylines.segments().tolist() == pairs
    assert polylines.segment_lines().tolist() == owners
    assert polylines.vertices[polylines.starts()].tolist() == [a for a, _ in pairs]
    assert lists_of(polylines) == chains
    assert polylines.lengths.tolist() == [len(chain) for chain in chains]


@pytest.mark.parametrize("seed", range(20))
def test_kept_segments_are_parts_of_their_lines(seed):
    rng = np.random.default_rng(seed)
    chains = random_chains(rng)
    masks = [rng.random(len(chain) - 1) < 0.6 for chain in chains]
    left = Polylines.of_chains(chains).keep(np.concatenate([*masks, np.empty(0, bool)]))
    wanted = [
        (line, part)
        for line, (chain, mask) in enumerate(zip(chains, masks, strict=True))
        for part in parts(chain, mask)
    ]
    assert list(zip(left.lines.tolist(), lists_of(left), strict=True)) == wanted


@pytest.mark.parametrize("seed", range(20))
def test_vertices_come_behind_their_positions(seed):
    rng = np.random.default_rng(seed)
    chains = random_chains(rng)
    polylines = Polylines.of_chains(chains)
    starts = polylines.starts()
    at = np.sort(rng.choice(starts, rng.integers(0, 9))) if len(starts) else starts
    new = 100 + np.arange(len(at), dtype=np.int32)
    wanted, position = [], 0
    for chain in chains:
        wanted.append([])
        for vertex in chain:
            wanted[-1] += [vertex, *new[at == position].tolist()]
            position += 1
    assert lists_of(polylines.insert(at, new)) == wanted


def test_numbers_and_positions_that_are_chosen():
    polylines = Polylines.of_chains([[0, 1, 2], [2, 0]])
    assert lists_of(polylines.renumber(np.array([7, 8, 9], np.int32))) == [[7, 8, 9], [9, 7]]
    chosen = polylines.choose_positions(np.array([True, False, True, False, True]))
    assert lists_of(chosen) == [[0, 2], [0]]


def test_offsets_and_owners_of_parts_of_which_some_are_empty():
    assert find_offsets([2, 0, 3]).tolist() == [0, 2, 2, 5]
    assert find_offsets([]).tolist() == [0]
    assert find_owners(find_offsets([2, 0, 3])).tolist() == [0, 0, 2, 2, 2]
