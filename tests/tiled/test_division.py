"""The plane in tiles: every place lies in exactly one, and none has too many points."""

from __future__ import annotations

import numpy as np
import pytest

import tinsmith as ts
from tinsmith.tiled.division import Tile, divide, quarter

BOUNDS = ts.Bounds(500_000.0, 4_000_000.0, 501_000.0, 4_002_000.0)


def owners(tiles, xy):
    """Count the half-open tiles in which each place lies."""
    boxes = [one.box for one in tiles]
    return sum(
        (xy[:, 0] >= box.xmin)
        & (xy[:, 0] < box.xmax)
        & (xy[:, 1] >= box.ymin)
        & (xy[:, 1] < box.ymax)
        for box in boxes
    )


def make_places(tiles):
    """Return places at random, some beyond the bounds, and all corners of tiles."""
    rng = np.random.default_rng(0)
    xy = rng.random((2_000, 2)) * [2_000, 4_000] + [BOUNDS.xmin - 500, BOUNDS.ymin - 1_000]
    sides = [[one.box.xmin, one.box.ymin, one.box.xmax, one.box.ymax] for one in tiles]
    corners = np.array([(s[i], s[j]) for s in sides for i in (0, 2) for j in (1, 3)])
    return np.concatenate([xy, corners[np.isfinite(corners).all(axis=1)]])


@pytest.mark.parametrize("most", [10**9, 5_000, 700])
@pytest.mark.parametrize("fewest", [1, 4, 16, 64])
def test_tiles_are_the_plane_without_overlap(most, fewest):
    rng = np.random.default_rng(1)
    counts = rng.integers(0, 50, (64, 64)) * (rng.random((64, 64)) < 0.3)
    tiles = divide(counts, BOUNDS, most=most, fewest_tiles=fewest)
    assert (owners(tiles, make_places(tiles)) == 1).all()
    assert len(tiles) >= fewest
    assert sum(one.count for one in tiles) == counts.sum()
    assert max(one.count for one in tiles) <= most
    assert [one.key for one in tiles] == [str(k) for k in range(len(tiles))]
    if most > counts.sum():
        assert len(tiles) == fewest


def test_a_cell_is_not_divided_and_empty_land_makes_few_tiles():
    counts = np.zeros((64, 64), np.int64)
    counts[10, 20] = 1_000_000
    counts[50, 50] = 10
    tiles = divide(counts, BOUNDS, most=1_000)
    assert max(one.count for one in tiles) == 1_000_000
    assert len(tiles) < 40
    assert (owners(tiles, make_places(tiles)) == 1).all()


@pytest.mark.parametrize("bounds", [ts.Bounds(5, 5, 5, 5), ts.Bounds(0, 1, 10, 1)])
def test_points_without_extent(bounds):
    tiles = divide(np.full((8, 8), 100), bounds, most=500)
    assert (owners(tiles, np.array([[5.0, 5.0], [0.0, 1.0], [10.0, 1.0]])) == 1).all()


def test_quarters_are_the_tile():
    tile = Tile("3", ts.Bounds(-np.inf, BOUNDS.ymin + 100, BOUNDS.xmin + 300, np.inf), 4_000)
    parts = quarter(tile, BOUNDS)
    assert [one.key for one in parts] == ["3.0", "3.1", "3.2", "3.3"]
    xy = make_places(parts)
    assert (owners(parts, xy) == owners([tile], xy)).all()
    assert np.isfinite([parts[0].box.xmax, parts[0].box.ymax]).all()
