"""Scales: how many times smaller paper is than ground, as 1:500 or as 1" = 20'."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from itertools import count
from typing import TYPE_CHECKING, Any

from ...base.checks import is_finite_number
from ...base.crs import FOOT, US_SURVEY_FOOT, Unit, require_projected
from ...base.errors import CrsError, OptionError
from .paper import MM_PER_INCH

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ...base.crs import CRS, UnitLike

_SMALLEST = 1e8
_RATIO = re.compile(r"(?:1\s*[:/]\s*)?(\d+(?:[.,]\d+)?)")
_INCHES = re.compile(
    r"""1\s*(?:"|''|\u2033|in|inch)\s*=\s*(\d+(?:\.\d+)?)\s*(?:'|\u2032|ft|foot|feet)""",
    re.IGNORECASE,
)
_THOUSANDS = re.compile(r"(?<=\d)[,\u2009\u00a0 ](?=\d{3}(?:\D|$))")
_ALLOWED = "a number from 1 to 100,000,000 such as 500 for 1:500, or text such as '1\"=20 ft'"
_RATIO_LEADS = (1.0, 2.0, 2.5, 5.0)
_FOOT_LEADS = (1.0, 2.0, 3.0, 4.0, 5.0, 6.0)
_FACTOR_TOLD = 1e-3
"""A scale factor of the CRS farther from 1 is told in a note; UTM stays within it in its zone."""
_LARGEST_ERROR = 0.01
"""Of a CRS's own scale: with more, a plan at 1:500 measures visibly wrong."""


@dataclass(frozen=True, slots=True)
class Scale:
    r"""How many times smaller paper is than ground.

    Examples
    --------
    >>> from tinsmith.base.crs import FOOT, METRE
    >>> Scale.of("1:500", METRE)
    Scale(denominator=500.0, text='1:500')
    >>> Scale.of('1" = 20 ft', FOOT).text
    '1" = 20\'  (1:240)'
    """

    denominator: float
    """500 of 1:500."""
    text: str
    """As it stands on the sheet."""

    @classmethod
    def of(cls, value: Any, unit: Unit) -> Scale:
        """Return the scale that a caller gives, for coordinates in a unit."""
        if isinstance(value, str):
            text = _THOUSANDS.sub("", value.strip())
            inches = _INCHES.fullmatch(text)
            if inches:
                return cls._of_feet(float(inches[1]), unit, value)
            ratio = _RATIO.fullmatch(text)
            number = float(ratio[1].replace(",", ".")) if ratio else math.nan
        else:
            number = float(value) if is_finite_number(value) else math.nan
        return cls._of_ratio(number, value)

    @classmethod
    def _of_ratio(cls, denominator: float, value: Any) -> Scale:
        if not 1.0 <= denominator <= _SMALLEST:
            raise OptionError("scale", value, _ALLOWED)
        return cls(denominator, f"1:{_write(denominator)}")

    @classmethod
    def _of_feet(cls, feet: float, unit: Unit, value: Any) -> Scale:
        """Return the scale of so many feet to an inch: of the CRS's own feet, if it has them."""
        foot = US_SURVEY_FOOT if unit == US_SURVEY_FOOT else FOOT
        denominator = feet * (foot.metres or math.nan) * 1000.0 / MM_PER_INCH
        if not 1.0 <= denominator <= _SMALLEST:
            raise OptionError("scale", value, _ALLOWED)
        return cls(denominator, f"1\" = {_write(feet)}'  (1:{_write(round(denominator, 2))})")

    @classmethod
    def usual(cls, unit: Unit) -> Iterator[Scale]:
        """Yield the scales that drawings have, from the largest on.

        Examples
        --------
        >>> from tinsmith.base.crs import METRE
        >>> scales = Scale.usual(METRE)
        >>> [next(scales).text for _ in range(9)][5:]
        ['1:25', '1:50', '1:100', '1:200']
        """
        in_feet = unit in (FOOT, US_SURVEY_FOOT)
        for power in count():
            for lead in _FOOT_LEADS if in_feet else _RATIO_LEADS:
                number = lead * 10.0**power
                if number % 1.0:
                    continue  # nobody draws at 1:2.5
                scale = (
                    cls._of_feet(number, unit, number)
                    if in_feet
                    else cls(number, f"1:{_write(number)}")
                )
                if scale.denominator > _SMALLEST:
                    return
                yield scale

    def measure_unit(self, unit: Unit) -> float:
        """Return how long a unit of the coordinates is on paper, millimetres."""
        return (unit.metres or math.nan) * 1000.0 / self.denominator


def _write(number: float) -> str:
    return f"{number:.12g}"


def find_ground_unit(crs: CRS | None, declared: UnitLike | None) -> Unit:
    """Return the unit of eastings and northings, declared where no CRS tells it.

    Raises CrsError if coordinates are angles, or nothing tells what they are; OptionError if the
    unit is none, or another than the CRS's.
    """
    unit = _parse_unit(declared)
    require_projected(
        crs,
        "A plan true to scale cannot be drawn in {crs}, whose coordinates are angles: reproject to "
        "a projected CRS first.",
    )
    known = None if crs is None else crs.horizontal_unit
    if known is None or known.metres is None:
        if unit is None:
            raise CrsError(
                "The unit of eastings and northings is not known, and a scale needs it: give the "
                "CRS, or the ground unit: 'm', 'ft' or 'US survey foot'.",
                crs=crs,
            )
        return unit
    if unit is not None and unit != known:
        raise OptionError(
            "ground_unit", unit.name, f"{known.name}, that of {crs.label if crs else ''}"
        )
    return known


def _parse_unit(declared: UnitLike | None) -> Unit | None:
    try:
        return Unit.of(declared)
    except OptionError as error:
        raise OptionError("ground_unit", declared, error.allowed) from None


def measure_scale_factor(crs: CRS | None, x: float, y: float) -> float | None:
    """Return how much longer lengths are in a CRS than on the ellipsoid; None if nothing tells.

    Raises CrsError if it is so far from 1 that no scale would hold.

    Examples
    --------
    >>> from tinsmith import CRS
    >>> round(measure_scale_factor(CRS("EPSG:32616"), 500_000, 4_000_000), 6)
    0.9996
    """
    factors = None if crs is None else _find_factors(crs, x, y)
    if crs is None or factors is None:
        return None
    worst = max(factors, key=lambda factor: abs(math.log(factor)))
    if abs(worst - 1.0) > _LARGEST_ERROR:
        raise CrsError(
            f"Lengths in {crs.label} are {worst:.3f} times those on the ground here, so that no "
            "scale would hold: reproject to the CRS of the country or UTM zone first.",
            crs=crs,
        )
    return worst


def describe_elevation_scale(scale: Scale, exaggeration: float) -> str:
    """Return the scale of elevations that are drawn so many times larger.

    Examples
    --------
    >>> from tinsmith.base.crs import METRE
    >>> describe_elevation_scale(Scale.of(500, METRE), 5.0)
    '1:100  (5 times)'
    """
    if exaggeration == 1.0:
        return scale.text
    return f"1:{_write(round(scale.denominator / exaggeration, 2))}  ({exaggeration:.6g} times)"


def describe_factor(factor: float | None, scale: Scale) -> Iterator[str]:
    """Tell a scale factor of the CRS that is far from 1."""
    if factor is not None and abs(factor - 1.0) > _FACTOR_TOLD:
        yield (
            f"Lengths in the CRS are {factor:.5f} times those on the ground here: the scale "
            f"{scale.text} holds for lengths in the CRS."
        )


def _find_factors(crs: CRS, x: float, y: float) -> tuple[float, float] | None:
    """Return the scale factors along the meridian and the parallel at a place."""
    from pyproj import Proj
    from pyproj.exceptions import ProjError

    try:
        projection = Proj(crs.horizontal.to_pyproj())
        longitude, latitude = projection(x, y, inverse=True)
        found = projection.get_factors(longitude, latitude)
    except ProjError:
        return None
    factors = (float(found.meridional_scale), float(found.parallel_scale))
    return factors if all(math.isfinite(one) and one > 0 for one in factors) else None
