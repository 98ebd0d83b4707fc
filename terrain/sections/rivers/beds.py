"""River beds between surveyed cross sections, interpolated along the channel."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ....base.checks import as_flag, as_length
from ....base.errors import LinesError
from ....base.georeference import describe_unknown
from ....base.progress import Progress
from ....base.sentences import counted
from ....tin import Breakline, triangulate
from .centrelines import read_centreline
from .channels import lay_out
from .strips import make_strips
from .surveyed import read_sections

if TYPE_CHECKING:
    from collections.abc import Callable

    from ....base.arrays import BoolArray, Float64Array
    from ....base.crs import CrsLike, UnitLike
    from ....tin import TIN
    from .channels import Channel, CrossSection
    from .strips import Strip


def riverbed(
    sections: Any,
    centreline: Any,
    *,
    spacing: float,
    banks: Any = None,
    thalweg: Any = None,
    by: str | None = None,
    omit_returns: bool = False,
    crs: CrsLike | None = None,
    elevation_unit: UnitLike | None = None,
    progress: Callable[[float], None] | None = None,
) -> TIN:
    """Interpolate the bed of a river between surveyed cross sections, along the channel.

    A TIN of the points alone joins points of one section that are nearer to each other than to the
    next section, and makes steps across the channel. Here elevations go from each point of a
    section to the place of the same offset on the next one.

    Parameters
    ----------
    sections : Features, Survey, or sequence of (k, 3) arrays
        Cross sections, two or more: lines in space across the channel, those of a survey its
        breaklines. Of points, see ``by``. Which end they begin at, and in which order they come,
        is found from the centreline.
    centreline : (k, 2) array, Features, geometry or Alignment
        One line along the channel, downstream, which every section crosses once.
    spacing : float
        Longest step along the centreline between two sections, CRS units.
    banks : sequence of two lines, or Features, optional
        The left and the right bank, which every section crosses once each: offsets are compared
        between them, and beyond them, separately. Their elevations do not count.
    thalweg : line, optional
        The line of the deepest flow, which every section crosses once: offsets are compared on
        either side of it separately. Its elevations do not count.
    by : str, optional
        Column whose values tell which section a point is on, needed for points; of lines the
        column that names them. Points of a section that do not follow each other across the channel
        are sorted.
    omit_returns : bool
        Leave out the fewest points without which every section goes across the channel and never
        back, as the track of a boat does where it turns. Default: such sections are refused.
    crs : CRS, str, int or pyproj.CRS, optional
        Of the sections, where they do not tell it.
    elevation_unit : Unit or str, optional
        Of the sections' elevations, where they do not tell it.
    progress : callable, optional
        Called with the fraction done, ascending to 1.0. What it raises ends the call.

    Returns
    -------
    TIN
        The bed from the first section to the last, between their ends. Every point of a section is
        a vertex as it was surveyed. Breaklines are named "section", "left bank", "thalweg" and
        "right bank", and "string" for the others along the channel. ``report.notes`` tell which
        sections were turned or sorted, what was left out, and which points look like blunders.

    Raises
    ------
    LinesError
        If there are fewer than two sections, one has no elevations, crosses itself or goes back
        across the channel, two of them meet, or one does not meet the centreline, a bank or the
        thalweg exactly once; if lines along the channel cross, where it turns more sharply than it
        is wide.
    OptionError
        If the spacing is no length or makes too many vertices, or there is no such column.
    CrsError
        If coordinates are angles, or CRSs differ.

    Notes
    -----
    In the coordinates of the channel, station along it and offset across, elevations are linear
    from section to section at the same normalised offset [1]_ [2]_: the share of the way from the
    left end of the section to its right end, or of each part between ends, banks and thalweg. So
    between two sections no elevation is lower or higher than those of both at that offset; a
    prismatic channel with an even slope is reproduced, and a curved one up to the chords of its
    steps. In the plane lines along the channel are straight in these coordinates, whose normals
    turn evenly along the centreline, and banks and thalweg lie on the lines given. It is the
    surface that one dimensional hydraulic models call the cross section interpolation surface.

    At a section there is a vertex for each point of its neighbours, on the line between its own;
    offsets that differ by less than 1e-6 are one.
    A section beyond an end of the centreline is met by that end prolonged, by at most the length of
    the section, which is told. Time and vertices are in proportion to points times steps.

    References
    ----------
    .. [1] V. Merwade, A. Cook, J. Coonrod, GIS techniques for creating river terrain models for
       hydrodynamic modeling and flood inundation mapping, Environmental Modelling & Software 23
       (2008), doi:10.1016/j.envsoft.2008.03.005.
    .. [2] D. Caviedes-Voullieme, M. Morales-Hernandez, I. Lopez-Marijuan, P. Garcia-Navarro,
       Reconstruction of 2D river beds by appropriate interpolation of 1D cross-sectional
       information for flood simulation, Environmental Modelling & Software 61 (2014),
       doi:10.1016/j.envsoft.2014.07.016.

    Examples
    --------
    >>> import tinsmith as ts
    >>> upper = [[0, 10, 5], [0, 6, 2], [0, 4, 2], [0, 0, 5]]
    >>> lower = [[40, 10, 4], [40, 6, 1], [40, 4, 1], [40, 0, 4]]
    >>> bed = ts.riverbed([upper, lower], [[0, 5], [40, 5]], spacing=10)
    >>> bed.interpolate([[20, 5], [20, 8], [40, 4]]).round(9)
    array([1.5, 3. , 1. ])
    """
    done = Progress(progress)
    step = as_length("spacing", spacing)
    surveyed = read_sections(sections, by, crs, elevation_unit)
    along = read_centreline(centreline, surveyed.crs)
    omit = as_flag("omit_returns", omit_returns)
    channel = lay_out(surveyed, along, (banks, thalweg), omit_returns=omit)
    done(0.1)
    strips = make_strips(channel, step)
    done(0.3)
    lines = [*_list_sections(channel, strips), *_list_strings(strips)]
    outline = _outline(channel, strips)
    _require_simple(outline)
    bed = triangulate(
        outline,
        breaklines=lines,
        boundary=[outline],
        duplicates="first",
        crs=surveyed.crs,
        elevation_unit=surveyed.elevation_unit,
        progress=done.stage(0.3, 1.0),
    )
    made = counted(
        len(bed.points) - sum(len(one.points) for one in channel.sections), "vertex", "vertices"
    )
    notes = (
        *surveyed.notes,
        *surveyed.screen(),
        *along.notes,
        *channel.notes,
        *describe_unknown(bed.crs, bed.elevation_unit),
        f"{counted(len(channel.sections), 'cross section')} from station "
        f"{channel.sections[0].station:.6g} to {channel.sections[-1].station:.6g}: between them "
        f"{made} were interpolated.",
    )
    done.end()
    return bed.replace(report=replace(bed.report, notes=(*bed.report.notes, *notes)))


def _list_sections(channel: Channel, strips: list[Strip]) -> list[Breakline]:
    """Return the sections with a vertex wherever a line along the channel meets them."""
    return [
        Breakline(_refine(one, strips, k), name="section", priority=1)
        for k, one in enumerate(channel.sections)
    ]


def _refine(section: CrossSection, strips: list[Strip], number: int) -> Float64Array:
    """Return a section with the ends of the lines of both its strips, (k, 3)."""
    ends = [section.offsets]
    ends += [strips[number - 1].last] if number > 0 else []
    ends += [strips[number].first] if number < len(strips) else []
    places: Float64Array = section.places_at(np.unique(np.concatenate(ends)))
    is_new: BoolArray = np.append(True, (np.diff(places[:, :2], axis=0) != 0.0).any(axis=1))
    kept: Float64Array = places[is_new]
    return kept


def _list_strings(strips: list[Strip]) -> list[Breakline]:
    """Return the lines along the channel, those of one name joined from strip to strip."""
    lines = []
    named: dict[str, list[Float64Array]] = {}
    for strip in strips:
        for name, places in zip(strip.names, strip.places, strict=True):
            if name == "string":
                lines.append(Breakline(places, name=name))
            else:
                path = named.setdefault(name, [])
                path.append(places[1:] if path else places)
    return [*(Breakline(np.concatenate(path), name=name) for name, path in named.items()), *lines]


def _outline(channel: Channel, strips: list[Strip]) -> Float64Array:
    """Return the ring around the bed."""
    left = [strip.places[0, :-1] for strip in strips]
    right = [strip.places[-1, -2:0:-1] for strip in reversed(strips)]
    ends = [channel.sections[k].points[-1:] for k in range(len(strips) - 1, 0, -1)]
    between = [path for pair in zip(right[:-1], ends, strict=True) for path in pair]
    last, first = (_refine(channel.sections[k], strips, k % (len(strips) + 1)) for k in (-1, 0))
    return np.concatenate([*left, last, *between, right[-1], first[:0:-1]])


def _require_simple(outline: Float64Array) -> None:
    """Refuse a bed that lies over itself."""
    import shapely

    polygon = shapely.Polygon(outline[:, :2])
    if not polygon.is_valid:
        raise LinesError(
            "The bed between the ends of the sections lies over itself: "
            f"{shapely.is_valid_reason(polygon)}."
        )
