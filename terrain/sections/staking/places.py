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
    from ....base.arrays import BoolArray, Float64Array, ObjectArray
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
    notes: list[str] = []
    is_named = isinstance(points, Survey | Features)
    theirs = points.crs if is_named else find_crs(points)
    agreed = require_same_crs(theirs, crs, "the points", is_plain=not is_named)
    if isinstance(points, Survey):
        columns, notes, points = points.attributes, [*points.notes], points.points
    elif isinstance(points, Features):
        if points.kind != "points":
            raise OptionError("points", points, "points, not lines or polygons")
        columns, notes, points = points.columns, [*points.notes], points.coordinates
    xy = as_places(points) + 0.0
    if len(xy) == 0:
        raise PointsError("There is no point to set out: at least one is needed.")
    numbers, is_numbered = _find_texts(columns, _NUMBERS, [str(k + 1) for k in range(len(xy))])
    descriptions, _ = _find_texts(columns, _DESCRIPTIONS, [""] * len(xy))
    along: dict[str, Float64Array] = {}
    if alignment is not None:
        found = alignment.stations_of(xy)
        names = ("station", "written_station", "offset")
        along = {name: found[name] for name in names if name in found.columns}
        notes += found.notes
    notes += [*agreed, *_describe_numbers(numbers, is_numbered)]
    return Stakes(xy, numbers, descriptions, along, tuple(notes))


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


def _find_texts(
    columns: Any, names: tuple[str, ...], otherwise: list[str]
) -> tuple[ObjectArray, BoolArray]:
    """Return the texts of the first column of these names, and which rows have one.

    Where one is missing it is another text. Numbers of points are whole, also where a missing one
    among them has made them floats.
    """
    texts = np.empty(len(otherwise), object)
    texts[:] = otherwise
    has_text = np.zeros(len(otherwise), np.bool_)
    found = next((name for name in names if name in columns), None)
    if found is not None:
        for row, value in enumerate(np.asarray(columns[found]).tolist()):
            text = "" if value is None or value != value else str(value).strip()
            if isinstance(value, float) and value.is_integer():
                text = str(int(value))
            if text:
                texts[row], has_text[row] = text, True
    return texts, has_text


def _describe_numbers(numbers: ObjectArray, is_numbered: BoolArray) -> list[str]:
    notes = []
    missing = np.flatnonzero(~is_numbered)
    if 0 < len(missing) < len(numbers):
        has = inflect(f"{counted(len(missing), 'point')} [has|have]", len(missing))
        first = f"(first: {numbers[missing[0]]})"
        notes.append(f"{has} no number, and the number of its row instead {first}.")
    names, counts = np.unique(numbers.astype(str), return_counts=True)
    repeated = names[counts > 1]
    if len(repeated):
        occur = inflect(f"{counted(len(repeated), 'point number')} [occurs|occur]", len(repeated))
        notes.append(f"{occur} several times (first: '{repeated[0]}').")
    return notes
