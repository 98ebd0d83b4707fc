"""Rows read from pages of an SQLite file that :func:`fill_table` wrote, many at a time.

What another program wrote or changed may lie otherwise: then None is returned, and SQLite reads it.
The layout alone is compared here. That the content is the one that was written a digest tells.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from .pages import pack_varints

if TYPE_CHECKING:
    from collections.abc import Sequence
    from typing import BinaryIO

    from ....base.arrays import AnyArray, Int64Array, UInt8Array

_LEAF, _INTERIOR = 13, 5
_LEAF_HEADER, _INTERIOR_HEADER = 8, 12
_AT_ONCE = 256
"""Pages in memory at a time."""
_LONGEST_HEAD = 32
"""Bytes before the first value of a row, at most."""
_SIZES = {1: 1, 2: 2, 3: 3, 4: 4}
"""Bytes of integers by serial type."""


def read_columns(
    file: BinaryIO, root: int, sizes: Sequence[int], *, skip: int = 0
) -> list[UInt8Array] | None:
    """Read the first columns of a table whose rows are numbered from 1 on.

    Parameters
    ----------
    file : binary file
    root : int
        The page of the table.
    sizes : sequence of int
        Of each column the bytes of its blobs, 0 for integers of four bytes at most.
    skip : int
        Columns that are not returned.

    Returns
    -------
    list of (n, width) uint8 array or None
        The bytes of the values; None if rows are not all alike, or not all there.
    """
    file.seek(0)
    header = file.read(100)
    page_size = int.from_bytes(header[16:18], "big")
    leaves = _list_leaves(file, root, page_size) if page_size >= 512 and not header[20] else None
    if not leaves:
        return None
    found: list[list[UInt8Array]] = []
    first = 1
    for start in range(0, len(leaves), _AT_ONCE):
        chosen = leaves[start : start + _AT_ONCE]
        part = _find_rows([_read_page(file, one, page_size) for one in chosen], sizes, first)
        if part is None:
            return None
        found.append([_gather(*column) for column in part[skip:]])
        first += len(found[-1][0])
    columns = list(zip(*found, strict=True))
    if any(len({values.shape[1] for values in column}) > 1 for column in columns):
        return None
    return [np.concatenate(column) for column in columns]


def decode_integers(content: UInt8Array) -> Int64Array:
    """Return integers of the bytes (n, width), the high ones first."""
    whole = np.zeros((len(content), 8), np.uint8)
    whole[:, 8 - content.shape[1] :] = content
    whole[:, : 8 - content.shape[1]] = np.where(content[:, :1] > 127, 255, 0)
    return whole.view(">i8").ravel().astype(np.int64)


def _read_page(file: BinaryIO, page: int, page_size: int) -> bytes:
    file.seek((page - 1) * page_size)
    return file.read(page_size)


def _list_leaves(file: BinaryIO, root: int, page_size: int) -> list[int] | None:
    """Return the pages that hold rows, in order; None of what is no tree."""
    most = file.seek(0, 2) // page_size
    level = [root]
    while 0 < len(level) <= most and all(0 < page <= most for page in level):
        first = _read_page(file, level[0], page_size)
        if first[:1] == bytes([_LEAF]):
            return level
        below: list[int] = []
        for page in level:
            content = _read_page(file, page, page_size)
            count = int.from_bytes(content[3:5], "big")
            end = _INTERIOR_HEADER + 2 * count
            if content[:1] != bytes([_INTERIOR]) or end > page_size or len(below) > most:
                return None
            for place in np.frombuffer(content, ">u2", count, _INTERIOR_HEADER).tolist():
                below.append(int.from_bytes(content[place : place + 4], "big"))
            below.append(int.from_bytes(content[8:12], "big"))
        if len(below) <= len(level):
            return None
        level = below
    return None


_Column: TypeAlias = "tuple[UInt8Array, Int64Array, int]"
"""Bytes, where each value begins in them, and how long it is."""


def _find_rows(pages: list[bytes], sizes: Sequence[int], first: int) -> list[_Column] | None:
    starts, page_size = [], len(pages[0])
    for number, page in enumerate(pages):
        count = int.from_bytes(page[3:5], "big")
        if page[:1] != bytes([_LEAF]) or _LEAF_HEADER + 2 * count > page_size:
            return None
        places = np.frombuffer(page, ">u2", count, _LEAF_HEADER)
        starts.append(places.astype(np.int64) + number * page_size)
    content = np.frombuffer(b"".join([*pages, bytes(page_size)]), np.uint8)
    return _take_columns(content, np.concatenate(starts), sizes, first)


def _take_columns(
    content: UInt8Array, starts: Int64Array, sizes: Sequence[int], first: int
) -> list[_Column] | None:
    """Return columns of the rows that start at these places."""
    if not len(starts):
        return None
    at = starts + np.where(content[starts] > 127, 2, 1)  # behind the length of the row
    numbers, lengths = pack_varints(np.arange(first, first + len(starts)))
    inside = np.arange(numbers.shape[1]) < lengths[:, None]
    if ((_gather(content, at, numbers.shape[1]) != numbers) & inside).any():
        return None
    at = at + lengths
    head = content[at[0] : at[0] + _LONGEST_HEAD]
    columns = _find_columns(head, sizes)
    if columns is None:
        return None
    compared = columns[0]
    if (_gather(content, at, compared) != head[:compared]).any():
        return None
    at = at + int(head[0])
    return [(content, at + offset, width) for offset, width in columns[1]]


def _find_columns(
    head: UInt8Array, sizes: Sequence[int]
) -> tuple[int, list[tuple[int, int]]] | None:
    """Return the bytes of a row's header for some columns, and where and how long each value is."""
    place, offset, found = 2, 0, []
    for size in sizes:
        if size:
            kind, length = pack_varints(np.array([12 + 2 * size]))
            stated = head[place : place + int(length[0])]
            if not np.array_equal(stated, kind[0]):
                return None
            place += int(length[0])
            width = size
        else:
            width = _SIZES.get(int(head[place]), 0)
            place += 1
        if not width:
            return None
        found.append((offset, width))
        offset += width
    is_sound = head[1] == 0 and place <= head[0] < 128
    return (place, found) if is_sound else None


def _gather(content: UInt8Array, starts: Int64Array, width: int) -> UInt8Array:
    """Return so many bytes from each place on, (n, width)."""
    rows: AnyArray = np.lib.stride_tricks.sliding_window_view(content, width)[starts]
    return rows
