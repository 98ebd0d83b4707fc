"""Children that are forks of this process: they start at once, as what is loaded need not be again.

A fork is safe where no other thread holds a lock that the child needs. A library cannot know that
of the program which uses it; a command of tinsmith knows it of itself, and permits forks.
"""

from __future__ import annotations

import contextlib
import gc
import os
import signal
import subprocess
import sys
import threading
import time
import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

__all__ = ["Fork", "can_fork", "permit_forks"]

_NATIVE = frozenset(
    {"rasterio", "pyogrio", "osgeo", "fiona", "pyvista", "vtkmodules", "meshio", "netCDF4",
     "lazrs", "pyarrow"}
)  # fmt: skip
"""Libraries that must be loaded by the child itself: they have read their variables, and may have
threads."""

_LARGEST_PARENT = 1 << 30
"""Bytes in use above which a new process starts sooner than the pages of this one are copied."""

_WAIT_SECONDS = 0.002

_permitted = False


def permit_forks() -> None:
    """Let children be forks of this process: it has no thread that works while they start."""
    global _permitted
    _permitted = True


def can_fork() -> bool:
    """Whether a child may be a fork now."""
    return (
        _permitted
        and sys.platform == "linux"
        and threading.current_thread() is threading.main_thread()
        and not _NATIVE & sys.modules.keys()
        and _measure_memory() < _LARGEST_PARENT
    )


def _measure_memory() -> int:
    pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE")


class Fork:
    """A forked child with pipes; what of ``subprocess.Popen`` its callers need.

    Parameters
    ----------
    run : callable
        What the child does, with the pipes as standard input and output. It never returns here.
    environment : mapping
        Variables to set in the child.
    """

    def __init__(self, run: Callable[[], None], environment: Mapping[str, str]) -> None:
        requests, to_child = os.pipe()
        from_child, answers = os.pipe()
        self.returncode: int | None = None
        every = signal.valid_signals()
        before = signal.pthread_sigmask(signal.SIG_BLOCK, every)  # no handler of ours in the child
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", DeprecationWarning)  # threads of numpy's BLAS
                self.pid = os.fork()
            if self.pid == 0:
                _become_child(run, environment, requests, answers)
        finally:
            signal.pthread_sigmask(signal.SIG_SETMASK, before)
        os.close(requests)
        os.close(answers)
        self.stdin: Any = os.fdopen(to_child, "wb", buffering=0)
        self.stdout: Any = os.fdopen(from_child, "rb", buffering=0)

    def kill(self) -> None:
        """End the child."""
        if self.returncode is None:
            with contextlib.suppress(ProcessLookupError):
                os.kill(self.pid, signal.SIGKILL)

    def wait(self, timeout: float | None = None) -> int:
        """Return how the child ended, as ``Popen.wait``."""
        end = None if timeout is None else time.monotonic() + timeout
        while self.returncode is None:
            pid, status = os.waitpid(self.pid, 0 if end is None else os.WNOHANG)
            if pid:
                self.returncode = os.waitstatus_to_exitcode(status)
            elif end is not None and time.monotonic() > end:
                raise subprocess.TimeoutExpired("fork", timeout or 0.0)
            else:
                time.sleep(_WAIT_SECONDS)
        return self.returncode


def _become_child(
    run: Callable[[], None], environment: Mapping[str, str], requests: int, answers: int
) -> NoReturn:
    """Let go of all that is the parent's, and run; its objects are kept and never finished."""
    code = 1
    try:
        gc.freeze()  # else a collected file would close a number that is another file's by now
        os.setsid()
        for number in signal.valid_signals() - {signal.SIGKILL, signal.SIGSTOP}:
            with contextlib.suppress(OSError, ValueError):
                signal.signal(number, signal.SIG_DFL)
        signal.signal(signal.SIGPIPE, signal.SIG_IGN)
        signal.pthread_sigmask(signal.SIG_SETMASK, ())
        os.dup2(requests, 0)
        os.dup2(answers, 1)
        os.closerange(3, os.sysconf("SC_OPEN_MAX"))
        os.environ.update(environment)
        sys.path[:] = [place for place in sys.path if place]
        run()
        code = 0
    finally:
        os._exit(code)
