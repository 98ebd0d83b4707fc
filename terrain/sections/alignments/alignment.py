"""Alignments: an axis of lines, arcs and transition curves, with stations and elevations."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from ....base.checks import as_length, as_number
from ....base.crs import CRS, Unit, scale_elevations
from ....base.errors import LinesError, OptionError, PointsError
from ....base.georeference import find_axes, require_same_crs
from ....base.notes import as_notes
from ....base.results import Features, Table
from ....base.sentences import coordinate, counted, inflect, shown
from ....tin.building import find_crs
from .arguments import as_numbers, as_places
from .elements import Element, measure_elements
from .nearest import Pieces, cut_pieces, find_nearest
from .stationing import StationEquation, Stationing
from .verticals import VerticalAlignment

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from ....base.arrays import Float64Array, Int64Array
    from .nearest import Feet

_GAP = 0.05
"""CRS units: what coordinates of files that are rounded leave between elements, at most."""

_STRAIGHT = 1e-9
"""Size of the sum of two unit vectors that are opposite."""

_MOST_VERTICES = 10_000_000


@dataclass(frozen=True, eq=False, repr=False)
class Alignment:
    """A horizontal alignment, with its stations and vertical alignments.

    Attributes
    ----------
    elements : sequence of Element
        Each begins where the one before ends. Tangents may break: polylines are alignments.
    name : str
    start : float
        Station where it begins, CRS units.
    equations : sequence of StationEquation
        In order; empty if stations are written on from ``start``.
    verticals : sequence of VerticalAlignment
        Designed elevations.
    crs : CRS, optional
    elevation_unit : Unit, optional
        Of vertical alignments; default that of the CRS.
    notes : sequence of str
        What was assumed or left out.

    Raises
    ------
    LinesError
        If there is no element, or one does not begin where the one before ends.
    OptionError
        If an equation lies off the alignment, two vertical alignments have the same name, or one
        has arcs and its elevations are in another unit than stations.
    CrsError
        If coordinates are angles.

    Notes
    -----
    Stations that are passed in and returned are lengths along the elements, from ``start`` on, in
    the plane of the CRS; :meth:`written_stations` and :meth:`find_stations` turn them into those
    that are written, and back, where there are equations. Nothing is replaced by chords.

    Examples
    --------
    >>> import tinsmith as ts
    >>> road = ts.Alignment.from_points([[0, 0], [100, 0], [100, 100]], radii=[40])
    >>> road
    <Alignment: 3 elements, from 0 to 182.832>
    >>> road.points_at([0.0, 60.0])
    array([[ 0.,  0.],
           [60.,  0.]])
    """

    elements: Sequence[Element]
    name: str = field(default="", kw_only=True)
    start: float = field(default=0.0, kw_only=True)
    equations: Sequence[StationEquation] = field(default=(), kw_only=True)
    verticals: Sequence[VerticalAlignment] = field(default=(), kw_only=True)
    crs: CRS | None = field(default=None, kw_only=True)
    elevation_unit: Unit | None = field(default=None, kw_only=True)
    notes: Sequence[str] = field(default=(), kw_only=True)

    def __post_init__(self) -> None:
        keep = object.__setattr__
        keep(self, "elements", tuple(self.elements))
        keep(self, "start", as_number("start", self.start))
        keep(self, "equations", tuple(self.equations))
        keep(self, "verticals", tuple(self.verticals))
        crs = CRS.of(self.crs)
        unit = Unit.of(self.elevation_unit)
        keep(self, "crs", crs)
        keep(self, "elevation_unit", unit or (None if crs is None else crs.vertical_unit))
        keep(self, "notes", as_notes(self.notes))
        scale = scale_elevations(crs, self.elevation_unit)  # which refuses angles
        if not self.elements:
            raise LinesError("An alignment has no element: at least one is needed.")
        _require_joined(self.elements)
        if crs is not None and scale != 1.0 and any(one.has_arcs for one in self.verticals):
            allowed = (
                f"{crs.horizontal_unit.name}, that of stations, where vertical curves are arcs"
            )
            raise OptionError("elevation_unit", str(self.elevation_unit), allowed)
        names = [one.name for one in self.verticals]
        if len(set(names)) < len(names):
            allowed = "a name of its own for each"
            raise OptionError("names of vertical alignments", names, allowed=allowed)
        _ = self._zones  # which refuses equations that are none

    @classmethod
    def from_points(
        cls,
        points: ArrayLike | Any,
        *,
        radii: ArrayLike | None = None,
        transitions: ArrayLike | None = None,
        **more: Any,
    ) -> Alignment:
        """Return an alignment of the points where its tangents meet.

        Parameters
        ----------
        points : (k, 2) array
            Its first point, points of intersection (PI), and its last point, CRS units.
        radii : float or (k - 2,) array, optional
            Of the arc at each point of intersection, CRS units; 0 for a break.
        transitions : float or (k - 2,) array, optional
            Length of the clothoids before and behind each arc, CRS units; 0 for none.
        **more
            Further attributes of the alignment.

        Returns
        -------
        Alignment

        Raises
        ------
        LinesError
            If points are none, or two that follow each other are the same, or there is no room for
            a curve between them.
        OptionError
            If radii or lengths are no numbers from 0 on, or not one for each.

        Examples
        --------
        >>> import tinsmith as ts
        >>> corner = [[0, 0], [100, 0], [100, 100]]
        >>> road = ts.Alignment.from_points(corner, radii=40, transitions=20)
        >>> [element.kind for element in road.elements]
        ['line', 'clothoid', 'arc', 'clothoid', 'line']
        """
        from .construction import lay_elements

        return cls(lay_elements(points, radii, transitions), **more)

    @cached_property
    def _pieces(self) -> Pieces:
        return cut_pieces(self.elements)

    @cached_property
    def _ends(self) -> Float64Array:
        """Stations where elements begin, and of the end."""
        return np.cumsum([self.start, *(one.length for one in self.elements)])

    @property
    def end(self) -> float:
        """Station where it ends, CRS units."""
        return float(self._ends[-1])

    @property
    def length(self) -> float:
        """CRS units."""
        return math.fsum(one.length for one in self.elements)

    # ---------------------------------------------------------------- at stations

    def points_at(self, stations: ArrayLike, *, offset: ArrayLike = 0.0) -> Float64Array:
        """Return the points at stations, or beside them.

        Parameters
        ----------
        stations : (n,) array
            CRS units.
        offset : float or (n,) array
            To the right, or negative to the left, square to the tangent, CRS units.

        Returns
        -------
        (n, 2) float64 array
            CRS units.

        Raises
        ------
        OptionError
            If a station lies off the alignment, or is no number.

        Examples
        --------
        >>> import tinsmith as ts
        >>> ts.Alignment.from_points([[0, 0], [10, 0]]).points_at([4.0], offset=-1.0)
        array([[4., 1.]])
        """
        element, along = self._find_elements(stations)
        places, tangents = measure_elements(self.elements, element, along)
        aside = as_numbers("offset", offset, len(along))
        left = tangents[:, ::-1] * ([1.0, -1.0] if self._is_mirrored else [-1.0, 1.0])
        beside: Float64Array = places - left * aside[:, None] + 0.0
        return beside

    def tangents_at(self, stations: ArrayLike, *, mean: bool = False) -> Float64Array:
        """Return the directions of the alignment at stations; at a break that of what follows.

        Parameters
        ----------
        stations : (n,) array
            CRS units.
        mean : bool
            At a break the mean of both directions instead, or that of what ends there if they are
            opposite.

        Returns
        -------
        (n, 2) float64 array
            Unit vectors.

        Raises
        ------
        OptionError
            As :meth:`points_at`.

        Examples
        --------
        >>> import tinsmith as ts
        >>> ts.Alignment.from_points([[0, 0], [10, 0]]).tangents_at([4.0])
        array([[1., 0.]])
        """
        element, along = self._find_elements(stations)
        tangents = measure_elements(self.elements, element, along)[1]
        is_break = (element > 0) & (along <= self.rounding)
        if not (mean and is_break.any()):
            return tangents
        before = np.array([self.elements[k - 1].end_direction for k in element[is_break].tolist()])
        back = np.column_stack([np.cos(before), np.sin(before)])
        both = back + tangents[is_break]
        size = np.hypot(both[:, 0], both[:, 1])[:, None]
        is_known = size > _STRAIGHT
        tangents[is_break] = np.where(is_known, both / np.where(is_known, size, 1.0), back)
        return tangents

    def elevations_at(self, stations: ArrayLike, vertical: str | None = None) -> Float64Array:
        """Return designed elevations at stations.

        Parameters
        ----------
        stations : (n,) array
            CRS units.
        vertical : str, optional
            Name of the vertical alignment, needed if there are several.

        Returns
        -------
        (n,) float64 array
            In ``elevation_unit``; NaN where the vertical alignment is not.

        Raises
        ------
        OptionError
            If there is no such vertical alignment, or as :meth:`points_at`.

        Examples
        --------
        >>> import tinsmith as ts
        >>> rise = ts.VerticalAlignment([ts.VerticalPoint(0, 5.0), ts.VerticalPoint(10, 6.0)])
        >>> ts.Alignment.from_points([[0, 0], [10, 0]], verticals=[rise]).elevations_at([5.0])
        array([5.5])
        """
        element, along = self._find_elements(stations)
        return self.find_vertical(vertical).elevations_at(self._ends[element] + along)

    def find_vertical(self, name: str | None = None) -> VerticalAlignment:
        """Return the vertical alignment of a name, or the only one.

        Parameters
        ----------
        name : str, optional

        Returns
        -------
        VerticalAlignment

        Raises
        ------
        OptionError
            If there is none, or none of the name.
        LinesError
            If there are several, and no name is given.

        Examples
        --------
        >>> import tinsmith as ts
        >>> rise = ts.VerticalAlignment([ts.VerticalPoint(0, 5), ts.VerticalPoint(10, 6)], "design")
        >>> ts.Alignment.from_points([[0, 0], [10, 0]], verticals=[rise]).find_vertical()
        <VerticalAlignment design: 2 points, from 0 to 10>
        """
        fitting = [one for one in self.verticals if name is None or one.name == name]
        if len(fitting) != 1:
            names = ", ".join(shown(one.name) for one in self.verticals) or "none: there is none"
            if name is None and fitting:
                count = counted(len(fitting), "gradient line")
                raise LinesError(f"The alignment has {count}: name one by `vertical`, of {names}.")
            raise OptionError("vertical", name, allowed=f"one of {names}")
        return fitting[0]

    # ---------------------------------------------------------------- of points

    def stations_of(self, points: Any) -> Table:
        """Return stations and offsets of points: of the nearest place of the alignment.

        Parameters
        ----------
        points : (n, 2) or (n, 3) array, Features, geometries or data frame
            CRS units.

        Returns
        -------
        Table
            A row for each point: ``x``, ``y``, ``station``, ``offset`` (to the right, negative to
            the left), ``element`` (its number from 0), and ``written_station`` if there are station
            equations. Before the start and beyond the end both are NaN, and ``element`` is -1.

        Raises
        ------
        PointsError
            If there is no point, or one is not finite.
        CrsError
            If they are in another CRS.

        Notes
        -----
        The place is exactly nearest to some roundings of coordinates. Of several places as near,
        as from the centre of an arc, the first is taken, and noted.

        Examples
        --------
        >>> import tinsmith as ts
        >>> road = ts.Alignment.from_points([[0, 0], [100, 0], [100, 100]], radii=[40])
        >>> table = road.stations_of([[30, -2], [110, 90]])
        >>> table["station"].round(3), table["offset"].round(3)
        (array([ 30.   , 172.832]), array([ 2., 10.]))
        """
        is_named = isinstance(points, Features)
        theirs = points.crs if is_named else find_crs(points)
        notes = require_same_crs(theirs, self.crs, "the points", is_plain=not is_named)
        if is_named:
            notes = (*points.notes, *notes)
            points = points.coordinates
        xy = as_places(points) + 0.0
        if len(xy) == 0:
            raise PointsError("There is no point: at least one is needed.")
        feet = find_nearest(self.elements, self._pieces, xy)
        station = np.where(feet.is_beyond, np.nan, self._ends[feet.elements] + feet.distances)
        sign = 1.0 if self._is_mirrored else -1.0
        columns: dict[str, Any] = {"x": xy[:, 0], "y": xy[:, 1], "station": station}
        columns["offset"] = np.where(feet.is_beyond, np.nan, sign * feet.offsets + 0.0)
        columns["element"] = np.where(feet.is_beyond, -1, feet.elements)
        if self.equations:
            columns["written_station"] = self.written_stations(station)
        unit = None if self.crs is None else self.crs.horizontal_unit
        return Table(
            columns,
            units=dict.fromkeys((one for one in columns if one != "element"), unit),
            name="stations",
            notes=[*self.notes, *notes, *_describe_feet(feet)],
        )

    # ---------------------------------------------------------------- written stations

    def written_stations(self, stations: ArrayLike) -> Float64Array:
        """Return what is written at stations: the same but behind station equations.

        Parameters
        ----------
        stations : (n,) array
            Lengths from ``start`` on, CRS units.

        Returns
        -------
        (n,) float64 array
            CRS units; at an equation that of what follows.

        Examples
        --------
        >>> import tinsmith as ts
        >>> jump = ts.StationEquation(40.0, ahead=100.0)
        >>> road = ts.Alignment.from_points([[0, 0], [100, 0]], equations=[jump])
        >>> road.written_stations([30.0, 50.0])
        array([ 30., 110.])
        """
        return self._zones.write(np.atleast_1d(np.asarray(stations, np.float64)))

    def find_stations(self, written: ArrayLike, zone: int | None = None) -> Float64Array:
        """Return the stations of what is written.

        Parameters
        ----------
        written : (n,) array
            CRS units.
        zone : int, optional
            Number of the zone between station equations, from 1; needed where two have the same.

        Returns
        -------
        (n,) float64 array
            Lengths from ``start`` on, CRS units.

        Raises
        ------
        OptionError
            If a station is written nowhere, or at several places and no zone is given.

        Examples
        --------
        >>> import tinsmith as ts
        >>> jump = ts.StationEquation(40.0, ahead=100.0)
        >>> road = ts.Alignment.from_points([[0, 0], [100, 0]], equations=[jump])
        >>> road.find_stations([110.0])
        array([50.])
        """
        return self._zones.find(as_numbers("stations", written), zone, self.rounding)

    # ---------------------------------------------------------------- as other things

    def to_features(self, tolerance: float, *, vertical: str | None = None) -> Features:
        """Return it as a polyline that lies within a tolerance of it.

        Parameters
        ----------
        tolerance : float
            How far curves may lie from their chords, CRS units.
        vertical : str, optional
            Name of a vertical alignment, whose elevations the vertices get, within the tolerance as
            well; "" where the only one has no name.

        Returns
        -------
        Features
            One line with a column ``name``.

        Raises
        ------
        OptionError
            If the tolerance is no length, or needs more than 10,000,000 vertices; if there is no
            such vertical alignment, or it does not cover the alignment.

        Examples
        --------
        >>> import tinsmith as ts
        >>> road = ts.Alignment.from_points([[0, 0], [100, 0], [100, 100]], radii=[40])
        >>> len(road.to_features(0.01).coordinates)
        39
        """
        stations = self.cut_into_chords(as_length("tolerance", tolerance))
        if vertical is None:
            coordinates = self.points_at(stations)
        else:
            profile = self.find_vertical(vertical)
            at = profile.cut_into_chords(tolerance)
            inner: Float64Array = at[(at > stations[0]) & (at < stations[-1])]
            stations = np.union1d(stations, inner)
            elevations = profile.elevations_at(stations)
            if np.isnan(elevations).any():
                allowed = (
                    f"one from {coordinate(self.start)} to {coordinate(self.end)}, and it goes "
                    f"from {coordinate(profile.start)} to {coordinate(profile.end)}"
                )
                raise OptionError("vertical", vertical, allowed=allowed)
            coordinates = np.column_stack([self.points_at(stations), elevations])
        return Features.of_lines(
            coordinates,
            [0, len(coordinates)],
            columns={"name": np.array([self.name], object)},
            crs=self.crs,
            elevation_unit=self.elevation_unit if vertical is not None else None,
            name=self.name,
            notes=self.notes,
        )

    def cut_into_chords(self, tolerance: float) -> Float64Array:
        """Return stations between which it lies within a tolerance of its chords.

        Parameters
        ----------
        tolerance : float
            CRS units.

        Returns
        -------
        (n,) float64 array
            CRS units, in ascending order, of its ends and those of all elements among them.

        Raises
        ------
        OptionError
            If these were more than 10,000,000.

        Examples
        --------
        >>> import tinsmith as ts
        >>> ts.Alignment.from_points([[0, 0], [100, 0]]).cut_into_chords(0.01)
        array([  0., 100.])
        """
        counts = [
            max(1, math.ceil(one.length * math.sqrt(one.largest_curvature / (8.0 * tolerance))))
            for one in self.elements
        ]
        if sum(counts) > _MOST_VERTICES:
            allowed = f"one for which at most {_MOST_VERTICES:,} chords are made"
            raise OptionError("tolerance", tolerance, allowed=allowed)
        steps = [
            np.linspace(begin, end, count + 1)[:-1]
            for begin, end, count in zip(self._ends[:-1], self._ends[1:], counts, strict=True)
        ]
        return np.concatenate([*steps, self._ends[-1:]])

    def tabulate(self) -> Table:
        """Return its elements as a table.

        Returns
        -------
        Table
            A row for each element: ``element``, ``kind``, ``station``, ``length``, ``x``, ``y`` and
            ``azimuth`` where it begins (degrees clockwise from grid north), ``start_radius`` and
            ``end_radius`` (above 0 to the right, below to the left, NaN where it is straight).

        Examples
        --------
        >>> import tinsmith as ts
        >>> road = ts.Alignment.from_points([[0, 0], [100, 0], [100, 100]], radii=[40])
        >>> table = road.tabulate()
        >>> table["kind"].tolist(), table["start_radius"].tolist()
        (['line', 'arc', 'line'], [nan, -40.0, nan])
        """
        elements = self.elements
        radii = np.array([(one.start_curvature, one.end_curvature) for one in elements])
        sign = 1.0 if self._is_mirrored else -1.0
        with np.errstate(divide="ignore"):
            radii = np.where(radii == 0.0, np.nan, sign / radii)
        directions = np.array([one.direction for one in elements])
        vectors = np.stack([np.cos(directions), np.sin(directions)], axis=1)
        starts = np.array([one.start for one in elements])
        columns: dict[str, Any] = {
            "element": np.arange(len(elements)),
            "kind": np.array([one.kind for one in elements], object),
            "station": self._ends[:-1],
            "length": np.array([one.length for one in elements]),
            "x": starts[:, 0],
            "y": starts[:, 1],
            "azimuth": self._find_azimuths(vectors),
            "start_radius": radii[:, 0],
            "end_radius": radii[:, 1],
        }
        unit = None if self.crs is None else self.crs.horizontal_unit
        units: dict[str, Any] = dict.fromkeys(
            ("station", "length", "x", "y", "start_radius", "end_radius"), unit
        )
        units["azimuth"] = "°"
        return Table(columns, units=units, name=self.name or "alignment", notes=self.notes)

    def tabulate_points(self, interval: float, *, offset: float = 0.0) -> Table:
        """Return points along it as a table: at multiples of an interval, and where elements meet.

        Parameters
        ----------
        interval : float
            CRS units.
        offset : float
            Of the points, to the right, negative to the left, CRS units.

        Returns
        -------
        Table
            ``station`` (and ``written_station`` with station equations), ``offset``, ``x``, ``y``,
            ``azimuth`` of the tangent, and ``elevation`` if there is one vertical alignment.

        Raises
        ------
        OptionError
            If the interval is no length, or makes more than 10,000,000 points.

        Examples
        --------
        >>> import tinsmith as ts
        >>> table = ts.Alignment.from_points([[0, 0], [10, 0]]).tabulate_points(4.0)
        >>> table["station"], table["x"]
        (array([ 0.,  4.,  8., 10.]), array([ 0.,  4.,  8., 10.]))
        """
        step = as_length("interval", interval)
        if self.length / step > _MOST_VERTICES:
            allowed = f"one that makes at most {_MOST_VERTICES:,} points"
            raise OptionError("interval", interval, allowed=allowed)
        multiples = np.arange(math.ceil(self.start / step), math.floor(self.end / step) + 1) * step
        nearest = np.clip(np.searchsorted(self._ends, multiples), 1, len(self._ends) - 1)
        away = np.minimum(self._ends[nearest] - multiples, multiples - self._ends[nearest - 1])
        at = np.union1d(self._ends, multiples[away > self.rounding])
        places, tangents = self.points_at(at, offset=offset), self.tangents_at(at)
        columns: dict[str, Any] = {"station": at}
        if self.equations:
            columns["written_station"] = self.written_stations(at)
        columns |= {"offset": np.full(len(at), float(offset)), "x": places[:, 0], "y": places[:, 1]}
        unit = None if self.crs is None else self.crs.horizontal_unit
        units: dict[str, Any] = dict.fromkeys(columns, unit)
        columns["azimuth"] = self._find_azimuths(tangents)
        units["azimuth"] = "°"
        if len(self.verticals) == 1:
            columns["elevation"] = self.verticals[0].elevations_at(at)
            units["elevation"] = self.elevation_unit
        return Table(columns, units=units, name=self.name or "alignment", notes=self.notes)

    # ---------------------------------------------------------------- inside

    def _find_azimuths(self, vectors: Float64Array) -> Float64Array:
        """Return degrees clockwise from grid north."""
        east, north = find_axes(self.crs).turn(vectors).T
        azimuths: Float64Array = np.degrees(np.arctan2(east, north)) % 360.0
        return azimuths

    @cached_property
    def _zones(self) -> Stationing:
        return Stationing(self.start, self.end, tuple(self.equations))

    @property
    def rounding(self) -> float:
        """How far stations may be off by the rounding of coordinates, CRS units."""
        size = max(np.abs(self._pieces.places).max(), np.abs(self._ends).max())
        return float(8.0 * np.spacing(size)) * math.sqrt(len(self.elements))

    @property
    def _is_mirrored(self) -> bool:
        return find_axes(self.crs).are_mirrored

    def _find_elements(self, stations: ArrayLike) -> tuple[Int64Array, Float64Array]:
        """Return the element of each station, the one that begins there, and how far along."""
        at = as_numbers("stations", stations)
        off = ~((at >= self.start - self.rounding) & (at <= self.end + self.rounding))
        if off.any():
            allowed = f"from {coordinate(self.start)} to {coordinate(self.end)}, on the alignment"
            raise OptionError("station", float(at[np.argmax(off)]), allowed=allowed)
        element = np.searchsorted(self._ends[1:-1], at, side="right")
        lengths = np.array([one.length for one in self.elements])
        return element, np.clip(at - self._ends[element], 0.0, lengths[element])

    def __repr__(self) -> str:
        title = f" {self.name}" if self.name else ""
        crs = "" if self.crs is None else f", crs {self.crs.label}"
        what = counted(len(self.elements), "element")
        return f"<Alignment{title}: {what}, from {self.start:.6g} to {self.end:.6g}{crs}>"


def _require_joined(elements: Sequence[Element]) -> None:
    for number, (before, after) in enumerate(itertools.pairwise(elements), 1):
        gap = math.dist(before.end, after.start)
        if gap > _GAP:
            raise LinesError(
                f"Element {number} of an alignment begins at {after.start}, and the one before "
                f"ends at {before.end}: they must follow each other.",
                lines=[number],
            )


def _describe_feet(feet: Feet) -> list[str]:
    notes = []
    count = len(feet.offsets)
    beyond = int(np.count_nonzero(feet.is_beyond))
    if beyond:
        lie = inflect(f"{beyond} of {counted(count, 'point')} [lies|lie]", beyond)
        notes.append(f"{lie} before the start or beyond the end: there is no station.")
    twofold = int(np.count_nonzero(feet.is_twofold & ~feet.is_beyond))
    if twofold:
        are = inflect(f"{twofold} of {counted(count, 'point')} [is|are]", twofold)
        notes.append(f"{are} as near to another place: the first station was taken.")
    return notes
