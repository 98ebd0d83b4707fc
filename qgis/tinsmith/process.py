"""Run a program; its progress, messages and errors go to the feedback of an algorithm."""

from __future__ import annotations

import json
import os
import queue
import shlex
import signal
import subprocess
import threading
from typing import Any

from qgis.core import QgsProcessingException

from .command import list_process_options, make_environment

CANCELLED = "Cancelled: what was not complete is not written."
_PERIOD = 0.1
"""Seconds between two looks at whether the user has cancelled."""
_GRACE = 10.0
"""Seconds that a program has to clean up before it is killed."""
_LABEL_WIDTH = 11


class Speaker:
    """Hands what the command says to the feedback.

    Parameters
    ----------
    feedback : QgsProcessingFeedback
    names : dict of str to str
        Names of layers, by the paths of the temporary files that stand for them.
    """

    def __init__(self, feedback: Any, names: dict[str, str]) -> None:
        self._feedback = feedback
        self._names = names
        self._step = ""
        self.error = ""
        self.rest: list[str] = []

    def hear(self, line: str) -> None:
        """Take one line of stderr: an event, or what a library prints."""
        event = _read_event(line)
        if event is None:
            if line.strip():
                self.rest.append(line.strip())
                self._feedback.pushConsoleInfo(line.rstrip())
            return
        text = self._rename(str(event.get("text", "")))
        getattr(self, f"_hear_{event['event']}")(text, event)

    def _rename(self, text: str) -> str:
        for path, name in self._names.items():
            text = text.replace(path, name)
        return text

    def _hear_step(self, text: str, event: dict[str, Any]) -> None:
        if text != self._step:
            self._feedback.setProgressText(text)
        self._step = text
        self._feedback.setProgress(100.0 * (event.get("fraction") or 0.0))

    def _hear_summary(self, text: str, event: dict[str, Any]) -> None:
        indent = "\n" + " " * (_LABEL_WIDTH + 1)
        label = str(event.get("label", ""))
        self._feedback.pushInfo(f"{label:<{_LABEL_WIDTH}} " + indent.join(text.split("\n")))

    def _hear_warning(self, text: str, _: dict[str, Any]) -> None:
        self._feedback.pushWarning(text)

    def _hear_error(self, text: str, _: dict[str, Any]) -> None:
        self.error = text


def _read_event(line: str) -> dict[str, Any] | None:
    if not line.startswith('{"event"'):
        return None
    try:
        event = json.loads(line)
    except ValueError:
        return None
    known = ("step", "summary", "warning", "error")
    return event if isinstance(event, dict) and event.get("event") in known else None


class Failed(Exception):
    """The program ended with an error; ``answer`` is what it wrote to stdout.

    QGIS takes its own class of exceptions for a sentence, one derived from it for a bug.
    """

    def __init__(self, sentence: str, answer: str) -> None:
        super().__init__(sentence)
        self.answer = answer


def run_program(arguments: list[str], speaker: Speaker, feedback: Any) -> str:
    """Run a program until it ends or the user cancels; return what it writes to stdout.

    It runs in the folder of QGIS, from which paths that the user has given lead.

    Parameters
    ----------
    arguments : list of str
        The program and its arguments.
    speaker : Speaker
        Hears what it writes to stderr.
    feedback : QgsProcessingFeedback
        Tells whether the user has cancelled.

    Raises
    ------
    Failed
        With the program's own sentence.
    QgsProcessingException
        If the user cancels; the process has then ended, or was not started.
    """
    feedback.pushCommandInfo(" ".join(map(shlex.quote, arguments)))
    if feedback.isCanceled():
        raise QgsProcessingException(CANCELLED)
    process = subprocess.Popen(
        arguments,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        env=make_environment(),
        **list_process_options(),
    )
    try:
        answer = _listen(process, speaker, feedback)
    except BaseException:
        _end(process)
        raise
    if process.returncode != 0:
        raise Failed(speaker.error or _guess_error(speaker.rest, process.returncode), answer)
    return answer


def _listen(process: subprocess.Popen[bytes], speaker: Speaker, feedback: Any) -> str:
    """Hear a process out; feedback is told in this thread alone."""
    lines: queue.Queue[str | None] = queue.Queue()
    answer: list[str] = []
    readers = [
        threading.Thread(target=_read_lines, args=(process.stderr, lines.put), daemon=True),
        threading.Thread(target=_read_lines, args=(process.stdout, answer.append), daemon=True),
    ]
    for reader in readers:
        reader.start()
    while process.poll() is None or readers[0].is_alive() or not lines.empty():
        if feedback.isCanceled():
            raise QgsProcessingException(CANCELLED)
        try:
            speaker.hear(lines.get(timeout=_PERIOD) or "")
        except queue.Empty:
            continue
    for reader in readers:
        reader.join()
    return "".join(answer)


def _read_lines(stream: Any, take: Any) -> None:
    with stream:
        for line in stream:
            take(line.decode("utf-8", "replace"))


def _end(process: subprocess.Popen[bytes]) -> None:
    """Ask a process to end, which removes what it has half-written; kill it if it does not."""
    process.terminate()
    try:
        process.wait(_GRACE)
    except subprocess.TimeoutExpired:
        _kill(process)
        process.wait()


def _kill(process: subprocess.Popen[bytes]) -> None:
    """Kill a process, and its children where it leads a group of its own."""
    if os.name == "nt":
        process.kill()
    else:
        os.killpg(process.pid, signal.SIGKILL)


def _guess_error(lines: list[str], code: int) -> str:
    """Return the sentence of a program that fails without an event."""
    if code < 0:
        return f"The command was ended by signal {-code}."
    return lines[-1] if lines else f"The command failed with exit code {code} and said nothing."
