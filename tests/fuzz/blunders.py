"""Residuals without each point, and tables of blunders, of any points and lines."""

from __future__ import annotations

from typing import Any

import numpy as np
from support.leave_one_out import interpolate_without, rounding_of
from support.point_sets import points

import tinsmith as ts
from tinsmith.terrain.inspection.findings import drop_blunders, list_wrong_rows, screen
from tinsmith.tin import _kernel

from .campaign import Campaign, Case


def generate(rng: np.random.Generator) -> Case:
    """Points of some kind, a few of them wrong, and a line through some."""
    made = np.array(points(rng, int(rng.integers(5, 40))), float)
    for _ in range(int(rng.integers(0, 4))):
        row, what = int(rng.integers(len(made))), int(rng.integers(5))
        if what == 0:
            made[row, 2] = rng.choice([0.0, -9999.0, 1e30, 1.70141e38])
        elif what == 1:
            made[row, 2] *= rng.choice([10.0, 0.1, 0.3048])
        elif what == 2:
            made[row, :2] = made[row, 1::-1]
        elif what == 3:
            made[row, 0] += rng.choice([-1.0, 1.0]) * 1e3 * (np.ptp(made[:, 0]) + 1.0)
        else:
            made[row] = made[int(rng.integers(len(made)))] + [0.0, 0.0, 7.0]
    line = rng.integers(0, len(made), 2).tolist() if rng.random() < 0.4 else []
    return {"points": made.tolist(), "line": line}


def examine(case: Case) -> str:
    """Compare residuals with surfaces built anew, and hold the table to what it promises."""
    xyz = np.array(case["points"], float)
    lines = {"breaklines": [xyz[case["line"]]]} if case["line"] else {}
    try:
        tin = ts.triangulate(xyz, **lines)
    except ts.TinsmithError:
        return "refused: points"
    if not lines and len(np.unique(xyz[:, :2], axis=0)) == len(xyz):
        examine_residuals(tin, xyz)
    for table in (ts.blunders(tin), screen(tin)):
        examine_table(tin, table, len(xyz))
    table = ts.blunders(tin)
    tin, gone = drop_blunders(tin, table)
    assert set(gone.tolist()) <= set(list_wrong_rows(table).tolist())
    assert ts.check(tin).ok, repr(ts.check(tin))
    return "found" if len(table) else "none"


def examine_residuals(tin: Any, xyz: Any) -> None:
    every = np.arange(len(xyz), dtype=np.int32)
    without = _kernel.LeaveOneOut(tin.points, tin.triangles, tin.neighbors)
    found = without.interpolate(every)[:, 0]
    slack = rounding_of(xyz)
    for row in every.tolist():
        expected = interpolate_without(xyz, row)
        if np.isnan(found[row]) and np.isnan(expected):
            continue
        assert abs(found[row] - expected) <= slack, f"{found[row]} instead of {expected}"


def examine_table(tin: Any, table: Any, count: int) -> None:
    rows = table["row"]
    assert ((rows >= -1) & (rows < count)).all()
    assert np.isfinite(np.stack([table[name] for name in "xyz"])).all()
    order = [("high", "medium", "low").index(one) for one in table["certainty"].tolist()]
    assert order == sorted(order)
    assert (tin.vertex_of[rows[rows >= 0]] >= 0).all()


CAMPAIGNS = (Campaign("blunders", "points that look like blunders", generate, examine),)
