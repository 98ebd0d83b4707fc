"""Small surfaces with lines, a boundary or holes, in places that are hard."""

from __future__ import annotations

from typing import Any

import numpy as np
from support.point_sets import points

import tinsmith as ts
from tinsmith.base.arrays import Float64Array

from .campaign import Case

__all__ = ["list_lines", "surface", "triangulate"]


def surface(rng: np.random.Generator, *, most: int) -> Case:
    """Points, so many at most, often with lines among them, a boundary or holes."""
    kind = None if rng.random() < 0.6 else str(rng.choice(["nearly_collinear", "neighbours"]))
    case: Case = {"points": points(rng, int(rng.integers(3, most + 1)), kind)}
    xy = np.array(case["points"])[:, :2]
    if rng.random() < 0.5:
        case["breaklines"] = [line(rng, xy) for _ in range(int(rng.integers(1, 4)))]
    if rng.random() < 0.3:
        case[str(rng.choice(["boundary", "holes"]))] = [ring(rng, xy)]
    return case


def list_lines(case: Case) -> dict[str, Any]:
    """Return the lines of a case by the parameter that takes them."""
    return {name: case[name] for name in ("breaklines", "boundary", "holes") if name in case}


def triangulate(case: Case) -> Any:
    """Return the TIN of a case, or in a few words why there is none to go on with."""
    try:
        tin = ts.triangulate(case["points"], **list_lines(case))
    except ts.TinsmithError:
        return "refused: TIN"
    return tin if ts.check(tin).ok else "not ours: unsound before"


def line(rng: np.random.Generator, xy: Float64Array) -> list[list[float]]:
    """Return two or three vertices of the points, or near them, with elevations."""
    rows = xy[rng.integers(0, len(xy), int(rng.integers(2, 4)))]
    if rng.random() < 0.3:
        rows = rows + rng.integers(-2, 3, rows.shape) * np.spacing(rows)
    return [[*row, float(rng.integers(0, 9))] for row in rows.tolist()]


def ring(rng: np.random.Generator, xy: Float64Array) -> list[list[float]]:
    """Return three to five vertices of the points or within their bounds."""
    low, high = xy.min(axis=0), xy.max(axis=0)
    rows = low + rng.random((int(rng.integers(3, 6)), 2)) * (high - low)
    is_vertex = rng.random(len(rows)) < 0.5
    rows[is_vertex] = xy[rng.integers(0, len(xy), int(is_vertex.sum()))]
    return rows.tolist()  # type: ignore[no-any-return]
