"""What the bands of a raster hold by what the file says: elevations, depths, or something else."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from ...crs import CRS, Unit
from ...errors import OptionError, ReadError
from ..reprojection.contradictions import look_at_units

if TYPE_CHECKING:
    from collections.abc import Sequence

    from .dem import Header

__all__ = ["describe_band", "find_default_band", "look_at_axes"]

_OTHER = re.compile(
    r"uncertaint|error|std|stdev|deviation|sigma|variance|rmse|accurac|precision|confidence"
    r"|qualit|count|density|number|weight|mask|flag|class|slope|aspect|hillshade|shade|curvature"
    r"|roughness|intensity|amplitude|backscatter|source|age\b|date|time",
    re.IGNORECASE,
)
"""Words of descriptions for what is no elevation."""

_ELEVATION = re.compile(
    r"elev|height|altitude|depth|bathym|topo|terrain|\bz\b|dem|dtm|dsm", re.IGNORECASE
)
_SHOWN = 5


def describe_band(dataset: Header, band: int, *, is_told: bool) -> list[str]:
    """Tell of depths, whose sign is changed, and of bands that are not read.

    Parameters
    ----------
    dataset : Header
    band : int
    is_told : bool
        Whether the caller has named the band.

    Raises
    ------
    ReadError
        If the caller has not, and the band is described as something else than elevations, or is
        one of a series.
    """
    notes = []
    if any(dataset.depths[band - 1 : band]):
        notes.append(f"Depths of band {band} grow downwards: their sign was changed.")
    if is_told or dataset.count == 1:
        return notes
    _require_no_series(dataset)
    if not any(dataset.descriptions):
        return notes
    text = dataset.descriptions[band - 1]
    if _OTHER.search(text) and not _ELEVATION.search(text):
        raise ReadError(
            f"'{dataset.path}': band {band} is described as '{text[:40]}', of the bands "
            f"{_list_bands(dataset)}: name the one that holds elevations with the option band.",
            path=dataset.path,
        )
    return [*notes, f"Of {dataset.count} bands number {band} is read: {_list_bands(dataset)}."]


def find_default_band(descriptions: Sequence[str]) -> int:
    """Return the number of the only band that is described as elevations, else of the first."""
    found = [number for number, text in enumerate(descriptions, start=1) if _is_elevation(text)]
    return found[0] if len(found) == 1 else 1


def _is_elevation(text: str) -> bool:
    return bool(_ELEVATION.search(text)) and not _OTHER.search(text)


def _list_bands(dataset: Header) -> str:
    shown = [
        f"{number} '{text[:40]}'" if text else f"{number} (not described)"
        for number, text in enumerate(dataset.descriptions[:_SHOWN], start=1)
    ]
    more = f" and {dataset.count - _SHOWN} more" if dataset.count > _SHOWN else ""
    return ", ".join(shown) + more


def _require_no_series(dataset: Header) -> None:
    places = dataset.series
    if not any(places):
        return
    raise ReadError(
        f"'{dataset.path}' is a series of {dataset.count} rasters (band 1: {places[0]}; band "
        f"{dataset.count}: {places[-1]}): choose one of them with the option band.",
        path=dataset.path,
    )


def look_at_axes(dataset: Header, source: CRS | None, target: CRS | None) -> tuple[str, ...]:
    """Compare the units of the axes with those of the CRS declared for them.

    Raises
    ------
    CrsError
        If they differ.
    """
    if source is not None or target is None or not dataset.axis_units:
        return ()
    x, y = dataset.axis_units
    try:
        measured = tuple(None if "degree" in one.lower() else Unit.of(one) for one in (x, y))
    except OptionError:
        return ()
    return look_at_units((x, y), measured, target, dataset.path)
