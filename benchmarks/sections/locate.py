"""Point location and linear interpolation beside the peers, on one and the same TIN.

Preparing, which is from points to the first answer (of matplotlib from triangles, since it has no
triangulation of its own), is timed apart from answering.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

import tinsmith as ts
from tinsmith.arrays import AnyArray, Float64Array
from tinsmith.tin import TIN

from ..measure import OURS, Outcome, Result, alternate, find_median

__all__ = ["SECTION", "run"]

SECTION = "locate"

SIZE = 1000.0
"""Side of the square; small, because SciPy loses points at national coordinates."""

MOST_SLOW_QUERIES = 20_000
"""startinpy answers some thousand places a second: it gets no more than these."""

Answer = Callable[[Float64Array], AnyArray]


class Tool(NamedTuple):
    """What answers places: how it is prepared, and how many places it gets at most."""

    name: str
    prepare: Callable[[TIN], Answer]
    most: int = sys.maxsize


def run(n_points: int = 50_000, n_queries: int = 50_000, *, repeats: int = 3) -> Outcome:
    """Measure every tool on ``n_points`` uniform points and ``n_queries`` uniform places.

    An AssertionError says that a peer's answer differs from ours.
    """
    rng = np.random.default_rng(1)
    tin = ts.triangulate(rng.random((n_points, 3)) * [SIZE, SIZE, 50.0])
    xy = rng.random((n_queries, 2)) * SIZE
    outcome = Outcome()
    present = outcome.present(MODULES)
    for task, tools in TASKS.items():
        print(f"locate: {task}, {n_queries:,} places", file=sys.stderr, flush=True)
        outcome.results += _measure_queries(
            task, [t for t in tools if t.name in present], tin, xy, repeats
        )
    return outcome


def _measure_queries(
    task: str, tools: list[Tool], tin: TIN, xy: Float64Array, repeats: int
) -> list[Result]:
    prepared = {tool.name: _prepare_tool(tool, tin) for tool in tools}
    asked = {tool.name: xy[: tool.most] for tool in tools}
    calls = {name: _prepare_query(answer, asked[name]) for name, (answer, _) in prepared.items()}
    answers, runs = alternate(calls, repeats)
    results = []
    for name, (_, prepare_seconds) in prepared.items():
        count = len(asked[name])
        np.testing.assert_allclose(answers[name], answers[OURS][:count], rtol=0, atol=1e-6)
        extra = {"prepare_seconds": prepare_seconds}
        seconds = find_median(runs[name])
        results.append(Result(SECTION, task, name, count, seconds, tuple(runs[name]), "", extra))
    return results


def _prepare_tool(tool: Tool, tin: TIN) -> tuple[Answer, float]:
    """Return what answers, and the seconds until it has answered once."""
    begin = time.perf_counter()
    answer = tool.prepare(tin)
    answer(np.array([[SIZE / 2, SIZE / 2]]))  # the first answer may fill a table
    return answer, time.perf_counter() - begin


def _prepare_query(answer: Answer, xy: Float64Array) -> Callable[[], AnyArray]:
    return lambda: answer(xy)


def _locate_with_tinsmith(tin: TIN) -> Answer:
    return ts.triangulate(tin.points).locate


def _interpolate_with_tinsmith(tin: TIN) -> Answer:
    return ts.triangulate(tin.points).interpolate


def _interpolate_with_scipy(tin: TIN) -> Answer:
    from scipy.interpolate import LinearNDInterpolator
    from scipy.spatial import Delaunay

    answer: Answer = LinearNDInterpolator(Delaunay(tin.points[:, :2]), tin.points[:, 2])
    return answer


def _locate_with_matplotlib(tin: TIN) -> Answer:
    import matplotlib.tri

    made = matplotlib.tri.Triangulation(tin.points[:, 0], tin.points[:, 1], tin.triangles)
    finder = made.get_trifinder()
    return lambda xy: finder(xy[:, 0], xy[:, 1])


def _interpolate_with_startinpy(tin: TIN) -> Answer:
    import startinpy

    surface = startinpy.DT()
    surface.snap_tolerance = 1e-9
    surface.insert(_order_in_strips(tin.points))
    return lambda xy: np.asarray(surface.interpolate({"method": "TIN"}, xy))


def _order_in_strips(points: Float64Array) -> Float64Array:
    """To and fro in strips: inserted at random, a million points take half a minute."""
    strip = (points[:, 1] / SIZE * np.sqrt(len(points) / 2)).astype(np.int64)
    eastwards = np.where(strip % 2 == 0, points[:, 0], -points[:, 0])
    return points[np.lexsort((eastwards, strip))]


TASKS = {
    "locate": [Tool(OURS, _locate_with_tinsmith), Tool("matplotlib", _locate_with_matplotlib)],
    "interpolate": [
        Tool(OURS, _interpolate_with_tinsmith),
        Tool("SciPy", _interpolate_with_scipy),
        Tool("startinpy", _interpolate_with_startinpy, MOST_SLOW_QUERIES),
    ],
}
"""Who answers what."""

MODULES = {OURS: "tinsmith", "matplotlib": "matplotlib", "SciPy": "scipy", "startinpy": "startinpy"}
"""What must be installed for each tool."""
