"""Units and CRS as LandXML writes them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ....base.crs import CRS, FOOT, METRE, US_SURVEY_FOOT, Unit
from ....base.errors import CrsError, ReadError
from ....base.sentences import FILE, shown
from ..reference import Stated
from .content import ELEVATION_UNIT, UNKNOWN

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ....base.arrays import Float64Array
    from .content import Content

_LINEAR = {
    ("Metric", "meter"): METRE,
    ("Metric", "kilometer"): Unit.of("km"),
    ("Metric", "centimeter"): Unit.of("cm"),
    ("Metric", "millimeter"): Unit.of("mm"),
    ("Imperial", "foot"): FOOT,
    ("Imperial", "USSurveyFoot"): US_SURVEY_FOOT,
    ("Imperial", "inch"): Unit.of("in"),
    ("Imperial", "mile"): Unit("Statute mile", "mi", 1609.344),
}
_WORDS = {name.lower(): unit for (_, name), unit in _LINEAR.items()}
_WORDS |= {"metre": METRE, "feet": FOOT, "miles": _WORDS["mile"], "internationalfoot": FOOT}
_NAMES_OF_SYSTEMS = (
    "name",
    "desc",
    "compoundCoordinateSystemName",
    "projectedCoordinateSystemName",
    "horizontalCoordinateSystemName",
)
_DEGREES = 2e-4
"""Places that lie so near in both CRSs, about 20 m, mean the same one: datums are not told apart,
which WKT of CAD programs often leaves out."""


def name_unit(unit: Unit) -> tuple[str, str] | None:
    """Return the system and name of a unit, such as ("Imperial", "foot"); None if it has none."""
    return next((names for names, one in _LINEAR.items() if one == unit), None)


def find_stated(
    content: Content, *, sample: Float64Array, is_crs_declared: bool
) -> tuple[Stated, list[str]]:
    """Return what the file says of units and CRS, and notes of what it says in other words.

    Parameters
    ----------
    content : Content
    sample : (n, 2) float64 array
        Easting and northing of some points.
    is_crs_declared : bool
        Whether the caller names a CRS, so that one that is unknown does no harm.
    """
    crs, notes = _find_crs(content, sample, is_crs_declared=is_crs_declared)
    units = [_parse_units(system, attributes) for system, attributes in content.units]
    if len(set(units)) > 1:
        raise ReadError(
            f"{FILE} gives its units twice, and not the same: {units[0][0].name} and "
            f"{units[1][0].name}."
        )
    unit, elevation_unit = units[0] if units else (None, None)
    is_unknown = content.system_properties.get(ELEVATION_UNIT) == UNKNOWN
    return Stated(crs, unit, elevation_unit, is_unknown, "its element Units"), notes


def _parse_units(system: str, attributes: dict[str, str]) -> tuple[Unit, Unit | None]:
    text = attributes.get("linearUnit", "").strip()
    unit = _find_unit(text)
    if unit is None:
        allowed = ", ".join(name for _, name in _LINEAR)
        raise ReadError(
            f"{FILE} has the linearUnit {shown(text)} under {system}: {allowed} are allowed."
        )
    word = attributes.get("elevationUnit", "").strip()
    elevation_unit = _find_unit(word)
    if word.lower() in ("feet", "foot") and unit == US_SURVEY_FOOT:
        elevation_unit = unit  # the schema has no other word for it
    return unit, elevation_unit


def _find_unit(text: str) -> Unit | None:
    return _WORDS.get(text.replace(" ", "").replace("_", "").lower())


# --------------------------------------------------------------------------- CRS


def _find_crs(
    content: Content, sample: Float64Array, *, is_crs_declared: bool
) -> tuple[CRS | None, list[str]]:
    system = content.system
    code, wkt = system.get("epsgCode", "").strip(), system.get("ogcWktCode", "").strip()
    digits = code.upper().removeprefix("EPSG").lstrip(": ")
    is_code = digits.replace("+", "").isdecimal()
    by_code, by_wkt = _parse_crs(f"EPSG:{digits}" if is_code else ""), _parse_crs(wkt)
    notes = [
        f"The {name} {shown(text)} of its CoordinateSystem is none that PROJ knows."
        for name, text, found in (("epsgCode", code, by_code), ("ogcWktCode", wkt, by_wkt))
        if text and found is None and text != "0"
    ]
    if by_code is not None and by_wkt is not None:
        return _choose_crs(by_code, by_wkt, sample, is_crs_declared=is_crs_declared), notes
    found = by_code or by_wkt or _find_named(system)
    if found is None and system and not is_crs_declared:
        words = next((system[name] for name in _NAMES_OF_SYSTEMS if system.get(name)), "")
        if words:
            notes.append(f"Its CRS is named in words only, {shown(words)}: declare it to have one.")
    elif by_code is None and by_wkt is None and found is not None:
        notes.append(f"The CRS {found.caption} was found by its name.")
    return found, notes


def _parse_crs(text: str) -> CRS | None:
    try:
        return CRS.of(text or None)
    except CrsError:
        return None


def _find_named(system: dict[str, str]) -> CRS | None:
    for name in _NAMES_OF_SYSTEMS:
        text = " ".join(system.get(name, "").split())
        found = _parse_crs(text) if 3 < len(text) < 200 else None
        if found is not None and found.name.casefold() == text.casefold():
            return found
    return None


def _choose_crs(by_code: CRS, by_wkt: CRS, sample: Float64Array, *, is_crs_declared: bool) -> CRS:
    """Return the CRS of which code and WKT speak, the fuller one; refuse two different ones."""
    if by_wkt.horizontal.is_same(by_code.horizontal):
        return by_wkt if by_code.vertical_unit is None else by_code
    if is_crs_declared or _lie_together(by_code, by_wkt, sample):
        return by_code
    raise ReadError(
        f"{FILE} names two CRSs, {by_code.caption} by its epsgCode and {by_wkt.name} by its "
        "ogcWktCode, which are not the same: declare the right one."
    )


def _lie_together(one: CRS, other: CRS, sample: Float64Array) -> bool:
    """Whether some points have about the same longitude and latitude in both."""
    if one.horizontal_unit != other.horizontal_unit:
        return False
    from pyproj.exceptions import ProjError

    try:
        first, second = (np.array(list(_iterate_degrees(crs, sample))) for crs in (one, other))
    except ProjError:  # a description that looks like a CRS, and leads nowhere
        return False
    return bool(np.allclose(first, second, rtol=0, atol=_DEGREES))


def _iterate_degrees(crs: CRS, sample: Float64Array) -> Iterator[tuple[float, float]]:
    from pyproj import Transformer

    system = crs.to_pyproj()
    to_degrees = Transformer.from_crs(system, system.geodetic_crs, always_xy=True)
    for x, y in sample[:8].tolist():
        yield to_degrees.transform(x, y)
