"""In which units areas and volumes come, and whether two surfaces can be compared at all."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ...crs import assume_elevation_unit, scale_elevations
from ...errors import CrsError, PointsError
from ...tin.validation.options import require_tin

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ...crs import CRS, Unit
    from ...tin import TIN

__all__ = ["Reference", "Surface", "reference_of", "require_finite", "surfaces_of"]

_POWERS = {2: "²", 3: "³"}


@dataclass(frozen=True, slots=True)
class Reference:
    """Units of what is measured on a surface.

    Attributes
    ----------
    crs : CRS or None
    elevation_unit : Unit or None
        The one that elevations are taken to have.
    up : float
        Factor from elevations to the unit of eastings.
    notes : tuple of str
        What was assumed.
    """

    crs: CRS | None
    elevation_unit: Unit | None
    up: float
    notes: tuple[str, ...]

    def power(self, exponent: int) -> str | None:
        """Return the symbol of an area (2) or a volume (3); None if the unit is not known."""
        unit = None if self.crs is None else self.crs.horizontal_unit
        if unit is None or unit.metres is None:
            return None
        return f"{unit.symbol}{_POWERS[exponent]}"


@dataclass(frozen=True, slots=True, eq=False)
class Surface:
    """Triangles of a surface, or pieces of them.

    Attributes
    ----------
    points : (n, 3) float64 array
    triangles : (m, 3) int32 array
        Counter-clockwise.
    """

    points: NDArray[np.float64]
    triangles: NDArray[np.int32]


def reference_of(tin: TIN, purpose: str) -> Reference:
    """Read the units of a TIN.

    Raises
    ------
    CrsError
        If coordinates are angles.
    """
    require_tin(tin)
    crs = tin.crs
    if crs is not None and crs.is_geographic:
        raise CrsError(
            f"{purpose} cannot be measured in degrees, and the TIN is in {crs.label}: build it in "
            "a projected CRS, such as UTM.",
            crs=crs,
        )
    unit = assume_elevation_unit(crs, tin.elevation_unit)
    up = scale_elevations(crs, tin.elevation_unit)
    return Reference(crs, unit, up, tuple(_notes(crs, tin.elevation_unit, unit)))


def _notes(crs: CRS | None, known: Unit | None, assumed: Unit | None) -> list[str]:
    if crs is None:
        return ["The CRS is not known: lengths are in its own unit, elevations taken as the same."]
    if known is not None:
        return []
    if assumed is None:
        return ["The unit of elevations is not known: taken to be that of the eastings."]
    return [f"The unit of elevations is not known: taken to be the {assumed.name}."]


def surfaces_of(tin: TIN, other: TIN) -> tuple[Surface, Surface, list[str]]:
    """Return two surfaces in the units of the first, and what is to be told of that.

    Raises
    ------
    CrsError
        If their CRSs differ, or only one of them is known, or if it cannot be told whether their
        elevations are in one unit.
    """
    require_tin(tin)
    require_tin(other)
    _require_one_crs(tin.crs, other.crs)
    notes = _datum_notes(tin.crs, other.crs)
    ours = assume_elevation_unit(tin.crs, tin.elevation_unit)
    theirs = assume_elevation_unit(other.crs, other.elevation_unit)
    points = other.triangulation.points
    if ours != theirs:
        if tin.elevation_unit is None or other.elevation_unit is None:
            raise CrsError(_unlike_units(tin, other), crs=tin.crs)
        factor = _quotient(theirs, ours)
        points = np.column_stack([points[:, :2], points[:, 2] * factor])
        notes.append(f"Elevations of the other surface were converted from {theirs} to {ours}.")
    first = tin.triangulation
    return (
        Surface(first.points, first.triangles),
        Surface(np.ascontiguousarray(points), other.triangulation.triangles),
        notes,
    )


def _quotient(unit: Unit | None, other: Unit | None) -> float:
    metres = [one.metres for one in (unit, other) if one is not None and one.metres is not None]
    return metres[0] / metres[1]  # both are known, and units of elevations are lengths


def _unlike_units(tin: TIN, other: TIN) -> str:
    names = [
        "an unknown unit" if one.elevation_unit is None else str(one.elevation_unit)
        for one in (tin, other)
    ]
    return (
        f"The elevations of one surface are in {names[0]}, those of the other in {names[1]}: give "
        "the units of both, for elevations are never mixed on a guess."
    )


def _require_one_crs(crs: CRS | None, other: CRS | None) -> None:
    if crs is None and other is None:
        return
    if crs is None or other is None:
        known = crs or other
        assert known is not None
        raise CrsError(
            f"One surface is in {known.label} and the CRS of the other is not known: give that of "
            "both, for coordinates are never mixed on a guess.",
            crs=known,
        )
    if not crs.horizontal.is_same(other.horizontal):
        raise CrsError(
            f"One surface is in {crs.label} and the other in {other.label}: bring the points of "
            "one into the CRS of the other and build it again, for a surface that is moved into "
            "another CRS is another surface.",
            crs=other,
        )
    if crs.vertical_unit is not None and other.vertical_unit is not None and not crs.is_same(other):
        raise CrsError(
            f"The elevations of one surface are those of {crs.label}, of the other those of "
            f"{other.label}: both must refer to one vertical CRS.",
            crs=other,
        )


def _datum_notes(crs: CRS | None, other: CRS | None) -> list[str]:
    named = [one for one in (crs, other) if one is not None and one.vertical_unit is not None]
    if len(named) != 1:
        return []
    return [
        f"Only one surface names the vertical CRS of its elevations ({named[0].label}): taken to "
        "be that of both."
    ]


def require_finite(values: NDArray[np.float64]) -> None:
    """Refuse sums that double precision cannot hold.

    Raises
    ------
    PointsError
    """
    if np.isnan(values).any():
        raise PointsError(
            "Coordinates or elevations are too large for volumes in double precision: their "
            "products must stay below 1e308."
        )
