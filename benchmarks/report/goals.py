"""The project's own goals, and how a run stands to them."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from typing import NamedTuple

from ..answers import contours, rasters, volumes
from ..datasets.edits import BATCH, EDITS, label_task
from ..measure import OURS, Result
from ..peers.edit_tools import BUILD, WITH_ARRAYS
from ..peers.line_tools import CGAL_INDICES
from ..peers.triangulators import CGAL, KERNEL
from ..sections.variants import TWO_THREADS

__all__ = ["judge_goals"]

POINTS = 1_000_000
UNEVEN = (
    "clusters",
    "contour lines",
    "survey tracks",
    "rails",
    "dense corner",
)


class Goal(NamedTuple):
    """A ratio to reach: at least, or with ``is_most`` at most, the required one."""

    name: str
    tasks: tuple[str, ...]
    required: float
    aim: float
    figure: Callable[[Results, str], float | None]
    is_most: bool = False


class Results:
    """Results of one section by data set, size class and tool."""

    def __init__(self, results: Iterable[Result]) -> None:
        self._by_key = {(r.task, _find_size_class(r.count), r.tool): r for r in results}

    def seconds(self, task: str, tool: str, size: int = POINTS) -> float | None:
        result = self._by_key.get((task, _find_size_class(size), tool))
        return None if result is None else result.seconds

    def memory(self, task: str, tool: str) -> float | None:
        result = self._by_key.get((task, _find_size_class(POINTS), tool))
        return None if result is None else result.extra.get("beyond_output_bytes_per_point")


def _find_size_class(count: int) -> int:
    """Power of ten: data sets have a few points less than asked for."""
    return len(str(round(count * 1.01))) - 1


def _divide(a: float | None, b: float | None) -> float | None:
    return None if a is None or b is None else a / b


def _compare_with_cgal(results: Results, task: str) -> float | None:
    return _divide(results.seconds(task, CGAL), results.seconds(task, KERNEL))


def _compare_threads(results: Results, task: str) -> float | None:
    return _divide(results.seconds(task, OURS), results.seconds(task, TWO_THREADS))


def _compare_sizes(results: Results, task: str) -> float | None:
    large = results.seconds(task, KERNEL, 10 * POINTS)
    return _divide(None if large is None else large / 10.0, results.seconds(task, KERNEL))


def _compare_call(results: Results, task: str) -> float | None:
    return _divide(results.seconds(task, OURS), results.seconds(task, KERNEL))


def _find_memory(results: Results, task: str) -> float | None:
    return results.memory(task, KERNEL)


def _compare_lines_with_cgal(results: Results, task: str) -> float | None:
    """Take the quicker of the two calls of CGAL."""
    calls = [results.seconds(task, CGAL), results.seconds(task, CGAL_INDICES)]
    known = [seconds for seconds in calls if seconds is not None and not math.isnan(seconds)]
    return _divide(min(known), results.seconds(task, OURS)) if known else None


def _compare_edits(results: Results, task: str) -> float | None:
    return results.seconds(task, OURS, EDITS)


def _compare_batch(results: Results, task: str) -> float | None:
    return _divide(results.seconds(task, WITH_ARRAYS), results.seconds(task, BUILD))


def _compare_contours(results: Results, task: str) -> float | None:
    return _divide(results.seconds(task, contours.MATPLOTLIB), results.seconds(task, OURS))


def _compare_raster_files(results: Results, task: str) -> float | None:
    return _divide(results.seconds(task, rasters.GDAL), results.seconds(task, rasters.FILES))


def _find_seconds(results: Results, task: str) -> float | None:
    return results.seconds(task, OURS)


GOALS = (
    Goal("CGAL time / kernel", ("uniform", "scan lines", "raster"), 1.5, 2.5, _compare_with_cgal),
    Goal("CGAL time / kernel", UNEVEN, 1.0, 1.5, _compare_with_cgal),
    Goal("CGAL time / kernel", ("circle", "few circles"), 0.3, 1.0, _compare_with_cgal),
    Goal("CGAL time / kernel", ("decimal raster",), 1.5, 3.0, _compare_with_cgal),
    Goal("kernel, one thread / two, in turn", ("uniform, threads",), 1.7, 1.9, _compare_threads),
    Goal("time per point, 10 M / 1 M", ("uniform",), 1.25, 1.1, _compare_sizes, is_most=True),
    Goal(
        "whole call / kernel",
        ("uniform", "raster", "scan lines", *UNEVEN),
        1.25,
        1.1,
        _compare_call,
        is_most=True,
    ),
    Goal(
        "bytes per point beyond input and output",
        ("uniform", "raster", "scan lines", *UNEVEN, "circle", "few circles"),
        100.0,
        50.0,
        _find_memory,
        is_most=True,
    ),
    Goal("CGAL time / tinsmith", ("short lines",), 1.0, 1.5, _compare_lines_with_cgal),
    Goal("CGAL time / tinsmith", ("nested rings", "hills"), 1.0, 1.5, _compare_lines_with_cgal),
    Goal(
        "seconds for 1,000 edits",
        (label_task("mixed edits", POINTS),),
        0.1,
        0.05,
        _compare_edits,
        is_most=True,
    ),
    Goal(
        "batch / building it", (label_task(BATCH, POINTS),), 3.0, 2.0, _compare_batch, is_most=True
    ),
    Goal("matplotlib time / tinsmith", (contours.TASK,), 5.0, 8.0, _compare_contours),
    Goal(
        "gdal_grid time / tinsmith", (rasters.label_task(POINTS),), 5.0, 8.0, _compare_raster_files
    ),
    Goal("seconds", (volumes.TASK,), 5.0, 4.0, _find_seconds, is_most=True),
)


def judge_goals(results: list[Result]) -> list[list[str]]:
    """Return rows of goal, data set, required, aim, reached and a mark; worst data set each."""
    found = Results(results)
    return [row for goal in GOALS if (row := _judge_goal(goal, found)) is not None]


def _judge_goal(goal: Goal, results: Results) -> list[str] | None:
    figures = {task: figure for task in goal.tasks if (figure := goal.figure(results, task))}
    if not figures:
        return None
    worst = (max if goal.is_most else min)(figures, key=lambda task: figures[task])
    figure = figures[worst]
    is_met = figure <= goal.required if goal.is_most else figure >= goal.required
    sign = "\u2264" if goal.is_most else "\u2265"
    return [
        goal.name,
        f"{worst} (worst of {len(figures)})" if len(figures) > 1 else worst,
        f"{sign} {goal.required:g}",
        f"{goal.aim:g}",
        f"{figure:.0f}" if figure >= 20.0 else f"{figure:.2f}",
        "\u2713" if is_met else "\u2717",
    ]
