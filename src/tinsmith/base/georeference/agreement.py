"""Agreement: the CRS and units of a surface, and of what is measured together with it.

One rule for every product. What is not known of one surface is told. Several surfaces must be of
one CRS, known of all or of none; elevations in units that are known and differ are converted; a
unit that is not known is taken to be the usual one of the CRS, and never another.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple, Protocol

from ..crs import CRS, METRE, Unit, assume_elevation_unit, scale_elevations
from ..errors import CrsError

if TYPE_CHECKING:
    from collections.abc import Sequence


class Referenced(Protocol):
    """Whatever has a CRS and a unit of elevations: a TIN, a Survey."""

    @property
    def crs(self) -> CRS | None:
        """None if it is not known."""

    @property
    def elevation_unit(self) -> Unit | None:
        """None if it is not known."""


class PlaneUnits(NamedTuple):
    """Units of lengths, areas and volumes; None if they are not known."""

    length: Unit | None
    area: str | None
    volume: str | None


@dataclass(frozen=True)
class Reference:
    """The CRS and the units of a surface, or the one of several that agree."""

    crs: CRS | None
    elevation_unit: Unit | None
    """The one that is known; None if none is."""
    notes: tuple[str, ...] = ()
    """What is not known, was assumed or converted."""
    factors: tuple[float, ...] = (1.0, 1.0)
    """From the elevations of each surface, or of one and of what is made of it, to that unit."""

    @classmethod
    def of(cls, crs: CRS | None, elevation_unit: Unit | None) -> Reference:
        """Return what is known of a surface, with notes on what is not."""
        return cls(crs, elevation_unit, describe_unknown(crs, elevation_unit))

    @cached_property
    def up(self) -> float:
        """Factor from elevations to the unit of eastings; CrsError where these are angles."""
        return scale_elevations(self.crs, self.elevation_unit)

    @property
    def units(self) -> PlaneUnits:
        """Units of lengths, areas and volumes."""
        return find_plane_units(self.crs)


def find_plane_units(crs: CRS | None) -> PlaneUnits:
    """Return the units that lengths, areas and volumes are measured in: the CRS's, of degrees m.

    Examples
    --------
    >>> find_plane_units(CRS("EPSG:2274")).area
    'US ft²'
    """
    unit = None if crs is None else METRE if crs.is_geographic else crs.horizontal_unit
    if unit is None or unit.metres is None:
        return PlaneUnits(unit, None, None)
    return PlaneUnits(unit, f"{unit.symbol}²", f"{unit.symbol}³")


def describe_unknown(crs: CRS | None, elevation_unit: Unit | None) -> tuple[str, ...]:
    """Say what is not known of a surface, and what it is taken to be where it is needed.

    Examples
    --------
    >>> describe_unknown(CRS("EPSG:32616"), None)
    ('The unit of elevations is not known: taken to be the metre.',)
    """
    if crs is None:
        return ("The CRS is not known: lengths are in its own unit, elevations taken as the same.",)
    if elevation_unit is not None:
        return ()
    usual = assume_elevation_unit(crs, None)
    taken = "that of the eastings" if usual is None else f"the {usual.name}"
    return (f"The unit of elevations is not known: taken to be {taken}.",)


# ---------------------------------------------------------------- several surfaces


def agree(surfaces: Sequence[Referenced], names: Sequence[str]) -> Reference:
    """Find the one CRS and the one unit of surfaces, which are those of the first.

    ``names`` are what each is called in a sentence: "the ground". Raises CrsError if CRSs differ,
    or are known of some only; if it cannot be told whether elevations are in one unit.
    """
    named = list(zip(surfaces, names, strict=True))
    for one, name in named[1:]:
        _require_one_crs(*named[0], one, name)
    crs = surfaces[0].crs
    notes = _agree_on_datum(named)
    unit = next((one.elevation_unit for one in surfaces if one.elevation_unit is not None), None)
    if crs is None or unit is None:  # of all of them once, else of each
        notes += describe_unknown(crs, unit)
    else:
        notes += [
            f"The unit of the elevations of {name} is not known: taken to be the {unit.name}."
            for one, name in named
            if one.elevation_unit is None
        ]
    factors = []
    for one, name in named:
        own = assume_elevation_unit(crs, one.elevation_unit)
        factor = 1.0 if unit is None or own == unit else _convert(one, own, unit, name, names)
        if factor != 1.0:
            notes.append(f"The elevations of {name} were converted from {own} to {unit}.")
        factors.append(factor)
    return Reference(crs, unit, tuple(notes), tuple(factors))


def _require_one_crs(first: Referenced, its_name: str, other: Referenced, name: str) -> None:
    one, two = first.crs, other.crs
    if one is None and two is None:
        return
    if one is None or two is None:
        known, unknown = (its_name, name) if two is None else (name, its_name)
        crs = one or two
        raise CrsError(
            f"{_begin_sentence(known)} is in {crs.label if crs else ''} and the CRS of {unknown} "
            "is not known: give that of both, for coordinates are never mixed on a guess.",
            crs=crs,
        )
    if not one.horizontal.is_same(two.horizontal):
        raise CrsError(
            f"{_begin_sentence(its_name)} is in {one.label} and {name} in {two.label}: bring the "
            "points of one into the CRS of the other and build the surface from them, for "
            "triangles that are moved make another surface.",
            crs=two,
        )


def _agree_on_datum(named: Sequence[tuple[Referenced, str]]) -> list[str]:
    """Refuse elevations that refer to different vertical CRSs, and tell which is assumed."""
    known = [(one.crs, name) for one, name in named if one.crs is not None]
    stated = [(crs, name) for crs, name in known if crs.vertical_unit is not None]
    for crs, name in stated[1:]:
        if not crs.is_same(stated[0][0]):
            raise CrsError(
                f"The elevations of {stated[0][1]} are those of {stated[0][0].label}, of {name} "
                f"those of {crs.label}: both must refer to one vertical CRS.",
                crs=crs,
            )
    return [
        f"The vertical CRS of {name} is not known: taken to be that of {stated[0][0].label}."
        for crs, name in known
        if stated and crs.vertical_unit is None
    ]


def _convert(
    surface: Referenced, own: Unit | None, unit: Unit, name: str, names: Sequence[str]
) -> float:
    """Return the factor from one unit that is known to another one."""
    if surface.elevation_unit is None:
        usual = "" if own is None else f", and {own.name} is usual in the CRS"
        others = " and ".join(one for one in names if one != name)
        raise CrsError(
            f"The unit of the elevations of {name} is not known{usual}, and there are elevations "
            f"in {unit.name} ({others}): give the units of both, for elevations are never mixed on "
            "a guess.",
            crs=surface.crs,
        )
    if own is None or own.metres is None or unit.metres is None:
        raise CrsError(
            f"Elevations in {own} and in {unit} cannot be compared: the length of a unit is not "
            "known.",
            crs=surface.crs,
        )
    return own.metres / unit.metres


# ---------------------------------------------------------------- what is laid on a surface


def require_same_crs(
    theirs: CRS | None, crs: CRS | None, what: str, *, is_plain: bool = False
) -> tuple[str, ...]:
    """Refuse what is in another CRS than the surface, and tell what was assumed.

    ``what`` is what it is called in sentences: "the lines". Plain coordinates cannot name a CRS:
    they are in that of the surface. Raises CrsError if the CRSs differ in the plane, or that of the
    surface is not known.
    """
    if theirs is None:
        if crs is None or is_plain:
            return ()
        return (f"The CRS of {what} is not known: taken to be that of the surface, {crs.label}.",)
    if crs is None:
        raise CrsError(
            f"The CRS of {what} is {theirs.label} and that of the surface is not known: give that "
            "of the surface, for coordinates are never mixed on a guess.",
            crs=theirs,
        )
    if not theirs.horizontal.is_same(crs.horizontal):
        raise CrsError(
            f"The CRS of {what} is {theirs.label}, that of the surface {crs.label}: they must be "
            "the same; reproject one of them first.",
            crs=theirs,
        )
    return ()


def _begin_sentence(text: str) -> str:
    return text[:1].upper() + text[1:]
