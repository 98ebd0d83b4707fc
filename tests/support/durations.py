"""Tests whose cases take long together: `make test` runs the first of them, `make slow` more.

What exceeds the budget of `make slow` too is left to `make proof`.

durations.json has the mean seconds of a case of every test that takes more than `BUDGET` with all
its cases. `make durations` measures them anew. A test that is not listed runs with all its cases,
and so does one marked ``every_case``, or ``every_case("slow")`` by the end of `make slow`.
"""

from __future__ import annotations

import json
from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping
from pathlib import Path

import pytest

LISTED = Path(__file__).parents[1] / "durations.json"
BUDGET = 0.4
"""Seconds that all cases of a test may take in `make test`."""
SLOW_BUDGET = 5.0
"""Seconds that they may take in `make slow`, where one case of every test is run."""


def name_test(nodeid: str) -> str:
    """Return the name of a test without its parameters, as durations.json has it."""
    return nodeid.split("[", 1)[0]


def read_durations() -> dict[str, float]:
    """Return the mean seconds of a case of the tests that are listed."""
    return json.loads(LISTED.read_text())


def mark_long_tests(items: Iterable[pytest.Item], seconds: Mapping[str, float]) -> None:
    """Mark as slow, or as proof, the case that exceeds a budget of its test, and all behind it."""
    seen: Counter[str] = Counter()
    for item in items:
        name, whole = name_test(item.nodeid), item.get_closest_marker("every_case")
        if name not in seconds or item.get_closest_marker("proof") or (whole and not whole.args):
            continue
        seen[name] += 1
        taken = seen[name] * seconds[name]
        if seen[name] > 1 and taken > SLOW_BUDGET and not whole:
            item.add_marker("proof")
        elif taken > BUDGET and item.get_closest_marker("slow") is None:
            item.add_marker("slow")


def is_left_out(item: pytest.Item, expression: str) -> bool:
    """Whether a test is run by another command than the one that selects by an expression."""
    if item.get_closest_marker("proof"):
        return "proof" not in expression
    return bool(item.get_closest_marker("slow")) and "slow" not in expression


class Recorder:
    """A plugin of pytest that writes durations.json after a run of all tests."""

    def __init__(self) -> None:
        self.cases: defaultdict[str, Counter[str]] = defaultdict(Counter)

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        self.cases[name_test(report.nodeid)][report.nodeid] += report.duration

    def pytest_sessionfinish(self) -> None:
        long = {name: cases for name, cases in self.cases.items() if cases.total() > BUDGET}
        means = {name: round(long[name].total() / len(long[name]), 2) for name in sorted(long)}
        LISTED.write_text(json.dumps(means, indent=1) + "\n")
