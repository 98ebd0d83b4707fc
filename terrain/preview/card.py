"""Card: what a notebook shows of a TIN - its figures, and a small map of its relief."""

from __future__ import annotations

import base64
import math
import struct
import zlib
from html import escape
from typing import TYPE_CHECKING

import numpy as np

from ..._sentences import counted
from ..units import find_ground
from .scene import NORTHWEST, choose_exaggeration, measure_relief
from .tints import interpolate_tints

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from ...tin import TIN
    from ..units import Ground

__all__ = ["draw_map", "encode_png", "make_card"]

_SIZE = (320, 240)
"""Greatest width and height of the map, pixels."""

_TINTS = 256
_AMBIENT, _BRIGHTEST = 0.42, 1.35
"""Share of the light that falls everywhere, and the most of the rest, as in a page's still."""

_COMPRESSION = 3
_MOST_WRITTEN = 1e12
_STEEPEST = 1e6
"""Rise over run, beyond which light is the same."""

_BORDER = "1px solid rgba(128, 128, 128, 0.4)"


def make_card(tin: TIN) -> str:
    """Return the HTML of a card: counts, CRS, units, bounds, and a map with hillshade.

    Parameters
    ----------
    tin : TIN

    Returns
    -------
    str
        Of one element, with the map as a PNG within; nothing is asked for. Colours of words are
        those of the notebook's theme.
    """
    picture = base64.b64encode(encode_png(draw_map(tin))).decode("ascii")
    rows = "".join(
        f'<tr style="background: none"><td style="text-align: left; opacity: 0.7">{escape(name)}'
        f'</td><td style="text-align: left">{escape(value)}</td></tr>'
        for name, value in _describe(tin)
    )
    return (
        f'<div style="display: inline-flex; gap: 16px; align-items: center; flex-wrap: wrap; '
        f'border: {_BORDER}; border-radius: 6px; padding: 10px 14px">'
        f'<img alt="Map of the surface, north up" src="data:image/png;base64,{picture}">'
        f'<div><strong>TIN</strong><table style="margin: 4px 0 0 0">{rows}</table></div></div>'
    )


def _describe(tin: TIN) -> Iterator[tuple[str, str]]:
    """Return the rows of the card: names and values."""
    counts = counted(len(tin.points), "vertex", "vertices")
    yield "Surface", f"{counts}, {counted(len(tin.triangles), 'triangle')}"
    if len(tin.lines.kinds):
        yield "Lines", counted(len(tin.lines.kinds), "line")
    yield "CRS", "not known" if tin.crs is None else tin.crs.caption
    units = [tin.crs.horizontal_unit if tin.crs is not None else None, tin.elevation_unit]
    across, up = ("not known" if unit is None else unit.name for unit in units)
    yield "Units", across if across == up else f"{across}, elevations {up}"
    low, high = tin.points.min(axis=0).tolist(), tin.points.max(axis=0).tolist()
    for name, start, stop in zip(("Easting", "Northing", "Elevation"), low, high, strict=True):
        yield name, f"{_write(start, stop - start)} to {_write(stop, stop - start)}"


def _write(value: float, span: float) -> str:
    """Write a coordinate with the decimals that tell a thousandth of a span."""
    if abs(value) >= _MOST_WRITTEN:
        return f"{value:g}"
    decimals = 3 if span <= 0 else min(max(2 - math.floor(math.log10(span)), 0), 9)
    return f"{value:,.{decimals}f}"


def draw_map(tin: TIN, *, size: tuple[int, int] = _SIZE) -> NDArray[np.uint8]:
    """Draw a surface from above, north up, with hypsometric tints and hillshade.

    Parameters
    ----------
    tin : TIN
    size : tuple of int, optional
        Greatest width and height, pixels.

    Returns
    -------
    (height, width, 4) uint8 array
        Red, green, blue and opacity, row 0 north; clear where there is no surface.
    """
    with np.errstate(over="ignore", invalid="ignore"):  # outside, and beyond all real elevations
        return _draw(tin, size)


def _draw(tin: TIN, size: tuple[int, int]) -> NDArray[np.uint8]:
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


def _sample(tin: TIN, ground: Ground, size: tuple[int, int]) -> tuple[NDArray[np.float64], float]:
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


def _shade(heights: NDArray[np.float64], pixel: float) -> NDArray[np.float64]:
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
    lit: NDArray[np.float64] = _AMBIENT + (1.0 - _AMBIENT) * np.clip(
        cosine / towards[2], 0.0, _BRIGHTEST
    )
    return lit


def _limit(slopes: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.clip(np.nan_to_num(slopes), -_STEEPEST, _STEEPEST)


def encode_png(picture: NDArray[np.uint8]) -> bytes:
    """Return a PNG of an (height, width, 4) picture: each byte as its step from the pixel before.

    Parameters
    ----------
    picture : (height, width, 4) uint8 array
        Red, green, blue and opacity.
    """
    height, width, _ = picture.shape
    steps = picture.copy()
    steps[:, 1:] -= picture[:, :-1]
    rows = np.full((height, 1 + 4 * width), 1, np.uint8)  # filter 1 of the standard, "Sub"
    rows[:, 1:] = steps.reshape(height, -1)
    header = struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0)
    data = zlib.compress(rows.tobytes(), _COMPRESSION)
    chunks = ((b"IHDR", header), (b"IDAT", data), (b"IEND", b""))
    return b"\x89PNG\r\n\x1a\n" + b"".join(_make_chunk(*chunk) for chunk in chunks)


def _make_chunk(kind: bytes, data: bytes) -> bytes:
    check = struct.pack(">I", zlib.crc32(kind + data))
    return struct.pack(">I", len(data)) + kind + data + check
