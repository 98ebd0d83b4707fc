"""Channels: cross sections in the order of a centreline, with offsets that compare."""

from __future__ import annotations

from bisect import bisect_left
from itertools import pairwise
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ....base.errors import LinesError
from ....base.georeference import require_same_crs
from ....base.sentences import coordinate, counted, height, inflect
from ...earthwork.grading import measure_tolerance
from ...surface import as_features

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ....base.arrays import AnyArray, BoolArray, Float64Array
    from ....base.crs import CRS
    from .centrelines import Centreline
    from .surveyed import Surveyed

_SAME = 1e-9
"""Of a section's length: what is nearer along it is one place."""


class CrossSection(NamedTuple):
    """A section from left to right."""

    name: str
    points: Float64Array
    """(k, 3)."""
    along: Float64Array
    """(k,), lengths along the section."""
    station: float
    """Where it meets the centreline."""
    nodes: Float64Array
    """Lengths at the left end, at each of the lines along the channel, and at the right end."""

    @property
    def offsets(self) -> Float64Array:
        """Normalised offsets of its points: 0 at the left end, 1 at the first line, and so on."""
        piece = np.clip(
            np.searchsorted(self.nodes, self.along, side="right") - 1, 0, len(self.nodes) - 2
        )
        width = self.nodes[piece + 1] - self.nodes[piece]
        share = np.divide(
            self.along - self.nodes[piece], width, out=np.zeros(len(piece)), where=width > 0
        )
        return np.asarray(piece + share)

    def places_at(self, offsets: Float64Array) -> Float64Array:
        """Return places with elevations at normalised offsets, (k, 3): its points as they are."""
        own = self.offsets
        near = np.clip(np.searchsorted(own, offsets), 0, len(own) - 1)
        at = np.interp(offsets, np.arange(len(self.nodes)), self.nodes)
        found = np.column_stack([np.interp(at, self.along, one) for one in self.points.T])
        is_own = own[near] == offsets
        found[is_own] = self.points[near[is_own]]
        return found


class LongLine(NamedTuple):
    """A line along the channel, which every section crosses: a bank, or the thalweg."""

    name: str
    line: Any
    """Of shapely."""
    stations: Float64Array
    """(s,), lengths along it at which it meets the sections, in their order."""


class Channel(NamedTuple):
    """Sections in the order of their stations."""

    centreline: Centreline
    sections: list[CrossSection]
    lines: list[LongLine]
    """From left to right."""
    notes: tuple[str, ...]


def lay_out(
    surveyed: Surveyed, centreline: Centreline, lines_along: tuple[Any, Any], *, omit_returns: bool
) -> Channel:
    """Order sections along a centreline, from left to right, with banks and thalweg.

    Raises LinesError and CrsError as :func:`tinsmith.riverbed`.
    """
    import shapely

    flat = [shapely.linestrings(line[:, :2]) for line in surveyed.lines]
    _require_apart(flat, surveyed.names)
    met = [_meet(centreline, line, name) for line, name in zip(flat, surveyed.names, strict=True)]
    stations = np.array([station for station, _ in met])
    notes = [note for _, note in met if note]
    order = np.argsort(stations, kind="stable")
    if (np.diff(order) < 0).any() and (np.diff(order) > 0).any():
        notes.append("The sections were not in the order of the centreline, and were sorted by it.")
    turned, lines = [], []
    _, left = centreline.frames_at(stations)
    for number, line in enumerate(surveyed.lines):
        goes_left = float((line[-1, :2] - line[0, :2]) @ left[number]) > 0.0
        turned += [surveyed.names[number]] if goes_left else []
        line = line[::-1].copy() if goes_left else line
        is_kept = _find_longest_ascent(
            -measure_channel(centreline, line, float(stations[number]), surveyed.names[number])[
                :, 1
            ]
        )
        if not is_kept.all():
            notes.append(_omit(surveyed.names[number], line[~is_kept], omit_returns=omit_returns))
        lines.append(line[is_kept])
    if turned:
        notes.append(
            f"{_list(turned)}: given from right to left, looking along the centreline, and turned."
        )
    given, told = _read_long_lines(*lines_along, surveyed.crs)
    sections = [_measure(surveyed.names[k], lines[k], float(stations[k])) for k in order]
    sections, long = _place(sections, given)
    _require_ascending(sections, long)
    notes += _describe_flow(sections)
    return Channel(centreline, sections, long, (*notes, *told))


def measure_channel(
    centreline: Centreline, points: Float64Array, station: float, name: str
) -> Float64Array:
    """Return the stations and offsets of places of a section, (k, 2).

    Raises LinesError where the centreline turns too sharply for that.
    """
    away = np.hypot(*(points[:, :2] - centreline.places_at(np.array([station]))).T)
    found = centreline.measure(points[:, :2], station, 2.0 * float(away.max()))
    if found is None:
        x, y = points[int(away.argmax()), :2].tolist()
        raise LinesError(
            f"{name} reaches to {coordinate(x)} {coordinate(y)}, farther from the centreline than "
            "this turns sharply there: another centreline, or a shorter section, is needed."
        )
    return found


def _find_longest_ascent(values: Float64Array) -> BoolArray:
    """Mark the longest subsequence that ascends strictly (patience sorting)."""
    tops: list[int] = []
    lows: list[float] = []
    before = np.full(len(values), -1)
    for k, value in enumerate(values.tolist()):
        at = bisect_left(lows, value)
        before[k] = tops[at - 1] if at else -1
        tops[at : at + 1], lows[at : at + 1] = [k], [value]
    is_kept = np.zeros(len(values), np.bool_)
    k = tops[-1]
    while k >= 0:
        is_kept[k] = True
        k = int(before[k])
    return is_kept


def _omit(name: str, lost: Float64Array, *, omit_returns: bool) -> str:
    """Tell which points of a section are left out, or refuse it."""
    x, y = lost[0, :2].tolist()
    where = f"{name} goes back across the channel at {coordinate(x)} {coordinate(y)}"
    points = counted(len(lost), "point")
    if not omit_returns:
        raise LinesError(
            f"{where}, where lines along it would cross one another: without {points} it would "
            "not; give `omit_returns` to leave them out."
        )
    return inflect(f"{where}, and {points} [was|were] left out.", len(lost))


def _list(names: Sequence[str]) -> str:
    shown = ", ".join(names[:5])
    return shown if len(names) <= 5 else f"{shown} and {len(names) - 5:,} more"


def _require_apart(flat: Sequence[Any], names: Sequence[str]) -> None:
    """Refuse sections that cross or touch one another."""
    import shapely

    first, second = shapely.STRtree(flat).query(flat, predicate="intersects")
    pairs = np.flatnonzero(first < second)
    if len(pairs):
        one, other = int(first[pairs[0]]), int(second[pairs[0]])
        x, y = shapely.get_coordinates(shapely.intersection(flat[one], flat[other]))[0].tolist()
        raise LinesError(
            f"{names[one]} and {names[other][:1].lower()}{names[other][1:]} meet at "
            f"{coordinate(x)} {coordinate(y)}: cross sections must not cross or touch one another.",
            lines=[one, other],
        )


def _meet(centreline: Centreline, line: Any, name: str) -> tuple[float, str]:
    """Return the station at which a section crosses a centreline, and what is told of it.

    Beyond its ends the centreline is prolonged, by no more than the section is long.
    """
    import shapely

    found = shapely.intersection(line, centreline.line)
    places = shapely.get_coordinates(found)
    if len(places) > 1:
        where = ", ".join(f"{coordinate(x)} {coordinate(y)}" for x, y in places[:3].tolist())
        raise LinesError(f"{name} meets the centreline more than once, at {where}: once is needed.")
    if len(places) == 1:
        return float(centreline.line.project(shapely.points(places[0]))), ""
    reach = float(line.length)
    beyond = []
    for station in (-reach, centreline.length + reach):
        end = np.clip(station, 0.0, centreline.length)
        ends = centreline.places_at(np.array([end, station]))
        across = shapely.get_coordinates(shapely.intersection(line, shapely.linestrings(ends)))
        if len(across) == 1:
            apart = float(np.hypot(*(across[0] - ends[0])))
            beyond.append((float(end + np.copysign(apart, station)), apart))
    if len(beyond) != 1:
        x, y = shapely.get_coordinates(line)[0].tolist()
        raise LinesError(
            f"{name}, from {coordinate(x)} {coordinate(y)}, does not cross the centreline, nor "
            "that prolonged by the length of the section."
        )
    station, apart = beyond[0]
    which = "start" if station < 0.0 else "end"
    return station, (
        f"{name} lies beyond the {which} of the centreline, which was prolonged by {apart:.4g}."
    )


def _measure(name: str, points: Float64Array, station: float) -> CrossSection:
    along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(points[:, :2], axis=0).T))])
    return CrossSection(name, points, along, station, along[[0, -1]])


def _require_ascending(sections: Sequence[CrossSection], lines: Sequence[LongLine]) -> None:
    """Refuse sections at one station, and lines that meet sections in another order."""
    for one, other in pairwise(sections):
        if not one.station < other.station:
            raise LinesError(
                f"{one.name} and {other.name[:1].lower()}{other.name[1:]} meet the centreline at "
                f"one station, {coordinate(one.station)}."
            )
    for line in lines:
        back = np.flatnonzero(np.diff(line.stations) <= 0.0)
        if len(back):
            raise LinesError(
                f"The {line.name} meets {_lower(sections[back[0] + 1].name)} before "
                f"{_lower(sections[back[0]].name)}, and the centreline the other way round."
            )


def _lower(name: str) -> str:
    return name[:1].lower() + name[1:]


def _describe_flow(sections: Sequence[CrossSection]) -> list[str]:
    """Tell if the lowest points rise along the centreline."""
    first, last = (float(one.points[:, 2].min()) for one in (sections[0], sections[-1]))
    if last <= first:
        return []
    return [
        f"The lowest points of the first and the last section rise from {height(first)} to "
        f"{height(last)} along the centreline: it seems to run upstream. Left and right are as one "
        "looks along it; the bed does not depend on it."
    ]


# ---------------------------------------------------------------- banks and thalweg


def _read_long_lines(
    banks: Any, thalweg: Any, crs: CRS | None
) -> tuple[list[tuple[str, Any]], tuple[str, ...]]:
    """Return lines along the channel with their names, and what was assumed of them."""
    import shapely

    found: list[tuple[str, Any]] = []
    notes: tuple[str, ...] = ()
    for given, what, count in ((banks, "bank", 2), (thalweg, "thalweg", 1)):
        if given is None:
            continue
        features = as_features(given, what)
        is_plain = not hasattr(given, "crs")
        notes += require_same_crs(features.crs, crs, f"the {what}", is_plain=is_plain)
        if features.kind != "lines" or len(features) != count:
            kinds = counted(len(features), features.kind[:-1])
            needed = (
                "two lines are needed, the left and the right one" if count == 2 else "one line is"
            )
            raise LinesError(f"The {what} has {kinds}: {needed}.")
        lines = np.split(features.coordinates[:, :2], features.offsets[0][1:-1])
        for number, line in enumerate(lines, 1):
            name = f"{what} {number}" if count == 2 else what
            found.append((name, shapely.linestrings(line)))
    return found, notes


def _place(
    sections: Sequence[CrossSection], given: Sequence[tuple[str, Any]]
) -> tuple[list[CrossSection], list[LongLine]]:
    """Put lines along the channel into the sections, in their order across."""
    if not given:
        return list(sections), []
    found = [[_cross(one, line, name) for name, line in given] for one in sections]
    across = np.array([[one[0] for one in row] for row in found])
    along = np.array([[one[1] for one in row] for row in found])
    order: AnyArray = np.argsort(across.mean(axis=0), kind="stable")
    if len(given) == 3 and order[1] != 2:
        raise LinesError("The thalweg does not run between the banks.")
    placed = []
    for one, own in zip(sections, across[:, order], strict=True):
        if (np.diff(own) <= 0.0).any():
            k = int(np.flatnonzero(np.diff(own) <= 0.0)[0])
            names = [given[j][0] for j in order[k : k + 2]]
            raise LinesError(
                f"At {_lower(one.name)} the {names[1]} is left of the {names[0]}, and right of it "
                "at others: lines along the channel must not cross."
            )
        placed.append(one._replace(nodes=np.concatenate([[0.0], own, one.along[-1:]])))
    names = _name_lines(given, order)
    lines = [LongLine(names[k], given[j][1], along[:, j]) for k, j in enumerate(order)]
    if (np.diff(along[[0, -1]], axis=0) < 0.0).any():
        lines = [_turn(one) if one.stations[0] > one.stations[-1] else one for one in lines]
    return placed, lines


def _name_lines(given: Sequence[tuple[str, Any]], order: AnyArray) -> list[str]:
    """Return "left bank", "thalweg" and "right bank" for lines in their order across."""
    found = [given[j][0] for j in order]
    sides = iter(("left bank", "right bank"))
    return [one if one == "thalweg" else next(sides) for one in found]


def _turn(line: LongLine) -> LongLine:
    import shapely

    return LongLine(line.name, shapely.reverse(line.line), line.line.length - line.stations)


def _cross(section: CrossSection, line: Any, name: str) -> tuple[float, float]:
    """Return the lengths along a section and along a line at which they meet.

    A line that ends at the end of a section but for rounding meets it there.
    """
    import shapely

    own = shapely.linestrings(section.points[:, :2])
    near = _SAME * float(own.length) + measure_tolerance(section.points)
    places = shapely.get_coordinates(shapely.intersection(own, line))
    if not len(places):
        ends = shapely.points(section.points[[0, -1], :2])
        places = section.points[[0, -1], :2][shapely.distance(ends, line) <= near]
    if len(places) > 1 and np.ptp(places, axis=0).max() <= near:
        places = places[:1]
    if len(places) != 1:
        how = "does not meet" if not len(places) else "meets more than once"
        raise LinesError(f"The {name} {how} {_lower(section.name)}: once is needed.")
    place = shapely.points(places[0])
    across = float(own.project(place))
    apart = np.abs(section.along - across)
    if apart.min() <= near:
        across = float(section.along[apart.argmin()])
    return across, float(line.project(place))
