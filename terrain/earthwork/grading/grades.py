"""Grade a pad into the ground: side slopes up through a cut and down over a fill."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from ....base.checks import as_number
from ....base.products import product
from ....base.progress import Progress
from ...surface import find_reference
from .fixed import Site, hold, read_fixed
from .pads import find_level, make_pad, read_polygon
from .pasting import join_surfaces
from .patches import make_patch, require_on_ground
from .seams import find_area

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike

    from ....tin import TIN


@product
def grade(
    tin: TIN,
    pad: ArrayLike | Any,
    elevation: float | None = None,
    *,
    cut_slope: float,
    fill_slope: float,
    gradient: tuple[float, float] | None = None,
    fixed: Any = None,
    progress: Callable[[float], None] | None = None,
) -> TIN:
    """Grade a pad into the ground, with side slopes to where they meet it.

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
        Of the pad, in the unit of the ground's; default that of the ring, which must be level. Of
        a pad that is not level that at its centroid.
    cut_slope, fill_slope : float
        Horizontal over vertical: 2 is 2:1, two along for one up or down.
    gradient : tuple of two floats, optional
        Rise of the pad to the east and to the north, vertical over horizontal: (0.02, 0) is 2 % up
        to the east. Default level. A pad that is not level must be convex.
    fixed : polygons, optional
        Regions that pad and slopes do not change: rings, polygons, a mapping of names to them,
        Features, or a GeoDataFrame. One with a level, as an elevation of all its corners or in a
        column ``elevation``, ``z``, ``level`` or ``height``, has that level; in any other one the
        ground stays as it is. Slopes of the same kind lead from it to the pad, and count there.
        Default none.
    progress : callable, optional
        Called with the fraction done, ascending to 1.0, as slopes are followed and pasted into the
        ground. What it raises ends the call.

    Returns
    -------
    TIN
        Pad, slopes, and the ground beyond. Breaklines are named "pad edge", "daylight" and
        "slope", where slopes break, and "fixed" around fixed regions. Volumes are those of
        ``ts.volume(tin, graded)``. Vertices of the ground keep their attributes, new ones have
        none.

    Raises
    ------
    OptionError
        If a slope is no number above 0, or the elevation none; if the gradient is as steep as a
        slope.
    LinesError
        If the pad is no ring, or crosses itself; if one that is not level has notches. If fixed
        regions lie over each other, or one whose ground is not level has notches where slopes
        reach it.
    PointsError
        If the pad lies off the ground, or the ground ends before a slope meets it: with the place.
        If slopes of fixed regions meet each other, or the regions leave nothing of the pad.
    CrsError
        If coordinates are angles.

    Notes
    -----
    Slopes are measured at right angles to the edge in the plane. Beside edges they are exact
    planes, and cones have facets of two degrees: daylight is short by at most 0.00016 of its
    distance. Where the pad has a notch, slopes meet where they are as far from both edges. What is
    cut or filled farther away, and does not reach the pad along its slope, stays ground. Time and
    vertices are in proportion to the corners of the pad.

    Where fixed regions are, the surface is that without them, but nowhere higher than the cut slope
    that rises from their edge, nor lower than the fill slope that falls from it. So slopes to a
    region may take a part of the pad, which ``report.notes`` tell.

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
    slopes = require_slopes(cut_slope, fill_slope)
    polygon, ring = read_polygon(pad)
    level = find_level(ring, elevation)
    made = make_pad(polygon, level, gradient, reference.up, *slopes)
    area = find_area(tin)
    require_on_ground(area, polygon)
    regions, told = read_fixed(fixed, tin, area)
    patch = make_patch(tin, made, slopes, reference.up, area, done)
    done(0.5)
    graded = join_surfaces(tin, patch, reference, area, "daylight", progress=done.stage(0.5, 1.0))
    if regions:
        held = hold(graded, patch, polygon, regions, Site(slopes, reference, area))
        notes = (*reference.notes, *told, *held.notes)
        graded = held.surface.replace(report=replace(held.surface.report, notes=notes))
    done.end()
    return graded


def require_slopes(cut_slope: Any, fill_slope: Any) -> tuple[float, float]:
    """Return both slopes, horizontal over vertical.

    Raises OptionError if one is no number above 0.
    """
    unit = "(horizontal over vertical: 2 is 2:1)"
    cut = as_number("cut_slope", cut_slope, "a ratio", above=0, unit=unit)
    return cut, as_number("fill_slope", fill_slope, "a ratio", above=0, unit=unit)
