"""Frame of HTML: a title, rows of names and values, a picture; all words escaped."""

from __future__ import annotations

import base64
import math
import struct
import zlib
from html import escape
from typing import TYPE_CHECKING

import numpy as np

from ....base.georeference import find_axes

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from ....base.arrays import Float64Array, UInt8Array
    from ....base.crs import CRS, Unit

SIZE = (320, 240)
"""Greatest width and height of a picture, pixels."""

_MOST_BYTES = 100_000
"""Of a picture; a larger one is drawn with half the pixels, which shown as large."""

_LONGEST = 200
"""Letters of a value; names of files and columns may be of any length."""

_COMPRESSION = 3
_MOST_WRITTEN = 1e12
_BORDER = "1px solid rgba(128, 128, 128, 0.4)"
_LEFT = "text-align: left"
_CELL = "text-align: right; padding: 2px 8px; white-space: nowrap"


def write_html(
    title: str,
    rows: Iterable[tuple[str, str]],
    *,
    picture: UInt8Array | None = None,
    alt: str = "",
    below: str = "",
) -> str:
    """Return HTML, of one element that asks for nothing.

    ``rows`` are names and values, of any letters; the picture is (height, width, 4), and ``alt``
    what it shows; ``below`` is HTML that follows the rows. Colours of words are those of the
    notebook's theme.
    """
    image = "" if picture is None else _write_image(picture, alt)
    written = "".join(
        f'<tr style="background: none"><td style="{_LEFT}; vertical-align: top; opacity: 0.7">'
        f'{_write_words(name)}</td><td style="{_LEFT}; overflow-wrap: anywhere">'
        f"{_write_words(value)}</td></tr>"
        for name, value in rows
    )
    table = f'<table style="margin: 4px 0 0 0">{written}</table>' if written else ""
    return (
        f'<div style="display: inline-flex; gap: 16px; align-items: center; flex-wrap: wrap; '
        f"max-width: 100%; box-sizing: border-box; border: {_BORDER}; border-radius: 6px; "
        f'padding: 10px 14px">{image}<div style="min-width: 0"><strong>{_write_words(title)}'
        f"</strong>{table}{below}</div></div>"
    )


def write_table(header: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return the HTML of a table that scrolls sideways where it is wide."""
    head = "".join(f'<th style="{_CELL}">{_write_words(name)}</th>' for name in header)
    body = "".join(f"<tr>{_write_cells(row)}</tr>" for row in rows)
    return (
        '<div style="overflow-x: auto; margin-top: 6px"><table style="margin: 0"><thead>'
        f"<tr>{head}</tr></thead><tbody>{body}</tbody></table></div>"
    )


def _write_cells(row: Sequence[str]) -> str:
    return "".join(f'<td style="{_CELL}">{_write_words(value)}</td>' for value in row)


def _write_words(words: str) -> str:
    return escape(words if len(words) <= _LONGEST else f"{words[:_LONGEST]}...")


def _write_image(picture: UInt8Array, alt: str) -> str:
    height, width, _ = picture.shape
    data = encode_png(picture)
    if len(data) > _MOST_BYTES:
        data = encode_png(np.ascontiguousarray(picture[::2, ::2]))
    source = base64.b64encode(data).decode("ascii")
    return (
        f'<img alt="{escape(alt)}" width="{width}" height="{height}" style="max-width: 100%; '
        f'height: auto" src="data:image/png;base64,{source}">'
    )


# ---------------------------------------------------------------------------------- values


def name_crs(crs: CRS | None) -> str:
    """Return the name of a CRS."""
    return "not known" if crs is None else crs.caption


def name_unit(crs: CRS | None) -> str:
    """Return the name of the unit of eastings and northings."""
    return _name(crs.horizontal_unit if crs is not None else None)


def _name(unit: Unit | None) -> str:
    return "not known" if unit is None else unit.name


def name_units(crs: CRS | None, elevation_unit: Unit | None) -> str:
    """Return the unit of eastings and northings, and that of elevations if it is another one."""
    across, up = name_unit(crs), _name(elevation_unit)
    return across if across == up else f"{across}, elevations {up}"


def describe_bounds(points: Float64Array, crs: CRS | None) -> list[tuple[str, str]]:
    """Return rows with the range of each coordinate; none of coordinates that are not known."""
    names = (*(f"{one.capitalize()}ing" for one in find_axes(crs)), "Elevation")
    known = {name: values[~np.isnan(values)] for name, values in zip(names, points.T, strict=False)}
    return [(name, write_range(values)) for name, values in known.items() if len(values)]


def write_range(values: Float64Array) -> str:
    """Write the least and the greatest of some numbers."""
    low, high = float(values.min()), float(values.max())
    return f"{_write_number(low, high - low)} to {_write_number(high, high - low)}"


def _write_number(value: float, span: float) -> str:
    """Write a number with the decimals that tell a thousandth of a span."""
    if abs(value) >= _MOST_WRITTEN or not math.isfinite(span):
        return f"{value:g}"
    decimals = 3 if span <= 0 else min(max(2 - math.floor(math.log10(span)), 0), 9)
    return f"{value:,.{decimals}f}"


# ------------------------------------------------------------------------------------- PNG


def encode_png(picture: UInt8Array) -> bytes:
    """Return a PNG of a (height, width, 4) picture: each byte as its step from the pixel before.

    Bands are red, green, blue and opacity.
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
