"""A plugin of pytest: note which lines of the package each test runs, in its children too.

The lines of a function are followed in its first calls of a test only, which costs a fraction of
following all. Children find this module by `sitecustomize`, their test by the environment, and
leave what they ran in a file of their own as they end.
"""

from __future__ import annotations

import atexit
import json
import os
import sys
import threading
from collections import Counter, defaultdict
from pathlib import Path
from types import CodeType, FrameType
from typing import Any

PACKAGE = os.environ["MUTATION_PACKAGE"] + os.sep
FOLDER = Path(os.environ["MUTATION_MAP"])
CALLS_FOLLOWED = 30

_lines: set[tuple[str, int]] = set()
_calls: Counter[CodeType] = Counter()


def follow_calls(frame: FrameType, event: str, value: object) -> Any:
    code = frame.f_code
    if not code.co_filename.startswith(PACKAGE):
        return None
    _calls[code] += 1
    return follow_lines if _calls[code] <= CALLS_FOLLOWED else None


def follow_lines(frame: FrameType, event: str, value: object) -> Any:
    _lines.add((frame.f_code.co_filename, frame.f_lineno))
    return follow_lines


def start() -> None:
    _lines.clear()
    _calls.clear()
    threading.settrace(follow_calls)
    sys.settrace(follow_calls)


def take_lines() -> dict[str, list[int]]:
    """Return the lines run so far by file, and forget them."""
    found = defaultdict(list)
    for path, line in sorted(_lines):
        found[path.removeprefix(PACKAGE)].append(line)
    _lines.clear()
    return found


# ---------------------------------------------------------------------------- children


def follow_child() -> None:
    """Follow a process that a test started; leave its lines in a file when it ends."""
    start()
    atexit.register(leave_lines)


def leave_lines() -> None:
    test = os.environ.get("MUTATION_TEST", "")
    if test and _lines:
        found = {"test": test, "lines": take_lines()}
        part = FOLDER / f"part-{os.getpid()}-{id(found)}"
        part.write_text(json.dumps(found))
        part.rename(FOLDER / f"child-{part.name}.json")  # whole, or not at all if it is killed


def leave_lines_at_exit_of_forks() -> None:
    parent, leave_at_once = os.getpid(), os._exit

    def leave(code: int) -> None:
        if os.getpid() != parent:
            leave_lines()
        leave_at_once(code)

    os._exit = leave
    os.register_at_fork(after_in_child=start)


# ---------------------------------------------------------------------------- the tests' process

_found: dict[str, dict[str, list[int]]] = {}


def pytest_configure() -> None:
    FOLDER.mkdir(parents=True, exist_ok=True)
    leave_lines_at_exit_of_forks()


def pytest_runtest_protocol(item: Any) -> None:
    os.environ["MUTATION_TEST"] = item.nodeid
    start()


def pytest_runtest_logfinish(nodeid: str) -> None:
    sys.settrace(None)
    _found[nodeid] = take_lines()
    os.environ["MUTATION_TEST"] = ""


def pytest_sessionfinish() -> None:
    FOLDER.joinpath(f"tests-{os.getpid()}.json").write_text(json.dumps(_found))
