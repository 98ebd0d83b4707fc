"""Thumbnails: points, lines and cells as pixels, north up, clear where there is nothing."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from .. import palette
from ..palette import interpolate_tints, parse_hex
from .frame import SIZE

if TYPE_CHECKING:
    from ....base.arrays import Float64Array, UInt8Array
    from ....base.crs import CRS
    from ..palette import Color

_INK = parse_hex(palette.THUMBNAIL)
_MARGIN = 3
_MOST_PIXELS = 4_000_000
"""Of all lines together; beyond it only every n-th segment is drawn."""

_FEW_POINTS = 5_000
"""Up to which points are drawn larger."""


@dataclass(frozen=True, slots=True, eq=False)
class Canvas:
    """A picture with a place on the map."""

    pixels: UInt8Array
    west: float
    north: float
    scale: Float64Array

    @classmethod
    def around(cls, xy: Float64Array, crs: CRS | None) -> Canvas:
        """Return a clear canvas that holds some places, as square on the ground as they are.

        ``xy`` is (n, 2), at least one place. Above longitude and latitude a degree of longitude is
        drawn as long as it is there.
        """
        low, high = xy.min(axis=0), xy.max(axis=0)
        middle = math.radians(float(np.clip((low[1] + high[1]) / 2, -89, 89)))
        wide = math.cos(middle) if crs is not None and crs.is_geographic else 1.0
        room = np.array(SIZE) - 2 * _MARGIN
        with np.errstate(over="ignore"):
            sides = np.minimum((high - low) * (wide, 1.0), np.finfo(float).max)
        pixel = max(float((sides / room).max()), np.finfo(float).tiny)
        width, height = (math.ceil(side / pixel) + 2 * _MARGIN for side in sides)
        scale = np.array([wide / pixel, 1.0 / pixel])
        return cls(np.zeros((height, width, 4), np.uint8), float(low[0]), float(high[1]), scale)

    def _place(self, xy: Float64Array) -> Float64Array:
        """Return columns and rows of places."""
        height, width = self.pixels.shape[:2]
        shift = np.column_stack([xy[:, 0] - self.west, self.north - xy[:, 1]])
        return np.clip(np.nan_to_num(shift * self.scale) + _MARGIN, 0, (width - 1, height - 1))

    def draw_points(self, xy: Float64Array, values: Float64Array | None) -> None:
        """Draw places as dots, tinted from the lowest value to the highest, which is on top."""
        colors = np.tile(np.array(_INK, np.uint8), (len(xy), 1))
        if values is not None and len(values):
            order = np.argsort(values, kind="stable")
            xy, colors = xy[order], _find_tints(values[order])
        columns, rows = np.rint(self._place(xy)).astype(np.intp).T
        reach = (-1, 0, 1) if len(xy) <= _FEW_POINTS else (0,)
        height, width = self.pixels.shape[:2]
        for down in reach:
            for right in reach:
                at = np.clip(rows + down, 0, height - 1), np.clip(columns + right, 0, width - 1)
                self.pixels[(*at, slice(0, 3))] = colors
                self.pixels[(*at, 3)] = 255

    def draw_segments(self, start: Float64Array, stop: Float64Array, color: Color = _INK) -> None:
        """Draw straight segments, a pixel wide."""
        a, b = self._place(start), self._place(stop)
        steps = np.ceil(np.abs(b - a).max(axis=1, initial=0.0)).astype(np.intp) + 1
        every = max(1, math.ceil(int(steps.sum()) / _MOST_PIXELS))
        a, b, steps = a[::every], b[::every], steps[::every]
        row = np.repeat(np.arange(len(steps)), steps)
        along = np.arange(len(row)) - np.repeat(np.cumsum(steps) - steps, steps)
        share = (along / np.maximum(steps - 1, 1)[row])[:, None]
        columns, rows = np.rint(a[row] + (b - a)[row] * share).astype(np.intp).T
        self.pixels[rows, columns] = (*color, 255)


def draw_cells(values: Float64Array) -> UInt8Array:
    """Draw the cells of a band, row 0 north, from the darkest tint to the lightest; NaN is clear.

    The picture has as many pixels as fit; of a larger band every n-th row and column is taken.
    """
    picture = np.zeros((*values.shape, 4), np.uint8)
    is_known = np.isfinite(values)
    picture[is_known, :3] = _find_tints(values[is_known])
    picture[is_known, 3] = 255
    times = max(1, min(SIZE[1] // values.shape[0], SIZE[0] // values.shape[1]))
    return picture.repeat(times, axis=0).repeat(times, axis=1)


def _find_tints(values: Float64Array) -> UInt8Array:
    """Return the hypsometric tint of each value."""
    ramp = interpolate_tints()
    values = np.nan_to_num(values)
    low, high = np.percentile(values, [1, 99]) if len(values) else (0.0, 0.0)
    with np.errstate(over="ignore", invalid="ignore"):
        share = (values - low) / (high - low) if high > low else np.full(len(values), 0.5)
    steps = np.clip(np.nan_to_num(share) * (len(ramp) - 1), 0, len(ramp) - 1)
    return ramp[steps.astype(np.intp)]
