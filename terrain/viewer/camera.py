"""Cameras: from where a terrain is seen, and how it fits into its part of the picture."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ...tin import Bounds

if TYPE_CHECKING:
    from ...base.arrays import Float64Array

_OVERHEAD = 89.5
"""Height of the viewer, degrees, from which on a view is a map."""

_POINTS = (
    "north",
    "north-northeast",
    "northeast",
    "east-northeast",
    "east",
    "east-southeast",
    "southeast",
    "south-southeast",
    "south",
    "south-southwest",
    "southwest",
    "west-southwest",
    "west",
    "west-northwest",
    "northwest",
    "north-northwest",
)


@dataclass(frozen=True, slots=True)
class View:
    """A direction to look from."""

    azimuth: float
    """Where the viewer stands, degrees clockwise from north."""
    height: float
    """Of the viewer above the horizon, degrees."""

    @classmethod
    def of(cls, camera: Any) -> View:
        """Return the direction from which a camera looks now."""
        _, up, toward = _read_axes(camera)
        height = math.degrees(math.asin(min(1.0, max(-1.0, toward[2]))))
        # From straight above, the foot of the picture is where the viewer stands.
        east, north = -up[:2] if height > _OVERHEAD else toward[:2]
        return cls(math.degrees(math.atan2(east, north)) % 360.0, height)

    @property
    def is_map(self) -> bool:
        """Whether this is a view from straight above."""
        return self.height > _OVERHEAD

    @property
    def caption(self) -> str:
        """The view in words.

        Examples
        --------
        >>> View(azimuth=88.0, height=20.0).caption
        'Parallel view from the east, 20° above the horizon'
        """
        if self.is_map:
            return "Map view, north up" if abs(self.azimuth - 180.0) < 0.5 else "Map view"
        point = name_direction(self.azimuth)
        side = "below" if self.height < -0.5 else "above"
        return f"Parallel view from the {point}, {abs(self.height):.0f}° {side} the horizon"

    @property
    def axes(self) -> Float64Array:
        """Unit vectors to the right, up the picture, and towards the viewer, (3, 3) rows."""
        azimuth, height = math.radians(self.azimuth), math.radians(self.height)
        east, north = math.sin(azimuth), math.cos(azimuth)
        return np.array(
            [
                [-north, east, 0.0],
                [-math.sin(height) * east, -math.sin(height) * north, math.cos(height)],
                [math.cos(height) * east, math.cos(height) * north, math.sin(height)],
            ]
        )


VIEWS = {"oblique": View(202.5, 35.0), "top": View(180.0, 90.0)}


def name_direction(azimuth: float) -> str:
    """Return the nearest of the 16 points of the compass.

    Examples
    --------
    >>> name_direction(200.0)
    'south-southwest'
    """
    return _POINTS[round(azimuth / 22.5) % 16]


def aim(
    camera: Any, points: Float64Array, *, view: View, frame: Bounds, size: tuple[int, int]
) -> None:
    """Point a camera so that all points just fit into a frame of the window.

    Parallel projection: one scale holds all over the picture. ``frame`` is in pixels from the lower
    left; ``size`` the width and height of the window in pixels.
    """
    right, up, _ = view.axes
    across, along = points @ right, points @ up
    drawn = Bounds(across.min(), along.min(), across.max(), along.max())
    # Seen from the side what is drawn may have no height.
    sides = ((frame.width, drawn.width), (frame.height, drawn.height))
    scale = min((room / side for room, side in sides if side > 0), default=1.0)
    middle = [
        part - (spot - full / 2) / scale
        for part, spot, full in zip(drawn.center, frame.center, size, strict=True)
    ]
    place_camera(camera, points, view=view, middle=(middle[0], middle[1]), height=size[1] / scale)


def place_camera(
    camera: Any,
    points: Float64Array,
    *,
    view: View,
    middle: tuple[float, float],
    height: float,
) -> None:
    """Place a camera so that a place across and along the picture is in its middle.

    ``points`` must lie in front of it; ``middle`` are lengths along the view's first two axes;
    ``height`` is that of the window, in lengths of the scene.
    """
    right, up, toward = view.axes
    depth = points @ toward
    focus = middle[0] * right + middle[1] * up + depth.mean() * toward
    distance = float(np.ptp(depth)) + float(np.ptp(points, axis=0).max())
    camera.parallel_projection = True
    camera.parallel_scale = height / 2
    camera.focal_point = focus
    camera.position = focus + max(distance, height) * toward
    camera.up = up


def measure_pixels_per_unit(camera: Any, height: float) -> float:
    """Return how many pixels a length of 1 takes across a picture of this height in pixels."""
    return float(height / 2 / camera.parallel_scale)


def project_ground_axes(camera: Any) -> Float64Array:
    """Return where east and north point in the picture, (2, 2) rows, foreshortened."""
    return _read_axes(camera)[:2, :2].T


def _read_axes(camera: Any) -> Float64Array:
    """Return a camera's unit vectors to the right, up and towards the viewer, (3, 3) rows."""
    toward = np.subtract(camera.position, camera.focal_point)
    toward /= np.linalg.norm(toward)
    right = np.cross(camera.up, toward)
    right /= np.linalg.norm(right)
    return np.array([right, np.cross(toward, right), toward])
