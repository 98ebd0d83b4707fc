"""Time point location and linear interpolation beside the peers, on one and the same TIN.

Run ``python -m benchmarks.locate`` (under a minute) or ``python -m benchmarks.locate --full``
(a million points, a million places). Every answer that is timed is compared with ours first.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from typing import NamedTuple, TypeVar

import matplotlib.tri
import numpy as np
import startinpy
from numpy.typing import NDArray
from scipy.interpolate import LinearNDInterpolator
from scipy.spatial import Delaunay

import tinsmith as ts
from tinsmith.tin import TIN

SIZE = 1000.0
"""Side of the square; small, because SciPy loses points at national coordinates."""

MOST_SLOW_QUERIES = 20_000
"""startinpy answers some thousand places a second: it gets no more than these."""

Floats = NDArray[np.float64]
T = TypeVar("T")


class Row(NamedTuple):
    """One measurement: seconds to prepare, best seconds to answer, answers a second."""

    tool: str
    task: str
    n_points: int
    n_queries: int
    prepare_seconds: float
    seconds: float

    @property
    def rate(self) -> float:
        """Answers a second."""
        return self.n_queries / self.seconds


class Case(NamedTuple):
    """What every tool is asked."""

    tin: TIN
    xy: Floats
    repeats: int

    def row(
        self, tool: str, task: str, prepare: float, seconds: float, n: int | None = None
    ) -> Row:
        """Note what a tool needed for the first ``n`` places, default all."""
        return Row(tool, task, len(self.tin.points), n or len(self.xy), prepare, seconds)


def run(n_points: int = 50_000, n_queries: int = 50_000, repeats: int = 3) -> list[Row]:
    """Measure every tool on ``n_points`` uniform points and ``n_queries`` uniform places.

    Raises
    ------
    AssertionError
        If a peer's answer differs from ours.
    """
    rng = np.random.default_rng(1)
    points = rng.random((n_points, 3)) * [SIZE, SIZE, 50.0]
    case = Case(ts.triangulate(points), rng.random((n_queries, 2)) * SIZE, repeats)
    rows, located, heights = _tinsmith(case)
    return [*rows, _scipy(case, heights), _matplotlib(case, located), _startinpy(case, heights)]


def _timed(function: Callable[[], T], repeats: int = 1) -> tuple[T, float]:
    best = np.inf
    for _ in range(repeats):
        begin = time.perf_counter()
        answer = function()
        best = min(best, time.perf_counter() - begin)
    return answer, best


def _tinsmith(case: Case) -> tuple[list[Row], NDArray[np.int32], Floats]:
    tin = case.tin
    _, prepare = _timed(lambda: tin.locate(case.xy[:1]))
    located, locate_seconds = _timed(lambda: tin.locate(case.xy), case.repeats)
    heights, seconds = _timed(lambda: tin.interpolate(case.xy), case.repeats)
    rows = [
        case.row("tinsmith", "locate", prepare, locate_seconds),
        case.row("tinsmith", "interpolate", prepare, seconds),
    ]
    return rows, located, heights


def _scipy(case: Case, heights: Floats) -> Row:
    points = case.tin.points

    def prepared() -> LinearNDInterpolator:
        interpolator = LinearNDInterpolator(Delaunay(points[:, :2]), points[:, 2])
        interpolator(case.xy[:1])  # the first answer fills a table
        return interpolator

    interpolator, prepare = _timed(prepared)
    answer, seconds = _timed(lambda: interpolator(case.xy), case.repeats)
    np.testing.assert_allclose(answer, heights, rtol=0, atol=1e-6)
    return case.row("scipy", "interpolate", prepare, seconds)


def _matplotlib(case: Case, located: NDArray[np.int32]) -> Row:
    tin = case.tin
    triangulation = matplotlib.tri.Triangulation(tin.points[:, 0], tin.points[:, 1], tin.triangles)
    finder, prepare = _timed(triangulation.get_trifinder)
    answer, seconds = _timed(lambda: finder(case.xy[:, 0], case.xy[:, 1]), case.repeats)
    np.testing.assert_array_equal(answer, located)
    return case.row("matplotlib", "locate", prepare, seconds)


def _startinpy(case: Case, heights: Floats) -> Row:
    surface = startinpy.DT()
    surface.snap_tolerance = 1e-9
    _, prepare = _timed(lambda: surface.insert(_in_strips(case.tin.points)))
    n = min(len(case.xy), MOST_SLOW_QUERIES)
    answer, seconds = _timed(lambda: surface.interpolate({"method": "TIN"}, case.xy[:n]))
    np.testing.assert_allclose(answer, heights[:n], rtol=0, atol=1e-6)
    return case.row("startinpy", "interpolate", prepare, seconds, n)


def _in_strips(points: Floats) -> Floats:
    """To and fro in strips: inserted at random, a million points take half a minute."""
    strip = (points[:, 1] / SIZE * np.sqrt(len(points) / 2)).astype(np.int64)
    eastwards = np.where(strip % 2 == 0, points[:, 0], -points[:, 0])
    return points[np.lexsort((eastwards, strip))]


def main() -> None:
    """Print one line a tool."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--full", action="store_true", help="a million points and places")
    size, repeats = (1_000_000, 1) if parser.parse_args().full else (50_000, 3)
    print(f"{'tool':<12}{'task':<13}{'places':>9}{'prepare s':>11}{'answer s':>10}{'per s':>13}")
    for row in run(size, size, repeats):
        print(
            f"{row.tool:<12}{row.task:<13}{row.n_queries:>9}{row.prepare_seconds:>11.3f}"
            f"{row.seconds:>10.3f}{row.rate:>13,.0f}"
        )


if __name__ == "__main__":
    main()
