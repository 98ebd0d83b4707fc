"""The faces of a PLY file as polygons: lists of vertices, or strips of triangles."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ....base.errors import ReadError
from .body import Ragged

if TYPE_CHECKING:
    from collections.abc import Mapping

    from ....base.arrays import AnyArray, Int64Array
    from .body import Table

__all__ = ["STRIPS", "find_faces"]

STRIPS = ("tristrips", "tristrip")
"""Elements whose rows are strips of triangles."""

_LISTS = ("vertex_indices", "vertex_index")
_RESTART = -1
"""What stands between two strips of one row."""


def find_faces(tables: Mapping[str, Table]) -> Ragged | None:
    """Return the vertices of the faces, whole numbers, those of strips behind the others.

    Returns
    -------
    Ragged
        None if there are no faces.

    Raises
    ------
    ReadError
        If faces name their vertices under another name, or by no whole numbers.
    """
    parts = []
    for name in ("face", *STRIPS):
        found = _find_list(tables.get(name), name)
        if found is not None:
            found = found._replace(items=_require_whole_numbers(found.items))
            parts.append(found if name == "face" else _cut_strips(found))
    if not parts:
        return None
    lengths = np.concatenate([np.diff(one.offsets) for one in parts])
    offsets = np.concatenate([[0], np.cumsum(lengths)])
    return Ragged(np.concatenate([one.items for one in parts]), offsets)


def _find_list(table: Table | None, element: str) -> Ragged | None:
    """Return the list of vertices of an element; None if it has no rows."""
    if table is None:
        return None
    found = next((table.lists[name] for name in _LISTS if name in table.lists), None)
    if found is None and _has_rows(table):
        others = ", ".join(f"'{name[:40]}'" for name in (*table.lists, *table.columns))
        raise ReadError(
            f"the rows of '{element}' have the properties {others}, and their vertices "
            f"must be a list {' or '.join(_LISTS)}."
        )
    return None if found is None or len(found.offsets) == 1 else found


def _has_rows(table: Table) -> bool:
    lengths = [len(one.offsets) - 1 for one in table.lists.values()]
    return any([*lengths, *(len(one) for one in table.columns.values())])


def _cut_strips(strips: Ragged) -> Ragged:
    """Return the triangles of strips; those that only lead from one to the next have no area."""
    items = np.asarray(strips.items)
    row = np.repeat(np.arange(len(strips.offsets) - 1), np.diff(strips.offsets))
    part = row + np.cumsum(items == _RESTART)  # a number for each strip
    _, first, owner = np.unique(part, return_index=True, return_inverse=True)
    place = np.arange(len(items)) - (first + (items[first] == _RESTART))[owner]
    a, b, c = items[:-2], items[1:-1], items[2:]
    whole = (place[2:] >= 2) & (a != b) & (b != c) & (a != c)
    turned = place[2:] % 2 == 1
    triangles = np.stack([np.where(turned, b, a), np.where(turned, a, b), c], axis=1)[whole]
    return Ragged(triangles.ravel(), 3 * np.arange(len(triangles) + 1))


def _require_whole_numbers(items: AnyArray) -> Int64Array:
    if items.dtype.kind == "f" and not (np.abs(items) < 2.0**53).all():
        raise ReadError("a face names a vertex that is no number.")
    whole = items.astype(np.int64)
    if (whole != items).any():
        raise ReadError("a face names a vertex that is no whole number.")
    return whole
