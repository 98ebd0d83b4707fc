"""Products of a surface: hydrology, checks, ground, flats, grading, simplification, sight.

Each runs alone in a process of its own, whose memory is looked at.
"""

from __future__ import annotations

import json
import subprocess
import sys
from typing import Any

from ..measure import OURS, SLOW_SECONDS, Outcome, Result, find_median
from ..products import PRODUCTS

__all__ = ["SECTION", "run"]

SECTION = "products"


def run(n_points: int, *, repeats: int = 3) -> Outcome:
    """Measure every product on about ``n_points`` points.

    Raises
    ------
    subprocess.CalledProcessError
        If an answer is wrong.
    """
    outcome = Outcome()
    for name in PRODUCTS:
        print(f"products: {name}, {n_points:,} points", file=sys.stderr, flush=True)
        outcome.results.append(_measure(name, n_points, repeats))
    return outcome


def _measure(name: str, n_points: int, repeats: int) -> Result:
    command = [sys.executable, "-m", "benchmarks.products", name, str(n_points)]
    figures: list[dict[str, Any]] = []
    while len(figures) < max(repeats, 1):
        done = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True)
        figures.append(json.loads(done.stdout))
        if figures[0]["seconds"] > SLOW_SECONDS:
            break
    seconds = [one["seconds"] for one in figures]
    processor = find_median([one["processor_seconds"] for one in figures])
    extra = {"processor_seconds": processor, "peak_bytes": figures[0].get("peak_bytes")}
    return Result(
        SECTION,
        name,
        OURS,
        n_points,
        find_median(seconds),
        tuple(seconds),
        figures[0]["found"],
        extra,
    )
