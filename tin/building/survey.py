"""Survey: elevation points as they were read, before triangulation."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.checks import as_flag
from ...base.crs import CRS, Unit, require_one_unit, shorten_crs
from ...base.errors import OptionError, PointsError
from ...base.lazy import make_html_repr
from ...base.ranges import require_degrees
from ...base.sentences import counted
from ...base.types import Bounds, Finding, RowSources
from ..constraints import Breakline, Water, as_sequence
from ..validation import Table, as_table, is_plain
from .attributes import as_columns, as_mapping
from .reference import settle_crs

if TYPE_CHECKING:
    from ...base.arrays import AnyArray, BoolArray, Float64Array

_LINES = ("breaklines", "boundary", "holes", "erase", "water", "extent")


@dataclass(frozen=True, eq=False, kw_only=True)
class Survey:
    """Elevation points with what is known about them.

    Attributes
    ----------
    points : (n, 3) float64 array
        Easting and northing in CRS units, elevation in ``elevation_unit``. Given as any table that
        :func:`tinsmith.triangulate` takes; masked points are left out.
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
        Further columns, one value a point (for example ``"number"`` and ``"description"``). Lists
        become arrays that hold their values as they are, of objects where those are of several
        types; what is masked becomes NaN or None.
    crs : CRS, optional
        Coordinate reference system; given as a code ("EPSG:32616"), number, WKT or ``pyproj.CRS``.
        Default that of the points or lines given, if they have one, as a GeoDataFrame has.
    elevation_unit : Unit, optional
        Unit of all elevations, those of lines included; given as Unit or text ("m", "US survey
        foot"). Default that of the CRS's vertical axis; None if it is not known.
    source : str, optional
        Name of the file that the points come from.
    from_raster : bool
        Whether the points are the cells of a raster: samples of a terrain without edges, over which
        slopes change evenly (:func:`tinsmith.hillshade`).
    skipped : mapping of str to int
        What the reader left out and how often, for example ``{"nodata cells": 12}``.
    skipped_lines : mapping of str to sequence of int
        Of a text file, the lines of the rows that were left out, counted from 1 as an editor does.
    notes : sequence of str
        What the reader assumed, in sentences.
    findings : sequence of Finding
        What was found odd, each with the rows that it is about; ``notes`` counts them.
    row_sources : RowSources, optional
        File and line of each point, where they were read from text.

    Raises
    ------
    CrsError
        If the CRS is unknown, or another than that of points or lines given.
    PointsError
        If points in a geographic CRS are no longitudes and latitudes.
    OptionError
        If the unit is unknown, or another than that of the CRS's vertical axis, or something has
        another type.
    LinesError
        If lines are no sequence.

    Examples
    --------
    >>> Survey(points=[[0, 0, 5], [4, 0, 6], [0, 3, 8]], crs="EPSG:32616")
    <Survey: 3 points, crs EPSG:32616>
    """

    points: Float64Array
    breaklines: Sequence[Breakline | Float64Array] = ()
    boundary: Sequence[Any] = ()
    holes: Sequence[Any] = ()
    erase: Sequence[Any] = ()
    water: Sequence[Water] = ()
    extent: Sequence[Float64Array] = ()
    attributes: Mapping[str, AnyArray] = field(default_factory=dict)
    crs: CRS | None = None
    elevation_unit: Unit | None = None
    source: str | None = None
    from_raster: bool = False
    skipped: Mapping[str, int] = field(default_factory=dict)
    skipped_lines: Mapping[str, Sequence[int]] = field(default_factory=dict)
    notes: Sequence[str] = ()
    findings: Sequence[Finding] = ()
    row_sources: RowSources | None = None

    def __post_init__(self) -> None:
        given = {"points": self.points} | {name: getattr(self, name) for name in _LINES}
        crs, told = settle_crs(CRS.of(self.crs), given)
        object.__setattr__(self, "crs", crs)
        unit = require_one_unit(crs, Unit.of(self.elevation_unit))
        object.__setattr__(self, "elevation_unit", unit)
        for name in _LINES:
            object.__setattr__(self, name, _as_lines(getattr(self, name), name))
        object.__setattr__(self, "skipped", as_mapping("skipped", self.skipped))
        object.__setattr__(self, "skipped_lines", as_mapping("skipped_lines", self.skipped_lines))
        # refuse a source that is no text, and notes that are no sequence of texts
        notes = self.notes
        if not isinstance(notes, tuple | list) or not all(isinstance(note, str) for note in notes):
            raise OptionError("notes", notes, "a list of sentences")
        if not isinstance(self.source, str | None):
            raise OptionError("source", self.source, "text or None")
        as_flag("from_raster", self.from_raster)
        if told:
            object.__setattr__(self, "notes", [*self.notes, *told])
        table = Table(self.points) if _is_plain(self.points) else as_table(self.points, "Points")
        if table.values.ndim != 2 and table.values.shape != (0,):
            raise PointsError(f"Points have shape {table.values.shape}: (n, 3) is needed.")
        if table.values.ndim == 2 and table.values.shape[1] >= 2:
            require_degrees(table.values, crs, "Points")
        object.__setattr__(self, "points", table.values)
        columns = as_columns(self.attributes, table.values.shape[:1])
        object.__setattr__(self, "attributes", columns)
        # refuse sources that are none; where points were left out nothing is known of the others
        sources = self.row_sources
        if not isinstance(sources, RowSources | None):
            raise OptionError("row_sources", sources, "RowSources or None")
        if sources is not None and len(sources.lines) != len(self.points):
            object.__setattr__(self, "row_sources", None)
        if table.is_masked is not None:
            self._leave_out(table.is_masked)

    def _leave_out(self, is_masked: BoolArray) -> None:
        columns = {name: values[~is_masked] for name, values in self.attributes.items()}
        object.__setattr__(self, "points", self.points[~is_masked])
        object.__setattr__(self, "attributes", columns)
        if self.row_sources is not None:
            object.__setattr__(self, "row_sources", self.row_sources.take(~is_masked))
        masked = {"masked points": int(is_masked.sum())}
        object.__setattr__(self, "skipped", {**self.skipped, **masked})

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
        return (
            f"<Survey: {counted(len(self), 'point')}{origin}{names}, crs {shorten_crs(self.crs)}>"
        )

    def _repr_html_(self) -> str:
        return make_html_repr(self)


def _as_lines(lines: Any, name: str) -> Sequence[Any]:
    """Return several lines or rings as a sequence; one alone is told from several."""
    is_ready = isinstance(lines, tuple | list) and all(map(_is_ready, lines))
    return lines if is_ready else as_sequence(lines, name)


def _is_ready(line: Any) -> bool:
    return isinstance(line, Breakline | Water) or is_plain(line)


def _is_plain(points: Any) -> bool:
    return type(points) is np.ndarray and points.dtype == np.float64
