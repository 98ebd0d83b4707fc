"""Nodes that a mesh calls by number: each has one, and those that are called are there."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from ....base.arrays import Int64Array
    from ..text_rows import TextRows


def require_distinct(numbers: Int64Array, rows: TextRows) -> None:
    """Refuse nodes of which two have one number."""
    order = np.argsort(numbers, kind="stable")
    again = np.flatnonzero(np.diff(numbers[order]) == 0)
    if len(again):
        row = int(order[again[0] + 1])
        raise rows.describe_fault(row, f"there is a node {numbers[row]} already")


def find_nodes(named: Int64Array, numbers: Int64Array, rows: TextRows) -> Int64Array:
    """Return the positions of nodes that are called by number, in rows of a file."""
    if len(numbers) and (np.diff(numbers) == 1).all():  # as most programs number them
        found = np.clip(named, numbers[0], numbers[-1]) - numbers[0]
    else:
        order = np.argsort(numbers)
        at = np.searchsorted(numbers, named, sorter=order)
        found = order[np.minimum(at, len(order) - 1)] if len(order) else np.zeros_like(at)
    wrong = (numbers[found] != named) if len(numbers) else np.ones(named.shape, np.bool_)
    if wrong.any():
        row = int(np.argmax(wrong.reshape(len(named), -1).any(axis=1)))
        first = int(named[row].ravel()[np.argmax(wrong[row])])
        raise rows.describe_fault(row, f"there is no node {first}")
    return np.asarray(found, np.int64)
