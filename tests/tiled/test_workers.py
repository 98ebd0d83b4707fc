"""Steps of a run: every task is accounted for, and only what is open is done."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import pytest

import tinsmith as ts
from tinsmith.tiled.running.runs import Record, Run
from tinsmith.tiled.running.workers import Phase


@dataclass(frozen=True)
class Job:
    """A task of some points."""

    key: str
    count: int


def halve(job):
    """Return halves, none of a point."""
    if job.count < 2:
        return []
    return [Job(f"{job.key}.{k}", job.count // 2) for k in range(2)]


@pytest.fixture
def run(tmp_path):
    """Return a run that is open."""
    run = Run(tmp_path / "out.run")
    manifest = {"version": "1", "product": "raster", "options": {}, "inputs": []}
    with run.opened(manifest, restart=False):
        yield run


def carry_out(run, function, jobs, *, divide=None, told=None):
    """Carry out a step with threads."""
    with ThreadPoolExecutor(2) as threads:
        phase = Phase("Triangulating", threads, 2, None if told is None else told.append)
        return phase.run(run, "tiles", function, jobs, divide=divide)


def recording(run, done, state="done"):
    """Return a function that does a task and writes its record."""

    def work(job):
        done.append(job.key)
        record = Record(job.key, state, points=job.count)
        run.add("tiles", record)
        return record

    return work


def test_what_is_done_is_not_done_again(run):
    jobs = [Job(str(k), 10) for k in range(12)]
    first, second, told = [], [], []
    carry_out(run, recording(run, first), jobs[:5])
    found = carry_out(run, recording(run, second), jobs, told=told)
    assert sorted(first) == sorted(str(k) for k in range(5))
    assert sorted(second, key=int) == [str(k) for k in range(5, 12)]
    assert list(found) == [str(k) for k in range(12)]
    assert [one.done for one in told] == list(range(5, 13))
    assert told[-1].points == 120
    assert told[0].seconds_left is None
    assert told[-1].seconds_left == 0.0


def test_failed_tasks_are_named_and_tried_again(run):
    def fail(job):
        record = Record(job.key, "failed", f"Tile {job.key} is bad.")
        run.add("tiles", record)
        return record

    jobs = [Job(str(k), 1) for k in range(6)]
    carry_out(run, recording(run, []), jobs[:2])
    with pytest.raises(ts.ReadError, match=r"4 tasks of 6 failed and 1 more\. Tile \d is bad\."):
        carry_out(run, fail, jobs)
    again = []
    carry_out(run, recording(run, again), jobs)
    assert sorted(again) == ["2", "3", "4", "5"]


def test_tasks_with_too_little_memory_are_divided(run):
    seen = []

    def work(job):
        seen.append(job.key)
        if job.count > 2:
            return Record(job.key, "no memory", f"Tile {job.key} needs more.")
        return recording(run, [])(job)

    found = carry_out(run, work, [Job("0", 8), Job("1", 1)], divide=halve)
    assert sum(one.points for one in found.values()) == 9
    assert sorted(found) == ["0.0.0", "0.0.1", "0.1.0", "0.1.1", "1"]
    seen.clear()
    assert carry_out(run, work, [Job("0", 8), Job("1", 1)], divide=halve) == found
    assert seen == []
    with pytest.raises(ts.ReadError, match=r"Tile 2 needs more\."):
        carry_out(run, work, [Job("2", 5)], divide=lambda _: [])
