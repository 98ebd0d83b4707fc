"""Grade a pad into the ground: side slopes up through a cut and down over a fill."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from ....base.checks import as_number
from ....base.crs import scale_elevations
from ....base.errors import LinesError, OptionError, PointsError
from ....base.georeference import Agreement
from ....base.products import product
from ....base.progress import Progress
from ....base.sentences import coordinate, height
from ....tin.constraints.polygons import gather_rings_of_regions
from ...surface import find_reference
from .pads import build_patch
from .pasting import join_surfaces
from .seams import find_area
from .slopes import find_slope

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike

    from ....base.arrays import Float64Array
    from ....tin import TIN

_SHARE = 1e-6
"""Of the area of pad and slopes: less of it may lie beyond the ground by rounding."""
_SLOPE = 0.2
"""Of the work as it is told, following the one slope or the other."""


@product
def grade(
    tin: TIN,
    pad: ArrayLike | Any,
    elevation: float | None = None,
    *,
    cut_slope: float,
    fill_slope: float,
    progress: Callable[[float], None] | None = None,
) -> TIN:
    """Grade a level pad into the ground, with side slopes to where they meet it.

    From the edge of the pad a slope rises where the ground is higher (cut), and falls where it is
    lower (fill), to the daylight line. Around corners the slopes are cones; in a notch that of the
    nearer edge counts.

    Parameters
    ----------
    tin : TIN
        The ground.
    pad : (k, 2) or (k, 3) array, or polygon
        Ring of the pad's edge in the CRS of the ground, convex or not.
    elevation : float, optional
        Of the pad, in the unit of the ground's; default that of the ring, which must be level.
    cut_slope, fill_slope : float
        Horizontal over vertical: 2 is 2:1, two along for one up or down.
    progress : callable, optional
        Called with the fraction done, ascending to 1.0, as slopes are followed and pasted into the
        ground. What it raises ends the call.

    Returns
    -------
    TIN
        Pad, slopes, and the ground beyond. Breaklines are named "pad edge", "daylight" and
        "slope", where slopes break. Volumes are those of ``ts.volume(tin, graded)``. Vertices of
        the ground keep their attributes, new ones have none.

    Raises
    ------
    OptionError
        If a slope is no number above 0, or the elevation none.
    LinesError
        If the pad is no ring, or crosses itself.
    PointsError
        If the pad lies off the ground, or the ground ends before a slope meets it: with the place.
    CrsError
        If coordinates are angles.

    Notes
    -----
    Slopes beside edges are exact planes, and cones have facets of two degrees: daylight is short by
    at most 0.00016 of its distance. Where the pad has a notch, slopes meet where they are as far
    from both edges. What is cut or filled farther away, and does not reach the pad along its slope,
    stays ground. Time and vertices are in proportion to the corners of the pad.

    Examples
    --------
    >>> import tinsmith as ts
    >>> flat = ts.triangulate([[0, 0, 5], [60, 0, 5], [60, 60, 5], [0, 60, 5]])
    >>> pad = [[25, 25], [35, 25], [35, 35], [25, 35]]
    >>> graded = ts.grade(flat, pad, 3.0, cut_slope=2, fill_slope=3)
    >>> graded.interpolate([[30, 30], [30, 37], [30, 45]]).round(9)
    array([3., 4., 5.])
    """
    done = Progress(progress)
    reference = find_reference(tin, "Slopes")
    up = scale_elevations(reference.crs, reference.elevation_unit)
    cut = 1.0 / (_require_ratio("cut_slope", cut_slope) * up)
    fill = -1.0 / (_require_ratio("fill_slope", fill_slope) * up)
    polygon, level = _read_pad(pad, elevation)
    area = find_area(tin)
    _require_on_ground(area, polygon)
    local = tin.replace(crs=None, elevation_unit=None)
    used = tin.points[tin.triangles, 2]
    farthest = {cut: (used.max() - level) / cut, fill: (used.min() - level) / fill}
    slopes = []
    # Farther away is no ground.
    across = math.hypot(*(tin.points.max(axis=0) - tin.points.min(axis=0))[:2])
    for number, (rate, reach) in enumerate(farthest.items(), 1):
        if reach > 0:
            slope = find_slope(local, area, polygon, level, rate, min(float(reach), across))
            slopes.append(slope)
        done(number * _SLOPE)
    patch = build_patch(tin, polygon, level, slopes)
    _require_within(area, patch)
    done(0.5)
    agreed = Agreement(tin.crs, tin.elevation_unit, (1.0, 1.0), reference.notes)
    graded = join_surfaces(tin, patch, agreed, area, "daylight", progress=done.stage(0.5, 1.0))
    done.end()
    return graded


# ---------------------------------------------------------------- what is given


def _require_ratio(name: str, value: Any) -> float:
    unit = "(horizontal over vertical: 2 is 2:1)"
    return as_number(name, value, "a ratio", above=0, unit=unit)


def _read_pad(pad: Any, elevation: Any) -> tuple[Any, float]:
    """Return the pad as a polygon of shapely, and its level."""
    import shapely

    regions = gather_rings_of_regions([pad], "pad")
    if len(regions) != 1 or len(regions[0]) != 1:
        raise OptionError("pad", "several rings", "one ring, without holes")
    ring = regions[0][0]
    if elevation is None:
        elevation = _find_level(ring)
    level = as_number("elevation", elevation)
    polygon = shapely.Polygon(ring[:, :2])
    if not polygon.is_valid or not polygon.area > 0:
        raise LinesError(f"Invalid pad: {shapely.is_valid_reason(polygon)}.")
    return shapely.orient_polygons(polygon), level


def _find_level(ring: Float64Array) -> float:
    if ring.shape[1] < 3:
        raise OptionError("elevation", None, "a number, where the pad's ring has no elevations")
    low, high = float(ring[:, 2].min()), float(ring[:, 2].max())
    if low != high:
        raise OptionError(
            "elevation",
            None,
            f"a number: the pad's ring is not level ({height(low)} to {height(high)})",
        )
    return low


def _require_within(area: Any, patch: TIN) -> None:
    import shapely

    beyond = shapely.difference(find_area(patch), area)
    if beyond.area > _SHARE * patch.area:
        place = shapely.point_on_surface(beyond)
        raise PointsError(
            f"A slope reaches beyond the ground, at {coordinate(place.x)} {coordinate(place.y)}."
        )


def _require_on_ground(area: Any, pad: Any) -> None:
    import shapely

    beyond = shapely.difference(pad, area)
    if not beyond.is_empty:
        place = shapely.point_on_surface(beyond)
        raise PointsError(
            f"The pad lies off the ground, at {coordinate(place.x)} {coordinate(place.y)}."
        )
