"""Read one tile of quantized-mesh 1.0: longitude, latitude and height above the ellipsoid."""

from __future__ import annotations

import re
import zlib
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from ....base.errors import OptionError, ReadError
from ....base.sentences import FILE
from ..common import Mesh, join_places, mesh_reader, read_content
from .placing import find_placing
from .tile import STEPS, BrokenTileError, TileName, decode_tile

if TYPE_CHECKING:
    from pathlib import Path


__all__ = ["read"]

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
        raise ReadError(_describe_fault(content, str(error))) from None
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


def _describe_fault(content: bytes, why: str) -> str:
    if _HEIGHTMAP_BYTES < len(content) <= _HEIGHTMAP_BYTES + 2 + 65536:
        why += "; it may be one of the older format heightmap-1.0, which is not read"
    return f"{FILE} is no sound quantized-mesh tile: {why}."
