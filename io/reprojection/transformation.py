"""Points move from one coordinate reference system to another, and elevations change their unit.

What a CRS is, and which units there are, is told by :mod:`tinsmith.base.crs`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...base.crs import CRS, UNKNOWN, Unit, assume_elevation_unit
from ...base.errors import CrsError
from ...base.sentences import coordinate, counted
from ...tin import Bounds
from ...tin.validation import as_points
from .quality import Quality, describe_missing_grids, judge

if TYPE_CHECKING:
    from ...base.arrays import Float64Array
    from ...base.crs import CrsLike, UnitLike

_BETWEEN = 99
"""Points between the corners of a box that is brought to another CRS."""

LengthUnit = Unit
"""The name of :class:`tinsmith.Unit` in the first version."""


class Reprojected(NamedTuple):
    """Points in another CRS."""

    points: Float64Array
    """(n, 3)."""
    unit: Unit | None
    """Of their elevations; None if it is still not known."""
    note: str | None
    """What was done to the elevations, in a sentence; None if nothing."""
    quality: Quality = Quality()
    """What the transformation leaves undone."""

    @property
    def notes(self) -> tuple[str, ...]:
        """All that is to be told, in sentences."""
        return tuple(one for one in (self.quality.note, self.note) if one)


def is_geographic(crs: CrsLike | None) -> bool:
    """Whether coordinates in this CRS are longitude and latitude; False where it is not known."""
    return crs is not None and CRS.of(crs).is_geographic


def length_unit(crs: CrsLike | None) -> Unit:
    """Return the unit of eastings and northings; ``metres`` is None where it is no known length.

    Examples
    --------
    >>> length_unit("EPSG:2274")
    Unit(name='US survey foot', symbol='US ft', metres=0.3048006096012192)
    """
    return UNKNOWN if crs is None else CRS.of(crs).horizontal_unit


def transform_points(
    points: Float64Array,
    source: CrsLike,
    target: CrsLike,
    *,
    elevation_unit: UnitLike | None = None,
) -> Float64Array:
    """Transform points from one CRS to another.

    Parameters
    ----------
    points : (n, 3) float64 array
        Easting (longitude), northing (latitude), elevation.
    source, target : CRS, str, int or pyproj.CRS
    elevation_unit : Unit or str, optional
        Unit of the elevations; default that of the source: its vertical axis, else its eastings,
        metres above degrees.

    Returns
    -------
    (n, 3) float64 array
        Elevations are converted as :func:`reproject` tells.

    Raises
    ------
    CrsError
        If a CRS is unknown, no transformation exists, or a point lies outside its domain.
    OptionError
        If the unit is unknown.

    Examples
    --------
    >>> transform_points([[-84.2, 36.4, 300.0]], "EPSG:4326", "EPSG:32616").round(1).tolist()
    [[751106.6, 4031958.5, 300.0]]
    """
    known, wanted = CRS.of(source), CRS.of(target)
    if known is None or wanted is None:
        raise CrsError("Points are transformed from one CRS to another: both are needed.")
    return reproject(as_points(points), known, wanted, unit=Unit.of(elevation_unit)).points


def reproject(
    points: Float64Array,
    source: CRS,
    target: CRS,
    *,
    unit: Unit | None,
    wanted: Unit | None = None,
    needs_datum: bool = True,
    first_row: int = 0,
) -> Reprojected:
    """Transform points, and convert their elevations where the unit changes.

    Parameters
    ----------
    points : (n, 3) float64 array
    source, target : CRS
    unit : Unit or None
        Unit of the elevations, if it is known otherwise than by the source.
    wanted : Unit, optional
        Unit that they are to have; default the usual one of the target: feet in a CRS in feet,
        metres in one in metres or degrees. A vertical axis of the target goes before it.
    needs_datum : bool
        Refuse to change the vertical axis where PROJ lacks the grid for it; else elevations keep
        their datum, and ``quality`` says so.
    first_row : int
        What the first point is called where a point has no image.

    Raises
    ------
    CrsError
        If no transformation exists, a point lies outside its domain, or elevations cannot be
        brought to the vertical datum of the target.

    Notes
    -----
    Where both systems have a vertical axis PROJ changes datum and unit. Otherwise elevations keep
    their datum, and only their unit becomes the one wanted.
    """
    points = np.asarray(points, np.float64)
    known = unit if unit is not None else source.vertical_unit
    had = assume_elevation_unit(source, known)
    wanted = target.vertical_unit or wanted or target.usual_elevation_unit or had
    if source.vertical_unit is not None and target.vertical_unit is not None:
        points = _scale_elevations(points, known, source.vertical_unit)
        moved, quality = _transform(points, source, target, first_row)
        if quality.keeps_datum and needs_datum:
            raise _describe_missing_datum(source, target)
    else:
        # In the plane alone: PROJ would let the elevation, whatever its unit, move the place.
        xy, quality = _transform(points[:, :2], source.horizontal, target.horizontal, first_row)
        moved = np.column_stack([xy, points[:, 2]])
        moved = _scale_elevations(moved, had, wanted)
    is_known = known is not None or target.vertical_unit is not None
    note = _note_conversion(source, target, known, wanted)
    found = np.ascontiguousarray(moved)
    return Reprojected(found, wanted if is_known else None, note, quality)


def _describe_missing_datum(source: CRS, target: CRS) -> CrsError:
    grids = describe_missing_grids(source, target)
    return CrsError(
        f"Elevations cannot be brought from {source.label} to {target.label}: PROJ has no grid for "
        f"the change of the vertical datum{grids}; name the horizontal part of the CRS alone to "
        "keep the datum.",
        crs=target,
    )


def convert_elevations(
    points: Float64Array, unit: Unit | None, wanted: Unit | None
) -> Float64Array:
    """Return points with elevations in another unit; as they are where either is not known."""
    return _scale_elevations(np.asarray(points, np.float64), unit, wanted)


def _scale_elevations(points: Float64Array, unit: Unit | None, wanted: Unit | None) -> Float64Array:
    factor = find_conversion_factor(unit, wanted)
    return points if factor == 1.0 else points * (1.0, 1.0, factor)


def find_conversion_factor(unit: Unit | None, wanted: Unit | None) -> float:
    """Return how many of the wanted unit are in one unit; 1 where either is not known."""
    if unit is None or wanted is None or unit == wanted:
        return 1.0
    if unit.metres is None or wanted.metres is None:
        return 1.0
    return unit.metres / wanted.metres


def _note_conversion(
    source: CRS, target: CRS, known: Unit | None, wanted: Unit | None
) -> str | None:
    had = assume_elevation_unit(source, known)
    if had is None or wanted is None or had == wanted:
        return None
    if known is not None:
        return f"Elevations were converted from {had.name} to {wanted.name}."
    return (
        f"The unit of the elevations is not told: taken to be {had.name}, as is usual in "
        f"{source.label}, they were converted to {wanted.name} for {target.label}."
    )


def _transform(
    points: Float64Array, source: CRS, target: CRS, first_row: int
) -> tuple[Float64Array, Quality]:
    import pyproj
    from pyproj.exceptions import ProjError

    names = f"from {source.label} to {target.label}"
    try:
        transformer = pyproj.Transformer.from_crs(
            source.to_pyproj(), target.to_pyproj(), always_xy=True
        )
        moved = np.stack(transformer.transform(*points.T), axis=1)
    except ProjError as error:
        raise CrsError(f"No transformation {names} is known.", crs=target) from error
    _require_images(points, moved, (names, first_row), target)
    return moved, judge(source, target, transformer) if len(points) else Quality()


def _require_images(
    points: Float64Array, moved: Float64Array, named: tuple[str, int], target: CRS
) -> None:
    names, first_row = named
    lost = ~np.isfinite(moved).all(axis=1)
    if lost.any():
        row = int(np.argmax(lost))
        x, y = points[row, :2]
        count = int(lost.sum())
        raise CrsError(
            f"{counted(count, 'point')} {'has' if count == 1 else 'have'} no image {names} "
            f"(first: point {first_row + row} at {coordinate(x)}, {coordinate(y)}): "
            "check that the CRS of the points is the right one.",
            crs=target,
        )


def find_utm_zone(longitude: float, latitude: float) -> str:
    """Return the code of the WGS 84 UTM zone (near the poles: UPS) that holds a place.

    Examples
    --------
    >>> find_utm_zone(-84.2, 36.4)
    'EPSG:32616'
    """
    if latitude >= 84.0:
        return "EPSG:32661"
    if latitude < -80.0:
        return "EPSG:32761"
    zone = int((longitude + 180.0) % 360.0 // 6.0) + 1
    return f"EPSG:{326 if latitude >= 0 else 327}{zone:02d}"


def find_bounds(
    low: Float64Array, high: Float64Array, source: CRS | None, target: CRS | None
) -> Bounds | None:
    """Return bounds, given by two corners, in another CRS; None if they are none there.

    The sides are followed by points between, which a curve between them may leave by a little.
    """
    import pyproj
    from pyproj.exceptions import ProjError

    box = [*low.tolist(), *high.tolist()]
    if source is not None and target is not None and not source.is_same(target):
        try:
            transformer = pyproj.Transformer.from_crs(
                source.horizontal.to_pyproj(), target.horizontal.to_pyproj(), always_xy=True
            )
            west, south, east, north = box
            box = list(transformer.transform_bounds(west, south, east, north, densify_pts=_BETWEEN))
        except ProjError:
            return None
    is_box = np.isfinite(box).all() and box[0] <= box[2] and box[1] <= box[3]
    return Bounds(*map(float, box)) if is_box else None
