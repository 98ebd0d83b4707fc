"""Where the cells of a regular table are: every row has as many, and no quote needs care."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from .cells import BLANKS

if TYPE_CHECKING:
    from ...base.arrays import Int64Array, UInt8Array

_QUOTE, _SPACE, _TAB, _LINE_FEED = b'" \t\n'


@dataclass(frozen=True, slots=True, eq=False)
class CellBounds:
    """The cells of a table in a text."""

    data: bytes
    """The rows, with a line feed between them."""
    before: Int64Array
    """(n, k), for each cell of n rows and k columns the byte before its first one (-1 for the first
    of all). Quotes around a cell are part of it.
    """
    ends: Int64Array
    """(n, k), the byte behind its last one."""

    def __len__(self) -> int:
        return len(self.ends)


def find_cell_bounds(data: bytes, delimiter: str, count: int) -> CellBounds | None:
    """Find the cells of a text if it is regular: None if rows must be looked at one by one.

    Parameters
    ----------
    data : bytes
        Rows with a line feed between them; at least one.
    delimiter : str
        One letter; ``BLANKS`` for runs of spaces and tabs.
    count : int
        Number of columns, at least 2.
    """
    codes = np.frombuffer(data, np.uint8)
    line_ends = np.append(np.flatnonzero(codes == _LINE_FEED), len(codes))
    if delimiter == BLANKS:
        return None if b'"' in data else _find_words(data, codes, line_ends, count)
    places = np.flatnonzero(codes == ord(delimiter))
    if b'"' in data:
        quotes = np.flatnonzero(codes == _QUOTE)
        if not _are_plain(quotes, codes, ord(delimiter), line_ends):
            return None
        places = _drop_quoted(places, quotes)
    starts = np.append(0, line_ends[:-1] + 1)
    if not _are_even(places, starts, line_ends, count - 1):
        return None
    edges = np.empty((len(line_ends), count + 1), np.int64)
    edges[:, 0] = starts - 1
    edges[:, 1:-1] = places.reshape(-1, count - 1)
    edges[:, -1] = line_ends
    return CellBounds(data, edges[:, :-1], edges[:, 1:])


def _find_words(
    data: bytes, codes: UInt8Array, line_ends: Int64Array, count: int
) -> CellBounds | None:
    is_gap = np.ones(len(codes) + 2, np.bool_)
    is_gap[1:-1] = (codes == _SPACE) | (codes == _TAB) | (codes == _LINE_FEED)
    before = np.flatnonzero(is_gap[:-1] & ~is_gap[1:]) - 1
    line_starts = np.append(0, line_ends[:-1] + 1)
    if not _are_even(before + 1, line_starts, line_ends, count):
        return None
    ends = np.flatnonzero(~is_gap[:-1] & is_gap[1:])
    return CellBounds(data, before.reshape(-1, count), ends.reshape(-1, count))


def _are_even(places: Int64Array, starts: Int64Array, ends: Int64Array, count: int) -> bool:
    """Whether exactly ``count`` of the places (ascending) lie in every line."""
    if len(places) != count * len(starts):
        return False
    by_line = places.reshape(-1, count)
    return bool((by_line[:, 0] >= starts).all() and (by_line[:, -1] < ends).all())


def _are_plain(quotes: Int64Array, codes: UInt8Array, delimiter: int, ends: Int64Array) -> bool:
    """Whether no quote stands where only care can read it.

    Quotes are plain if they are closed on their line, open at the start of a cell, and close at
    the end of one or are doubled.
    """
    if len(quotes) % 2:
        return False
    opening, closing = quotes[0::2], quotes[1::2]
    if (np.searchsorted(ends, opening) != np.searchsorted(ends, closing)).any():
        return False
    before, behind = opening - 1, closing + 1
    beside = codes[np.concatenate([before[before >= 0], behind[behind < len(codes)]])]
    return bool(np.isin(beside, [delimiter, _QUOTE, _LINE_FEED]).all())


def _drop_quoted(places: Int64Array, quotes: Int64Array) -> Int64Array:
    """Return the places (ascending) that do not lie between an opening and its closing quote."""
    first = np.searchsorted(places, quotes[0::2])
    counts = np.searchsorted(places, quotes[1::2]) - first
    running = np.cumsum(counts)
    total = int(running[-1])
    return np.delete(places, np.repeat(first - running + counts, counts) + np.arange(total))
