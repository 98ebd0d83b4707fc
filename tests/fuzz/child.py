"""A process that examines cases: it may die, hang or be killed, and the run goes on."""

from __future__ import annotations

import multiprocessing
import os
import resource
import signal
import sys
import time
import traceback
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any, NamedTuple

from .campaign import Campaign, Case, as_written, make_case

FORK = multiprocessing.get_context("fork")


class Outcome(NamedTuple):
    """What became of a case; `kind` is None for one that is as it should be."""

    kind: str | None  # "error", "crash" or "hang"
    label: str = "sound"
    where: str = ""  # tells one defect from another
    text: str = ""


class Child:
    """A forked process with limits of its own, started anew after each death."""

    def __init__(self, campaign: Campaign, seed: int, *, has_limits: bool = True) -> None:
        self.campaign, self.seed, self.has_limits = campaign, seed, has_limits
        self.number = -1
        self.deadline = 0.0
        self._start()

    def _start(self) -> None:
        self.connection, far = FORK.Pipe()
        arguments = (far, self.connection, self.campaign, self.seed, self.has_limits)
        self.process = FORK.Process(target=serve, args=arguments)
        self.process.start()
        far.close()

    def send(self, verb: str, what: int | Case) -> None:
        """Ask for one thing; the answer is waited for until the deadline."""
        self.deadline = time.monotonic() + self.campaign.seconds
        self.connection.send((verb, what))

    def receive(self) -> Any:
        """Return the answer, or the outcome of a process that gave none."""
        try:
            if self.connection.poll(max(0.0, self.deadline - time.monotonic())):
                return self.connection.recv()
        except (EOFError, ConnectionResetError):
            self.process.join()
            return self._died(self.process.exitcode or 0)
        seconds = self.campaign.seconds
        self._restart()
        return Outcome("hang", where="hang", text=f"no answer within {seconds:g} seconds")

    def _died(self, code: int) -> Outcome:
        name = signal.Signals(-code).name if code < 0 else f"exit {code}"
        self._restart()
        return Outcome("crash", where=name, text=f"the process died: {name}")

    def _restart(self) -> None:
        self.stop()
        self._start()

    def ask(self, verb: str, what: int | Case) -> Any:
        """Send, then receive."""
        self.send(verb, what)
        return self.receive()

    def stop(self) -> None:
        """End the process and all that it started."""
        self.connection.close()
        try:
            os.killpg(self.process.pid or 0, signal.SIGKILL)
        except (ProcessLookupError, PermissionError):
            self.process.kill()
        self.process.join()


def serve(
    near: Connection, far: Connection, campaign: Campaign, seed: int, has_limits: bool
) -> None:
    """Answer requests until the run ends."""
    os.setsid()
    far.close()
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
    if has_limits:
        limit_memory(campaign.megabytes)
    parent = os.getppid()
    while True:
        while not near.poll(5.0):
            if os.getppid() != parent:  # the run was killed
                os._exit(0)
        try:
            verb, what = near.recv()
        except EOFError:  # the run ended
            os._exit(0)
        if verb == "make":
            near.send(make_case(campaign, seed, what))
        elif verb == "number":
            near.send(judge(campaign, seed, what))
        else:
            near.send(judge(campaign, seed, None, what))


def limit_memory(megabytes: int) -> None:
    """Allow so much address space beyond what is taken already."""
    statm = Path("/proc/self/statm")
    if not statm.exists():  # not Linux: no limit
        return
    taken = int(statm.read_text().split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (taken + (megabytes << 20),) * 2)


def judge(campaign: Campaign, seed: int, number: int | None, case: Case | None = None) -> Outcome:
    """Make a case, unless it is given, examine it, and tell what became of it."""
    try:
        made = make_case(campaign, seed, number or 0) if case is None else as_written(case)
        return Outcome(None, label=campaign.examine(made) or "sound")
    except BaseException as error:  # what a case raises is the find
        frame = traceback.extract_tb(sys.exc_info()[2])[-1]
        where = f"{type(error).__name__} at {Path(frame.filename).name}:{frame.lineno}"
        return Outcome("error", where=where, text=traceback.format_exc())
