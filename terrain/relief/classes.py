"""Classes of slope and aspect, as polygons with a legend."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...base.checks import as_floats
from ...base.errors import OptionError, choice
from ...base.georeference import describe_unknown, find_plane_units
from ...base.policies import SlopeUnit
from ...base.products import product
from ...base.results import Features
from ..drawing import COMPASS, STEEPNESS, interpolate_colors
from ..surface import dissolve, make_polygons, measure_plane_areas
from .gradients import aspect, slope
from .statistics import SYMBOLS

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike

    from ...base.arrays import AnyArray, Float64Array
    from ...tin import TIN

_DEGREE_BREAKS = (2.0, 5.0, 10.0, 15.0, 25.0, 35.0, 45.0)
_PERCENT_BREAKS = (2.0, 5.0, 10.0, 15.0, 30.0, 60.0)
"""Limits of the FAO's Guidelines for soil description (2006, 4th edition, table 7), from level to
very steep, its three classes below 2 % taken together."""

_USUAL_BREAKS = {
    "degrees": _DEGREE_BREAKS,
    "percent": _PERCENT_BREAKS,
    "ratio": tuple(value / 100 for value in _PERCENT_BREAKS),
}
_STEEPEST = {"degrees": 90.0, "percent": math.inf, "ratio": math.inf}
_COMPASS = ("N", "NE", "E", "SE", "S", "SW", "W", "NW")
_LEVEL = "level"
_MOST_CLASSES = 1000


class _Legend(NamedTuple):
    """What each class is called, its limits, and how it is drawn."""

    labels: Sequence[str]
    lower: Sequence[float]
    upper: Sequence[float]
    colors: Sequence[str]


@product
def slope_classes(
    tin: TIN, *, breaks: ArrayLike | None = None, unit: SlopeUnit = "degrees"
) -> Features:
    """Divide a surface into classes of slope, each a feature of dissolved polygons.

    Parameters
    ----------
    tin : TIN
    breaks : sequence of float, optional
        Ascending limits between the classes, in ``unit``; the first class begins at 0, the last
        has no upper limit but the vertical. Default 2, 5, 10, 15, 25, 35, 45 degrees, or 2, 5, 10,
        15, 30, 60 percent.
    unit : {"degrees", "percent", "ratio"}, optional

    Returns
    -------
    Features
        A feature for each class that has a triangle, with the columns ``class`` (from 0 on),
        ``label``, ``lower``, ``upper``, ``triangles``, ``area`` (in the plane, CRS units squared),
        ``share`` of it, and ``color`` for a legend.

    Raises
    ------
    OptionError
        If the unit is another, or the breaks are not ascending, finite and above 0.

    Notes
    -----
    A class holds slopes from ``lower`` up to, but not including, ``upper``. Each triangle belongs
    to one class whole, so that the polygons tile the surface and their areas add up to its own.
    Polygons are valid in the sense of the OGC: holes and parts touch in points at most.

    Examples
    --------
    >>> import tinsmith as ts
    >>> roof = [[0, 0, 0], [4, 0, 3], [4, 4, 3], [0, 4, 0], [9, 0, 3], [9, 4, 3]]
    >>> classes = ts.slope_classes(ts.triangulate(roof), breaks=[30])
    >>> classes.columns["label"].tolist(), classes.columns["area"].tolist()
    (['0 to 30°', '30° and more'], [20.0, 16.0])
    """
    choice("unit", unit, SlopeUnit)
    limits = _as_breaks(_USUAL_BREAKS[unit] if breaks is None else breaks, unit)
    classes = np.searchsorted(limits, slope(tin, unit=unit), side="right")
    symbol = SYMBOLS[unit]
    lower, upper = [0.0, *limits.tolist()], [*limits.tolist(), _STEEPEST[unit]]
    legend = _Legend(
        [
            _write_range(low, high, symbol, _STEEPEST[unit])
            for low, high in zip(lower, upper, strict=True)
        ],
        lower,
        upper,
        interpolate_colors(STEEPNESS, len(lower)),
    )
    return _as_features(tin, classes, legend, symbol, "slope_classes")


@product
def aspect_classes(tin: TIN) -> Features:
    """Divide a surface into the eight directions in which it falls, and level ground.

    Parameters
    ----------
    tin : TIN

    Returns
    -------
    Features
        As :func:`slope_classes`: labels "N", "NE", ... and "level". North reaches from 337.5 to
        22.5 degrees, a limit belongs to the direction clockwise of it; ``lower`` and ``upper`` are
        NaN for level ground.

    Examples
    --------
    >>> import tinsmith as ts
    >>> tin = ts.triangulate([[0, 0, 0], [1, 0, 1], [0, 1, 0]])
    >>> ts.aspect_classes(tin).columns["label"].tolist()
    ['W']
    """
    azimuth = aspect(tin)
    is_level = np.isnan(azimuth)
    sector = 360.0 / len(_COMPASS)
    turned = np.floor((np.where(is_level, 0.0, azimuth) + sector / 2) / sector).astype(np.int64)
    classes = np.where(is_level, len(_COMPASS), turned % len(_COMPASS))
    middle = np.arange(len(_COMPASS)) * sector
    legend = _Legend(
        (*_COMPASS, _LEVEL),
        [*((middle - sector / 2) % 360.0).tolist(), math.nan],
        [*(middle + sector / 2).tolist(), math.nan],
        COMPASS,
    )
    return _as_features(tin, classes, legend, "°", "aspect_classes")


def _as_breaks(breaks: Any, unit: str) -> Float64Array:
    """Return limits between classes, or say what is wrong with them."""
    allowed = "a sequence of ascending numbers above 0"
    limits = as_floats(breaks)
    if limits is None:
        raise OptionError("breaks", breaks, allowed=allowed)
    if limits.ndim != 1 or len(limits) == 0 or len(limits) >= _MOST_CLASSES:
        raise OptionError("breaks", breaks, allowed=f"{allowed}, 1 to {_MOST_CLASSES - 1} of them")
    is_ascending = np.isfinite(limits).all() and limits[0] > 0 and (np.diff(limits) > 0).all()
    if not is_ascending or limits[-1] >= _STEEPEST[unit]:
        below = " and below 90" if unit == "degrees" else ""
        raise OptionError("breaks", breaks, allowed=allowed + below)
    return limits


def _write_range(low: float, high: float, symbol: str, most: float) -> str:
    """Write the limits of a class: "5 to 10°", "45° and more"."""
    behind = f" {symbol}" if symbol == "%" else symbol
    if high == most:
        return f"{low:g}{behind} and more"
    return f"{low:g} to {high:g}{behind}"


def _as_features(tin: TIN, classes: AnyArray, legend: _Legend, symbol: str, name: str) -> Features:
    found = dissolve(tin, classes.astype(np.int64))
    ground = measure_plane_areas(tin)
    measured = np.bincount(classes, ground, len(legend.labels))[found.classes]
    columns = {
        "class": found.classes,
        "label": np.array(legend.labels, object)[found.classes],
        "lower": np.array(legend.lower)[found.classes],
        "upper": np.array(legend.upper)[found.classes],
        "triangles": np.bincount(classes, minlength=len(legend.labels))[found.classes],
        "area": measured,
        "share": 100.0 * measured / ground.sum(),
        "color": np.array(legend.colors, object)[found.classes],
    }
    unit = symbol or "ratio"
    return make_polygons(
        tin,
        found,
        columns=columns,
        units={"lower": unit, "upper": unit, "area": find_plane_units(tin.crs).area, "share": "%"},
        name=name,
        notes=describe_unknown(tin.crs, tin.elevation_unit),
    )
