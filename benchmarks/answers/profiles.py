"""Profiles and cross sections beside VTK's slice and shapely's tree of edges, on the same TIN.

Preparing, which is from a TIN to its index, is timed apart from cutting. Peers must find the same
breaks, at the same elevations.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

import tinsmith as ts
from tinsmith.base.arrays import Float64Array, Int64Array
from tinsmith.tin import TIN

from ..measure import OURS, Outcome, Result, alternate, find_median

__all__ = ["run"]

SECTION = "answers"
SIZE = 1000.0
"""Side of the square of points."""

MOST_SECTIONS = 10_000
SECTION_WIDTH = 20.0
ROUNDING = 1e-6

Cut = Callable[[Float64Array, Float64Array], Float64Array]
"""Cuts segments (starts, ends) and returns the elevations of all their breaks, sorted."""


class Tool(NamedTuple):
    """What cuts: the module that it needs, and how it is prepared."""

    module: str
    prepare: Callable[[TIN], Cut]


def run(n_points: int, *, repeats: int = 3) -> Outcome:
    """Measure a profile across ``n_points`` uniform points, and cross sections of it.

    An AssertionError says that a peer finds other breaks.
    """
    rng = np.random.default_rng(1)
    tin = ts.triangulate(rng.random((n_points, 3)) * [SIZE, SIZE, 50.0])
    outcome = Outcome()
    middle = np.linspace(0.2 * SIZE, 0.8 * SIZE, min(MOST_SECTIONS, n_points // 10))
    half = 0.5 * SECTION_WIDTH
    sections = (
        np.column_stack([middle, np.full(len(middle), 0.5 * SIZE - half)]),
        np.column_stack([middle, np.full(len(middle), 0.5 * SIZE + half)]),
    )
    line = (np.array([[0.1, 0.15]]) * SIZE, np.array([[0.9, 0.83]]) * SIZE)
    _measure("profile: a line across", tin, line, LINE_TOOLS, repeats, outcome)
    task = f"cross sections: {len(middle):,} of {SECTION_WIDTH:g} m"
    _measure(task, tin, sections, SECTION_TOOLS, repeats, outcome)
    return outcome


def _measure(
    task: str,
    tin: TIN,
    segments: tuple[Float64Array, Float64Array],
    tools: dict[str, Tool],
    repeats: int,
    outcome: Outcome,
) -> None:
    present = outcome.present({name: tool.module for name, tool in tools.items()})
    calls, prepared = {}, {}
    for name in present:
        begin = time.perf_counter()
        cut = tools[name].prepare(tin)
        prepared[name] = time.perf_counter() - begin
        calls[name] = _call(cut, *segments)
    answers, runs = alternate(calls, repeats)
    for name in present:
        np.testing.assert_allclose(answers[name], answers[OURS], rtol=0, atol=ROUNDING)
        extra = {"prepare_seconds": prepared[name], "breaks": len(answers[name])}
        seconds = find_median(runs[name])
        outcome.results.append(
            Result(SECTION, task, name, len(tin.points), seconds, tuple(runs[name]), "", extra)
        )


def _call(cut: Cut, starts: Float64Array, ends: Float64Array) -> Callable[[], Float64Array]:
    return lambda: cut(starts, ends)


def _tinsmith(tin: TIN) -> Cut:
    fresh = TIN.from_triangles(tin.points, tin.triangles)
    fresh.interpolate([[SIZE / 2, SIZE / 2]])  # builds the index

    def cut(starts: Float64Array, ends: Float64Array) -> Float64Array:
        lines = np.stack([starts, ends], axis=1)
        table = ts.profile(fresh, ts.Features.of_lines(lines.reshape(-1, 2), _pairs(len(starts))))
        return np.sort(table["elevation"][table["crossed"] != "line"])

    return cut


def _pairs(count: int) -> Int64Array:
    return np.arange(0, 2 * count + 1, 2)


def _shapely(tin: TIN) -> Cut:
    import shapely

    edges = tin.edges
    tree = shapely.STRtree(shapely.linestrings(tin.points[edges][:, :, :2]))

    def cut(starts: Float64Array, ends: Float64Array) -> Float64Array:
        lines = shapely.linestrings(np.stack([starts, ends], axis=1))
        line, edge = tree.query(lines, predicate="crosses")
        (a, b), (c, d) = (starts[line], ends[line]), tin.points[edges[edge]].transpose(1, 0, 2)
        at_c, at_d = _side(a, b, c), _side(a, b, d)
        return np.sort(c[:, 2] + at_c / (at_c - at_d) * (d[:, 2] - c[:, 2]))

    return cut


def _side(a: Float64Array, b: Float64Array, c: Float64Array) -> Float64Array:
    side: Float64Array = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1])
    return side - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])


def _pyvista(tin: TIN) -> Cut:
    import pyvista

    mesh = pyvista.PolyData.from_regular_faces(tin.points, tin.triangles)

    def cut(starts: Float64Array, ends: Float64Array) -> Float64Array:
        (start,), (end,) = starts, ends
        along = end - start
        found: Any = mesh.slice(normal=(-along[1], along[0], 0.0), origin=(*start, 0.0))
        points = np.asarray(found.points)
        share = (points[:, :2] - start) @ along / (along @ along)
        inside = (share > 0) & (share < 1)  # the plane goes on beyond the line
        return np.sort(points[inside, 2])

    return cut


LINE_TOOLS = {
    OURS: Tool("tinsmith", _tinsmith),
    "shapely": Tool("shapely", _shapely),
    "VTK": Tool("pyvista", _pyvista),
}
SECTION_TOOLS = {name: LINE_TOOLS[name] for name in (OURS, "shapely")}
