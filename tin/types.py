"""Small value types that replace bare tuples."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["Bounds", "Grid"]


@dataclass(frozen=True, slots=True)
class Bounds:
    """An axis-aligned rectangle, in CRS units.

    Attributes
    ----------
    xmin, ymin, xmax, ymax : float
        West, south, east and north limit.

    Examples
    --------
    >>> Bounds(0.0, 0.0, 3.0, 4.0).diagonal
    5.0
    """

    xmin: float
    ymin: float
    xmax: float
    ymax: float

    @classmethod
    def of(cls, points: NDArray[np.float64]) -> Bounds:
        """Return the bounds of ``points``, an (n, 2) or (n, 3) array with n >= 1."""
        xmin, ymin = points[:, :2].min(axis=0)
        xmax, ymax = points[:, :2].max(axis=0)
        return cls(float(xmin), float(ymin), float(xmax), float(ymax))

    @property
    def width(self) -> float:
        """Extent from west to east."""
        return self.xmax - self.xmin

    @property
    def height(self) -> float:
        """Extent from south to north."""
        return self.ymax - self.ymin

    @property
    def diagonal(self) -> float:
        """Length of the diagonal."""
        return float(np.hypot(self.width, self.height))

    @property
    def center(self) -> tuple[float, float]:
        """Easting and northing of the middle."""
        return (self.xmin + self.width / 2, self.ymin + self.height / 2)


@dataclass(frozen=True, slots=True)
class Grid:
    """A regular grid of cells; row 0 is the northernmost.

    Attributes
    ----------
    bounds : Bounds
        Outer edges of the outermost cells.
    shape : tuple of int
        (rows, columns).
    spacing : float
        Side of one square cell, CRS units.
    """

    bounds: Bounds
    shape: tuple[int, int]
    spacing: float
