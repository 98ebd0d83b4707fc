"""How many threads work on one triangulation."""

from __future__ import annotations

import os

from ...base.checks import require_count

# Below, starting the threads and stitching their parts costs as much as they save.
LEAST_POINTS_PER_THREAD = 10_000

# More are never started: the result is the same, and each takes memory.
MOST_THREADS = 1024


def thread_count(threads: int | None, n_points: int) -> int:
    """Return the number of threads for so many points, as asked for; OptionError if it is none.

    None takes every core that this process may use, where it pays.
    """
    if threads is None:
        most = n_points // LEAST_POINTS_PER_THREAD
        return min(available_cores(), most) if most > 1 else 1
    if type(threads) is not int or threads < 1:  # edits ask often
        require_count("threads", threads, or_none=True)
    return min(int(threads), MOST_THREADS)


def available_cores() -> int:
    """Return how many cores this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
