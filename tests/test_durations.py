"""Of tests that take long `make test` runs the first cases; the list names tests that exist."""

from __future__ import annotations

import json
from types import SimpleNamespace

import pytest
from support import durations

ROOT = durations.LISTED.parents[1]


@pytest.mark.parametrize("number", range(5))
@pytest.mark.parametrize(
    ("seconds", "commands"),
    [
        (0.05, "ttttt"),
        (0.1, "tttts"),
        (0.13, "tttss"),
        (0.4, "tssss"),
        (0.41, "sssss"),
        (1.5, "ssspp"),
        (60, "spppp"),
    ],
)
def test_cases_beyond_a_budget_are_left_to_the_next_command(number, seconds, commands, request):
    name = durations.name_test(request.node.nodeid)
    cases = [case for case in request.node.parent.collect() if case.nodeid.startswith(name)][:5]
    durations.mark_long_tests(cases, {name: seconds})
    found = {"t": "", "s": "slow", "p": "proof"}
    for case, command in zip(cases, commands, strict=True):
        by = [one for one, expression in found.items() if not is_left(case, expression)]
        assert by == [command], case.nodeid


def is_left(case, expression):
    """Whether a command does not run a case: left out, or not chosen by its expression."""
    chosen = not expression or case.get_closest_marker(expression) is not None
    return durations.is_left_out(case, expression) or not chosen


def test_a_test_whose_cases_must_all_run_has_no_proofs(request):
    [case] = [one for one in request.node.parent.collect() if one.nodeid == request.node.nodeid]
    case.add_marker(pytest.mark.every_case("slow"))
    durations.mark_long_tests([case] * 3, {case.nodeid: 60.0})
    assert case.get_closest_marker("slow") is not None
    assert case.get_closest_marker("proof") is None


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
