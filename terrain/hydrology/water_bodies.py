"""Depressions: pits, where they spill, and what they hold; and ponds at a level."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.checks import as_flag, as_number
from ...base.errors import OptionError
from ...base.products import product
from ...base.results import Features
from ...tin.topology import NO_NEIGHBOR, find_boundary_vertices, gather
from ..surface import find_reference, find_slivers, follow_to_end, number_components
from .descent import Walker
from .falls import find_falls
from .filling import fill
from .networks import build_vertex_network, find_ends
from .vertices import NOWHERE, sort_edges_at
from .water import Waters, cut_below, gather_polygons, measure_waters

if TYPE_CHECKING:
    from ...base.arrays import AnyArray, BoolArray, Float64Array, Int64Array
    from ...tin import TIN
    from ..surface import Reference
    from .filling import Filling
    from .hierarchy import Hierarchy

_MOST_VERTICES = 5_000_000
"""Of all waters that lie in each other, beyond those of the surface."""

BOUNDARY_NOTE = "Water leaves the surface freely at its boundary, and into its holes."


@product
def pits(tin: TIN) -> Features:
    """Find the pits of a surface: the lowest vertices of its depressions.

    Parameters
    ----------
    tin : TIN

    Returns
    -------
    Features
        A point for each depression that has no other one in it, by elevation, with the columns
        ``vertex``, ``depth`` up to where it spills or joins another one, ``spill_level``,
        ``spill_x``, ``spill_y`` and ``spill_vertex``.

    Raises
    ------
    CrsError
        If coordinates are degrees.

    Notes
    -----
    Flat ground that nothing descends from is one pit. Water runs off freely at the boundary, so
    that what is lowest there is no pit.

    Examples
    --------
    >>> import tinsmith as ts
    >>> bowl = [[0, 0, 3], [6, 0, 3], [6, 6, 2], [0, 6, 3], [3, 3, 0]]
    >>> found = ts.pits(ts.triangulate(bowl))
    >>> found.coordinates, found.columns["depth"], found.columns["spill_vertex"]
    (array([[3., 3., 0.]]), array([2.]), array([2]))
    """
    reference = find_reference(tin, "Pits")
    found = fill(tin).hierarchy
    is_leaf = np.ones(len(found.pits), np.bool_)
    is_leaf[found.parents[found.parents != NOWHERE]] = False
    chosen = np.flatnonzero(is_leaf)
    chosen = chosen[np.lexsort((found.pits[chosen], tin.points[found.pits[chosen], 2]))]
    columns = {"vertex": found.pits[chosen], **_describe_spills(tin, found, chosen)}
    return Features.of_points(
        tin.points[found.pits[chosen]],
        columns=columns,
        units=_list_units(reference, columns),
        crs=tin.crs,
        elevation_unit=tin.elevation_unit,
        name="pits",
        notes=[*reference.notes, BOUNDARY_NOTE],
    )


@product
def depressions(tin: TIN, *, nested: bool = False, min_depth: float = 0.0) -> Features:
    """Find the depressions of a surface, with the water they hold when they are full.

    Parameters
    ----------
    tin : TIN
    nested : bool, optional
        Also those that are part of a larger one; default the outermost only.
    min_depth : float, optional
        Leave out those that are not as deep, in the unit of elevations.

    Returns
    -------
    Features
        The surface of the water in each when it is full, as polygons at that elevation, the deepest
        first, with the columns ``depression`` (a number from 0 on), ``parent`` (the one it is part
        of, -1 for none), ``into`` (the next outermost one here that its water comes to when all are
        full, -1 where it leaves the surface), ``pit_vertex``, ``pit_level``, ``depth``,
        ``spill_level``, ``spill_x``, ``spill_y``, ``spill_vertex``, ``area`` and ``volume``.

    Raises
    ------
    CrsError
        If coordinates are degrees.
    OptionError
        If the least depth is no number from 0 on, or too many depressions lie in each other.

    Notes
    -----
    As water rises in a surface of triangles, waters join at vertices; so the hierarchy [1]_ is
    exact. Areas and volumes are closed forms over triangles, exact but for rounding. With
    ``nested`` the time is that of all waters together, which lie in each other.

    References
    ----------
    .. [1] R. Barnes, K. L. Callaghan, A. D. Wickert, Computing water flow through complex
       landscapes, Earth Surface Dynamics 8 (2020), doi:10.5194/esurf-8-431-2020.

    Examples
    --------
    >>> import tinsmith as ts
    >>> bowl = [[0, 0, 3], [6, 0, 3], [6, 6, 3], [0, 6, 3], [3, 3, 0]]
    >>> found = ts.depressions(ts.triangulate(bowl))
    >>> found.columns["depth"], found.columns["area"], found.columns["volume"]
    (array([3.]), array([36.]), array([36.]))
    """
    nested = as_flag("nested", nested)
    min_depth = as_number("min_depth", min_depth, least=0)
    reference = find_reference(tin, "Depressions")
    filling = fill(tin)
    found = filling.hierarchy
    chosen = _choose_depressions(tin, found, nested, min_depth)
    waters = _list_waters(tin, found, chosen)
    areas, volumes = measure_waters(tin.points, tin.triangles, waters, reference.up)
    columns = {
        **_describe_places(tin, filling, chosen),
        **_describe_spills(tin, found, chosen),
        "area": areas,
        "volume": volumes,
    }
    return _draw_waters(tin, waters, columns, reference, "depressions", (BOUNDARY_NOTE,))


@product
def ponds(tin: TIN, level: float) -> Features:
    """Find the ponds when water stands at one level wherever the surface is lower.

    Parameters
    ----------
    tin : TIN
    level : float
        In the unit of elevations.

    Returns
    -------
    Features
        A polygon for each, at that elevation, the largest first, with the columns ``pond`` (a
        number from 0 on), ``depth`` at the lowest place, ``area``, ``volume`` and
        ``is_contained``, whether it stays below the boundary of the surface: else water would run
        out of what was surveyed, and the row holds only what is inside.

    Raises
    ------
    CrsError
        If coordinates are degrees.
    OptionError
        If the level is no finite number.

    Examples
    --------
    >>> import tinsmith as ts
    >>> bowl = ts.triangulate([[0, 0, 3], [6, 0, 3], [6, 6, 3], [0, 6, 3], [3, 3, 0]])
    >>> ts.ponds(bowl, 2).columns["volume"].round(3), ts.ponds(bowl, 2).columns["is_contained"]
    (array([10.667]), array([ True]))
    """
    level = as_number("level", level)
    reference = find_reference(tin, "Ponds")
    z = tin.points[:, 2]
    is_wet = z < level
    chosen = np.flatnonzero(is_wet[tin.triangles].any(axis=1))
    numbers, lowest = _part_waters(tin, is_wet, chosen)
    waters = Waters(chosen, numbers, np.full(len(lowest), float(level)))
    areas, volumes = measure_waters(tin.points, tin.triangles, waters, reference.up)
    rim = find_boundary_vertices(tin.triangles, tin.neighbors, len(tin.points)) & is_wet
    touches = np.zeros(len(lowest), np.bool_)
    touches[numbers[rim[tin.triangles[chosen]].any(axis=1)]] = True
    order = np.lexsort((lowest, -areas))
    place = np.argsort(order)
    columns = {
        "pond": np.arange(len(order)),
        "depth": (waters.levels - lowest)[order],
        "area": areas[order],
        "volume": volumes[order],
        "is_contained": ~touches[order],
    }
    waters = waters._replace(numbers=place[numbers])
    return _draw_waters(tin, waters, columns, reference, "ponds", ())


# ---------------------------------------------------------------- which waters


def _choose_depressions(tin: TIN, found: Hierarchy, nested: bool, min_depth: float) -> Int64Array:
    z = tin.points[:, 2]
    depths = z[found.spill_vertices] - z[found.pits]
    chosen = np.flatnonzero((depths >= min_depth) & (nested | (found.parents == NOWHERE)))
    return chosen[np.lexsort((found.pits[chosen], -depths[chosen]))]


def _list_waters(tin: TIN, found: Hierarchy, chosen: Int64Array) -> Waters:
    """Return the triangles in which each depression has water when it is full."""
    z = tin.points[:, 2]
    levels = z[found.spill_vertices]
    numbers = np.full(len(found.pits) + 1, NOWHERE)
    numbers[chosen] = np.arange(len(chosen))
    # Each depression itself, or the innermost that it is part of and that has a number.
    own = np.where(numbers[:-1] != NOWHERE, np.arange(len(found.parents)), found.parents)
    outward = follow_to_end(np.append(own, NOWHERE))
    around = outward[found.basins]
    vertices = np.flatnonzero(around != NOWHERE)
    around = around[vertices]
    wet, waters, count = [], [], 0
    while len(vertices):  # from the inside outwards
        is_wet = z[vertices] < levels[around]
        wet.append(vertices[is_wet])
        waters.append(numbers[around[is_wet]])
        count += len(vertices)
        if count > _MOST_VERTICES + len(z):
            allowed = "False here, or a larger `min_depth` with it, for there is too much to draw"
            raise OptionError("nested", True, allowed=allowed)
        around = outward[found.parents[around]]
        vertices, around = vertices[around != NOWHERE], around[around != NOWHERE]
    return _gather_triangles(tin, wet, waters, levels[chosen])


def _gather_triangles(
    tin: TIN, wet: list[Int64Array], waters: list[Int64Array], levels: AnyArray
) -> Waters:
    """Return the triangles that have a vertex in each water."""
    if not wet:
        return Waters(np.zeros(0, np.int64), np.zeros(0, np.int64), levels)
    vertices = np.concatenate(wet)
    half_edges = sort_edges_at(tin.triangles, vertices, len(tin.points))
    slots, owner = gather(half_edges.offsets, vertices)
    water = np.concatenate(waters)[owner]
    keys = np.unique(half_edges.triangles[slots] * np.int64(len(levels)) + water)
    return Waters(keys // len(levels), keys % len(levels), levels)


def _part_waters(
    tin: TIN, is_wet: BoolArray, chosen: Int64Array
) -> tuple[Int64Array, Float64Array]:
    """Return numbers of waters that are connected, and the lowest elevation in each."""
    wet_edge = np.roll(is_wet[tin.triangles], -1, axis=1) | np.roll(
        is_wet[tin.triangles], 1, axis=1
    )
    neighbors = np.where(wet_edge, tin.neighbors, np.int32(NO_NEIGHBOR))
    roots, numbers = np.unique(number_components(neighbors)[chosen], return_inverse=True)
    lowest = np.full(len(roots), np.inf)
    np.minimum.at(lowest, numbers, tin.points[tin.triangles[chosen], 2].min(axis=1))
    return numbers, lowest


# ---------------------------------------------------------------- what is told of them


def _list_units(reference: Reference, columns: dict[str, Any]) -> dict[str, Any]:
    known: dict[str, Any] = {
        **dict.fromkeys(("spill_x", "spill_y"), reference.units.length),
        **dict.fromkeys(("depth", "pit_level", "spill_level"), reference.elevation_unit),
        "area": reference.units.area,
        "volume": reference.units.volume,
    }
    return {name: known[name] for name in columns if name in known}


def _describe_spills(tin: TIN, found: Hierarchy, chosen: Int64Array) -> dict[str, Any]:
    spills = found.spill_vertices[chosen]
    x, y, z = tin.points[spills].T
    return {
        "depth": z - tin.points[found.pits[chosen], 2],
        "spill_level": z,
        "spill_x": x,
        "spill_y": y,
        "spill_vertex": spills,
    }


def _describe_places(tin: TIN, filling: Filling, chosen: Int64Array) -> dict[str, Any]:
    """Name depressions, those they are part of, and those that they run over into."""
    found, numbers = filling.hierarchy, np.full(len(filling.hierarchy.pits) + 1, NOWHERE)
    numbers[chosen] = np.arange(len(chosen))
    outer, row = np.unique(found.find_roots()[chosen], return_inverse=True)
    into = _run_over(tin, filling, outer, numbers != NOWHERE) if len(outer) else outer
    return {
        "depression": np.arange(len(chosen)),
        "parent": numbers[found.parents[chosen]],
        "into": numbers[into][row],
        "pit_vertex": found.pits[chosen],
        "pit_level": tin.points[found.pits[chosen], 2],
    }


def _run_over(tin: TIN, filling: Filling, ponds: Int64Array, is_listed: BoolArray) -> Int64Array:
    """Return the next listed depression that water of full ones comes to, ``NOWHERE`` for none."""
    roots = np.unique(filling.ponds)
    roots = roots[roots != NOWHERE]
    nexts = np.full(len(is_listed), NOWHERE)  # the last one is for NOWHERE
    nexts[roots] = _find_next_ponds(Walker(find_falls(tin), filling), roots)
    further = np.where(is_listed, np.arange(len(nexts)), nexts)  # skips those that are not listed
    further[-1] = NOWHERE
    into: Int64Array = follow_to_end(further)[nexts[ponds]]
    return into


def _find_next_ponds(walker: Walker, ponds: Int64Array) -> Int64Array:
    """Return the next pond from where ponds spill, ``NOWHERE`` if water leaves first."""
    filling: Any = walker.filling
    network = build_vertex_network(walker)
    begins = network.nexts[filling.hierarchy.spill_vertices[ponds]]
    is_wet = filling.ponds != NOWHERE
    wet = np.flatnonzero(is_wet)
    network.nexts[wet] = wet
    ends = find_ends(network.nexts)[begins]
    outside = np.full(len(network.nexts) - len(is_wet), NOWHERE)
    found: Int64Array = np.append(filling.ponds, outside)[ends]
    return found


def _draw_waters(
    tin: TIN,
    waters: Waters,
    columns: dict[str, Any],
    reference: Reference,
    name: str,
    notes: tuple[str, ...],
) -> Features:
    is_drawn = ~find_slivers(tin.points, tin.triangles, tin.neighbors)[waters.triangles]
    seen = Waters(waters.triangles[is_drawn], waters.numbers[is_drawn], waters.levels)
    drawn = gather_polygons(cut_below(tin.points, tin.triangles, seen))
    levels = np.repeat(
        waters.levels[drawn.regions],
        np.diff(drawn.ring_offsets[drawn.polygon_offsets[drawn.feature_offsets]]),
    )
    return Features.of_polygons(
        np.column_stack([drawn.points, levels]),
        drawn.ring_offsets,
        drawn.polygon_offsets,
        drawn.feature_offsets,
        columns={key: values[drawn.regions] for key, values in columns.items()},
        units=_list_units(reference, columns),
        crs=tin.crs,
        elevation_unit=tin.elevation_unit,
        name=name,
        notes=[*reference.notes, *notes, *drawn.notes],
    )
