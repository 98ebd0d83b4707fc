"""Coordinate reference systems and units of length: the only place that knows what a foot is.

A CRS is kept as text, an authority code where it has one that means exactly this, else WKT, and
equals that text. pyproj is loaded when one is looked up or asked something. Coordinates are always
in the order easting, northing (longitude, latitude), whatever the authority says.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from functools import lru_cache
from numbers import Integral
from typing import TYPE_CHECKING, Any, overload

from . import optional
from .errors import CrsError, OptionError
from .sentences import shown

if TYPE_CHECKING:
    from typing import TypeAlias

    import pyproj

    CrsLike: TypeAlias = "CRS | str | int | pyproj.CRS"
    UnitLike: TypeAlias = "Unit | str"

_SHOWN_LETTERS = 60
_LABEL_LETTERS = 24
_SAME_LENGTH = 1e-10
"""Two units are the same if their lengths differ by less, as a share: EPSG, WKT and PROJ write the
US survey foot with 10 to 17 digits, and the closest two units differ by 7e-8."""


@dataclass(frozen=True, slots=True)
class Unit:
    """A unit of eastings and northings, or of elevations.

    Attributes
    ----------
    name : str
        As EPSG writes it, for example "US survey foot".
    symbol : str
        As it stands behind a number, for example "US ft".
    metres : float or None
        Its length; None if it is unknown, or an angle.

    Examples
    --------
    >>> unit = Unit.of("US survey foot")
    >>> unit.symbol, round(unit.metres, 9)
    ('US ft', 0.30480061)
    """

    name: str
    symbol: str
    metres: float | None

    @overload
    @classmethod
    def of(cls, value: None) -> None: ...
    @overload
    @classmethod
    def of(cls, value: UnitLike) -> Unit: ...
    @classmethod
    def of(cls, value: UnitLike | None) -> Unit | None:
        """Look a unit of length up; None stays None.

        Parameters
        ----------
        value : str, Unit or None
            As people write it: "m", "ft", "US survey feet", "us-ft"; or a name of EPSG.

        Raises
        ------
        OptionError
            If it is no unit of length.

        Examples
        --------
        >>> Unit.of("USft")
        Unit(name='US survey foot', symbol='US ft', metres=0.3048006096012192)
        """
        if value is None or (isinstance(value, Unit) and value.metres is not None):
            return value
        found = _find_unit(value) if isinstance(value, str) else None
        if found is None:
            raise OptionError("elevation_unit", value, _ALLOWED_UNITS, what="unit of elevations")
        return found

    @property
    def text(self) -> str:
        """Name by which :meth:`of` finds the unit again; "" if there is none."""
        return self.name if _find_unit(self.name) == self else ""

    def __str__(self) -> str:
        return self.name


METRE = Unit("metre", "m", 1.0)
FOOT = Unit("foot", "ft", 0.3048)
US_SURVEY_FOOT = Unit("US survey foot", "US ft", 1200 / 3937)
UNKNOWN = Unit("unit", "units", None)
_WORDS = {
    METRE: "m metre metres meter meters mtr mtrs",
    FOOT: "ft foot feet ift intft internationalft internationalfoot internationalfeet ftint",
    US_SURVEY_FOOT: "usft ftus usfoot usfeet footus feetus ussft ussurveyft ussurveyfoot "
    "ussurveyfeet surveyft surveyfoot surveyfeet sft ftussurvey footussurvey",
    Unit("kilometre", "km", 1000.0): "km kilometre kilometres kilometer kilometers",
    Unit("decimetre", "dm", 0.1): "dm decimetre decimetres decimeter decimeters",
    Unit("centimetre", "cm", 0.01): "cm centimetre centimetres centimeter centimeters",
    Unit("millimetre", "mm", 0.001): "mm millimetre millimetres millimeter millimeters",
    Unit("yard", "yd", 0.9144): "yd yard yards",
    Unit("inch", "in", 0.0254): "in inch inches",
    Unit("fathom", "fathoms", 1.8288): "fathom fathoms ftm",
}
_UNIT_OF_WORD = {word: unit for unit, words in _WORDS.items() for word in words.split()}
_ALLOWED_UNITS = "a length such as 'm', 'ft' (0.3048 m), 'US survey foot' (1200/3937 m) or 'cm'"


def _find_unit(text: str) -> Unit | None:
    """Look a unit up by the words of people, then by those of EPSG."""
    plain = _simplify_unit(text)
    if plain in _UNIT_OF_WORD:
        return _UNIT_OF_WORD[plain]
    return _load_epsg_units().get(plain) if plain.isascii() and plain.isalnum() else None


def _simplify_unit(text: str) -> str:
    """Leave case, blanks and punctuation out; other letters and signs stay: no µm is a metre."""
    return re.sub(r"[\s._,'()\[\]-]", "", text.casefold())


@lru_cache(maxsize=1)
def _load_epsg_units() -> dict[str, Unit]:
    """Return EPSG's units of length; PROJ's own are left out, its decimetre is a centimetre."""
    library = optional.load("pyproj", "Units by their EPSG names")
    return {
        _simplify_unit(name): _make_unit(name, unit.conv_factor)
        for name, unit in library.get_units_map(auth_name="EPSG", category="linear").items()
    }


def _make_unit(name: str, metres: float) -> Unit:
    """Return the unit of a length, under its usual name if it has one."""
    for unit in _WORDS:
        if unit.metres is not None and abs(unit.metres - metres) <= _SAME_LENGTH * metres:
            return unit
    return Unit(name, name, float(metres))


class CRS:
    """A coordinate reference system, with the units that it gives.

    ``str`` of it is its text: an authority code if it has one that means exactly this, else WKT. It
    equals, and hashes as, this text; pyproj, rasterio and geopandas take it as a CRS.

    Parameters
    ----------
    value : CRS, str, int or pyproj.CRS
        Authority code ("EPSG:32616", with a vertical one "EPSG:2274+6360"), EPSG number, WKT, PROJ
        text, PROJJSON, or an object that has a WKT.

    Raises
    ------
    CrsError
        If PROJ does not know it, or it is none of easting and northing.

    Examples
    --------
    >>> crs = CRS(2274)
    >>> crs == "EPSG:2274", crs.name, crs.horizontal_unit.name, crs.vertical_unit
    (True, 'NAD83 / Tennessee (ftUS)', 'US survey foot', None)
    """

    __slots__ = ("_text",)

    def __init__(self, value: CrsLike) -> None:
        self._text = _find_text(value)

    @overload
    @classmethod
    def of(cls, value: None) -> None: ...
    @overload
    @classmethod
    def of(cls, value: CrsLike) -> CRS: ...
    @classmethod
    def of(cls, value: CrsLike | None) -> CRS | None:
        """Return the CRS of anything that names one; None stays None.

        Raises
        ------
        CrsError
            As the class.

        Examples
        --------
        >>> CRS.of(32616), CRS.of(None)
        (CRS('EPSG:32616'), None)
        """
        return value if value is None or isinstance(value, CRS) else cls(value)

    # ------------------------------------------------------------------ what it is

    @property
    def name(self) -> str:
        """Name of the authority, for example "WGS 84 / UTM zone 16N"."""
        return str(_parsed(self._text).name)

    @property
    def label(self) -> str:
        """The text if it is short, else the name."""
        return self._text if len(self._text) <= _LABEL_LETTERS else self.name

    @property
    def caption(self) -> str:
        """Name and code, for example "WGS 84 / UTM zone 16N (EPSG:32616)"."""
        return f"{self.name} ({self._text})" if len(self._text) <= _LABEL_LETTERS else self.name

    @property
    def is_geographic(self) -> bool:
        """Whether coordinates are longitude and latitude."""
        return bool(_parsed(self._text).is_geographic)

    @property
    def area_of_use(self) -> Any:
        """West, south, east, north, degrees (``pyproj.aoi.AreaOfUse``); None if not known."""
        return _parsed(self._text).area_of_use

    @property
    def horizontal_unit(self) -> Unit:
        """Unit of eastings and northings; an angle has no ``metres``."""
        axes = _parsed(self._text).axis_info
        if not axes:
            return UNKNOWN
        if self.is_geographic:
            name = str(axes[0].unit_name)
            return Unit(name, "°" if name == "degree" else name, None)
        return _make_unit(axes[0].unit_name, axes[0].unit_conversion_factor)

    @property
    def vertical_unit(self) -> Unit | None:
        """Unit of the vertical axis of a compound or 3D CRS; None for others."""
        axes = _parsed(self._text).axis_info
        return _make_unit(axes[2].unit_name, axes[2].unit_conversion_factor) if axes[2:] else None

    @property
    def usual_elevation_unit(self) -> Unit | None:
        """Unit that elevations have where nothing else is known; None where that is no length.

        That of the vertical axis, else that of the eastings (who works in State Plane feet levels
        in feet), metres above longitude and latitude.
        """
        if self.vertical_unit is not None:
            return self.vertical_unit
        if self.is_geographic:
            return METRE
        return self.horizontal_unit if self.horizontal_unit.metres is not None else None

    @property
    def horizontal(self) -> CRS:
        """The CRS without its vertical part."""
        return _restore(_take_horizontal(self._text))

    # ------------------------------------------------------------------ other forms

    def to_pyproj(self) -> pyproj.CRS:
        """Return the CRS of pyproj.

        Examples
        --------
        >>> CRS("EPSG:32616").to_pyproj().name
        'WGS 84 / UTM zone 16N'
        """
        return _parsed(self._text)

    def to_wkt(self, version: str = "WKT2_2019") -> str:
        """Return the CRS as WKT, in a version that pyproj knows.

        Examples
        --------
        >>> CRS("EPSG:32616").to_wkt()[:30]
        'PROJCRS["WGS 84 / UTM zone 16N'
        """
        return str(_parsed(self._text).to_wkt(version))

    def to_epsg(self) -> int | None:
        """Return the EPSG number; None if there is none that means exactly this.

        Examples
        --------
        >>> CRS("EPSG:32616").to_epsg()
        32616
        """
        authority = self.to_authority()
        return int(authority[1]) if authority and authority[0] == "EPSG" else None

    def to_authority(self) -> tuple[str, str] | None:
        """Return authority and code; None if there are none that mean exactly this.

        Examples
        --------
        >>> CRS(4326).to_authority()
        ('EPSG', '4326')
        """
        if self._text == self.to_wkt():  # a code would have been found when it was made
            return None
        found = _parsed(self._text).to_authority(min_confidence=100)
        return None if found is None else (str(found[0]), str(found[1]))

    def is_same(self, other: CrsLike) -> bool:
        """Whether coordinates are the same in both, the order of the axes aside.

        Examples
        --------
        >>> CRS(4326).is_same("OGC:CRS84")  # longitude first
        True
        """
        wanted = CRS.of(other)
        if self._text == wanted._text:
            return True
        return bool(self.to_pyproj().equals(wanted.to_pyproj(), ignore_axis_order=True))

    def __eq__(self, other: object) -> bool:
        if isinstance(other, CRS):
            return self._text == other._text
        if other is None or self._text == other:
            return other is not None
        try:
            return self._text == _find_text(other)
        except CrsError:
            return False

    def __hash__(self) -> int:
        return hash(self._text)

    def __reduce__(self) -> tuple[Any, ...]:
        return _restore, (self._text,)

    def __str__(self) -> str:
        return self._text

    def __format__(self, spec: str) -> str:
        return format(self._text, spec)

    def __repr__(self) -> str:
        return f"CRS({self._text!r})"


def _restore(text: str) -> CRS:
    """Return a CRS that was one before, without looking it up."""
    crs = CRS.__new__(CRS)
    crs._text = text
    return crs


def _find_text(value: object) -> str:
    """Return the text that stands for whatever names a CRS."""
    if isinstance(value, CRS):
        return str(value)
    if isinstance(value, Integral) and not isinstance(value, bool):
        return _look_up(f"EPSG:{int(value)}")
    if isinstance(value, str):
        text = str(value).strip()
        return _look_up(f"EPSG:{text}" if text.isdecimal() else text)
    return _write_text(_parse(value))


@lru_cache(maxsize=128)
def _look_up(text: str) -> str:
    return _write_text(_parse(text))


@lru_cache(maxsize=128)
def _take_horizontal(text: str) -> str:
    crs = _parsed(text)
    if not crs.axis_info[2:]:
        return text
    if crs.is_compound:
        crs = crs.sub_crs_list[0]
    return _write_text(crs.to_2d() if crs.axis_info[2:] else crs)


def _write_text(parsed: pyproj.CRS) -> str:
    """Return the authority code of a CRS if it has one that means exactly this, else its WKT."""
    return _write_wkt_text(parsed.to_wkt())


@lru_cache(maxsize=128)
def _write_wkt_text(wkt: str) -> str:
    """Look for a code in all of PROJ's data base, which takes up to a second."""
    parsed = _parse(wkt)
    authority = parsed.to_authority(min_confidence=100)
    if authority:
        return ":".join(authority)
    if parsed.is_compound:
        parts = [part.to_authority(min_confidence=100) for part in parsed.sub_crs_list]
        if all(part and part[0] == "EPSG" for part in parts):
            return "EPSG:" + "+".join(str(part[1]) for part in parts if part)
    return wkt


@lru_cache(maxsize=128)
def _parsed(text: str) -> pyproj.CRS:
    return _parse(text)


def _parse(value: object) -> pyproj.CRS:
    library = optional.load("pyproj", "A CRS")
    try:
        parsed: pyproj.CRS = library.CRS.from_user_input(value)
    except (library.exceptions.CRSError, TypeError, ValueError, AttributeError) as error:
        text = f"'{_shorten(value)}'" if isinstance(value, str) else shown(value)
        raise CrsError(
            f"Unknown CRS {text}: an authority code such as EPSG:32616, "
            "its number, a WKT or a PROJ text is needed.",
            crs=value,
        ) from error
    axes = parsed.axis_info
    is_flat = parsed.is_geocentric or (parsed.is_vertical and not parsed.is_compound)
    if is_flat or len(axes) == 1:
        raise CrsError(
            f"'{_shorten(value)}' is {parsed.name}, a {parsed.type_name}: one of eastings "
            "and northings, or longitude and latitude, is needed.",
            crs=value,
        )
    if len(axes) > 2 and axes[2].direction == "down":
        raise CrsError(
            f"'{_shorten(value)}' is {parsed.name}, whose third axis points down: "
            "elevations must grow upwards; change the sign of the depths, and name the CRS "
            "without its vertical part.",
            crs=value,
        )
    return parsed


def _shorten(value: object, most: int = _SHOWN_LETTERS) -> str:
    text = str(value)
    return text if len(text) <= most else text[: most - 3] + "..."


def find_wkt(crs: CRS, version: str) -> str | None:
    """Return a CRS as WKT of a version; None where that cannot say it, as of derived CRSs.

    Examples
    --------
    >>> find_wkt(CRS("EPSG:32616"), "WKT1_GDAL")[:30]
    'PROJCS["WGS 84 / UTM zone 16N"'
    """
    library = optional.load("pyproj", "A CRS")
    try:
        text: str | None = crs.to_pyproj().to_wkt(version)
    except library.exceptions.CRSError:
        return None
    return text or None


def choose_wkt(crs: CRS) -> str:
    """Return WKT 1, which older programs read, where it means the same; else WKT 2.

    Examples
    --------
    >>> choose_wkt(CRS("EPSG:32616"))[:30]
    'PROJCS["WGS 84 / UTM zone 16N"'
    """
    older = find_wkt(crs, "WKT1_GDAL")
    try:
        is_same = older is not None and crs.is_same(older)
    except CrsError:
        is_same = False
    return older if older is not None and is_same else crs.to_wkt()


def shorten_crs(crs: CRS | None) -> str:
    """Return the text of a CRS, cut to fit a one-line repr."""
    return "unknown" if crs is None else _shorten(crs, _LABEL_LETTERS)


# --------------------------------------------------------------------- elevations


def require_one_unit(crs: CRS | None, unit: Unit | None) -> Unit | None:
    """Return the unit of elevations that is known: that of the CRS's vertical axis, or ``unit``.

    Refused if both are known and differ.
    """
    vertical = None if crs is None else crs.vertical_unit
    if crs is not None and vertical is not None and unit is not None:
        require_same_unit(vertical, unit, f"that of the vertical axis of {crs.label}")
    return unit if vertical is None else vertical


def require_same_unit(known: Unit, declared: Unit, why: str) -> None:
    """Refuse a unit of elevations that is declared to be another than it is known to be."""
    if known != declared:
        raise OptionError(
            "elevation_unit", declared.name, f"{known.name}, {why}", what="unit of elevations"
        )


def measure_angular_unit(crs: CRS | None) -> float | None:
    """Return the degrees of a unit of longitude and latitude; None where these are lengths.

    Examples
    --------
    >>> measure_angular_unit(CRS(4326)), measure_angular_unit(CRS(32616))
    (1.0, None)
    """
    if crs is None or not crs.is_geographic:
        return None
    return math.degrees(_parsed(str(crs)).axis_info[0].unit_conversion_factor)


def assume_elevation_unit(crs: CRS | None, unit: Unit | None) -> Unit | None:
    """Return the unit that elevations are taken to have: the known ``unit``; None if none tells."""
    return unit if unit is not None or crs is None else crs.usual_elevation_unit


def require_projected(crs: CRS | None, sentence: str) -> None:
    """Refuse longitude and latitude; "{crs}" in the sentence stands for the CRS."""
    if crs is not None and crs.is_geographic:
        raise CrsError(sentence.replace("{crs}", crs.label), crs=crs)


def require_lengths(crs: CRS | None) -> None:
    """Refuse to measure areas in the plane where coordinates are longitude and latitude."""
    require_projected(
        crs,
        "Coordinates in {crs} are angles, and areas cannot be measured in their squares: a "
        "projected CRS is needed.",
    )


def scale_elevations(crs: CRS | None, unit: Unit | None) -> float:
    """Return the factor from elevations to the unit of eastings and northings.

    Where either is unknown they are taken to be the same; where eastings are angles it is refused.
    """
    if crs is None:
        return 1.0
    require_projected(
        crs,
        "Coordinates in {crs} are angles, which have no length of their own in space: a projected "
        "CRS is needed.",
    )
    along, up = crs.horizontal_unit, assume_elevation_unit(crs, unit)
    if up is None or up.metres is None or along.metres is None or up == along:
        return 1.0
    return up.metres / along.metres
