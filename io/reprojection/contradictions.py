"""Coordinates that contradict their CRS: refused, unless the caller asks to take them as they are.

Every reader brings its points to their place by :func:`tinsmith.io.reprojection.placement.place`,
or makes a TIN of them where they are; both look here.
"""

from __future__ import annotations

from contextlib import contextmanager
from contextvars import ContextVar
from typing import TYPE_CHECKING

import numpy as np

from ...base.checks import as_flag
from ...base.errors import CrsError
from ...base.georeference.axes import gives_northing_first
from ...base.sentences import coordinate, counted
from ...tin.screening.area_of_use import AreaOfUse

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ...base.arrays import Float64Array
    from ...base.crs import CRS

__all__ = [
    "are_small_degrees",
    "checking_crs",
    "look_at_crs",
    "look_at_degrees",
    "look_at_order",
    "look_at_place",
    "refuse",
]

_MOST_DEGREES = (360.0, 90.0)
_WIDEST = 3.0
"""Degrees that a site spans at most; as many metres are none."""

_IS_CHECKED: ContextVar[bool] = ContextVar("is_checked", default=True)


@contextmanager
def checking_crs(is_checked: bool) -> Iterator[None]:
    """Refuse what contradicts its CRS in this block, or tell it only, as in a block around it.

    Raises
    ------
    OptionError
        If it is neither True nor False.
    """
    is_checked = as_flag("check_crs", is_checked)
    token = _IS_CHECKED.set(is_checked and _IS_CHECKED.get())
    try:
        yield
    finally:
        _IS_CHECKED.reset(token)


def refuse(sentence: str, crs: CRS | None = None) -> str:
    """Refuse a contradiction; return it as a note where the caller wants no refusal.

    Raises
    ------
    CrsError
    """
    if not _IS_CHECKED.get():
        return f"{sentence}."
    raise CrsError(f"{sentence}; `check_crs=False` takes them as they are.", crs=crs)


def look_at_crs(
    points: Float64Array, crs: CRS | None, *, is_declared: bool = False
) -> tuple[str, ...]:
    """Compare points, (n, 3), that stay where they are with their CRS.

    ``is_declared`` tells that the caller names it and the file does not.

    Raises
    ------
    CrsError
        As :func:`look_at_degrees` and :func:`look_at_place`.
    """
    order = look_at_order(points, crs) if is_declared else ()
    return (*look_at_degrees(points, crs), *look_at_place(points, crs, None), *order)


def look_at_order(points: Float64Array, crs: CRS | None) -> tuple[str, ...]:
    """Tell where a CRS that the file does not name leaves open which coordinate comes first.

    It names the northing first, and the points, (n, 3), lie in its area of use in either order.
    """
    area = AreaOfUse.of(crs, crs)
    if crs is None or area is None or not gives_northing_first(crs):
        return ()
    if not all(area.covers_whole(points[:, order]) for order in ([0, 1], [1, 0])):
        return ()
    names = ("latitude", "longitude") if crs.is_geographic else ("northing", "easting")
    return (
        f"The file names no CRS, and {crs.label} gives the {names[0]} before the {names[1]}: the "
        f"first coordinate was taken as the {names[1]}, and in the other order the points would "
        "lie in its area of use, too.",
    )


def look_at_place(points: Float64Array, source: CRS | None, target: CRS | None) -> tuple[str, ...]:
    """Tell how many points lie outside the areas of use.

    Parameters
    ----------
    points : (n, 3) float64 array
        As they are in the file.
    source, target : CRS or None
        Of the file, and the one that is wanted.

    Raises
    ------
    CrsError
        If most do, and with easting and northing exchanged most would not.
    """
    area = AreaOfUse.of(source, target)
    is_moved = source is not None and target is not None and not source.is_same(target)
    if area is None or (not is_moved and area.is_local(points[:, :2])):
        return ()
    outside = area.find_outside(points[:, :2])
    if len(outside) == 0:
        return ()
    lie = "lies" if len(outside) == 1 else "lie"
    sentence = (
        f"{len(outside):,} of {counted(len(points), 'point')} {lie} outside the area of use of "
        f"{area.label}"
    )
    if not area.covers_most(points[outside][:, [1, 0]]):
        return (f"{sentence}: check that the CRS is the right one.",)
    exchanged = f"{sentence} and, with easting and northing exchanged, inside"
    if 2 * len(outside) > len(points):
        return (refuse(f"{exchanged}: the coordinates are in the other order", area.source),)
    return (f"{exchanged}: check the order of the coordinates.",)


def are_small_degrees(points: Float64Array, crs: CRS) -> bool:
    """Whether points of no CRS, (n, 3), are a site as degrees in the area of a projected CRS only.

    As lengths they are a few units apart and lie about its origin, outside the area.
    """
    if crs.is_geographic or len(points) == 0 or not _IS_CHECKED.get():
        return False
    xy = points[:, :2]
    if (np.abs(xy).max(axis=0) > _MOST_DEGREES).any() or np.ptp(xy, axis=0).max() > _WIDEST:
        return False
    area = AreaOfUse.of(crs, crs)
    return area is not None and area.is_local(xy) and area.covers_as_degrees(xy)


def look_at_degrees(points: Float64Array, crs: CRS | None) -> tuple[str, ...]:
    """Look for longitudes and latitudes under a CRS that measures in lengths.

    Parameters
    ----------
    points : (n, 3) float64 array
        As they are in the file.
    crs : CRS or None
        Of the coordinates, as the file or the caller says.

    Raises
    ------
    CrsError
        If the points lie in the area of use of their CRS as degrees only.
    """
    if crs is None or crs.is_geographic or len(points) == 0:
        return ()
    area = AreaOfUse.of(crs, crs)
    if area is None or not area.is_local(points[:, :2]):
        return ()
    x, y = points[0, :2].tolist()
    first = f"first: easting {coordinate(x)}, northing {coordinate(y)}"
    if (np.abs(points[:, :2]).max(axis=0) > _MOST_DEGREES).any():
        return (_describe_local(crs, first),)
    if area.covers_as_degrees(points[:, :2]):
        sentence = (
            f"the points lie outside the area of use of {area.label} and, as longitude and "
            f"latitude in degrees, inside ({first}): the CRS of the file is to be one in degrees"
        )
        return (refuse(sentence, crs),)
    if area.covers_as_degrees(points[:, [1, 0]]):
        sentence = (
            f"the points lie outside the area of use of {area.label} and, as latitude and "
            f"longitude in degrees, inside ({first}): the coordinates are in the other order"
        )
        return (refuse(sentence, crs),)
    return (_describe_local(crs, first),)


def _describe_local(crs: CRS, first: str) -> str:
    return (
        f"The points lie about the origin of {crs.label} ({first}), outside its area of use: check "
        "that they are no local coordinates, and no degrees."
    )
