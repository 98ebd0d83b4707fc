"""Hydro-flattening of flowing water: level across, and falling downstream."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ....base.checks import as_length
from ....base.errors import choice
from ....base.policies import FlowDirection, WaterFit
from ....base.products import product
from ....base.progress import Progress
from ....base.sentences import coordinate, counted, inflect
from ....tin import Breakline, triangulate
from ...earthwork.grading import arrange_rings, find_area, join_surfaces, measure_tolerance
from ...surface import find_reference
from ..profiles import profile
from .centrelines import read_centreline
from .crosslines import make_cross_lines
from .levels import BankSamples, find_direction, fit_levels
from .waters import derive_centreline, find_ends, read_water

if TYPE_CHECKING:
    from collections.abc import Callable

    from ....base.arrays import BoolArray, Float64Array, Int64Array
    from ....base.georeference import Reference
    from ....tin import TIN
    from .centrelines import Centreline
    from .crosslines import CrossLines
    from .waters import Waters

_LEAST_WIDTH = 30.0
"""Metres, 100 feet: nominal width from which the USGS has streams flattened."""
_LEAST_ISLAND = 4046.8564224
"""Square metres, an acre: islands from which on the USGS has them kept."""


class Shore(NamedTuple):
    """The rings of the water with every vertex that they get."""

    rings: list[Float64Array]
    """(k, 2) each, closed."""
    numbers: list[Int64Array]
    """(k,) of each, its vertices among all."""
    points: Float64Array
    """(n, 2), of all rings."""
    lines: Int64Array
    """(p,), the vertex at which each line across ends."""
    starts: Int64Array
    """(p,), that at which it begins, -1 on the centreline."""


class Stream(NamedTuple):
    """The water, and what divides it."""

    waters: Waters
    along: Centreline
    across: CrossLines
    shore: Shore


@product
def hydroflatten(
    tin: TIN,
    water: Any,
    centreline: Any = None,
    *,
    spacing: float,
    fit: WaterFit = "lowest",
    downstream: FlowDirection = "guess",
    progress: Callable[[float], None] | None = None,
) -> TIN:
    """Make flowing water level from bank to bank, and fall downstream.

    Standing water is what ``water`` of :func:`tinsmith.triangulate` flattens. Of flowing water the
    level changes along its centreline only: at each station it is the same from shore to shore, at
    right angles, and nowhere higher than upstream of it.

    Parameters
    ----------
    tin : TIN
        The ground, with whatever was measured on the water.
    water : polygon or polygons
        One stream, its islands as holes; of several parts where bridges interrupt it. As the
        ``polygons`` of :func:`tinsmith.clip`; elevations of theirs are not looked at.
    centreline : (k, 2) array, Features, geometry or Alignment, optional
        One line along the stream. Default the longest path of the medial axis of the polygon.
    spacing : float
        Longest distance of lines across the water along the centreline, CRS units; there is one at
        each of its vertices besides.
    fit : {"lowest", "isotonic"}
        How the level follows the shores: the highest that falls downstream and is nowhere above the
        ground at the shore, or the one that is nearest to it by least squares, above it in places.
    downstream : {"guess", "along", "against"}
        Which way the water flows: as the ground along the shores falls, which is told, or along the
        centreline, or against it.
    progress : callable, optional
        Called with the fraction done, ascending to 1.0. What it raises ends the call.

    Returns
    -------
    TIN
        The ground with the water in it. Breaklines are named "shore", "centreline" and "across".
        Vertices in the water are left out, breaklines end at the shore; other vertices stay as they
        are. ``report.notes`` tell which way the water flows and by how much it falls, how far it
        lies below the ground along the shore, what was left out, and what the specification of the
        USGS says of such a width.

    Raises
    ------
    LinesError
        If a polygon or the centreline crosses itself.
    OptionError
        If ground along the shores does not tell which way the water flows; if there is no
        centreline, and the water has several parts or is not much longer than wide.
    PointsError
        If the water lies off the ground.
    CrsError
        If coordinates are angles, or CRSs differ.

    Notes
    -----
    The rules are those of the Lidar Base Specification of the USGS for streams [1]_: level from
    bank to bank and square to the flow, a gradient downstream, the edge of the water at or just
    below the ground around it, islands kept. A place in the water belongs to the nearest station of
    the centreline, and levels are linear between two lines across. Around the outer side of a bend
    the water is level. On the inner side of a bend places of several stations touch: these get one
    level, and the water falls the more between bends.

    The lowest level at a station is the least elevation of the ground along the shores between its
    line across and the next one, or that of a line upstream, if lower. The isotonic one is the
    weighted least squares fit of the elevations along the shores, at the nearest station, each for
    its length of shore, by pooling adjacent violators [2]_. The shores have a vertex wherever they
    cross an edge of the ground: so the lowest is nowhere above it, up to roundings.

    Edges of a polygon that the centreline crosses, where the stream goes on, are no shore. From the
    shore the ground goes on as it was but in the triangles that the shore cuts, which are
    joined to the water as :func:`tinsmith.paste` does. Water beyond the surface is left out.

    References
    ----------
    .. [1] H. K. Heidemann, Lidar Base Specification, U.S. Geological Survey Techniques and Methods
       11-B4 (2018), doi:10.3133/tm11B4.
    .. [2] R. E. Barlow, D. J. Bartholomew, J. M. Bremner, H. D. Brunk, Statistical Inference under
       Order Restrictions, Wiley, 1972.

    Examples
    --------
    >>> import tinsmith as ts
    >>> ground = [[0, 0, 12], [90, 0, 9], [0, 40, 12], [90, 40, 9]]
    >>> valley = ts.triangulate([*ground, [0, 20, 10], [90, 20, 7], [45, 19, 9]])
    >>> stream = [[0, 15], [90, 15], [90, 25], [0, 25]]
    >>> made = ts.hydroflatten(valley, stream, [[0, 20], [90, 20]], spacing=15)
    >>> made.interpolate([[30, 16], [30, 20], [30, 24], [60, 20]]).round(3)
    array([9.632, 9.632, 9.632, 8.767])
    """
    done = Progress(progress)
    choice("fit", fit, WaterFit)
    choice("downstream", downstream, FlowDirection)
    step = as_length("spacing", spacing)
    reference = find_reference(tin, "Distances")
    area = find_area(tin)
    waters = read_water(water, tin.crs, area)
    along = (
        derive_centreline(waters, tin.crs)
        if centreline is None
        else read_centreline(centreline, tin.crs)
    )
    across = make_cross_lines(waters, along, step)
    done(0.2)
    tolerance = measure_tolerance(tin.points)
    shore = _divide_shore(tin, waters, across, tolerance)
    stream = Stream(waters, along, across, shore)
    ground = tin.interpolate(shore.points, extrapolate="nearest")  # rounded, they may lie outside
    samples, stations = _sample(stream, ground, tolerance)
    is_along, drop = find_direction(samples, across.groups, downstream)
    levels = fit_levels(samples, across.groups, fit, is_along=is_along)
    done(0.3)
    heights = np.interp(stations, across.stations, levels)
    patch = _build_patch(tin, stream, levels, heights)
    done(0.5)
    joined = join_surfaces(tin, patch, reference, area, "shore", progress=done.stage(0.5, 1.0))
    notes = (
        *waters.notes,
        *along.notes,
        *_describe_flow(across, is_along=is_along, drop=drop, reference=reference, how=downstream),
        *_describe_shore(
            (heights - ground)[samples.vertices], shore.points[samples.vertices], reference
        ),
        *_describe_water(tin, waters, reference),
        *joined.report.notes,
    )
    made: TIN = joined.replace(report=replace(joined.report, notes=notes))
    done.end()
    return made


# ---------------------------------------------------------------- the shore


def _divide_shore(tin: TIN, waters: Waters, across: CrossLines, tolerance: float) -> Shore:
    """Put vertices into the rings where lines across end, and where edges of the ground cross."""
    import shapely

    rings = [
        shapely.get_coordinates(ring) for ring in shapely.get_rings(shapely.get_parts(waters.shape))
    ]
    table = profile(tin, rings)
    breaks = np.column_stack([table["x"], table["y"]])
    inner = ~across.starts_inside
    wanted = np.concatenate([across.lines[:, 1], across.lines[inner, 0], across.corners, breaks])
    owner, ratio = _find_on(rings, wanted)
    points, numbers, first = [], [], 0
    at = np.full(len(wanted), -1)
    for k, ring in enumerate(rings):
        chosen = np.flatnonzero(owner == k)
        path, place = _insert(ring, wanted[chosen], ratio[chosen], tolerance)
        points.append(path[:-1])
        at[chosen] = first + place % (len(path) - 1)
        numbers.append(first + np.append(np.arange(len(path) - 1), 0))
        first += len(path) - 1
    every = np.concatenate(points)
    count = len(across.lines)
    starts = np.full(count, -1)
    starts[inner] = at[count : count + int(inner.sum())]
    return Shore([every[one] for one in numbers], numbers, every, at[:count], starts)


def _find_on(rings: list[Float64Array], places: Float64Array) -> tuple[Int64Array, Float64Array]:
    """Return the ring that each place is nearest to, and the number of its segment with a share."""
    import shapely

    pairs = [np.stack([ring[:-1], ring[1:]], axis=1) for ring in rings]
    ends = np.concatenate(pairs)
    owners = np.repeat(np.arange(len(rings)), [len(one) for one in pairs])
    firsts = np.concatenate([np.arange(len(one)) for one in pairs])
    tree = shapely.STRtree(shapely.linestrings(ends))
    near = tree.nearest(shapely.points(places))
    along = ends[near, 1] - ends[near, 0]
    share = ((places - ends[near, 0]) * along).sum(axis=1) / (along**2).sum(axis=1)
    return owners[near], firsts[near] + np.clip(share, 0.0, 1.0)


def _insert(
    ring: Float64Array, places: Float64Array, ratio: Float64Array, tolerance: float
) -> tuple[Float64Array, Int64Array]:
    """Return a closed ring with places put in, and where each is: at a vertex if it is near one."""
    own = np.arange(len(ring), dtype=float)
    every = np.concatenate([own, ratio])
    xy = np.concatenate([ring, places])
    is_given = np.append(np.zeros(len(ring), np.bool_), np.ones(len(places), np.bool_))
    order = np.lexsort((is_given, every))
    path: list[Float64Array] = []
    at = np.empty(len(every), np.int64)
    fixed: list[bool] = []
    for k in order.tolist():
        near = path and float(np.hypot(*(xy[k] - path[-1]))) <= tolerance
        if near and (is_given[k] or not fixed[-1]):
            if not is_given[k]:  # a vertex of the ring counts
                path[-1], fixed[-1] = xy[k], True
        else:
            path.append(xy[k])
            fixed.append(not is_given[k])
        at[k] = len(path) - 1
    return np.array(path), at[len(ring) :]


def _sample(
    stream: Stream, ground: Float64Array, tolerance: float
) -> tuple[BankSamples, Float64Array]:
    """Return elevations of the ground by stations, and the stations of vertices of the shore."""
    import shapely

    waters, along, across, shore = stream
    places = shapely.points(shore.points)
    stations = np.asarray(shapely.line_locate_point(along.line, places))
    stations[shore.lines] = across.stations[across.nodes]
    inner = shore.starts >= 0
    stations[shore.starts[inner]] = across.stations[across.nodes[inner]]
    last = len(across.stations) - 1
    cells = np.clip(np.searchsorted(across.stations, stations, side="right") - 1, 0, last)
    weights = np.zeros(len(shore.points))
    for ring, number in zip(shore.rings, shore.numbers, strict=True):
        length = np.hypot(*np.diff(ring, axis=0).T)
        np.add.at(weights, number[:-1], 0.5 * length)
        np.add.at(weights, number[1:], 0.5 * length)
    is_shore = shapely.distance(places, waters.shore) <= tolerance  # not where the surface ends
    is_shore &= ~_lie_on_ends(shore.points, find_ends(waters, along), tolerance)
    chosen = np.flatnonzero(is_shore) if is_shore.any() else np.arange(len(places))
    own, there = cells[chosen], stations[chosen]
    after = np.minimum(own + 1, last)
    is_nearer = across.stations[after] - there < there - across.stations[own]
    nearest = np.where(is_nearer, after, own)
    at_node = there == across.stations[own]
    samples = BankSamples(chosen, own, at_node, nearest, ground[chosen], weights[chosen])
    return samples, stations


def _lie_on_ends(xy: Float64Array, ends: Float64Array, tolerance: float) -> BoolArray:
    """Tell which places lie on segments, (k, 2, 2), and not at their ends."""
    import shapely

    places = shapely.points(xy)
    lines, corners = shapely.multilinestrings(list(ends)), shapely.multipoints(ends.reshape(-1, 2))
    if not len(ends):
        return np.zeros(len(xy), np.bool_)
    is_on = shapely.distance(lines, places) <= tolerance
    return np.asarray(is_on & (shapely.distance(corners, places) > tolerance))


# ---------------------------------------------------------------- the water


def _build_patch(tin: TIN, stream: Stream, levels: Float64Array, at_shore: Float64Array) -> TIN:
    """Return the water as a surface, with levels of stations and of the vertices of the shore."""
    import shapely

    waters, along, across, shore = stream
    rings = [np.column_stack([shore.points[one], at_shore[one]]) for one in shore.numbers]
    inner = {tuple(xy): float(z) for ring in rings for *xy, z in ring.tolist()}
    outlines = [shapely.linearrings(ring[:, :2]) for ring in rings]
    area = shapely.build_area(shapely.geometrycollections(outlines))
    middles = along.places_at(across.stations)
    nodes = np.column_stack([middles, levels])
    ends = np.column_stack([shore.points, at_shore])
    lines = [
        Breakline(np.stack([nodes[node] if start < 0 else ends[start], ends[end]]), name="across")
        for node, start, end in zip(
            across.nodes.tolist(), shore.starts.tolist(), shore.lines.tolist(), strict=True
        )
        if start != end
    ]
    lines += _list_centreline(waters, nodes, inner)
    outline: dict[str, Any] = arrange_rings(area, inner)
    return triangulate(
        np.concatenate(rings),
        breaklines=lines,
        duplicates="first",
        crs=tin.crs,
        elevation_unit=tin.elevation_unit,
        **outline,
    )


def _list_centreline(
    waters: Waters, nodes: Float64Array, on_shore: dict[tuple[float, float], float]
) -> list[Breakline]:
    """Return the runs of the centreline within the water, (k, 3) each."""
    import shapely

    shapely.prepare(waters.shape)
    pairs = np.stack([nodes[:-1], nodes[1:]], axis=1)
    is_inside = shapely.contains_properly(waters.shape, shapely.linestrings(pairs[:, :, :2]))
    number = np.flatnonzero(is_inside)
    runs = np.split(number, np.flatnonzero(np.diff(number) > 1) + 1)
    return [
        Breakline(nodes[run[0] : run[-1] + 2], name="centreline")
        for run in runs
        if len(run) and not {tuple(xy) for xy in nodes[run, :2].tolist()} & on_shore.keys()
    ]


# ---------------------------------------------------------------- notes


def _describe_flow(
    across: CrossLines, *, is_along: bool, drop: float, reference: Reference, how: str
) -> list[str]:
    """Tell which way the water flows, and where it is level."""
    symbol = _name_unit(reference)
    way = "along the centreline" if is_along else "against the centreline as it is drawn"
    fall = f"the banks fall by {drop:.4g}{symbol} that way"
    notes = [
        f"The water flows {way}: {fall}."
        if how == "guess"
        else f"The water flows {way}, as it was given; {fall}."
    ]
    lengths = np.diff(across.stations)
    level = float(lengths[np.diff(across.groups) == 0].sum())
    if level > 0.0:
        share = 100.0 * level / float(lengths.sum())
        notes.append(
            f"Because of bends that are narrow for the width of the water, {share:.3g} % of the "
            "centreline is level."
        )
    return notes


def _describe_shore(above: Float64Array, xy: Float64Array, reference: Reference) -> list[str]:
    """Tell how far the edge of the water lies below the ground, and above it."""
    symbol = _name_unit(reference)
    low, high = int(above.argmin()), int(above.argmax())
    notes = [
        f"The edge of the water lies {max(-float(above.mean()), 0.0):.4g}{symbol} below the ground "
        f"on average, {max(-float(above[low]), 0.0):.4g}{symbol} at most, at "
        f"{coordinate(xy[low, 0])} {coordinate(xy[low, 1])}."
    ]
    rounding = 1e-9 * max(1.0, float(np.abs(above).max()))
    is_above = above > rounding
    if is_above.any():
        notes.append(
            f"It lies above the ground at {counted(int(is_above.sum()), 'vertex', 'vertices')} of "
            f"{len(above):,}, by {float(above[high]):.4g}{symbol} at most, at "
            f"{coordinate(xy[high, 0])} {coordinate(xy[high, 1])}."
        )
    return notes


def _name_unit(reference: Reference) -> str:
    return "" if reference.elevation_unit is None else f" {reference.elevation_unit.symbol}"


def _describe_water(tin: TIN, waters: Waters, reference: Reference) -> list[str]:
    """Tell how many vertices were in the water, and what the USGS says of its width."""
    import shapely

    shapely.prepare(waters.shape)
    lost = int(shapely.contains_xy(waters.shape, tin.points[:, :2]).sum())
    vertices = counted(lost, "vertex", "vertices")
    notes = [inflect(f"{vertices} in the water [was|were] left out.", lost)] if lost else []
    unit = None if reference.crs is None else reference.crs.horizontal_unit
    if unit is None or unit.metres is None:
        return notes
    width = waters.width * unit.metres
    if width < _LEAST_WIDTH:
        notes.append(
            f"The water is {width:.3g} m wide on average: the Lidar Base Specification of the USGS "
            f"asks for streams from {_LEAST_WIDTH:g} m (100 ft) on."
        )
    parts = shapely.get_parts(waters.shape)
    islands = [shapely.Polygon(ring).area for one in parts for ring in one.interiors]
    small = sum(one * unit.metres**2 < _LEAST_ISLAND for one in islands)
    if small:
        notes.append(
            inflect(
                f"{counted(small, 'island')} smaller than an acre (4,047 m²), which that "
                "specification does not ask for, [was|were] kept.",
                small,
            )
        )
    return notes
