"""Attributes: further columns of points, and what they say of the vertices of a TIN.

A TIN keeps the columns of its input rows. The value of a vertex is that of the first row that it
stands for, so that edits, which keep the numbers of rows, keep the values in their places.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.errors import OptionError
from ...base.types import seal

if TYPE_CHECKING:
    from collections.abc import Callable

    from ...base.arrays import AnyArray, Int32Array, Int64Array

_EXACT = 2**53
"""Whole numbers up to here are exact as floats."""


class Attributes(Mapping[str, "AnyArray"]):
    """Columns of some rows of a table; each is taken when it is asked for.

    ``find_rows`` gives the row of each value, -1 for one that is missing: NaN, empty text or None.
    """

    def __init__(
        self, columns: Mapping[str, AnyArray], find_rows: Callable[[], Int64Array]
    ) -> None:
        self._columns = columns
        self._find_rows = find_rows

    def __getitem__(self, name: str) -> AnyArray:
        return seal(_take(self._columns[name], self._find_rows()))

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __len__(self) -> int:
        return len(self._columns)

    def __repr__(self) -> str:
        return f"<Attributes: {', '.join(self) or 'none'}>"


def _take(column: AnyArray, rows: Int64Array) -> AnyArray:
    """Return values of rows; where a row is missing or beyond the column, there is none."""
    is_missing = (rows < 0) | (rows >= len(column))
    if not is_missing.any():
        return column[rows]
    if len(column) == 0:
        taken = np.full(len(rows), None, object)
        return taken if column.dtype.kind == "O" else taken.astype(float)
    taken = column[np.where(is_missing, 0, rows)]
    kind = column.dtype.kind
    if kind in "iu" and (np.abs(taken.astype(float)) < _EXACT).all():
        taken, kind = taken.astype(float), "f"
    if kind in "biuO":
        taken = taken.astype(object)
    taken[is_missing] = np.nan if kind in "fc" else "NaT" if kind in "mM" else _EMPTY.get(kind)
    return taken


_EMPTY = {"U": "", "S": b""}


def find_first_rows(vertex_of: Int32Array, n_vertices: int) -> Int64Array:
    """Return the first row that each vertex stands for, -1 for none.

    Examples
    --------
    >>> find_first_rows(np.array([0, 2, -1, 0], np.int32), 3)
    array([ 0, -1,  1])
    """
    rows = np.flatnonzero(vertex_of >= 0)[::-1]
    found = np.full(n_vertices, -1, np.int64)
    found[vertex_of[rows]] = rows
    return seal(found)


def join_columns(
    tables: Sequence[Mapping[str, AnyArray]], counts: Sequence[int]
) -> dict[str, AnyArray]:
    """Return the columns of several tables, one behind the other; what one lacks is missing.

    Examples
    --------
    >>> one, other = {"number": np.array([1, 2])}, {"number": np.array(["2A"])}
    >>> join_columns([one, other], [2, 1])["number"].tolist()
    [1, 2, '2A']
    """
    names = dict.fromkeys(name for table in tables for name in table)
    return {name: _join([one.get(name) for one in tables], counts) for name in names}


def _join(columns: Sequence[AnyArray | None], counts: Sequence[int]) -> AnyArray:
    there = [(one, n) for one, n in zip(columns, counts, strict=True) if one is not None and n]
    kinds = {one.dtype.kind for one, _ in there}
    if len(kinds) > 1 and not (kinds <= {"i", "f"} and _are_exact(one for one, _ in there)):
        there = [(one.astype(object), n) for one, n in there]
    together = np.concatenate([one for one, _ in there] or [np.empty(0, object)])
    if len(there) == sum(1 for n in counts if n):
        return together
    ends = iter(np.cumsum([0, *(n for _, n in there)]).tolist())
    start, rows = next(ends), []
    for one, n in zip(columns, counts, strict=True):
        rows.append(np.full(n, -1) if one is None else np.arange(start, start + n))
        start = next(ends, start) if one is not None and n else start
    return _take(together, np.concatenate(rows))


def _are_exact(columns: Iterable[AnyArray]) -> bool:
    """Whether whole numbers of columns stay what they are among floats."""
    whole = (one.astype(float) for one in columns if one.dtype.kind == "i")
    return all((np.abs(one) < _EXACT).all() for one in whole)


def as_row_attributes(given: Any, n_rows: int) -> dict[str, AnyArray]:
    """Return columns of the first rows of a TIN as read-only views."""
    columns = as_columns(given, None)
    for name, column in columns.items():
        if len(column) > n_rows:
            allowed = f"an array of up to {n_rows} values, one for each row of input"
            raise OptionError(f"attribute '{name}'", column, allowed)
    return {name: seal(column.view()) for name, column in columns.items()}


def as_columns(attributes: Any, shape: tuple[int, ...] | None) -> dict[str, AnyArray]:
    """Return columns as arrays of one value a point, of a shape; those of a data frame too."""
    if hasattr(attributes, "columns") and not isinstance(attributes, Mapping):
        columns = attributes.columns
        is_mapping = isinstance(columns, Mapping)
        attributes = columns if is_mapping else {name: attributes[name] for name in columns}
    given = as_mapping("attributes", attributes)
    return {name: _as_column(name, given[name], shape) for name in given}


def _as_column(name: str, values: Any, shape: tuple[int, ...] | None) -> AnyArray:
    try:
        column = _as_array(values)
    except Exception:
        column = np.empty(())
    if column.ndim != 1 or shape not in (None, column.shape):
        raise OptionError(f"attribute '{name}'", values, "an array of one value for each point")
    return column


def _as_array(values: Any) -> AnyArray:
    """Return values as an array that holds them as they are: no number as text, none rounded."""
    if isinstance(values, np.ma.MaskedArray):
        # values with NaN, or None where the others are no floats, for those masked
        if not np.ma.is_masked(values):
            return np.asarray(values.data)
        is_float = values.dtype.kind == "f"
        filled = np.array(values.data, values.dtype if is_float else object)
        filled[np.ma.getmaskarray(values)] = np.nan if is_float else None
        return filled
    column = np.asarray(values)
    if not isinstance(values, list | tuple) or column.ndim != 1 or column.dtype.kind == "O":
        return column
    pairs = zip(column.tolist(), values, strict=True)
    if all(kept == given or (kept != kept and given != given) for kept, given in pairs):
        return column
    mixed = np.empty(len(values), object)
    mixed[:] = values
    return mixed


def as_mapping(name: str, given: Any) -> Mapping[str, Any]:
    """Return what gives values by their names."""
    if not isinstance(given, Mapping) or not all(isinstance(key, str) for key in given):
        raise OptionError(name, given, "a mapping whose keys are text")
    return given
