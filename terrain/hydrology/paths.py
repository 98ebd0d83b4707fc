"""Flow paths: the way that a drop of water takes down a surface."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.checks import as_flag
from ...base.products import product
from ...base.results import Features
from ...base.sentences import counted
from ...tin.topology import find_offsets
from ..surface import as_places, find_reference
from .descent import BOUNDARY, FLAT, PIT, Walker
from .falls import find_falls
from .filling import fill
from .routes import KINDS, cut_parts, trace_down
from .starts import place_drops
from .vertices import NOWHERE

if TYPE_CHECKING:
    from ...base.arrays import Float64Array, Int64Array
    from ...tin import TIN
    from .filling import Filling
    from .routes import Trace

FILLED_NOTE = "Depressions are full: their water goes on from where they spill."
ENDS = {PIT: "pit", FLAT: "flat", BOUNDARY: "boundary"}


@product
def flow_path(tin: TIN, points: Any, *, fill_depressions: bool = False) -> Features:
    """Follow drops of water down a surface, along the steepest descent.

    Parameters
    ----------
    tin : TIN
    points : (k, 2) array, Features of points, shapes, or a data frame
        Where they fall, CRS units.
    fill_depressions : bool, optional
        Depressions are full, so that water goes on from where they spill, to the boundary; default
        they are empty, and hold what comes to their pits.

    Returns
    -------
    Features
        A line for each drop, with a vertex wherever it crosses an edge, and the columns ``start``
        (number of the point, from 0 on), ``end`` ("pit", "flat" or "boundary", where water leaves
        the surface), ``length`` in the plane and ``drop`` in elevation. A point from which nothing
        descends has no line; a note tells it.

        With ``fill_depressions`` a line for each part, on the surface of the water where there is
        any, and the columns ``start``, ``part`` (from 0 on), ``kind`` ("descent", "pond" or "flat",
        over level ground), ``pit`` (the lowest vertex of the pond, -1 for none), ``end`` (the kind
        of the next part, "boundary" behind the last), ``length`` and ``drop``.

    Raises
    ------
    CrsError
        If coordinates are degrees, or the CRS of the points is another one.
    OptionError
        If ``fill_depressions`` is neither True nor False.
    PointsError
        If there is no point, or one lies outside the surface.

    Notes
    -----
    Water runs down a triangle along its gradient, and over the edge into the next one; where that
    one falls towards the edge too, along the edge, which is a channel [1]_. Which edge a drop
    crosses is decided exactly, on which side of a corner it passes too; the place on the edge is
    rounded once, downwards if need be, so that every path descends, and ends. From a vertex it
    takes the steepest way, of equally steep ones that of the smallest azimuth.

    It ends in a pit, on flat ground (a level triangle or channel, over which no direction is
    steepest) or at the boundary, of a hole too, which water leaves freely.

    Filled depressions are those of a priority flood [2]_, on the edges: a depression that spills
    into one that spills back is one with it. Across water and level ground a drop takes the edges
    of the surface, as few as there can be, to where the pond spills or the ground descends; so its
    way there is one of many. Under water it may cross a triangle to come to the first vertex.

    References
    ----------
    .. [1] S. Yu, M. van Kreveld, J. Snoeyink, Drainage queries in TINs: from local to global and
       back again, Advances in GIS Research II (1996), 829-842.
    .. [2] R. Barnes, C. Lehman, D. Mulla, Priority-flood, Computers & Geosciences 62 (2014),
       doi:10.1016/j.cageo.2013.04.024.

    Examples
    --------
    >>> import tinsmith as ts
    >>> low, high = [[0, 0, 1], [4, 0, 0]], [[0, 2, 3], [4, 2, 2], [0, -2, 3], [4, -2, 2]]
    >>> path = ts.flow_path(ts.triangulate([*low, *high]), [[2, 1]])
    >>> path.coordinates
    array([[2.    , 1.    , 1.5   ],
           [2.25  , 0.    , 0.4375],
           [4.    , 0.    , 0.    ]])
    >>> path.columns["end"].tolist()
    ['boundary']

    >>> bowl = [[0, 0, 3], [6, 0, 3], [6, 6, 2], [0, 6, 3], [3, 3, 0]]
    >>> path = ts.flow_path(ts.triangulate(bowl), [[0, 0]], fill_depressions=True)
    >>> path.columns["kind"].tolist(), path.columns["end"].tolist()
    (['descent', 'pond'], ['pond', 'boundary'])
    """
    is_filled = as_flag("fill_depressions", fill_depressions)
    reference = find_reference(tin, "Flow paths")
    xy, notes = as_places(tin, points, "the points")
    walker = Walker(find_falls(tin), fill(tin) if is_filled else None)
    start = np.column_stack([xy, tin.interpolate(xy)])
    trace = trace_down(walker, start, place_drops(tin, walker, xy))
    lengths = np.bincount(trace.owners, minlength=len(xy))
    stays = np.flatnonzero(lengths < 2)
    if len(stays):
        what = counted(len(stays), "point")
        notes += (
            f"Nothing descends from {what} (first: number {stays[0]}): no path starts there.",
        )
    if walker.filling is None:
        coordinates, offsets, columns = _describe_paths(trace, lengths)
    else:
        coordinates, offsets, columns = _describe_parts(trace, walker.filling)
        notes += (FILLED_NOTE,)
    columns |= _measure_lines(coordinates, offsets)
    return Features.of_lines(
        coordinates,
        offsets,
        columns=columns,
        units={"length": reference.units.length, "drop": reference.elevation_unit},
        crs=tin.crs,
        elevation_unit=tin.elevation_unit,
        name="flow paths",
        notes=[*reference.notes, *notes],
    )


def _describe_paths(
    trace: Trace, lengths: Int64Array
) -> tuple[Float64Array, Int64Array, dict[str, Any]]:
    """Return the paths of more than one place: coordinates, offsets, columns."""
    kept = np.flatnonzero(lengths >= 2)
    ends = np.array([ENDS[end] for end in trace.ends[kept].tolist()], object)
    coordinates = trace.coordinates[lengths[trace.owners] >= 2]
    return coordinates, find_offsets(lengths[kept]), {"start": kept, "end": ends}


def _describe_parts(
    trace: Trace, filling: Filling
) -> tuple[Float64Array, Int64Array, dict[str, Any]]:
    """Return the parts of paths over a filled surface: coordinates, offsets, columns."""
    parts = cut_parts(trace, filling)
    rows = np.arange(len(parts.owners))
    first = np.append(True, np.diff(parts.owners) != 0)[: len(rows)]
    last = np.append(first[1:], True)[: len(rows)]
    kinds = KINDS[parts.kinds]
    columns = {
        "start": parts.owners,
        "part": rows - np.maximum.accumulate(np.where(first, rows, 0)),
        "kind": kinds,
        "pit": np.append(filling.hierarchy.pits, NOWHERE)[parts.ponds],
        "end": np.where(last, ENDS[BOUNDARY], np.roll(kinds, -1)),
    }
    return parts.coordinates, parts.offsets, columns


def _measure_lines(coordinates: Float64Array, offsets: Int64Array) -> dict[str, Float64Array]:
    """Return lengths in the plane and drops in elevation."""
    steps = np.diff(coordinates, axis=0)
    spans = np.append(np.hypot(steps[:, 0], steps[:, 1]), 0.0)
    spans[offsets[1:] - 1] = 0.0
    return {
        "length": np.add.reduceat(spans, offsets[:-1]) if len(offsets) > 1 else np.zeros(0),
        "drop": coordinates[offsets[:-1], 2] - coordinates[offsets[1:] - 1, 2],
    }
