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
from ...base.georeference import gives_northing_first
from ...base.sentences import coordinate, counted
from ...tin.screening import AreaOfUse

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ...base.arrays import Float64Array
    from ...base.crs import CRS

_MOST_DEGREES = (360.0, 90.0)
_WIDEST = 3.0
"""Degrees that a site spans at most; as many metres are none."""

_BOTH_ORDERS = ([0, 1], [1, 0])
"""Columns of the first coordinate and of the second, as they are and exchanged."""

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
    """Refuse a contradiction; return it as a note where the caller wants no refusal."""
    if not _IS_CHECKED.get():
        return f"{sentence}."
    raise CrsError(f"{sentence}; `check_crs=False` takes them as they are.", crs=crs)


def look_at_crs(
    points: Float64Array, crs: CRS | None, *, is_declared: bool = False
) -> tuple[str, ...]:
    """Compare points, (n, 3), that stay where they are with their CRS.

    ``is_declared`` tells that the caller names it and the file does not.
    """
    places = Places(crs, None, looks_at_order=is_declared)
    places.add(points)
    order = places.describe_order()
    return (*places.describe_degrees(), *places.describe_outside(), *order)


class Places:
    """What the points of a file show of their CRS, looked at block by block.

    Parameters
    ----------
    source, target : CRS or None
        Of the file, and the one that is wanted.
    looks_at_area : bool
        Whether points outside the areas of use are counted.
    looks_at_order : bool
        Whether it is asked which coordinate comes first.
    """

    def __init__(
        self,
        source: CRS | None,
        target: CRS | None,
        *,
        looks_at_area: bool = True,
        looks_at_order: bool = False,
    ) -> None:
        self._crs = source or target
        self._area = AreaOfUse.of(source, target) if looks_at_area else None
        self._is_moved = source is not None and target is not None and not source.is_same(target)
        self._own_area = AreaOfUse.of(self._crs, self._crs)
        self._order = _find_order_in_doubt(self._crs) if looks_at_order else None
        self._count = 0
        self._outside = 0
        self._exchanged = 0
        self._first: list[float] = []
        self._is_local = True
        self._is_plain = True
        self._as_degrees = [True, True]
        self._as_ordered = [True, True]

    def add(self, points: Float64Array) -> None:
        """Look at further points, (n, 3), as they are in the file."""
        if len(points) == 0:
            return
        xy = points[:, :2]
        if not self._first:
            self._first = xy[0].tolist()
        self._look_at_degrees(xy)
        self._look_at_area(xy)
        if self._order is not None:
            for k, columns in enumerate(_BOTH_ORDERS):
                self._as_ordered[k] &= self._order.covers_whole(points[:, columns])
        self._count += len(xy)

    def _look_at_degrees(self, xy: Float64Array) -> None:
        area = self._own_area
        was_local = self._is_local
        self._is_local &= area is not None and area.is_local(xy)
        if area is None or not self._is_local:
            if was_local and not self._is_moved:
                self._outside += self._count  # those before lie about the origin, and nowhere else
            return
        self._is_plain &= not bool((np.abs(xy).max(axis=0) > _MOST_DEGREES).any())
        for k, columns in enumerate(_BOTH_ORDERS):
            if self._is_plain and self._as_degrees[k]:
                self._as_degrees[k] = area.covers_as_degrees(xy[:, columns])

    def _look_at_area(self, xy: Float64Array) -> None:
        if self._area is None or (self._is_local and not self._is_moved):
            return
        outside = self._area.find_outside(xy)
        self._outside += len(outside)
        if len(outside):
            self._exchanged += int(self._area.covers(xy[outside][:, [1, 0]]).sum())

    def describe(self) -> tuple[str, ...]:
        """Tell what is odd of the points that were added.

        Raises
        ------
        CrsError
            If most lie outside the areas of use, and with easting and northing exchanged most would
            not; if they lie in the area of use of their CRS as degrees only.
        """
        return (*(self.describe_outside() or self.describe_degrees()), *self.describe_order())

    def describe_outside(self) -> tuple[str, ...]:
        """Tell how many points lie outside the areas of use."""
        area = self._area
        is_local = self._is_local and not self._is_moved and self._count > 0
        if area is None or is_local or self._outside == 0:
            return ()
        lie = "lies" if self._outside == 1 else "lie"
        sentence = (
            f"{self._outside:,} of {counted(self._count, 'point')} {lie} outside the area of use "
            f"of {area.label}"
        )
        if 2 * self._exchanged <= self._outside:
            return (f"{sentence}: check that the CRS is the right one.",)
        exchanged = f"{sentence} and, with easting and northing exchanged, inside"
        if 2 * self._outside > self._count:
            return (refuse(f"{exchanged}: the coordinates are in the other order", area.source),)
        return (f"{exchanged}: check the order of the coordinates.",)

    def describe_degrees(self) -> tuple[str, ...]:
        """Tell of longitudes and latitudes under a CRS that measures in lengths."""
        crs, area = self._crs, self._own_area
        if crs is None or crs.is_geographic or self._count == 0:
            return ()
        if area is None or not self._is_local:
            return ()
        x, y = self._first
        first = f"first: easting {coordinate(x)}, northing {coordinate(y)}"
        if not self._is_plain or not any(self._as_degrees):
            return (_describe_local(crs, first),)
        if self._as_degrees[0]:
            sentence = (
                f"the points lie outside the area of use of {area.label} and, as longitude and "
                f"latitude in degrees, inside ({first}): the CRS of the file is to be one in "
                "degrees"
            )
        else:
            sentence = (
                f"the points lie outside the area of use of {area.label} and, as latitude and "
                f"longitude in degrees, inside ({first}): the coordinates are in the other order"
            )
        return (refuse(sentence, crs),)

    def describe_order(self) -> tuple[str, ...]:
        """Tell where a CRS that the file does not name leaves open which coordinate comes first.

        It names the northing first, and the points lie in its area of use in either order.
        """
        crs = self._crs
        if crs is None or self._order is None or self._count == 0 or not all(self._as_ordered):
            return ()
        names = ("latitude", "longitude") if crs.is_geographic else ("northing", "easting")
        return (
            f"The file names no CRS, and {crs.label} gives the {names[0]} before the {names[1]}: "
            f"the first coordinate was taken as the {names[1]}, and in the other order the points "
            "would lie in its area of use, too.",
        )


def _find_order_in_doubt(crs: CRS | None) -> AreaOfUse | None:
    """Return the area of a CRS that names the northing first."""
    return AreaOfUse.of(crs, crs) if crs is not None and gives_northing_first(crs) else None


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


def _describe_local(crs: CRS, first: str) -> str:
    return (
        f"The points lie about the origin of {crs.label} ({first}), outside its area of use: check "
        "that they are no local coordinates, and no degrees."
    )
