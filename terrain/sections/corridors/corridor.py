"""Corridors: a template carried along an axis, with side slopes to the ground."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from ....base.checks import as_length
from ....base.products import product
from ....base.progress import Progress
from ...earthwork.grading import find_area, join_surfaces
from .axis import read_axis
from .designs import Design
from .layouts import Layouts
from .patches import build_patch
from .proof import require_as_designed

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from numpy.typing import ArrayLike

    from ....tin import TIN
    from .templates import Template


@product
def corridor(
    tin: TIN,
    axis: Any,
    template: Template | Mapping[float, Template],
    *,
    superelevation: ArrayLike | None = None,
    vertical: str | None = None,
    start: float | None = None,
    end: float | None = None,
    interval: float | None = None,
    tolerance: float = 0.01,
    progress: Callable[[float], None] | None = None,
) -> TIN:
    """Carry a cross section along an axis, with side slopes to where they meet the ground.

    Parameters
    ----------
    tin : TIN
        The ground.
    axis : Alignment, (k, 3) array, Features, Breakline or geometry
        What the template is carried along: an alignment with its vertical alignment, or a line in
        space, whose elevations are the profile.
    template : Template or mapping of stations to templates
        The cross section; of several the widths, slopes and rises change evenly from one station
        to the next, and before the first and behind the last nothing changes. They have the same
        parts.
    superelevation : (k, 3) array, optional
        Rows of station, slope of the left side, slope of the right side, in place of the slopes of
        parts that turn: rise outwards over width, so that the cross section turns about the axis.
        They change evenly between stations; before the first and behind the last they stay.
    vertical : str, optional
        Name of the vertical alignment, needed if there are several.
    start, end : float, optional
        First and last station, CRS units. Default as far as elevations are designed.
    interval : float, optional
        A section at every station that is a multiple of it, besides those that are needed.
    tolerance : float, optional
        How far lines of the corridor may lie from the curves that they are chords of, in the plane
        and in height, CRS units. Default 0.01.
    progress : callable, optional
        Called with the fraction done, ascending to 1.0. What it raises ends the call.

    Returns
    -------
    TIN
        Corridor, side slopes, and the ground beyond. Breaklines have the names of the parts whose
        outer edge they are, and "axis", "hinge" (where side slopes begin, and at both ends),
        "daylight" and "slope", where side slopes break. Quantities are those of
        :func:`tinsmith.volume` and :func:`tinsmith.section_volumes` from the ground to it.
        ``report.notes`` tell at which stations it was cut off.

    Raises
    ------
    OptionError
        If an option is no such value, templates have other parts than the first, or stations are
        too many.
    LinesError
        If the axis is no line, has no elevations or crosses itself; if it closes, and elevations or
        cross section do not; if it ends in the side slopes of another stretch.
    PointsError
        If the corridor lies off the ground, or the ground ends before a slope meets it.
    CrsError
        If coordinates are angles, or the axis is in another CRS.

    Notes
    -----
    Each place has the section of the station that is nearest to it, as
    :meth:`tinsmith.Alignment.stations_of` finds it. So where a bend is sharper than the template
    is wide, sections are cut off where those of both stretches are as near: of the two elevations
    there the lower counts, and of a part and a side slope that of the part. Around the outer side
    of a bend without a curve lines are circles. An axis whose ends are nearer than 0.001 CRS units
    closes: its corridor has no ends.

    A side slope is a cut where the ground is higher than the last part, and a fill where it is
    lower. At both ends the corridor ends in a vertical face, whose edges are 0.001 CRS units
    apart.

    Stations are all those where something changes, and so many between that the lines of parts and
    the side slopes lie within the tolerance of chords, at any offset that they reach: for a line at
    an offset o along a curvature k chords are at most sqrt(8 t / (k (1 + o k))) long.

    Examples
    --------
    >>> import tinsmith as ts
    >>> flat = ts.triangulate([[0, 0, 5], [60, 0, 5], [60, 60, 5], [0, 60, 5]])
    >>> lane = ts.Part("lane", 3, -0.02)
    >>> road = ts.Template(ts.Side([lane], cut_slope=1, fill_slope=2))
    >>> made = ts.corridor(flat, [[10, 30, 7], [50, 30, 7]], road)
    >>> made.interpolate([[30, 30], [30, 33], [30, 34], [30, 40]]).round(9)
    array([7.  , 6.94, 6.44, 5.  ])
    """
    done = Progress(progress)
    bound = as_length("tolerance", tolerance)
    step = None if interval is None else as_length("interval", interval)
    road = read_axis(tin, axis, vertical, start, end)
    design = Design(template, superelevation, road)
    area = find_area(tin)
    layouts = Layouts(tin, area, road, design, bound, step)
    layout = layouts.find(Progress(done.stage(0.0, 0.6)))
    most = bound / road.up
    patch = build_patch(layouts.ground, layout, road, tin, most)
    require_as_designed(patch, layout, road, design, bound)
    reference = replace_factors(road.agreed)
    joined = join_surfaces(tin, patch, reference, area, "daylight", progress=done.stage(0.6, 1.0))
    notes = (*joined.report.notes, *road.notes, *layout.describe(road))
    made: TIN = joined.replace(report=replace(joined.report, notes=notes))
    done.end()
    return made


def replace_factors(agreed: Any) -> Any:
    """Return what was agreed on, for a patch that is in its unit already."""
    return replace(agreed, factors=(agreed.factors[0], 1.0))
