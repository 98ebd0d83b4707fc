"""Children that read: started when first needed, used again after sound files, ended with limits.

A child that crashed, or took too long or too much memory, is not used again. Each is asked by one
thread at a time; a second thread gets a child of its own.
"""

from __future__ import annotations

import atexit
import contextlib
import os
import re
import signal
import subprocess
import sys
import threading
from collections.abc import Generator, Iterator, Mapping
from pathlib import Path
from typing import Any

from ...base.errors import ReadError
from ...base.notes import naming_file
from ...base.sentences import FILE
from .answers import Answer, BrokenMessageError, receive, send
from .limits import START_SECONDS, Limits, choose_limits

_START = (
    "import json, sys; sys.path[:] = json.loads(sys.argv[1]);"
    "from tinsmith.io.isolated.child import serve_requests; serve_requests(sys.argv[2])"
)
_SOUND_ENDS = frozenset({"end", "refusal", "fault"})
"""Answers after which a child may read a further file."""

_ODD_LETTERS = re.compile(r"[\x00-\x1f\x7f-\x9f]+")
_LONGEST_REASON = 200


def run_isolated(
    function: str, arguments: Mapping[str, Any], *, path: Path, limits: Limits | None = None
) -> Answer:
    """Let a child read a file, and return its only part.

    Parameters
    ----------
    function : str
        ``"module:function"`` of this package. It takes the arguments and returns an
        :class:`Answer`, or is a generator of them; a :class:`Refusal` that it raises becomes a
        ReadError of the same sentence.
    arguments : mapping
        What JSON can hold.
    path : Path
        The file, for sentences and for the limits.
    limits : Limits, optional
        Default those of the file's size.

    Raises
    ------
    ReadError
        If the file is refused, damaged, takes longer or more memory than it may, or makes the
        library crash.
    """
    with stream_isolated(function, arguments, path=path, limits=limits) as parts:
        return next(parts)


@contextlib.contextmanager
def stream_isolated(
    function: str, arguments: Mapping[str, Any], *, path: Path, limits: Limits | None = None
) -> Iterator[Iterator[Answer]]:
    """Let a child read a file, and yield the parts of its answer as they come.

    Parameters and errors are those of :func:`run_isolated`; the limit of time is for each part.
    """
    allowed = limits or choose_limits(path.stat().st_size if path.is_file() else 0)
    worker = _POOL.take(function.partition(":")[0])
    parts = worker.ask({"function": function, "arguments": dict(arguments)}, allowed)
    try:
        with naming_file(path):
            yield parts
        for _ in parts:
            pass  # the end is read too, so that the child is free for the next file
    finally:
        parts.close()
        _POOL.give_back(worker)


def start_early(module: str) -> None:
    """Start the child that will read with a module, while the caller prepares its request."""
    _POOL.give_back(_POOL.take(module))


class _Worker:
    """A child process that reads with one module."""

    def __init__(self, module: str) -> None:
        self.module = module
        self.is_sound = True
        self._timed_out = False
        from importlib import import_module

        wanted: dict[str, str] = getattr(import_module(module), "ENVIRONMENT", {})
        self._process = subprocess.Popen(
            [_find_interpreter(), "-P", "-c", _START, _search_path(), module],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            bufsize=0,
            env={**os.environ, **wanted},
            start_new_session=True,  # Ctrl-C is for the program, which then ends the child
        )

    def ask(self, request: dict[str, Any], limits: Limits) -> Generator[Answer, None, None]:
        """Yield the parts of the answer; anything but a sound end leaves the child unsound."""
        self.is_sound = False
        with contextlib.suppress(BrokenPipeError):
            assert self._process.stdin is not None
            send(self._process.stdin, Answer({**request, "limits": list(limits)}, {}))
        seconds = START_SECONDS
        while True:
            answer = self._receive_next(seconds, limits)
            kind = answer.value.get("kind")
            if kind in _SOUND_ENDS:
                self.is_sound = True
            if kind == "end":
                return
            if kind == "part":
                yield Answer(answer.value["value"], answer.arrays)
            elif kind != "ready":
                raise _describe_answer(answer.value, limits)
            seconds = limits.waiting_seconds

    def _receive_next(self, seconds: float, limits: Limits) -> Answer:
        watchdog = threading.Timer(seconds, self._time_out)
        watchdog.daemon = True
        watchdog.start()
        try:
            assert self._process.stdout is not None
            return receive(self._process.stdout, most_bytes=limits.memory)
        except BrokenMessageError:
            self.end()
            raise _describe_death(self._process.returncode, self._timed_out, limits) from None
        finally:
            watchdog.cancel()

    def _time_out(self) -> None:
        self._timed_out = True
        self.kill()

    def kill(self) -> None:
        """End the child at once."""
        self._process.kill()

    def end(self) -> None:
        """End the child and close its pipes."""
        for stream in (self._process.stdin, self._process.stdout):
            if stream is not None:
                with contextlib.suppress(OSError):
                    stream.close()
        with contextlib.suppress(subprocess.TimeoutExpired):
            self._process.wait(0.2)  # how it ended tells why
        if self._process.returncode is None:
            self._process.kill()
            self._process.wait()

    def forget(self) -> None:
        """Let go of a child that belongs to the process from which this one was forked."""
        for stream in (self._process.stdin, self._process.stdout):
            if stream is not None:
                stream.close()
        self._process.returncode = 0


class _Pool:
    """Idle children by the module that they read with, at most one each."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._idle: dict[str, _Worker] = {}

    def take(self, module: str) -> _Worker:
        """Return an idle child, else a new one."""
        with self._lock:
            worker = self._idle.pop(module, None)
        return _Worker(module) if worker is None else worker

    def give_back(self, worker: _Worker) -> None:
        """Keep a sound child for the next file; end any other."""
        if worker.is_sound:
            with self._lock:
                spare = self._idle.setdefault(worker.module, worker) is not worker
            if not spare:
                return
        worker.end()

    def end(self) -> None:
        """End all idle children."""
        with self._lock:
            workers, self._idle = list(self._idle.values()), {}
        for worker in workers:
            worker.kill()  # an idle child has nothing to finish
            worker.end()

    def forget(self) -> None:
        """Begin anew in a forked process: pipes must not be shared."""
        workers, self._idle, self._lock = list(self._idle.values()), {}, threading.Lock()
        for worker in workers:
            worker.forget()


_POOL = _Pool()
atexit.register(_POOL.end)
if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_POOL.forget)


# ---------------------------------------------------------------------- starting a child


def _find_interpreter() -> str:
    """Return the path of Python; a program that embeds it is not one."""
    places = [Path(sys.executable or "."), Path(sys.exec_prefix, "bin", "python3")]
    places += [Path(sys.exec_prefix, "python.exe"), Path(sys.exec_prefix, "Scripts", "python.exe")]
    for place in places:
        if place.stem.lower().startswith(("python", "pypy")) and place.is_file():
            return str(place)
    raise ReadError("There is no Python interpreter to read the file with, beside this program.")


def _search_path() -> str:
    """Return where modules are, the current folder apart: it may hold anyone's files."""
    import json

    return json.dumps([str(Path(place).absolute()) for place in sys.path if place])


# ---------------------------------------------------------------------------- sentences


def _describe_answer(answer: dict[str, Any], limits: Limits) -> ReadError:
    if answer.get("kind") == "refusal":
        return ReadError(_ODD_LETTERS.sub(" ", str(answer.get("text"))))
    if answer.get("kind") == "memory":
        return _describe_lack_of_memory(limits)
    words = " ".join(_ODD_LETTERS.sub(" ", str(answer.get("text"))).split())
    reason = words[:_LONGEST_REASON].rstrip(" .")
    return ReadError(f"{FILE} cannot be read, it may be damaged or truncated: {reason}.")


def _describe_death(code: int | None, timed_out: bool, limits: Limits) -> ReadError:
    too_long = timed_out or code == -getattr(signal, "SIGXCPU", 0)
    if too_long:
        return ReadError(
            f"{FILE} cannot be read, it may be damaged: after {limits.seconds:.0f} "
            f"{'second' if round(limits.seconds) == 1 else 'seconds'}, the limit for a file of "
            "this size, there was no end."
        )
    if code == -getattr(signal, "SIGKILL", 0):
        return _describe_lack_of_memory(limits)
    return ReadError(
        f"{FILE} cannot be read, it is damaged: the library that reads this format crashed."
    )


def _describe_lack_of_memory(limits: Limits) -> ReadError:
    return ReadError(
        f"{FILE} cannot be read, it may be damaged: it asks for more than "
        f"{limits.memory / (1 << 30):.1f} GiB of memory, the limit for a file of this size."
    )
