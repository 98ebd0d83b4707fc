"""Campaign: conforming builds, in which every edge must be Delaunay, in rational arithmetic."""

from __future__ import annotations

from fractions import Fraction

import numpy as np

import tinsmith as ts

from . import lines
from .campaign import Campaign, Case


def generate(rng: np.random.Generator) -> Case:
    """Return a case of lines, to be made conforming."""
    case = lines.generate(rng) | {"conforming": True}
    if rng.random() < 0.7:  # what is split most: several lines, nothing cut away
        case |= {"boundary": [], "holes": [], "max_edge": None, "snap": 0.0, "erase": []}
    return case


def examine(case: Case) -> str:
    """Examine it like any build with lines, and every edge without its flags."""
    label = lines.examine(case)
    if label == "built":
        tin = lines.build(case)
        if len(tin.triangles) <= 300:
            _require_delaunay(tin)
        assert ts.check(tin, conforming=True).ok
    return label


def _require_delaunay(tin: ts.TIN) -> None:
    """Every inner edge is Delaunay, constrained or not."""
    places = [(Fraction(x), Fraction(y)) for x, y in tin.points[:, :2].tolist()]
    for t, beside in enumerate(tin.neighbors.tolist()):
        for k, across in enumerate(beside):
            if across <= t:
                continue
            a, b, c = tin.triangles[t].tolist()
            (d,) = set(tin.triangles[across].tolist()) - {a, b, c}
            assert _in_circle(*(places[v] for v in (a, b, c, d))) <= 0, (t, k, "is not Delaunay")


def _in_circle(a, b, c, d):  # type: ignore[no-untyped-def]
    (ax, ay), (bx, by), (cx, cy) = ((p[0] - d[0], p[1] - d[1]) for p in (a, b, c))
    az, bz, cz = (x * x + y * y for x, y in ((ax, ay), (bx, by), (cx, cy)))
    return az * (bx * cy - cx * by) - bz * (ax * cy - cx * ay) + cz * (ax * by - bx * ay)


CAMPAIGNS = (
    Campaign("conforming", "conforming builds: every edge is Delaunay", generate, examine),
)
