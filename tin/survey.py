"""Survey: elevation points as they were read, before triangulation."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from .lines import Breakline, Water
from .tables import as_table
from .types import Bounds

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["Survey"]


@dataclass(frozen=True, eq=False, kw_only=True)
class Survey:
    """Elevation points with what is known about them.

    Attributes
    ----------
    points : (n, 3) float64 array
        Given as any table that :func:`tinsmith.triangulate` takes; masked points are left out.
        Easting, northing, elevation; CRS units, elevation in metres unless the CRS says otherwise.
    breaklines : sequence of Breakline or (k, 3) or (k, 2) arrays
        Polylines that must be edges of the surface; with two columns draped on it.
    boundary : sequence of (k, 3) or (k, 2) arrays, or polygons
        Outer rings: the surface ends there.
    holes : sequence of (k, 3) or (k, 2) arrays, or polygons
        Rings without surface inside; a polygon's islands stay.
    erase : sequence of (k, 2) arrays, or polygons
        Rings inside which points are left out; the surface spans them.
    water : sequence of Water
        Flat polygons.
    extent : sequence of (k, 3) arrays
        Rings around the data, such as those a raster's voids leave: there is surface only where an
        odd number of them holds the place.
    attributes : mapping of str to (n,) array
        Further columns, one value a point (for example ``"number"`` and ``"description"``).
    crs : str, optional
        Coordinate reference system: an authority code ("EPSG:32616") or WKT.
    source : str, optional
        Name of the file that the points come from.
    skipped : mapping of str to int
        What the reader left out and how often, for example ``{"nodata cells": 12}``.
    skipped_lines : mapping of str to sequence of int
        Of a text file, the lines of the rows that were left out, counted from 1 as an editor does.
    notes : sequence of str
        What the reader assumed, in sentences.
    """

    points: NDArray[np.float64]
    breaklines: Sequence[Breakline | NDArray[np.float64]] = ()
    boundary: Sequence[Any] = ()
    holes: Sequence[Any] = ()
    erase: Sequence[Any] = ()
    water: Sequence[Water] = ()
    extent: Sequence[NDArray[np.float64]] = ()
    attributes: Mapping[str, NDArray[Any]] = field(default_factory=dict)
    crs: str | None = None
    source: str | None = None
    skipped: Mapping[str, int] = field(default_factory=dict)
    skipped_lines: Mapping[str, Sequence[int]] = field(default_factory=dict)
    notes: Sequence[str] = ()

    def __post_init__(self) -> None:
        if not _is_plain(self.points):
            self._clean_points()

    def _clean_points(self) -> None:
        """Take columns by their names, and leave out what is masked."""
        table = as_table(self.points, "Points")
        points, attributes = table.values, self.attributes
        if table.is_masked is not None:
            keep = ~table.is_masked
            points = points[keep]
            attributes = {name: np.asarray(v)[keep] for name, v in attributes.items()}
            masked = {"masked points": int(table.is_masked.sum())}
            object.__setattr__(self, "skipped", {**self.skipped, **masked})
        object.__setattr__(self, "points", points)
        object.__setattr__(self, "attributes", attributes)

    @property
    def bounds(self) -> Bounds:
        """Bounds of the points (at least one point)."""
        return Bounds.of(self.points)

    @property
    def has_lines(self) -> bool:
        """Whether there is more than points."""
        return any((self.breaklines, self.boundary, self.holes, self.erase, self.water))

    def __len__(self) -> int:
        return len(self.points)

    def __repr__(self) -> str:
        origin = f" from {self.source}" if self.source else ""
        names = f", attributes {', '.join(self.attributes)}" if self.attributes else ""
        return f"<Survey: {len(self)} points{origin}{names}, crs {_short(self.crs)}>"


def _is_plain(points: Any) -> bool:
    return type(points) is np.ndarray and points.dtype == np.float64


def _short(crs: str | None) -> str:
    """Shorten a CRS text to fit a one-line repr."""
    if crs is None:
        return "unknown"
    return crs if len(crs) <= 24 else crs[:21] + "..."
