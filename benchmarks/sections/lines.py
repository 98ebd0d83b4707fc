"""Triangulation of points with breaklines beside other libraries: seconds and memory.

As in ``kernel``: every tool in a process of its own, in turn, and every answer compared. Ours is
checked by ``ts.check``, and its lines against edges found in whole numbers.
"""

from __future__ import annotations

import sys
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

import tinsmith as ts
from tinsmith.base.arrays import Int64Array
from tinsmith.tin import TIN

from ..compiled import build_harness
from ..datasets.lines import LEAST_POINTS, LINE_DATASETS, LineTask, make_lines
from ..measure import Outcome, Result
from ..peers.answers import Verdict, encode_edges, judge_answer, number_corners, rank_triangles
from ..peers.line_tools import ALL_LINE_TOOLS, ARGUMENTS, LINE_TOOLS
from ..peers.tool_process import ToolFailedError, ToolProcess, make_task_command
from ..peers.triangulators import is_compiled, is_exact, name_harness
from .kernel import find_tools, make_result, run_tools

__all__ = ["SECTION", "run"]

SECTION = "lines"


def run(
    n: int,
    *,
    names: Iterable[str] = tuple(LINE_DATASETS),
    tools: Sequence[str] = ALL_LINE_TOOLS,
    repeats: int = 5,
    limit: float = 60.0,
) -> Outcome:
    """Measure tools on ``n`` points, or ``LEAST_POINTS``, with lines; else as ``kernel.run``."""
    outcome = Outcome()
    present = find_tools(tools, LINE_TOOLS, "lines", outcome)
    for name in names:
        print(f"lines: {name}, {n:,} points", file=sys.stderr, flush=True)
        task = make_lines(name, max(n, LEAST_POINTS))
        outcome.results += _measure_lines(name, task, present, repeats, limit)
    return outcome


class LineProcess(ToolProcess):
    """A tool that holds points and lines."""

    def command(self, name: str, task: LineTask, folder: Path) -> list[str]:
        """Write the task for the tool; return what runs it."""
        if not is_compiled(name):
            return make_task_command("lines", name, task, folder)
        plane, segments = folder / "points.bin", folder / "segments.bin"
        task.vertices.tofile(plane)
        task.segments.tofile(segments)
        harness = build_harness(name_harness(name, "lines"))
        return [str(harness), str(plane), str(segments), *ARGUMENTS[name]]


def _measure_lines(
    name: str, task: LineTask, tools: list[str], repeats: int, limit: float
) -> Iterator[Result]:
    wanted = _prepare_wanted(task)
    with run_tools(LineProcess, tools, task, repeats, limit) as (processes, failures):
        verdicts = {
            tool: Verdict(False, failures[tool])
            if tool in failures
            else _judge_lines(tool, process, wanted)
            for tool, process in processes.items()
        }
    for tool, process in processes.items():
        yield make_result(SECTION, name, tool, len(task.vertices), process, verdicts[tool])


# ------------------------------------------------------------------------ answers


class _Wanted(NamedTuple):
    tin: TIN
    triangles: Int64Array
    steps: Int64Array


def _prepare_wanted(task: LineTask) -> _Wanted:
    """Return our answer, proved, and the edges that lines must be, as its vertices."""
    tin = ts.triangulate(task.points, breaklines=task.breaklines())
    ts.check(tin, level=3, points=task.points).raise_if_failed()
    assert len(tin.points) == len(task.vertices)
    place = number_corners(np.stack([task.vertices] * 3, axis=1), tin.points)[:, 0]
    assert (np.sort(place) == np.arange(len(place))).all()
    steps = place[task.steps]
    codes = np.unique(encode_edges(steps))
    assert np.array_equal(np.unique(encode_edges(tin.lines.segments())), codes)
    triangle, corner = np.nonzero(tin.constrained)
    ends = [tin.triangles[triangle, (corner + k) % 3] for k in (1, 2)]
    assert np.array_equal(np.unique(encode_edges(np.stack(ends, axis=1))), codes)
    return _Wanted(tin, rank_triangles(tin.triangles), steps)


def _judge_lines(tool: str, process: ToolProcess, wanted: _Wanted) -> Verdict:
    try:
        answer = process.triangles()
    except ToolFailedError as error:
        return Verdict(False, str(error))
    found = judge_answer(wanted.tin, answer, wanted.triangles, steps=wanted.steps)
    assert found.is_right or not is_exact(tool, LINE_TOOLS), f"{tool}: {found.text}"
    return found
