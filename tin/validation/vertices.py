"""Vertex numbers as callers give them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.checks import is_whole_number
from ...base.errors import OptionError, PointsError
from ...base.sentences import shown
from .tables import is_masked_array

if TYPE_CHECKING:
    from ...base.arrays import AnyArray, Int64Array


def as_vertex(vertex: Any, n_vertices: int) -> int:
    """Return a vertex number."""
    if not is_whole_number(vertex):
        raise PointsError(f"Invalid vertex {shown(vertex)}: a whole number is needed.")
    if not 0 <= vertex < n_vertices:
        raise PointsError(
            f"There is no vertex {shown(vertex)}: numbers 0 to {n_vertices - 1} are allowed."
        )
    return int(vertex)


def as_vertex_array(vertices: Any, n_vertices: int) -> Int64Array:
    """Return vertex numbers as an array of the shape given; an empty list is no vertices."""
    numbers = _as_whole_numbers(vertices)
    if numbers is None:
        raise PointsError(f"Invalid vertices {shown(vertices)}: whole numbers are needed.")
    wrong = (numbers < 0) | (numbers >= n_vertices)
    if wrong.any():
        raise PointsError(
            f"There is no vertex {int(numbers[wrong][0])}: numbers 0 to {n_vertices - 1} are "
            "allowed."
        )
    return numbers.astype(np.int64)


def as_rows(rows: Any) -> Int64Array:
    """Return numbers of rows as an array."""
    numbers = _as_whole_numbers(rows)
    if numbers is None:
        raise OptionError("rows", rows, "whole numbers")
    return numbers.astype(np.int64)


def _as_whole_numbers(given: Any) -> AnyArray | None:
    """Return whole numbers as an array of their type, or None for anything else."""
    try:
        numbers = np.asarray(given)
    except Exception:  # whatever an object says to that
        return None
    numbers = numbers.astype(np.int64) if numbers.size == 0 else numbers
    return None if is_masked_array(given) or numbers.dtype.kind not in "iu" else numbers


def as_vertex_pairs(a: Any, b: Any, n_vertices: int) -> tuple[Int64Array, Int64Array]:
    """Return the vertex numbers of pairs, of one shape."""
    first, second = as_vertex_array(a, n_vertices), as_vertex_array(b, n_vertices)
    try:
        first_of, second_of = np.broadcast_arrays(first, second)
    except ValueError:
        raise PointsError(
            f"Vertices a have shape {first.shape} and b {second.shape}: as many are needed, or "
            "one of them single."
        ) from None
    return first_of, second_of
