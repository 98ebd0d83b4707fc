"""The bytes of a text file as UTF-8 lines, each with its number and kind."""

from __future__ import annotations

import codecs
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from ...base.errors import ReadError
from ...base.sentences import FILE

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    from ...base.arrays import BoolArray, Int64Array, UInt8Array

__all__ = ["COMMENT_PREFIXES", "TextLines", "decode_head", "read_lines"]

COMMENT_PREFIXES = ("#", "//", ";", "!", "%")

_BOMS = (
    (codecs.BOM_UTF8, "utf-8"),
    (codecs.BOM_UTF32_LE, "utf-32-le"),
    (codecs.BOM_UTF32_BE, "utf-32-be"),
    (codecs.BOM_UTF16_LE, "utf-16-le"),
    (codecs.BOM_UTF16_BE, "utf-16-be"),
)
_SPACE, _TAB, _LINE_FEED = 32, 9, 10
_PROBE = 4096
_LONGEST_LINE = 1_000_000


@dataclass(frozen=True, eq=False)
class TextLines:
    r"""Text in UTF-8 whose lines end with ``"\n"``, and where its lines are."""

    data: bytes
    starts: Int64Array
    """(k,), the first byte of every line."""
    ends: Int64Array
    """(k,), the byte behind its last one, without the line end."""
    is_whole: bool
    """Whether the last line has an end, too."""

    @classmethod
    def of(cls, data: bytes) -> TextLines:
        r"""Find the lines of UTF-8 text; every customary line end becomes ``"\n"``."""
        if b"\r" in data:
            data = data.replace(b"\r\r\n", b"\n").replace(b"\r\n", b"\n").replace(b"\r", b"\n")
        breaks = np.flatnonzero(np.frombuffer(data, np.uint8) == _LINE_FEED)
        is_whole = data.endswith(b"\n")
        starts = np.concatenate([[0], breaks + 1])
        ends = np.append(breaks, len(data))
        n_lines = len(ends) - is_whole
        return cls(data, starts[:n_lines], ends[:n_lines], is_whole)

    def __len__(self) -> int:
        return len(self.starts)

    @property
    def codes(self) -> UInt8Array:
        """The bytes as numbers."""
        return np.frombuffer(self.data, np.uint8)

    def decode_line(self, line: int) -> str:
        """Return one line; ``line`` counts from 0."""
        return self.data[self.starts[line] : self.ends[line]].decode()

    def decode_lines(self, lines: Iterable[int]) -> list[str]:
        """Return some lines."""
        return [self.decode_line(line) for line in lines]

    @cached_property
    def firsts(self) -> Int64Array:
        """First byte of every line that is no space or tab; the line's end where there is none."""
        codes = self.codes
        firsts = self.starts.copy()
        active = np.flatnonzero(firsts < self.ends)
        while len(active):
            found = codes[firsts[active]]
            active = active[(found == _SPACE) | (found == _TAB)]
            firsts[active] += 1
            active = active[firsts[active] < self.ends[active]]
        return firsts

    @cached_property
    def is_blank(self) -> BoolArray:
        """Whether a line holds nothing but spaces and tabs, (k,) array."""
        blank: BoolArray = self.firsts == self.ends
        return blank

    @cached_property
    def first_codes(self) -> UInt8Array:
        """The byte at ``firsts``, (k,) array; 0 where a line is blank."""
        codes = np.zeros(len(self), np.uint8)
        filled = np.flatnonzero(~self.is_blank)
        codes[filled] = self.codes[self.firsts[filled]]
        return codes

    def starts_with(self, prefix: str) -> BoolArray:
        """Whether a line starts with a prefix, leading spaces aside, (k,) array."""
        code, *others = prefix.encode()
        fits: BoolArray = self.first_codes == code
        for place, other in enumerate(others, start=1):
            lines = np.flatnonzero(fits)
            at = self.firsts[lines] + place
            is_inside = at < self.ends[lines]
            fits[lines] = is_inside
            fits[lines[is_inside]] = self.codes[at[is_inside]] == other
        return fits

    def find_with_decimals(self, lines: Int64Array) -> Int64Array:
        """Return those of the chosen lines in which a comma or a point stands between digits."""
        codes = self.codes
        is_digit = (codes >= ord("0")) & (codes <= ord("9"))
        is_mark = (codes[1:-1] == ord(",")) | (codes[1:-1] == ord("."))
        places = np.flatnonzero(is_mark & is_digit[:-2] & is_digit[2:]) + 1
        return np.intersect1d(np.searchsorted(self.starts, places, side="right") - 1, lines)

    def find_with_exponents(self, lines: Int64Array) -> Int64Array:
        """Return the places of those of the chosen lines in which e+ or E+ stands."""
        if b"E+" not in self.data and b"e+" not in self.data:
            return np.empty(0, np.int64)
        codes = self.codes
        is_exponent = ((codes[:-1] | 32) == ord("e")) & (codes[1:] == ord("+"))
        found = np.searchsorted(self.starts, np.flatnonzero(is_exponent), side="right") - 1
        return np.flatnonzero(np.isin(lines, found))

    def join(self, lines: Int64Array) -> bytes:
        """Return the chosen lines (ascending numbers) as one text."""
        if len(lines) == 0:
            return b""
        gaps = np.flatnonzero(np.diff(lines) != 1)
        run_starts = self.starts[lines[np.append(0, gaps + 1)]]
        run_ends = self.ends[lines[np.append(gaps, len(lines) - 1)]]
        view = memoryview(self.data)
        runs = [view[start:end] for start, end in zip(run_starts, run_ends, strict=True)]
        return b"\n".join(runs)


def read_lines(path: Path, *, encoding: str | None = None) -> TextLines:
    """Read a text file.

    Parameters
    ----------
    path : Path
    encoding : str, optional
        Default by looking: a byte-order mark, UTF-8, UTF-16, else Windows-1252.

    Raises
    ------
    ReadError
        If the file cannot be read, holds binary data, or is not in the encoding named.
    """
    try:
        data = path.read_bytes()
    except OSError as error:
        raise ReadError(f"Cannot read '{path}': {error.strerror or error}.", path=path) from error
    text = _convert_to_utf8(data, encoding)
    if b"\x00" in text:
        raise ReadError(f"'{path}' holds binary data, not delimited text.", path=path)
    lines = TextLines.of(text.rstrip(b"\x1a"))
    _require_short(lines)
    return lines


def _require_short(lines: TextLines) -> None:
    """Refuse a line so long that it is no row, before anything tries to understand it."""
    lengths = lines.ends - lines.starts
    if len(lengths) and lengths.max() > _LONGEST_LINE:
        line = int(lengths.argmax())
        raise ReadError(
            f"{FILE}, line {line + 1}: {lengths[line]:,} bytes are no row of points; at most "
            f"{_LONGEST_LINE:,} are read.",
            lines=[line + 1],
        )


def decode_head(head: bytes) -> str | None:
    """Return the first bytes of a file as text, None if they are none; a cut line is dropped."""
    encoding, skipped = _detect_encoding(head)
    text = head[skipped:].decode(encoding, errors="replace")
    if "\x00" in text:
        return None
    whole, line_end, _ = text.rpartition("\n")
    return whole if line_end else text


def _convert_to_utf8(data: bytes, encoding: str | None) -> bytes:
    found, skipped = _detect_encoding(data)
    try:
        if encoding is not None:
            return data.decode(encoding).lstrip("\ufeff").encode()
        if found == "utf-8":
            return _require_utf8(data[skipped:] if skipped else data)
        return data[skipped:].decode(found).encode()
    except LookupError as error:
        raise ReadError(f"Unknown encoding '{encoding}' for {FILE}.") from error
    except UnicodeError as error:
        raise ReadError(
            f"{FILE} is not {encoding or found} text: {getattr(error, 'reason', error)}; "
            "the option `encoding` names another.",
        ) from error


def _require_utf8(data: bytes) -> bytes:
    if data.isascii():
        return data
    try:
        data.decode()
    except UnicodeDecodeError:
        return _decode_western(data).encode()
    return data


def _decode_western(data: bytes) -> str:
    """Decode Windows-1252, where it has no letter Latin-1, which takes every byte."""
    try:
        return data.decode("cp1252")
    except UnicodeDecodeError:
        return data.decode("latin-1")


def _detect_encoding(data: bytes) -> tuple[str, int]:
    """Return the encoding by the first bytes, and how many of them are the mark of it."""
    for bom, encoding in _BOMS:
        if data.startswith(bom):
            return encoding, len(bom)
    even, odd = data[:_PROBE:2].count(0), data[1:_PROBE:2].count(0)
    if max(even, odd) * 4 > min(len(data), _PROBE) and min(even, odd) == 0:
        return ("utf-16-le" if odd else "utf-16-be"), 0
    return "utf-8", 0
