"""Tasks run by any executor: processes of this machine, a Dask cluster, or the caller's own.

Nothing else here knows of Dask. Its own futures are none of ``concurrent.futures``, those of
``Client.get_executor`` are; equal tasks would run once without ``pure=False``.
"""

from __future__ import annotations

import multiprocessing
import os
import signal
import sys
from collections import Counter, deque
from concurrent.futures import FIRST_COMPLETED, Executor, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from threading import Thread
from types import ModuleType
from typing import TYPE_CHECKING, Any, TypeVar

from ...base import optional
from ...base.errors import ReadError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

Job = TypeVar("Job")
_AHEAD = 4
"""Tasks that are handed over for each worker, so that none waits for work."""
_TRIES = 3
_SECONDS_TO_CONNECT = 20
_TRIES_ALONE = 2
"""Processes that a task may end while it runs alone, before it is given up."""


class Processes:
    """Processes of this machine, which are started anew when one of them is killed.

    Parameters
    ----------
    workers : int
    """

    def __init__(self, workers: int) -> None:
        self.workers = workers
        self._pool: ProcessPoolExecutor | None = None

    def start(self) -> ProcessPoolExecutor:
        """Return the pool, a new one where it is broken."""
        if self._pool is None:
            context = multiprocessing.get_context("spawn")
            self._pool = ProcessPoolExecutor(self.workers, context, _prepare_worker)
        return self._pool

    def stop(self) -> None:
        """End all processes, at once."""
        pool, self._pool = self._pool, None
        if pool is None:
            return
        for process in list((pool._processes or {}).values()):
            process.terminate()
        pool.shutdown(wait=True, cancel_futures=True)

    def close(self) -> None:
        """End the processes, which have nothing left to do."""
        if self._pool is not None:
            self._pool.shutdown(wait=True)
            self._pool = None


def _prepare_worker() -> None:
    """Leave Ctrl-C to the process that hands out tasks, and end when that one is killed."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    """End at once: a worker waits for tasks for ever where the process that has them is gone."""
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)


@contextmanager
def connect_to_dask(address: str) -> Iterator[Executor]:
    """Yield the executor of a Dask cluster at an address, such as ``tcp://10.0.0.5:8786``.

    Raises
    ------
    MissingExtraError
        If Dask is not installed.
    ReadError
        If no scheduler answers there.
    """
    distributed = optional.load("distributed", "Running on a Dask cluster")
    try:
        client = distributed.Client(address, timeout=_SECONDS_TO_CONNECT)
    except (OSError, ValueError) as error:
        raise ReadError(f"No scheduler of Dask answers at '{address}'.") from error
    with client:
        yield client.get_executor(pure=False, retries=_TRIES)


def run_tasks(
    executor: Executor | Processes,
    function: Callable[..., Any],
    jobs: Iterable[Job],
    *,
    workers: int,
    take: Callable[[Job, Any], None],
    give_up: Callable[[Job, str], None],
) -> None:
    """Run a function for each job, in any order.

    Parameters
    ----------
    executor : concurrent.futures.Executor or Processes
    function : callable
        Of a module, called with the job.
    jobs : iterable
        Plain values.
    workers : int
        How many tasks the executor runs at a time, about.
    take : callable
        Called here with the job and its result, as each ends.
    give_up : callable
        Called with a job whose process was ended each time, and a sentence.

    Notes
    -----
    When a process of this machine is killed, such as by the system for want of memory, the tasks
    that were under way run again, one at a time, so that the one at fault is known.
    """
    waiting, suspects = deque(jobs), deque[Job]()
    running: dict[Future[Any], Job] = {}
    ended: Counter[int] = Counter()
    try:
        while waiting or suspects or running:
            source, most = (suspects, 1) if suspects else (waiting, _AHEAD * workers)
            while source and len(running) < most:
                job = source.popleft()
                running[_submit(executor, function, job)] = job
            broken = _take_results(running, take)
            if broken and isinstance(executor, Processes):
                executor.stop()
            if len(broken) == 1:
                ended[id(broken[0])] += 1
            for job in broken:
                if ended[id(job)] == _TRIES_ALONE:
                    give_up(job, "its process was ended, for want of memory or by a signal")
                else:
                    suspects.append(job)
    except BaseException:
        for future in running:
            future.cancel()
        if isinstance(executor, Processes):
            executor.stop()
        raise


def _take_results(running: dict[Future[Any], Job], take: Callable[[Job, Any], None]) -> list[Job]:
    """Wait for a task, hand over what has ended; return the jobs of processes that are gone."""
    done, _ = wait(running, return_when=FIRST_COMPLETED)
    broken = []
    for future in done:
        job = running.pop(future)
        try:
            result = future.result()
        except BrokenProcessPool:
            broken.append(job)
        else:
            take(job, result)
    if broken:
        broken += running.values()
        running.clear()
    return broken


def _submit(executor: Executor | Processes, function: Callable[..., Any], job: Any) -> Future[Any]:
    if not isinstance(executor, Processes):
        return executor.submit(function, job)
    with _hiding_main():
        try:
            return executor.start().submit(function, job)
        except BrokenProcessPool:
            executor.stop()
            return executor.start().submit(function, job)


@contextmanager
def _hiding_main() -> Iterator[None]:
    """Let processes start without running the caller's script again, which need not expect it.

    They are handed functions of this package alone.
    """
    main = sys.modules["__main__"]
    sys.modules["__main__"] = ModuleType("__main__")
    try:
        yield
    finally:
        sys.modules["__main__"] = main
