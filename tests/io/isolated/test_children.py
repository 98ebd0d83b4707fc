"""What children are given and how they end: limits, variables, signals, sentences, pipes."""

from __future__ import annotations

import io
import os
import signal
import socket
import sys
import threading
from pathlib import Path
from types import SimpleNamespace

import pytest

from tinsmith.io import ReadError, read
from tinsmith.io.isolated import Limits, run_isolated, spooling, stream_isolated, workers
from tinsmith.io.isolated.answers import Answer, BrokenMessageError, _reserve_array, receive, send
from tinsmith.io.isolated.child import _Buffered
from tinsmith.io.reading import read_stream

FILE = Path("some file")
SINCE = 0.5
"""Seconds of processor time that a child may use between its limit and its answer."""
on_linux = pytest.mark.skipif(sys.platform != "linux", reason="what /proc tells of a process")


# ------------------------------------------------------------------------- limits


@on_linux
def test_a_child_has_the_limits_of_its_file_beyond_what_is_in_use():
    limits = Limits(7.0, 1 << 29)
    found = run_isolated("support.isolated_functions:limits", {}, path=FILE, limits=limits).value
    assert 7.0 - SINCE <= found["seconds"] - found["used"] < 8.1
    assert found["core"] == [0, 0]
    assert 0 <= (1 << 29) - (found["memory"] - found["mapped"]) < 1 << 28  # what came since
    assert found["ends"] == ["/dev/null"] * 3


@on_linux
def test_each_part_of_an_answer_has_the_time_of_its_own():
    how = {"path": FILE, "limits": Limits(3.0, 1 << 29)}
    with stream_isolated("support.isolated_functions:limits_of_parts", {}, **how) as parts:
        for part in parts:
            assert 3.0 - SINCE <= part.value["seconds"] - part.value["used"] < 4.1


@pytest.mark.parametrize("most", [1, 3, 1000])
def test_a_pipe_that_takes_only_some_bytes_gets_all(most):
    taken = bytearray()

    class Pipe:
        def write(self, content):
            taken.extend(content[:most])
            return min(most, len(content))

    stream = _Buffered(Pipe())
    stream.write(b"a message of some length")
    stream.write(memoryview(b""))
    stream.write(b"!")
    stream.flush()
    assert bytes(taken) == b"a message of some length!"


@pytest.mark.parametrize(("axes", "is_taken"), [(8, True), (9, False)])
def test_arrays_have_at_most_eight_axes(axes, is_taken):
    if is_taken:
        assert _reserve_array("<f8", [1] * axes).ndim == axes
        return
    with pytest.raises(BrokenMessageError):
        _reserve_array("<f8", [1] * axes)


def test_an_axis_may_be_empty_and_a_message_exactly_as_long_as_allowed():
    stream = io.BytesIO()
    send(stream, Answer("x", {}))
    length = len(stream.getvalue()) - 8
    assert receive(io.BytesIO(stream.getvalue()), most_bytes=length).value == "x"
    with pytest.raises(BrokenMessageError):
        receive(io.BytesIO(stream.getvalue()), most_bytes=length - 1)


# ----------------------------------------------------------------------- sentences

LIMITS = Limits(12.0, 3 << 29)
TOO_LONG = (
    "'some file' cannot be read, it may be damaged: after {}, the limit for a file of this size, "
    "there was no end."
)
GREEDY = (
    "'some file' cannot be read, it may be damaged: it asks for more than 1.5 GiB of memory, the "
    "limit for a file of this size."
)
CRASHED = "'some file' cannot be read, it is damaged: the library that reads this format crashed."


@pytest.mark.parametrize(
    ("code", "timed_out", "sentence"),
    [
        (None, True, TOO_LONG.format("12 seconds")),
        (-signal.SIGKILL, True, TOO_LONG.format("12 seconds")),
        (-signal.SIGXCPU, False, TOO_LONG.format("12 seconds")),
        (-signal.SIGKILL, False, GREEDY),
        (-signal.SIGSEGV, False, CRASHED),
        (-signal.SIGABRT, False, CRASHED),
        (None, False, CRASHED),
        (0, False, CRASHED),
        (1, False, CRASHED),
        (-1, False, CRASHED),
    ],
)
def test_each_end_of_a_child_has_its_sentence(code, timed_out, sentence):
    error = workers._describe_death(code, timed_out, LIMITS)
    error.add_file(FILE)
    assert str(error) == sentence
    assert error.file == FILE


@pytest.mark.parametrize(
    ("seconds", "words"),
    [(1.0, "1 second"), (1.4, "1 second"), (1.6, "2 seconds"), (0.4, "0 seconds")],
)
def test_seconds_are_counted_in_words(seconds, words):
    error = workers._describe_death(None, True, Limits(seconds, 1))
    error.add_file(FILE)
    assert str(error) == TOO_LONG.format(words)


@pytest.mark.parametrize(
    ("answer", "sentence"),
    [
        (
            {"kind": "refusal", "text": "A whole\x07\x1b sentence."},
            "'some file': A whole  sentence.",
        ),
        ({"kind": "memory", "text": "no matter"}, GREEDY),
        (
            {"kind": "fault", "text": "  two \n words. .."},
            "'some file' cannot be read, it may be damaged or truncated: two words.",
        ),
        (
            {"kind": "fault", "text": "x" * 200 + "y"},
            f"'some file' cannot be read, it may be damaged or truncated: {'x' * 200}.",
        ),
        (
            {"kind": "fault", "text": "x" * 199 + "y"},
            f"'some file' cannot be read, it may be damaged or truncated: {'x' * 199}y.",
        ),
    ],
)
def test_each_answer_that_is_none_has_its_sentence(answer, sentence):
    error = workers._describe_answer(answer, LIMITS)
    error.add_file(FILE)
    assert str(error) == sentence
    assert error.file == FILE


# ------------------------------------------------------------------- the interpreter


def test_python_is_looked_for_beside_the_program_and_then_in_its_prefix(tmp_path, monkeypatch):
    places = [
        *("own/python3.11", "prefix/bin/python3", "prefix/python.exe"),
        "prefix/Scripts/python.exe",
    ]
    for place in places:
        (tmp_path / place).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / place).write_text("")
    monkeypatch.setattr(sys, "executable", str(tmp_path / places[0]))
    monkeypatch.setattr(sys, "exec_prefix", str(tmp_path / "prefix"))
    for place in places:
        assert workers._find_interpreter() == str(tmp_path / place)
        (tmp_path / place).unlink()
    with pytest.raises(ReadError, match="no Python interpreter"):
        workers._find_interpreter()
    (tmp_path / places[1]).mkdir()  # a folder of that name is none
    with pytest.raises(ReadError, match="no Python interpreter"):
        workers._find_interpreter()


@pytest.mark.parametrize("name", ["", "qgis", "own/embedding"])
def test_a_program_that_embeds_python_is_no_interpreter(tmp_path, monkeypatch, name):
    (tmp_path / "own").mkdir()
    (tmp_path / "own" / "embedding").write_text("")
    (tmp_path / "bin").mkdir()
    (tmp_path / "bin" / "python3").write_text("")
    monkeypatch.setattr(sys, "executable", name and str(tmp_path / name))
    monkeypatch.setattr(sys, "exec_prefix", str(tmp_path))
    assert workers._find_interpreter() == str(tmp_path / "bin" / "python3")


# -------------------------------------------------------------------------- the pool


class Child:
    """A child that keeps what became of it."""

    def __init__(self, module, *, is_sound=True):
        self.module, self.is_sound, self.fate = module, is_sound, []

    def __getattr__(self, name):
        if name not in ("end", "kill", "forget"):
            raise AttributeError(name)
        return lambda: self.fate.append(name)


def test_the_pool_keeps_one_sound_child_for_each_module(monkeypatch):
    monkeypatch.setattr(workers, "_Worker", Child)
    pool = workers._Pool()
    one, other, broken, third = Child("a"), Child("a"), Child("b", is_sound=False), Child("c")
    for child in (one, other, broken, third):
        pool.give_back(child)
    assert [child.fate for child in (one, other, broken, third)] == [[], ["end"], ["end"], []]
    assert pool.take("a") is one
    assert pool.take("a") not in (one, other)
    new = pool.take("b")
    assert new is not broken
    assert new.module == "b"
    pool.give_back(one)
    pool.end()
    assert one.fate == third.fate == ["kill", "end"]
    pool.end()
    assert one.fate == ["kill", "end"]


def test_a_forked_process_lets_go_of_idle_children():
    pool = workers._Pool()
    one = Child("a")
    pool.give_back(one)
    lock = pool._lock
    pool.forget()
    assert one.fate == ["forget"]
    assert pool._lock is not lock
    pool.forget()
    assert one.fate == ["forget"]


def test_a_child_that_is_let_go_of_is_closed_and_not_waited_for():
    closed = []
    stream = SimpleNamespace(close=lambda: closed.append(True))
    worker = workers._Worker.__new__(workers._Worker)
    worker._process = SimpleNamespace(stdin=stream, stdout=stream, returncode=None)
    worker.forget()
    assert (len(closed), worker._process.returncode) == (2, 0)


# ---------------------------------------------------------------------------- pipes


@pytest.mark.parametrize(
    ("error", "sentence"),
    [
        (FileNotFoundError(2, "No such file"), "There is no file 'some file'."),
        (PermissionError(13, "Denied"), "'some file' may not be read: permission denied."),
        (OSError(5, "Input/output error"), "Cannot read 'some file': Input/output error."),
        (OSError("odd"), "Cannot read 'some file': odd."),
    ],
)
def test_faults_of_the_system_are_sentences(error, sentence):
    found = spooling.describe_system_error(FILE, error)
    assert isinstance(found, ReadError)
    assert (str(found), found.file) == (sentence, FILE)


def test_a_file_is_read_where_it_is(tmp_path):
    path = tmp_path / "a.csv"
    path.write_text("1,2,3")
    with spooling.open_ordinary_file(path) as found:
        assert found is path


@pytest.mark.parametrize(("name", "copied"), [("pipe.csv", "piped.csv"), ("pipe", "piped.txt")])
def test_a_pipe_is_copied_and_the_copy_removed(tmp_path, name, copied):
    pipe = tmp_path / name
    os.mkfifo(pipe)
    sender = threading.Thread(target=pipe.write_bytes, args=(b"x" * 200_000,))
    sender.start()
    with spooling.open_ordinary_file(pipe) as copy:
        assert copy.name == copied
        assert copy.read_bytes() == b"x" * 200_000
        folder = copy.parent
        assert folder.name.startswith("tinsmith-")
    sender.join()
    assert not folder.exists()


def test_errors_of_a_copy_speak_of_the_pipe():
    path = Path("/dev/stdin")
    with pytest.raises(ReadError) as caught, spooling.spool(io.BytesIO(b"1"), path) as copy:
        raise ReadError(f"'{copy}' is not good, nor is {copy.name}.", path=copy)
    assert str(caught.value) == "'/dev/stdin' is not good, nor is stdin."
    assert caught.value.file == path
    other = Path("elsewhere")
    with pytest.raises(ReadError) as caught, spooling.spool(io.BytesIO(b"1"), path):
        raise ReadError("Not here.", path=other)
    assert caught.value.file == other


@on_linux
def test_devices_and_sockets_are_named(tmp_path, monkeypatch):
    with (
        pytest.raises(ReadError, match=r"'/dev/null' is a device or a terminal: a file or a pipe"),
        spooling.open_ordinary_file(Path("/dev/null")),
    ):
        pass
    monkeypatch.chdir(tmp_path)
    with socket.socket(socket.AF_UNIX) as server:
        server.bind("s")
        with (
            pytest.raises(ReadError, match=r"'s' is a socket: a file or a pipe is needed"),
            spooling.open_ordinary_file(Path("s")),
        ):
            pass
    with spooling.open_ordinary_file(tmp_path / "missing") as path:
        assert path == tmp_path / "missing"  # left to the reader


@pytest.mark.parametrize("name", ["ground.csv", "ground"])
def test_what_is_read_from_a_pipe_bears_its_name(tmp_path, name):
    content = b"1.5,2.5,3.5\n4.5,5.5,6.5\n7.5,1.5,-9999\n2.5,8.5,4.5\n"
    pipe = tmp_path / name
    os.mkfifo(pipe)
    sender = threading.Thread(target=pipe.write_bytes, args=(content,))
    sender.start()
    found = read(pipe)
    sender.join()
    pipe.unlink()
    (tmp_path / "ground.csv").write_bytes(content)
    plain = read(tmp_path / "ground.csv")
    streamed = read_stream(io.BytesIO(content), "ground.csv")
    assert found.source == name
    assert plain.source == streamed.source == "ground.csv"
    for one in (found, streamed):
        assert one.points.tolist() == plain.points.tolist()
        assert list(one.notes) == list(plain.notes)
        assert not any("piped" in note for note in one.notes)
    (tmp_path / "bad.csv").write_bytes(b"no,table\n")
    with pytest.raises(ReadError, match=r"'bad\.csv'") as caught:
        read_stream(io.BytesIO(b"no,table\n"), "bad.csv")
    assert "piped" not in str(caught.value)
