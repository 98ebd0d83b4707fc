"""Bands: the parts of a surface between one level and the next, as polygons."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...base.checks import require_tin
from ...base.georeference import describe_unknown, find_plane_units
from ...base.products import product
from ...base.results import Features
from ...base.types import seal
from .. import _kernel
from ..surface import (
    PolygonParts,
    is_whole,
    leave_out_slivers,
    measure_ring_areas,
    repair_polygons,
    require_whole,
    sum_parts,
)
from .levels import LevelOptions
from .rebuilding import rebuild_wrong_bands

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike

    from ...base.crs import CRS, Unit
    from ...tin import TIN
    from .levels import Levels


@product
def contour_bands(
    tin: TIN,
    interval: float | None = None,
    *,
    levels: ArrayLike | None = None,
    base: float = 0.0,
) -> Features:
    """Fill the bands between the contours of a TIN.

    Parameters
    ----------
    tin : TIN
    interval, levels, base
        As of :func:`tinsmith.contours`.

    Returns
    -------
    Features
        A multipolygon for each band that has an area, from the lowest, with the columns from, to
        and area. Of explicit levels the lowest and the highest band are open: their from or to is
        NaN.

    Raises
    ------
    OptionError
        As :func:`tinsmith.contours`.
    PointsError
        If rounding leaves no polygons that add up to the surface.

    Notes
    -----
    A band has its lower level and not its upper one, so that a flat area at a level belongs to the
    band above. The polygons are valid, share every vertex along their common boundaries, tile the
    surface and nothing else; their areas add up to that of the TIN, up to rounding. Triangles along
    the boundary that are thinner than the rounding of their coordinates are left out. Where others
    are, a polygon may meet itself: it is made valid, and a note tells it.

    Examples
    --------
    >>> import tinsmith as ts
    >>> tin = ts.triangulate([[0, 0, 0], [4, 0, 4], [4, 4, 4], [0, 4, 0]])
    >>> bands = ts.contour_bands(tin, interval=3)
    >>> bands.columns["from"], bands.columns["to"], bands.columns["area"]
    (array([0., 3.]), array([3., 6.]), array([12.,  4.]))
    """
    require_tin(tin)
    options = LevelOptions(interval, levels, base)
    chosen = options.for_bands(tin)
    try:
        kept = leave_out_slivers(tin.points, tin.triangles, tin.neighbors)
        filled = _kernel.fill_bands(tin.points, *kept, chosen.values)
    except OverflowError as error:
        raise options.refuse_count(int(str(error)), "parts of triangles") from None
    parts, notes = repair_polygons(
        PolygonParts(filled.points, filled.ring_offsets, filled.polygon_offsets, filled.band)
    )
    said: tuple[str, ...] = ()
    if notes or not is_whole(tin, parts):
        parts, said = rebuild_wrong_bands(tin, chosen.values, parts)
        require_whole(tin, parts)
    return as_band_features(parts, chosen, tin.crs, tin.elevation_unit, (*notes, *said))


def as_band_features(
    parts: PolygonParts,
    chosen: Levels,
    crs: CRS | None,
    elevation_unit: Unit | None,
    notes: Sequence[str] = (),
) -> Features:
    """Return the polygons of bands as features, one a band."""
    numbers, first = np.unique(parts.band, return_index=True)
    areas = measure_ring_areas(crs, parts.points, parts.ring_offsets)
    rings = sum_parts(areas, parts.polygon_offsets[:-1])
    bounds = np.concatenate([[np.nan], chosen.values, [np.nan]])
    columns = {
        "from": bounds[numbers],
        "to": bounds[numbers + 1],
        "area": sum_parts(rings, first),
    }
    units = {"from": elevation_unit, "to": elevation_unit}
    return Features.of_polygons(
        seal(parts.points),
        seal(parts.ring_offsets),
        seal(parts.polygon_offsets),
        seal(np.append(first, len(parts.band)).astype(np.int64)),
        columns={name: seal(values) for name, values in columns.items()},
        units={**units, "area": find_plane_units(crs).area},
        crs=crs,
        elevation_unit=elevation_unit,
        name="contour bands",
        notes=[*describe_unknown(crs, elevation_unit), *notes],
    )
