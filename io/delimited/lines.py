"""The bytes of a text file as UTF-8 lines, each with its number and kind."""

from __future__ import annotations

import codecs
from dataclasses import dataclass
from functools import cached_property
from typing import IO, TYPE_CHECKING, Any

import numpy as np

from ...base.errors import ReadError
from ...base.sentences import FILE

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator
    from pathlib import Path

    from ...base.arrays import BoolArray, Int64Array, UInt8Array

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
LONGEST_LINE = 1_000_000
BLOCK_BYTES = 1 << 22
"""Bytes of a block: some 100,000 rows of points."""


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
    first: int = 0
    """Number of the first line in the file, from 0, as all numbers of lines are."""
    is_last: bool = True
    """Whether the file ends with these lines."""

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
    def last(self) -> int:
        """Number of the last line."""
        return self.first + len(self) - 1

    def number(self, mask: BoolArray) -> Int64Array:
        """Return the numbers of the lines of a mask, (k,) array."""
        return np.flatnonzero(mask) + self.first

    @property
    def codes(self) -> UInt8Array:
        """The bytes as numbers."""
        return np.frombuffer(self.data, np.uint8)

    def decode_line(self, line: int) -> str:
        """Return one line by its number."""
        line -= self.first
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
        found = np.searchsorted(self.starts, places, side="right") - 1 + self.first
        return np.intersect1d(found, lines)

    def find_with_exponents(self, lines: Int64Array) -> Int64Array:
        """Return the places of those of the chosen lines in which e+ or E+ stands."""
        if b"E+" not in self.data and b"e+" not in self.data:
            return np.empty(0, np.int64)
        codes = self.codes
        is_exponent = ((codes[:-1] | 32) == ord("e")) & (codes[1:] == ord("+"))
        found = np.searchsorted(self.starts, np.flatnonzero(is_exponent), side="right") - 1
        return np.flatnonzero(np.isin(lines, found + self.first))

    def join(self, lines: Int64Array) -> bytes:
        """Return the chosen lines (ascending numbers) as one text."""
        if len(lines) == 0:
            return b""
        lines = lines - self.first
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
    """
    try:
        data = path.read_bytes()
    except OSError as error:
        raise ReadError(f"Cannot read {FILE}: {error.strerror or error}.") from error
    text = _convert_to_utf8(data, encoding)
    if b"\x00" in text:
        raise ReadError(f"{FILE} holds binary data, not delimited text.")
    lines = TextLines.of(text.rstrip(b"\x1a"))
    _require_short(lines)
    return lines


def _require_short(lines: TextLines) -> None:
    """Refuse a line so long that it is no row, before anything tries to understand it."""
    lengths = lines.ends - lines.starts
    if len(lengths) and lengths.max() > LONGEST_LINE:
        length, line = lengths.max(), int(lengths.argmax()) + lines.first
        raise ReadError(
            f"{FILE}, line {line + 1}: {length:,} bytes are no row of points; at most "
            f"{LONGEST_LINE:,} are read.",
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
    """Return text in UTF-8, which it may be already, else is in Windows-1252."""
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


# ---------------------------------------------------------------------------- blocks


def iterate_lines(
    path: Path, *, encoding: str | None = None, block_bytes: int | None = None
) -> Iterator[TextLines]:
    """Read a text file block by block.

    Parameters
    ----------
    path : Path
    encoding : str, optional
        As of :func:`read_lines`. What is not told is decided by the first block, and between UTF-8
        and Windows-1252 by the first one with a letter beyond ASCII.
    block_bytes : int, optional
        Bytes of a block; the last has up to twice as many. None reads the file as one.
    """
    try:
        is_small = block_bytes is None or path.stat().st_size <= 2 * block_bytes
    except OSError:
        is_small = True  # reading it tells better why there is none
    if block_bytes is None or is_small:
        yield read_lines(path, encoding=encoding)
        return
    with path.open("rb") as file:
        first = 0
        decoder: _Decoder | None = None
        for content, is_last in _iterate_bytes(file, block_bytes):
            decoder = decoder or _Decoder(content, encoding)
            text = decoder.decode(content, first, is_last=is_last)
            if b"\x00" in text:
                raise ReadError(f"{FILE} holds binary data, not delimited text.")
            lines = _number_lines(text.rstrip(b"\x1a") if is_last else text, first, is_last)
            _require_short(lines)
            if len(lines) or is_last:
                yield lines
            first += len(lines)


def _number_lines(text: bytes, first: int, is_last: bool) -> TextLines:
    """Return the lines of a block; an empty one has none."""
    if not text:
        none = np.empty(0, np.int64)
        return TextLines(b"", none, none, True, first, is_last)
    found = TextLines.of(text)
    return TextLines(found.data, found.starts, found.ends, found.is_whole, first, is_last)


def _iterate_bytes(file: IO[bytes], block_bytes: int) -> Iterator[tuple[bytes, bool]]:
    """Yield blocks of bytes, and whether each is the last, which is no small one."""
    before = file.read(block_bytes)
    while True:
        behind = file.read(block_bytes)
        if len(behind) < block_bytes:
            yield before + behind, True
            return
        yield before, False
        before = behind


class _Decoder:
    """Blocks of bytes as UTF-8 that ends with a line, the beginning of the next kept back."""

    def __init__(self, head: bytes, encoding: str | None) -> None:
        found, self._skipped = _detect_encoding(head)
        self._name = encoding or found
        self._is_open = encoding is None and found == "utf-8"
        self._is_western: bool | None = None
        self._rest = b""
        self._decoder: Any = None
        if not self._is_open:
            self._skipped = 0 if encoding is not None else self._skipped
            try:
                self._decoder = codecs.getincrementaldecoder(self._name)()
            except LookupError as error:
                raise ReadError(f"Unknown encoding '{encoding}' for {FILE}.") from error

    def decode(self, content: bytes, first: int, *, is_last: bool) -> bytes:
        """Return the whole lines of a block; ``first`` is the number of the first of them."""
        content, self._skipped = content[self._skipped :], 0
        if self._decoder is not None:
            content = self._convert(content, is_first=first == 0 and not self._rest, ends=is_last)
        content = self._rest + content
        if is_last:
            self._rest = b""
        else:
            cut = _find_cut(content)
            content, self._rest = content[:cut], content[cut:]
        return self._require_one_encoding(content, first) if self._is_open else content

    def _convert(self, content: bytes, *, is_first: bool, ends: bool) -> bytes:
        try:
            text: str = self._decoder.decode(content, ends)
        except UnicodeError as error:
            raise ReadError(
                f"{FILE} is not {self._name} text: {getattr(error, 'reason', error)}; "
                "the option `encoding` names another.",
            ) from error
        return (text.lstrip("\ufeff") if is_first else text).encode()

    def _require_one_encoding(self, content: bytes, first: int) -> bytes:
        if content.isascii():
            return content
        text = _require_utf8(content)
        is_western = text is not content
        if self._is_western is False and is_western:
            raise ReadError(
                f"{FILE} is UTF-8 text up to line {first}, and no more behind it: the option "
                "`encoding` names that of all."
            )
        if self._is_western and not is_western:  # it may be both, and those above were not
            return content.decode("cp1252", "replace").encode()
        self._is_western = is_western
        return text


def _find_cut(content: bytes) -> int:
    """Return the byte behind the last whole line; 0 if there is none, and may be one later."""
    cut = content.rfind(b"\n") + 1
    cut = cut or content.rfind(b"\r", 0, max(0, len(content) - 1)) + 1
    return len(content) if not cut and len(content) > LONGEST_LINE else cut
