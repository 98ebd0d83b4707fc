"""Read one tile of quantized-mesh 1.0: longitude, latitude and height above the ellipsoid."""

from __future__ import annotations

import math
import re
import zlib
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ....base.errors import OptionError, ReadError
from ....base.sentences import FILE
from ..common import Mesh, join_places, mesh_reader, read_content
from .tile import STEPS, BrokenTileError, TileName, decode_tile

if TYPE_CHECKING:
    from pathlib import Path

    from .tile import TileName

_NAME = re.compile(r"(\d{1,2})/(\d{1,9})/(\d{1,9})")
_MOST_LEVEL = 30
_GZIP = b"\x1f\x8b"
_LARGEST = 1 << 28
_HEIGHTMAP_BYTES = 65 * 65 * 2


@mesh_reader
def read(path: Path, *, tile: str | None = None) -> Mesh:
    """Read a tile, gzipped or not, in longitude, latitude and metres above the ellipsoid.

    A tile of a pyramid of web Mercator, by the centre that its header tells, is in EPSG:3857; the
    report tells it. A CRS or unit that is given must be that and the metre. Triangles that rounding
    left without area or turned over are left out and told. Normals, water and other extensions are
    skipped.

    Parameters
    ----------
    tile : str, optional
        Where it lies, "level/column/row", rows from the south; default what the path says.
    """
    name = _find_name(path, tile)
    content = _unzip(read_content(path))
    try:
        found = decode_tile(content)
    except BrokenTileError as error:
        why = str(error)
        if _HEIGHTMAP_BYTES < len(content) <= _HEIGHTMAP_BYTES + 2 + 65536:
            why += "; it may be one of the older format heightmap-1.0, which is not read"
        raise ReadError(f"{FILE} is no sound quantized-mesh tile: {why}.") from None
    placing = find_placing(found.center, name, is_declared=tile is not None)
    steps, number = join_places(found.steps)  # at one place and height
    triangles = number[found.triangles]
    places = replace(found, steps=steps).place(placing.west, placing.south, placing.width)
    if len(triangles) == 0:
        raise ReadError(f"{FILE} is a tile without any triangle.")
    return Mesh(
        places,
        triangles.ravel(),
        np.arange(0, triangles.size + 1, 3),
        crs=placing.crs,
        elevation_unit=placing.unit,
        notes=placing.notes,
        rounding=placing.width / STEPS,
    )


def _find_name(path: Path, tile: str | None) -> TileName:
    text = path.with_suffix("").absolute().as_posix() if tile is None else tile
    parts = text.rsplit("/", 3)[-3:]
    found = _NAME.fullmatch("/".join(parts)) if isinstance(tile, str | None) else None
    if found is not None:
        level, x, y = (int(number) for number in found.groups())
        if level <= _MOST_LEVEL and x < 2 ** (level + 1) and y < 2**level:
            return TileName(level, x, y)
    if tile is None:
        raise ReadError(
            f"{FILE} does not tell where the tile lies: a path that ends in "
            "level/column/row.terrain does, or tell it as tile."
        )
    raise OptionError("tile", tile, "level/column/row of a tile, such as '14/17000/12000'")


def _unzip(content: bytes) -> bytes:
    """Return the content of a gzipped file, no more than a tile can have."""
    if not content.startswith(_GZIP):
        return content
    opened = zlib.decompressobj(wbits=31)
    try:
        plain = opened.decompress(content, _LARGEST)
    except zlib.error as error:
        raise ReadError(f"{FILE} is a damaged gzip file: {error}.") from None
    if not opened.eof:
        raise ReadError(f"{FILE} is a gzip file that ends early, or no tile.")
    return plain


HALF_WORLD = 20_037_508.342789244
"""Half the width of the world in web Mercator, metres."""

_LEAST_RADIUS, _MOST_RADIUS = 6.2e6, 6.6e6
"""Metres from the centre of the Earth between which its surface lies."""

_LEAST_FLAT = 4
"""The level from which the middle of a tile lies near the surface, wherever a program puts it."""

_EXACTLY = 1e-3
"""Widths of a tile within which a centre is that of the tile."""


class Placing(NamedTuple):
    """The rectangle that a tile covers, and the CRS of its coordinates."""

    west: float
    south: float
    width: float
    crs: str = "EPSG:4979"
    unit: str | None = None
    """Of heights, where the CRS does not tell."""
    notes: tuple[str, ...] = ()


def find_placing(
    center: tuple[float, float, float], name: TileName, *, is_declared: bool
) -> Placing:
    """Return where a tile of a name lies, by the centre that its header tells."""
    west, south, east, _ = name.bounds
    globe = Placing(west, south, east - west)
    if not any(center):
        note = "The header of the tile does not tell where it lies: taken to be one of the globe."
        return globe._replace(notes=(note,))
    mercator = _place_in_mercator(name)
    if _find_distance(center[:2], mercator) <= _EXACTLY:
        return mercator
    x, y, z = center
    least = _LEAST_RADIUS if name.level >= _LEAST_FLAT else 0.0
    if not least < math.hypot(x, y, z) < _MOST_RADIUS:
        degrees = None
    else:
        squeeze = 1 - (1 - 1 / 298.257223563) ** 2
        degrees = (
            math.degrees(math.atan2(y, x)),
            math.degrees(math.atan2(z, math.hypot(x, y) * (1 - squeeze))),
        )
    if degrees is not None and _find_distance(degrees, globe) <= 0.5 + _EXACTLY:
        return globe
    if degrees is None and _find_distance(center[:2], mercator) <= 0.5 + _EXACTLY:
        return mercator
    if degrees is not None:
        shown = f"longitude {degrees[0]:.6f}, latitude {degrees[1]:.6f}"
    else:
        shown = f"({', '.join(f'{one:,.1f}' for one in center)})"
    # Name the tile of the level in which the centre lies, if rows are counted from the north.
    world = (
        Placing(-180.0, -90.0, name.width)
        if degrees is not None
        else _place_in_mercator(type(name)(name.level, 0, 0))
    )
    place = center if degrees is None else degrees
    x, y = (math.floor((one - low) / world.width)
            for one, low in zip(place[:2], (world.west, world.south), strict=True))  # fmt: skip
    if not (0 <= y < 2**name.level and 0 <= x < 2 ** (name.level + (degrees is not None))):
        advice = ""
    else:
        counted = "rows are counted from the south, and " if y == 2**name.level - 1 - name.y else ""
        advice = f": {counted}tile='{name.level}/{x}/{y}' is where it lies"
    fault = (
        f"the centre that the header tells, {shown}, does not lie in tile "
        f"{name.level}/{name.x}/{name.y}, neither of longitude and latitude nor of web Mercator"
        f"{advice}"
    )
    if is_declared:
        return globe._replace(notes=(f"The tile lies where it is declared to lie, and {fault}.",))
    raise ReadError(f"{fault}.")


def _place_in_mercator(name: TileName) -> Placing:
    width = 2 * HALF_WORLD / 2**name.level
    note = (
        "By the centre that its header tells, the tile is one of a pyramid of web Mercator: its "
        "coordinates are those of EPSG:3857."
    )
    west, south = name.x * width - HALF_WORLD, name.y * width - HALF_WORLD
    return Placing(west, south, width, "EPSG:3857", "metre", (note,))


def _find_distance(place: tuple[float, ...], placing: Placing) -> float:
    """Return how far a place lies from the middle of a rectangle, in widths."""
    away = (place[0] - placing.west, place[1] - placing.south)
    return max(abs(one / placing.width - 0.5) for one in away)
