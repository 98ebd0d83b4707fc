"""Interpolation and rasters beside SciPy, matplotlib and startinpy, on one and the same TIN.

Preparing, which is from points to the first answer, is timed apart. Smooth surfaces differ within
triangles, and are compared along edges, where SciPy's and ours are the same.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

import tinsmith as ts
from tinsmith.arrays import AnyArray, Float64Array
from tinsmith.tin import TIN

from ..measure import OURS, Outcome, Result, alternate, find_median

__all__ = ["run"]

SECTION = "answers"
SIZE = 1000.0
"""Side of the square; small, because SciPy loses points at national coordinates."""

MOST_SLOW_PLACES = 5_000
"""startinpy answers some thousand places a second: it gets no more than these."""

CELLS_PER_POINT = 16

Answer = Callable[[Float64Array], AnyArray]


class Tool(NamedTuple):
    """What answers places: its module, how it is prepared, and how many places it gets at most."""

    module: str
    prepare: Callable[[TIN], Answer]
    rounding: float = 1e-6
    most: int = sys.maxsize


def run(n_points: int, *, repeats: int = 3) -> Outcome:
    """Measure every tool on ``n_points`` uniform points, and as many places.

    An AssertionError says that a peer's answer differs from ours.
    """
    rng = np.random.default_rng(1)
    tin = ts.triangulate(rng.random((n_points, 3)) * [SIZE, SIZE, 50.0])
    inner = (0.1 + 0.8 * rng.random((n_points, 2))) * SIZE
    middles = tin.points[tin.edges, :2].mean(axis=1)
    middles = rng.permutation(middles[np.abs(middles / SIZE - 0.5).max(axis=1) < 0.4])[:n_points]
    side = int(np.sqrt(CELLS_PER_POINT * n_points))
    cells = ts.Grid(ts.Bounds(0.0, 0.0, SIZE, SIZE), shape=(side, side), spacing=SIZE / side)
    outcome = Outcome()
    for task, tools in TASKS.items():
        places = middles if task.startswith("c1") else inner
        _measure(f"interpolate: {task}", tin, places, tools, repeats, outcome)
    _measure("raster: linear", tin, _centers(cells), _raster_tools(cells), repeats, outcome)
    return outcome


def _measure(
    task: str,
    tin: TIN,
    xy: Float64Array,
    tools: dict[str, Tool],
    repeats: int,
    outcome: Outcome,
) -> None:
    calls, prepared, counts = {}, {}, {}
    for name in outcome.present({name: tool.module for name, tool in tools.items()}):
        begin = time.perf_counter()
        answer = tools[name].prepare(tin)
        answer(xy[:1])  # the first answer may fill a table
        prepared[name] = time.perf_counter() - begin
        counts[name] = min(len(xy), tools[name].most)
        calls[name] = _call(answer, xy[: counts[name]])
    answers, runs = alternate(calls, repeats)
    for name, found in answers.items():
        wanted = answers[OURS][: counts[name]]
        both = np.isfinite(found) & np.isfinite(wanted)
        assert both.mean() > 0.95, f"{name} has other places inside"
        np.testing.assert_allclose(found[both], wanted[both], rtol=0, atol=tools[name].rounding)
        extra = {"prepare_seconds": prepared[name]}
        seconds, times = find_median(runs[name]), tuple(runs[name])
        outcome.results.append(Result(SECTION, task, name, counts[name], seconds, times, "", extra))


def _call(answer: Answer, xy: Float64Array) -> Callable[[], AnyArray]:
    return lambda: answer(xy)


def _centers(grid: ts.Grid) -> Float64Array:
    rows, columns = grid.shape
    x = grid.bounds.xmin + (np.arange(columns) + 0.5) * grid.spacing
    y = grid.bounds.ymax - (np.arange(rows) + 0.5) * grid.spacing
    return np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)


def _ours(method: Any) -> Callable[[TIN], Answer]:
    def prepare(tin: TIN) -> Answer:
        fresh = ts.triangulate(tin.points)
        return lambda xy: fresh.interpolate(xy, method, threads=1)

    return prepare


def _startinpy(method: str) -> Callable[[TIN], Answer]:
    def prepare(tin: TIN) -> Answer:
        import startinpy

        surface = startinpy.DT()
        surface.snap_tolerance = 1e-9
        strip = (tin.points[:, 1] / SIZE * np.sqrt(len(tin.points) / 2)).astype(np.int64)
        surface.insert(tin.points[np.lexsort((tin.points[:, 0], strip))])
        return lambda xy: np.asarray(surface.interpolate({"method": method}, xy))

    return prepare


def _scipy(name: str, **options: Any) -> Callable[[TIN], Answer]:
    def prepare(tin: TIN) -> Answer:
        import scipy.interpolate
        from scipy.spatial import Delaunay

        made = getattr(scipy.interpolate, name)
        answer: Answer = made(Delaunay(tin.points[:, :2]), tin.points[:, 2], **options)
        return answer

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

    return {OURS: Tool("tinsmith", ours), "SciPy": Tool("scipy", _scipy("LinearNDInterpolator"))}


TASKS = {
    "nearest": {
        OURS: Tool("tinsmith", _ours("nearest")),
        "SciPy": Tool("scipy", _nearest_of_scipy),
    },
    "natural": {
        OURS: Tool("tinsmith", _ours("natural")),
        "startinpy": Tool("startinpy", _startinpy("NNI"), most=MOST_SLOW_PLACES),
    },
    "laplace": {
        OURS: Tool("tinsmith", _ours("laplace")),
        "startinpy": Tool("startinpy", _startinpy("Laplace"), most=MOST_SLOW_PLACES),
    },
    "c1, along edges": {
        OURS: Tool("tinsmith", _ours("c1")),
        "SciPy": Tool("scipy", _scipy("CloughTocher2DInterpolator", tol=1e-9), rounding=1e-4),
    },
}
"""Who answers what."""
