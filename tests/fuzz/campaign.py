"""What a campaign is, where campaigns are found, and how a number becomes a case."""

from __future__ import annotations

import importlib
import json
import pkgutil
import zlib
from collections.abc import Callable, Iterable
from typing import Any, NamedTuple

import numpy as np

Case = dict[str, Any]


class Campaign(NamedTuple):
    """Cases of one kind, and what must hold for each of them.

    `generate` makes a case of plain lists, numbers and strings. `examine` raises whatever it likes
    if the case shows a defect; a refusal that the case deserves is caught by it. It may return a
    label of a word or two (`"built"`, `"refused: crossing"`) that the summary counts, so that a
    campaign that refuses everything is seen.
    """

    name: str
    what: str
    generate: Callable[[np.random.Generator], Case]
    examine: Callable[[Case], str | None]
    seconds: float = 60.0  # a case that takes longer hangs; room for a machine that is busy
    megabytes: int = 4096  # what a case may allocate
    weight: int = 1  # how many cases of other campaigns take the time of one


def discover(modules: Iterable[str] = (), wanted: Iterable[str] = ()) -> dict[str, Campaign]:
    """Return the campaigns of further modules and of this package, by their names.

    The package is not loaded when the further modules have all campaigns that are wanted.
    """
    found = _import_campaigns(modules)
    if wanted and found.keys() >= set(wanted):
        return found
    package = importlib.import_module(__package__ or "fuzz")
    inside = [f"{package.__name__}.{m.name}" for m in pkgutil.iter_modules(package.__path__)]
    ours = _import_campaigns(name for name in sorted(inside) if not name.endswith("__main__"))
    assert not found.keys() & ours.keys(), "two campaigns have one name"
    return ours | found


def _import_campaigns(modules: Iterable[str]) -> dict[str, Campaign]:
    found: dict[str, Campaign] = {}
    for name in modules:
        for campaign in getattr(importlib.import_module(name), "CAMPAIGNS", ()):
            assert campaign.name not in found, f"two campaigns are called {campaign.name}"
            found[campaign.name] = campaign
    return found


def make_case(campaign: Campaign, seed: int, number: int) -> Case:
    """Return the case of a number: the same in every run, whatever ran before it."""
    rng = np.random.default_rng([seed, zlib.crc32(campaign.name.encode()), number])
    return as_written(campaign.generate(rng))


def as_written(case: Case) -> Case:
    """Return a case as it comes back from its file, so that a replay is the same exactly."""
    plain: Case = json.loads(json.dumps(case))
    return plain
