"""A survey at other places: its points and lines moved by a function."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.errors import CrsError
from ...base.sentences import height
from ..constraints import Breakline, Water
from .survey import Survey

if TYPE_CHECKING:
    from collections.abc import Callable

    from ...base.arrays import Float64Array
    from ...base.crs import CRS

_FLAT = 1e-3
"""By how much the corners of water may differ in elevation after a change of the vertical datum."""


def move_survey(
    survey: Survey, move: Callable[[Float64Array], Float64Array], **changes: Any
) -> Survey:
    """Return a survey whose points and lines a function has moved.

    Parameters
    ----------
    survey : Survey
    move : callable
        Takes and returns (n, 3) points.
    **changes
        Further fields of the survey that change, such as ``crs``.

    Returns
    -------
    Survey

    Raises
    ------
    CrsError
        If water would not be flat.
    """
    changes.setdefault("points", move(survey.points))
    mover = _Mover(move, changes.get("crs"))
    return replace(survey, **mover.move_lines(survey), **changes)


class _Mover:
    """Lines of a survey, moved as its points are."""

    def __init__(self, move: Callable[[Float64Array], Float64Array], target: CRS | None) -> None:
        self._move = move
        self._target = target

    def move_lines(self, survey: Survey) -> dict[str, Any]:
        """Return the lines and rings of a survey, by what they are."""
        return {
            "breaklines": [self.move_line(line) for line in survey.breaklines],
            "boundary": [self.move_region(one) for one in survey.boundary],
            "holes": [self.move_region(one) for one in survey.holes],
            "erase": [self.move_region(one) for one in survey.erase],
            "water": [self.move_water(one) for one in survey.water],
            "extent": [self.move_ring(one) for one in survey.extent],
        }

    def move_ring(self, ring: Any) -> Float64Array:
        """Move an array of two or three columns."""
        given = np.asarray(ring, np.float64)
        if given.shape[1] == 3:
            return self._move(given)
        level = np.column_stack([given, np.zeros(len(given))])
        return self._move(level)[:, :2].copy()

    def move_line(self, line: Any) -> Any:
        """Move a breakline or its coordinates."""
        if isinstance(line, Breakline):
            coords = self.move_ring(line.coords)
            return Breakline(coords, kind=line.kind, priority=line.priority, name=line.name)
        return self.move_ring(line)

    def move_region(self, region: Any) -> Any:
        """Move a ring, or a list of rings."""
        if isinstance(region, list | tuple) and np.ndim(region[0]) == 2:
            return [self.move_ring(ring) for ring in region]
        return self.move_ring(region)

    def move_water(self, water: Water) -> Water:
        """Move a polygon of water, which must stay flat."""
        corners = np.column_stack([water.ring, np.full(len(water.ring), water.z)])
        moved = self._move(corners)
        levels = np.unique(moved[:, 2])
        if self._target is not None and np.ptp(levels) > _FLAT:
            raise CrsError(
                f"Water at {height(water.z)} would not be flat in the vertical datum of "
                f"{self._target.label}: name the horizontal part of the CRS alone.",
                crs=self._target,
            )
        return Water(moved[:, :2], float(levels.mean()), name=water.name)
