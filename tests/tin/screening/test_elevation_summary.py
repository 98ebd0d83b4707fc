"""Elevations block by block are described as all of them, in memory that does not grow."""

import numpy as np
import pytest

from tinsmith.tin.screening import elevation_summary
from tinsmith.tin.screening.elevation_summary import ElevationSummary
from tinsmith.tin.screening.nodata import describe_elevations


def summarise(blocks, **options):
    summary = ElevationSummary("cell", **options)
    for block in blocks:
        summary.add(block)
    return summary


RNG = np.random.default_rng(1)
GROUND = 300 + RNG.random(5000) * 40


@pytest.mark.parametrize("marks", [[], [-9999.0] * 3, [0.0] * 5, [-9999.0, 1e30], [-1e38] * 7])
@pytest.mark.parametrize("n_blocks", [1, 2, 13])
@pytest.mark.parametrize("most", [200, 10**6])
def test_blocks_are_described_as_the_whole(monkeypatch, marks, n_blocks, most):
    monkeypatch.setattr(elevation_summary, "_MOST", most)
    monkeypatch.setattr(elevation_summary, "_SOME", 50)
    z = GROUND.copy()
    z[RNG.choice(len(z), len(marks), replace=False)] = marks
    blocks = np.array_split(z, n_blocks)
    assert summarise(blocks).describe() == describe_elevations(z, "cell")
    assert summarise(blocks, keeps_all=True).describe() == describe_elevations(z, "cell")


@pytest.mark.parametrize("value", [0.0, 5.0, -9999.0])
def test_one_elevation_alone(value):
    z = np.full(60, value)
    assert summarise(np.array_split(z, 4)).describe() == describe_elevations(z, "cell")


def test_memory_does_not_grow(monkeypatch):
    monkeypatch.setattr(elevation_summary, "_MOST", 1000)
    monkeypatch.setattr(elevation_summary, "_SOME", 100)
    summary = summarise(np.array_split(GROUND, 500))
    assert sum(map(len, summary._kept)) <= 1100


def test_no_elevations():
    assert ElevationSummary("point").describe() == []
    assert summarise([np.empty(0)]).describe() == []
