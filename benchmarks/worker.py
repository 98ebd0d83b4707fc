"""A process that holds one tool and one set of points, and triangulates when told.

Commands on stdin are those of ``cgal/delaunay.cpp``: ``run K`` and ``save PATH``. Answers are
lines of JSON. Alone in its process, a tool's peak memory is its own.
"""

from __future__ import annotations

import json
import os
import sys
import time
from typing import Any

import numpy as np

from .triangulators import TOOLS

WARM_UP_POINTS = 100


def main() -> None:
    """Serve until stdin ends."""
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)  # whatever a library prints must not mix with the answers
    tool = TOOLS[sys.argv[1]]
    given = tool.prepare(np.load(sys.argv[2]))
    tool.run(tool.prepare(np.random.default_rng(0).random((WARM_UP_POINTS, 3))))
    _say(answers, {"ready": True})
    made: Any = None
    for line in sys.stdin:
        command, argument = line.split(maxsplit=1)
        if command == "run":
            made = None
            made, seconds = _mean_seconds(lambda: tool.run(given), int(argument))
            _say(answers, {"seconds": seconds, "output_bytes": tool.output_bytes(made)})
        else:
            np.save(argument.strip(), tool.triangles(made))
            _say(answers, {"saved": True})


def _mean_seconds(run: Any, count: int) -> tuple[Any, float]:
    total = 0.0
    made = None
    for _ in range(count):
        made = None
        begin = time.perf_counter()
        made = run()
        total += time.perf_counter() - begin
    return made, total / count


def _say(answers: Any, values: dict[str, Any]) -> None:
    answers.write(json.dumps(values) + "\n")
    answers.flush()


if __name__ == "__main__":
    main()
