"""A process that holds one tool and one task, and runs when told.

Commands on stdin are those of ``cgal/serve.hpp``: ``run K`` and ``save PATH``. Answers are lines of
JSON. Alone in its process, a tool's peak memory is its own.
"""

from __future__ import annotations

import json
import os
import sys
import time
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ..datasets.edits import EditTask, make_edit_task
from ..datasets.lines import LEAST_POINTS, LineTask, make_lines
from ..datasets.tasks import read_task
from .edit_tools import EDIT_TOOLS
from .line_tools import LINE_TOOLS
from .triangulators import TOOLS, Tool

WARM_UP_POINTS = 100


class Kind(NamedTuple):
    """A kind of task: its tools, how it is read from a file, and a small one to warm up on."""

    tools: Mapping[str, Tool]
    read: Callable[[Path], Any]
    small: Callable[[], Any]


KINDS = {
    "points": Kind(TOOLS, np.load, lambda: np.random.default_rng(0).random((WARM_UP_POINTS, 3))),
    "lines": Kind(
        LINE_TOOLS, partial(read_task, LineTask), partial(make_lines, "short lines", LEAST_POINTS)
    ),
    "edits": Kind(
        EDIT_TOOLS,
        partial(read_task, EditTask),
        partial(make_edit_task, "mixed edits", WARM_UP_POINTS),
    ),
}


def serve_tasks() -> None:
    """Serve until stdin ends."""
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)  # whatever a library prints must not mix with the answers
    kind = KINDS[sys.argv[1]]
    tool = kind.tools[sys.argv[2]]
    given = tool.prepare(kind.read(Path(sys.argv[3])))
    tool.run(tool.renew(tool.prepare(kind.small())))
    _say(answers, {"ready": True})
    made: Any = None
    for line in sys.stdin:
        command, argument = line.split(maxsplit=1)
        if command == "run":
            made = None
            made, seconds = _measure_mean_seconds(tool, given, int(argument))
            _say(answers, {"seconds": seconds, "output_bytes": tool.output_bytes(made)})
        else:
            np.save(argument.strip(), tool.triangles(made))
            _say(answers, {"saved": True})


def _measure_mean_seconds(tool: Tool, given: Any, count: int) -> tuple[Any, float]:
    total = 0.0
    made = None
    for _ in range(count):
        made = None
        state = tool.renew(given)
        begin = time.perf_counter()
        made = tool.run(state)
        total += time.perf_counter() - begin
    return made, total / count


def _say(answers: Any, values: dict[str, Any]) -> None:
    answers.write(json.dumps(values) + "\n")
    answers.flush()


if __name__ == "__main__":
    serve_tasks()
