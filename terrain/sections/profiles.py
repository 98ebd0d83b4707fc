"""Profiles: elevations of surfaces along polylines, with every break between."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.checks import as_length
from ...base.crs import scale_elevations
from ...base.errors import LinesError, OptionError
from ...base.products import product
from ...base.results import Table
from ...base.sentences import counted
from .axes import CHORD, as_axis
from .grades import measure_grades
from .rows import Places, cut_rows
from .surfaces import as_surfaces

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from ...base.arrays import AnyArray, Float64Array, Int64Array
    from ...tin import TIN
    from ..surface import Segments
    from .rows import Rows
    from .surfaces import Surfaces

MOST_STATIONS = 1_000_000
"""So many stations at an interval are made; more are a slip of the interval."""


@product
def profile(
    tin: TIN | Sequence[TIN] | Mapping[str, TIN],
    line: Any,
    *,
    interval: float | None = None,
    start: float = 0.0,
) -> Table:
    """Cut one surface or several along polylines.

    Parameters
    ----------
    tin : TIN, sequence of TIN, or mapping of str to TIN
        Surfaces; in a sequence they are called 1, 2, ...
    line : (k, 2) array, Breakline, Features, geometry, or sequence of these, or Alignment
        One polyline or several, CRS units. A geometry is one of shapely, a GeoDataFrame, or
        whatever has a ``__geo_interface__``. Elevations in it are not looked at. Curves of an
        alignment are cut along chords within 0.001 CRS units of them, by its own stations.
    interval : float, optional
        Add a row at every station that is a multiple of it, CRS units.
    start : float
        Station of the first vertex of each line, CRS units.

    Returns
    -------
    Table
        A row wherever a surface has a break: where the line crosses an edge or passes a vertex of
        it, enters or leaves it, and at the line's own vertices. Columns ``line`` (its number),
        ``station``, ``x``, ``y``; of each surface ``elevation`` (NaN where it is not), ``grade``
        (rise over run to the next row, NaN in gaps) and ``crossed``: "vertex", "edge", "breakline",
        "boundary", "line" (a vertex of the line inside a triangle or outside the surface), "gap",
        "station", or "" for another surface's break. Of several surfaces these end with the name,
        as in ``elevation_1``, and ``difference_2`` is surface 2 minus the first.

    Raises
    ------
    LinesError
        If there is no line, one has no length or coordinates that are not finite, no line meets a
        surface, or triangles lie over each other.
    OptionError
        If an interval or a start is no such number, or would make too many stations.
    CrsError
        If CRSs or units do not go together, or coordinates are angles, which have no length.

    Notes
    -----
    Between two successive rows that both have an elevation, the surface is the straight line
    between them: a gap has a row without elevation in it. What is crossed, and in which order, is
    decided by exact predicates. Places and elevations of crossings are the true ones rounded once;
    at the line's own vertices the elevation is what :meth:`TIN.interpolate` gives. The profile of
    the reversed line has the same rows in reverse, bit for bit, but for stations and what was added
    by ``interval``.

    Stations are lengths in the plane of the CRS, added up from vertex to vertex; of an alignment
    with station equations ``written_station`` has what is written there. The first call for a TIN
    builds its index of point location; then a line takes time in proportion to the triangles that
    it meets.

    Examples
    --------
    >>> import tinsmith as ts
    >>> square = [[0, 0, 0], [4, 0, 4], [4, 4, 8], [0, 4, 4]]
    >>> tin = ts.TIN.from_triangles(square, [[0, 1, 2], [0, 2, 3]])
    >>> table = ts.profile(tin, [[1, 2], [5, 2]])
    >>> table["station"], table["elevation"]
    (array([0., 1., 3., 4.]), array([ 3.,  4.,  6., nan]))
    >>> table["crossed"].tolist()
    ['line', 'edge', 'boundary', 'line']
    """
    surfaces = as_surfaces(tin)
    scale_elevations(surfaces.crs, surfaces.elevation_unit)  # refuses angles
    axis = as_axis(line, surfaces.crs, start, "line", "profile")
    segments = axis.segments
    extra = (
        None if interval is None else _place_at_interval(segments, as_length("interval", interval))
    )
    rows = cut_rows(surfaces, segments, extra)
    require_surface(surfaces, segments, rows)
    columns: dict[str, AnyArray] = {
        "line": segments.lines[rows.places.segments],
        "station": rows.places.stations,
    }
    notes = surfaces.notes + axis.notes
    if axis.alignment is not None:
        columns |= axis.write_stations(rows.places.stations)
        if len(segments.lines) > len(axis.alignment.elements):
            notes += (f"Curves were cut along chords within {CHORD} of them.",)
    return measure_rows(surfaces, segments, rows, columns, name="profile", notes=notes)


def measure_rows(
    surfaces: Surfaces,
    segments: Segments,
    rows: Rows,
    columns: dict[str, AnyArray],
    *,
    name: str,
    notes: Sequence[str],
) -> Table:
    """Return rows as a table: first the columns given, which are lengths but for whole numbers."""
    length = None if surfaces.crs is None else surfaces.crs.horizontal_unit
    xy = rows.places.xy
    columns = columns | {"x": xy[:, 0], "y": xy[:, 1]}
    units: dict[str, Any] = {
        key: length for key, values in columns.items() if values.dtype.kind == "f"
    }
    scale = scale_elevations(surfaces.crs, surfaces.elevation_unit)
    grades = measure_grades(surfaces, segments, rows) * scale
    crossed = rows.crossed.copy()
    crossed[(rows.crossed == "").all(axis=1)] = "station"  # which was asked for
    for k in range(len(surfaces.tins)):
        own = {"elevation": rows.elevations[:, k]}
        if k > 0:
            own["difference"] = rows.elevations[:, k] - rows.elevations[:, 0]
        columns |= {surfaces.column(key, k): values for key, values in own.items()}
        units |= {surfaces.column(key, k): surfaces.elevation_unit for key in own}
        columns[surfaces.column("grade", k)] = grades[:, k]
        columns[surfaces.column("crossed", k)] = crossed[:, k]
    notes = (*notes, *_describe_gaps(surfaces, rows))
    return Table(columns, units=units, name=name, notes=notes)


def _describe_gaps(surfaces: Surfaces, rows: Rows) -> list[str]:
    """Tell how much of the way each surface is missing."""
    steps = np.abs(rows.steps)
    whole = float(steps.sum())
    notes = []
    for k, name in enumerate(surfaces.names):
        missing = float(steps[rows.is_gap[:, k]].sum())
        if missing > 0.0:
            what = f"surface '{name}'" if name else "surface"
            notes.append(f"There is no {what} along {missing:.6g} of {whole:.6g}.")
    return notes


def require_surface(surfaces: Surfaces, segments: Segments, rows: Rows, what: str = "line") -> None:
    """Refuse lines that meet no surface at all."""
    if np.isfinite(rows.elevations).any():
        return
    low = np.minimum(segments.starts.min(axis=0), segments.ends.min(axis=0)).tolist()
    high = np.maximum(segments.starts.max(axis=0), segments.ends.max(axis=0)).tolist()
    count, bounds = int(segments.lines[-1]) + 1, surfaces.tins[0].bounds
    verb = "lies" if count == 1 else "lie"
    raise LinesError(
        f"{counted(count, what)} from {tuple(low)} to {tuple(high)} {verb} outside the "
        f"surface, which reaches from ({bounds.xmin!r}, {bounds.ymin!r}) to "
        f"({bounds.xmax!r}, {bounds.ymax!r})."
    )


# ---------------------------------------------------------------- stations


def _place_at_interval(segments: Segments, interval: float) -> Places:
    """Return the places within segments whose stations are multiples of an interval."""
    lengths = segments.end_stations - segments.start_stations
    require_few("interval", interval, lengths)
    first = np.floor(segments.start_stations / interval) + 1
    last = np.ceil(segments.end_stations / interval) - 1
    counts = np.maximum(last - first + 1, 0).astype(np.int64)
    segment = np.repeat(np.arange(len(counts)), counts)
    turn = np.arange(len(segment)) - np.repeat(np.cumsum(counts) - counts, counts)
    return places_at(segments, segment, (first[segment] + turn) * interval)


def require_few(option: str, interval: float, lengths: Float64Array) -> None:
    """Refuse an interval that makes more stations than anybody can use."""
    least = float(lengths.sum()) / MOST_STATIONS
    if not interval >= least:
        allowed = f"{least:.3g} or more here, where at most {MOST_STATIONS:,} stations are made"
        raise OptionError(option, interval, allowed=allowed)


def places_at(segments: Segments, segment: Int64Array, stations: Float64Array) -> Places:
    """Return the places at stations within segments; those at a segment's ends are left out.

    A station as close to an end as coordinates are rounded is there.
    """
    begin, end = segments.start_stations[segment], segments.end_stations[segment]
    share = ((stations - begin) / (end - begin))[:, None]
    start, stop = segments.starts[segment], segments.ends[segment]
    xy = start + share * (stop - start)
    inside = (begin + segments.rounding < stations) & (stations < end - segments.rounding)
    inside &= (xy != start).any(axis=1) & (xy != stop).any(axis=1)
    return Places(segment[inside], stations[inside], xy[inside])
