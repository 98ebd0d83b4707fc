"""Flats: the regions of flat triangles as polygons, and whether points look like contours."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ....base.checks import require_tin
from ....base.georeference import describe_unknown, find_plane_units
from ....base.products import product
from ....base.results import Features
from ....base.sentences import counted
from ...surface import dissolve, make_polygons, measure_plane_areas
from .regions import KINDS, find_regions

if TYPE_CHECKING:
    from ....tin import TIN

_FEWEST_POINTS = 30
_POINTS_PER_LEVEL = 10
"""Contours have so many points at each elevation at least,"""

_ONE_STEP = 0.95
"""this share of triangles between neighbouring elevations or at one,"""

_FEWEST_FLAT = 0.01
"""and this share of flat ones; less is not worth telling."""

_GRID = 4.0
"""Points are a grid if columns times rows are no more than so many times the points."""


@product
def flats(tin: TIN) -> Features:
    """Find the flat triangles of a TIN, such as those that contours leave.

    Where a contour turns back on itself, at ridges, in valleys, on peaks and in pits, a
    triangulation joins points of one contour, and the surface is flat where the ground is not.

    Parameters
    ----------
    tin : TIN

    Returns
    -------
    Features
        A polygon for each region of triangles whose corners have one elevation, to the last digit.
        Columns: ``elevation``, ``triangles``, ``area`` (in the plane), and ``landform``: what the
        contours around tell, ``"ridge"``, ``"valley"``, ``"peak"``, ``"pit"`` or ``"unclear"``.
        Triangles between points of water alone are left out.

    Examples
    --------
    >>> import tinsmith as ts
    >>> ring = [[0, 0], [30, 0], [30, 10], [0, 10], [0, 0]]
    >>> outer = [[-9, -9], [39, -9], [39, 19], [-9, 19], [-9, -9]]
    >>> lines = [[[x, y, z] for x, y in one] for one, z in ((ring, 5), (outer, 0))]
    >>> tin = ts.triangulate(ts.Survey(points=lines[0] + lines[1], breaklines=lines))
    >>> ts.flats(tin).columns["landform"].tolist()
    ['peak']
    """
    require_tin(tin)
    regions = find_regions(tin)
    found = dissolve(tin, regions.region_of)
    is_flat = regions.region_of >= 0
    numbers = regions.region_of[is_flat]
    area = np.bincount(numbers, measure_plane_areas(tin)[is_flat], regions.size)
    columns = {
        "elevation": regions.elevations,
        "landform": np.array(KINDS, object)[regions.kinds],
        "triangles": np.bincount(numbers, minlength=regions.size),
        "area": area,
    }
    return make_polygons(
        tin,
        found,
        columns=columns,
        units={"elevation": tin.elevation_unit, "area": find_plane_units(tin.crs).area},
        name="flats",
        notes=describe_unknown(tin.crs, tin.elevation_unit),
    )


def describe_flats(tin: TIN) -> list[str]:
    """Tell of flat triangles in a sentence, if the points look like contours; else return none."""
    z = tin.points[tin.triangles, 2]
    is_flat = (z == z[:, :1]).all(axis=1)
    if is_flat.mean() < _FEWEST_FLAT or not _look_like_contours(tin):
        return []
    share = 100.0 * is_flat.mean()
    return [
        f"{counted(int(is_flat.sum()), 'triangle')} of {len(is_flat):,} ({share:.0f} %) are flat, "
        "for the points look like those of contours"
    ]


def _look_like_contours(tin: TIN) -> bool:
    points = tin.points
    levels, level_of = np.unique(points[:, 2], return_inverse=True)
    if len(points) < _FEWEST_POINTS or len(levels) * _POINTS_PER_LEVEL > len(points):
        return False
    columns, rows = (len(np.unique(points[:, axis])) for axis in (0, 1))
    if len(levels) < 2 or columns * rows <= _GRID * len(points):
        return False
    steps = np.ptp(level_of[tin.triangles], axis=1)
    return bool((steps <= 1).mean() >= _ONE_STEP)
