"""Residuals without each point, against surfaces that are built without it."""

from __future__ import annotations

import numpy as np
import pytest
from support.leave_one_out import interpolate_without, rounding_of

import tinsmith as ts
from tinsmith.tin import _kernel
from tinsmith.tin.screening import scales
from tinsmith.tin.screening.residuals import Residuals
from tinsmith.tin.screening.scales import NORMAL, find_rounding, measure_scales


def prepare(tin):
    return _kernel.LeaveOneOut(tin.points, tin.triangles, tin.neighbors)


def scattered(rng, count):
    return rng.random((count, 2)) * 10


def on_a_small_grid(rng, count):
    return np.unique(rng.integers(0, 6, (count, 2)), axis=0).astype(float)


def at_utm(rng, count):
    return np.unique(rng.integers(0, 20, (count, 2)), axis=0) * 0.1 + [752_000.3, 4_024_000.7]


def on_a_circle(rng, count):
    angle = np.sort(rng.random(count)) * 2 * np.pi
    return np.vstack([np.column_stack([np.cos(angle), np.sin(angle)]), [[0.1, 0.2]]])


@pytest.mark.parametrize("kind", [scattered, on_a_small_grid, at_utm, on_a_circle])
def test_every_residual_is_that_of_a_surface_built_without_the_point(kind):
    rng = np.random.default_rng(8)
    told = 0
    for _ in range(12):
        xy = kind(rng, int(rng.integers(5, 40)))
        points = np.column_stack([xy, rng.normal(300, 5, len(xy))])
        try:
            tin = ts.triangulate(points)
        except ts.PointsError:
            continue
        every = np.arange(len(points), dtype=np.int32)
        found = prepare(tin).interpolate(every)[:, 0]
        expected = [interpolate_without(points, row) for row in every]
        np.testing.assert_allclose(found, expected, rtol=0, atol=rounding_of(points))
        told += int(np.isfinite(found).sum())
    assert told > (5 if kind is on_a_circle else 50)  # all of a circle are on the hull


@pytest.mark.slow
def test_lines_beside_a_point_are_kept_when_it_is_left_out():
    rng = np.random.default_rng(3)
    for _ in range(20):
        xy = rng.random((30, 2)) * 10
        points = np.column_stack([xy, rng.normal(300, 5, 30)])
        rows = rng.choice(30, 2, replace=False)
        ends = points[rows]
        tin = ts.triangulate(points, breaklines=[ends])
        known = Residuals.of(tin.triangulation)
        free = np.setdiff1d(np.flatnonzero(~known.on_line), rows).astype(np.int32)
        free = free[free < 30]
        found = tin.points[free, 2] - known.measure(free)
        for vertex, elevation in zip(free.tolist(), found.tolist(), strict=True):
            expected = interpolate_without(points, vertex, breaklines=[ends])
            if not np.isnan(expected):
                assert elevation == pytest.approx(expected, abs=rounding_of(points))


def test_a_vertex_of_a_line_is_compared_with_its_chord():
    line = [[0.0, 5.0, 10.0], [4.0, 5.0, 13.0], [10.0, 5.0, 10.0]]
    corners = [[0, 0, 10], [10, 0, 10], [10, 10, 0], [0, 10, 0]]
    tin = ts.triangulate(corners, breaklines=[line])
    known = Residuals.of(tin.triangulation)
    middle = np.flatnonzero((tin.points[:, :2] == [4, 5]).all(axis=1)).astype(np.int32)
    residual, moment = known.measure_with_moments(middle)
    assert residual == pytest.approx([3.0])
    assert moment == pytest.approx([24.0])
    ends = np.flatnonzero(known.on_line & (known.chords[:, 0] < 0)).astype(np.int32)
    assert len(ends) == 2
    assert np.isnan(known.measure(ends)).all()


def test_the_moment_is_half_the_error_on_a_quadratic_surface():
    """Linear interpolation of x^2 + y^2 is too high by the moment, exactly."""
    rng = np.random.default_rng(1)
    xy = rng.random((60, 2)) * 10
    points = np.column_stack([xy, (xy**2).sum(axis=1)])
    tin = ts.triangulate(points)
    every = np.arange(60, dtype=np.int32)
    elevation, moment = prepare(tin).interpolate(every).T
    inside = np.isfinite(elevation)
    np.testing.assert_allclose(elevation[inside] - points[inside, 2], moment[inside], atol=1e-11)


def test_a_corner_of_the_hull_is_compared_with_the_plane_around_it():
    x, y = np.meshgrid(np.arange(6.0), np.arange(6.0))
    z = 300 + 0.3 * x - 0.2 * y
    z[0, 0] += 2.0
    tin = ts.triangulate(np.column_stack([x.ravel(), y.ravel(), z.ravel()]))
    residual = Residuals.of(tin.triangulation).measure(np.array([0], np.int32))
    assert residual == pytest.approx([2.0])


@pytest.mark.parametrize("bad", [[-1], [4], [2**31 - 1]])
def test_the_kernel_refuses_vertices_that_are_not_there(bad):
    tin = ts.triangulate([[0, 0, 5], [4, 0, 6], [4, 3, 7], [0, 3, 8]])
    for ask in (prepare(tin).interpolate, prepare(tin).list_neighbors):
        with pytest.raises(ValueError, match="vertices must be numbers from 0 to n - 1"):
            ask(np.array(bad, np.int32))


def test_neighbors_are_those_of_the_surface():
    rng = np.random.default_rng(2)
    tin = ts.triangulate(np.column_stack([rng.random((50, 2)), rng.random(50)]))
    every = np.arange(50, dtype=np.int32)
    offsets, near = prepare(tin).list_neighbors(every)
    measured = _kernel.measure_neighbors(tin.points, tin.triangles)
    for v in range(50):
        ring = near[offsets[v] : offsets[v + 1]]
        assert sorted(ring.tolist()) == sorted(tin.vertex_neighbors(v).tolist())
        z = tin.points[ring, 2]
        square = ((tin.points[ring, :2] - tin.points[v, :2]) ** 2).sum(axis=1).min()
        np.testing.assert_allclose(measured[v], [z.min(), z.max(), square])


def test_scales_follow_the_noise_and_not_the_blunders():
    """Of normal residuals the median absolute deviation of 64 is within 5 of its deviations."""
    rng = np.random.default_rng(5)
    xy = rng.random((20_000, 2)) * 100
    sigma = np.where(xy[:, 0] < 50, 0.02, 0.5)
    residuals = rng.normal(0, sigma)
    residuals[rng.choice(20_000, 1_000, replace=False)] += 50.0
    scales = measure_scales(xy, residuals, np.ones(20_000), 1e-6)
    margin = 5 * 1.17 / np.sqrt(64)  # 1.17 / sqrt(n) is the relative deviation of the estimate
    away = np.abs(xy[:, 0] - 50) > 12  # a block of 64 of 20,000 is some 6 wide
    ratio = (scales / sigma)[away]
    assert ratio.min() > 1 - margin
    assert ratio.max() < (1 + margin) * 1.25  # a tenth of a block at most spoilt, and two of them
    assert pytest.approx(1 / 0.6745, rel=1e-4) == NORMAL


@pytest.mark.parametrize("count", [1, 2, 63, 64, 65, 5000])
@pytest.mark.parametrize("steps", [2, 50, 10**9])
def test_points_are_in_strips_forth_and_back(count, steps):
    """Also points of one coordinate: their order is that of their rows."""
    rng = np.random.default_rng(count)
    along, across = rng.integers(0, steps, (2, count)).astype(float)
    strips = max(1, round(np.sqrt(count / 64)))
    strip = np.empty(count, np.int64)
    strip[np.argsort(across)] = np.arange(count) * strips // count
    expected = np.lexsort((np.where(strip % 2 == 0, along, -along), strip))
    assert scales._sort_by_strips(along, across).tolist() == expected.tolist()


def test_the_rounding_is_that_of_the_decimals():
    rng = np.random.default_rng(6)
    for decimals in range(4):
        z = np.round(rng.random(900) * 500, decimals)
        lost = rng.random(100_000) * 10.0**-decimals
        assert find_rounding(z) == pytest.approx(lost.std(), rel=0.02)
    assert find_rounding(rng.random(900) * 500) < 1e-6
    assert find_rounding(np.full(5, 318.2)) < 0.03


def test_the_pairs_within_two_edges_are_in_proportion_where_all_meet_in_one_vertex():
    """Over it each of 20,000 points would be near all others."""
    angle = 2 * np.pi * np.arange(20_000) / 20_000
    ring = np.column_stack([100 * np.cos(angle), 100 * np.sin(angle), np.sin(9 * angle)])
    tin = ts.triangulate(np.vstack([[0, 0, 0], ring]), boundary=[ring])
    hub = tin.vertex_of[0]
    known = Residuals.of(tin.triangulation)
    everyone = np.arange(len(tin.points), dtype=np.int32)
    offsets, around = known.list_wide_neighbors(everyone)
    assert len(around) < 10 * len(tin.points)
    assert offsets[hub + 1] - offsets[hub] == len(ring)
    assert (np.bincount(around, minlength=len(everyone))[hub]) == len(ring)
