"""Edits of one vertex that the core did and logged: as they are written down, and what they did."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ..report import Edit

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ...base.arrays import Float64Array, Int32Array
    from .. import _kernel

__all__ = ["INSERT", "MOVE", "REMOVE", "SET_ELEVATION", "SingleEdit", "make_vertices", "take_log"]

INSERT, REMOVE, MOVE, SET_ELEVATION = range(4)
"""Kinds of edits, as the core numbers them."""

_ONE = np.zeros(1, np.int32)


class SingleEdit(NamedTuple):
    """An edit of one vertex that was done.

    Attributes
    ----------
    edit : Edit
        As the caller gave it.
    kind, slot : int
    point : (3,) float64 array
        Where the vertex is then; nowhere, and not to be looked at, once it is removed.
    """

    edit: Edit
    kind: int
    slot: int
    point: Float64Array


def take_log(edited: _kernel.EditedMesh) -> Iterator[SingleEdit]:
    """Yield the edits that were logged, in order; the log is empty then."""
    numbers, given = edited.take_log()
    points = given + 0.0  # no -0.0
    for (kind, vertex, slot), xyz, point in zip(
        numbers.tolist(), given.tolist(), points, strict=True
    ):
        yield SingleEdit(_write_down(kind, vertex, xyz), kind, slot, point)


def _write_down(kind: int, vertex: int, xyz: list[float]) -> Edit:
    if kind == INSERT:
        return Edit("insert", {"points": [xyz], "duplicates": "last"})
    if kind == REMOVE:
        return Edit("remove", {"vertices": vertex})
    if kind == MOVE:
        return Edit("move", {"vertex": vertex, "point": xyz})
    return Edit("set_elevation", {"vertices": vertex, "z": xyz[2]})


def make_vertices(vertex: int) -> Int32Array:
    """Return one vertex as an array."""
    vertices = _ONE.copy()
    vertices[0] = vertex
    return vertices
