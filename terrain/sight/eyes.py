"""Eyes above a surface, and how they see."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...base.checks import as_length
from ...base.errors import PointsError
from ..surface import as_places
from .lines import as_height, raise_places

if TYPE_CHECKING:
    from ...base.arrays import Float64Array
    from ...tin import TIN


class View(NamedTuple):
    """An eye, and how it sees."""

    eye: Float64Array
    target_height: float
    radius: float
    fall: float


def as_view(
    tin: TIN, eye: Any, heights: tuple[Any, Any], radius: Any, fall: float
) -> tuple[View, tuple[str, ...]]:
    """Return how an eye sees, from what a caller gives, and what is to be told about it."""
    above = as_height("eye_height", heights[0]), as_height("target_height", heights[1])
    reach = np.inf if radius is None else as_length("radius", radius, or_none=True)
    xy, notes = as_places(tin, eye, "the eye")
    if len(xy) != 1:
        raise PointsError(f"There are {len(xy)} eyes: a viewshed has one.")
    return View(raise_places(tin, xy, above[0])[0], above[1], reach, fall), notes


def measure_distances(points: Float64Array, eye: Float64Array) -> Float64Array:
    """Return the distances of points from the eye in the plane."""
    found: Float64Array = np.hypot(points[:, 0] - eye[0], points[:, 1] - eye[1])
    return found
