"""Columns of attributes: as trees of plain values and arrays, and as columns of a layer."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

import numpy as np

from .....base.records import require

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Mapping

    from .....base.arrays import AnyArray

__all__ = ["describe_layer_columns", "pack_columns", "unpack_columns"]

_STORED = re.compile(r"[<|][bif][148]|\|u1")
"""Types that the table of arrays holds."""

_TYPE = re.compile(r"[<|](?:[biu][1248]|f[248]|[mM]8(?:\[\w{1,12}\])?|U\d{1,7})|\|O")
_PLAIN = (bool, int, float, str, type(None))
_LARGEST = 2**63


def pack_columns(columns: Mapping[str, AnyArray], pack: Callable[[Any], Any]) -> list[Any]:
    """Return for each column its name, type and values; what is no plain value becomes text."""
    return [[name, *_pack_column(values, pack)] for name, values in columns.items()]


def _pack_column(values: AnyArray, pack: Callable[[Any], Any]) -> list[Any]:
    kind = values.dtype.newbyteorder("<").str
    if kind[1] in "OUSVc" or not _TYPE.fullmatch(kind):
        plain = [one if isinstance(one, _PLAIN) else str(one) for one in values.tolist()]
        return [kind if kind[1] == "U" else "|O", pack(plain)]
    values = np.ascontiguousarray(values, kind)
    if _STORED.fullmatch(kind):
        return [kind, pack(values)]
    wider = "f4" if kind[1] == "f" else "i8"
    return [kind, pack(values.view(wider) if values.itemsize == 8 else values.astype(wider))]


def unpack_columns(trees: Any, unpack: Callable[[Any], Any], n_rows: int) -> dict[str, AnyArray]:
    """Return the columns of trees that :func:`pack_columns` made.

    Raises
    ------
    PointsError
        If one is no column, or longer than there are rows.
    """
    return {name: _unpack_column(kind, unpack(tree), n_rows) for name, kind, tree in trees}


def _unpack_column(kind: Any, values: Any, n_rows: int) -> AnyArray:
    require(isinstance(kind, str) and _TYPE.fullmatch(kind) is not None, "type of a column")
    require(isinstance(values, np.ndarray | list) and len(values) <= n_rows, "a column")
    if isinstance(values, list):
        require(all(isinstance(one, _PLAIN) for one in values), "values of a column")
        column = np.empty(len(values), object)
        column[:] = values
        return column if kind == "|O" else column.astype(kind)
    require(values.ndim == 1 and kind[1] not in "OU", "a column")
    dtype = np.dtype(kind)
    is_same_size = dtype.itemsize == values.itemsize
    whole: AnyArray = values.view(dtype) if is_same_size else values.astype(dtype)
    return whole


def describe_layer_columns(
    columns: Mapping[str, AnyArray], taken: Collection[str]
) -> list[tuple[str, Iterable[Any]]]:
    """Return for each column its declaration in SQL, and its values as SQLite holds them.

    Parameters
    ----------
    columns : mapping of str to array
    taken : collection of str
        Names that the layer has already, small letters.
    """
    names, found = set(taken), []
    for name, values in columns.items():
        free = _find_free_name(name.replace("\0", " "), names)
        names.add(free.lower())
        quoted = '"' + free.replace('"', '""') + '"'
        kind = {"b": "BOOLEAN", "i": "INTEGER", "u": "INTEGER", "f": "REAL"}.get(values.dtype.kind)
        if values.dtype.kind == "u" and (values >= _LARGEST).any():
            kind = None
        plain = values.tolist()
        found.append(
            (f"{quoted} {kind}", plain) if kind else (f"{quoted} TEXT", map(_as_text, plain))
        )
    return found


def _find_free_name(name: str, taken: set[str]) -> str:
    free, number = name or "attribute", 2
    while free.lower() in taken:
        free, number = f"{name}_{number}", number + 1
    return free


def _as_text(value: Any) -> str | None:
    """Return a value as text; None for none."""
    if value is None or value != value:
        return None
    return str(value).encode("utf-8", "replace").decode()
