"""Archives of terrain tiles, read by the library of PMTiles and by SQLite."""

from __future__ import annotations

import sqlite3
from contextlib import closing
from io import BytesIO
from typing import Any

import numpy as np
import pyproj
from PIL import Image

SIDE = 512
WORLD = 2 * np.pi * 6_378_137.0
STEPS = {"terrarium": 1 / 256, "mapbox": 0.1}


def read_archive(path) -> tuple[dict[str, Any], dict[tuple[int, int, int], bytes]]:
    """Return the metadata, and tiles by zoom, column and row from the north."""
    if path.suffix == ".pmtiles":
        from pmtiles.reader import MemorySource, Reader, all_tiles

        source = MemorySource(path.read_bytes())
        return Reader(source).metadata(), dict(all_tiles(source))
    with closing(sqlite3.connect(path)) as base:
        rows = base.execute("SELECT * FROM tiles").fetchall()
        about = dict(base.execute("SELECT * FROM metadata"))
    return about, {(z, x, 2**z - 1 - row): content for z, x, row, content in rows}


def decode(content: bytes, encoding: str):
    """Return elevations as MapLibre unpacks them; NaN where a pixel is transparent."""
    pixels = np.asarray(Image.open(BytesIO(content))).astype(float)
    assert pixels.shape[:2] == (SIDE, SIDE)
    red, green, blue = (pixels[..., k] for k in range(3))
    if encoding == "terrarium":
        values = red * 256 + green + blue / 256 - 32_768
    else:
        values = red * 6553.6 + green * 25.6 + blue * 0.1 - 10_000
    return values if pixels.shape[2] == 3 else np.where(pixels[..., 3] > 0, values, np.nan)


def locate(place: tuple[int, int, int], crs: str):
    """Return eastings and northings of the centres of a tile's pixels."""
    z, x, y = place
    pixel = WORLD / 2**z / SIDE
    east = (x * SIDE + np.arange(SIDE) + 0.5) * pixel - WORLD / 2
    north = WORLD / 2 - (y * SIDE + np.arange(SIDE) + 0.5) * pixel
    to_crs = pyproj.Transformer.from_crs("EPSG:3857", crs, always_xy=True)
    return to_crs.transform(*np.meshgrid(east, north))


def interpolate(values, grid, x, y):
    """Return the bilinear value between the centres of four cells; NaN beyond the outermost."""
    column = (x - grid.bounds.xmin) / grid.spacing - 0.5
    row = (grid.bounds.ymax - y) / grid.spacing - 0.5
    i = np.clip(np.floor(row).astype(int), 0, grid.shape[0] - 2)
    j = np.clip(np.floor(column).astype(int), 0, grid.shape[1] - 2)
    u, v = row - i, column - j
    found = (
        values[i, j] * (1 - u) * (1 - v)
        + values[i + 1, j] * u * (1 - v)
        + values[i, j + 1] * (1 - u) * v
        + values[i + 1, j + 1] * u * v
    )
    return np.where((u >= 0) & (u <= 1) & (v >= 0) & (v <= 1), found, np.nan)
