"""Edits of a finished TIN beside CGAL and startinpy: one call each, and one large batch.

Every tool in a process of its own, in turn, one core each. After the timing the answers are
compared with the TIN of the points as they are then, built afresh.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

import tinsmith as ts
from tinsmith.tin import TIN

from ..compiled import build_harness
from ..datasets.edits import BATCH, EDIT_TASKS, EditTask, label_task, make_edit_task
from ..measure import Outcome, Result, find_median
from ..peers.answers import Verdict, judge_answer, number_corners, rank_triangles
from ..peers.edit_tools import ALL_EDIT_TOOLS, BUILD, EDIT_TOOLS, OPENED
from ..peers.tool_process import ToolProcess, make_task_command
from ..peers.triangulators import CGAL, is_compiled, is_exact, name_harness
from .kernel import find_tools, run_tools

__all__ = ["SECTION", "run"]

SECTION = "edits"
CGAL_COLUMNS = (0, 1, 3, 4)
"""Of a script: what, number, x, y."""


def run(
    n: int, *, tools: Sequence[str] = ALL_EDIT_TOOLS, repeats: int = 5, limit: float = 60.0
) -> Outcome:
    """Measure edits of a TIN of ``n`` uniform points.

    Parameters
    ----------
    n : int
    tools : sequence of str
    repeats : int
        Rounds; in each every tool does all edits once, on a new TIN.
    limit : float
        Seconds that a tool may take for building and editing once.

    An AssertionError says that the answer of an exact tool is wrong.
    """
    outcome = Outcome()
    present = find_tools(tools, EDIT_TOOLS, "edits", outcome)
    for name in (*EDIT_TASKS, BATCH):
        print(f"edits: {name}, {n:,} points", file=sys.stderr, flush=True)
        fitting = [tool for tool in present if _takes_part(tool, name)]
        outcome.results += _measure_edits(name, make_edit_task(name, n), fitting, repeats, limit)
    return outcome


def _takes_part(tool: str, name: str) -> bool:
    if tool == CGAL and name == "new elevations":  # it has none
        return False
    return tool != (OPENED if name == BATCH else BUILD)


class EditProcess(ToolProcess):
    """A tool that builds the same triangulation before every run, and edits it."""

    least_timed_seconds = 0.0

    def command(self, name: str, task: EditTask, folder: Path) -> list[str]:
        """Write the task for the tool; return what runs it."""
        if not is_compiled(name):
            return make_task_command("edits", name, task, folder)
        plane, script = folder / "points.bin", folder / "script.bin"
        task.points[:, :2].tofile(plane)
        task.script[:, CGAL_COLUMNS].tofile(script)
        return [str(build_harness(name_harness(name, "edits"))), str(plane), str(script)]


def _measure_edits(
    name: str, task: EditTask, tools: list[str], repeats: int, limit: float
) -> Iterator[Result]:
    tin = ts.triangulate(task.afterwards())
    ts.check(tin, level=3).raise_if_failed()
    with run_tools(EditProcess, tools, task, repeats, limit) as (processes, failures):
        verdicts = {
            tool: Verdict(False, failures[tool])
            if tool in failures
            else _judge_edits(tool, process, tin, task)
            for tool, process in processes.items()
        }
    for tool, process in processes.items():
        label = label_task(name, len(task.points))
        yield _make_result(label, tool, len(task.script), process, verdicts[tool])


def _judge_edits(tool: str, process: ToolProcess, tin: TIN, task: EditTask) -> Verdict:
    wanted = ts.triangulate(task.script[:, 3:]) if tool == BUILD else tin
    answer = process.triangles()
    numbers = number_corners(np.ascontiguousarray(answer[:, :, :2]), wanted.points)
    found = judge_answer(wanted, numbers, rank_triangles(wanted.triangles))
    if found.is_right and answer.shape[2] == 3:
        wrong = np.count_nonzero(wanted.points[numbers, 2] != answer[:, :, 2])
        found = Verdict(False, f"{wrong:,} elevations of corners wrong") if wrong else found
    assert found.is_right or not is_exact(tool, EDIT_TOOLS), f"{tool}: {found.text}"
    return found


def _make_result(task: str, tool: str, count: int, process: ToolProcess, found: Verdict) -> Result:
    extra: dict[str, Any] = {"is_right": found.is_right}
    runs = tuple(process.seconds)
    return Result(SECTION, task, tool, count, find_median(process.seconds), runs, found.text, extra)
