"""What the coordinates of a drawing are measured in: units and CRS, from the file and the caller.

Coordinates are in the unit of the CRS, whatever the file's; elevations keep their own. Where the
file contradicts itself or its CRS, two readings are plausible, and the caller has to choose.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...base.crs import CRS, Unit
from ...base.errors import CrsError, OptionError, ReadError
from ...base.sentences import FILE
from ...tin.screening import AreaOfUse
from ..reprojection import settle_unit

if TYPE_CHECKING:
    from ...base.arrays import Float64Array
    from ...base.crs import CrsLike, UnitLike


class Stated(NamedTuple):
    """What a file says."""

    crs: CRS | None = None
    unit: Unit | None = None
    """Of all lengths."""
    elevation_unit: Unit | None = None
    """Of elevations, where the file tells it apart from other lengths."""
    is_elevation_unknown: bool = False
    """The file says that the unit of elevations is not known."""
    what: str = "the file"
    """Where it says the unit, for sentences."""


class Declared(NamedTuple):
    """What the caller says: the CRS wanted, the unit of lengths, and that of elevations."""

    crs: CRS | None = None
    unit: Unit | None = None
    elevation_unit: Unit | None = None

    @classmethod
    def of(
        cls, crs: CrsLike | None, unit: UnitLike | None, elevation_unit: UnitLike | None
    ) -> Declared:
        """Return it of whatever names a CRS and units."""
        return cls(CRS.of(crs), Unit.of(unit), Unit.of(elevation_unit))


@dataclass(frozen=True, slots=True)
class Measures:
    """How coordinates of a file become those of a survey."""

    source: CRS | None
    """CRS of the coordinates."""
    elevation_unit: Unit | None
    scale: float = 1.0
    """From the file's eastings and northings to those of the CRS."""
    elevation_scale: float = 1.0
    is_swapped: bool = False
    """Whether the first of two coordinates is the other one than the format says."""
    notes: tuple[str, ...] = ()

    def noting(self, *notes: str, first: bool = False, **changes: Any) -> Measures:
        """Return them with further notes, at the end or first, and other changes."""
        noted = (*notes, *self.notes) if first else (*self.notes, *notes)
        return replace(self, notes=noted, **changes)

    def apply(self, rows: Float64Array) -> Float64Array:
        """Return easting, northing and, where there is one, elevation as they are wanted."""
        if self.scale == 1.0 and self.elevation_scale == 1.0 and not self.is_swapped:
            return rows
        rows = rows[:, [1, 0, *range(2, rows.shape[1])]] if self.is_swapped else rows.copy()
        with np.errstate(over="ignore"):  # what becomes infinite is refused later
            rows[:, :2] *= self.scale
            rows[:, 2:] *= self.elevation_scale
        return rows


def require_own_crs(stated: Stated, declared: Declared) -> None:
    """Refuse to reproject an alignment.

    Raises CrsError if the caller names another CRS than the file.
    """
    own, wanted = stated.crs, declared.crs
    if own is not None and wanted is not None and not own.horizontal.is_same(wanted.horizontal):
        raise CrsError(
            f"{FILE} is in {own.label}, and {wanted.label} is another CRS: an alignment is not "
            "reprojected, since its arcs would be no arcs there.",
            crs=wanted,
        )


def choose_measures(stated: Stated, declared: Declared, *, sample: Float64Array) -> Measures:
    """Decide what coordinates and elevations are measured in.

    Parameters
    ----------
    stated : Stated
    declared : Declared
    sample : (n, 2) float64 array
        Easting and northing of some points, as in the file, to be looked for in the area of the
        CRS; may be empty.

    Raises
    ------
    ReadError
        If the unit of the file is not that of its CRS, and none is declared.
    OptionError
        If a unit is declared that neither the file nor the CRS has.
    """
    source = stated.crs or declared.crs
    unit = declared.unit or stated.unit
    measures = Measures(source, _choose_elevation_unit(stated, declared, unit))
    along = None if source is None or source.is_geographic else source.horizontal_unit
    if along is not None and along.metres is not None:
        _require_agreement(stated, declared, along, source)
        if unit is not None and unit.metres is not None and unit != along:
            measures = measures.noting(
                f"Coordinates were converted from {unit.name} to {along.name}, the unit of the "
                "CRS.",
                scale=unit.metres / along.metres,
            )
    elif source is None and unit is not None:
        measures = _convert_elevations(measures, unit, "the unit of the coordinates")
    if source is None:
        return measures
    vertical = source.vertical_unit
    if vertical is not None:
        measures = _convert_elevations(
            measures, vertical, "the unit of the vertical axis of the CRS"
        )
        measures = replace(measures, elevation_unit=vertical)
    # Compare coordinates with the area of use; swap them if they only fit so.
    area = AreaOfUse.of(measures.source, declared.crs)
    rows = sample[np.isfinite(sample).all(axis=1)] * measures.scale
    if area is None or len(rows) == 0 or area.covers_most(rows):
        return measures
    if area.covers_most(rows[:, ::-1]):
        return measures.noting(
            "Easting and northing were taken in the other order than the format says: only so do "
            f"they lie in the area of {area.label}.",
            is_swapped=True,
        )
    if area.is_local(rows):
        return measures
    return measures.noting(f"Most points lie outside the area of {area.label}.")


def _choose_elevation_unit(stated: Stated, declared: Declared, unit: Unit | None) -> Unit | None:
    if declared.elevation_unit is not None:
        known = None if declared.unit is not None else stated.elevation_unit or stated.unit
        if stated.elevation_unit is not None and stated.elevation_unit != stated.unit:
            known = None  # the file contradicts itself, and the caller knows better
        return settle_unit(declared.elevation_unit, known)
    if stated.is_elevation_unknown and declared.unit is None:
        return None
    different = stated.elevation_unit not in (None, stated.unit)
    if different and declared.unit is None and stated.elevation_unit and stated.unit:
        raise ReadError(
            f"{FILE} gives {stated.unit.name} for lengths and {stated.elevation_unit.name} for "
            "elevations, which may stand for those of attributes only: declare the unit of the "
            f"elevations, `elevation_unit='{stated.unit.name}'` or "
            f"`elevation_unit='{stated.elevation_unit.name}'`."
        )
    return unit


def _require_agreement(stated: Stated, declared: Declared, along: Unit, source: CRS | None) -> None:
    """Refuse a file whose unit is not that of its CRS, until the caller tells which is right."""
    unit, label = stated.unit, "" if source is None else source.label
    if declared.unit is not None:
        if unit is not None and declared.unit not in (unit, along):
            allowed = f"{unit.name}, as {FILE} says, or {along.name}, the unit of {label}"
            raise OptionError("unit", declared.unit.name, allowed)
        return
    if unit is not None and unit != along:
        raise ReadError(
            f"{stated.what} says that coordinates are in {unit.name}, and {label} "
            f"measures in {along.name}: tell which is right, `unit='{unit.name}'` or "
            f"`unit='{along.name}'`."
        )


def _convert_elevations(measures: Measures, unit: Unit, what: str) -> Measures:
    """Bring elevations to another unit; nothing else tells that of eastings without a CRS."""
    known = measures.elevation_unit
    if known is None or known == unit or known.metres is None or unit.metres is None:
        return measures
    return measures.noting(
        f"Elevations were converted from {known.name} to {unit.name}, {what}.",
        elevation_scale=known.metres / unit.metres,
        elevation_unit=unit,
    )
