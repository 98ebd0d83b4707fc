"""Volumes between two TINs, beside the sum of raster cells that comes near the same result.

No open tool overlays triangulations: they sum the cells of two rasters. So ours is also measured
that way, at the coarsest resolution that reaches an error that many would accept. Both surfaces
cover one square, so what must come of cut and fill together is known from each surface alone.
"""

from __future__ import annotations

from functools import partial
from typing import NamedTuple

import numpy as np

import tinsmith as ts
from tinsmith.tin import TIN

from ..measure import OURS, Outcome, Result, alternate, find_median

__all__ = ["TASK", "run"]

SECTION = "answers"
SIZE = 10_000.0
"""Side of the square of points, metres."""

ERROR = 1e-4
"""Of cut and of fill, by which sums of cells may be off."""

EXACT = 1e-9
MOST_CELLS_PER_POINT = 64
CELLS = "raster cells"
TASK = "volume: cut and fill between two TINs"


class Volumes(NamedTuple):
    """Cut and fill, cubic metres."""

    cut: float
    fill: float


def run(n_points: int, *, repeats: int = 3) -> Outcome:
    """Measure the volumes between two TINs of ``n_points`` points each, on one thread.

    Raises
    ------
    AssertionError
        If volumes do not add up, or sums of cells do not come near.
    """
    rng = np.random.default_rng(1)
    before, after = (_make_surface(rng, n_points, shift) for shift in (0.0, 0.4))
    exact = _measure_exactly(before, after)
    _require_balance(exact, before, after)
    side = _find_resolution(before, after, exact)
    calls = {
        OURS: partial(_measure_exactly, before, after),
        CELLS: partial(_sum_cells, before, after, side),
    }
    answers, runs = alternate(calls, repeats)
    outcome = Outcome()
    for name, found in answers.items():
        error = _error_of(found, exact)
        note = f"{side * side:,} cells: off by {error:.0e}" if name == CELLS else "exact"
        outcome.results.append(
            Result(
                SECTION,
                TASK,
                name,
                n_points,
                find_median(runs[name]),
                tuple(runs[name]),
                note,
                {"relative_error": error},
            )
        )
    return outcome


def _make_surface(rng: np.random.Generator, n_points: int, shift: float) -> TIN:
    along = np.linspace(0.0, SIZE, int(np.sqrt(n_points)))
    sides = [np.full_like(along, end) for end in (0.0, SIZE)]
    border = [np.column_stack([along, end]) for end in sides]
    border += [np.column_stack([end, along[1:-1]]) for end in (sides[0][1:-1], sides[1][1:-1])]
    ring = np.concatenate(border)
    xy = np.concatenate([ring, rng.random((n_points - len(ring), 2)) * SIZE])
    x, y = xy.T
    z = 300 + 60 * np.sin(x / 900 + shift) * np.cos(y / 1100) + 8 * np.sin(x / 70) * np.sin(y / 90)
    return ts.triangulate(np.column_stack([xy, z]), crs="EPSG:32616", elevation_unit="m")


def _measure_exactly(before: TIN, after: TIN) -> Volumes:
    table = ts.volume(before, after, threads=1)
    return Volumes(float(table["cut"][0]), float(table["fill"][0]))


def _sum_cells(before: TIN, after: TIN, side: int) -> Volumes:
    grid = ts.Grid(ts.Bounds(0.0, 0.0, SIZE, SIZE), shape=(side, side), spacing=SIZE / side)
    first, second = (
        np.asarray(ts.rasterize(tin, grid=grid, threads=1).bands["elevation"])
        for tin in (before, after)
    )
    rise = second - first
    area = grid.spacing**2
    return Volumes(-area * float(rise[rise < 0].sum()), area * float(rise[rise > 0].sum()))


def _find_resolution(before: TIN, after: TIN, exact: Volumes) -> int:
    """Return how many cells along a side come near enough: each trial has twice as many in all."""
    cells = len(before.points) / 64
    while True:
        side = int(np.sqrt(cells))
        error = _error_of(_sum_cells(before, after, side), exact)
        if error <= ERROR:
            return side
        assert cells < MOST_CELLS_PER_POINT * len(before.points), f"cells are off by {error}"
        cells *= 2


def _error_of(found: Volumes, exact: Volumes) -> float:
    return max(abs(found.cut / exact.cut - 1), abs(found.fill / exact.fill - 1))


def _require_balance(found: Volumes, before: TIN, after: TIN) -> None:
    """Refuse a fill less cut that is not what lies under the one surface less under the other."""
    under = [
        float(tin.triangle_areas @ (tin.points[tin.triangles, 2].mean(axis=1) - 300.0))
        for tin in (before, after)
    ]
    error = abs((found.fill - found.cut) - (under[1] - under[0]))
    assert error <= EXACT * (found.fill + found.cut), f"cut and fill are off by {error}"
