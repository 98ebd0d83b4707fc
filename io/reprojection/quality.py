"""How good a transformation is that PROJ can do here, and whether a file kept its CRS."""

from __future__ import annotations

import warnings
from functools import lru_cache
from typing import TYPE_CHECKING, Any, NamedTuple

from ...base.crs import CRS
from ...base.errors import CrsError, WriteError
from ...base.notes import warn
from ...base.sentences import FILE

if TYPE_CHECKING:
    from ...base.crs import CRS

_MOST_NAMES = 2


class Quality(NamedTuple):
    """What the operation that was used leaves undone."""

    keeps_datum: bool = False
    """Whether elevations went over unchanged although their datums differ."""
    note: str | None = None
    """What is to be told of the places in the plane."""


def judge(source: CRS, target: CRS, transformer: Any) -> Quality:
    """Say how good the operation is that a transformer has just used.

    Notes
    -----
    PROJ chooses among the operations whose grids are there, by place and accuracy. It calls one
    "ballpark" that leaves a change of datum out.
    """
    from pyproj.exceptions import ProjError

    try:
        used = transformer.get_last_used_operation()
    except (ProjError, AttributeError):
        used = transformer
    text = str(used.description).lower()
    keeps_datum = "ballpark vertical" in text
    names = f"from {source.label} to {target.label}"
    if "ballpark geographic" in text:
        return Quality(
            keeps_datum,
            f"PROJ knows no transformation {names} without grids{_name_missing(source, target)}: "
            "the datum was left out, and places may be wrong by metres, up to some hundred.",
        )
    missing = _name_missing(source, target)
    if not missing or keeps_datum:
        return Quality(keeps_datum)
    accuracy = float(used.accuracy)
    within = f"within {accuracy:g} m" if accuracy >= 0 else "of an accuracy that is not known"
    return Quality(
        keeps_datum,
        f"The best transformation {names} needs grids that are not here{missing}: one {within} "
        "was used.",
    )


def describe_missing_grids(source: CRS, target: CRS) -> str:
    """Return the grids that PROJ would need, for a sentence; empty if it needs none."""
    return _name_missing(source, target)


@lru_cache(maxsize=64)
def _name_missing(source: CRS, target: CRS) -> str:
    from pyproj.transformer import TransformerGroup

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # it tells what is asked here
        group = TransformerGroup(source.to_pyproj(), target.to_pyproj(), always_xy=True)
    if group.best_available:
        return ""
    grids = dict.fromkeys(
        grid.short_name
        for operation in group.unavailable_operations[:_MOST_NAMES]
        for grid in operation.grids
        if not grid.available
    )
    return f" ({', '.join(grids)})" if grids else ""


def require_kept(crs: CRS | None, found: str | None) -> None:
    """Compare a CRS with the one that was read back.

    Parameters
    ----------
    crs : CRS or None
        As it was written.
    found : str or None
        WKT as GDAL reads it back.

    Warns
    -----
    LossWarning
        If it is another CRS with the same units.
    """
    if crs is None:
        return
    try:
        kept = CRS.of(found or None)
    except CrsError:
        kept = None
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


def _find_units(crs: CRS) -> tuple[object, object]:
    return crs.horizontal_unit, crs.vertical_unit
