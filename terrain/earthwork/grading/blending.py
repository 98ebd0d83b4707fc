"""A surface that goes over into the one around it, in a strip along its boundary."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ....base.errors import LinesError
from ....base.sentences import coordinate
from ....tin import Breakline, Survey, triangulate
from ....tin.building import join_columns
from ....tin.meshing import clip_tin
from ....tin.topology import mark_corners
from .seams import find_area, measure_tolerance

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ....base.arrays import BoolArray, Float64Array, Int64Array
    from ....base.georeference import Reference
    from ....tin import TIN

_JOINT = "joint"


class SeamSteps(NamedTuple):
    """How two surfaces lie over each other, and how far apart they are along the seam."""

    overlap: float
    """Area that both cover, CRS units squared."""
    length: float
    """Of the seam, the part of the upper one's boundary that lies on the other; CRS units."""
    mean: float
    """Of the differences along it, in the unit of elevations, without their signs."""
    largest: float
    place: tuple[float, float]
    """Where that is."""

    def describe(self, name: str, agreed: Reference, blend: float) -> str:
        """Tell it in a sentence that begins with the name of the upper surface."""
        unit = agreed.units.area or "square units"
        if not self.overlap:
            return f"{name} lies over none of those after it."
        told = f"{name} lies over {self.overlap:.6g} {unit} of those after it"
        if not self.length:
            return f"{told}."
        symbol = "" if agreed.elevation_unit is None else f" {agreed.elevation_unit.symbol}"
        x, y = self.place
        told += (
            f"; along the seam they differ by {self.mean:.4g}{symbol} on average, "
            f"{self.largest:.4g}{symbol} at most, at {coordinate(x)} {coordinate(y)}"
        )
        length = agreed.units.length
        width = f"{blend:g}" if length is None else f"{blend:g} {length.symbol}"
        return f"{told}; blended over {width}." if blend else f"{told}."


class Strip(NamedTuple):
    """Where a patch goes over into a base."""

    seam: Any
    """The segments of the patch's boundary that lie on the base, of shapely."""
    area: Any
    """What is nearer to the seam than the width, on the base."""
    width: float
    tolerance: float
    """The distance within which places are one."""


def measure_seam(patch: TIN, base: TIN) -> SeamSteps:
    """Measure how a patch lies over a base, both in one CRS and unit."""
    import shapely

    ground, over = find_area(base), find_area(patch)
    tolerance = measure_tolerance(patch.points, base.points)
    overlap = float(shapely.intersection(over, ground).area)
    if overlap <= tolerance * over.length:  # by rounding
        overlap = 0.0
    rings = [np.concatenate([ring, ring[:1]]) for ring in _cut_rings(patch, base, tolerance)]
    pairs = np.concatenate([np.stack([ring[:-1], ring[1:]], axis=1) for ring in rings])
    pairs = pairs[_are_seam(pairs[:, :, :2], ground, tolerance)]
    if not len(pairs):
        return SeamSteps(overlap, 0.0, 0.0, 0.0, (0.0, 0.0))
    ends = pairs.reshape(-1, 3)
    steps = (ends[:, 2] - base.interpolate(ends[:, :2], extrapolate="nearest")).reshape(-1, 2)
    lengths = np.hypot(*(pairs[:, 1] - pairs[:, 0])[:, :2].T)
    a, b = np.abs(steps).T
    middle = a / 2 + b / 2
    half = np.where(middle > 0.0, middle, 1.0)  # no squares: they overflow where steps do not
    crossing = a * (a / half / 4) + b * (b / half / 4)
    means = np.where(np.sign(steps[:, 0]) * np.sign(steps[:, 1]) < 0.0, crossing, middle)
    worst = int(np.abs(steps).argmax())
    x, y = ends[worst, :2].tolist()
    mean = float((means * lengths).sum() / lengths.sum())
    return SeamSteps(overlap, float(lengths.sum()), mean, float(np.abs(steps).max()), (x, y))


def _are_seam(segments: Float64Array, ground: Any, tolerance: float) -> BoolArray:
    """Tell which segments, (k, 2, 2), lie in an area, and not along its outline."""
    import shapely

    outline = shapely.boundary(ground)
    is_long = np.hypot(*(segments[:, 1] - segments[:, 0]).T) > tolerance
    is_within = _are_within(ground, outline, segments.mean(axis=1), tolerance)
    return np.asarray(is_long & is_within, np.bool_)


def _are_within(area: Any, outline: Any, places: Float64Array, tolerance: float) -> BoolArray:
    """Tell which places, (k, 2) or more, lie in an area and not near its outline."""
    import shapely

    points = shapely.points(places[:, :2])
    for one in (area, outline):
        shapely.prepare(one)
    found = shapely.contains_properly(area, points) & ~shapely.dwithin(outline, points, tolerance)
    return np.asarray(found, np.bool_)


def find_strip(patch: TIN, base: TIN, width: float) -> Strip | None:
    """Return the strip along the boundary of a patch on a base; None if no part of it is there."""
    import shapely

    tolerance = measure_tolerance(patch.points, base.points)
    ground = find_area(base)
    rings = [patch.points[np.append(ring, ring[0]), :2] for ring in patch.boundary]
    lines = shapely.multilinestrings([shapely.linestrings(ring) for ring in rings])
    parts = shapely.get_parts(shapely.intersection(lines, ground))
    paths = [shapely.get_coordinates(part) for part in parts if part.geom_type == "LineString"]
    pairs = [np.stack([path[:-1], path[1:]], axis=1) for path in paths]
    segments = np.concatenate([np.empty((0, 2, 2)), *pairs])
    segments = segments[_are_seam(segments, ground, tolerance)]
    if not len(segments):
        return None
    seam = shapely.multilinestrings(shapely.linestrings(segments))
    area = shapely.intersection(shapely.buffer(seam, width), ground)
    polygons = [one for one in shapely.get_parts(area) if one.geom_type == "Polygon"]
    return Strip(seam, shapely.multipolygons(polygons), width, tolerance)


def blend_into(patch: TIN, base: TIN, strip: Strip) -> TIN:
    """Return a patch that meets the base along the seam, both in one CRS and unit.

    In the strip its elevations are means of both: the base's at the seam, its own at the distance
    of the width, and linear between. Its vertices there are those of both surfaces. What is farther
    away stays as it is, exactly: the triangles at the border of the strip are divided along it.
    """
    rings = [
        np.ascontiguousarray(np.asarray(ring.coords)[:-1, :2])
        for part in strip.area.geoms
        for ring in (part.exterior, *part.interiors)
    ]
    inner = clip_tin(patch, rings, outside=False).tin
    try:
        beyond: TIN | None = clip_tin(patch, rings, outside=True).tin
    except LinesError:  # the strip holds all of the patch
        beyond = None
    lift = _Lift(patch, base, strip, beyond)
    is_own = mark_corners(patch.triangles, len(patch.points))
    is_other = _find_inside(base, strip)
    made = np.empty((0, 3))
    if beyond is not None:
        made = beyond.points[np.concatenate(beyond.boundary)]
    columns = [
        {name: column[is_taken] for name, column in tin.attributes.items()}
        for tin, is_taken in ((patch, is_own), (base, is_other))
    ]
    points = np.concatenate([patch.points[is_own], base.points[is_other]])
    return triangulate(
        Survey(
            points=lift(points),
            attributes=join_columns(columns, [int(is_own.sum()), int(is_other.sum())]),
        ),
        breaklines=[*_list_lines(inner, lift), *_list_fixed(beyond)],
        boundary=[lift(ring) for ring in _cut_rings(patch, base, strip.tolerance, made)],
        duplicates="first",
        crs=patch.crs,
        elevation_unit=patch.elevation_unit,
    )


class _Lift:
    """Gives places the elevations that they have in the end."""

    def __init__(self, patch: TIN, base: TIN, strip: Strip, beyond: TIN | None) -> None:
        import shapely

        self._patch, self._base, self._strip = patch, base, strip
        fixed = np.empty((0, 3)) if beyond is None else beyond.points
        self._fixed = {(x, y): z for x, y, z in fixed.tolist()}
        shapely.prepare(strip.seam)
        self._ground = find_area(base)
        self._outline = shapely.boundary(self._ground)

    def __call__(self, points: Float64Array) -> Float64Array:
        """Return points, (n, 3), with other elevations where they lie in the strip."""
        import shapely

        strip, xy = self._strip, np.ascontiguousarray(points[:, :2])
        places = shapely.points(xy)
        is_in = _are_within(self._ground, self._outline, xy, strip.tolerance)
        is_in &= shapely.dwithin(strip.seam, places, strip.width)
        is_in &= np.array([(x, y) not in self._fixed for x, y in xy.tolist()], np.bool_)
        share = shapely.distance(strip.seam, places[is_in]) / strip.width
        own, other = (
            tin.interpolate(xy[is_in], extrapolate="nearest") for tin in (self._patch, self._base)
        )
        lifted = points.copy()
        lifted[is_in, 2] = other + np.minimum(share, 1.0) * (own - other)
        return lifted


def _find_inside(base: TIN, strip: Strip) -> BoolArray:
    """Tell which vertices of the base are in the strip, and not on its border."""
    import shapely

    border = shapely.boundary(strip.area)
    is_inside = _are_within(strip.area, border, base.points, strip.tolerance)
    is_inside &= ~shapely.dwithin(strip.seam, shapely.points(base.points[:, :2]), strip.tolerance)
    return is_inside & mark_corners(base.triangles, len(base.points))


def _list_lines(inner: TIN, lift: _Lift) -> Iterator[Breakline]:
    """Yield the breaklines of the patch in the strip."""
    lines = inner.lines
    for chain, kind, name in zip(lines.chains(), lines.kinds, lines.names, strict=True):
        if kind == "hard" or (kind == "soft" and name != _JOINT):
            yield Breakline(lift(inner.points[chain]), kind=kind, name=name)


def _list_fixed(beyond: TIN | None) -> Iterator[Breakline]:
    """Yield the lines of the patch beyond the strip, and the border of the strip."""
    if beyond is None:
        return
    lines = beyond.lines
    for chain, kind, name in zip(lines.chains(), lines.kinds, lines.names, strict=True):
        if kind in ("hard", "soft"):
            shape: Any = kind
            yield Breakline(beyond.points[chain], kind=shape, name=name)
    for ring in beyond.boundary:
        closed = beyond.points[np.append(ring, ring[0])]
        yield Breakline(closed, kind="soft", name=_JOINT)


def _cut_rings(
    patch: TIN, base: TIN, tolerance: float, made: Float64Array | None = None
) -> Iterator[Float64Array]:
    """Yield the rings of a patch, (k, 3), with a vertex wherever an edge of the base crosses.

    If vertices were ``made`` on its boundary, (m, 3), they are taken where the base ends.
    """
    import shapely

    ground = find_area(base)
    outline = shapely.boundary(ground)
    edges = base.points[base.edges, :2]
    tree = shapely.STRtree(shapely.linestrings(edges))
    given = np.empty((0, 3)) if made is None else made
    for ring in patch.boundary:
        start = patch.points[ring]
        way = np.roll(start, -1, axis=0) - start
        sides = shapely.linestrings(np.stack([start[:, :2], start[:, :2] + way[:, :2]], axis=1))
        side, edge = tree.query(sides, predicate="intersects")
        with np.errstate(divide="ignore", invalid="ignore"):  # along the side
            share = _cross(edges[edge, 0] - start[side, :2], edges[edge, 1] - edges[edge, 0])
            share /= _cross(way[side], edges[edge, 1] - edges[edge, 0])
        is_between = (share > 0.0) & (share < 1.0)
        side, share = side[is_between], share[is_between]
        places = start[side] + share[:, None] * way[side]
        if made is None:
            is_on = np.ones(len(places), np.bool_)
        else:
            is_on = _are_within(ground, outline, places, tolerance)
        near, at = shapely.STRtree(sides).query(
            shapely.points(given[:, :2]), predicate="dwithin", distance=tolerance
        )
        along = ((given[near] - start[at])[:, :2] * way[at, :2]).sum(axis=1)
        along /= (way[at, :2] ** 2).sum(axis=1)
        yield _insert(
            start,
            np.concatenate([at, side[is_on]]),
            np.concatenate([along, share[is_on]]),
            np.concatenate([given[near], places[is_on]]),
            tolerance=tolerance,
        )


def _insert(
    ring: Float64Array,
    side: Int64Array,
    share: Float64Array,
    places: Float64Array,
    *,
    tolerance: float,
) -> Float64Array:
    """Insert places into the sides of a ring, of those that are one the first given."""
    lengths = np.hypot(*(np.roll(ring, -1, axis=0) - ring)[:, :2].T)
    along = share * lengths[side]
    order = np.lexsort((along, side))
    chosen: list[int] = []
    for k in order.tolist():
        if not tolerance < along[k] < lengths[side[k]] - tolerance:
            continue
        if chosen and side[chosen[-1]] == side[k] and along[k] - along[chosen[-1]] <= tolerance:
            chosen[-1] = min(chosen[-1], k)
        else:
            chosen.append(k)
    return np.insert(ring, side[chosen] + 1, places[chosen], axis=0)


def _cross(u: Float64Array, v: Float64Array) -> Float64Array:
    product: Float64Array = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
    return product
