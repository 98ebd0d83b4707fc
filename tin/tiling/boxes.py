"""Boxes of tiles: closed rectangles, those at the rim without end."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...base.types import Bounds

if TYPE_CHECKING:
    from ...base.arrays import BoolArray, Float64Array


def are_in_box(places: Float64Array, box: Bounds) -> BoolArray:
    """Tell which places, (..., 2 or more), lie in a closed box."""
    x, y = places[..., 0], places[..., 1]  # one after the other: `all` of two is slow
    is_inside = x >= box.xmin
    is_inside &= x <= box.xmax
    is_inside &= y >= box.ymin
    is_inside &= y <= box.ymax
    return np.asarray(is_inside)


def list_sides(box: Bounds) -> tuple[float, float, float, float]:
    """Return the western, southern, eastern and northern side."""
    return float(box.xmin), float(box.ymin), float(box.xmax), float(box.ymax)


def intersect(one: Bounds, other: Bounds) -> Bounds:
    """Return what two boxes have in common; its sides are exchanged where that is nothing."""
    return Bounds(
        max(one.xmin, other.xmin),
        max(one.ymin, other.ymin),
        min(one.xmax, other.xmax),
        min(one.ymax, other.ymax),
    )


def widen(box: Bounds, margin: float) -> Bounds:
    """Return a box that is wider by a margin on every side."""
    return Bounds(box.xmin - margin, box.ymin - margin, box.xmax + margin, box.ymax + margin)
