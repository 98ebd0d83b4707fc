"""What a raster says of its bands and of its axes: elevations, depths, errors, times; units."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...base.crs import CRS, Unit
from ...base.errors import OptionError, ReadError
from ...base.sentences import FILE, counted
from ...tin.screening import AreaOfUse

if TYPE_CHECKING:
    from .header import Header

_WGS84 = "EPSG:4326"
_WORD = re.compile(r"[a-z]+")
_ELEVATION = frozenset(
    ("elevation", "elevations", "elev", "height", "heights", "altitude", "dem", "dtm", "dsm", "z")
) | {"bathymetry", "topography"}
_ERROR = frozenset(
    ("uncertainty", "error", "errors", "sigma", "sd", "std", "stddev", "stdev", "deviation")
) | {
    *("variance", "rmse", "accuracy", "precision", "confidence", "residual", "quality"),
    *("count", "counts", "density", "weight", "intensity"),
}
_DEPTH = frozenset(("depth", "depths"))
_DEPTH_NAME = re.compile(r"depth|sea_floor_depth(_below_\w+)?")
_AXES = {
    "x": frozenset(("projection_x_coordinate", "longitude")),
    "y": frozenset(("projection_y_coordinate", "latitude")),
}
"""Standard names of the CF conventions, which name what GDAL takes for the axes of cells."""
_DEGREES = re.compile(r"degrees?(_?[nesw]|_?(north|east))?")


class Meaning(NamedTuple):
    """The band to read, the raster whose factors make elevations of it, and what was told."""

    band: int
    header: Header
    notes: list[str]


def find_meaning(header: Header, band: int | None, chosen: int) -> Meaning:
    """Find the band of elevations by what the file says of its bands, and turn depths.

    Parameters
    ----------
    header : Header
    band : int or None
        The caller's.
    chosen : int
        That one, or the first.

    Raises
    ------
    ReadError
        If no band was named, and the first holds errors, or several bands are of several times.
    """
    notes: list[str] = []
    if band is None:
        chosen, notes = _choose_by_words(header, chosen)
    return _turn_depths(header, chosen, notes)


def _choose_by_words(header: Header, first: int) -> tuple[int, list[str]]:
    """Return the only band that is said to hold elevations, else the first."""
    numbers = range(1, len(header.meanings) + 1)
    levels = [one for one in numbers if _words(header, one) & _ELEVATION]
    levels = [one for one in levels if not _words(header, one) & _ERROR]
    count = header.count
    # Refuse bands that differ by a time, a depth or another dimension alone.
    extra = re.findall(r"[^{},]+", header.tags.get("NETCDF_DIM_EXTRA", ""))
    if header.count > 1 and extra:
        raise ReadError(
            f"{FILE} has {header.count} bands, one for each {' and '.join(extra)}: the "
            "option band chooses the one to read.",
        )
    if first in levels or (not levels and not _words(header, first) & _ERROR):
        if count == 1:
            return first, []
        others = f"Band {first} of {count} is read; the option `band` chooses another one."
        return first, [others]
    if len(levels) == 1:
        label = _label(header, levels[0])
        return levels[0], [f"Band {levels[0]} of {count} is read, by its description '{label}'."]
    raise ReadError(
        f"{FILE}: band {first} of {counted(count, 'band')} is described as "
        f"'{_label(header, first)}', which is no elevation: the option `band` chooses the one to "
        "read.",
    )


def _turn_depths(header: Header, band: int, notes: list[str]) -> Meaning:
    """Change the sign of what is positive downwards; refuse depths that do not say so."""
    tags = header.meanings[band - 1] if band <= len(header.meanings) else {}
    positive = tags.get("positive", "").strip().lower()
    name = tags.get("standard_name", "")
    if positive == "down" or (not positive and _DEPTH_NAME.fullmatch(name)):
        reason = "positive is 'down'" if positive else f"its standard name is '{name}'"
        scales, offsets = list(header.scales), list(header.offsets)
        scales[band - 1], offsets[band - 1] = -scales[band - 1], -offsets[band - 1]
        note = f"Band {band} holds depths ({reason}): their sign was changed."
        return Meaning(band, replace(header, scales=scales, offsets=offsets), [*notes, note])
    words = _words(header, band)
    if words & _DEPTH and not positive and not words & _ELEVATION:
        note = (
            f"Band {band} is called '{_label(header, band)}', and its values are taken as "
            "elevations, positive upwards: check that they are no depths."
        )
        return Meaning(band, header, [*notes, note])
    return Meaning(band, header, notes)


def _words(header: Header, band: int) -> set[str]:
    return set(_WORD.findall(_label(header, band).lower()))


def _label(header: Header, band: int) -> str:
    """Return the description of a band, else its names in netCDF."""
    tags = header.meanings[band - 1] if band <= len(header.meanings) else {}
    named = (tags.get(one, "") for one in ("description", "standard_name", "long_name"))
    return next((one for one in named if one), tags.get("NETCDF_VARNAME", ""))


# ------------------------------------------------------------------------- axes


def settle_axes(header: Header, target: CRS | None) -> tuple[Header, CRS | None, list[str]]:
    """Return a raster in units of its CRS, that CRS, and what was told; by the units of its axes.

    Raises
    ------
    ReadError
        If the two axes have different units.
    """
    source, word = CRS.of(header.crs), _find_axis_unit(header)
    if source is not None or target is None or target.is_geographic:
        return header, source, []
    if word is None:
        return header, *_take_degrees(header, target)
    if _DEGREES.fullmatch(word.lower()):
        said = f"Its axes are in {word}: longitudes and latitudes are taken as of WGS 84."
        return header, CRS.of(_WGS84), [said]
    try:
        unit = Unit.of(word)
    except OptionError:
        return header, None, [f"The unit of its axes, '{word}', is no length, and was not used."]
    wanted = target.horizontal_unit
    if unit is None or unit.metres is None or wanted.metres is None or unit == wanted:
        return header, None, []
    factor = unit.metres / wanted.metres
    note = f"Eastings and northings were converted from {unit.name} to {wanted.name}."
    transform = type(header.transform)(*(factor * one for one in header.transform))
    return replace(header, transform=transform), None, [note]


def _find_axis_unit(header: Header) -> str | None:
    found = {
        header.tags.get(f"{key.removesuffix('#standard_name')}#units", "").strip()
        for key, value in header.tags.items()
        for names in _AXES.values()
        if key.endswith("#standard_name") and value in names
    }
    found = {"degrees" if _DEGREES.fullmatch(one.lower()) else one for one in found if one}
    if len(found) > 1:
        raise ReadError(
            f"its axes have the units {' and '.join(sorted(found))}: one for both is needed.",
        )
    return next(iter(found), None)


def _take_degrees(header: Header, target: CRS) -> tuple[CRS | None, list[str]]:
    """Take a raster for one in degrees where it lies in the area of use of the CRS only so."""
    west, south, east, north = header.bounds
    corners = np.array([[west, south], [east, north], [west, north], [east, south]])
    area = AreaOfUse.of(None, target)
    if area is None or not area.is_local(corners) or not area.covers_as_degrees(corners):
        return None, []
    note = (
        f"It has no CRS, and lies inside the area of use of {area.label} as longitude and latitude "
        f"alone (west {west:.10g}, south {south:.10g}): they were taken to be degrees of WGS 84."
    )
    return CRS.of(_WGS84), [note]
