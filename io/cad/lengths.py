"""The one unit of length that a drawing has: that of coordinates, to which elevations come too."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...base.crs import Unit
from ...base.errors import CrsError, OptionError, WriteError
from ...base.notes import warn
from ...base.sentences import FILE

if TYPE_CHECKING:
    from collections.abc import Callable

    from ...base.crs import UnitLike
    from ...base.results import Features
    from ...tin import TIN, Survey

__all__ = ["choose_length_unit"]


def choose_length_unit(
    obj: TIN | Survey | Features,
    unit: UnitLike | None,
    *,
    is_known: Callable[[Unit], bool],
    format_name: str,
) -> tuple[Unit | None, float]:
    """Return the unit of all lengths in a file, and the factor that brings elevations to it.

    Parameters
    ----------
    obj : TIN, Survey or Features
    unit : Unit or str, optional
        Declared by the caller, where the CRS does not tell.
    is_known : callable
        Whether the format has a unit.
    format_name : str

    Raises
    ------
    CrsError
        If coordinates are angles.
    OptionError
        If the unit declared is not that of the CRS.
    WriteError
        If the format does not have the unit.

    Warns
    -----
    LossWarning
        If the unit is not known, or elevations are converted.
    """
    declared = Unit.of(unit)
    chosen = declared or obj.elevation_unit
    if obj.crs is not None:
        if obj.crs.is_geographic:
            raise CrsError(
                f"Cannot write {FILE}: {format_name} holds lengths, and {obj.crs.label} measures "
                "in degrees: reproject first.",
                crs=obj.crs,
            )
        chosen = obj.crs.horizontal_unit
        if declared is not None and declared != chosen:
            raise OptionError("unit", declared.name, f"{chosen.name}, the unit of {obj.crs.label}")
    if chosen is not None and not is_known(chosen):
        raise WriteError(
            f"Cannot write {FILE}: {format_name} has no unit {chosen.name}; it has metre, foot, "
            "US survey foot and their like."
        )
    return chosen, _find_factor(obj.elevation_unit, chosen, format_name)


def _find_factor(known: Unit | None, unit: Unit | None, format_name: str) -> float:
    if unit is None:
        warn(
            f"{FILE} has no units, since none are known: programs that read it will guess; the "
            "option `unit` names one."
        )
        return 1.0
    if known is None or known == unit or known.metres is None or unit.metres is None:
        return 1.0
    warn(
        f"{FILE}: elevations were converted from {known.name} to {unit.name}, as {format_name} "
        "has one unit for all lengths."
    )
    return known.metres / unit.metres
