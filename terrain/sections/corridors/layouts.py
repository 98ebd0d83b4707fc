"""Layouts: bed and side slopes of a corridor in the plane, as far as the ground needs them."""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ....base.errors import LinesError
from ....base.sentences import coordinate, counted
from ....tin import TIN
from ...earthwork.grading import (
    Slope,
    lie_on,
    measure_tolerance,
    meet_ground,
    require_ground,
    require_on_ground,
)
from .designs import SideLines
from .rays import Reach, make_rays
from .stations import choose_stations
from .surfaces import CorridorSurface, Rows, build_surface

if TYPE_CHECKING:
    from collections.abc import Callable

    from ....base.arrays import BoolArray, Float64Array
    from ....base.progress import Progress
    from .axis import Axis
    from .designs import Design
    from .rays import Rays
    from .surfaces import Fold

_SIGNS = {"cut": 1.0, "fill": -1.0}
_SAMPLES = 65
_SHARE_OF_VOLUME = 1e-5
"""Of the area times the largest difference: so much the side slopes less the ground may be off, by
steps at bends that are thinner than coordinates. :mod:`.proof` requires what is designed."""
_SHOWN = 5
_CHECKS = 9
"""Places on an edge at which is seen whether it is made."""
_TOGETHER = 0.01
"""CRS units: ranges of stations no farther apart are told as one."""


class Layout(NamedTuple):
    """A corridor that has met the ground."""

    bed: CorridorSurface
    skirts: list[CorridorSurface]
    slopes: list[Slope]
    """Of each skirt that covers something."""
    ends: list[Float64Array]
    """(2, 2) each: the first and the last section, from left to right."""

    def describe(self, road: Axis) -> list[str]:
        """Tell where it was cut off because another station is nearer."""
        unit = road.agreed.elevation_unit
        symbol = "" if unit is None else f" {unit.symbol}"
        folds: list[Any] = [
            (self.bed.fold, lambda xy: np.ones(len(xy), bool), "the template reaches into that")
        ]
        for skirt, slope in zip(self.skirts, self.slopes, strict=True):
            folds.append((skirt.fold, slope.are_made, "side slopes meet those"))
        notes = []
        for fold, are_made, what in folds:
            ranges, step = _find_ranges(fold, are_made)
            if road.lap is not None:
                ranges = [one for low, high in ranges for one in road.lap.split(low, high)]
            if ranges:
                notes.append(_describe_fold(_join_ranges(ranges), what, step, symbol))
        return list(dict.fromkeys(notes))


class Layouts:
    """What is laid out, farther and farther until side slopes meet the ground."""

    def __init__(
        self,
        tin: TIN,
        area: Any,
        road: Axis,
        design: Design,
        tolerance: float,
        interval: float | None,
    ) -> None:
        factor = road.agreed.factors[0]
        points = tin.points if factor == 1.0 else tin.points * (1.0, 1.0, factor)
        self.ground = (
            tin.replace(crs=None, elevation_unit=None)
            if factor == 1.0
            else TIN.from_triangles(points, tin.triangles)
        )
        self._area, self._road, self._design = area, road, design
        self._tolerance, self._interval = tolerance, interval

    def find(self, done: Progress) -> Layout:
        """Return the layout whose side slopes meet the ground.

        Raises LinesError, PointsError and OptionError as :func:`tinsmith.corridor`.
        """
        far, most = self._estimate_reach()
        for number in range(64):
            done(1.0 - 0.6**number)
            layout, open_ends = self._lay(min(far, max(most.values())))
            for kind, ends in open_ends.items():
                near = lie_on(self._area, ends, measure_tolerance(self.ground.points))
                self._require_far(ends[~near], min(far, max(most.values())))
                require_ground(ends if far >= most[kind] else ends[near], _SIGNS[kind])
            if not any(map(len, open_ends.values())):
                break
            far *= 2.0
        return layout

    def _require_far(self, places: Float64Array, far: float) -> None:
        """Refuse side slopes that end sooner than at a distance: beyond an end of the axis.

        Raises LinesError.
        """
        if not len(places):
            return
        table = self._road.alignment.stations_of(places)
        widest = np.full(len(places), np.inf)
        for side in (-1, 1):
            own = np.flatnonzero((table["offset"] < 0.0) == (side < 0))
            station = np.nan_to_num(table["station"][own], nan=self._road.span[0])
            widest[own] = Reach(self._design, far).measure(side, station)[:, -1]
        is_far = np.abs(table["offset"]) >= widest - 2.0 * self._tolerance
        if not is_far.all():
            x, y = places[~is_far][0].tolist()
            raise LinesError(
                f"At {coordinate(x)} {coordinate(y)} side slopes reach an end of the axis that is "
                "as near as their own stretch: the axis has to end farther from it, or sooner."
            )

    def _estimate_reach(self) -> tuple[float, dict[str, float]]:
        """Return how far slopes go on ground as at their feet, and how far they can on any."""
        stations = np.linspace(*self._road.span, _SAMPLES)
        used = self.ground.points[self.ground.triangles, 2]
        axis = self._road.elevations_at(stations)
        far, most = 0.0, dict.fromkeys(_SIGNS, 0.0)
        across = float(np.hypot(*(np.ptp(self.ground.points[:, :2], axis=0))))
        for side in (-1, 1):
            bed = self._design.find_bed(side, stations)
            ditch = self._design.find_ditch(side, stations)
            hinge = axis + bed.rises[:, -1]
            foot = hinge + ditch.rises[:, -1]
            far = max(far, 0.25 * float(bed.offsets[:, -1].max()))
            places = self._road.alignment.points_at(stations, offset=side * bed.offsets[:, -1])
            ground = self.ground.interpolate(places)
            for kind, start in (("cut", foot), ("fill", hinge)):
                rates = self._design.find_rates(side, stations, kind)
                rise = np.nan_to_num((ground - start) / rates)
                far = max(far, 2.0 * float(rise.max()))
                extreme = used.max() if kind == "cut" else used.min()
                slack = abs(extreme - start).max() * 0.01
                reach = float(((extreme - start) / rates).max()) + slack / float(abs(rates).min())
                most[kind] = max(most[kind], min(reach, across))
        most = {kind: max(value, far) for kind, value in most.items()}
        return far, most

    def _lay(self, far: float) -> tuple[Layout, dict[str, Float64Array]]:
        reach = Reach(self._design, far)
        stations = self._choose_stations(reach)
        rays = make_rays(self._road, reach, stations, self._tolerance)
        bed = self._build_bed(rays)
        ends = self._find_ends(reach)
        skirts, slopes, found = [], [], {}
        tolerance = measure_tolerance(self.ground.points)
        for kind, sign in _SIGNS.items():
            skirt = self._build_skirt(rays, kind, reach, bed)
            if skirt is None:
                raise LinesError("The corridor has no side slopes: its axis turns too sharply.")
            slope, open_ends = meet_ground(
                self.ground, skirt.tin, bed.area, -sign, share=_SHARE_OF_VOLUME
            )
            skirts.append(skirt)
            slopes.append(slope)
            import shapely

            ended = shapely.multilinestrings(ends) if ends else shapely.MultiLineString()
            is_end = shapely.dwithin(ended, shapely.points(open_ends), 64.0 * tolerance)
            found[kind] = open_ends[~is_end]
        return Layout(bed, skirts, slopes, ends), found

    def _choose_stations(self, reach: Reach) -> Float64Array:
        road = self._road
        ends = np.union1d(np.array(road.span), self._design.changes)
        widest = max(float(reach.measure(side, ends)[:, -1].max()) for side in (-1, 1))
        up = road.up * road.agreed.factors[1]
        return choose_stations(
            road,
            self._design,
            widest=widest,
            far=reach.far,
            tolerance=(self._tolerance, self._tolerance / up),
            interval=self._interval,
        )

    def _find_ends(self, reach: Reach) -> list[Float64Array]:
        found = []
        for station in self._road.span if self._road.lap is None else ():
            at = np.array([station])
            offsets = [side * float(reach.measure(side, at)[0, -1]) for side in (-1, 1)]
            places = [self._road.alignment.points_at(at, offset=one)[0] for one in offsets]
            found.append(np.array(places))
        return found

    def _build_bed(self, rays: Rays) -> CorridorSurface:
        """Return what lies between the outermost parts."""
        axis = self._road.elevations_at(rays.stations)
        sides = {side: self._design.find_bed(side, rays.stations) for side in (-1, 1)}
        sides = {s: SideLines(one.offsets, one.rises + axis[:, None]) for s, one in sides.items()}
        names = {side: ["", *self._design.list_names(side)] for side in (-1, 1)}
        names[1][0] = "axis"
        import shapely

        bed = build_surface(rays, Rows(names, sides), self._hold, self._road)
        path = shapely.linestrings(rays.origins[rays.sides == 1])
        if bed is None or bed.area.geom_type != "Polygon" or not shapely.is_simple(path):
            raise LinesError(
                "The corridor lies over itself: stretches of the axis that are far apart along it "
                "are nearer to each other than the template is wide."
            )
        require_on_ground(self._area, bed.area, "The corridor lies off")
        return bed

    def _build_skirt(
        self, rays: Rays, kind: str, reach: Reach, bed: CorridorSurface
    ) -> CorridorSurface | None:
        """Return the side slopes of cuts or fills, whether or not they are made."""
        axis = self._road.elevations_at(rays.stations)
        names, sides = {}, {}
        for side in (-1, 1):
            own = self._design.find_bed(side, rays.stations)
            first = own.offsets[:, -1:], own.rises[:, -1:] + axis[:, None]
            ditch = self._design.find_ditch(side, rays.stations)
            own = ditch if kind == "cut" else SideLines(ditch.offsets[:, :1], ditch.rises[:, :1])
            offsets, heights = first[0] + own.offsets, first[1] + own.rises
            end = first[0] + ditch.offsets[:, -1:] + reach.far
            rates = self._design.find_rates(side, rays.stations, kind)[:, None]
            top = heights[:, -1:] + (end - offsets[:, -1:]) * rates
            sides[side] = SideLines(np.hstack([offsets, end]), np.hstack([heights, top]))
            parts = self._design.list_names(side, ditch=True) if kind == "cut" else []
            names[side] = ["", *parts, ""]
        is_own = partial(self._hold, reach=reach)
        return build_surface(rays, Rows(names, sides), is_own, self._road, bed=bed)

    def _hold(self, places: Float64Array, reach: Reach | None = None) -> BoolArray:
        """Whether places are those of the bed, or of side slopes as far as they may go."""
        table = self._road.alignment.stations_of(places)
        station, offset = table["station"], table["offset"]
        low, high = self._road.span
        known = (station >= low) & (station <= high)
        held = np.zeros(len(places), bool)
        for side in (-1, 1):
            own = np.flatnonzero(known & ((offset < 0.0) == (side < 0)))
            hinge = self._design.find_bed(side, station[own]).offsets[:, -1]
            away = np.abs(offset[own])
            if reach is None:
                held[own] = away <= hinge
            else:
                held[own] = (away >= hinge) & (away <= reach.measure(side, station[own])[:, -1])
        return held


def _find_ranges(
    fold: Fold, are_made: Callable[[Float64Array], BoolArray]
) -> tuple[list[tuple[float, float]], float]:
    """Return the stations at which a surface was cut off, and by how much both sides differ."""
    shares = np.linspace(0.0, 1.0, _CHECKS)
    first, last = fold.places[:, :1], fold.places[:, 1:]
    places = first + shares[:, None] * (last - first)
    is_made = are_made(places.reshape(-1, 2)).reshape(-1, _CHECKS)
    ranges, step = [], 0.0
    for stations, own_made, own in zip(fold.stations, is_made, fold.steps, strict=True):
        made = shares[own_made]
        if len(made):
            found = stations[0] + made[[0, -1]] * (stations[1] - stations[0])
            ranges.append((float(found.min()), float(found.max())))
            step = max(step, float(own))
    return ranges, step


def _describe_fold(ranges: list[tuple[float, float]], what: str, step: float, symbol: str) -> str:
    """Say at which stations a surface was cut off."""
    joined = [
        f"{coordinate(math.floor(low * 1e3) / 1e3)} to {coordinate(math.ceil(high * 1e3) / 1e3)}"
        for low, high in ranges
    ]
    listed = ", ".join(joined[:_SHOWN])
    more = f" and {counted(len(joined) - _SHOWN, 'more range')}" if len(joined) > _SHOWN else ""
    differ = (
        f", the lower of elevations that differ by up to {step:.4g}{symbol}" if step > 1e-6 else ""
    )
    return (
        f"At stations {listed}{more} {what} of other stations, and was cut off where both are as "
        f"near{differ}."
    )


def _join_ranges(ranges: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """Return ranges of stations in ascending order, those that meet as one."""
    joined: list[tuple[float, float]] = []
    for low, high in sorted(ranges):
        if joined and low <= joined[-1][1] + _TOGETHER:
            joined[-1] = joined[-1][0], max(joined[-1][1], high)
        else:
            joined.append((low, high))
    return joined
