"""Standard streams and signals, one by one, and how a summary is laid out."""

from __future__ import annotations

import contextlib
import io
import json
import os
import shlex
import signal
import subprocess
import sys
from types import SimpleNamespace

import numpy as np
import pytest

from tinsmith.cli.output import console, progress, streams
from tinsmith.cli.output.console import Console, format_json
from tinsmith.cli.output.facts import Facts
from tinsmith.cli.output.failures import Failure

# --------------------------------------------------------------------------- letters


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("plain äöü", "plain äöü"),
        ("a\nb\tc", r"a\nb\tc"),
        ("\x1b[31mred", r"\x1b[31mred"),
        ("\u202ereversed", r"\u202ereversed"),
        ("half \ud800 \udfff", "half \ud800 \udfff"),  # a byte of a name that is no UTF-8
        ("\ud7ff\ue000", r"\ud7ff\ue000"),
        ("", ""),
    ],
)
def test_letters_that_would_command_the_terminal_are_escaped(text, shown):
    assert streams.escape_unprintable(text) == shown


def test_a_summary_has_labels_of_one_width_and_lines_below_each_other(capsys):
    fields = [("Points", "7"), ("", "one\ntwo"), ("A long label", "x\x07")]
    Console().summarise(fields)
    assert capsys.readouterr().err == (
        "Points      7\n            one\n            two\nA long label x\\x07\n"
    )
    Console(quiet=True).summarise(fields)
    assert capsys.readouterr() == ("", "")
    facts = Facts("a.csv", a=1)
    facts.add("Points", "7")
    Console(quiet=True).answer(facts)
    assert capsys.readouterr().out == "Points      7\n"
    Console(as_json=True).answer(facts)
    assert json.loads(capsys.readouterr().out) == {"input": "a.csv", "a": 1, "notes": []}


def test_facts_are_strict_json():
    facts = {
        "infinite": [float("inf"), -np.inf, np.float64("nan")],
        "numbers": (np.int32(5), np.float32(0.5), True, None, 2.5),
        "inner": {"text": "ä", "none": []},
    }
    assert json.loads(format_json(facts)) == {
        "infinite": [None] * 3,
        "numbers": [5, 0.5, True, None, 2.5],
        "inner": {"text": "ä", "none": []},
    }
    assert format_json({"a": 1}) == '{\n  "a": 1\n}'


# --------------------------------------------------------------------------- streams


def test_a_silenced_stream_writes_nowhere(tmp_path):
    with (tmp_path / "a").open("w") as file:
        file.write("kept back")
        streams.silence(file)
        file.flush()
    assert (tmp_path / "a").read_text() == ""
    streams.silence(None)


def test_what_cannot_be_told_silences_stderr(monkeypatch):
    silenced = []

    def fail(*_, **__):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(streams.click, "echo", fail)
    monkeypatch.setattr(streams, "silence", silenced.append)
    streams.write_error("anything")
    assert silenced == [sys.stderr]


class Closing(io.StringIO):
    """A stream that fails when it is flushed."""

    def __init__(self, error):
        super().__init__()
        self.error = error

    def flush(self):
        raise self.error


@pytest.mark.parametrize(
    ("error", "raised", "is_silenced"),
    [(OSError(28, "Full"), Failure, True), (BrokenPipeError(), BrokenPipeError, False)],
)
def test_results_are_written_to_the_last_byte(monkeypatch, tmp_path, error, raised, is_silenced):
    silenced = []
    monkeypatch.setattr(console, "silence", silenced.append)
    out = Closing(error)
    out.buffer = SimpleNamespace(write=lambda _: 0, flush=out.flush)
    monkeypatch.setattr(sys, "stdout", out)
    with pytest.raises(raised):
        Console().emit("text")
    (tmp_path / "a").write_bytes(b"content")
    with pytest.raises(raised) as caught:
        console.emit_file(tmp_path / "a")
    if is_silenced:
        assert str(caught.value) == "Cannot write to standard output: Full."
    assert silenced == [out, out] * is_silenced
    monkeypatch.setattr(sys, "stdout", None)
    for write in (lambda: Console().emit("text"), lambda: console.emit_file(tmp_path / "a")):
        with pytest.raises(Failure, match=r"Cannot write to standard output: it is closed\."):
            write()


def test_a_file_goes_to_stdout_byte_by_byte(monkeypatch, tmp_path):
    content = bytes(range(256)) * 1000
    (tmp_path / "a").write_bytes(content)
    out = SimpleNamespace(buffer=io.BytesIO())
    monkeypatch.setattr(sys, "stdout", out)
    console.emit_file(tmp_path / "a")
    assert out.buffer.getvalue() == content


@pytest.mark.skipif(sys.platform != "linux", reason="/proc tells what a number is open for")
@pytest.mark.parametrize("closed", [(0,), (1,), (2,), (0, 2), (0, 1, 2)])
def test_closed_streams_get_their_numbers_back(tmp_path, closed):
    code = (
        "import json, os, sys\n"
        "from tinsmith.cli.output.streams import reserve_standard_streams\n"
        f"for number in {closed!r}: os.close(number)\n"
        "reserve_standard_streams()\n"
        "found = {n: os.readlink(f'/proc/self/fd/{n}') for n in range(3)}\n"
        "import fcntl\n"
        "modes = {n: fcntl.fcntl(n, fcntl.F_GETFL) & os.O_ACCMODE for n in range(3)}\n"
        "extra = os.open(os.devnull, os.O_RDONLY)\n"
        f"open({str(tmp_path / 'told')!r}, 'w').write(json.dumps([found, modes, extra]))\n"
    )
    subprocess.run([sys.executable, "-c", code], capture_output=True, check=True, timeout=600)
    found, modes, extra = json.loads((tmp_path / "told").read_text())
    for number in range(3):
        assert (found[str(number)] == "/dev/null") >= (number in closed)
    for number in closed:
        assert modes[str(number)] == (os.O_RDONLY if number == 0 else os.O_WRONLY)
    assert extra >= 3


# --------------------------------------------------------------------------- signals


@pytest.mark.parametrize("name", ["SIGTERM", "SIGHUP"])
def test_a_signal_that_ends_is_an_exception_meanwhile(name):
    number = getattr(signal, name)
    before = signal.getsignal(number)
    hook = sys.unraisablehook
    signal.signal(number, signal.SIG_DFL)

    def end_oneself():
        with streams.raise_for_signals():
            assert sys.unraisablehook is not hook
            os.kill(os.getpid(), number)
            signal.pause()

    try:
        with pytest.raises(streams.Terminated) as caught:
            end_oneself()
        assert caught.value.number == number
        assert signal.getsignal(number) is signal.SIG_DFL
        assert sys.unraisablehook is hook
        signal.signal(number, signal.SIG_IGN)
        with streams.raise_for_signals():
            assert signal.getsignal(number) is signal.SIG_IGN
            os.kill(os.getpid(), number)
    finally:
        signal.signal(number, before)


@pytest.mark.parametrize(
    ("error", "sent"),
    [(streams.Terminated(15), 15), (KeyboardInterrupt(), 2), (ValueError("x"), None)],
)
def test_a_signal_that_was_dropped_is_sent_again(monkeypatch, error, sent):
    later, told = [], []
    monkeypatch.setattr(streams, "start_new_thread", lambda f, given: later.append((f, given)))
    monkeypatch.setattr(sys, "__unraisablehook__", told.append)
    dropped = SimpleNamespace(exc_value=error)
    streams._send_again(dropped)
    if sent is None:
        assert (later, told) == ([], [dropped])
        return
    assert told == []
    ((function, given),) = later
    kills = []
    monkeypatch.setattr(streams.os, "kill", lambda *one: kills.append(one))
    monkeypatch.setattr(streams.time, "sleep", lambda seconds: kills.append(seconds))
    function(*given)
    assert kills == [0.05, (os.getpid(), sent)]


# -------------------------------------------------------------------------- progress


class Bar:
    """A bar of progress that draws nothing."""

    def __init__(self):
        self.calls = []

    def __getattr__(self, name):
        def note(*given, **named):
            self.calls.append((name, given, named))
            return "task" if name == "add_task" else None

        return note


def test_steps_show_once_they_take_long(monkeypatch):
    bar = Bar()
    monkeypatch.setattr(progress, "_is_terminal", lambda: True)
    monkeypatch.setattr(progress, "_make_progress_bar", lambda: bar)
    steps = progress.Steps()
    assert steps._timer.interval == 0.5
    assert steps._timer.daemon
    with steps:
        with steps.step("Growing") as tell:
            tell(0.25)
        assert bar.calls == [
            ("add_task", ("Growing",), {"total": None}),
            ("update", ("task",), {"total": 1.0, "completed": 0.25}),
            ("remove_task", ("task",), {}),
        ]
        steps._show()
    assert [name for name, *_ in bar.calls[3:]] == ["start", "stop"]
    short = progress.Steps()
    with short, contextlib.suppress(KeyError), short.step("Failing"):
        raise KeyError
    assert [name for name, *_ in bar.calls[5:]] == ["add_task", "remove_task"]


@pytest.mark.parametrize(("quiet", "is_terminal"), [(True, True), (False, False)])
def test_nothing_is_shown_to_who_does_not_look(monkeypatch, quiet, is_terminal):
    monkeypatch.setattr(progress, "_is_terminal", lambda: is_terminal)
    monkeypatch.setattr(progress, "_make_progress_bar", lambda: pytest.fail("a bar"))
    with progress.Steps(quiet=quiet) as steps:
        with steps.step("Growing") as tell:
            tell(0.5)
        steps._show()
    assert not steps._is_shown
    monkeypatch.undo()
    monkeypatch.setattr(sys, "stderr", None)
    assert not progress._is_terminal()


def test_the_bar_speaks_on_stderr_and_vanishes():
    bar = progress._make_progress_bar()
    assert bar.console.stderr
    assert bar.live.transient
    words = bar.columns[1]
    assert not words.markup


@pytest.mark.each_value
@pytest.mark.parametrize("arguments", [["formats"], ["formats", "--json"], ["completion", "bash"]])
@pytest.mark.parametrize(("to", "why"), [(">&-", "it is closed"), (">/dev/full", "No space left")])
def test_commands_that_only_print_tell_that_they_cannot(arguments, to, why):
    command = shlex.join([sys.executable, "-m", "tinsmith", *arguments])
    done = subprocess.run(
        ["sh", "-c", f"{command} {to}"], capture_output=True, text=True, check=False, timeout=120
    )
    assert done.returncode == 1
    assert done.stderr.startswith(f"Error: Cannot write to standard output: {why}")
