"""A picture draped over a surface: its bytes, and the place in it of each vertex.

A GeoTIFF is read through GDAL in a child process, made smaller where graphics cards ask for that,
and becomes JPEG, or PNG where it is partly transparent. PNG and JPEG files go as they are, placed
by the world file beside them.
"""

from __future__ import annotations

import os
import struct
import warnings
from dataclasses import dataclass
from pathlib import Path
from typing import IO, TYPE_CHECKING

import numpy as np

from ... import _optional
from ...crs import CRS
from ...errors import CrsError, LossWarning, OptionError, ReadError
from ..isolated import run_isolated
from ..isolated.local_files import require_local
from .common import read_content

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ...tin import TIN

__all__ = ["MOST_PIXELS", "Texture", "load_texture"]

MOST_PIXELS = 8192
"""Widest and highest picture that graphics cards and WebGL take everywhere."""

_KINDS = {b"\x89PNG\r\n\x1a\n": "png", b"\xff\xd8\xff": "jpeg"}
_WORLD_SUFFIXES = {"png": (".pgw", ".pngw", ".wld"), "jpeg": (".jgw", ".jpgw", ".jpegw", ".wld")}
_SIZE_MARKERS = frozenset({*range(0xC0, 0xD0)} - {0xC4, 0xC8, 0xCC})
"""Segments of JPEG that tell the size of the picture."""

_OUTSIDE = 1e-6
"""Share of the picture beyond its edge that rounding of a world file explains."""


@dataclass(frozen=True, eq=False)
class Texture:
    """A picture with its places.

    Attributes
    ----------
    content : bytes
        A PNG or JPEG file.
    kind : {"png", "jpeg"}
    places : (n, 2) float64 array
        Of each vertex: from left to right and from top to bottom, 0 to 1 within the picture.
    """

    content: bytes
    kind: str
    places: NDArray[np.float64]

    @property
    def suffix(self) -> str:
        """Suffix of a file of this kind."""
        return ".png" if self.kind == "png" else ".jpg"


@dataclass(frozen=True)
class _Picture:
    """A picture, and the affine transform from columns and rows to eastings and northings."""

    content: bytes
    kind: str
    width: int
    height: int
    transform: tuple[float, ...]
    crs: CRS | None


def load_texture(source: str | os.PathLike[str], tin: TIN, *, stacklevel: int = 3) -> Texture:
    """Read the picture to drape over a TIN.

    Parameters
    ----------
    source : path-like
        A GeoTIFF, or a PNG or JPEG file with a world file beside it.
    tin : TIN
    stacklevel : int
        Of the caller who is told of losses.

    Raises
    ------
    OptionError
        If it is no path.
    ReadError
        If the file is missing, damaged, no picture, or has no place on the ground; or shows none of
        the surface.
    CrsError
        If it is in another CRS than the TIN.
    MissingExtraError
        If a GeoTIFF is given and rasterio is not installed.

    Warns
    -----
    LossWarning
        If the picture is made smaller, or does not reach over all of the surface.
    """
    path = _as_path(source)
    picture = _read_picture(path, stacklevel + 1)
    _require_same_crs(picture, tin, path)
    places = _find_places(picture, tin.points, path)
    used = places[np.unique(tin.triangles)]
    outside = ((used < -_OUTSIDE) | (used > 1.0 + _OUTSIDE)).any(axis=1)
    if outside.all():
        raise ReadError(f"'{path}' shows nothing of the surface: it lies elsewhere.", path=path)
    if outside.any():
        warnings.warn(
            f"'{path}' does not reach over {outside.mean():.1%} of the vertices: its edge is drawn "
            "out to them.",
            LossWarning,
            stacklevel=stacklevel,
        )
    return Texture(picture.content, picture.kind, places)


def _as_path(source: object) -> Path:
    if not isinstance(source, str | os.PathLike):
        raise OptionError("texture", source, "the path of a GeoTIFF, PNG or JPEG file")
    require_local(source)
    return Path(source)


def _read_picture(path: Path, stacklevel: int) -> _Picture:
    if path.is_dir():
        raise ReadError(f"'{path}' is a folder: name a picture in it.", path=path)
    with _open(path) as file:
        head = file.read(16)
    kind = next((kind for start, kind in _KINDS.items() if head.startswith(start)), None)
    return _read_georeferenced(path, stacklevel) if kind is None else _read_plain(path, kind)


def _open(path: Path) -> IO[bytes]:
    try:
        return path.open("rb")
    except OSError as error:
        raise ReadError(f"Cannot read '{path}': {error.strerror or error}.", path=path) from error


def _read_georeferenced(path: Path, stacklevel: int) -> _Picture:
    _optional.require("rasterio", "Reading a texture that is no PNG or JPEG file")
    where = {"path": os.path.abspath(path), "shown": str(path), "most_pixels": MOST_PIXELS}  # noqa: PTH100
    value, arrays = run_isolated(f"{__package__}.texture_child:read_picture", where, path=path)
    if value["transform"] is None:
        raise ReadError(f"'{path}' has no place on the ground: it is not georeferenced.", path=path)
    rows, columns = value["shape"]
    if (rows, columns) != (value["height"], value["width"]):
        warnings.warn(
            f"'{path}' was made smaller, from {value['width']} x {value['height']} to {columns} x "
            f"{rows} pixels: graphics cards take no larger ones.",
            LossWarning,
            stacklevel=stacklevel + 1,
        )
    return _Picture(
        arrays["content"].tobytes(),
        value["kind"],
        value["width"],
        value["height"],
        tuple(value["transform"]),
        CRS.of(value["crs"]),
    )


def _read_plain(path: Path, kind: str) -> _Picture:
    """Return a PNG or JPEG file as it is, placed by its world file."""
    content = read_content(path)
    size = _find_png_size(content) if kind == "png" else _find_jpeg_size(content)
    if size is None or min(size) < 1:
        raise ReadError(f"'{path}' is a damaged {kind.upper()} file: it tells no size.", path=path)
    world = next(
        (one for suffix in _WORLD_SUFFIXES[kind]
         for one in (path.with_suffix(suffix), path.with_suffix(suffix.upper()))
         if one.is_file()),
        None,
    )  # fmt: skip
    if world is None:
        names = ", ".join(path.with_suffix(one).name for one in _WORLD_SUFFIXES[kind])
        raise ReadError(
            f"'{path}' has no place on the ground: there is no world file beside it ({names}).",
            path=path,
        )
    return _Picture(content, kind, *size, _read_world_file(world), None)


def _find_png_size(content: bytes) -> tuple[int, int] | None:
    if content[12:16] != b"IHDR" or len(content) < 24:
        return None
    width, height = struct.unpack(">II", content[16:24])
    return width, height


def _find_jpeg_size(content: bytes) -> tuple[int, int] | None:
    """Walk the segments of a JPEG file up to the one that tells its size."""
    at = 2
    while at + 9 <= len(content) and content[at] == 0xFF:
        marker = content[at + 1]
        if marker in _SIZE_MARKERS:
            height, width = struct.unpack(">HH", content[at + 5 : at + 9])
            return width, height
        if marker == 0xFF or marker == 0x01 or 0xD0 <= marker <= 0xD8:
            at += 1 if marker == 0xFF else 2
        else:
            at += 2 + int.from_bytes(content[at + 2 : at + 4], "big")
    return None


def _read_world_file(path: Path) -> tuple[float, ...]:
    """Return the transform of a world file, which places the centre of the first pixel."""
    words = read_content(path).decode("latin-1").replace(",", ".").split()
    try:
        a, d, b, e, x, y = (float(word) for word in words)
    except ValueError:
        raise ReadError(
            f"'{path}' is no world file: six numbers are needed, and it has "
            f"{' '.join(words)[:60]!r}.",
            path=path,
        ) from None
    return a, b, x - (a + b) / 2, d, e, y - (d + e) / 2


def _require_same_crs(picture: _Picture, tin: TIN, path: Path) -> None:
    if picture.crs is None or tin.crs is None:
        return
    if not picture.crs.horizontal.is_same(tin.crs.horizontal):
        raise CrsError(
            f"'{path}' is in {picture.crs.label}, and the TIN in {tin.crs.label}: bring the "
            "picture to the CRS of the TIN first (gdalwarp -t_srs).",
            crs=picture.crs,
        )


def _find_places(picture: _Picture, points: NDArray[np.float64], path: Path) -> NDArray[np.float64]:
    """Return where in the picture each vertex lies."""
    a, b, x, d, e, y = picture.transform
    area = a * e - b * d
    if not np.isfinite([*picture.transform]).all() or area == 0.0:
        raise ReadError(f"'{path}' has no place on the ground: its pixels have no area.", path=path)
    along, up = points[:, 0] - x, points[:, 1] - y
    columns, rows = (e * along - b * up) / area, (a * up - d * along) / area
    return np.column_stack([columns / picture.width, rows / picture.height])
