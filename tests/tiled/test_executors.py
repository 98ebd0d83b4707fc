"""Tasks in processes: all are done, whatever becomes of a process."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from tinsmith.tiled.running.executors import Processes, run_tasks


def double(job):
    """Return twice a number."""
    return 2 * job


def die_once(job):
    """Kill the process the first time that a job is seen."""
    number, folder = job
    mark = Path(folder, f"{number}")
    if number % 5 == 0 and not mark.exists():
        mark.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return number


def die(job):
    """Kill the process of one job, always."""
    if job == 3:
        os.kill(os.getpid(), signal.SIGKILL)
    return job


def fail(job):
    """Raise an error."""
    raise ZeroDivisionError(str(job))


def run(executor, function, jobs, workers=2):
    """Run tasks, and return what was taken and what was given up."""
    taken, given_up = {}, {}
    try:
        run_tasks(
            executor,
            function,
            jobs,
            workers=workers,
            take=lambda job, result: taken.__setitem__(job, result),
            give_up=lambda job, sentence: given_up.__setitem__(job, sentence),
        )
    finally:
        if isinstance(executor, Processes):
            executor.close()
    return taken, given_up


def test_processes_and_threads_do_every_job():
    wanted = {job: 2 * job for job in range(30)}
    assert run(Processes(2), double, range(30)) == (wanted, {})
    with ThreadPoolExecutor(3) as threads:
        assert run(threads, double, range(30)) == (wanted, {})
        assert run(threads, double, []) == ({}, {})


@pytest.mark.slow
def test_killed_processes_lose_nothing(tmp_path):
    jobs = [(number, str(tmp_path)) for number in range(12)]
    taken, given_up = run(Processes(2), die_once, jobs)
    assert taken == {job: job[0] for job in jobs}
    assert given_up == {}


@pytest.mark.slow
def test_a_job_that_ends_its_process_each_time_is_given_up():
    taken, given_up = run(Processes(2), die, range(8))
    assert taken == {job: job for job in range(8) if job != 3}
    assert list(given_up) == [3]
    assert "its process was ended" in given_up[3]


def test_an_error_ends_the_run():
    processes = Processes(1)
    with pytest.raises(ZeroDivisionError):
        run(processes, fail, range(3))


def test_a_script_without_a_guard_is_not_run_again(tmp_path):
    script = tmp_path / "script.py"
    script.write_text(
        "from tinsmith.tiled.running.executors import Processes, run_tasks\n"
        "print('once')\n"
        "processes = Processes(2)\n"
        "run_tasks(processes, abs, [-1, -2], workers=2, take=print, give_up=print)\n"
        "processes.close()\n"
    )
    found = subprocess.run([sys.executable, script], capture_output=True, text=True, check=True)
    assert sorted(found.stdout.split()) == ["-1", "-2", "1", "2", "once"]
    assert found.stderr == ""
