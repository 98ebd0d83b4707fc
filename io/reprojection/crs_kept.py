"""Whether a file kept the CRS that was written to it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...base.crs import CRS
from ...base.errors import CrsError, WriteError
from ...base.notes import warn
from ...base.sentences import FILE

if TYPE_CHECKING:
    pass

__all__ = ["require_kept"]


def require_kept(crs: CRS | None, found: str | None) -> None:
    """Compare a CRS with the one that was read back.

    Parameters
    ----------
    crs : CRS or None
        As it was written.
    found : str or None
        WKT as GDAL reads it back.

    Raises
    ------
    WriteError
        If a unit has changed, or nothing is left of the CRS.

    Warns
    -----
    LossWarning
        If it is another CRS with the same units.
    """
    if crs is None:
        return
    kept = _parse(found)
    if kept is None or _find_units(kept) != _find_units(crs):
        raise WriteError(
            f"Cannot write {FILE}: the format does not keep the CRS {crs.label}, it would be "
            f"{'none' if kept is None else kept.name}; name its horizontal part alone.",
        )
    if not kept.to_pyproj().equals(crs.to_pyproj(), ignore_axis_order=True):
        warn(
            f"{FILE} has the CRS as the format can describe it, '{kept.name}', which PROJ does "
            f"not take for the same as {crs.label}."
        )


def _parse(found: str | None) -> CRS | None:
    try:
        return CRS.of(found or None)
    except CrsError:
        return None


def _find_units(crs: CRS) -> tuple[object, object]:
    return crs.horizontal_unit, crs.vertical_unit
