"""A picture draped over a surface: its bytes, and the place in it of each vertex.

A GeoTIFF is read as for a preview, and becomes JPEG, or PNG where it is partly transparent. PNG and
JPEG files go as they are, placed by the world file beside them.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ...base.errors import ReadError
from ...base.notes import warn
from ...terrain.viewer import Ortho
from ..raster import as_picture_path, read_ortho
from .common import read_content

if TYPE_CHECKING:
    import os

    from ...base.arrays import Float64Array
    from ...tin import TIN

MOST_PIXELS = 8192
"""Widest and highest picture that graphics cards and WebGL take everywhere."""

_KINDS = {b"\x89PNG\r\n\x1a\n": "png", b"\xff\xd8\xff": "jpeg"}
_WORLD_SUFFIXES = {"png": (".pgw", ".pngw", ".wld"), "jpeg": (".jgw", ".jpgw", ".jpegw", ".wld")}
_SIZE_MARKERS = frozenset({*range(0xC0, 0xD0)} - {0xC4, 0xC8, 0xCC})
"""Segments of JPEG that tell the size of the picture."""

_BEYOND = "its edge is drawn out to them"


@dataclass(frozen=True, eq=False)
class Texture:
    """A picture with its places."""

    content: bytes
    """A PNG or JPEG file."""
    kind: str
    """Either "png" or "jpeg"."""
    places: Float64Array
    """(n, 2), of each vertex from left to right and from top to bottom, 0 to 1 in the picture."""

    @property
    def suffix(self) -> str:
        """Suffix of a file of this kind."""
        return ".png" if self.kind == "png" else ".jpg"


def load_texture(source: str | os.PathLike[str], tin: TIN) -> Texture:
    """Read the picture to drape over a TIN: a GeoTIFF, or PNG or JPEG with a world file beside it.

    Errors and warnings are those of :func:`.read_ortho`.
    """
    path = as_picture_path(source, "ortho")
    with path.open("rb") as file:
        head = file.read(16)
    kind = next((kind for start, kind in _KINDS.items() if head.startswith(start)), None)
    if kind is None:
        ortho = read_ortho(path, [tin], most_pixels=MOST_PIXELS, beyond=_BEYOND)
    else:
        content = read_content(path)
        size = _find_png_size(content) if kind == "png" else _find_jpeg_size(content)
        if size is None or min(size) < 1:
            raise ReadError(
                f"'{path}' is a damaged {kind.upper()} file: it tells no size.", path=path
            )
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
        width, height = size
        words = read_content(world).decode("latin-1").replace(",", ".").split()
        try:
            a, d, b, e, x, y = (float(word) for word in words)
        except ValueError:
            raise ReadError(
                f"'{world}' is no world file: six numbers are needed, and it has "
                f"{' '.join(words)[:60]!r}.",
                path=world,
            ) from None
        ortho = Ortho(
            path, content, kind, (height, width), (a, b, x - (a + b) / 2, d, e, y - (d + e) / 2)
        )
        if gap := ortho.measure_gap([tin]):
            warn(f"'{path}' does not reach over {gap:.1%} of the vertices: {_BEYOND}.")
    return Texture(ortho.content, ortho.kind, ortho.place(tin.points))


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
