"""Triangulation beside the peers: seconds, memory and work, on clean and on ugly data.

Every tool lives in a process of its own and holds the points; they triangulate in turn. Answers
are compared after the timing: those of tools that claim to be exact must be right, those of the
others are described.
"""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import tinsmith as ts
from tinsmith.base.arrays import Float64Array
from tinsmith.tin import _kernel

from ..compiled import PeerMissingError, build_harness
from ..datasets.points import DATASETS, make_points
from ..measure import OURS, SLOW_SECONDS, Outcome, Result, find_median
from ..peers.answers import Verdict, judge_answer, make_counting_judge, rank_triangles
from ..peers.tool_process import ToolFailedError, ToolProcess
from ..peers.triangulators import (
    ALL_CORES,
    CGAL,
    DELAUNAY32,
    DELAUNAY32_ALL_CORES,
    KERNEL,
    KERNEL_ALL_CORES,
    TOOLS,
    is_compiled,
    is_exact,
    name_harness,
)

__all__ = [
    "ALL_TOOLS",
    "OUR_TOOLS",
    "SECTION",
    "WORK",
    "find_tools",
    "list_cases",
    "make_result",
    "run",
    "run_tools",
]

SECTION = "kernel"
WORK = "work"
"""Stands as tool in the rows that count work."""

OUR_TOOLS = (OURS, KERNEL, ALL_CORES, KERNEL_ALL_CORES)
COMPILED_TOOLS = (CGAL, DELAUNAY32, DELAUNAY32_ALL_CORES)
ALL_TOOLS = (*OUR_TOOLS, *COMPILED_TOOLS, *(name for name in TOOLS if name not in OUR_TOOLS))
LARGEST_COMPARED = 1_000_000
"""Above this only the numbers of triangles are compared, and ours is checked to level 2."""


class Case(NamedTuple):
    """A task: a data set of some size."""

    name: str
    n: int


def run(
    cases: Iterable[tuple[str, int]],
    *,
    tools: Sequence[str] = ALL_TOOLS,
    repeats: int = 5,
    limit: float = 60.0,
) -> Outcome:
    """Measure tools on data sets.

    Parameters
    ----------
    cases : iterable of (str, int)
        Data sets and their number of points.
    tools : sequence of str
    repeats : int
        Rounds; in each every tool triangulates once.
    limit : float
        Seconds that a peer may take for one run.

    An AssertionError says that our answer, or that of an exact peer, is wrong.
    """
    outcome = Outcome()
    present = find_tools(tools, TOOLS, "points", outcome)
    for name, n in cases:
        print(f"kernel: {name}, {n:,} points", file=sys.stderr, flush=True)
        outcome.results += _measure_case(Case(name, n), present, repeats, limit)
    return outcome


def find_tools(
    tools: Sequence[str], modules: Mapping[str, Any], work: str, outcome: Outcome
) -> list[str]:
    """Return the tools that are here, compiled ones by their harness for some work; note others."""
    here = outcome.present({tool: modules[tool].module for tool in tools if not is_compiled(tool)})
    for tool in filter(is_compiled, tools):
        try:
            build_harness(name_harness(tool, work))
            here.append(tool)
        except PeerMissingError as error:
            outcome.skip({tool: str(error)})
    return [tool for tool in tools if tool in here]


def _measure_case(case: Case, tools: list[str], repeats: int, limit: float) -> Iterator[Result]:
    points = make_points(case.name, case.n)
    fitting = [tool for tool in tools if len(points) <= _find_largest(tool)]
    with run_tools(ToolProcess, fitting, points, repeats, limit) as (processes, failures):
        verdicts = _judge_all(points, processes, failures)
    for tool, process in processes.items():
        yield make_result(SECTION, case.name, tool, len(points), process, verdicts[tool])
    yield _measure_work(case, points)


def _find_largest(tool: str) -> int:
    return TOOLS[tool].largest if tool in TOOLS else TOOLS[OURS].largest


@contextmanager
def run_tools(
    kind: type[ToolProcess], tools: Iterable[str], task: Any, repeats: int, limit: float
) -> Iterator[tuple[dict[str, ToolProcess], dict[str, str]]]:
    """Run tools in turn, each in a process of ``kind``; yield these, and what failed by tool."""
    with tempfile.TemporaryDirectory() as folder, ExitStack() as stack:
        processes = {
            tool: stack.enter_context(kind(tool, task, Path(folder), limit)) for tool in tools
        }
        yield processes, _run_in_turn(processes, repeats)


def _run_in_turn(processes: Mapping[str, ToolProcess], repeats: int) -> dict[str, str]:
    """Run A B C A B C; return what went wrong by tool."""
    failures: dict[str, str] = {}
    for turn in range(repeats):
        for tool, process in processes.items():
            if tool in failures or (turn and process.seconds[0] > SLOW_SECONDS):
                continue
            try:
                process.run()
            except ToolFailedError as error:
                failures[tool] = str(error)
    return failures


def make_result(
    section: str, task: str, tool: str, count: int, process: ToolProcess, found: Verdict
) -> Result:
    """Return seconds, memory and answer of a tool that has had its turns."""
    extra: dict[str, Any] = {"is_right": found.is_right}
    if process.growth is not None and process.seconds:
        extra["peak_bytes_per_point"] = process.growth / count
        if tool in OUR_TOOLS:
            beyond = process.growth - process.output_bytes
            extra["beyond_output_bytes_per_point"] = beyond / count
    runs = tuple(process.seconds)
    return Result(section, task, tool, count, find_median(process.seconds), runs, found.text, extra)


def _measure_work(case: Case, points: Float64Array) -> Result:
    counts = _kernel.count_work(points, method=_kernel.Method.GROWTH_OR_INSERTION)
    per_triangle = {
        name: count / counts["triangles"] for name, count in counts.items() if name != "triangles"
    }
    return Result(SECTION, case.name, WORK, len(points), float("nan"), extra=per_triangle)


# ----------------------------------------------------------------------- answers


def _judge_all(
    points: Float64Array, processes: dict[str, ToolProcess], failures: dict[str, str]
) -> dict[str, Verdict]:
    """Return what is to be said of each tool's answer."""
    tin = ts.triangulate(points)
    level = 3 if len(points) <= LARGEST_COMPARED else 2
    ts.check(tin, level=level, points=points).raise_if_failed()
    assert len(tin.points) == len(points)
    assert len(tin.triangles) == 2 * len(points) - 2 - len(tin.hull)
    judge = (
        partial(judge_answer, tin, wanted=rank_triangles(tin.triangles))
        if level == 3
        else make_counting_judge(tin)
    )
    return {
        tool: Verdict(False, failures[tool])
        if tool in failures
        else _accept(tool, judge(process.triangles()))
        for tool, process in processes.items()
    }


def _accept(tool: str, found: Verdict) -> Verdict:
    assert found.is_right or not is_exact(tool, TOOLS), f"{tool}: {found.text}"
    return found


def list_cases(n: int, *, is_full: bool = False) -> list[tuple[str, int]]:
    """Return every data set at ``n`` points, and uniform points at smaller sizes (and larger)."""
    smaller = [("uniform", size) for size in (1_000, 10_000, 100_000) if size < n]
    larger = [("uniform", 10_000_000)] if is_full else []
    return smaller + [(name, n) for name in DATASETS] + larger
