"""Points of a file come to the CRS in which they are wanted; degrees do not make a TIN."""

from __future__ import annotations

from typing import TYPE_CHECKING, NoReturn

import numpy as np

from .crs import as_crs, crs_label, fitting_utm, is_geographic, transform_points
from .errors import CrsError, ReadError

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

__all__ = ["placed"]

_WGS84 = "EPSG:4326"


def placed(
    points: NDArray[np.float64], *, source: str | None, target: str | None, path: Path
) -> tuple[NDArray[np.float64], str | None]:
    """Bring points into a projected CRS.

    Parameters
    ----------
    points : (n, 3) float64 array
    source : str, optional
        CRS of the points; unknown points are declared to be in the target.
    target : str, optional
        CRS wanted; default the source.
    path : Path
        For sentences.

    Returns
    -------
    points : (n, 3) float64 array
    crs : str or None

    Raises
    ------
    ReadError
        If the points would be in degrees.
    CrsError
        If they cannot be transformed.
    """
    wanted = target if target is not None else source
    if wanted is not None and is_geographic(wanted):
        _refuse_degrees(points, wanted, source or wanted, path)
    if source is None or wanted is None or _is_same(source, wanted):
        return points, wanted
    try:
        return transform_points(points, source, wanted), wanted
    except CrsError as error:
        raise CrsError(f"'{path}': {error}", crs=wanted) from error


def _is_same(source: str, target: str) -> bool:
    return source == target or as_crs(source).equals(as_crs(target), ignore_axis_order=True)


def _refuse_degrees(points: NDArray[np.float64], wanted: str, source: str, path: Path) -> NoReturn:
    suggestion = _suggestion(points, source)
    fitting = f"crs='{suggestion}'" if suggestion else "the option crs"
    raise ReadError(
        f"'{path}': {crs_label(wanted)} measures in degrees, and a TIN needs a projected CRS: "
        f"give {fitting} to reproject from longitude and latitude.",
        path=path,
    )


def _suggestion(points: NDArray[np.float64], source: str) -> str | None:
    """Return the UTM zone of the middle of the points."""
    if len(points) == 0:
        return None
    middle = np.append((points[:, :2].min(axis=0) + points[:, :2].max(axis=0)) / 2, 0.0)
    try:
        longitude, latitude, _ = transform_points(middle[None, :], source, _WGS84)[0]
    except CrsError:
        return None
    return fitting_utm(float(longitude), float(latitude))
