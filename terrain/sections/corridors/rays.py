"""Rays: the cross sections of a corridor in the plane, each to where another station is nearer."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ....base.georeference import find_axes

if TYPE_CHECKING:
    from ....base.arrays import BoolArray, Float64Array, Int64Array
    from .axis import Axis
    from .designs import Design

NEAR = 1e-4
"""CRS units: places so near to each other are one."""

_ROUNDINGS = 16.0
"""Of coordinates: by so much less another station may be nearer."""

_KINK = 1e-6
"""Radians: tangents that turn less go on."""

_HALVINGS = 44
"""Of a length until it is known to roundings."""

_MOST_ROUNDS = 3
"""Of rays that show where lines end and folds meet: after them there are few, or ever more."""

_MOST_STEPS = 64
"""Until a distance is known to roundings."""


class Rays(NamedTuple):
    """Rays square to an axis, sorted by sides, stations and turns."""

    sides: Int64Array
    """(n,), -1 to the left, 1 to the right."""
    stations: Float64Array
    turns: Float64Array
    """(n,), where the axis bends radians from the direction square to what ends there."""
    origins: Float64Array
    ways: Float64Array
    """(n, 2), on the axis, and unit vectors away from it."""
    limits: Float64Array
    """(n,), the distance from which another station is nearer, or the largest that is needed."""
    ends: Float64Array
    """(n, 2), the place there."""

    def take(self, chosen: Int64Array | BoolArray) -> Rays:
        """Return some of them."""
        columns: Any = (column[chosen] for column in self)
        return Rays(*columns)

    def join(self, other: Rays) -> Rays:
        """Return those of both, in order."""
        joined = Rays(*(np.concatenate(pair) for pair in zip(self, other, strict=True)))
        return joined.take(np.lexsort((joined.turns, joined.stations, joined.sides)))

    @property
    def pairs(self) -> Int64Array:
        """(m, 2), those that follow each other on one side."""
        first = np.flatnonzero(self.sides[1:] == self.sides[:-1])
        return np.stack([first, first + 1], axis=1)


class Reach(NamedTuple):
    """How far rays may go: lines of the template, and the end of side slopes behind the last."""

    design: Design
    far: float

    def measure(self, side: int, stations: Float64Array) -> Float64Array:
        """Return the offsets of all lines and of the end, (n, k)."""
        bed = self.design.find_bed(side, stations).offsets
        ditch = bed[:, -1:] + self.design.find_ditch(side, stations).offsets
        return np.hstack([bed, ditch[:, 1:], ditch[:, -1:] + self.far])


def make_rays(road: Axis, reach: Reach, stations: Float64Array, tolerance: float) -> Rays:
    """Return rays at stations, and at those where lines meet what belongs to other stations.

    Around the outer side of a bend without a curve rays are so near to each other that circles
    about it lie within the tolerance of chords.
    """
    return _RayMaker(road, reach, tolerance).make(stations)


class _RayMaker:
    def __init__(self, road: Axis, reach: Reach, tolerance: float) -> None:
        axis = road.alignment
        self._axis, self._reach, self._tolerance = axis, reach, tolerance
        self._is_closed = road.lap is not None
        self._hand = -1.0 if find_axes(axis.crs).are_mirrored else 1.0
        size = np.abs(axis.points_at([axis.start, axis.end])).max() + axis.length
        self._slack = _ROUNDINGS * float(np.spacing(size))
        self._kinks = self._find_kinks()

    def make(self, stations: Float64Array) -> Rays:
        rays = self._match(self._lay_first(self._separate_kinks(stations)))
        is_matched, rounds = True, 0
        for _ in range(_HALVINGS):
            added = self._find_between(rays)
            if is_matched and not len(added.sides):
                rounds += 1
                if rounds > _MOST_ROUNDS:
                    break
                # Rays to the ends of others show where lines end, and where folds meet.
                added = self._find_crossings(rays)
                added = added if len(added.sides) else self._find_corners(rays)
                if not len(added.sides):
                    break
            is_matched = not len(added.sides)
            rays = self._match(rays) if is_matched else rays.join(added)
        return self._mirror(rays if is_matched else self._match(rays))

    def _mirror(self, rays: Rays) -> Rays:
        """Return rays with those of the other side where that begins at the axis without a part.

        So the edge of the bed there, which is the axis, and the side slopes have the same vertices.
        """
        for side in (-1, 1):
            is_own = rays.sides == side
            lost = np.setdiff1d(rays.stations[~is_own], rays.stations[is_own])
            lost = lost[self._reach.design.find_bed(side, lost).offsets[:, -1] <= NEAR]
            if not len(lost):
                continue
            sides, turns = np.full(len(lost), side), np.zeros(len(lost))
            origins, ways = self._axis.points_at(lost), self._find_ways(sides, lost)
            limits = self._find_limits(origins, ways, self._find_caps(sides, lost))
            ends = origins + limits[:, None] * ways
            rays = rays.join(Rays(sides, lost, turns, origins, ways, limits, ends))
        return rays

    def _match(self, rays: Rays) -> Rays:
        """Return rays with those at crossings, and those of other stations to their ends."""
        matched = self._add_partners(rays.join(self._find_crossings(rays)))
        return self._close(matched) if self._is_closed else matched

    def _close(self, rays: Rays) -> Rays:
        """Return rays of which those at the last station are those at the first, where they are."""
        start, end = self._axis.start, self._axis.end
        first = rays.stations <= start
        again = rays.take(first)
        again = again._replace(stations=np.full(len(again.stations), end))
        return rays.take(rays.stations < end).join(again)

    def _find_between(self, rays: Rays) -> Rays:
        """Return the rays half-way between cut ones whose ends are chords of a curve."""
        is_cut = self._are_cut(rays)
        first, second = rays.pairs[is_cut[rays.pairs].all(axis=1)].T
        if not len(first):
            return rays.take(first)
        found = self._lay_between(rays, first, second, np.full(len(first), 0.5))
        chord = rays.ends[second] - rays.ends[first]
        length = np.hypot(*chord.T)
        away = found.ends - rays.ends[first]
        area = np.abs(chord[:, 0] * away[:, 1] - chord[:, 1] * away[:, 0])
        is_bent = (length > self._tolerance) & (area > length * self._tolerance)
        return found.take(is_bent)

    def _find_corners(self, rays: Rays) -> Rays:
        """Return the rays to places as near to two other stretches, at which folds meet."""
        is_cut = self._are_cut(rays)
        first, second = rays.pairs[is_cut[rays.pairs].all(axis=1)].T
        if not len(first):
            return rays.take(first)
        low_foot, high_foot = (self._find_feet(rays.take(own)) for own in (first, second))
        steps = [np.hypot(*(one[second] - one[first]).T) for one in (rays.origins, rays.ends)]
        jump = np.hypot(*(high_foot - low_foot).T)
        is_far = jump > 2.0 * (steps[0] + steps[1]) + self._tolerance
        first, second = first[is_far], second[is_far]
        low_foot, high_foot = low_foot[is_far], high_foot[is_far]
        low, high = np.zeros(len(first)), np.ones(len(first))
        for _ in range(_HALVINGS if len(first) else 0):
            middle = 0.5 * (low + high)
            foot = self._find_feet(self._lay_between(rays, first, second, middle))
            is_low = np.hypot(*(foot - low_foot).T) < np.hypot(*(foot - high_foot).T)
            low, high = np.where(is_low, middle, low), np.where(is_low, high, middle)
            low_foot = np.where(is_low[:, None], foot, low_foot)
            high_foot = np.where(is_low[:, None], high_foot, foot)
        is_corner = np.hypot(*(high_foot - low_foot).T) > self._tolerance
        first, second = first[is_corner], second[is_corner]
        if not len(first):
            return rays.take(first)
        found = self._lay_between(rays, first, second, low[is_corner])
        return self._leave_known(rays, found)

    def _find_feet(self, rays: Rays) -> Float64Array:
        """Return the places on the axis that are as near to the ends of rays, (n, 2)."""
        station = self._axis.stations_of(rays.ends + 10.0 * NEAR * rays.ways)["station"]
        feet = np.full((len(station), 2), np.nan)
        known = ~np.isnan(station)
        feet[known] = self._axis.points_at(station[known])
        return feet

    def _lay_between(
        self, rays: Rays, first: Int64Array, second: Int64Array, share: Float64Array
    ) -> Rays:
        """Return the rays between two of them each, at shares from the first."""
        station, turn = self._mix(rays, first, second, share)
        side = rays.sides[first]
        origins, ways, _ = self._place(side, station, turn, np.zeros(len(first), np.int64))
        limits = self._find_limits(origins, ways, self._find_caps(side, station))
        return Rays(side, station, turn, origins, ways, limits, origins + limits[:, None] * ways)

    def _are_cut(self, rays: Rays) -> BoolArray:
        """Whether rays end where another station is as near."""
        step = 10.0 * NEAR
        beyond = rays.ends + step * rays.ways
        return np.asarray((rays.limits > NEAR) & ~self._is_own(beyond, rays.limits + step))

    def _find_kinks(self) -> dict[float, tuple[float, float]]:
        """Return the direction before and the turn of each bend without a curve, by station."""
        kinks = {}
        elements = self._axis.elements
        begins = self._axis.tabulate()["station"]
        for before, after, station in zip(elements, elements[1:], begins[1:], strict=False):
            turn = (after.direction - before.end_direction + np.pi) % (2.0 * np.pi) - np.pi
            if abs(turn) > _KINK:
                kinks[float(station)] = (before.end_direction, float(turn))
        return kinks

    def _find_ways(self, side: Int64Array, stations: Float64Array) -> Float64Array:
        """Return unit vectors away from the axis."""
        tangents = self._axis.tangents_at(stations)
        right = np.column_stack([tangents[:, 1], -tangents[:, 0]])
        return np.asarray(right * (self._hand * side)[:, None])

    def _turn(self, station: float, side: int, angles: Float64Array) -> Float64Array:
        """Return unit vectors away from a bend, by angles from the direction before."""
        direction, turn = self._kinks[station]
        right = direction - 0.5 * np.pi * self._hand * side + np.sign(turn) * angles
        return np.column_stack([np.cos(right), np.sin(right)])

    def _is_outer(self, station: float, side: int) -> bool:
        return self._kinks[station][1] * side * self._hand > 0.0

    def _lay_first(self, stations: Float64Array) -> Rays:
        kinks = np.array(sorted(self._kinks))
        plain = stations[~np.isin(stations, kinks)]
        sides, at, turns, ways, inner = [], [], [], [], []
        for side in (-1, 1):
            own = np.full(len(plain), side)
            parts = [(plain, np.zeros(len(plain)), self._find_ways(own, plain), False)]
            for station in kinks[(kinks > stations[0]) & (kinks < stations[-1])].tolist():
                angles = self._list_angles(station, side)
                row = np.full(len(angles), station)
                outer = self._is_outer(station, side)
                parts.append((row, angles, self._turn(station, side, angles), not outer))
            for row, angles, way, is_inner in parts:
                sides.append(np.full(len(row), side))
                at.append(row)
                turns.append(angles)
                ways.append(way)
                inner.append(np.full(len(row), is_inner))
        side_of, station_of = np.concatenate(sides), np.concatenate(at)
        origins, way_of = self._axis.points_at(station_of), np.concatenate(ways)
        caps = self._find_caps(side_of, station_of)
        limits = self._find_limits(origins, way_of, np.where(np.concatenate(inner), 0.0, caps))
        ends = origins + limits[:, None] * way_of
        columns: Any = side_of, station_of, np.concatenate(turns), origins, way_of, limits, ends
        none = Rays(*(column[:0] for column in columns))
        return Rays(*columns).join(none)

    def _separate_kinks(self, stations: Float64Array) -> Float64Array:
        """Return stations with one between bends that follow each other: there rays have ends."""
        is_kink = np.isin(stations, list(self._kinks))
        first = np.flatnonzero(is_kink[:-1] & is_kink[1:])
        return np.union1d(stations, 0.5 * (stations[first] + stations[first + 1]))

    def _list_angles(self, station: float, side: int) -> Float64Array:
        """Return the angles of rays at a bend; on its inner side one, which has no length."""
        turn = abs(self._kinks[station][1])
        if not self._is_outer(station, side):
            return np.zeros(1)
        far = float(self._find_caps(np.array([side]), np.array([station]))[0])
        step = 2.0 * np.arccos(max(1.0 - self._tolerance / far, 0.5))
        return np.linspace(0.0, turn, int(np.ceil(turn / step)) + 1)

    def _find_caps(self, sides: Int64Array, stations: Float64Array) -> Float64Array:
        caps = np.empty(len(sides))
        for side in (-1, 1):
            own = sides == side
            caps[own] = self._reach.measure(side, stations[own])[:, -1]
        return caps

    def _is_own(self, places: Float64Array, distances: Float64Array) -> BoolArray:
        """Whether no other station is nearer to places than that at a distance."""
        return self._compare(places, distances)[0]

    def _compare(
        self, places: Float64Array, distances: Float64Array
    ) -> tuple[BoolArray, Float64Array]:
        """Return whether no other station is nearer than that at a distance, and the nearest."""
        table = self._axis.stations_of(places)
        is_own = np.abs(table["offset"]) >= distances - self._slack
        return np.asarray(is_own), table["station"]  # NaN, beyond the ends: nobody's

    def _find_limits(
        self, origins: Float64Array, ways: Float64Array, caps: Float64Array
    ) -> Float64Array:
        """Return the distances from which other stations are nearer, at most those of caps.

        A circle that touches the axis at an origin, and goes through the station that is nearest to
        a place beyond, has the next place as its centre (Ma, Bae and Choi 2012); what rounding
        leaves open is halved.
        """
        limits = caps.copy()
        is_own, station = self._compare(origins + caps[:, None] * ways, caps)
        at = np.flatnonzero(~is_own & (caps != 0.0))
        low, high = np.zeros(len(at)), caps[at]
        guess, slack = self._shrink(origins[at], ways[at], station[at], high)
        high = np.fmin(high, guess + slack)
        for _ in range(_MOST_STEPS):
            if not len(at):
                break
            probe = guess - slack
            probe = np.where((probe > low) & (probe < high), probe, 0.5 * (low + high))
            places = origins[at] + probe[:, None] * ways[at]
            is_own, station = self._compare(places, probe)
            low, high = np.where(is_own, probe, low), np.where(is_own, high, probe)
            guess, slack = self._shrink(origins[at], ways[at], station, probe)
            guess[is_own] = np.nan
            high = np.fmin(high, guess + slack)
            limits[at] = low
            goes_on = high - low > 0.25 * self._slack
            at, low, high = at[goes_on], low[goes_on], high[goes_on]
            guess, slack = guess[goes_on], slack[goes_on]
        return limits

    def _shrink(
        self, origins: Float64Array, ways: Float64Array, stations: Float64Array, at: Float64Array
    ) -> tuple[Float64Array, Float64Array]:
        """Return distances of places as near to stations, NaN if unknown, and their roundings."""
        guess, error = np.full(len(at), np.nan), np.full(len(at), np.nan)
        known = np.flatnonzero(~np.isnan(stations))
        chord = self._axis.points_at(stations[known]) - origins[known]
        square, ahead = (chord * chord).sum(axis=1), (chord * ways[known]).sum(axis=1)
        with np.errstate(divide="ignore", invalid="ignore"):
            found = np.where(ahead > 0.0, 0.5 * square / ahead, np.nan)
            error[known] = self._slack * (1.0 + 4.0 * at[known] ** 2 / square)
        guess[known] = found
        guess[error > 0.25 * at] = np.nan
        return guess, error

    def _find_crossings(self, rays: Rays) -> Rays:
        """Return the rays at which lines meet what is nearer to other stations."""
        first, second = rays.pairs.T
        offsets = self._measure_lines(rays)
        is_in = rays.limits[:, None] >= offsets - 0.5 * NEAR
        pair, line = np.nonzero((is_in[first] != is_in[second]) & np.isfinite(offsets[first]))
        a, b = first[pair], second[pair]
        low, high = np.zeros(len(pair)), np.ones(len(pair))  # shares from the ray that has it
        is_turned = ~is_in[a, line]
        a, b = np.where(is_turned, b, a), np.where(is_turned, a, b)
        for _ in range(_HALVINGS if len(pair) else 0):
            middle = 0.5 * (low + high)
            station, turn = self._mix(rays, a, b, middle)
            origin, way, offset = self._place(rays.sides[a], station, turn, line)
            inside = self._is_own(origin + offset[:, None] * way, offset)
            low, high = np.where(inside, middle, low), np.where(inside, high, middle)
        station, turn = self._mix(rays, a, b, low)
        origin, way, offset = self._place(rays.sides[a], station, turn, line)
        found = Rays(
            rays.sides[a], station, turn, origin, way, offset, origin + offset[:, None] * way
        )
        return self._leave_known(rays, found)

    def _measure_lines(self, rays: Rays) -> Float64Array:
        """Return the offsets of lines but the axis, (n, k), infinite where there is none."""
        rows = {side: self._reach.measure(side, rays.stations)[:, 1:] for side in (-1, 1)}
        width = max(row.shape[1] for row in rows.values())
        found = np.full((len(rays.sides), width), np.inf)
        for side, row in rows.items():
            own = rays.sides == side
            found[own, : row.shape[1]] = row[own]
        return found

    def _mix(
        self, rays: Rays, a: Int64Array, b: Int64Array, share: Float64Array
    ) -> tuple[Float64Array, Float64Array]:
        """Return stations and turns between two rays; turns only at one station."""
        same = rays.stations[a] == rays.stations[b]
        station = rays.stations[a] + share * (rays.stations[b] - rays.stations[a])
        turn = rays.turns[a] + share * (rays.turns[b] - rays.turns[a])
        at_start = (share == 0.0) & ~same
        turn = np.where(at_start, rays.turns[a], turn)
        return np.where(same, rays.stations[a], station), np.where(same | at_start, turn, 0.0)

    def _place(
        self, sides: Int64Array, stations: Float64Array, turns: Float64Array, line: Int64Array
    ) -> tuple[Float64Array, Float64Array, Float64Array]:
        """Return origins, ways and the offsets of lines of rays."""
        ways = self._find_ways(sides, stations)
        for k in np.flatnonzero(np.isin(stations, list(self._kinks))).tolist():
            station = float(stations[k])
            ways[k] = self._turn(station, int(sides[k]), turns[k : k + 1])[0]
        offsets = np.empty(len(sides))
        for side in (-1, 1):
            own = np.flatnonzero(sides == side)
            rows = self._reach.measure(side, stations[own])[:, 1:]
            offsets[own] = rows[np.arange(len(own)), line[own]]
        return self._axis.points_at(stations), ways, offsets

    def _add_partners(self, rays: Rays) -> Rays:
        """Return rays with those from other stations to the ends of those that are cut.

        Where there is one already it gets the same end, from which it is away by rounding.
        """
        masters, found = self._find_partners(rays)
        is_cut = self._are_cut(rays)
        is_fixed = self._are_fixed(rays)
        order = np.lexsort((found.stations, ~is_fixed[masters]))
        ties = _Ties(rays, is_cut, is_fixed, max(self._tolerance, 10.0 * NEAR))
        for k in order.tolist():
            ties.add(int(masters[k]), found, k)
        tied = rays._replace(ends=ties.ends, limits=ties.limits)
        return tied.join(found.take(np.array(ties.kept, np.int64)))

    def _are_fixed(self, rays: Rays) -> BoolArray:
        """Whether rays end at lines of the template."""
        away = np.abs(self._measure_lines(rays) - rays.limits[:, None])
        return np.asarray((away <= 0.5 * NEAR).any(axis=1))

    def _find_partners(self, rays: Rays) -> tuple[Int64Array, Rays]:
        """Return the rays that are cut and, of each, that from another station to its end."""
        cut = np.flatnonzero(self._are_cut(rays))
        beyond = rays.ends[cut] + 10.0 * NEAR * rays.ways[cut]
        if not len(cut):
            return cut, rays.take(cut)
        table = self._axis.stations_of(beyond)
        station, offset = table["station"], table["offset"]
        known = ~np.isnan(station)
        cut, station, offset = cut[known], station[known], offset[known]
        ends = rays.ends[cut]
        station = self._square(station, ends)
        if self._is_closed:
            at_end = station >= self._axis.end - self._axis.rounding
            station = np.where(at_end, self._axis.start, station)
        for kink in self._kinks:
            station[np.abs(station - kink) <= self._axis.rounding] = kink
        origins = self._axis.points_at(station)
        away = ends - origins
        limits = np.hypot(*away.T)
        sides = np.where(offset < 0.0, -1, 1)
        turns = np.zeros(len(sides))
        for k in np.flatnonzero(np.isin(station, list(self._kinks))).tolist():
            direction, turn = self._kinks[float(station[k])]
            start = direction - 0.5 * np.pi * self._hand * sides[k]
            angle = (np.arctan2(away[k, 1], away[k, 0]) - start) * np.sign(turn)
            turns[k] = (angle + np.pi) % (2.0 * np.pi) - np.pi
        found = Rays(sides, station, turns, origins, away / limits[:, None], limits, ends)
        fits = limits <= self._find_caps(sides, station) + NEAR
        fits &= (station >= rays.stations.min()) & (station <= rays.stations.max())
        return cut[fits], found.take(fits)

    def _square(self, stations: Float64Array, places: Float64Array) -> Float64Array:
        """Return the stations, near to others, that places are square to."""
        for _ in range(3):
            along = (places - self._axis.points_at(stations)) * self._axis.tangents_at(stations)
            moved = np.clip(stations + along.sum(axis=1), self._axis.start, self._axis.end)
            near = np.abs(moved - stations) <= 100.0 * NEAR
            for kink in self._kinks:  # a whole fan is square to it
                near &= np.abs(stations - kink) > self._axis.rounding
            stations = np.where(near, moved, stations)
        return stations

    def _leave_known(self, rays: Rays, found: Rays) -> Rays:
        """Leave out what is a ray already, or twice among them."""
        kept: list[int] = []
        every = rays.join(found.take(np.zeros(0, np.int64)))
        for k in np.lexsort((found.turns, found.stations, found.sides)).tolist():
            place = found.sides[k], found.stations[k], found.turns[k], found.limits[k]
            if kept and self._is_same(found, np.array([kept[-1]]), *place):
                continue
            near = np.flatnonzero(
                (every.sides == place[0]) & (np.abs(every.stations - place[1]) <= NEAR)
            )
            if not self._is_same(every, near, *place):
                kept.append(k)
        return found.take(np.array(kept, np.int64))

    @staticmethod
    def _is_same(
        rays: Rays, rows: Int64Array, side: int, station: float, turn: float, limit: float
    ) -> bool:
        near = (rays.sides[rows] == side) & (np.abs(rays.stations[rows] - station) <= 0.1 * NEAR)
        near &= np.abs(rays.turns[rows] - turn) * max(limit, 1.0) <= 0.1 * NEAR
        near &= rays.limits[rows] >= limit - 0.4 * NEAR
        return bool(near.any())


class _Ties:
    """Ends of rays, those of one place from both sides made the same.

    A ray of another station to the end of one is either there, but for rounding, or it is kept.
    Rays that end at lines keep their distance, at which the lines are sought.
    """

    def __init__(
        self, rays: Rays, is_cut: BoolArray, is_fixed: BoolArray, tolerance: float
    ) -> None:
        self.ends, self.limits = rays.ends.copy(), rays.limits.copy()
        self.kept: list[int] = []
        self._rays, self._is_fixed, self._tolerance = rays, is_fixed, tolerance
        self._cut = np.flatnonzero(is_cut)
        self._is_tied = np.zeros(len(rays.sides), bool)

    def add(self, master: int, found: Rays, k: int) -> None:
        """Tie a ray to the one that is found from another station to its end, or keep that."""
        if self._is_tied[master]:
            return
        own = self._find_nearest(master, self._rays, self._cut, found, k)
        if own is None:
            other = self._find_nearest(master, found, np.array(self.kept, np.int64), found, k)
            if other is None:
                self.kept.append(k)
            else:
                self._move(master, found.ends[other])
        elif self._is_tied[own]:
            self._move(master, self.ends[own])
        else:
            self._move(own, self.ends[master])
        self._is_tied[master] = True

    def _find_nearest(
        self, master: int, rays: Rays, rows: Int64Array, found: Rays, k: int
    ) -> int | None:
        """Return the ray from the same place whose end is nearest to the master's."""
        near = rows[np.abs(rays.stations[rows] - found.stations[k]) <= 10.0 * NEAR]
        near = near[rays.sides[near] == found.sides[k]]
        turned = np.abs(rays.turns[near] - found.turns[k]) * max(found.limits[k], 1.0)
        near = near[turned <= 10.0 * NEAR]
        ends = self.ends if rays is self._rays else rays.ends
        away = np.hypot(*(ends[near] - self.ends[master]).T)
        if not len(near) or away.min() > self._tolerance:
            return None
        return int(near[away.argmin()])

    def _move(self, ray: int, end: Float64Array) -> None:
        self.ends[ray] = end
        if not self._is_fixed[ray]:
            self.limits[ray] = np.hypot(*(end - self._rays.origins[ray]))
        self._is_tied[ray] = True
