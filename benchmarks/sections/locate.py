"""Point location and linear interpolation beside the peers, on one and the same TIN.

Matplotlib is prepared from triangles, since it has no triangulation of its own.
"""

from __future__ import annotations

import sys

import numpy as np

import tinsmith as ts
from tinsmith.tin import TIN

from ..measure import OURS, Outcome
from ..peers.place_tools import SIZE, Answer, Tool, ask_tools, make_tin, use_scipy, use_startinpy

__all__ = ["SECTION", "run"]

SECTION = "locate"

MOST_SLOW_QUERIES = 20_000
"""startinpy answers some thousand places a second: it gets no more than these."""


def run(n_points: int = 50_000, n_queries: int = 50_000, *, repeats: int = 3) -> Outcome:
    """Measure every tool on ``n_points`` uniform points and ``n_queries`` uniform places.

    An AssertionError says that a peer's answer differs from ours.
    """
    rng = np.random.default_rng(1)
    tin = make_tin(n_points, rng)
    xy = rng.random((n_queries, 2)) * SIZE
    outcome = Outcome()
    for task, tools in TASKS.items():
        print(f"locate: {task}, {n_queries:,} places", file=sys.stderr, flush=True)
        asked = ask_tools(tools, tin, xy, repeats, outcome)
        for one in asked.values():
            wanted = asked[OURS].answers[: len(one.answers)]
            np.testing.assert_allclose(one.answers, wanted, rtol=0, atol=1e-6)
        outcome.results += [one.make_result(SECTION, task, name) for name, one in asked.items()]
    return outcome


def _locate_with_tinsmith(tin: TIN) -> Answer:
    return ts.triangulate(tin.points).locate


def _interpolate_with_tinsmith(tin: TIN) -> Answer:
    return ts.triangulate(tin.points).interpolate


def _locate_with_matplotlib(tin: TIN) -> Answer:
    import matplotlib.tri

    made = matplotlib.tri.Triangulation(tin.points[:, 0], tin.points[:, 1], tin.triangles)
    finder = made.get_trifinder()
    return lambda xy: finder(xy[:, 0], xy[:, 1])


TASKS = {
    "locate": {
        OURS: Tool("tinsmith", _locate_with_tinsmith),
        "matplotlib": Tool("matplotlib", _locate_with_matplotlib),
    },
    "interpolate": {
        OURS: Tool("tinsmith", _interpolate_with_tinsmith),
        "SciPy": Tool("scipy", use_scipy("LinearNDInterpolator")),
        "startinpy": Tool("startinpy", use_startinpy("TIN"), most=MOST_SLOW_QUERIES),
    },
}
"""Who answers what."""
