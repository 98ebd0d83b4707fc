"""A plugin of pytest: run the tests that are asked for, those that took least time before first.

A mutant that many tests notice is then noticed by one that takes milliseconds, and the minutes of
the long ones are spent on those that live. A test that hangs ends soon, and what hypothesis finds
is not made small.
"""

from __future__ import annotations

import json
import os
from pathlib import Path

import hypothesis
import pytest
from hypothesis import Phase

_KNOWN = Path(os.environ["MUTATION_DURATIONS"])
_CHOSEN = os.environ.get("MUTATION_CHOSEN", "")
_UNKNOWN = 0.05
_HANGS_AFTER = 30.0, 10.0
"""Seconds, and multiples of what it took: the larger of both is allowed on a busy machine."""

_seconds: dict[str, float] = json.loads(_KNOWN.read_text()) if _KNOWN.exists() else {}


@pytest.hookimpl(trylast=True)
def pytest_configure() -> None:
    usual = hypothesis.settings.get_profile("explore")
    phases = (Phase.explicit, Phase.generate)
    hypothesis.settings.register_profile("mutation", usual, phases=phases)
    hypothesis.settings.load_profile("mutation")


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    if _CHOSEN:
        chosen = set(json.loads(Path(_CHOSEN).read_text()))
        gone = chosen - {name for item in items for name in names_of(item)}
        chosen |= {name.partition("[")[0] for name in gone}  # their parameters were changed since
        wanted = {one for one in items if chosen & set(names_of(one))}
        config.hook.pytest_deselected(items=[one for one in items if one not in wanted])
        items[:] = [one for one in items if one in wanted]
    items.sort(key=lambda item: _seconds.get(item.nodeid, _UNKNOWN))
    if "MUTATION_MAP" in os.environ:
        return  # followed line by line a test takes many times as long
    for item in items:
        least, times = _HANGS_AFTER
        limit = max(least, times * _seconds.get(item.nodeid, 0.0))
        item.add_marker(pytest.mark.timeout(limit, method="thread"))


def names_of(item: pytest.Item) -> tuple[str, str, str]:
    """Return what names a test: itself, with all its parameters, or its file."""
    return item.nodeid, item.nodeid.partition("[")[0], item.nodeid.partition("::")[0]


def pytest_runtest_logreport(report: pytest.TestReport) -> None:
    if report.when == "call" and report.passed:
        _seconds[report.nodeid] = round(report.duration, 3)


def pytest_sessionfinish() -> None:
    """Keep the durations; whoever comes last wins, for they need not be exact."""
    part = _KNOWN.with_suffix(f".{os.getpid()}")
    part.write_text(json.dumps(_seconds, indent=0))
    part.replace(_KNOWN)
