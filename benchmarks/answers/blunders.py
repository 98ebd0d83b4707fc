"""Blunders among the points of hills, and the residuals without each point by another way.

All that were planted are named and nothing else. Residuals of a few points must be those of
surfaces that SciPy triangulates anew without each, which nobody would do for all.
"""

from __future__ import annotations

from typing import Any

import numpy as np

import tinsmith as ts
from tinsmith.terrain.inspection.findings import screen
from tinsmith.tin import TIN, _kernel

from ..measure import OURS, Outcome, Result, alternate, find_median

__all__ = ["run"]

SECTION = "answers"
PLANTED, HEIGHT, NOISE = 50, 5.0, 0.02
SIZE = 1000.0
"""Side of the square of points."""

CHECKED = 3
ROUNDING = 1e-8


def run(n_points: int, *, repeats: int = 3) -> Outcome:
    """Measure the full check and that of a build on ``n_points`` random points.

    An AssertionError says that a planted blunder was not named, a sound point was, or that a
    residual differs.
    """
    tin, planted = _make(n_points)
    outcome = Outcome()
    tasks = {"blunders": ts.blunders, "blunders, as a build looks": screen}
    for task, check in tasks.items():
        answers, runs = alternate({OURS: lambda check=check: check(tin)}, repeats)
        named = set(answers[OURS]["row"].tolist())
        assert named <= planted, f"{task}: {sorted(named - planted)} are sound"
        assert check is screen or named == planted, f"{task}: {sorted(planted - named)} missed"
        seconds = tuple(runs[OURS])
        outcome.results.append(
            Result(SECTION, task, OURS, n_points, find_median(runs[OURS]), seconds)
        )
    if "scipy" in outcome.present({"scipy": "scipy"}):
        _compare_residuals(tin)
    return outcome


def _make(n_points: int) -> tuple[TIN, set[int]]:
    rng = np.random.default_rng(1)
    xy = rng.random((n_points, 2)) * SIZE
    z = 300 + 30 * np.sin(xy[:, 0] / 90) * np.cos(xy[:, 1] / 70) + rng.normal(0, NOISE, n_points)
    inside = np.flatnonzero((np.abs(xy / SIZE - 0.5) < 0.4).all(axis=1))
    planted = inside[:: max(1, len(inside) // PLANTED)][:PLANTED]
    z[planted] += HEIGHT * (100_000 / min(n_points, 100_000))
    return ts.triangulate(np.column_stack([xy, z])), set(planted.tolist())


def _compare_residuals(tin: TIN) -> None:
    from scipy.interpolate import LinearNDInterpolator

    vertices = np.argsort(((tin.points[:, :2] - SIZE / 2) ** 2).sum(axis=1))[:CHECKED]
    without = _kernel.LeaveOneOut(tin.points, tin.triangles, tin.neighbors)
    found: Any = without.interpolate(vertices.astype(np.int32))
    for vertex, elevation in zip(vertices.tolist(), found[:, 0].tolist(), strict=True):
        rest = np.delete(tin.points, vertex, axis=0)
        near = (np.abs(rest[:, :2] - SIZE / 2) < SIZE / 4).all(axis=1)
        theirs = LinearNDInterpolator(rest[near, :2], rest[near, 2])(tin.points[vertex, :2])
        assert abs(float(theirs[0]) - elevation) <= ROUNDING, f"{elevation} and {theirs}"
