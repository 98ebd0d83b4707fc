"""Rows of an SQLite table as pages of its file, made of arrays: a statement a row takes 2 us.

Pages of a table are a tree: leaves hold rows (cells), interior pages the last number of each page
below (https://www.sqlite.org/fileformat2.html). SQLite makes the empty table; all rows follow here
at once, and the tree of the table takes the place of its only page.
"""

from __future__ import annotations

from itertools import chain, islice
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ....base.errors import WriteError
from ....base.sentences import FILE

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence
    from typing import BinaryIO

    from ....base.arrays import AnyArray, Int64Array, UInt8Array

_LEAF, _INTERIOR = 13, 5
_LEAF_HEADER, _INTERIOR_HEADER = 8, 12
_POINTER = 2
_INTERIOR_CELL = 4 + 5 + _POINTER
"""Bytes at most: a page, the number of a row, and where the cell begins."""

_LEAF_BYTES_AT_LEAST = 35
"""Of a page's bytes, those that a row without overflow pages leaves."""

_LOCK_BYTE = 1 << 30
"""The page that holds this byte of the file holds no content."""

_SIZE_AT = slice(28, 32)
_COUNTERS_AT = slice(24, 28), slice(92, 96)
"""Where the file has the number of its pages; that is valid if these are equal."""


class Column(NamedTuple):
    """The values of a column in some rows, as they lie in the file."""

    kinds: AnyArray
    """Type and length of each value (n,): a serial type of SQLite."""
    content: UInt8Array
    """Bytes of each value (n, width), of a text as many as its type says."""


NULL = 0
_REAL = 7
_BLOB = 12
"""The first type of blobs, an even number; a text has an odd one. Types grow by 2 for a byte."""
_INTEGERS = {1: 1, 2: 2, 3: 3, 4: 4, 8: 6}
"""Serial type by bytes."""


def make_blobs(rows: AnyArray) -> Column:
    """Return a column of blobs of one length: the elements of a structured array (n,)."""
    size = rows.dtype.itemsize
    return Column(np.full(len(rows), _BLOB + 2 * size), rows.view(np.uint8).reshape(-1, size))


def make_integers(values: AnyArray, largest: int) -> Column:
    """Return a column of integers (n,), all of as many bytes.

    The smallest may be ``-largest - 1``.
    """
    size = next(size for size in _INTEGERS if largest < 1 << (8 * size - 1))
    content = values.astype(">i8").view(np.uint8).reshape(-1, 8)
    return Column(np.full(len(values), _INTEGERS[size]), content[:, 8 - size :])


def make_reals(values: AnyArray) -> Column:
    """Return a column of real numbers (n,); NaN is NULL."""
    content = values.astype(">f8").view(np.uint8).reshape(-1, 8)
    return Column(np.where(np.isnan(values), NULL, _REAL), content)


def make_texts(values: Sequence[str | None]) -> Column:
    """Return a column of texts; None is NULL."""
    encoded = [b"" if value is None else value.encode() for value in values]
    sizes = np.array([len(one) for one in encoded])
    is_null = np.array([value is None for value in values])
    content = np.array(encoded, "S").view(np.uint8).reshape(len(values), -1)
    return Column(np.where(is_null, NULL, _BLOB + 1 + 2 * sizes), content[:, : sizes.max()])


# --------------------------------------------------------------------------- cells


class _Cells(NamedTuple):
    """Rows as they lie in pages."""

    numbers: Int64Array
    ends: Int64Array
    """Where each ends in the content."""
    content: memoryview


def _make_cells(first: int, columns: list[Column], most: int) -> _Cells:
    """Return rows numbered from ``first``, the first column, each of ``most`` bytes at most."""
    numbers = np.arange(first, first + len(columns[0].kinds))
    kinds = [pack_varints(column.kinds) for column in columns]
    head = 2 + _add_up(kinds)  # its own length, and NULL for the number
    if (head > 0x7F).any():
        raise ValueError(f"{len(columns)} columns are more than a header of 127 bytes holds")
    values = [(column.content, _measure(column)) for column in columns]
    payload = head + _add_up(values)
    if (payload > most).any():
        raise ValueError(f"a row of {payload.max()} bytes is longer than a page holds")
    parts = [*map(pack_varints, (payload, numbers, head, 0 * head)), *kinds, *values]
    return _Cells(numbers, np.cumsum(_add_up(parts)), _join(parts))


def _measure(column: Column) -> Int64Array:
    """Return the bytes of each value."""
    kinds, width = column.kinds, column.content.shape[1]
    return np.where(kinds >= _BLOB, (kinds - _BLOB) // 2, np.where(kinds == NULL, 0, width))


def _add_up(parts: list[tuple[UInt8Array, Int64Array]]) -> Int64Array:
    """Return the bytes of each row."""
    total = np.zeros(len(parts[0][1]), np.int64)
    for _, sizes in parts:
        total += sizes
    return total


def _join(parts: list[tuple[UInt8Array, Int64Array]]) -> memoryview:
    """Return the bytes of each row one after the other: of each part as many as its sizes say."""
    if all((sizes == sizes[0]).all() for _, sizes in parts):
        same = [content[:, : sizes[0]] for content, sizes in parts]
        rows = np.empty((len(same[0]), sum(content.shape[1] for content in same)), np.uint8)
        rows[:] = np.hstack([content[0] for content in same])
        start = 0
        for content in same:
            if content.strides[0]:  # not the same in all rows
                rows[:, start : start + content.shape[1]] = content
            start += content.shape[1]
        return rows.ravel().data
    whole = np.hstack([content for content, _ in parts])
    used = np.hstack([np.arange(part.shape[1]) < sizes[:, None] for part, sizes in parts])
    return whole[used].data


def pack_varints(values: Int64Array) -> tuple[UInt8Array, Int64Array]:
    """Return numbers below 2^35 in 7 bits a byte, the high ones first; and how many bytes each."""
    if len(values) > 1 and (values == values[0]).all():
        value, size = pack_varints(values[:1])
        return np.broadcast_to(value, (len(values), value.shape[1])), np.repeat(size, len(values))
    sizes = np.ones(len(values), np.int64)
    for count in range(1, 5):
        sizes += values >> 7 * count > 0
    bytes_of = np.empty((len(values), int(sizes.max())), np.uint8)
    for place in range(bytes_of.shape[1]):
        left = sizes - 1 - place
        low = values >> 7 * np.maximum(left, 0) & 0x7F
        bytes_of[:, place] = np.where(left > 0, low | 0x80, low)
    return bytes_of, sizes


# --------------------------------------------------------------------------- pages


def fill_table(file: BinaryIO, root: int, parts: Iterable[list[Column]]) -> None:
    """Write all rows of an empty table of a database that nobody has open.

    Parameters
    ----------
    file : binary file
        Open for reading and writing.
    root : int
        The page of the table: ``rootpage`` in ``sqlite_schema``.
    parts : iterable of lists of Columns
        Some rows each, which are numbered from 1: their columns but the first, the number.

    Raises
    ------
    WriteError
        If the database is not one that was just closed, or its table is not empty.
    """
    file.seek(0)
    header = file.read(100)
    page_size = int.from_bytes(header[16:18], "big")
    count = int.from_bytes(header[_SIZE_AT], "big")
    one, other = (header[place] for place in _COUNTERS_AT)
    file.seek((root - 1) * page_size)
    is_empty = file.read(5) == b"\x0d\0\0\0\0"
    if one != other or file.seek(0, 2) != count * page_size or not is_empty:
        raise WriteError(f"Cannot write {FILE}: its table on page {root} is not empty.")
    leaves = _make_leaves(parts, page_size)
    begin = list(islice(leaves, 2))
    if not begin:
        return
    top = begin[0].content
    if len(begin) == 2:
        top, count = _write_below(file, chain(begin, leaves), count)
    file.seek((root - 1) * page_size)
    file.write(top)
    file.seek(_SIZE_AT.start)
    file.write(count.to_bytes(4, "big"))


class _Page(NamedTuple):
    content: bytes
    last: int
    """Number of the last row."""


class _Child(NamedTuple):
    page: int
    last: int
    """Number of the last row on the page or below."""


def _write_below(file: BinaryIO, leaves: Iterable[_Page], count: int) -> tuple[bytes, int]:
    """Write all pages of a tree but the top; return that, and how many pages there are now."""
    children = []
    for leaf in leaves:
        count = _append(file, leaf.content, count)
        children.append(_Child(count, leaf.last))
    page_size = len(leaf.content)
    most = (page_size - _INTERIOR_HEADER) // _INTERIOR_CELL
    while len(children) > most:
        parts = np.array_split(np.arange(len(children)), len(children) // most + 1)
        level = [[children[place] for place in part] for part in parts]
        children = []
        for below in level:
            count = _append(file, _make_interior(below, page_size), count)
            children.append(_Child(count, below[-1].last))
    return _make_interior(children, page_size), count


def _append(file: BinaryIO, content: bytes, count: int) -> int:
    """Write a page behind ``count`` pages, and return its number."""
    size = len(content)
    if count == _LOCK_BYTE // size:
        count += 1
    file.seek(count * size)
    file.write(content)
    return count + 1


def _make_leaves(parts: Iterable[list[Column]], page_size: int) -> Iterator[_Page]:
    first = 1
    for columns in parts:
        cells = _make_cells(first, columns, page_size - _LEAF_BYTES_AT_LEAST)
        first += len(cells.numbers)
        needed = cells.ends + _POINTER * np.arange(1, len(cells.ends) + 1)
        begin = start = used = 0
        while begin < len(needed):
            end = int(np.searchsorted(needed, used + page_size - _LEAF_HEADER, side="right"))
            stop = int(cells.ends[end - 1])
            content = cells.content[start:stop]
            at = page_size - len(content)
            places = np.append(start, cells.ends[begin : end - 1]) - start + at
            yield _Page(_pack(_LEAF, places, b"", content, page_size), int(cells.numbers[end - 1]))
            begin, start, used = end, stop, int(needed[end - 1])


def _make_interior(children: list[_Child], page_size: int) -> bytes:
    """Return a page of cells (page, number of its last row), of all children but the last."""
    varints, sizes = pack_varints(np.array([child.last for child in children[:-1]]))
    cells = [
        child.page.to_bytes(4, "big") + varint[:size].tobytes()
        for child, varint, size in zip(children[:-1], varints, sizes, strict=True)
    ]
    content = b"".join(cells)
    ends = np.cumsum([len(cell) for cell in cells])
    places = page_size - len(content) + np.append(0, ends[:-1])
    right = children[-1].page.to_bytes(4, "big")
    return _pack(_INTERIOR, places, right, content, page_size)


def _pack(
    kind: int, places: Int64Array, right: bytes, content: bytes | memoryview, page_size: int
) -> bytes:
    """Return a page: header, where cells begin, and cells at its end."""
    count, begin = len(places).to_bytes(2, "big"), (page_size - len(content)).to_bytes(2, "big")
    head = b"".join(
        [bytes([kind, 0, 0]), count, begin, b"\0", right, places.astype(">u2").tobytes()]
    )
    return b"".join([head, bytes(page_size - len(head) - len(content)), content])
