"""The tasks of a step, run and accounted for."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, replace
from functools import partial
from time import monotonic
from typing import TYPE_CHECKING, Any, Protocol

from ...base.notes import collecting_warnings, join_alike, warn
from ...base.sentences import counted
from .executors import Processes, run_tasks
from .runs import FINAL, Record, UnfinishedError

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from concurrent.futures import Executor

    from .runs import Run

_SHOWN = 3


class Job(Protocol):
    """What a task is handed: plain values, and a name."""

    @property
    def key(self) -> str:
        """Name of the task."""


@dataclass(frozen=True)
class Status:
    """How far a step is.

    Attributes
    ----------
    step : str
        What is done, such as "Reading".
    done, total : int
        Tasks.
    points : int
        Of the tasks that are done.
    seconds : float
        Since the step began.
    seconds_left : float or None
        About; None while no task of this run has ended.
    """

    step: str
    done: int
    total: int
    points: int
    seconds: float
    seconds_left: float | None


@dataclass(frozen=True)
class Phase:
    """How the tasks of a step are run.

    Attributes
    ----------
    step : str
        For people: "Reading", "Triangulating".
    executor : concurrent.futures.Executor or Processes
    workers : int
    tell : callable, optional
        Called with a :class:`Status` as each task ends.
    """

    step: str
    executor: Executor | Processes
    workers: int
    tell: Callable[[Status], None] | None = None

    def run(
        self,
        run: Run,
        name: str,
        function: Callable[[Any], Record],
        jobs: Sequence[Job],
        *,
        divide: Callable[[Any], list[Any]] | None = None,
    ) -> dict[str, Record]:
        """Do every task that no record says is done, and return all records by their keys.

        Parameters
        ----------
        run : Run
        name : str
            Of the step, where records are kept.
        function : callable
            Does a task, and writes its record.
        jobs : sequence of Job
        divide : callable, optional
            Returns the parts of a job whose memory was not enough, none where it has none.

        Raises
        ------
        UnfinishedError
            If a task failed: how many, and the sentences of the first.

        Warns
        -----
        LossWarning
            Of what tasks lost, those of an earlier call included.
        """
        accounts = _Accounts(run, name, divide, self)
        waiting = accounts.find_open(jobs)
        accounts.report()
        while waiting:
            run_tasks(
                self.executor,
                partial(_collect, function),
                waiting,
                workers=self.workers,
                take=accounts.take,
                give_up=accounts.give_up,
            )
            waiting = accounts.take_parts()
        accounts.require_done()
        for sentence in join_alike(
            one for record in accounts.done.values() for one in record.warnings
        ):
            warn(sentence)
        return dict(sorted(accounts.done.items(), key=lambda item: _as_order(item[0])))


def _collect(function: Callable[[Any], Record], job: Any) -> Record:
    """Do a task, and return its record with its warnings, which are lost in other processes."""
    with collecting_warnings() as found:
        record = function(job)
    return replace(record, warnings=tuple(found))


class _Accounts:
    """What became of the tasks of a step."""

    def __init__(
        self, run: Run, name: str, divide: Callable[[Any], list[Any]] | None, phase: Phase
    ) -> None:
        self._run = run
        self._name = name
        self._divide = divide or (lambda _: [])
        self._phase = phase
        self._kept = run.read(name)
        self._parts: list[Any] = []
        self._started = monotonic()
        self._new = 0
        self._total = 0
        self._points = 0
        self.done: dict[str, Record] = {}

    def find_open(self, jobs: Sequence[Any]) -> list[Any]:
        """Return what no record says is done: jobs, or parts of those that were divided."""
        found = []
        waiting = deque(jobs)
        while waiting:
            job = waiting.popleft()
            record = self._kept.get(job.key)
            if record is None or record.state == "failed":
                found.append(job)
            elif record.state == "divided":
                waiting.extend(self._divide(job))
            else:
                self._keep(job, record)
        self._total = len(self.done) + len(found)
        return found

    def take(self, job: Any, record: Record) -> None:
        """Account for a task; one that had too little memory is divided."""
        if record.state == "no memory":
            parts = self._divide(job)
            state = "divided" if parts else "failed"
            record = Record(job.key, state, record.sentence, record.seconds)
            self._run.add(self._name, record)
            self._parts += parts
            if parts:
                self._total += len(parts) - 1
                return
        self._new += 1
        self._keep(job, record)
        self.report()

    def _keep(self, job: Any, record: Record) -> None:
        self.done[job.key] = record
        self._points += record.points

    def give_up(self, job: Any, sentence: str) -> None:
        """Account for a task whose process was ended each time."""
        self.take(job, Record(job.key, "no memory", f"Task {job.key}: {sentence}."))

    def take_parts(self) -> list[Any]:
        """Return the parts of jobs that were divided since."""
        parts, self._parts = self._parts, []
        return parts

    def report(self) -> None:
        """Tell how far the step is."""
        if self._phase.tell is None:
            return
        seconds, done = monotonic() - self._started, len(self.done)
        left = seconds / self._new * (self._total - done) if self._new else None
        self._phase.tell(Status(self._phase.step, done, self._total, self._points, seconds, left))

    def require_done(self) -> None:
        """Refuse to go on where tasks failed."""
        failed = [one for one in self.done.values() if one.state == "failed"]
        if not failed:
            return
        shown = " ".join(one.sentence for one in failed[:_SHOWN])
        more = f" and {len(failed) - _SHOWN} more" if len(failed) > _SHOWN else ""
        raise UnfinishedError(
            f"{self._phase.step}: {counted(len(failed), 'task')} of {len(self.done):,} "
            f"failed{more}. {shown} {_describe_cure(failed)}"
        )


def _describe_cure(failed: Sequence[Record]) -> str:
    """Tell what a further call can do for tasks that failed."""
    final = sum(bool(one.values.get(FINAL)) for one in failed)
    if not final:
        return "What is done is kept: the same call tries these again."
    which = "it" if final == len(failed) == 1 else "them" if final == len(failed) else "some"
    return (
        f"The same call refuses {which} again: change the points or the options, and begin anew "
        "(`restart`)."
    )


def _as_order(key: str) -> tuple[int, ...]:
    return tuple(map(int, key.split(".")))
