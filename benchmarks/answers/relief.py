"""Slope and its classes beside VTK's normals and shapely's union of triangles, on the same TIN."""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

import tinsmith as ts
from tinsmith.tin import TIN

from ..measure import OURS, Outcome, Result, alternate, find_median

__all__ = ["run"]

SECTION = "answers"
SIZE = 1000.0
"""Side of the square of points."""

BREAKS = (10.0, 20.0, 30.0)
ROUNDING = 1e-6
"""By how much the cosine of a slope may be off that comes from normals in single precision."""


class Tool(NamedTuple):
    """What answers: the module that it needs, and how."""

    module: str
    answer: Callable[[TIN], Any]


def run(n_points: int, *, repeats: int = 3) -> Outcome:
    """Measure slopes and their classes on ``n_points`` uniform points.

    An AssertionError says that a peer's answer differs from ours.
    """
    rng = np.random.default_rng(1)
    xy = rng.random((n_points, 2)) * SIZE
    hills = 40 * np.sin(xy[:, 0] / 90) * np.cos(xy[:, 1] / 70)
    tin = ts.triangulate(np.column_stack([xy, hills]))
    outcome = Outcome()
    for task, tools in TASKS.items():
        _measure(task, tin, tools, repeats, outcome)
    return outcome


def _measure(task: str, tin: TIN, tools: dict[str, Tool], repeats: int, outcome: Outcome) -> None:
    print(f"answers: {task}", file=sys.stderr, flush=True)
    present = outcome.present({name: tool.module for name, tool in tools.items()})
    calls = {name: _call(tools[name].answer, tin) for name in present}
    answers, runs = alternate(calls, repeats)
    count = len(tin.triangles)
    for name in present:
        _require_equal(task, answers[name], answers[OURS])
        seconds = tuple(runs[name])
        outcome.results.append(Result(SECTION, task, name, count, find_median(runs[name]), seconds))


def _require_equal(task: str, answer: Any, ours: Any) -> None:
    if task == SLOPES:  # where it is nearly flat, a rounded cosine is a slope that is far off
        answer, ours = np.cos(np.radians(answer)), np.cos(np.radians(ours))
        np.testing.assert_allclose(answer, ours, rtol=0, atol=ROUNDING)
    else:
        np.testing.assert_allclose(answer, ours, rtol=0, atol=ROUNDING * SIZE)


def _call(answer: Callable[[TIN], Any], tin: TIN) -> Callable[[], Any]:
    return lambda: answer(tin)


def _vtk_slopes(tin: TIN) -> Any:
    import pyvista

    mesh = pyvista.PolyData.from_regular_faces(tin.points, np.array(tin.triangles))
    made = mesh.compute_normals(
        point_normals=False, consistent_normals=False, auto_orient_normals=False
    )
    return np.degrees(np.arccos(np.clip(made.cell_data["Normals"][:, 2], -1.0, 1.0)))


def _class_areas(tin: TIN) -> Any:
    import shapely

    return shapely.area(ts.slope_classes(tin, breaks=BREAKS).to_shapely())


def _shapely_areas(tin: TIN) -> Any:
    import shapely

    classes = np.searchsorted(BREAKS, ts.slope(tin), side="right")
    triangles = shapely.polygons(tin.points[tin.triangles, :2])
    return np.array([shapely.union_all(triangles[classes == k]).area for k in np.unique(classes)])


SLOPES = "slope of every triangle"
TASKS = {
    SLOPES: {OURS: Tool("tinsmith", ts.slope), "VTK": Tool("pyvista", _vtk_slopes)},
    "slope classes, dissolved": {
        OURS: Tool("tinsmith", _class_areas),
        "shapely": Tool("shapely", _shapely_areas),
    },
}
