"""Centrelines of rivers: places, stations and directions along one polyline."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ....base.errors import LinesError
from ....base.georeference import find_axes
from ....base.sentences import coordinate, counted
from ..axes import as_axis

if TYPE_CHECKING:
    from ....base.arrays import Float64Array, Int64Array
    from ....base.crs import CRS

_HALVINGS = 64
_NEAR = 1e-9
"""Of a section's length: how far a place may be ahead of its station."""


class Centreline(NamedTuple):
    """A polyline that does not cross itself, in the direction of its stations."""

    points: Float64Array
    """(n, 2)."""
    stations: Float64Array
    """(n,), from 0, lengths along it in CRS units."""
    left: float
    """1.0 where the left is counter-clockwise of the way, -1.0 in a CRS with mirrored axes."""
    notes: tuple[str, ...] = ()

    @property
    def length(self) -> float:
        """Station of its last vertex."""
        return float(self.stations[-1])

    @property
    def line(self) -> Any:
        """It as a line of shapely."""
        import shapely

        return shapely.linestrings(self.points)

    @property
    def directions(self) -> Float64Array:
        """Unit vectors along its segments, (n - 1, 2)."""
        steps = np.diff(self.points, axis=0)
        return steps / np.hypot(steps[:, 0], steps[:, 1])[:, None]

    def reverse(self) -> Centreline:
        """Return it in the other direction."""
        stations = self.length - self.stations[::-1]
        return self._replace(points=self.points[::-1].copy(), stations=stations)

    def find_segments(self, stations: Float64Array) -> Int64Array:
        """Return the segments that hold stations, the first or last one beyond the ends."""
        found = np.searchsorted(self.stations, stations, side="right") - 1
        return np.clip(found, 0, len(self.points) - 2)

    def places_at(self, stations: Float64Array) -> Float64Array:
        """Return places, (k, 2); beyond the ends on the segments prolonged."""
        segment = self.find_segments(stations)
        begin, end = self.stations[segment], self.stations[segment + 1]
        share = ((stations - begin) / (end - begin))[:, None]
        start, stop = self.points[segment], self.points[segment + 1]
        return np.where(share == 1.0, stop, start + share * (stop - start))

    def frames_at(self, stations: Float64Array) -> tuple[Float64Array, Float64Array]:
        """Return unit vectors along and to the left, (k, 2) each, that turn evenly.

        At a vertex the direction is the mean of both segments', and between two vertices its angle
        changes in proportion to the station: so frames of a polyline have no steps.
        """
        angles = np.unwrap(np.arctan2(self.directions[:, 1], self.directions[:, 0]))
        means = np.concatenate([angles[:1], 0.5 * (angles[1:] + angles[:-1]), angles[-1:]])
        angle = np.interp(stations, self.stations, means)
        along = np.column_stack([np.cos(angle), np.sin(angle)])
        return along, self.left * np.column_stack([-along[:, 1], along[:, 0]])

    def measure(self, xy: Float64Array, station: float, reach: float) -> Float64Array | None:
        """Return stations and offsets to the left of places, (k, 2), within reach of a station.

        A place lies on the normal at its station, in frames that turn evenly. None if some lie on
        several, where the line turns more sharply than they are away.
        """
        low, high = (np.full(len(xy), station + way * reach) for way in (-1.0, 1.0))
        for _ in range(_HALVINGS):
            middle = 0.5 * (low + high)
            is_ahead = self._measure_ahead(xy, middle) > 0.0
            low, high = np.where(is_ahead, middle, low), np.where(is_ahead, high, middle)
        stations = 0.5 * (low + high)
        if np.abs(self._measure_ahead(xy, stations)).max() > _NEAR * reach:
            return None
        _, left = self.frames_at(stations)
        return np.column_stack([stations, ((xy - self.places_at(stations)) * left).sum(axis=1)])

    def _measure_ahead(self, xy: Float64Array, stations: Float64Array) -> Float64Array:
        """Return how far places lie ahead of stations, along the line there."""
        along, _ = self.frames_at(stations)
        return np.asarray(((xy - self.places_at(stations)) * along).sum(axis=1))

    def place(self, stations: Float64Array, offsets: Float64Array) -> Float64Array:
        """Return places, (k, 2), at stations and offsets to the left."""
        _, left = self.frames_at(stations)
        return self.places_at(stations) + offsets[:, None] * left


def read_centreline(given: Any, crs: CRS | None) -> Centreline:
    """Return a line, or the chords of an alignment, in the CRS of what it runs through.

    Raises LinesError, CrsError.
    """
    axis = as_axis(given, crs, 0.0, "centreline")
    segments = axis.segments
    count = int(segments.lines[-1]) + 1
    if count != 1:
        raise LinesError(f"There are {counted(count, 'centreline')}: one is needed.")
    points = np.vstack([segments.starts, segments.ends[-1:]])
    return make_centreline(points, crs, axis.notes)


def make_centreline(points: Float64Array, crs: CRS | None, notes: tuple[str, ...]) -> Centreline:
    """Return a polyline of vertices that are apart as a centreline.

    Raises LinesError if it crosses itself.
    """
    import shapely

    lengths = np.hypot(*np.diff(points, axis=0).T)
    left = -1.0 if find_axes(crs).are_mirrored else 1.0
    made = Centreline(points, np.concatenate([[0.0], np.cumsum(lengths)]), left, notes)
    if not shapely.is_simple(made.line):
        x, y = _find_crossing(made)
        raise LinesError(f"The centreline crosses itself at {coordinate(x)} {coordinate(y)}.")
    return made


def _find_crossing(made: Centreline) -> tuple[float, float]:
    """Return a place where a line crosses or touches itself, or turns back."""
    import shapely

    segments = shapely.linestrings(np.stack([made.points[:-1], made.points[1:]], axis=1))
    tree = shapely.STRtree(segments)
    first, second = tree.query(segments, predicate="intersects")
    apart = np.flatnonzero(second > first + 1)
    back = np.flatnonzero((made.directions[1:] == -made.directions[:-1]).all(axis=1))
    if len(apart):
        found = shapely.intersection(segments[first[apart[0]]], segments[second[apart[0]]])
        x, y = shapely.get_coordinates(found)[0].tolist()
        return x, y
    x, y = made.points[int(back[0]) + 1 if len(back) else 0].tolist()
    return x, y
