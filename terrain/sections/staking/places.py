"""Points to set out: given ones with their numbers, or places along an alignment."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ....base.errors import OptionError, PointsError
from ....base.georeference import require_same_crs
from ....base.results import Features
from ....base.sentences import counted, inflect
from ....tin import Survey
from ....tin.building import find_crs
from ..alignments import as_numbers, as_places

if TYPE_CHECKING:
    from ....base.arrays import Float64Array, ObjectArray
    from ....base.crs import CRS
    from ..alignments import Alignment

_NUMBERS = ("number", "point", "name", "id")
_DESCRIPTIONS = ("description", "code")
_MOST = 10_000_000


class Stakes(NamedTuple):
    """Points to set out, n of them."""

    xy: Float64Array
    """(n, 2), CRS units."""
    numbers: ObjectArray
    """Texts."""
    descriptions: ObjectArray
    """Texts, empty where there is none."""
    along: dict[str, Float64Array]
    """Stations and offsets, where there is an alignment."""
    notes: tuple[str, ...]


def take_points(points: Any, alignment: Alignment | None, crs: CRS | None) -> Stakes:
    """Return points that are given, with the stations of an alignment."""
    columns: Any = {}
    is_named = isinstance(points, Survey | Features)
    theirs = points.crs if is_named else find_crs(points)
    notes = require_same_crs(theirs, crs, "the points", is_plain=not is_named)
    if isinstance(points, Survey):
        columns, points = points.attributes, points.points
    elif isinstance(points, Features):
        if points.kind != "points":
            raise OptionError("points", points, "points, not lines or polygons")
        columns, points = points.columns, points.coordinates
    xy = as_places(points) + 0.0
    if len(xy) == 0:
        raise PointsError("There is no point to set out: at least one is needed.")
    numbers = _find_texts(columns, _NUMBERS, [str(one + 1) for one in range(len(xy))])
    descriptions = _find_texts(columns, _DESCRIPTIONS, [""] * len(xy))
    along: dict[str, Float64Array] = {}
    if alignment is not None:
        found = alignment.stations_of(xy)
        names = ("station", "written_station", "offset")
        along = {name: found[name] for name in names if name in found.columns}
        notes = (*notes, *alignment.notes)
    return Stakes(xy, numbers, descriptions, along, (*notes, *_describe_repeated(numbers)))


def place_along(
    alignment: Alignment, stations: Any, interval: float | None, offsets: Any
) -> Stakes:
    """Return points at stations, or at multiples of an interval, and at each of the offsets."""
    if interval is None:
        at = as_numbers("stations", stations)
    else:
        at = alignment.tabulate_points(interval)["station"]
    aside = as_numbers("offsets", offsets)
    if not 0 < len(at) * len(aside) <= _MOST:
        allowed = f"from 1 to {_MOST:,}"
        raise OptionError("stations", len(at) * len(aside), allowed, what="number of points")
    station, offset = np.repeat(at, len(aside)), np.tile(aside, len(at))
    xy = alignment.points_at(station, offset=offset)
    along = {"station": station}
    written = station
    if alignment.equations:
        written = along["written_station"] = alignment.written_stations(station)
    along["offset"] = offset
    words = [
        f"{one:.3f} " + (f"{'R' if side > 0 else 'L'} {abs(side):.3f}" if side else "CL")
        for one, side in zip(written.tolist(), offset.tolist(), strict=True)
    ]
    numbers = np.empty(len(xy), object)
    numbers[:] = [str(one + 1) for one in range(len(xy))]
    descriptions = np.empty(len(xy), object)
    descriptions[:] = words
    return Stakes(xy, numbers, descriptions, along, tuple(alignment.notes))


def _find_texts(columns: Any, names: tuple[str, ...], otherwise: list[str]) -> ObjectArray:
    """Return the texts of the first column of these names; where one is missing, another text."""
    texts = np.empty(len(otherwise), object)
    texts[:] = otherwise
    found = next((name for name in names if name in columns), None)
    if found is not None:
        values = np.asarray(columns[found]).tolist()
        texts[:] = [
            other if one is None or one != one or str(one).strip() == "" else str(one)
            for one, other in zip(values, otherwise, strict=True)
        ]
    return texts


def _describe_repeated(numbers: ObjectArray) -> list[str]:
    names, counts = np.unique(numbers.astype(str), return_counts=True)
    repeated = names[counts > 1]
    if not len(repeated):
        return []
    words = inflect(f"{counted(len(repeated), 'point number')} [occurs|occur]", len(repeated))
    return [f"{words} several times (first: '{repeated[0]}')."]
