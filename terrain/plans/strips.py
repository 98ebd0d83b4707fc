"""Strips: a long surface cut into rectangles that follow its axis."""

from __future__ import annotations

import heapq
import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...base import optional
from ...tin import Bounds
from .footprint import cut_into_pieces
from .windows import turn

if TYPE_CHECKING:
    from ...base.arrays import Float64Array
    from .footprint import Footprint, Pieces

_CELLS_ACROSS = 20
"""Cells of the footprint in the height of a strip."""
_BAND = 6
"""Cells along the axis of which one place of it is the middle."""
_SHORTEST = 0.05
"""Of a strip, as a share of its full length: where an axis turns faster, no strip can follow."""
_SHORTER = 0.97
_AROUND = [(i, j) for i in (-1, 0, 1) for j in (-1, 0, 1) if (i, j) != (0, 0)]


class Joint(NamedTuple):
    """Where one strip ends and the next begins."""

    place: Float64Array
    """(2,), on the axis."""
    angle: float
    """Direction of the axis there, radians."""


class Strip(NamedTuple):
    """A rectangle of ground."""

    center: tuple[float, float]
    angle: float
    """Of its longer side, in the direction of the axis, degrees counter-clockwise from east."""
    end: Joint
    """To the next strip."""


def cut_strips(
    footprint: Footprint,
    step: float,
    room: tuple[float, float],
    axis: Float64Array | None,
) -> list[Strip] | None:
    """Cover a footprint with rectangles along an axis, (k, 2), by default its own.

    ``step`` is that of the axis from one strip to the next at most, CRS units; ``room`` the width,
    along the axis, and the height of a rectangle. None if somewhere the footprint is too wide for
    the rectangles, or turns too fast.

    The footprint is cut into small cells, every piece goes to the strip that has the station of its
    middle on the axis, and a strip is as long as all of its pieces, whole, lie in the rectangle. So
    no place of the surface is left out, whatever the axis is.
    """
    shapely = optional.load("shapely")
    if _measure_widest(footprint) > math.hypot(*room):
        return None
    pieces = cut_into_pieces(footprint.faces, room[1] / _CELLS_ACROSS)
    line = find_axis(footprint, pieces, room[1]) if axis is None else axis
    return _Walk(pieces, shapely.LineString(line), step, room).cut()


def _measure_widest(footprint: Footprint) -> float:
    """Return the diameter of the largest circle in a footprint, or a little less."""
    shapely = optional.load("shapely")
    largest = footprint.faces[int(np.argmax(shapely.area(footprint.faces)))]
    tolerance = 0.01 * math.sqrt(float(shapely.area(largest)))
    return 2 * float(shapely.length(shapely.maximum_inscribed_circle(largest, tolerance)))


class _Walk:
    """The way along an axis, rectangle after rectangle."""

    def __init__(self, pieces: Pieces, axis: Any, step: float, room: tuple[float, float]) -> None:
        shapely = optional.load("shapely")
        self._axis = axis
        self._step = step
        self._room = room
        stations = shapely.line_locate_point(axis, shapely.points(pieces.centers))
        of_corners = stations[pieces.owners]
        order = np.argsort(of_corners, kind="stable")
        self._stations, self._corners = of_corners[order], pieces.corners[order]

    def cut(self) -> list[Strip] | None:
        strips: list[Strip] = []
        here, end = float(self._stations[0]), float(self._stations[-1])
        while True:
            found = self._find_longest(here, end)
            if found is None:
                return None
            strip, here = found
            strips.append(strip)
            if here >= end:
                return strips

    def _find_longest(self, here: float, end: float) -> tuple[Strip, float] | None:
        """Return the longest strip from a station on that holds all of its pieces."""
        length = self._step
        if end - here <= length:
            length = max(end - here, _SHORTEST * length)
        while length >= _SHORTEST * self._step:
            strip = self._try(here, min(here + length, end), is_last=here + length >= end)
            if strip is not None:
                return strip, min(here + length, end)
            length *= _SHORTER
        return None

    def _try(self, begin: float, end: float, *, is_last: bool) -> Strip | None:
        first = np.searchsorted(self._stations, begin, "left")
        last = np.searchsorted(self._stations, end, "right" if is_last else "left")
        angle = self._measure_angle(begin, end)
        places = np.concatenate([self._corners[first:last], self._list_axis(begin, end)])
        box = Bounds.of(turn(places, -angle))
        if box.width > self._room[0] or box.height > self._room[1]:
            return None
        center = turn(np.array([self._center(box, begin, end, angle), box.center[1]]), angle)
        joint = Joint(self._at(end)[0], math.radians(self._measure_angle_at(end)))
        return Strip((float(center[0]), float(center[1])), angle, joint)

    def _center(self, box: Bounds, begin: float, end: float, angle: float) -> float:
        """Return the middle between both stations, as far as all pieces are in the rectangle."""
        middle = float(turn(self._at(begin, end), -angle)[:, 0].mean())
        half = self._room[0] / 2
        return min(max(middle, box.xmax - half), box.xmin + half)

    def _measure_angle(self, begin: float, end: float) -> float:
        """Return the direction from one station to another, degrees."""
        east, north = np.subtract(*self._at(end, begin))
        if east == 0 and north == 0:
            return self._measure_angle_at(begin)
        return math.degrees(math.atan2(north, east))

    def _measure_angle_at(self, station: float) -> float:
        around = 0.25 * self._room[1]
        length = self._axis.length
        low, high = max(station - around, 0.0), min(station + around, length)
        east, north = np.subtract(*self._at(high, low))
        return math.degrees(math.atan2(north, east))

    def _at(self, *stations: float) -> Float64Array:
        shapely = optional.load("shapely")
        found = shapely.line_interpolate_point(self._axis, list(stations))
        places: Float64Array = shapely.get_coordinates(found)
        return places

    def _list_axis(self, begin: float, end: float) -> Float64Array:
        return self._at(*np.linspace(begin, end, 5).tolist())


# ---------------------------------------------------------------- the axis of a surface


def find_axis(footprint: Footprint, pieces: Pieces, height: float) -> Float64Array:
    """Return a line along a footprint, (k, 2), from west to east.

    If all fits a straight strip of a height in CRS units it is the middle line of the smallest
    rectangle around the footprint. Else it runs through the middles of bands at equal distances,
    along the surface, from the one of its places that is farthest from the others.
    """
    straight, is_enough = _find_straight_axis(footprint, height)
    if is_enough:
        return straight
    curved = _find_curved_axis(pieces, height / _CELLS_ACROSS)
    return straight if curved is None else curved


def _find_straight_axis(footprint: Footprint, height: float) -> tuple[Float64Array, bool]:
    shapely = optional.load("shapely")
    around = shapely.oriented_envelope(shapely.MultiPoint(shapely.get_coordinates(footprint.faces)))
    corners = shapely.get_coordinates(around)[:4]
    sides = np.hypot(*np.diff(corners[:3], axis=0).T)
    first = 0 if sides[0] <= sides[1] else 1
    ends = np.array(
        [
            (corners[first] + corners[first + 1]) / 2,
            (corners[first + 2] + corners[(first + 3) % 4]) / 2,
        ]
    )
    return _turn_east(ends), bool(sides.min() <= height)


def _turn_east(axis: Float64Array) -> Float64Array:
    is_westward = tuple(axis[-1]) < tuple(axis[0])
    return axis[::-1].copy() if is_westward else axis


def _find_curved_axis(pieces: Pieces, side: float) -> Float64Array | None:
    """Return the middles of bands at equal distances from one end; None for separate parts."""
    distances = _measure_distances(pieces, 0)
    if not np.isfinite(distances).all():
        return None
    start = int(np.argmax(distances))
    distances = _measure_distances(pieces, start)
    band = np.floor(distances / (_BAND * side)).astype(np.int64)
    counts = np.bincount(band)
    sums = np.column_stack([np.bincount(band, pieces.centers[:, axis]) for axis in (0, 1)])
    middles = sums[counts > 0] / counts[counts > 0, None]
    if len(middles) < 2:
        return None
    inner = (middles[:-2] + 2 * middles[1:-1] + middles[2:]) / 4
    end = pieces.centers[int(np.argmax(distances))]
    line = np.concatenate([pieces.centers[[start]], middles[:1], inner, middles[-1:], [end]])
    return _turn_east(line)


def _measure_distances(pieces: Pieces, start: int) -> Float64Array:
    """Return the distances of pieces from one along the surface (Dijkstra 1959).

    Pieces in one cell or in cells side by side are neighbours.
    """
    at: dict[tuple[int, ...], list[int]] = {}
    for number, cell in enumerate(map(tuple, pieces.cells.tolist())):
        at.setdefault(cell, []).append(number)
    centers, cells = pieces.centers.tolist(), pieces.cells.tolist()
    distances = np.full(len(centers), np.inf)
    distances[start] = 0.0
    todo = [(0.0, start)]
    while todo:
        distance, here = heapq.heappop(todo)
        if distance > distances[here]:
            continue
        column, row = cells[here]
        for i, j in [(0, 0), *_AROUND]:
            for other in at.get((column + i, row + j), ()):
                further = distance + math.dist(centers[here], centers[other])
                if further < distances[other]:
                    distances[other] = further
                    heapq.heappush(todo, (further, other))
    return distances
