"""Tools that answer places on one and the same TIN: prepared one by one, then asked in turn.

Preparing, which is from points to the first answer, is timed apart from answering.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np

from tinsmith import triangulate
from tinsmith.base.arrays import AnyArray, Float64Array
from tinsmith.tin import TIN

from ..measure import Outcome, Result, alternate, find_median

__all__ = ["SIZE", "Answer", "Asked", "Tool", "ask_tools", "make_tin", "use_scipy", "use_startinpy"]

SIZE = 1000.0
"""Side of the square of points; small, because SciPy loses points at national coordinates."""

Answer = Callable[[Float64Array], AnyArray]


class Tool(NamedTuple):
    """What answers places: its module, how it is prepared, and how many places it gets at most."""

    module: str
    prepare: Callable[[TIN], Answer]
    rounding: float = 1e-6
    most: int = sys.maxsize


class Asked(NamedTuple):
    """What a tool answered, and the seconds that it took in every round, and to be prepared."""

    answers: AnyArray
    runs: list[float]
    prepare_seconds: float

    def make_result(self, section: str, task: str, tool: str) -> Result:
        """Return the row of a report."""
        seconds, extra = find_median(self.runs), {"prepare_seconds": self.prepare_seconds}
        count = len(self.answers)
        return Result(section, task, tool, count, seconds, tuple(self.runs), "", extra)


def make_tin(n_points: int, rng: np.random.Generator) -> TIN:
    """Triangulate uniform points in the square."""
    return triangulate(rng.random((n_points, 3)) * [SIZE, SIZE, 50.0])


def ask_tools(
    tools: Mapping[str, Tool], tin: TIN, xy: Float64Array, repeats: int, outcome: Outcome
) -> dict[str, Asked]:
    """Prepare the tools, and have them answer the places, or as many as they get, in turn.

    Those that are not here are noted in the outcome.
    """
    present = outcome.present({name: tool.module for name, tool in tools.items()})
    prepared = {name: _prepare(tools[name], tin, xy[:1]) for name in present}
    calls = {
        name: _prepare_call(answer, xy[: tools[name].most])
        for name, (answer, _) in prepared.items()
    }
    answers, runs = alternate(calls, repeats)
    return {name: Asked(answers[name], runs[name], prepared[name][1]) for name in present}


def _prepare(tool: Tool, tin: TIN, place: Float64Array) -> tuple[Answer, float]:
    """Return what answers, and the seconds until it has answered once."""
    begin = time.perf_counter()
    answer = tool.prepare(tin)
    answer(place)  # the first answer may fill a table
    return answer, time.perf_counter() - begin


def _prepare_call(answer: Answer, xy: Float64Array) -> Callable[[], AnyArray]:
    return lambda: answer(xy)


def use_scipy(name: str, **options: Any) -> Callable[[TIN], Answer]:
    """Return how an interpolator of SciPy is prepared."""

    def prepare(tin: TIN) -> Answer:
        import scipy.interpolate
        from scipy.spatial import Delaunay

        made = getattr(scipy.interpolate, name)
        answer: Answer = made(Delaunay(tin.points[:, :2]), tin.points[:, 2], **options)
        return answer

    return prepare


def use_startinpy(method: str) -> Callable[[TIN], Answer]:
    """Return how a method of startinpy is prepared."""

    def prepare(tin: TIN) -> Answer:
        import startinpy

        surface = startinpy.DT()
        surface.snap_tolerance = 1e-9
        surface.insert(_order_in_strips(tin.points))
        return lambda xy: np.asarray(surface.interpolate({"method": method}, xy))

    return prepare


def _order_in_strips(points: Float64Array) -> Float64Array:
    """To and fro in strips: inserted at random, a million points take half a minute."""
    strip = (points[:, 1] / SIZE * np.sqrt(len(points) / 2)).astype(np.int64)
    eastwards = np.where(strip % 2 == 0, points[:, 0], -points[:, 0])
    return points[np.lexsort((eastwards, strip))]
