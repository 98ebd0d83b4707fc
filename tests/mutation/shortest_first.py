"""A plugin of pytest: order tests by how long they took before, those that take least first.

A mutant that many tests notice is then noticed by one that takes milliseconds, and the minutes of
the long ones are spent on those that live.
"""

from __future__ import annotations

import json
import os
from pathlib import Path

import pytest

_KNOWN = Path(os.environ["MUTATION_DURATIONS"])
_UNKNOWN = 0.05
_seconds: dict[str, float] = json.loads(_KNOWN.read_text()) if _KNOWN.exists() else {}


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    items.sort(key=lambda item: _seconds.get(item.nodeid, _UNKNOWN))


def pytest_runtest_logreport(report: pytest.TestReport) -> None:
    if report.when == "call" and report.passed:
        _seconds[report.nodeid] = round(report.duration, 3)


def pytest_sessionfinish() -> None:
    """Keep the durations; whoever comes last wins, for they need not be exact."""
    part = _KNOWN.with_suffix(f".{os.getpid()}")
    part.write_text(json.dumps(_seconds, indent=0))
    part.replace(_KNOWN)
