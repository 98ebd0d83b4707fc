"""The child process: reads one file after the other, within limits, and answers through a pipe.

Nothing that a library prints can get into the answers: the pipe is moved away from the numbers of
standard output and standard error before any library is loaded.
"""

from __future__ import annotations

import contextlib
import faulthandler
import math
import os
from collections.abc import Iterator
from importlib import import_module
from typing import IO, Any

from .answers import Answer, BrokenMessageError, Refusal, receive, send
from .limits import Limits

_LONGEST_REQUEST = 1 << 24
_MARGIN_SECONDS = 5.0


def serve_requests(module: str) -> None:
    """Answer requests to a module until there are no more.

    Its library is loaded while the program prepares its first request, which is told of a fault.
    """
    requests = os.fdopen(os.dup(0), "rb", buffering=0)
    answers = os.fdopen(os.dup(1), "wb", buffering=0)
    with open(os.devnull, "r+b", buffering=0) as nothing:  # noqa: PTH123 - a device
        for number in (0, 1, 2):
            os.dup2(nothing.fileno(), number)
    with contextlib.suppress(ImportError, ValueError, OSError):
        import resource

        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    with contextlib.suppress(Exception):
        getattr(import_module(module), "prepare", int)()
    with contextlib.suppress(BrokenMessageError, BrokenPipeError, KeyboardInterrupt):
        while True:
            _serve(receive(requests, most_bytes=_LONGEST_REQUEST).value, _Buffered(answers))


class _Buffered:
    """A pipe that takes every byte: a raw one may take only some."""

    def __init__(self, stream: IO[bytes]) -> None:
        self._stream = stream

    def write(self, content: bytes | memoryview) -> None:
        rest = memoryview(content)
        while len(rest):
            rest = rest[self._stream.write(rest) :]

    def flush(self) -> None:
        """Nothing is kept back."""


def _serve(request: dict[str, Any], answers: Any) -> None:
    """Load what is needed, say so, then read."""
    try:
        module, _, name = request["function"].partition(":")
        function = getattr(import_module(module), name)
        prepare = getattr(import_module(module), "prepare", None)
        if prepare is not None:
            prepare()
    except Exception as error:
        send(answers, Answer({"kind": "fault", "text": _describe_error(error)}, {}))
        return
    send(answers, Answer({"kind": "ready"}, {}))
    _answer_request(function, request, answers)


def _answer_request(function: Any, request: dict[str, Any], answers: Any) -> None:
    limits = Limits(*request["limits"])
    try:
        _limit_memory(limits.memory)
        for part in _iterate_parts(function, request["arguments"], limits):
            send(answers, Answer({"kind": "part", "value": part.value}, part.arrays))
        last = {"kind": "end"}
    except Refusal as refusal:
        last = {"kind": "refusal", "text": str(refusal)}
    except MemoryError:
        last = {"kind": "memory"}
    except BrokenPipeError:
        raise
    except Exception as error:
        last = {"kind": "fault", "text": _describe_error(error)}
    faulthandler.cancel_dump_traceback_later()
    send(answers, Answer(last, {}))


def _iterate_parts(function: Any, arguments: dict[str, Any], limits: Limits) -> Iterator[Answer]:
    """Yield the parts of the answer, each within the limit of time."""
    _limit_time(limits)
    found = function(**arguments)
    for part in [found] if isinstance(found, Answer) else found:
        faulthandler.cancel_dump_traceback_later()  # the program takes the part when it likes
        yield part
        _limit_time(limits)


def _limit_time(limits: Limits) -> None:
    """End this process when a part takes too long, also when the program is gone by then."""
    faulthandler.dump_traceback_later(limits.waiting_seconds + _MARGIN_SECONDS, exit=True, file=2)
    with contextlib.suppress(ImportError, ValueError, OSError):
        import resource

        used = sum(resource.getrusage(resource.RUSAGE_SELF)[:2])
        _, most = resource.getrlimit(resource.RLIMIT_CPU)
        resource.setrlimit(resource.RLIMIT_CPU, (math.ceil(used + limits.seconds), most))


def _limit_memory(n_bytes: int) -> None:
    """Limit the memory beyond that in use, where the system lets a process do so (Linux)."""
    with contextlib.suppress(ImportError, ValueError, OSError):
        import resource

        with open("/proc/self/statm", encoding="ascii") as file:  # noqa: PTH123 - no file of data
            pages = int(file.read().split()[0])
        _, most = resource.getrlimit(resource.RLIMIT_AS)
        wanted = pages * resource.getpagesize() + n_bytes
        if most != resource.RLIM_INFINITY:
            wanted = min(wanted, most)
        resource.setrlimit(resource.RLIMIT_AS, (wanted, most))


def _describe_error(error: Exception) -> str:
    return str(error) or type(error).__name__
