"""Inputs of a TIN at other places: points and lines moved, to be built anew."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.checks import is_finite_number
from ...base.errors import OptionError, PointsError
from ..validation import as_points

if TYPE_CHECKING:
    from collections.abc import Callable

    from ...base.arrays import Float64Array
    from ...base.crs import CRS, Unit
    from .inputs import BuildInputs

    Move = Callable[[Float64Array], Float64Array]


def move_inputs(
    inputs: BuildInputs, move: Move, *, length: float, crs: CRS | None, elevation_unit: Unit | None
) -> BuildInputs:
    """Return inputs whose points and lines a function has moved, with the CRS and unit of these.

    ``move`` takes and returns (n, 3) points; ``length`` is the factor of lengths in the plane, for
    ``max_edge`` and ``snap``. Draped vertices have no elevation before and after. Water stays flat,
    at the mean of what becomes of its corners.
    """
    lines = inputs.lines
    xyz = _move_places(np.column_stack([lines.xy, lines.elevations]), move)
    for line, kind in enumerate(lines.kinds):
        if kind == "water":
            part = slice(lines.offsets[line], lines.offsets[line + 1])
            if np.ptp(xyz[part, 2]) > 0:
                xyz[part, 2] = xyz[part, 2].mean()
    moved = replace(
        inputs,
        points=_move_places(inputs.points, move),
        erase=[[_move_ring(ring, move) for ring in region] for region in inputs.erase],
        options=inputs.options.scale(length),
        crs=crs,
        elevation_unit=elevation_unit,
    )
    if not lines.kinds:
        return moved
    return moved.with_lines(lines._replace(xy=xyz[:, :2].copy(), elevations=xyz[:, 2].copy()))


def require_move(function: Any, length: Any) -> None:
    """Refuse what cannot move points, or is no factor of lengths."""
    if not callable(function):
        raise OptionError("function", function, "one that takes and returns (n, 3) points")
    if not (is_finite_number(length) and length > 0):
        raise OptionError("length", length, "a factor > 0")


def move_points(points: Float64Array, move: Move) -> Float64Array:
    """Return where a function puts points."""
    moved = as_points(move(points))
    if len(moved) != len(points):
        raise PointsError(
            f"The function returned {len(moved)} of {len(points)} points: "
            "it must return all of them, in the same order."
        )
    return moved


def _move_places(xyz: Float64Array, move: Move) -> Float64Array:
    """Move what has coordinates; an elevation that is not known stays so."""
    found = xyz.copy()
    is_place = np.isfinite(xyz[:, :2]).all(axis=1)
    if is_place.any():
        has_elevation = np.isfinite(xyz[is_place, 2])
        given = np.where(has_elevation, xyz[is_place, 2], 0.0)
        moved = move_points(np.column_stack([xyz[is_place, :2], given]), move)
        moved[~has_elevation, 2] = np.nan
        found[is_place] = moved
    return found


def _move_ring(ring: Float64Array, move: Move) -> Float64Array:
    return move_points(np.column_stack([ring, np.zeros(len(ring))]), move)[:, :2].copy()
