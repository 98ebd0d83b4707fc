"""Surfaces: one TIN or several that are cut along the same lines, in one CRS and one unit."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

from ..._sentences import shown
from ...crs import CRS, Unit, assume_elevation_unit
from ...errors import CrsError, OptionError
from ...tin.validation.options import require_tin

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ...tin import TIN

__all__ = ["Surfaces", "as_surfaces"]

_ALLOWED = "a TIN, a sequence of TINs, or a mapping of names to TINs"


class Surfaces(NamedTuple):
    """TINs with names, and how their elevations become those of one unit.

    Attributes
    ----------
    names : tuple of str
        The one name of a TIN given by itself is empty.
    tins : tuple of TIN
    factors : tuple of float
        From each TIN's elevations to ``elevation_unit``.
    crs : CRS or None
    elevation_unit : Unit or None
    notes : tuple of str
        What had to be assumed or converted.
    """

    names: tuple[str, ...]
    tins: tuple[TIN, ...]
    factors: tuple[float, ...]
    crs: CRS | None
    elevation_unit: Unit | None
    notes: tuple[str, ...]

    def column(self, name: str, k: int) -> str:
        """Return what the column of surface ``k`` is called."""
        return f"{name}_{self.names[k]}" if self.names[k] else name


def as_surfaces(given: Any) -> Surfaces:
    """Return one TIN or several as surfaces of one CRS and one unit of elevations.

    Parameters
    ----------
    given : TIN, sequence of TIN, or mapping of str to TIN
        In a sequence they are called 1, 2, ...

    Raises
    ------
    OptionError
        If there is none, or a name is no printable text.
    PointsError
        If one is no TIN.
    CrsError
        If CRSs differ, or a unit of elevations is not known while another one is usual in the CRS
        than the one that is known.
    """
    names, tins = _named(given)
    for tin in tins:
        require_tin(tin)
    crs, notes = _one_crs(names, tins)
    unit, factors, more = _one_unit(names, tins, crs)
    return Surfaces(names, tins, factors, crs, unit, (*notes, *more))


def _named(given: Any) -> tuple[tuple[str, ...], tuple[TIN, ...]]:
    if isinstance(given, Mapping):
        names = tuple(given)
        for name in names:
            if not (isinstance(name, str) and name.strip() and name.isprintable()):
                raise OptionError("name of a surface", name, allowed="a printable text")
        tins = tuple(given.values())
    elif isinstance(given, Iterable) and not isinstance(given, str | bytes):
        tins = tuple(given)
        names = tuple(str(number + 1) for number in range(len(tins)))
    else:
        names, tins = ("",), (given,)
    if not tins:
        raise OptionError("surfaces", [], allowed=_ALLOWED)
    return names, tins


def _one_crs(names: Sequence[str], tins: Sequence[TIN]) -> tuple[CRS | None, list[str]]:
    known = next((tin.crs for tin in tins if tin.crs is not None), None)
    notes = []
    for name, tin in zip(names, tins, strict=True):
        if known is None:
            break
        if tin.crs is None:
            notes.append(f"The surface '{name}' names no CRS: taken as {known.label}.")
        elif not _is_same(tin.crs, known):
            raise CrsError(
                f"The surface '{name}' is in {tin.crs.label} and another in {known.label}: "
                "reproject one of them first.",
                crs=tin.crs,
            )
    return known, notes


def _is_same(one: CRS, other: CRS) -> bool:
    """Whether both are the same in the plane, and above it if both tell of elevations."""
    if one.vertical_unit is not None and other.vertical_unit is not None:
        return one.is_same(other)
    return one.horizontal.is_same(other.horizontal)


def _one_unit(
    names: Sequence[str], tins: Sequence[TIN], crs: CRS | None
) -> tuple[Unit | None, tuple[float, ...], list[str]]:
    """Take the first unit that is known for all, and convert those that differ."""
    known = next((tin.elevation_unit for tin in tins if tin.elevation_unit is not None), None)
    factors, notes = [], []
    for name, tin in zip(names, tins, strict=True):
        factor, note = 1.0, ""
        if known is not None and tin.elevation_unit is None:
            note = _assume(name, known, crs)
        elif known is not None and tin.elevation_unit is not None and tin.elevation_unit != known:
            factor = _metres(tin.elevation_unit) / _metres(known)
            note = (
                f"The elevations of '{name}' were converted from {tin.elevation_unit.name} to "
                f"{known.name}."
            )
        factors.append(factor)
        notes += [note] if note else []
    return known, tuple(factors), notes


def _metres(unit: Unit) -> float:
    return 1.0 if unit.metres is None else unit.metres


def _assume(name: str, known: Unit, crs: CRS | None) -> str:
    """Take an unknown unit to be the known one, unless another one is usual in the CRS."""
    usual = assume_elevation_unit(crs, None)
    if usual is not None and usual != known:
        raise CrsError(
            f"The unit of the elevations of '{name}' is not known: another surface has "
            f"{known.name}, and {usual.name} is usual in the CRS; declare it "
            f"(z_unit={shown(known.name)}).",
            crs=crs,
        )
    return f"The unit of the elevations of '{name}' is not known: taken as {known.name}."
