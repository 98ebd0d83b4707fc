"""Placing: texts on a map that overlap neither each other nor the frame."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .windows import turn

if TYPE_CHECKING:
    from ...base.arrays import Float64Array
    from ...tin import Bounds

_CELL = 8.0
"""Millimetres; a text is looked for in the cells that it covers."""


def outline_text(
    center: tuple[float, float], width: float, height: float, rotation: float = 0.0
) -> Float64Array:
    """Return the corners of the rectangle around a text, (4, 2)."""
    half = np.array([(-width, -height), (width, -height), (width, height), (-width, height)]) / 2
    corners: Float64Array = turn(half, rotation) + np.asarray(center)
    return corners


class Room:
    """What is left of a frame for texts."""

    def __init__(self, frame: Bounds) -> None:
        self._frame = frame
        self._taken: dict[tuple[int, int], list[Float64Array]] = {}

    def take(self, corners: Float64Array) -> bool:
        """Take the room of a text, unless it leaves the frame or meets another one."""
        low, high = corners.min(axis=0), corners.max(axis=0)
        frame = self._frame
        if not (frame.xmin <= low[0] and high[0] <= frame.xmax):
            return False
        if not (frame.ymin <= low[1] and high[1] <= frame.ymax):
            return False
        (left, bottom), (right, top) = ((one // _CELL).astype(int).tolist() for one in (low, high))
        cells = [(i, j) for i in range(left, right + 1) for j in range(bottom, top + 1)]
        if any(_overlap(corners, other) for cell in cells for other in self._taken.get(cell, ())):
            return False
        for cell in cells:
            self._taken.setdefault(cell, []).append(corners)
        return True


def _overlap(one: Float64Array, other: Float64Array) -> bool:
    """Tell whether two rectangles overlap: no side of either parts them."""
    for sides in (one, other):
        for across in (sides[1] - sides[0], sides[3] - sides[0]):
            first, second = one @ across, other @ across
            if first.max() <= second.min() or second.max() <= first.min():
                return False
    return True
