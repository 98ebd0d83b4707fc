"""What a benchmark gives back, and fair timing: the tools in turn, the median of several."""

from __future__ import annotations

import importlib.util
import math
import statistics
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

__all__ = ["OURS", "Outcome", "Result", "alternate", "find_median", "is_installed"]

OURS = "tinsmith"
SLOW_SECONDS = 4.0
"""A run longer than this is not repeated."""


@dataclass(frozen=True)
class Result:
    """One tool on one task.

    Attributes
    ----------
    section, task, tool : str
    count : int
        Size of the task: points, places, rows or triangles.
    seconds : float
        Median; NaN if the tool did not end in time.
    runs : tuple of float
        Seconds of every run.
    note : str
        What the reader must know to compare.
    extra : dict
        Further figures by name.
    """

    section: str
    task: str
    tool: str
    count: int
    seconds: float
    runs: tuple[float, ...] = ()
    note: str = ""
    extra: dict[str, Any] = field(default_factory=dict)


@dataclass
class Outcome:
    """Everything that a section measured, and a line for every peer that was not there."""

    results: list[Result] = field(default_factory=list)
    skipped: list[str] = field(default_factory=list)

    def present(self, modules: Mapping[str, str]) -> list[str]:
        """Return the tools whose module is installed; note the others."""
        missing = {tool: module for tool, module in modules.items() if not is_installed(module)}
        self.skip({tool: f"{module} is not installed" for tool, module in missing.items()})
        return [tool for tool in modules if tool not in missing]

    def skip(self, reasons: Mapping[str, str]) -> None:
        """Note why tools were left out."""
        lines = [f"{tool}: skipped, {reason}." for tool, reason in reasons.items()]
        self.skipped += [line for line in lines if line not in self.skipped]

    def add(self, other: Outcome) -> None:
        """Take over what another section measured."""
        self.results += other.results
        self.skipped += [line for line in other.skipped if line not in self.skipped]


def is_installed(module: str) -> bool:
    """Whether a module can be imported, without importing it."""
    return importlib.util.find_spec(module) is not None


def find_median(runs: list[float]) -> float:
    """Return the median, NaN of nothing."""
    return statistics.median(runs) if runs else math.nan


def alternate(
    tools: Mapping[str, Callable[[], Any]], repeats: int
) -> tuple[dict[str, Any], dict[str, list[float]]]:
    """Run the tools in turn, ``repeats`` rounds; return first answers and seconds by tool."""
    answers: dict[str, Any] = {}
    runs: dict[str, list[float]] = {name: [] for name in tools}
    for turn in range(repeats):
        for name, run in tools.items():
            if turn and runs[name][0] > SLOW_SECONDS:
                continue
            begin = time.perf_counter()
            answer = run()
            runs[name].append(time.perf_counter() - begin)
            if turn == 0:
                answers[name] = answer
            del answer
    return answers, runs
