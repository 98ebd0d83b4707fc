"""Triangles as callers give them: vertex numbers, edge flags, counter-clockwise at the end."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...base.errors import PointsError
from .. import _kernel

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from ...base.arrays import BoolArray, Float64Array, Int32Array


def as_triangles(triangles: ArrayLike, n_vertices: int) -> Int32Array:
    """Return an (m, 3) int32 array of vertex numbers, m >= 1."""
    try:
        given = np.asarray(triangles)
    except ValueError:
        raise PointsError("Triangles have rows of unequal length: three integers a row.") from None
    if given.ndim != 2 or given.shape[1] != 3 or len(given) == 0:
        raise PointsError(
            f"Triangles have shape {given.shape}: they must be (m, 3) vertex numbers, m >= 1."
        )
    if given.dtype.kind not in "iu":
        raise PointsError(f"Triangles are {given.dtype}: vertex numbers must be integers.")
    wrong = ((given < 0) | (given >= n_vertices)).any(axis=1)
    if wrong.any():
        row = int(np.argmax(wrong))
        raise PointsError(
            f"Triangle {row} has the vertices {given[row].tolist()}: "
            f"numbers 0 to {n_vertices - 1} are allowed.",
            rows=np.flatnonzero(wrong)[:5],
        )
    return np.ascontiguousarray(given, np.int32)


def as_flags(constrained: ArrayLike | None, n_triangles: int) -> BoolArray:
    """Return an (m, 3) bool array of flags, all False by default."""
    if constrained is None:
        return np.zeros((n_triangles, 3), np.bool_)
    try:
        flags = np.array(constrained, np.bool_)
    except ValueError:
        raise PointsError("Edge flags have rows of unequal length: three flags a row.") from None
    if flags.shape != (n_triangles, 3):
        raise PointsError(
            f"Edge flags have shape {flags.shape}: one row of three a triangle is needed, "
            f"({n_triangles}, 3)."
        )
    return flags


def turn_counter_clockwise(
    points: Float64Array, triangles: Int32Array, flags: BoolArray
) -> tuple[Int32Array, BoolArray]:
    """Return triangles seen from above, each with the flags of its edges."""
    turn = _kernel.turns_of_triangles(np.ascontiguousarray(points), np.ascontiguousarray(triangles))
    flat = turn == 0
    if flat.any():
        row, count = int(np.argmax(flat)), int(flat.sum())
        what = "triangle has" if count == 1 else "triangles have"
        raise PointsError(
            f"{count} {what} no area in the plane (first: triangle {row}, "
            f"vertices {triangles[row].tolist()}): a TIN needs triangles seen from above.",
            rows=np.flatnonzero(flat)[:5],
        )
    clockwise = turn < 0
    triangles, flags = triangles.copy(), flags.copy()
    triangles[clockwise] = triangles[clockwise][:, [0, 2, 1]]
    flags[clockwise] = flags[clockwise][:, [0, 2, 1]]
    return triangles, flags
