"""Edits of a finished TIN: random ones, one call each, and one large batch."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tinsmith.base.arrays import Float64Array, Int64Array

from .points import SEED, make_points

__all__ = [
    "BATCH",
    "EDITS",
    "EDIT_TASKS",
    "INSERT_ALL",
    "WHAT",
    "EditTask",
    "label_task",
    "make_edit_task",
]


EDITS = 1_000
WHAT = ("insert", "remove", "move", "set_elevation")
"""The edits, as a script numbers them."""
INSERT_ALL = 4
"""In a script: insert this point together with all others of this kind, in one call."""
STRIDE = 0.3
"""Metres east and north by which points move at most; points are one a square metre."""

BATCH = "batch"
EDIT_TASKS = {
    "inserts": (0,),
    "removals": (1,),
    "moves": (2,),
    "new elevations": (3,),
    "mixed edits": (0, 1, 2, 3),
}
"""What is done in each task but the batch."""


class EditTask(NamedTuple):
    """Points of a TIN, and what is done to it.

    Attributes
    ----------
    points : (n, 3) float64 array
    script : (e, 6) float64 array
        What, number of a point as given, number of its vertex when its turn comes, x, y, z.
        No point is touched twice.
    """

    points: Float64Array
    script: Float64Array

    def afterwards(self) -> Float64Array:
        """Return the points after all edits, in the order of a TIN's vertices."""
        what, number = self.script[:, :2].astype(np.int64).T
        points = self.points.copy()
        is_moved, is_lifted = what == WHAT.index("move"), what == WHAT.index("set_elevation")
        points[number[is_moved]] = self.script[is_moved, 3:]
        points[number[is_lifted], 2] = self.script[is_lifted, 5]
        left = np.delete(points, number[what == WHAT.index("remove")], axis=0)
        is_new = (what == WHAT.index("insert")) | (what == INSERT_ALL)
        return np.concatenate([left, self.script[is_new, 3:]])


def label_task(name: str, n: int) -> str:
    """Return what results of a task are called."""
    return f"{name}, TIN of {n:,} points"


def make_edit_task(name: str, n: int) -> EditTask:
    """Make a task on a TIN of ``n`` uniform points.

    Parameters
    ----------
    name : str
        A key of ``EDIT_TASKS``, or ``BATCH``: as many points again, in one call.
    n : int
    """
    rng = np.random.default_rng(SEED + 1)
    points = make_points("uniform", n)
    if name == BATCH:
        what = np.full(n, INSERT_ALL)
        number = np.arange(n)
    else:
        what = rng.choice(EDIT_TASKS[name], min(EDITS, n // 4))
        number = rng.choice(n, len(what), replace=False)
    return EditTask(points, _make_script(points, what, number, rng))


def _make_script(
    points: Float64Array, what: Int64Array, number: Int64Array, rng: np.random.Generator
) -> Float64Array:
    corner, side = points[:, :2].min(axis=0), np.ptp(points[:, :2], axis=0)
    xyz = points[number] + rng.uniform(-STRIDE, STRIDE, (len(what), 3))
    is_new = (what == WHAT.index("insert")) | (what == INSERT_ALL)
    xyz[is_new, :2] = corner + side * rng.random((int(is_new.sum()), 2))
    is_lifted = what == WHAT.index("set_elevation")
    xyz[is_lifted, :2] = points[number[is_lifted], :2]
    vertex = number - _count_removed_before(what, number)
    return np.column_stack([what, number, vertex, xyz])


def _count_removed_before(what: Int64Array, number: Int64Array) -> Int64Array:
    """Count the smaller numbers that are removed by then: those behind them have moved up."""
    removals = np.flatnonzero(what == WHAT.index("remove"))
    is_earlier = removals < np.arange(len(what))[:, None]
    is_smaller = number[removals] < number[:, None]
    return np.count_nonzero(is_earlier & is_smaller, axis=1)
