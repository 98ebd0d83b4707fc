"""Windows: the rectangle of ground that a sheet shows, and where it lies on paper."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from ...base.arrays import Float64Array
    from ...tin import Bounds


class MatchLine(NamedTuple):
    """Where another sheet goes on."""

    ends: Float64Array
    """(2, 2), on the ground."""
    window: int
    """Number of the other sheet's window, from 0."""


@dataclass(frozen=True, eq=False)
class Window:
    """A rectangle of ground on a sheet."""

    center: tuple[float, float]
    """Easting and northing in the middle of the frame."""
    angle: float
    """Direction that is to the right on the sheet, degrees counter-clockwise from east."""
    mm_per_unit: float
    """Length of a unit of the coordinates on paper."""
    frame: Bounds
    """Of the map on paper, millimetres from the lower left corner of the sheet."""
    matches: tuple[MatchLine, ...] = field(default=())

    def to_paper(self, xy: Float64Array) -> Float64Array:
        """Return where places on the ground are on paper, millimetres."""
        moved = self.mm_per_unit * (np.asarray(xy, np.float64)[..., :2] - self.center)
        turned = turn(moved, -self.angle) + self.frame.center
        placed: Float64Array = turned
        return placed

    def to_ground(self, mm: Float64Array) -> Float64Array:
        """Return the places on the ground of places on paper."""
        moved = (np.asarray(mm, np.float64) - self.frame.center) / self.mm_per_unit
        found: Float64Array = turn(moved, self.angle) + self.center
        return found

    @property
    def corners(self) -> Float64Array:
        """Corners of the frame on the ground, (4, 2), from the lower left one to the right."""
        return self.to_ground(outline(self.frame)[:4])


def turn(xy: Float64Array, angle: float) -> Float64Array:
    """Turn vectors counter-clockwise by degrees; by none they stay the same to the bit."""
    if angle == 0.0:
        return xy
    cos, sin = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    x, y = xy[..., 0], xy[..., 1]
    return np.stack([cos * x - sin * y, sin * x + cos * y], axis=-1)


def outline(box: Bounds) -> Float64Array:
    """Return the ring around a rectangle, (5, 2), from the lower left corner to the right."""
    west, south, east, north = box.xmin, box.ymin, box.xmax, box.ymax
    return np.array([(west, south), (east, south), (east, north), (west, north), (west, south)])
