"""Of a product of parameters, cases that hold each value at least once.

A test marked ``each_value`` has parameters of which each was proven by itself, such as products and
formats: `make test` runs as many cases as the longest list of values has, each with the least used
of the other lists. `make proof` runs the others, or `make slow` where it is ``others="slow"``.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable, Sequence

import pytest


def choose_cases(cases: Sequence[tuple[object, ...]]) -> list[int]:
    """Return the numbers of few cases, tuples of values, that hold each value of each place."""
    used: Counter[tuple[int, object]] = Counter()
    chosen: list[int] = []
    left = dict.fromkeys(pair for case in cases for pair in enumerate(case))
    pairs = [tuple(enumerate(case)) for case in cases]
    while left:
        best = min(
            range(len(cases)),
            key=lambda k: (-sum(p in left for p in pairs[k]), sum(used[p] for p in pairs[k])),
        )
        chosen.append(best)
        used.update(pairs[best])
        for pair in pairs[best]:
            left.pop(pair, None)
    return sorted(chosen)


def mark_other_cases(items: Iterable[pytest.Function]) -> None:
    """Mark the cases of tests marked ``each_value`` that are not chosen as proofs, or slow.

    Of those that are slow themselves others are chosen, and proofs stay what they are.
    """
    tests = defaultdict(list)
    for item in items:
        if item.get_closest_marker("each_value") and not item.get_closest_marker("proof"):
            is_slow = item.get_closest_marker("slow") is not None
            tests[item.parent.nodeid, item.originalname, is_slow].append(item)
    for cases in tests.values():
        chosen = choose_cases([tuple(map(id, case.callspec.params.values())) for case in cases])
        others = cases[0].get_closest_marker("each_value").kwargs.get("others", "proof")
        for case in set(cases).difference(cases[k] for k in chosen):
            case.add_marker(others)


def list_seeds(count: int, *, few: int) -> list[object]:
    """Return the numbers below a count; those beyond a few are proofs."""
    return [k if k < few else pytest.param(k, marks=pytest.mark.proof) for k in range(count)]
