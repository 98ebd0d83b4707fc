"""Stations: the axis of a plan, its stations, and the ground along a part of it."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...base import optional
from ...base.checks import as_floats, as_length
from ...base.errors import LinesError, OptionError
from ...base.georeference import find_axes
from ..sections import Axis, as_axis
from ..surface import as_features
from .footprint import Footprint

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ...base.arrays import Float64Array
    from ...tin import TIN
    from .windows import Window

_MOST = 10_000
_DECIMALS = 3
_BAND = 0.3
"""Of the height of a frame: how far to either side of the axis no ground may be missing."""


class Stationed(NamedTuple):
    """The axis of a plan, in coordinates of a drawing."""

    line: Float64Array
    """(k, 2), the part that is shown."""
    places: Float64Array
    """(n, 2), where stations are marked."""
    directions: Float64Array
    """(n, 2), of the axis there, unit vectors."""
    texts: tuple[str, ...]
    """What is written at each."""
    ends: tuple[str, str]
    """What is written at the ends of the part."""
    is_part: bool
    """Whether a range of stations was asked for."""
    notes: tuple[str, ...]


def as_stationed(given: Any, tin: TIN, interval: Any, reach: Any) -> Stationed | None:
    """Return the axis of a plan with a mark at every multiple of an interval, and at both ends.

    Raises OptionError if there is no axis, or an interval or a range does not fit it; LinesError if
    it is not one line; CrsError if it has another CRS.
    """
    if given is None:
        for name, value in (("station_interval", interval), ("station_range", reach)):
            if value is not None:
                raise OptionError(name, value, "None where there is no axis")
        return None
    if not hasattr(given, "elements"):
        features = as_features(given, "axis")
        if features.kind != "lines" or len(features.offsets[0]) != 2:
            raise LinesError(
                f"The axis of a plan is one line, and there are {len(features)} {features.kind}."
            )
    axis = as_axis(given, tin.crs, 0.0, "axis")
    begin, end = _as_range(reach, axis)
    marked = _list_stations(interval, begin, end)
    places, directions = axis.measure(np.zeros(len(marked), np.int64), marked)
    breaks = axis.find_breaks(0)
    inner = breaks[(breaks > begin) & (breaks < end)]
    stations = np.concatenate([[begin], inner, [end]])
    line, _ = axis.measure(np.zeros(len(stations), np.int64), stations)
    turn = find_axes(tin.crs).turn
    texts = _write(axis, marked)
    first, last = _write(axis, np.array([begin, end]))
    shown = texts if interval is not None else ()
    is_part = reach is not None
    return Stationed(
        turn(line), turn(places), turn(directions), shown, (first, last), is_part, axis.notes
    )


def _as_range(reach: Any, axis: Axis) -> tuple[float, float]:
    first, last = (float(one) for one in axis.ends[0])
    if reach is None:
        return first, last
    found = as_floats(reach)
    slack = axis.rounding
    if found is None or found.shape != (2,) or not found[0] < found[1]:
        raise OptionError("station_range", reach, "two stations, the smaller one first")
    begin, end = found.tolist()
    if not (first - slack <= begin and end <= last + slack):
        allowed = f"two stations of the axis, which reaches from {first:.12g} to {last:.12g}"
        raise OptionError("station_range", reach, allowed)
    return max(begin, first), min(end, last)


def _list_stations(interval: Any, begin: float, end: float) -> Float64Array:
    if interval is None:
        return np.array([begin, end])
    step = as_length("station_interval", interval)
    if not (end - begin) / step <= _MOST:
        allowed = f"so large that there are at most {_MOST:,} stations"
        raise OptionError("station_interval", interval, allowed)
    inner = step * np.arange(math.ceil(begin / step), math.floor(end / step) + 1)
    return np.unique(np.concatenate([[begin], inner[(inner > begin) & (inner < end)], [end]]))


def _write(axis: Axis, stations: Float64Array) -> tuple[str, ...]:
    """Return what is written at stations, with the decimals that each needs."""
    written = axis.write_stations(stations).get("written_station", stations)
    texts = [f"{round(one, _DECIMALS) + 0.0:.{_DECIMALS}f}" for one in written.tolist()]
    return tuple(text.rstrip("0").rstrip(".") for text in texts)


def cut_band(footprint: Footprint, axis: Stationed, height: float) -> Footprint:
    """Return what a footprint has along an axis, in the middle of strips of a height, CRS units.

    Raises LinesError if that is nothing.
    """
    shapely = optional.load("shapely")
    band = shapely.buffer(
        shapely.LineString(axis.line), _BAND * height, cap_style="flat", join_style="round"
    )
    shapes, owners = shapely.get_parts(
        shapely.intersection(footprint.faces, band), return_index=True
    )
    is_ground = shapely.area(shapes) > 0.0
    if not is_ground.any():
        first, last = axis.ends
        raise LinesError(f"There is no surface along the axis from station {first} to {last}.")
    return Footprint(shapes[is_ground], footprint.is_water[owners[is_ground]])


def require_shown(axis: Stationed | None, windows: Sequence[Window]) -> None:
    """Refuse an axis that runs through no window: its coordinates are elsewhere."""
    shapely = optional.load("shapely")
    if axis is None:
        return
    frames = shapely.polygons([window.corners for window in windows])
    if not shapely.intersects(frames, shapely.LineString(axis.line)).any():
        raise LinesError("The axis runs through none of the sheets: it lies beside the surface.")
