"""HTML representation of a TIN for notebooks: its figures, and a small map of its relief."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from ...base.georeference import find_ground
from ...base.products import product
from ...base.sentences import counted
from ..drawing import draw_north_up, interpolate_tints
from ..drawing.html_repr.frame import SIZE, describe_bounds, name_crs, name_units, write_html
from ..surface import NORTHWEST
from .relief import choose_exaggeration, measure_relief

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ...base.arrays import Float64Array, UInt8Array
    from ...base.georeference import Ground
    from ...tin import TIN

_TINTS = 256
_AMBIENT, _BRIGHTEST = 0.42, 1.35
"""Share of the light that falls everywhere, and the most of the rest, as in a page's still."""

_STEEPEST = 1e6
"""Rise over run, beyond which light is the same."""


@product
def make_html_repr(tin: TIN) -> str:
    """Return HTML: counts, CRS, units, bounds, and a map with hillshade.

    It is of one element, with the map as a PNG within; nothing is asked for. Colours of words are
    those of the notebook's theme.
    """
    picture = draw_map(tin)
    return write_html("TIN", _describe(tin), picture=picture, alt="Map of the surface, north up")


def _describe(tin: TIN) -> Iterator[tuple[str, str]]:
    """Return the rows: names and values."""
    counts = counted(len(tin.points), "vertex", "vertices")
    yield "Surface", f"{counts}, {counted(len(tin.triangles), 'triangle')}"
    if len(tin.lines.kinds):
        yield "Lines", counted(len(tin.lines.kinds), "line")
    yield "CRS", name_crs(tin.crs)
    yield "Units", name_units(tin.crs, tin.elevation_unit)
    yield from describe_bounds(tin.points, tin.crs)


def draw_map(tin: TIN, *, size: tuple[int, int] = SIZE) -> UInt8Array:
    """Draw a surface from above, north up, with hypsometric tints and hillshade.

    ``size`` is the greatest width and height, pixels. Returns (height, width, 4): red, green, blue
    and opacity, row 0 north; clear where there is no surface.
    """
    with np.errstate(over="ignore", invalid="ignore"):  # outside, and beyond all real elevations
        return _draw(tin, size)


def _draw(tin: TIN, size: tuple[int, int]) -> UInt8Array:
    tin = draw_north_up(tin)
    ground = find_ground(tin)
    heights, pixel = _sample(tin, ground, size)
    shown = measure_relief(tin, ground)
    span = shown.high - shown.low
    share = np.nan_to_num((heights - shown.low) / span) if span > 0 else np.full(heights.shape, 0.5)
    tints = interpolate_tints(_TINTS)[np.clip(share * (_TINTS - 1), 0, _TINTS - 1).astype(np.intp)]
    factor = ground.scale[2] * choose_exaggeration(tin, ground, shown)
    light = _shade(np.clip(heights, shown.low, shown.high) * factor, pixel)
    picture = np.empty((*heights.shape, 4), np.uint8)
    picture[..., :3] = np.clip(np.rint(tints * light[..., None]), 0, 255)
    picture[..., 3] = np.where(np.isnan(heights), 0, 255)
    return picture


def _sample(tin: TIN, ground: Ground, size: tuple[int, int]) -> tuple[Float64Array, float]:
    """Return the elevations at the centres of square pixels, and how wide these are on the ground.

    The surface is asked place by place: that takes as long for many triangles as for few.
    """
    bounds = tin.bounds
    width, height = bounds.width * ground.scale[0], bounds.height * ground.scale[1]
    pixel = max(width / size[0], height / size[1])
    columns, rows = (max(1, math.ceil(side / pixel - 1e-9)) for side in (width, height))
    x = bounds.xmin + (np.arange(columns) + 0.5) * (bounds.width / columns)
    y = bounds.ymax - (np.arange(rows) + 0.5) * (bounds.height / rows)
    places = np.column_stack([np.tile(x, rows), np.repeat(y, columns)])
    return tin.interpolate(places).reshape(rows, columns), pixel


def _shade(heights: Float64Array, pixel: float) -> Float64Array:
    """Return the light on each pixel, 1 on level ground."""
    east, south = np.zeros_like(heights), np.zeros_like(heights)
    if heights.shape[1] > 1:
        east = _limit(np.gradient(heights, pixel, axis=1))
    if heights.shape[0] > 1:
        south = _limit(np.gradient(heights, pixel, axis=0))
    turn, rise = math.radians(NORTHWEST.azimuth), math.radians(NORTHWEST.altitude)
    towards = math.sin(turn) * math.cos(rise), math.cos(turn) * math.cos(rise), math.sin(rise)
    cosine = (towards[2] - east * towards[0] + south * towards[1]) / np.sqrt(
        1.0 + east**2 + south**2
    )
    lit: Float64Array = _AMBIENT + (1.0 - _AMBIENT) * np.clip(cosine / towards[2], 0.0, _BRIGHTEST)
    return lit


def _limit(slopes: Float64Array) -> Float64Array:
    return np.clip(np.nan_to_num(slopes), -_STEEPEST, _STEEPEST)
