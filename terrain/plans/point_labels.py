"""Points and spot heights of a plan, and the label that stands beside each."""

from __future__ import annotations

from numbers import Real
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...base.checks import as_number, require_count
from ...base.errors import OptionError
from ...base.georeference import find_axes
from ..surface import as_places
from .paper import clean_text

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from ...base.arrays import Float64Array
    from ...tin import TIN, Survey

_BESIDE = {
    "numbers": ("point-number", ("number",)),
    "elevations": ("point-elevation", ()),
    "codes": ("point-code", ("code", "description")),
}
"""What labels of points say: the name of such a text, and attributes of a survey that have it."""
_MOST_DECIMALS, _DECIMALS_OF_SPOTS = 3, 2
"""Of elevations: an instrument measures no finer, and what is interpolated is known no finer."""
_MOST_SPOTS = 100_000
_SIZES = (0.5, 20.0)
PEAKS = "peaks"


class Marks(NamedTuple):
    """Points to be drawn."""

    kind: str
    """ "point" or "spot height"."""
    places: Float64Array
    """(n, 2)."""
    texts: dict[str, list[str]]
    """What stands beside each, from the top down, by the names of texts."""


class Marking(NamedTuple):
    """Which points are drawn, and what is written beside them."""

    points: tuple[str, ...] | None
    """Of "numbers", "elevations", "codes"; None draws no points."""
    spots: float | str | Float64Array | None
    """Spacing of a grid, "peaks" or places."""
    decimals: int | None
    size: float
    """Height of digits, millimetres."""
    notes: tuple[str, ...] = ()

    @classmethod
    def of(cls, tin: TIN, points: Any, spots: Any, decimals: Any, size: Any) -> Marking:
        """Return what a caller gives; OptionError, PointsError or CrsError if it cannot be."""
        least, most = _SIZES
        height = as_number("label_size", size, least=least, most=most, unit="millimetres")
        require_count("decimals", decimals, least=0, most=9, or_none=True)
        chosen: Any = spots
        notes: tuple[str, ...] = ()
        if isinstance(spots, Real):
            chosen = as_number("spots", spots, "a spacing", above=0.0)
        elif isinstance(spots, str):
            if spots != PEAKS:
                raise OptionError("spots", spots, f"a spacing, '{PEAKS}', or points")
        elif spots is not None:
            places, notes = as_places(tin, spots, "spot heights")
            chosen = find_axes(tin.crs).turn(places)
        return cls(_parse_points(points), chosen, decimals, height, notes)


def _parse_points(points: Any) -> tuple[str, ...] | None:
    words = points.split(",") if isinstance(points, str) else []
    chosen = tuple(word.strip() for word in words)
    if chosen in (("none",), ("marks",)):
        return None if chosen == ("none",) else ()
    chosen = ("numbers", "elevations") if chosen == ("both",) else chosen
    if not chosen or not set(chosen) <= set(_BESIDE) or len(set(chosen)) < len(chosen):
        allowed = f"none, marks, both, or some of {', '.join(_BESIDE)} with commas between them"
        raise OptionError("points", points, allowed)
    return tuple(word for word in _BESIDE if word in chosen)


def gather_marks(tin: TIN, survey: Survey | None, marking: Marking) -> tuple[Marks, ...]:
    """Return points and spot heights, in coordinates of a drawing.

    Raises OptionError if points have no such texts, a survey has elevations in another unit, or
    spot heights are too many.
    """
    marks = []
    if marking.points is not None:
        marks.append(_gather_points(tin, survey, marking.points, marking.decimals))
    if marking.spots is not None:
        places = _place_spots(tin, marking.spots)
        elevations = np.asarray(tin.interpolate(places), np.float64)
        is_known = np.isfinite(elevations)
        decimals = _DECIMALS_OF_SPOTS if marking.decimals is None else marking.decimals
        texts = write_elevations(elevations[is_known], decimals)
        marks.append(Marks("spot height", places[is_known], {"spot-elevation": texts}))
    return tuple(marks)


def _gather_points(
    tin: TIN, survey: Survey | None, words: Sequence[str], decimals: int | None
) -> Marks:
    xyz = tin.points if survey is None else survey.points
    known = [one.elevation_unit for one in (tin, survey) if one is not None]
    if None not in known and known[0] != known[-1]:
        raise OptionError(
            "survey",
            f"with elevations in {known[-1]}",
            f"one with elevations in {known[0]}, as those of the surface",
        )
    texts = {}
    for word in words:
        name, attributes = _BESIDE[word]
        texts[name] = (
            _find_texts(survey, word, attributes)
            if attributes
            else write_elevations(xyz[:, 2], decimals)
        )
    return Marks("point", xyz[:, :2], texts)


def _find_texts(survey: Survey | None, word: str, attributes: Sequence[str]) -> list[str]:
    for name in attributes:
        values = None if survey is None else survey.attributes.get(name)
        if values is not None and len(values):
            return [clean_text(str(value)) for value in values]
    what = "point numbers" if word == "numbers" else "codes of points"
    allowed = f"'marks' or 'elevations' where there is no survey with {what}"
    raise OptionError("points", word, allowed)


def _place_spots(tin: TIN, spots: float | str | Float64Array) -> Float64Array:
    if isinstance(spots, str):
        return find_peaks(tin)
    if not isinstance(spots, float):
        return spots
    box = tin.bounds
    if not (box.width / spots + 1) * (box.height / spots + 1) <= _MOST_SPOTS:
        allowed = f"so large that there are at most {_MOST_SPOTS:,} spot heights"
        raise OptionError("spots", spots, allowed)
    first = np.ceil([box.xmin / spots, box.ymin / spots])
    last = np.floor([box.xmax / spots, box.ymax / spots])
    x, y = (spots * np.arange(a, b + 1) for a, b in zip(first, last, strict=True))
    return np.column_stack([one.ravel() for one in np.meshgrid(x, y[::-1])])


def find_peaks(tin: TIN) -> Float64Array:
    """Return the places of vertices higher, or lower, than all of their neighbours, (k, 2).

    Those on the boundary are none; first come those farthest from the median elevation.
    """
    z = tin.points[:, 2]
    pairs = np.concatenate([tin.triangles[:, [0, 1]], tin.triangles[:, [1, 2]],
                            tin.triangles[:, [2, 0]]])  # fmt: skip
    highest, lowest = np.full(len(z), -np.inf), np.full(len(z), np.inf)
    for here, there in (pairs.T, pairs.T[::-1]):
        np.maximum.at(highest, here, z[there])
        np.minimum.at(lowest, here, z[there])
    is_inner = np.isfinite(highest)
    is_inner[np.concatenate([*tin.boundary, np.empty(0, np.int64)]).astype(np.int64)] = False
    found = np.flatnonzero(is_inner & ((z > highest) | (z < lowest)))
    order = np.argsort(-np.abs(z[found] - np.median(z)), kind="stable")
    places: Float64Array = tin.points[found[order], :2]
    return places


def write_elevations(elevations: Iterable[float], decimals: int | None = None) -> list[str]:
    """Write elevations with so many decimals; default as many as they need, at most three.

    Examples
    --------
    >>> write_elevations([318.5, 320.25]), write_elevations([318.5], 1)
    (['318.50', '320.25'], ['318.5'])
    """
    values = np.asarray(elevations, np.float64)
    if decimals is None:
        needed = (k for k in range(_MOST_DECIMALS) if np.array_equal(values.round(k), values))
        decimals = next(needed, _MOST_DECIMALS)
    rounded = [round(value, decimals) + 0.0 for value in values.tolist()]
    return [f"{value:.{decimals}f}" for value in rounded]
