"""Catchments: which part of a surface drains where, and how much of it through each channel."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.checks import as_flag, as_number
from ...base.errors import PointsError
from ...base.products import product
from ...base.progress import Progress
from ...base.results import Features
from ...tin.predicates import blocks
from .. import _kernel
from ..surface import as_places, find_reference
from .descent import MOVING
from .divides import cut_at_divides, find_divides
from .filling import fill
from .networks import accumulate, build_network, find_ends
from .paths import FILLED_NOTE
from .routes import DESCENT, FLAT_GROUND, KINDS, POND
from .starts import place_drops
from .strips import settle
from .vertices import NOWHERE
from .water import gather_polygons
from .water_bodies import BOUNDARY_NOTE

if TYPE_CHECKING:
    from collections.abc import Callable

    from ...base.arrays import Float64Array, Int32Array, Int64Array
    from ...tin import TIN
    from .networks import Network


@product
def catchments(
    tin: TIN,
    outlets: Any = None,
    *,
    fill_depressions: bool = False,
    progress: Callable[[float], None] | None = None,
) -> Features:
    """Find which part of a surface drains into each pit, or through each outlet.

    Parameters
    ----------
    tin : TIN
    outlets : (k, 2) array, Features of points, shapes or a data frame, optional
        Places on the surface, CRS units; default the pits. Each is moved down to the first vertex
        that a drop comes to there, as to the lower end of a channel.
    fill_depressions : bool, optional
        Depressions are full, so that water goes on from where they spill, as of :func:`flow_path`.
    progress : callable, optional
        Called with the fraction done, ascending to 1.0, between the stages. What it raises ends
        the call.

    Returns
    -------
    Features
        Polygons, the largest first. Of pits, with the columns ``pit`` (a vertex, -1 for the
        boundary), ``end`` ("pit", "flat" or "boundary", as of :func:`flow_path`) and ``area``;
        these tile the surface. Of outlets, with the columns ``outlet`` (number of the point, from
        0 on), ``vertex`` and ``area``; each place belongs to the first outlet its water comes to.

        With ``fill_depressions`` all water leaves the surface: without outlets there is a polygon
        for each vertex of the boundary at which it does, with the columns ``vertex`` and ``area``,
        and one for what leaves across edges, with ``vertex`` -1. An outlet under water is moved to
        where the pond spills.

    Raises
    ------
    CrsError, OptionError
        As of :func:`flow_path`, of the outlets.
    PointsError
        If an outlet lies outside the surface, its water comes to no vertex, two come to the same,
        or fall lines cross too many triangles.

    Notes
    -----
    1. Where water parts at a vertex, the fall line that comes down to it is followed upwards across
       the triangles [1]_. These lines cut triangles into strips, all water of which goes one way.
    2. From strip to strip, and along channels from vertex to vertex, water runs as a
       :func:`flow_path` does.
    3. Strips that end alike are joined.

    Directions are decided exactly; where the lines cross edges is rounded. Nothing is filled: water
    of a small pit stays in it. Level ground that water leaves somewhere, or that the boundary
    touches, is a "flat" of its own, for no direction over it is known.

    References
    ----------
    .. [1] S. Yu, M. van Kreveld, J. Snoeyink, Drainage queries in TINs: from local to global and
       back again, Advances in GIS Research II (1996), 829-842.

    Examples
    --------
    >>> import tinsmith as ts
    >>> bowl = ts.triangulate([[0, 0, 3], [6, 0, 3], [6, 6, 3], [0, 6, 3], [3, 3, 0]])
    >>> found = ts.catchments(bowl)
    >>> found.columns["pit"], found.columns["area"]
    (array([4]), array([36.]))
    """
    is_filled = as_flag("fill_depressions", fill_depressions)
    reference, done = find_reference(tin, "Catchments"), Progress(progress)
    notes: tuple[str, ...] = (FILLED_NOTE,) if is_filled else ()
    nothing = np.zeros(0, np.int32)  # of all strips: what is not used, or was, is let go
    network = build_network(tin, fill(tin) if is_filled else None, done.stage(0.1, 0.7))
    network = network._replace(uppers=nothing)
    if outlets is not None:
        named, noted = _place_outlets(tin, network, outlets)
        notes += noted
    elif is_filled:
        named = network.find_leaving()
    else:
        named = np.arange(network.first_end, len(network.nexts))
    network.nexts[named] = named
    numbers = np.full(len(network.nexts), NOWHERE, np.int32)
    numbers[named] = np.arange(len(named))
    labels, level = _label(network, numbers)
    del numbers
    areas = _measure(network, labels, level, len(named))
    kept = np.flatnonzero(areas > 0.0) if outlets is None else np.arange(len(named))
    columns = _describe_catchments(tin, network, named[kept], kept, outlets is None)
    columns["area"] = areas[kept]
    network = network._replace(nexts=nothing)
    order = np.lexsort((kept, -areas[kept]))
    places = np.full(len(named) + 1, NOWHERE, np.int32)
    places[kept[order]] = np.arange(len(kept))
    labels, level = places[labels], places[level]
    divides = find_divides(network, labels, level)
    del network, labels, level
    drawn = gather_polygons(cut_at_divides(divides))
    done.end()
    return Features.of_polygons(
        drawn.points,
        drawn.ring_offsets,
        drawn.polygon_offsets,
        drawn.feature_offsets,
        columns={name: values[order][drawn.regions] for name, values in columns.items()},
        units={"area": reference.units.area},
        crs=tin.crs,
        elevation_unit=tin.elevation_unit,
        name="catchments",
        notes=[*reference.notes, *notes, BOUNDARY_NOTE, *drawn.notes],
    )


@product
def flow_accumulation(
    tin: TIN,
    *,
    min_area: float = 0.0,
    fill_depressions: bool = False,
    progress: Callable[[float], None] | None = None,
) -> Features:
    """Measure the area that drains through each channel of a surface.

    Parameters
    ----------
    tin : TIN
    min_area : float, optional
        Leave out channels through which less drains, in the square of CRS units.
    fill_depressions, progress
        As of :func:`catchments`.

    Returns
    -------
    Features
        A line for each edge along which water runs, from its upper end, the largest first, with the
        columns ``start`` and ``end`` (vertices), ``area`` that drains through the edge at its lower
        end, and ``start_area`` and ``end_area``, those that drain through both vertices. With
        ``fill_depressions`` also ``kind`` ("descent", "pond" or "flat", over level ground), and
        elevations are those of the water where there is any.

    Raises
    ------
    CrsError
        If coordinates are degrees.
    OptionError
        If the least area is no number from 0 on, or ``fill_depressions`` no flag.
    PointsError
        If fall lines cross too many triangles.

    Notes
    -----
    Areas are those in the plane, of the strips of :func:`catchments` that come to an edge, and of
    all water that comes to its upper end and leaves it along the edge. Water that leaves a vertex
    down a triangle runs there on no edge, and no line shows it.

    Examples
    --------
    >>> import tinsmith as ts
    >>> low, high = [[0, 0, 1], [4, 0, 0]], [[0, 2, 3], [4, 2, 2], [0, -2, 3], [4, -2, 2]]
    >>> found = ts.flow_accumulation(ts.triangulate([*low, *high]))
    >>> found.columns["area"].tolist()
    [15.0]
    """
    min_area = as_number("min_area", min_area, least=0)
    is_filled = as_flag("fill_depressions", fill_depressions)
    reference, done = find_reference(tin, "Flow accumulation"), Progress(progress)
    filling = fill(tin) if is_filled else None
    network = build_network(tin, filling, done.stage(0.1, 0.9))
    total = accumulate(network)
    pairs, areas = _kernel.sum_channels(network.uppers, network.nexts, total, len(tin.points))
    chosen = np.flatnonzero((areas > 0.0) & (areas >= min_area))
    chosen = chosen[np.lexsort((chosen, -areas[chosen]))]
    start, end = pairs[chosen].T.astype(np.int64)
    columns = {
        "start": start,
        "end": end,
        "area": areas[chosen],
        "start_area": total[network.first_vertex + start],
        "end_area": total[network.first_vertex + end],
    }
    names = ("area", "start_area", "end_area")
    coordinates = tin.points[pairs[chosen]].reshape(-1, 3)
    notes: tuple[str, ...] = (BOUNDARY_NOTE,)
    if filling is not None:
        is_level = filling.levels[start] == filling.levels[end]
        is_wet = (filling.ponds[start] != NOWHERE) | (filling.ponds[end] != NOWHERE)
        columns["kind"] = KINDS[np.where(is_level, np.where(is_wet, POND, FLAT_GROUND), DESCENT)]
        coordinates[:, 2] = filling.levels[pairs[chosen]].ravel()
        notes += (FILLED_NOTE,)
    done.end()
    return Features.of_lines(
        coordinates,
        2 * np.arange(len(chosen) + 1),
        columns=columns,
        units=dict.fromkeys(names, reference.units.area),
        crs=tin.crs,
        elevation_unit=tin.elevation_unit,
        name="flow accumulation",
        notes=[*reference.notes, *notes],
    )


def _label(network: Network, numbers: Int32Array) -> tuple[Int32Array, Int32Array]:
    """Return the number of each strip's end, and of level triangles; ``NOWHERE`` for none."""
    falls = network.walker.falls
    ends = find_ends(network.nexts)
    labels = numbers[ends[: network.first_vertex]]
    level = np.full(len(falls.triangles), NOWHERE, np.int32)
    flat = np.flatnonzero(falls.is_level)
    level[flat] = numbers[ends[network.find_level_nodes(flat)]]
    return labels, level


def _measure(network: Network, labels: Int32Array, level: Int32Array, count: int) -> Float64Array:
    areas = np.zeros(count + 1)  # the last of what has no label
    sizes = network.measure_strips()
    for block in blocks(len(sizes)):
        np.add.at(areas, labels[block], sizes[block])
    areas = areas[:-1]
    flat = level != NOWHERE
    np.add.at(areas, level[flat], network.areas[flat])
    return areas


def _describe_catchments(
    tin: TIN, network: Network, nodes: Int64Array, numbers: Int64Array, is_all: bool
) -> dict[str, Any]:
    """Name what the water of catchments comes to: all ends there are, or outlets by number."""
    vertices = nodes - network.first_vertex
    if not is_all:
        return {"outlet": numbers, "vertex": vertices}
    if network.walker.filling is None:
        return _describe_pits(tin, network, nodes)
    return {"vertex": np.where(nodes == len(network.nexts) - 1, NOWHERE, vertices)}


def _describe_pits(tin: TIN, network: Network, nodes: Int64Array) -> dict[str, Any]:
    """Name what water ends in: a pit if nothing descends from the level ground there."""
    z, count = tin.points[:, 2], len(tin.points)
    leaves = network.walker.is_boundary.copy()
    for near, far in (tin.edges.T, tin.edges.T[::-1]):
        leaves[near[z[far] < z[near]]] = True
    drains = np.zeros(count, np.bool_)
    drains[network.grounds[leaves]] = True
    vertices = nodes - network.first_end
    outside = vertices == count
    vertices[outside] = 0
    pit = ~outside & ~drains[vertices]
    vertices[pit] = _find_westernmost(tin.points, network.grounds)[vertices[pit]]
    vertices[outside] = NOWHERE
    ends = np.where(outside, "boundary", np.where(pit, "pit", "flat")).astype(object)
    return {"pit": vertices, "end": ends}


def _find_westernmost(points: Float64Array, grounds: Int32Array) -> Int64Array:
    """Return the westernmost vertex of each level ground, of several the southernmost, (n,)."""
    found = np.arange(len(grounds))
    wide = np.flatnonzero(grounds != found)
    members = np.union1d(wide, grounds[wide])
    x, y = points[members, :2].T
    order = members[np.lexsort((y, x))[::-1]]
    found[grounds[order]] = order  # the last one that is written stays
    return found


def _place_outlets(tin: TIN, network: Network, outlets: Any) -> tuple[Int64Array, tuple[str, ...]]:
    """Return the nodes of the vertices that drops come to, which fall at outlets."""
    xy, notes = as_places(tin, outlets, "the outlets")
    drops = place_drops(tin, network.walker, xy)
    runs = np.flatnonzero(
        (drops.vertices == NOWHERE) & (drops.targets == NOWHERE) & (drops.ends == MOVING)
    )
    if len(runs):
        drops.put(runs, settle(network.walker, drops.choose(runs))[0])
    vertices = np.where(drops.vertices != NOWHERE, drops.vertices, drops.targets)
    lost = np.flatnonzero(vertices == NOWHERE)
    if len(lost):
        raise PointsError(
            f"Water from outlet {lost[0]} (from 0 on) comes to no vertex of the surface: "
            "it ends on level ground, or leaves across the boundary.",
            rows=lost[:5],
        )
    filling = network.walker.filling
    if filling is not None:
        ponds = filling.ponds[vertices]
        spills = np.append(filling.hierarchy.spill_vertices, NOWHERE)[ponds]
        vertices = np.where(ponds == NOWHERE, vertices, spills)
    order = np.argsort(vertices, kind="stable")
    same = np.flatnonzero(np.diff(vertices[order]) == 0)
    if len(same):
        one, other = order[same[0]], order[same[0] + 1]
        raise PointsError(
            f"Outlets {one} and {other} (from 0 on) come to the same vertex: leave one of them out."
        )
    moved = int((tin.points[vertices, :2] != xy).any(axis=1).sum())
    if moved:
        notes += (f"Outlets moved down to the first vertex their water comes to: {moved:,}.",)
    return network.first_vertex + vertices, notes
