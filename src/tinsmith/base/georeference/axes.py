"""Axes: where coordinates grow, which in some CRSs is to the west or to the south."""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..crs import CRS

if TYPE_CHECKING:
    from ..arrays import Float64Array

_VECTORS = {"east": (1.0, 0.0), "west": (-1.0, 0.0), "north": (0.0, 1.0), "south": (0.0, -1.0)}


class Label(NamedTuple):
    """How the coordinates along a side of a map are written."""

    name: str
    """Such as "easting" or "westing"."""
    sign: float
    """What makes the coordinate of the CRS of the one along the side."""

    def of(self, value: float) -> float:
        """Return the coordinate to write; 0 has no sign."""
        return self.sign * value + 0.0


_USUAL = (Label("easting", 1.0), Label("northing", 1.0))


class Axes(NamedTuple):
    """The directions in which coordinates of a CRS grow."""

    first: str = "east"
    second: str = "north"
    """"east", "west", "north" or "south"."""

    @property
    def are_usual(self) -> bool:
        """Whether the first grows to the east, the second to the north."""
        return self == _EAST_NORTH

    @property
    def are_mirrored(self) -> bool:
        """Whether left and right are exchanged in their plane."""
        return float(np.linalg.det(self.matrix)) < 0

    @property
    def matrix(self) -> Float64Array:
        """(2, 2), by which vectors of coordinates become vectors to the east and the north."""
        return np.array([_VECTORS[self.first], _VECTORS[self.second]]).T

    @property
    def labels(self) -> tuple[Label, Label]:
        """What is written along a map with north up, across and up."""
        names = (self.first, self.second)
        across, up = (int(np.flatnonzero(row)[0]) for row in self.matrix)
        return (
            Label(f"{names[across]}ing", float(self.matrix[0, across])),
            Label(f"{names[up]}ing", float(self.matrix[1, up])),
        )

    def turn(self, places: Any, *, back: bool = False) -> Float64Array:
        """Return coordinates, (..., 2 or more), as those to the east and north, or back again.

        What lies behind the first two stays.
        """
        turned = np.array(places, np.float64)
        turned[..., :2] = turned[..., :2] @ (self.matrix if back else self.matrix.T) + 0.0
        return turned


_EAST_NORTH = Axes()


class DrawnCRS(CRS):
    """The CRS of coordinates that were turned to the east and the north for a drawing.

    It equals the CRS that they had, and knows how that one's coordinates are written.
    """

    __slots__ = ("axes",)

    def __init__(self, crs: CRS, axes: Axes) -> None:
        super().__init__(crs)
        self.axes = axes

    @property
    def horizontal(self) -> CRS:
        """The CRS without its vertical part."""
        return DrawnCRS(super().horizontal, self.axes)

    def __reduce__(self) -> tuple[Any, ...]:
        return DrawnCRS, (CRS(str(self)), self.axes)


def find_axes(crs: CRS | None) -> Axes:
    """Return the directions of the axes of a CRS; east and north if it is not known.

    Longitudes and latitudes, and the grids around the poles, whose axes follow meridians, are taken
    as east and north.

    Examples
    --------
    >>> find_axes(CRS("EPSG:2048"))  # Hartebeesthoek94 / Lo19
    Axes(first='west', second='south')
    """
    if crs is None or isinstance(crs, DrawnCRS):
        return _EAST_NORTH
    return _read_axes(str(crs))


@lru_cache(maxsize=128)
def _read_axes(text: str) -> Axes:
    crs = CRS(text)
    directions = [str(axis.direction) for axis in crs.to_pyproj().axis_info[:2]]
    if crs.is_geographic or directions == ["north", "east"]:  # which are handed over exchanged
        return _EAST_NORTH
    is_cross = sum(one in ("east", "west") for one in directions) == 1
    if not is_cross or any(one not in _VECTORS for one in directions):
        return _EAST_NORTH
    return Axes(*directions)


def gives_northing_first(crs: CRS) -> bool:
    """Whether a CRS names the northing, or the latitude, before the easting or longitude.

    Examples
    --------
    >>> gives_northing_first(CRS("EPSG:2180")), gives_northing_first(CRS("EPSG:32616"))
    (True, False)
    """
    axes = crs.to_pyproj().axis_info[:2]
    return [str(axis.direction) for axis in axes] == ["north", "east"]


def label_axes(crs: CRS | None) -> tuple[Label, Label]:
    """Return how coordinates are written across and up a map."""
    return crs.axes.labels if isinstance(crs, DrawnCRS) else _USUAL


def turn_into_drawing(places: Any, crs: CRS | None) -> Any:
    """Return places in coordinates of a CRS as a drawing in it has them."""
    return crs.axes.turn(places) if isinstance(crs, DrawnCRS) else places


def undo_north_up(places: Any, crs: CRS | None) -> Any:
    """Return places of a drawing in coordinates of the CRS that what is drawn had."""
    return crs.axes.turn(places, back=True) if isinstance(crs, DrawnCRS) else places
