"""Answers from the surface beside the peers that give them too: every module of `answers`."""

from __future__ import annotations

import importlib
import inspect
import pkgutil
import sys
from typing import Any

from .. import answers
from ..measure import Outcome

__all__ = ["SECTION", "describe_modules", "run"]

SECTION = "answers"


def run(n_points: int, *, repeats: int = 3) -> Outcome:
    """Measure all of them on ``n_points`` points.

    An AssertionError says that a peer's answer differs from ours.
    """
    outcome = Outcome()
    for name, module in _load_modules():
        print(f"answers: {name}, {n_points:,} points", file=sys.stderr, flush=True)
        outcome.add(module.run(n_points, repeats=repeats))
    return outcome


def describe_modules() -> list[str]:
    """Return what each module measures beside whom and what must agree, as it says itself."""
    return [" ".join((inspect.getdoc(module) or "").split()) for _, module in _load_modules()]


def _load_modules() -> list[tuple[str, Any]]:
    names = sorted(module.name for module in pkgutil.iter_modules(answers.__path__))
    return [(name, importlib.import_module(f"{answers.__name__}.{name}")) for name in names]
