"""Of tests that take long `make test` runs the first cases; the list names tests that exist."""

from __future__ import annotations

import json
from types import SimpleNamespace

import pytest
from support import durations

ROOT = durations.LISTED.parents[1]


@pytest.mark.parametrize("number", range(5))
@pytest.mark.parametrize(
    ("seconds", "kept"), [(0.05, 5), (0.1, 4), (0.13, 3), (0.4, 1), (0.41, 0), (60, 0)]
)
def test_cases_beyond_the_budget_are_slow(number, seconds, kept, request):
    name = durations.name_test(request.node.nodeid)
    cases = [case for case in request.node.parent.collect() if case.nodeid.startswith(name)][:5]
    durations.mark_long_tests(cases, {name: seconds})
    slow = [case.get_closest_marker("slow") is not None for case in cases]
    assert slow == [False] * kept + [True] * (5 - kept)


def test_what_is_not_listed_runs_and_what_is_marked_runs_too(request):
    [case] = [one for one in request.node.parent.collect() if one.nodeid == request.node.nodeid]
    durations.mark_long_tests([case], {})
    assert case.get_closest_marker("slow") is None
    case.add_marker("every_case")
    durations.mark_long_tests([case], {case.nodeid: 100.0})
    assert case.get_closest_marker("slow") is None


def test_means_of_long_tests_are_recorded(tmp_path, monkeypatch):
    monkeypatch.setattr(durations, "LISTED", tmp_path / "durations.json")
    recorder = durations.Recorder()
    for nodeid, seconds in [("a.py::b[1]", 0.3), ("a.py::b[2]", 0.1), ("a.py::c", 0.4)]:
        for duration in (seconds, 0.01):  # a report each of setting up and of calling
            recorder.pytest_runtest_logreport(SimpleNamespace(nodeid=nodeid, duration=duration))
    recorder.pytest_sessionfinish()
    assert json.loads(durations.LISTED.read_text()) == {"a.py::b": 0.21, "a.py::c": 0.41}


def test_every_listed_test_exists():
    for name in durations.read_durations():
        path, *_, test = name.split("::")
        assert f"def {test}(" in (ROOT / path).read_text(), name
