"""Answers from the surface beside the peers that give them too: every module of `answers`."""

from __future__ import annotations

import importlib
import pkgutil
import sys

from .. import answers
from ..measure import Outcome

__all__ = ["SECTION", "run"]

SECTION = "answers"


def run(n_points: int, *, repeats: int = 3) -> Outcome:
    """Measure all of them on ``n_points`` points.

    An AssertionError says that a peer's answer differs from ours.
    """
    outcome = Outcome()
    for found in sorted(module.name for module in pkgutil.iter_modules(answers.__path__)):
        print(f"answers: {found}, {n_points:,} points", file=sys.stderr, flush=True)
        module = importlib.import_module(f"{answers.__name__}.{found}")
        outcome.add(module.run(n_points, repeats=repeats))
    return outcome
