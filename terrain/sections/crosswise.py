"""Cross sections: surfaces cut square to a centreline at stations along it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...base.checks import as_length, as_number
from ...base.crs import scale_elevations
from ...base.errors import OptionError, PointsError
from ...base.georeference import find_axes
from ...base.products import product
from ...base.results import Features, Table
from ...base.sentences import coordinate
from ...tin.validation import as_elevations
from ..surface import Segments
from .axes import Places, as_axis
from .profiles import measure_rows, require_few, require_surface
from .rows import cut_rows, find_runs
from .surfaces import as_surfaces

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import ArrayLike

    from ...base.arrays import AnyArray, Float64Array, Int64Array
    from ...tin import TIN
    from .axes import Axis
    from .rows import Rows
    from .surfaces import Surfaces


class _Axes(NamedTuple):
    """Cross sections in the plane."""

    segments: Segments
    """From left to right, their stations being offsets, their lines the sections."""
    lines: Int64Array
    """(s,), the centreline of each section."""
    stations: Float64Array
    """(s,)."""


class _Cut(NamedTuple):
    """Sections with what was cut along them."""

    surfaces: Surfaces
    axes: _Axes
    rows: Rows
    axis: Axis
    notes: tuple[str, ...]

    def list_stations(self, section: Int64Array) -> dict[str, AnyArray]:
        """Return columns of the centreline and the stations of sections."""
        stations = self.axes.stations[section]
        lines = {"line": self.axes.lines[section], "section": section, "station": stations}
        return lines | self.axis.write_stations(stations)


@product
def cross_sections(
    tin: TIN | Sequence[TIN] | Mapping[str, TIN],
    centreline: Any,
    *,
    interval: float | None = None,
    stations: ArrayLike | None = None,
    width: float | None = None,
    left: float | None = None,
    right: float | None = None,
    start: float = 0.0,
) -> Table:
    """Cut one surface or several square to a centreline.

    Parameters
    ----------
    tin, centreline
        Surfaces, and polylines or an alignment, as of :func:`tinsmith.profile`.
    interval : float, optional
        A section at every station that is a multiple of it, and at both ends, CRS units.
    stations : (s,) array, optional
        Sections at these stations, CRS units; with ``interval`` both.
    width : float, optional
        Of the sections, half of it to either side, CRS units.
    left, right : float, optional
        How far sections reach to either side instead, 0 or more.
    start : float
        Station of the first vertex of the centreline.

    Returns
    -------
    Table
        Columns ``line`` (of the centreline), ``section`` (numbers from 0), ``station``, ``offset``
        (from the centreline, negative to the left), and then as of :func:`tinsmith.profile`: a row
        at both ends of a section, on the centreline, and wherever a surface has a break.

    Raises
    ------
    OptionError
        If an interval, a width, an offset or a station is no such number, none is given, a station
        lies off the centreline, or there would be too many sections.
    LinesError, CrsError
        As :func:`tinsmith.profile`.

    Notes
    -----
    Of an :class:`Alignment` sections are square to the curve itself, ``start`` is its own, and
    stations are lengths; with station equations ``written_station`` has what is written there.

    A section is square to the segment of the centreline that holds its station. At a vertex of the
    centreline it halves the angle between both segments (its direction is square to the mean of
    their unit vectors); where the centreline turns back on itself it is square to the segment that
    ends there. Sections on the inside of a sharp bend may cross each other.

    Both ends of a section are rounded, so that its two halves may be out of line by a rounding.

    Examples
    --------
    >>> import tinsmith as ts
    >>> square = [[0, 0, 0], [4, 0, 4], [4, 4, 8], [0, 4, 4]]
    >>> tin = ts.TIN.from_triangles(square, [[0, 1, 2], [0, 2, 3]])
    >>> table = ts.cross_sections(tin, [[1, 2], [3, 2]], stations=[1], width=2)
    >>> table["offset"], table["elevation"]
    (array([-1.,  0.,  1.]), array([5., 4., 3.]))
    """
    cut = _cut(tin, centreline, interval, stations, (width, left, right), start)
    section = cut.axes.segments.lines[cut.rows.places.segments]
    columns = cut.list_stations(section) | {"offset": cut.rows.places.stations}
    return measure_rows(
        cut.surfaces, cut.axes.segments, cut.rows, columns, name="cross sections", notes=cut.notes
    )


@product
def section_lines(
    tin: TIN | Sequence[TIN] | Mapping[str, TIN],
    centreline: Any,
    *,
    interval: float | None = None,
    stations: ArrayLike | None = None,
    width: float | None = None,
    left: float | None = None,
    right: float | None = None,
    start: float = 0.0,
) -> Features:
    """Cut surfaces square to a centreline, and return the sections as lines in space.

    Parameters
    ----------
    tin, centreline, interval, stations, width, left, right, start
        As of :func:`tinsmith.cross_sections`.

    Returns
    -------
    Features
        A line wherever a section runs over a surface without a gap, from left to right, with
        columns ``line``, ``section``, ``station``, and ``surface`` if they have names.

    Raises
    ------
    OptionError, LinesError, CrsError
        As :func:`tinsmith.cross_sections`.

    Examples
    --------
    >>> import tinsmith as ts
    >>> square = [[0, 0, 0], [4, 0, 4], [4, 4, 8], [0, 4, 4]]
    >>> tin = ts.TIN.from_triangles(square, [[0, 1, 2], [0, 2, 3]])
    >>> ts.section_lines(tin, [[1, 2], [3, 2]], interval=1, width=2).coordinates[:3]
    array([[1., 3., 4.],
           [1., 2., 3.],
           [1., 1., 2.]])
    """
    cut = _cut(tin, centreline, interval, stations, (width, left, right), start)
    runs = [find_runs(cut.rows, k) for k in range(len(cut.surfaces.tins))]
    first_rows = np.concatenate([one.first_rows for one in runs])
    section = cut.axes.segments.lines[cut.rows.places.segments[first_rows]]
    columns: dict[str, Any] = cut.list_stations(section)
    if any(cut.surfaces.names):
        counts = [len(one.first_rows) for one in runs]
        columns["surface"] = np.repeat(np.array(cut.surfaces.names, object), counts)
    lengths = np.concatenate([np.diff(one.offsets) for one in runs])
    crs = cut.surfaces.crs
    return Features.of_lines(
        np.concatenate([one.coordinates for one in runs]),
        np.concatenate([[0], np.cumsum(lengths)]),
        columns=columns,
        units={
            name: None if crs is None else crs.horizontal_unit
            for name in columns
            if name.endswith("station")
        },
        crs=crs,
        elevation_unit=cut.surfaces.elevation_unit,
        name="cross sections",
        notes=cut.notes,
    )


def _cut(
    tin: Any,
    centreline: Any,
    interval: Any,
    stations: Any,
    widths: tuple[Any, Any, Any],
    start: Any,
) -> _Cut:
    surfaces = as_surfaces(tin)
    scale_elevations(surfaces.crs, surfaces.elevation_unit)  # refuses angles
    axis = as_axis(centreline, surfaces.crs, start, "centreline")
    places = place_sections(axis, interval, stations)
    is_mirrored = find_axes(surfaces.crs).are_mirrored
    axes = _lay_axes(places, *as_reaches(*widths), is_mirrored=is_mirrored)
    rows = cut_rows(surfaces, axes.segments, is_computed=True)
    require_surface(surfaces, axes.segments, rows, "section")
    return _Cut(surfaces, axes, rows, axis, surfaces.notes + axis.notes)


# ---------------------------------------------------------------- options


def as_reaches(width: Any, left: Any, right: Any) -> tuple[float, float]:
    """Return how far sections reach to the left and to the right."""
    if width is not None:
        if left is not None or right is not None:
            raise OptionError("width", width, allowed="given without left and right")
        half = as_length("width", width) / 2
        return half, half
    if left is None and right is None:
        raise OptionError("width", None, allowed="given, or left and right")
    reach = [
        0.0 if side is None else as_number(name, side, "a length", least=0, unit="in CRS units")
        for name, side in (("left", left), ("right", right))
    ]
    if reach == [0.0, 0.0]:
        raise OptionError("left and right", 0.0, allowed="above 0, one of them at least")
    return reach[0], reach[1]


def place_sections(axis: Axis, interval: Any, given: Any) -> Places:
    """Return where sections are, with the directions of the centrelines there.

    Raises OptionError as :func:`cross_sections`.
    """
    if interval is None and given is None:
        raise OptionError("interval", None, allowed="given, or stations")
    ends, near = axis.ends, axis.rounding
    wanted = [_find_on_lines(ends, given, near)] if given is not None else [np.empty((0, 2))]
    if interval is not None:
        wanted.append(_list_multiples(ends, as_length("interval", interval)))
    pairs = _join_near(np.unique(np.concatenate(wanted), axis=0), ends, near)
    lines, stations = pairs[:, 0].astype(np.int64), pairs[:, 1]
    return Places(lines, stations, *axis.measure(lines, stations))


def _list_multiples(ends: Float64Array, interval: float) -> Float64Array:
    """Return line and station of every multiple of an interval, and of both ends of each line."""
    require_few("interval", interval, ends[:, 1] - ends[:, 0])
    first, last = np.ceil(ends[:, 0] / interval), np.floor(ends[:, 1] / interval)
    found = [
        np.concatenate([np.arange(low, high + 1) * interval, pair])
        for low, high, pair in zip(first.tolist(), last.tolist(), ends, strict=True)
    ]
    found = [np.clip(one, pair[0], pair[1]) for one, pair in zip(found, ends, strict=True)]
    lines = np.repeat(np.arange(len(found)), [len(one) for one in found])
    return np.column_stack([lines, np.concatenate(found)])


def _join_near(pairs: Float64Array, ends: Float64Array, near: float) -> Float64Array:
    """Take lines and stations, in order, that coordinates can tell apart; ends are where they are.

    A length is a sum of distances between rounded coordinates: 200.00000000003743 is 200.
    """
    own = ends[pairs[:, 0].astype(np.int64)]
    placed = pairs.copy()
    for k in range(2):
        at_end = np.abs(placed[:, 1] - own[:, k]) <= near
        placed[at_end, 1] = own[at_end, k]
    is_new = np.append(True, np.diff(placed[:, 0]) > 0)
    is_new[1:] |= np.diff(placed[:, 1]) > near
    kept: Float64Array = placed[is_new]
    return kept


def _find_on_lines(ends: Float64Array, given: Any, near: float) -> Float64Array:
    """Return line and station of stations, on every line that is long enough for them."""
    try:
        stations = np.atleast_1d(as_elevations(given))
    except PointsError:
        raise OptionError("stations", given, allowed="finite numbers, in CRS units") from None
    if len(stations) == 0:
        raise OptionError("stations", [], allowed="one number at least")
    is_on = (ends[:, :1] - near <= stations) & (stations <= ends[:, 1:] + near)
    off = ~is_on.any(axis=0)
    if off.any():
        raise OptionError(
            "station",
            float(stations[np.argmax(off)]),
            allowed=(
                f"on the centreline, from {coordinate(ends[:, 0].min())} to "
                f"{coordinate(ends[:, 1].max())}"
            ),
        )
    line, at = np.nonzero(is_on)
    return np.column_stack([line, stations[at]])


# ---------------------------------------------------------------- in the plane


def _lay_axes(places: Places, left: float, right: float, *, is_mirrored: bool) -> _Axes:
    """Return the sections, each as the segments left and right of the centreline."""
    side = (1.0, -1.0) if is_mirrored else (-1.0, 1.0)
    to_left, middle = places.tangents[:, ::-1] * side, places.middles
    count = len(middle)
    outer = np.stack([middle + left * to_left, middle, middle - right * to_left], axis=1)
    offsets = np.broadcast_to([-left, 0.0, right], (count, 3))
    sections = np.repeat(np.arange(count), 2)
    axes = Segments(
        outer[:, :2].reshape(-1, 2),
        outer[:, 1:].reshape(-1, 2),
        offsets[:, :2].ravel() + 0.0,
        offsets[:, 1:].ravel() + 0.0,
        sections,
    )
    has_length = (axes.starts != axes.ends).any(axis=1)
    if len(np.unique(sections[has_length])) < count:
        raise OptionError("width", left + right, allowed="wide enough to tell both ends apart")
    axes = Segments(*(array[has_length] for array in axes))
    return _Axes(axes, places.lines, places.stations)
