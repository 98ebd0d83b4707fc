"""Tests whose cases take long together: `make test` runs the first of them, `make slow` the others.

durations.json has the mean seconds of a case of every test that takes more than `BUDGET` with all
its cases. `make durations` measures them anew. A test that is not listed runs with all its cases,
and so does one marked ``every_case``.
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


def name_test(nodeid: str) -> str:
    """Return the name of a test without its parameters, as durations.json has it."""
    return nodeid.split("[", 1)[0]


def read_durations() -> dict[str, float]:
    """Return the mean seconds of a case of the tests that are listed."""
    return json.loads(LISTED.read_text())


def mark_long_tests(items: Iterable[pytest.Item], seconds: Mapping[str, float]) -> None:
    """Mark as slow the case that exceeds the budget of its test, and all behind it."""
    seen: Counter[str] = Counter()
    for item in items:
        name = name_test(item.nodeid)
        if name not in seconds or any(
            map(item.get_closest_marker, ("slow", "proof", "every_case"))
        ):
            continue
        seen[name] += 1
        if seen[name] * seconds[name] > BUDGET:
            item.add_marker("slow")


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
