"""Regions held fixed: the ground as it is, or a given level, and slopes from them to what moves."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ....base.checks import as_number
from ....base.crs import CRS, Unit, assume_elevation_unit
from ....base.errors import LinesError, OptionError, PointsError
from ....base.georeference import require_same_crs
from ....base.results import Features
from ....base.sentences import coordinate, height
from ....tin import TIN
from ....tin.constraints import gather_rings_of_regions
from ...surface import Surface, double_areas
from ..clipping import clip
from ..subtraction import overlay_heights
from .distances import measure_distances
from .edge_cells import FACET
from .pasting import join_surfaces
from .patches import build_patch, require_on_ground
from .seams import find_area, measure_tolerance
from .slopes import find_slope, take_near

if TYPE_CHECKING:
    from ....base.arrays import BoolArray, Float64Array
    from ....base.georeference import Reference
    from .slopes import Slope

ELEVATION_COLUMNS = ("elevation", "z", "level", "height")
"""Columns that give the level of a fixed region, in this order."""
_SHARE = 1e-6
"""Of the area of a region: less is reached by rounding only."""
_LEVEL = 1e-9
"""Units of elevations: triangles that are raised or lowered by less are unchanged."""
_STEP = 1e-6
"""Units of elevations: a lower step at the edge of a region is rounding, and needs no slope."""


class Fixed(NamedTuple):
    """A region that stays as it is, a polygon of shapely without holes."""

    name: str
    polygon: Any
    """With corners where the ground breaks at its edge."""
    heights: Float64Array
    """(k,), at the corners, of which the last is the first again."""
    normals: Float64Array
    """(k - 1, 2), of length 1, from each of its sides outwards."""
    ground: TIN | None
    """The ground within it, None at a given level."""

    @property
    def title(self) -> str:
        """Its name at the beginning of a sentence."""
        return self.name[:1].upper() + self.name[1:]

    @property
    def is_level(self) -> bool:
        """Whether its edge has one elevation."""
        return bool((self.heights == self.heights[0]).all())

    def measure_heights(self, xy: Float64Array) -> Float64Array:
        """Return the elevations of its edge at places on it, (n, 2), or nearest to them."""
        import shapely

        ring = shapely.get_coordinates(self.polygon.exterior)
        along = np.append(0.0, np.cumsum(np.hypot(*np.diff(ring, axis=0).T)))
        stations = shapely.line_locate_point(self.polygon.exterior, shapely.points(xy))
        return np.asarray(np.interp(stations, along, self.heights))

    def find_range(self) -> tuple[float, float]:
        """Return the lowest and the highest elevation of its edge."""
        return float(self.heights.min()), float(self.heights.max())

    def make_skirt(self, reach: float, rate: float, tolerance: float) -> TIN:
        """Return the slope all around it, which rises by ``rate`` for a unit along."""
        if self.is_level:
            distances = measure_distances(self.polygon, reach, tolerance)
            points = distances.points * (1.0, 1.0, rate)
            points[:, 2] += self.heights[0]
            return TIN.from_triangles(points, distances.triangles)
        return self._fan_out(reach, rate)

    def _fan_out(self, reach: float, rate: float) -> TIN:
        """Return planes at right angles to the sides of a convex region, and cones between them."""
        import shapely

        ring = shapely.get_coordinates(self.polygon.exterior)[:-1]
        points = [*np.column_stack([ring, self.heights[:-1]])]
        triangles: list[tuple[int, int, int]] = []
        angles = np.arctan2(self.normals[:, 1], self.normals[:, 0])
        first, last = [], []
        for corner, start in enumerate(ring):
            turn = (angles[corner] - angles[corner - 1] + math.pi) % (2.0 * math.pi) - math.pi
            steps = math.ceil(max(turn, 0.0) / FACET - 1e-9)
            first.append(len(points))
            for ray in range(steps + 1):
                angle = angles[corner] - turn * (1.0 - ray / steps) if steps else angles[corner]
                way = np.array([math.cos(angle), math.sin(angle)])
                points.append(np.append(start + reach * way, self.heights[corner] + reach * rate))
                if ray:
                    triangles.append((corner, len(points) - 2, len(points) - 1))
            last.append(len(points) - 1)
        for corner in range(len(ring)):
            after = (corner + 1) % len(ring)
            triangles.append((corner, last[corner], first[after]))
            triangles.append((corner, first[after], after))
        return TIN.from_triangles(np.array(points), np.array(triangles, np.int32))


class Site(NamedTuple):
    """What slopes are made with."""

    ratios: tuple[float, float]
    """Of slopes, horizontal over vertical, of cuts and of fills."""
    reference: Reference
    area: Any
    """What the ground covers, of shapely."""


class Held(NamedTuple):
    """A graded surface in which regions are as they have to be."""

    surface: TIN
    own: Any
    """What the regions and their slopes cover, of shapely."""
    kept: Any
    """Of it where the ground stays."""
    notes: tuple[str, ...]


class _Done(NamedTuple):
    """A region that was put in: what it covers with its slopes, and where these cut and fill."""

    region: Fixed
    area: Any
    made: tuple[Any, Any]


# ---------------------------------------------------------------- what is given


def read_fixed(fixed: Any, tin: TIN, area: Any) -> tuple[list[Fixed], tuple[str, ...]]:
    """Return the regions that are given, those at a level first, and what was assumed.

    Raises OptionError, LinesError, CrsError; PointsError if one lies off the ground.
    """
    if fixed is None:
        return [], ()
    theirs = CRS.of(getattr(fixed, "crs", None))
    is_plain = not hasattr(fixed, "crs")
    notes = require_same_crs(theirs, tin.crs, "the fixed regions", is_plain=is_plain)
    factor, told = _find_factor(fixed, tin)
    found = [
        _make_region(f"fixed region {name}", _make_polygon(name, ring, area), level, tin)
        for name, ring, level in _list_rings(fixed, factor)
    ]
    if not found:
        raise OptionError("fixed", 0, "1 or more", what="number of fixed regions")
    _require_apart(found)
    found.sort(key=lambda one: one.ground is not None)
    levels = [
        f"{one.title} is held at {height(one.heights[0])}." for one in found if one.ground is None
    ]
    return found, (*notes, *told, *levels)


def _list_rings(fixed: Any, factor: float) -> Iterator[tuple[str, Float64Array, float | None]]:
    """Yield name, ring, and level if there is one, of each region."""
    number = 0
    for name, shape, level in _list_given(fixed):
        what = f"fixed region {name or number + 1}"
        for rings in gather_rings_of_regions([shape], what):
            number += 1
            if len(rings) != 1:
                raise LinesError(
                    f"Invalid {what}: it has {len(rings)} rings, and a fixed region is one ring "
                    "without holes."
                )
            own = rings[0][:, 2] if rings[0].shape[1] == 3 else None
            if level is None and own is not None and not np.isnan(own).all():
                if not own.min() == own.max():
                    raise LinesError(
                        f"Invalid {what}: its elevations are {height(own.min())} to "
                        f"{height(own.max())}. A level one, or none to keep the ground, is needed."
                    )
                level = float(own[0])
            yield name or str(number), rings[0], None if level is None else level * factor


def _list_given(fixed: Any) -> Iterator[tuple[str, Any, float | None]]:
    if isinstance(fixed, Features):
        yield from _list_given(fixed.__geo_interface__)
    elif isinstance(fixed, Mapping) and "type" not in fixed:
        yield from ((str(name), shape, None) for name, shape in fixed.items())
    elif isinstance(given := getattr(fixed, "__geo_interface__", fixed), Mapping):
        features = given["features"] if given["type"] == "FeatureCollection" else [given]
        for number, one in enumerate(features, 1):
            properties = one.get("properties") or {}
            level = _find_level(properties, number)
            yield str(properties.get("name") or ""), one.get("geometry", one), level
    elif isinstance(fixed, np.ndarray) and fixed.ndim == 2:
        yield "", fixed, None
    elif isinstance(fixed, Sequence | np.ndarray) and not isinstance(fixed, str):
        is_ring = len(fixed) > 0 and np.ndim(fixed[0]) == 1 and not hasattr(fixed[0], "geom_type")
        yield from (("", shape, None) for shape in ([fixed] if is_ring else fixed))
    else:
        raise OptionError("fixed", type(fixed).__name__, "polygons")


def _find_level(properties: Mapping[str, Any], number: int) -> float | None:
    """Return the level that a column gives.

    Raises OptionError if it is no number, or two columns differ.
    """
    by_lower = {str(key).lower(): value for key, value in properties.items()}
    given = {name: by_lower[name] for name in ELEVATION_COLUMNS if name in by_lower}
    levels = {
        name: as_number(f"fixed[{number}].{name}", value, "a level, or none to keep the ground")
        for name, value in given.items()
        if value is not None and not (isinstance(value, float) and math.isnan(value))
    }
    if len(set(levels.values())) > 1:
        told = ", ".join(f"{name} {height(value)}" for name, value in levels.items())
        raise OptionError(f"fixed[{number}]", told, "one level")
    return next(iter(levels.values()), None)


def _find_factor(fixed: Any, tin: TIN) -> tuple[float, tuple[str, ...]]:
    """Return the factor from elevations of regions to those of the ground, and a note of it."""
    if not isinstance(fixed, Features):
        return 1.0, ()
    units = [fixed.units.get(name) for name in ELEVATION_COLUMNS if name in fixed.columns]
    known = [Unit.of(one) for one in (*units, fixed.elevation_unit) if one is not None]
    own = next(iter(known), None)
    to = assume_elevation_unit(tin.crs, tin.elevation_unit)
    if own is None or to is None or own == to:
        return 1.0, ()
    if own.metres is None or to.metres is None:
        raise OptionError("fixed", str(own), f"levels in the unit of the ground, {to}")
    told = f"The levels of the fixed regions were converted from {own} to {to}."
    return own.metres / to.metres, (told,)


def _make_polygon(name: str, ring: Float64Array, area: Any) -> Any:
    """Return a region, which lies on the ground, as a polygon of shapely."""
    import shapely

    polygon = shapely.Polygon(ring[:, :2])
    polygon = shapely.remove_repeated_points(polygon, measure_tolerance(ring))
    if not polygon.is_valid or not polygon.area > 0:
        raise LinesError(f"Invalid fixed region {name}: {shapely.is_valid_reason(polygon)}.")
    require_on_ground(area, polygon, f"Fixed region {name} lies off")
    return shapely.orient_polygons(polygon)


def _make_region(name: str, polygon: Any, level: float | None, tin: TIN) -> Fixed:
    import shapely

    corners = shapely.get_coordinates(polygon.exterior)
    ground = None
    if level is None:
        ground = clip(tin, [polygon])
        corners, sides = _insert_breaks(polygon, ground, measure_tolerance(tin.points))
        heights = tin.interpolate(corners, extrapolate="nearest")  # rounded, some may lie outside
        heights[-1] = heights[0]
    else:
        heights, sides = np.full(len(corners), level), np.arange(len(corners) - 1)
    way = np.diff(shapely.get_coordinates(polygon.exterior), axis=0)
    normals = np.column_stack([way[:, 1], -way[:, 0]]) / np.hypot(*way.T)[:, None]
    return Fixed(name, shapely.Polygon(corners), heights, normals[sides], ground)


def _insert_breaks(polygon: Any, ground: TIN, tolerance: float) -> tuple[Float64Array, Any]:
    """Return the corners of a ring with those at which edges of the ground cross it.

    And the side of the ring, by its number, that each segment is a part of.
    """
    import shapely

    ring = shapely.get_coordinates(polygon.exterior)
    along = np.append(0.0, np.cumsum(np.hypot(*np.diff(ring, axis=0).T)))
    places = shapely.points(ground.points[np.concatenate(ground.boundary), :2])
    stations = np.sort(shapely.line_locate_point(polygon.exterior, places))
    gaps = np.abs(stations[:, None] - along[None]).min(axis=1)
    stations = stations[gaps > tolerance]
    stations = stations[np.diff(stations, prepend=-np.inf) > tolerance]
    inner = shapely.get_coordinates(shapely.line_interpolate_point(polygon.exterior, stations))
    every = np.append(along, stations)
    order = np.argsort(every, kind="stable")
    corners = np.concatenate([ring, inner])[order]
    sides = np.searchsorted(along, every[order][:-1], side="right") - 1
    return corners, np.minimum(sides, len(ring) - 2)


def _require_apart(regions: Sequence[Fixed]) -> None:
    """Refuse regions that lie over each other."""
    import shapely

    tree = shapely.STRtree([one.polygon for one in regions])
    for first, second in zip(*tree.query([one.polygon for one in regions]), strict=True):
        one, other = regions[first], regions[second]
        shared = one.polygon.intersection(other.polygon) if first < second else None
        if shared is not None and shared.area > _SHARE * min(one.polygon.area, other.polygon.area):
            place = shapely.point_on_surface(shared)
            raise LinesError(
                f"{one.title} and {other.name} lie over each other, at "
                f"{coordinate(place.x)} {coordinate(place.y)}."
            )


# ---------------------------------------------------------------- putting them in


def hold(graded: TIN, patch: TIN, pad: Any, regions: Sequence[Fixed], site: Site) -> Held:
    """Return a graded surface in which regions are as they have to be, with slopes around them.

    ``patch`` are pad and slopes that are in it, ``pad`` is the polygon of the pad.

    Raises
    ------
    PointsError
        If a slope does not meet the ground, or reaches another region; if regions leave nothing of
        the pad.
    LinesError
        If a region that keeps uneven ground has notches, where slopes of it are needed.
    """
    import shapely

    surface, reached = graded, find_area(patch)
    done: list[_Done] = []
    notes = []
    for region in regions:
        overlap = float(region.polygon.intersection(reached).area)
        if region.ground is not None and overlap <= _SHARE * region.polygon.area:
            notes.append(f"{region.title} is not reached.")
            continue
        _require_even(region)
        made, own, slopes = _put_in(surface, region, site)
        surface = made
        found = _Done(region, own, slopes)
        for other in done:
            _require_apart_slopes(found, other)
        done.append(found)
        reached = reached.union(own)
    covered = shapely.union_all([one.area for one in done])
    kept = shapely.union_all([one.region.polygon for one in done if one.region.ground is not None])
    regions_alone = shapely.union_all([one.region.polygon for one in done])
    if pad.difference(regions_alone).area <= _SHARE * pad.area:
        raise PointsError("The fixed regions leave nothing of the pad.")
    lost = float(pad.intersection(covered).area - pad.intersection(regions_alone).area)
    if lost > _SHARE * pad.area:
        unit = site.reference.units.area or "square units"
        notes.append(f"Slopes to fixed regions take {lost:.6g} {unit} of the pad.")
    return Held(surface, covered, kept, tuple(notes))


def _put_in(surface: TIN, region: Fixed, site: Site) -> tuple[TIN, Any, tuple[Any, Any]]:
    """Return a surface with a region and its slopes in it, what they cover, cuts and fills."""
    import shapely

    ratios, reference, area = site
    local = surface.replace(crs=None, elevation_unit=None)
    used = surface.points[surface.triangles, 2]
    low, high = region.find_range()
    across = math.hypot(*np.ptp(surface.points[:, :2], axis=0))
    least = 0.0 if region.ground is None else _STEP
    slopes: list[Slope] = []
    made = [shapely.Polygon(), shapely.Polygon()]
    for number, (sign, ratio) in enumerate(zip((1, -1), ratios, strict=True)):
        rate = sign / (ratio * reference.up)
        reach = float(((used.max() - low) if sign > 0 else (used.min() - high)) / rate)
        if reach <= 0.0:
            continue
        slope = find_slope(local, area, region, rate, min(reach, across), least=least)
        if slope.is_made.any():
            slopes.append(slope)
            own = slope.surface.points[slope.surface.triangles[slope.is_made], :2]
            made[number] = shapely.union_all(shapely.polygons(own))
    if not slopes and region.ground is not None:
        patch = region.ground
    else:
        patch = build_patch(surface, region, slopes, "fixed")
        require_on_ground(area, find_area(patch), "A slope reaches beyond", _SHARE * patch.area)
        if region.ground is not None:
            patch = join_surfaces(patch, region.ground, reference, find_area(patch), "fixed")
    joined = join_surfaces(surface, patch, reference, area, "daylight")
    return joined, find_area(patch), (made[0], made[1])


def _require_even(region: Fixed) -> None:
    """Refuse slopes of a region with notches whose edge is not level."""
    if region.is_level:
        return
    import shapely

    polygon = region.polygon
    corners = shapely.get_coordinates(polygon)
    rounding = measure_tolerance(corners) * float(polygon.length)
    if float(polygon.convex_hull.area - polygon.area) > 1e-9 * float(polygon.area) + rounding:
        raise LinesError(
            f"{region.title} has notches, in which slopes from its uneven edge do not "
            "meet: divide it into convex parts, or give it a level."
        )


def _require_apart_slopes(found: _Done, other: _Done) -> None:
    """Refuse a region whose slopes reach another one, or rise where those of it fall."""
    least = _SHARE * min(found.region.polygon.area, other.region.polygon.area)
    shared = [found.area.intersection(other.region.polygon)]
    shared += [found.made[k].intersection(other.made[1 - k]) for k in (0, 1)]
    for one in shared:
        if one.area > least:
            place = one.representative_point()
            raise PointsError(
                f"The slopes of {found.region.name} and {other.region.name} meet, at "
                f"{coordinate(place.x)} {coordinate(place.y)}: they are too near to each other "
                "for their elevations."
            )


def measure_held(
    tin: TIN, held: Held, works: Any, up: float
) -> tuple[dict[str, float], dict[str, float]]:
    """Return volumes and areas of a site, and the same where pad and its slopes move.

    ``works`` is what these cover, ``up`` the factor from elevations to the unit of eastings.
    """
    import shapely

    bounds = np.reshape(shapely.union(works, held.own).bounds, (2, 2))
    near = [take_near(one, *bounds) for one in (tin, held.surface)]
    points, triangles = overlay_heights(*(Surface(one.points, one.triangles) for one in near))
    area = double_areas(points, triangles) / 2
    rise = points[triangles, 2].mean(axis=1)
    middles = points[triangles, :2].mean(axis=1).T
    is_own, is_works, is_kept = (_contain(one, middles) for one in (held.own, works, held.kept))
    is_site = (is_works | is_own) & ~is_kept
    return _sum(area, rise, is_site, up), _sum(area, rise, is_works & ~is_own, up)


def _contain(area: Any, xy: Float64Array) -> BoolArray:
    import shapely

    shapely.prepare(area)
    inside: BoolArray = shapely.contains_xy(area, *xy)
    return inside


def _sum(area: Float64Array, rise: Float64Array, chosen: BoolArray, up: float) -> dict[str, float]:
    """Return volumes and areas of triangles that are wholly cut or filled by a mean rise."""
    parts = {"cut": rise < -_LEVEL, "fill": rise > _LEVEL, "unchanged": np.abs(rise) <= _LEVEL}
    areas = {f"{name}_area": math.fsum(area[chosen & own]) for name, own in parts.items()}
    raised = np.abs(area * rise) * up
    return areas | {name: math.fsum(raised[chosen & parts[name]]) for name in ("cut", "fill")}
