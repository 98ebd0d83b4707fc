"""Interpolation and rasters beside SciPy, matplotlib and startinpy, on one and the same TIN.

Smooth surfaces differ within triangles, and are compared along edges, where SciPy's and ours are
the same.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

import tinsmith as ts
from tinsmith.base.arrays import AnyArray, Float64Array
from tinsmith.tin import TIN

from ..measure import OURS, Outcome
from ..peers.place_tools import (
    SIZE,
    Answer,
    Asked,
    Tool,
    ask_tools,
    make_tin,
    use_scipy,
    use_startinpy,
)

__all__ = ["run"]

SECTION = "answers"
MOST_SLOW_PLACES = 5_000
"""startinpy answers some thousand places a second: it gets no more than these."""

CELLS_PER_POINT = 16


def run(n_points: int, *, repeats: int = 3) -> Outcome:
    """Measure every tool on ``n_points`` uniform points, and as many places.

    An AssertionError says that a peer's answer differs from ours.
    """
    rng = np.random.default_rng(1)
    tin = make_tin(n_points, rng)
    inner = (0.1 + 0.8 * rng.random((n_points, 2))) * SIZE
    middles = tin.points[tin.edges, :2].mean(axis=1)
    middles = rng.permutation(middles[np.abs(middles / SIZE - 0.5).max(axis=1) < 0.4])[:n_points]
    side = int(np.sqrt(CELLS_PER_POINT * n_points))
    cells = ts.Grid(ts.Bounds(0.0, 0.0, SIZE, SIZE), shape=(side, side), spacing=SIZE / side)
    tasks = [
        (f"interpolate: {task}", tools, middles if task.startswith("c1") else inner)
        for task, tools in TASKS.items()
    ]
    tasks.append(("raster: linear", _raster_tools(cells), _centers(cells)))
    outcome = Outcome()
    for task, tools, places in tasks:
        asked = ask_tools(tools, tin, places, repeats, outcome)
        _require_same(asked, tools)
        outcome.results += [one.make_result(SECTION, task, name) for name, one in asked.items()]
    return outcome


def _require_same(asked: dict[str, Asked], tools: dict[str, Tool]) -> None:
    for name, one in asked.items():
        wanted = asked[OURS].answers[: len(one.answers)]
        both = np.isfinite(one.answers) & np.isfinite(wanted)
        assert both.mean() > 0.95, f"{name} has other places inside"
        rounding = tools[name].rounding
        np.testing.assert_allclose(one.answers[both], wanted[both], rtol=0, atol=rounding)


def _centers(grid: ts.Grid) -> Float64Array:
    rows, columns = grid.shape
    x = grid.bounds.xmin + (np.arange(columns) + 0.5) * grid.spacing
    y = grid.bounds.ymax - (np.arange(rows) + 0.5) * grid.spacing
    return np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)


def _ours(method: Any) -> Callable[[TIN], Answer]:
    def prepare(tin: TIN) -> Answer:
        fresh = ts.triangulate(tin.points)
        return lambda xy: fresh.interpolate(xy, method=method, threads=1)

    return prepare


def _nearest_of_scipy(tin: TIN) -> Answer:
    from scipy.interpolate import NearestNDInterpolator

    answer: Answer = NearestNDInterpolator(tin.points[:, :2], tin.points[:, 2])
    return answer


def _raster_tools(grid: ts.Grid) -> dict[str, Tool]:
    def ours(tin: TIN) -> Answer:
        fresh = ts.triangulate(tin.points)

        def answer(xy: Float64Array) -> AnyArray:
            raster = ts.rasterize(fresh, grid=grid, threads=1)
            return np.asarray(raster.bands["elevation"]).ravel()[: len(xy)]

        return answer

    return {OURS: Tool("tinsmith", ours), "SciPy": Tool("scipy", use_scipy("LinearNDInterpolator"))}


TASKS = {
    "nearest": {
        OURS: Tool("tinsmith", _ours("nearest")),
        "SciPy": Tool("scipy", _nearest_of_scipy),
    },
    "natural": {
        OURS: Tool("tinsmith", _ours("natural")),
        "startinpy": Tool("startinpy", use_startinpy("NNI"), most=MOST_SLOW_PLACES),
    },
    "laplace": {
        OURS: Tool("tinsmith", _ours("laplace")),
        "startinpy": Tool("startinpy", use_startinpy("Laplace"), most=MOST_SLOW_PLACES),
    },
    "c1, along edges": {
        OURS: Tool("tinsmith", _ours("c1")),
        "SciPy": Tool("scipy", use_scipy("CloughTocher2DInterpolator", tol=1e-9), rounding=1e-4),
    },
}
"""Who answers what."""
