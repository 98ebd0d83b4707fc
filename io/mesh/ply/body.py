"""The tables behind a PLY header, as arrays: single values as columns, lists as offsets and items.

Text and binary files are read alike: a row is a run of cells (words of the text, or bytes), and a
list is a cell for its length and then its items.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ....base.errors import ReadError
from ....base.sentences import FILE

if TYPE_CHECKING:
    from collections.abc import Collection

    from ....base.arrays import AnyArray, Float64Array, Int64Array
    from .header import Element, Header

_LINE_END = 3
"""Bytes behind the last row that may be ends of lines."""


class Ragged(NamedTuple):
    """Lists of any length, one after the other."""

    items: AnyArray
    """(k,)."""
    offsets: Int64Array
    """(rows + 1,)."""


@dataclass(frozen=True, slots=True, eq=False)
class Table:
    """One element's values by property name."""

    columns: dict[str, AnyArray]
    lists: dict[str, Ragged]


def read_tables(content: bytes, header: Header, names: Collection[str]) -> dict[str, Table]:
    """Read the tables up to the last of those named.

    Raises
    ------
    ReadError
        If the file ends before a table does, or text holds something that is no number.
    """
    wanted = [i for i, element in enumerate(header.elements) if element.name in names]
    body = _Body(content, header)
    read = header.elements[: max(wanted, default=-1) + 1]
    tables = {element.name: body.read_table(element) for element in read}
    if read and len(read) == len(header.elements):
        body.require_end(read[-1])
    return tables


class _Body:
    """Rows of cells, read from a cursor on; a cell of a text is one word, read as a number."""

    def __init__(self, content: bytes, header: Header) -> None:
        self.cursor = 0
        self.byte_order = header.byte_order
        self.cells: AnyArray = (
            np.frombuffer(content, np.uint8)[header.size :]
            if self.byte_order
            else _parse_text_body(content[header.size :])
        )

    def find_dtype(self, type_name: str) -> np.dtype[Any]:
        """Return the type in which a value is stored."""
        return np.dtype(self.byte_order + type_name) if self.byte_order else np.dtype(np.float64)

    def measure_width(self, type_name: str) -> int:
        """Return the cells that one value takes."""
        return self.find_dtype(type_name).itemsize // self.cells.itemsize

    def pick(self, starts: Int64Array, type_name: str) -> AnyArray:
        """Return the values that begin at these cells."""
        cells = self.cells[starts[:, None] + np.arange(self.measure_width(type_name))]
        values: AnyArray = cells.view(self.find_dtype(type_name)).reshape(len(starts))
        return values

    def view_block(
        self, start: int, stride: int, shape: tuple[int, int], type_name: str
    ) -> AnyArray:
        """View ``shape[1]`` neighbouring values in each of ``shape[0]`` rows ``stride`` apart."""
        dtype, cell = self.find_dtype(type_name), self.cells.itemsize
        strides = (stride * cell, dtype.itemsize)
        return np.ndarray(shape, dtype, self.cells.data, start * cell, strides)

    def read_table(self, element: Element) -> Table:
        """Read an element's rows and move the cursor behind them."""
        room = len(self.cells) - self.cursor
        if element.count * max(_measure_shortest_row(element, self), 1) > room:
            raise self._describe_truncation(element)
        table = self._read_even_table(element) if element.count else None
        return self._read_uneven_table(element) if table is None else table

    def require_end(self, element: Element) -> None:
        """Refuse a file that holds further rows: its header tells too small a count."""
        rest = len(self.cells) - self.cursor
        if rest >= max(_measure_shortest_row(element, self), _LINE_END if self.byte_order else 1):
            raise ReadError(
                f"{FILE} goes on behind its last element: its header promises "
                f"{_count_rows(element)}, and more follow."
            )

    def _describe_truncation(self, element: Element) -> ReadError:
        return ReadError(
            f"{FILE} ends too early: its header promises {_count_rows(element)}, more than "
            "the file holds."
        )

    def _list_lengths(self, element: Element, start: int) -> tuple[list[int], int]:
        """Walk one row: the lengths of its lists, and the cell after it."""
        lengths = []
        for prop in element.properties:
            if prop.count_type is not None:
                count_type = prop.count_type
                if start + self.measure_width(count_type) > len(self.cells):
                    raise self._describe_truncation(element)
                length = self.view_block(start, 1, (1, 1), count_type)[0, 0]
                if not (0 <= length < len(self.cells) and length == int(length)):
                    raise ReadError(f"a list of '{element.name}' has the length {length}.")
                lengths.append(int(length))
                start += self.measure_width(prop.count_type) + lengths[-1] * self.measure_width(
                    prop.type
                )
            else:
                start += self.measure_width(prop.type)
        if start > len(self.cells):
            raise self._describe_truncation(element)
        return lengths, start

    def _read_even_table(self, element: Element) -> Table | None:
        """Read all rows at once if each is as long as the first; otherwise return None."""
        lengths, after = self._list_lengths(element, self.cursor)
        stride = after - self.cursor
        if self.cursor + stride * element.count > len(self.cells):
            return None
        table, start, following = Table({}, {}), self.cursor, iter(lengths)
        for prop in element.properties:
            length = 1
            if prop.count_type is not None:
                length = next(following)
                if (
                    self.view_block(start, stride, (element.count, 1), prop.count_type) != length
                ).any():
                    return None
                start += self.measure_width(prop.count_type)
            values = self.view_block(start, stride, (element.count, length), prop.type)
            start += length * self.measure_width(prop.type)
            if prop.count_type is None:
                table.columns[prop.name] = values[:, 0]
            else:
                offsets = length * np.arange(element.count + 1, dtype=np.int64)
                table.lists[prop.name] = Ragged(values.ravel(), offsets)
        self.cursor += stride * element.count
        return table

    def _read_uneven_table(self, element: Element) -> Table:
        # Walk the rows one by one: their start cells, and per list property the lengths.
        n_lists = sum(prop.count_type is not None for prop in element.properties)
        starts = np.empty(element.count, np.int64)
        counts = np.empty((element.count, n_lists), np.int64)
        for row in range(element.count):
            starts[row] = self.cursor
            counts[row], self.cursor = self._list_lengths(element, self.cursor)
        starts, sizes = starts, counts.T
        table, following = Table({}, {}), iter(sizes)
        for prop in element.properties:
            if prop.count_type is None:
                table.columns[prop.name] = self.pick(starts, prop.type)
                starts = starts + self.measure_width(prop.type)
            else:
                lengths = next(following)
                starts = starts + self.measure_width(prop.count_type)
                type_name = prop.type
                offsets = np.zeros(len(lengths) + 1, np.int64)
                np.cumsum(lengths, out=offsets[1:])
                within = np.arange(offsets[-1]) - np.repeat(offsets[:-1], lengths)
                cells = np.repeat(starts, lengths) + within * self.measure_width(type_name)
                table.lists[prop.name] = Ragged(self.pick(cells, type_name), offsets)
                starts = starts + lengths * self.measure_width(prop.type)
        return table


def _count_rows(element: Element) -> str:
    return f"{element.count} {'row' if element.count == 1 else 'rows'} of '{element.name}'"


def _measure_shortest_row(element: Element, body: _Body) -> int:
    return sum(body.measure_width(prop.count_type or prop.type) for prop in element.properties)


def _parse_text_body(text: bytes) -> Float64Array:
    with warnings.catch_warnings():
        warnings.simplefilter("error", DeprecationWarning)
        try:
            return np.fromstring(text, dtype=np.float64, sep=" ")
        except (DeprecationWarning, ValueError):
            raise ReadError("the body of the PLY file holds something that is no number.") from None
