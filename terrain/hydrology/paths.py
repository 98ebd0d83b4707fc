"""Flow paths: the way that a drop of water takes down a surface."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ..._sentences import counted
from ...errors import PointsError
from ...tin.topology import find_offsets
from ...tin.validation.points import as_xy
from ..earthwork.reference import find_reference
from ..georeference import require_same_crs
from ..results import Features
from .descent import BOUNDARY, FLAT, MOVING, PIT, Walker
from .falls import find_falls
from .starts import place_drops
from .vertices import NOWHERE

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ...tin import TIN
    from .descent import Drops

__all__ = ["ENDS", "as_places", "flow_path", "trace_down"]

ENDS = {PIT: "pit", FLAT: "flat", BOUNDARY: "boundary"}


def flow_path(tin: TIN, points: Any) -> Features:
    """Follow drops of water down a surface, along the steepest descent.

    Parameters
    ----------
    tin : TIN
    points : (k, 2) array or Features of points
        Where they fall, CRS units.

    Returns
    -------
    Features
        A line for each drop, with a vertex wherever it crosses an edge, and the columns ``start``
        (number of the point, from 0 on), ``end`` ("pit", "flat" or "boundary", where water leaves
        the surface), ``length`` in the plane and ``drop`` in elevation. A point from which nothing
        descends has no line; a note tells it.

    Raises
    ------
    CrsError
        If coordinates are degrees, or the CRS of the points is another one.
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

    References
    ----------
    .. [1] S. Yu, M. van Kreveld, J. Snoeyink, Drainage queries in TINs: from local to global and
       back again, Advances in GIS Research II (1996), 829-842.

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
    """
    reference = find_reference(tin, "Flow paths")
    xy, notes = as_places(tin, points, "the points")
    walker = Walker(find_falls(tin))
    start = np.column_stack([xy, tin.interpolate(xy)])
    coordinates, owners, ends = trace_down(walker, start, place_drops(tin, walker, xy))
    lengths = np.bincount(owners, minlength=len(xy))
    stays = np.flatnonzero(lengths < 2)
    if len(stays):
        what = counted(len(stays), "point")
        notes += (
            f"Nothing descends from {what} (first: number {stays[0]}): no path starts there.",
        )
    kept = np.flatnonzero(lengths >= 2)
    coordinates = coordinates[lengths[owners] >= 2]
    offsets = find_offsets(lengths[kept])
    steps = np.diff(coordinates, axis=0)
    spans = np.append(np.hypot(steps[:, 0], steps[:, 1]), 0.0)
    spans[offsets[1:] - 1] = 0.0
    columns = {
        "start": kept,
        "end": np.array([ENDS[end] for end in ends[kept].tolist()], object),
        "length": np.add.reduceat(spans, offsets[:-1]) if len(kept) else np.zeros(0),
        "drop": coordinates[offsets[:-1], 2] - coordinates[offsets[1:] - 1, 2],
    }
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


def as_places(tin: TIN, points: Any, what: str) -> tuple[NDArray[np.float64], tuple[str, ...]]:
    """Return places on a surface, and what was assumed of them.

    Raises
    ------
    CrsError
        If their CRS is another one.
    PointsError
        If there is none, or one lies outside the surface.
    """
    theirs = getattr(points, "crs", None)
    notes: tuple[str, ...] = ()
    if isinstance(points, Features):
        if points.kind != "points":
            raise PointsError(f"Points are needed for {what}, and there are {points.kind}.")
        notes = require_same_crs(theirs, tin.crs, what) + tuple(points.notes)
        points = points.coordinates[:, :2]
    xy = np.atleast_2d(as_xy(np.atleast_2d(points) if np.size(points) else points)) + 0.0
    if len(xy) == 0:
        raise PointsError(f"There is no point for {what}: at least one is needed.")
    outside = np.flatnonzero(tin.locate(xy) < 0)
    if len(outside):
        first = int(outside[0])
        raise PointsError(
            f"{len(outside):,} of {counted(len(xy), 'point')} for {what} "
            f"{'lies' if len(outside) == 1 else 'lie'} outside the surface (first: number {first}, "
            f"at {tuple(xy[first].tolist())}).",
            rows=outside[:5],
        )
    return xy, notes


def trace_down(
    walker: Walker, start: NDArray[np.float64], drops: Drops
) -> tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.int8]]:
    """Follow drops to their ends.

    Returns
    -------
    coordinates : (n, 3) float64 array
        Of all paths, one after the other; a place that repeats the one before is left out.
    owners : (n,) int64 array
        The drop of each.
    ends : (k,) int8 array
    """
    numbers = np.arange(len(start))
    ends = drops.ends.copy()
    places, owners = [start], [numbers]
    stays = (drops.vertices == NOWHERE) & (drops.triangles == NOWHERE)
    here = np.where(stays[:, None], start, walker.locate(drops))
    while True:
        places.append(here)
        owners.append(numbers)
        ends[numbers] = drops.ends
        moving = np.flatnonzero(drops.ends == MOVING)
        if len(moving) == 0:
            break
        numbers, drops = numbers[moving], walker.step(drops.choose(moving))
        here = walker.locate(drops)
    owner, xyz = np.concatenate(owners), np.concatenate(places)
    order = np.argsort(owner, kind="stable")
    owner, xyz = owner[order], xyz[order]
    is_new = np.append(True, (np.diff(xyz[:, :2], axis=0) != 0).any(axis=1) | (np.diff(owner) != 0))
    return xyz[is_new], owner[is_new], ends
