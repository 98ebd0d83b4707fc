"""Children that read: their answers, their limits, and what becomes of them."""

import io
import json
import multiprocessing
import os
import struct
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest

from tinsmith.io import ReadError
from tinsmith.io.isolated import (
    Limits,
    choose_limits,
    run_isolated,
    start_early,
    stream_isolated,
    workers,
)
from tinsmith.io.isolated.answers import Answer, BrokenMessageError, receive, send

FILE = Path("some file")
QUICK = Limits(1.0, 1 << 28)


def run(name, limits=None, **arguments):
    return run_isolated(f"support.isolated_functions:{name}", arguments, path=FILE, limits=limits)


def refused(name, limits=QUICK, **arguments):
    with pytest.raises(ReadError) as caught:
        run(name, limits, **arguments)
    text = str(caught.value)
    assert text.isprintable()
    assert text.endswith(".")
    assert caught.value.file == FILE
    return text


def test_an_answer_comes_back_whatever_a_library_prints(capfd):
    value, arrays = run("answer", text="a\n", number=1.5, nothing=None)
    assert value == {"text": "a\n", "number": 1.5, "nothing": None}
    assert arrays["numbers"].tolist() == [0, 1, 2]
    assert arrays["none"].shape == (0, 2)
    assert capfd.readouterr() == ("", "")


def test_parts_come_one_by_one():
    how = {"path": FILE, "limits": QUICK}
    with stream_isolated("support.isolated_functions:parts", {"count": 5}, **how) as answers:
        found = [(part.value, part.arrays["numbers"].sum()) for part in answers]
    assert found == [(k, 200_000 * k) for k in range(5)]


def test_an_answer_that_is_not_read_to_its_end_does_no_harm():

    def leave_early():
        how = {"path": FILE, "limits": QUICK}
        with stream_isolated("support.isolated_functions:parts", {"count": 50}, **how) as answers:
            next(answers)
            raise KeyError

    with pytest.raises(KeyError):
        leave_early()
    assert run("answer", a=1).value == {"a": 1}


def test_a_sound_child_is_used_again_and_another_is_not():
    first = run("process").value[0]
    assert first != os.getpid()
    assert run("process").value[0] == first
    assert refused("refuse", text="No.") == "'some file': No."
    assert run("process").value[0] == first
    refused("fail", text="broken")
    assert run("process").value[0] == first
    refused("crash")
    assert run("process").value[0] != first


def test_a_child_that_was_started_early_takes_the_request():
    module = "support.isolated_functions"
    workers._POOL.end()
    start_early(module)
    start_early(module)  # one is enough
    process = workers._POOL._idle[module]._process
    assert run("process").value[0] == process.pid


def test_errors_are_sentences_without_control_letters():
    text = refused("fail", text="what\n\x1b[31m a library\x00 says " + "x" * 5000)
    assert text.startswith(
        "'some file' cannot be read, it may be damaged or truncated: what [31m a"
    )
    assert len(text) < 400


@pytest.mark.parametrize("name", ["crash", "leave", "objects"])
def test_a_crash_is_a_sentence(name):
    text = refused(name)
    assert "crashed" in text or "damaged" in text


@pytest.mark.every_case("slow")
@pytest.mark.parametrize("name", ["spin", pytest.param("wait", marks=pytest.mark.slow)])
def test_a_hang_ends_at_the_limit(name):
    start = time.monotonic()
    assert "after 1 second" in refused(name, Limits(1.0, 1 << 28))
    assert time.monotonic() - start < 500


@pytest.mark.parametrize("name", ["hoard", "hoard_slowly"])
def test_memory_has_a_limit(name):
    if not Path("/proc/self/statm").exists():
        return  # only Linux lets a process limit itself; the limit of time holds everywhere
    assert "0.2 GiB of memory" in refused(name, Limits(20.0, 1 << 28))


def test_limits_grow_with_the_file():
    small, large = choose_limits(0), choose_limits(100_000_000)
    assert small.seconds == 5
    assert large.seconds == 105
    assert small.memory == 1 << 30
    assert large.memory == (1 << 30) + 6_400_000_000
    assert small.waiting_seconds == 30


def test_threads_do_not_share_an_answer():
    found = {}

    def ask(k):
        found[k] = [run("answer", k=k).value["k"] for _ in range(5)]

    threads = [threading.Thread(target=ask, args=(k,)) for k in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert found == {k: [k] * 5 for k in range(4)}


def _ask_after_fork(parent, answers):
    answers.put((run("process").value[0] != parent, run("answer", k=7).value))


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no fork on this system")
def test_a_forked_process_has_children_of_its_own():
    ours = run("process").value[0]
    context = multiprocessing.get_context("fork")
    answers = context.Queue()
    other = context.Process(target=_ask_after_fork, args=(ours, answers))
    other.start()
    assert answers.get(timeout=600) == (True, {"k": 7})
    other.join()
    assert run("process").value[0] == ours


def test_modules_of_the_current_folder_are_not_loaded(tmp_path):
    (tmp_path / "numpy.py").write_text("raise SystemExit('hostile')\n")
    code = (
        "import sys; sys.path.append(sys.argv[1]); sys.path.insert(0, '')\n"
        "import os, numpy; os.chdir(sys.argv[2])\n"
        "from pathlib import Path\n"
        "from tinsmith.io.isolated import run_isolated\n"
        "print(run_isolated('support.isolated_functions:answer', {'k': 1}, path=Path('f')).value)\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", code, str(Path(__file__).parents[2]), tmp_path],
        capture_output=True,
        text=True,
        check=False,
    )
    assert (done.stdout, done.stderr) == ("{'k': 1}\n", "")


def test_the_child_ends_with_the_program(tmp_path):
    code = (
        "import sys; sys.path.append(sys.argv[1])\n"
        "from pathlib import Path\n"
        "from tinsmith.io.isolated import run_isolated\n"
        "found = run_isolated('support.isolated_functions:process', {}, path=Path('f'))\n"
        "print(found.value[0], flush=True)\n"
        "import os; os.kill(os.getpid(), 9)\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", code, str(Path(__file__).parents[2])],
        capture_output=True,
        text=True,
        check=False,
    )
    child = int(done.stdout)
    for _ in range(5000):
        try:
            os.kill(child, 0)
        except ProcessLookupError:
            return
        if (
            Path(f"/proc/{child}/stat").exists()
            and " Z " in Path(f"/proc/{child}/stat").read_text()
        ):
            return  # ended, and not yet collected by whoever inherited it
        time.sleep(0.05)
    pytest.fail("the child outlives the program")


def test_numbers_keep_their_type_and_order():
    from io import BytesIO

    from tinsmith.io.isolated.answers import Answer, BrokenMessageError, receive, send

    stream = BytesIO()
    arrays = {"a": np.arange(6, dtype=">i2").reshape(2, 3), "b": np.array([np.nan, 1.0])}
    send(stream, Answer({"x": [1, None]}, arrays))
    whole = stream.getvalue()
    value, found = receive(BytesIO(whole), most_bytes=1 << 20)
    assert value == {"x": [1, None]}
    assert found["a"].dtype == np.dtype(">i2")
    assert np.array_equal(found["a"], arrays["a"])
    for end in range(len(whole)):
        with pytest.raises(BrokenMessageError):
            receive(BytesIO(whole[:end]), most_bytes=1 << 20)
    with pytest.raises(BrokenMessageError):
        receive(BytesIO(whole), most_bytes=20)


# ------------------------------------------------------------------ children that are forks

# ------------------------------------------------------------------ messages

CONTENT = Answer(
    {"a": [1, "ä", None]},
    {"x": np.arange(6.0).reshape(2, 3), "none": np.empty((0, 3), "<i4"), "b": np.array([True])},
)


def message(value=None, arrays=None, body=b""):
    head = json.dumps({"value": value, "arrays": arrays or {}}).encode()
    return struct.pack("<Q", len(head)) + head + body


def test_messages_arrive_as_they_were_sent():
    stream = io.BytesIO()
    send(stream, CONTENT)
    send(stream, Answer("next", {}))
    stream.seek(0)
    found = receive(stream, most_bytes=1 << 20)
    assert found.value == CONTENT.value
    assert list(found.arrays) == list(CONTENT.arrays)
    for name, array in CONTENT.arrays.items():
        np.testing.assert_array_equal(found.arrays[name], array)
        assert found.arrays[name].dtype == array.dtype
    assert receive(stream, most_bytes=1 << 20) == Answer("next", {})


def test_a_message_that_ends_early_is_none():
    stream = io.BytesIO()
    send(stream, CONTENT)
    whole = stream.getvalue()
    for length in range(len(whole)):
        with pytest.raises(BrokenMessageError):
            receive(io.BytesIO(whole[:length]), most_bytes=1 << 20)


def test_a_message_has_at_most_so_many_bytes():
    plain = message("x" * 40)
    assert receive(io.BytesIO(plain), most_bytes=len(plain) - 8).value == "x" * 40
    with pytest.raises(BrokenMessageError):
        receive(io.BytesIO(plain), most_bytes=len(plain) - 9)
    array = message(None, {"a": ["<f8", [500]], "b": ["<f8", [500]]}, bytes(8000))
    assert len(receive(io.BytesIO(array), most_bytes=8000).arrays["b"]) == 500
    with pytest.raises(BrokenMessageError):
        receive(io.BytesIO(array), most_bytes=7999)


@pytest.mark.parametrize(
    "arrays",
    [
        {"a": ["|O", [1]]},
        {"a": ["<f8", [-1]]},
        {"a": ["<f8", [True]]},
        {"a": ["<f8", [1.0]]},
        {"a": ["<f8", [1] * 40]},
        {"a": ["<f8", [1 << 62]]},
        {"a": ["<f8", [1 << 50, 1 << 50]]},
        {"a": ["<f8"]},
        {"a": [8, [1]]},
        {"a": ["no type", [1]]},
        [1, 2],
        "text",
    ],
)
def test_arrays_that_cannot_be_are_no_message(arrays):
    with pytest.raises(BrokenMessageError):
        receive(io.BytesIO(message(None, arrays, bytes(64))), most_bytes=1 << 62)


@pytest.mark.parametrize("head", [b"", b"{", b"[]", b"{}", b'{"arrays": {}}', b"\xff", b"[" * 9000])
def test_what_is_no_message(head):
    with pytest.raises(BrokenMessageError):
        receive(io.BytesIO(struct.pack("<Q", len(head)) + head), most_bytes=1 << 20)
