"""Standard streams, whatever the shell did to them; signals as exceptions that clean up."""

from __future__ import annotations

import os
import signal
import sys
import threading
import time
from _thread import start_new_thread
from contextlib import contextmanager
from io import TextIOWrapper
from typing import IO, TYPE_CHECKING, Any

import click

if TYPE_CHECKING:
    from collections.abc import Iterator

_SIGNALS = ("SIGTERM", "SIGHUP")
_RESENDING_DELAY = 0.05
"""Seconds until a signal is sent again whose exception Python dropped."""


class Terminated(BaseException):
    """A signal that ends the program; unwinding removes temporary files.

    Attributes
    ----------
    number : int
        Of the signal; the exit code is 128 more, as shells count.
    """

    def __init__(self, number: int) -> None:
        super().__init__(number)
        self.number = number


@contextmanager
def raise_for_signals() -> Iterator[None]:
    """Raise :class:`Terminated` for a signal that would end the program at once.

    One that is ignored, as under ``nohup``, stays ignored. Python drops an exception that is raised
    inside a finalizer or a weak reference's callback; a signal that was dropped so is sent again.
    """
    before = {}
    hook = sys.unraisablehook
    if threading.current_thread() is threading.main_thread():
        for number in (getattr(signal, name) for name in _SIGNALS if hasattr(signal, name)):
            if signal.getsignal(number) is signal.SIG_DFL:
                before[number] = signal.signal(number, _terminate)
        sys.unraisablehook = _send_again
    try:
        yield
    finally:
        sys.unraisablehook = hook
        for number, handler in before.items():
            signal.signal(number, handler)


def _terminate(number: int, _: object) -> None:
    raise Terminated(number)


def _send_again(dropped: sys.UnraisableHookArgs) -> None:
    """Send a signal anew whose exception was dropped; tell of any other exception as usual."""
    error = dropped.exc_value
    if isinstance(error, Terminated):
        number = error.number
    elif isinstance(error, KeyboardInterrupt):
        number = signal.SIGINT
    else:
        sys.__unraisablehook__(dropped)
        return
    # From another thread and later, or it would be raised and dropped in here again; a Thread's
    # start() would wait in here for the thread.
    start_new_thread(_send_later, (number,))


def _send_later(number: int) -> None:
    time.sleep(_RESENDING_DELAY)
    os.kill(os.getpid(), number)


def reserve_standard_streams() -> None:
    """Give closed standard streams their numbers back, or the next file opened gets them.

    What libraries print would then be written into that file.
    """
    for number, flags in ((0, os.O_RDONLY), (1, os.O_WRONLY), (2, os.O_WRONLY)):
        try:
            os.fstat(number)
        except OSError:
            descriptor = os.open(os.devnull, flags)
            if descriptor != number:
                os.dup2(descriptor, number)
                os.close(descriptor)


def accept_any_text() -> None:
    """Let stdout and stderr escape letters that the terminal's encoding does not have."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")


def write_error(text: str) -> None:
    """Write a line to stderr; what cannot be written there cannot be told anywhere."""
    try:
        click.echo(text, err=True)
    except OSError:
        silence(sys.stderr)


def silence(stream: IO[Any] | None) -> None:
    """Send what is still buffered nowhere, or Python fails once more when it exits."""
    if stream is None:
        return
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, stream.fileno())
    os.close(nowhere)


def escape_unprintable(text: str) -> str:
    r"""Escape what would break a line or command the terminal, such as ``\n`` in a file's name."""
    if text.isprintable():
        return text
    return "".join(
        letter if letter.isprintable() or "\ud800" <= letter <= "\udfff" else _escape(letter)
        for letter in text
    )


def _escape(letter: str) -> str:
    return letter.encode("unicode_escape").decode("ascii")
