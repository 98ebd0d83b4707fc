"""Chunks of points on disk: every point of a box is found, with its number."""

from __future__ import annotations

import numpy as np
import pytest
from support.point_sets import KINDS

import tinsmith as ts
from tinsmith.tiled.chunks import Chunk, write_chunk
from tinsmith.tiled.store import (
    PointStore,
    count_by_cells,
    join_skeletons,
    load_chunks,
    save_chunks,
)
from tinsmith.tin.tiling.boxes import are_in_box
from tinsmith.tin.tiling.circles import Discs
from tinsmith.tin.tiling.skeleton import reduce_to_hull
from tinsmith.tin.tiling.sources import NumberedPoints


def store(tmp_path, points, *, parts=3):
    """Return points in a store of several chunks, each with every so manyeth of them."""
    chunks = []
    for part in range(parts):
        rows = np.arange(part, len(points), parts)
        if len(rows):
            chunks.append(write_chunk(tmp_path, 0, part, points[rows], rows + 2**40))
    save_chunks(tmp_path / "all.npy", chunks)
    whole = NumberedPoints(points, np.arange(len(points)) + 2**40)
    return PointStore(load_chunks(tmp_path / "all.npy", tmp_path), reduce_to_hull(whole))


def list_boxes(rng, points):
    """Return boxes at random, through points, and without an extent."""
    low, high = points[:, :2].min(axis=0), points[:, :2].max(axis=0)
    for _ in range(20):
        corners = low + (high - low) * rng.random((2, 2)) * 1.2 - 0.1 * (high - low)
        yield ts.Bounds.of(corners)
        yield ts.Bounds.of(points[rng.integers(0, len(points), 2)])
        yield ts.Bounds.of(points[rng.integers(0, len(points), 1)])
    yield ts.Bounds(-np.inf, -np.inf, np.inf, np.inf)


@pytest.mark.parametrize("kind", sorted(KINDS))
def test_every_point_of_a_box_is_read_once_in_order(tmp_path, kind):
    rng = np.random.default_rng(5)
    points = np.asarray(KINDS[kind](rng, 3_000), np.float64).reshape(-1, 3)
    made = store(tmp_path, points)
    assert made.count == len(points)
    assert made.bounds == ts.Bounds.of(points)
    for box in list_boxes(rng, points):
        rows = np.flatnonzero(are_in_box(points, box))
        found = made.read_box(box)
        assert (found.numbers == rows + 2**40).all()
        assert (found.points == points[rows]).all()


def test_every_point_of_discs_is_read(tmp_path):
    rng = np.random.default_rng(6)
    points = rng.random((2_000, 3)) * [1e3, 2e3, 10] + [5e5, 4e6, 0]
    made = store(tmp_path, points)
    rows = rng.integers(0, len(points), 30)
    radii = np.hypot(*(points[rows, :2] - points[np.roll(rows, 1), :2]).T) / 10
    discs = Discs(points[rows, :2] + rng.random((30, 2)), radii)
    found = made.read_discs(discs)
    assert len(np.unique(found.numbers)) == len(found.numbers)
    far = np.hypot(*(points[:, None, :2] - discs.centers[None]).transpose(2, 0, 1))
    inside = np.flatnonzero((far <= radii).any(axis=1))
    assert set(inside + 2**40) <= set(found.numbers.tolist())
    endless = Discs(np.zeros((1, 2)), np.array([np.inf]))
    assert len(made.read_discs(endless).numbers) == len(points)


@pytest.mark.parametrize("shape", [(1, 1), (400, 1), (1, 400)])
def test_chunks_without_width_or_height(tmp_path, shape):
    x, y = np.meshgrid(np.arange(shape[0]), np.arange(shape[1]))
    points = np.column_stack([x.ravel(), y.ravel(), x.ravel()]).astype(float)
    made = store(tmp_path, points)
    box = ts.Bounds(0, 0, 10, 10)
    assert len(made.read_box(box).numbers) == are_in_box(points, box).sum()


def test_chunks_are_known_without_reading_points(tmp_path):
    points = np.random.default_rng(1).random((5_000, 3))
    chunk = write_chunk(tmp_path, 3, 7, points, np.arange(5_000) * 3 + 10)
    save_chunks(tmp_path / "all.npy", [chunk])
    (again,) = load_chunks(tmp_path / "all.npy", tmp_path)
    assert again == chunk == Chunk(tmp_path, 3, 7, 10, 5_000, ts.Bounds.of(points), chunk.shape)
    assert again.path.name == "000003-000007.npy"
    assert again.offsets[-1] == 5_000
    assert (np.sort(again.read([slice(0, 5_000)]).numbers) == np.arange(5_000) * 3 + 10).all()


def test_skeletons_of_chunks_hold_the_hull_of_all_and_stay_small(tmp_path):
    rng = np.random.default_rng(2)
    points = rng.random((60_000, 3))
    whole = NumberedPoints(points, np.arange(60_000))
    bounds = ts.Bounds.of(points)
    known = join_skeletons([whole.choose(np.arange(k, 60_000, 40)) for k in range(40)], bounds)
    hull = reduce_to_hull(whole)
    assert set(hull.numbers.tolist()) <= set(known.numbers.tolist())
    assert len(known.numbers) <= 16 * 32 * 32 + len(hull.numbers)


def test_cells_of_chunks_are_counted_where_they_lie(tmp_path):
    rng = np.random.default_rng(3)
    points = rng.random((20_000, 3)) * [100, 50, 1]
    points[:15_000, 0] /= 4
    made = store(tmp_path, points)
    counts = count_by_cells(made.chunks, made.bounds, 4)
    assert counts.sum() == 20_000
    west = (points[:, 0] < made.bounds.xmin + made.bounds.width / 4).sum()
    assert abs(counts[:, 0].sum() - west) < 0.1 * west


def test_large_discs(tmp_path, monkeypatch):
    monkeypatch.setattr("tinsmith.tiled.store._MANY", 100)
    rng = np.random.default_rng(8)
    points = rng.random((20_000, 3)) * [1e3, 1e3, 10] + [5e5, 4e6, 0]
    made = store(tmp_path, points)
    centers = [[500_500.0, 4_000_500.0], [499_000.0, 4_000_500.0], [499_000.0, 4_000_500.0]]
    discs = Discs(np.array(centers), np.array([400.0, 1_200.0, 999.0]))
    far = np.hypot(*(points[:, None, :2] - discs.centers[None]).transpose(2, 0, 1))
    some = made.read_some(discs)
    chosen = far[some.numbers - 2**40]
    assert 0 < len(some.numbers) <= 128
    assert (chosen < discs.radii).any(axis=1).all()
    assert (chosen < discs.radii).any(axis=0).tolist() == [True, True, False]
    found = made.read_discs(discs)
    inside = np.flatnonzero((far <= discs.radii).any(axis=1)) + 2**40
    assert set(inside.tolist()) <= set(found.numbers.tolist())
    assert len(found.numbers) < 1.1 * len(inside)
    assert len(made.read_some(discs.choose([2])).numbers) == 0


@pytest.mark.parametrize("kind", sorted(KINDS))
def test_large_discs_of_any_points(tmp_path, monkeypatch, kind):
    monkeypatch.setattr("tinsmith.tiled.store._MANY", 10)
    rng = np.random.default_rng(9)
    points = np.asarray(KINDS[kind](rng, 3_000), np.float64).reshape(-1, 3)
    made = store(tmp_path, points)
    rows = rng.integers(0, len(points), 20)
    centers = points[rows, :2]
    radii = np.hypot(*(centers - points[np.roll(rows, 1), :2]).T)
    found = made.read_discs(Discs(centers, radii))
    far = np.hypot(*(points[:, None, :2] - centers[None]).transpose(2, 0, 1))
    inside = np.flatnonzero((far <= radii).any(axis=1)) + 2**40
    assert set(inside.tolist()) <= set(found.numbers.tolist())
    some = made.read_some(Discs(centers, radii))
    assert set(some.numbers.tolist()) <= set(inside.tolist())
