"""The CRS that points and lines bring along: taken from them, and refused where they differ."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from ...base.crs import CRS
from ...base.errors import CrsError
from ..validation import is_plain

if TYPE_CHECKING:
    from collections.abc import Iterator


def adds_to(own: CRS, crs: CRS) -> bool:
    """Whether a CRS is the same as another, or that with a vertical axis."""
    return own.is_same(crs) or (own.vertical_unit is None and own.is_same(crs.horizontal))


def find_crs(given: Any) -> CRS | None:
    """Return the CRS that a value says it is in, such as a GeoSeries; None if it says none.

    Examples
    --------
    >>> import tinsmith as ts
    >>> find_crs(ts.Features.of_points([[0, 0]], crs="EPSG:32616"))
    CRS('EPSG:32616')
    """
    found = None if is_plain(given) else getattr(given, "crs", None)
    is_one = isinstance(found, CRS) or hasattr(found, "to_wkt")
    return CRS.of(found) if is_one else None


def require_crs(given: Any, crs: CRS | None, what: str) -> None:
    """Refuse what says that it is in another CRS than one that is known."""
    found = find_crs(given)
    if found is None or crs is None or adds_to(found, crs) or adds_to(crs, found):
        return
    raise CrsError(
        f"The {what} are in {found.label}, and {crs.label} is another CRS: they must be "
        "reprojected first.",
        crs=found,
    )


def settle_crs(crs: CRS | None, given: Mapping[str, Any]) -> tuple[CRS | None, list[str]]:
    """Return the CRS of points and lines together, and a note if only lines tell it.

    ``crs`` is the one that is known already, ``given`` has points first, then lines of each kind,
    by what they are called. Raises CrsError if one of them is in another.
    """
    notes = []
    for what, things in given.items():
        for one in _list_things(things):
            require_crs(one, crs, what)
            found = find_crs(one) if crs is None else None
            if found is not None:
                crs = found
                if what != "points":
                    notes.append(f"The CRS, {found.label}, is that of the {what}.")
    return crs, notes


def _list_things(things: Any) -> Iterator[Any]:
    """Walk a value and, if it is a list, what is in it."""
    if isinstance(things, list | tuple):
        yield from (one for one in things if hasattr(one, "crs"))
    else:
        yield things
