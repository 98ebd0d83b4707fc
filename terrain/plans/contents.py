"""Contents: what there is to draw on the sheets of a plan, in coordinates of the ground."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...base.checks import is_finite_number
from ...base.errors import OptionError
from ...base.georeference import label_axes, require_same_crs
from ...base.sentences import counted
from ...tin.topology import find_offsets
from ..drawing import EDGE_KINDS, LineEdges, find_line_edges, join_edges, round_down
from ..isolines import contours, elevation_range
from .clipping import Paths
from .lettering import clean_text

if TYPE_CHECKING:
    from collections.abc import Iterable

    from ...base.arrays import AnyArray, Float64Array
    from ...base.georeference import Label as AxisLabel
    from ...base.results import Features
    from ...tin import TIN, Survey
    from .footprint import Footprint

_MOST_LEVELS = 2000
"""More contours than a sheet has room for: the interval was given in another unit, or by a slip."""
_LEVELS = 12
_MOST_DECIMALS = 3
"""Of elevations of points, which an instrument does not measure finer."""


class Marks(NamedTuple):
    """Points to be drawn."""

    places: Float64Array
    """(n, 2)."""
    numbers: list[str]
    elevations: list[str]
    """What stands beside each; both empty if nothing does."""


@dataclass(frozen=True, eq=False)
class Contents:
    """What is drawn."""

    contours: Features
    interval: float
    """Between them."""
    linework: dict[str, Paths]
    """Lines by their kinds, those of ``EDGE_KINDS``."""
    outline: Paths
    """The boundary of the surface where no line runs along it."""
    footprint: Footprint
    marks: Marks | None
    axes: tuple[AxisLabel, AxisLabel]
    """How coordinates across and up the map are written."""
    notes: tuple[str, ...]


def gather_contents(
    tin: TIN,
    footprint: Footprint,
    *,
    interval: float | None,
    smooth: float | None,
    points: str,
    survey: Survey | None,
) -> Contents:
    """Trace contours, and gather lines and points.

    Raises OptionError if an interval makes too many levels, or points have no numbers. Raises
    CrsError if the survey is in another CRS.
    """
    chosen = choose_interval(tin) if interval is None else interval
    lines = _trace(tin, chosen, smooth)
    notes = list(lines.notes)
    if survey is not None:
        notes += require_same_crs(survey.crs, tin.crs, "the survey")
    linework, outline = _gather_lines(tin)
    return Contents(
        contours=lines,
        interval=float(chosen),
        linework=linework,
        outline=outline,
        footprint=footprint,
        marks=None if points == "none" else _gather_marks(tin, survey, points),
        axes=label_axes(tin.crs),
        notes=tuple(notes),
    )


# ---------------------------------------------------------------- contours


def choose_interval(tin: TIN) -> float:
    """Return the interval of a dozen contours or more; 1 where the surface is flat."""
    lowest, highest = elevation_range(tin)
    relief = highest - lowest
    finest = 8 * float(np.spacing(max(abs(lowest), abs(highest), 1e-300)))
    if relief / _LEVELS <= finest:
        return 1.0
    return float(f"{round_down(relief / _LEVELS):.6g}")


def _trace(tin: TIN, chosen: Any, smooth: float | None) -> Features:
    lowest, highest = elevation_range(tin)
    is_positive = is_finite_number(chosen) and chosen > 0
    count = (highest - lowest) / chosen if is_positive else 0.0
    if count > _MOST_LEVELS:
        raise OptionError(
            "interval",
            chosen,
            f"so large that there are at most {_MOST_LEVELS:,} levels on a plan, and here there "
            f"would be {math.floor(count):,}",
        )
    return contours(tin, interval=chosen, smooth=smooth)


# ---------------------------------------------------------------- lines


def _gather_lines(tin: TIN) -> tuple[dict[str, Paths], Paths]:
    found = find_lines(tin)
    linework = {kind: _chain_edges(tin.points, pairs) for kind, pairs in found.by_kind().items()}
    known = {tuple(pair) for pair in np.sort(found.pairs, axis=1).tolist()}
    bare = [
        pair
        for ring in tin.boundary
        for pair in zip(ring.tolist(), np.roll(ring, -1).tolist(), strict=True)
        if (min(pair), max(pair)) not in known
    ]
    return linework, _chain_edges(tin.points, np.array(bare, np.int64).reshape(-1, 2))


def find_lines(tin: TIN) -> LineEdges:
    """Return the edges of lines; of a surface that knows none, its constrained edges are lines.

    Those at its rim are no boundary that somebody gave: a surface that was trimmed has them too.
    """
    if len(tin.lines):
        return find_line_edges(tin, guess=False)
    found = find_line_edges(tin)
    is_inner = found.kinds != EDGE_KINDS.index("boundary")
    return LineEdges(found.pairs[is_inner], found.kinds[is_inner])


def _chain_edges(points: Float64Array, pairs: AnyArray) -> Paths:
    vertices, counts = join_edges(pairs)
    return Paths.whole(points[vertices, :2], find_offsets(counts))


# ---------------------------------------------------------------- points


def _gather_marks(tin: TIN, survey: Survey | None, points: str) -> Marks:
    numbers = () if survey is None else survey.attributes.get("number", ())
    has_numbers = points in ("numbers", "both")
    if has_numbers and len(numbers) == 0:
        raise OptionError(
            "points", points, "'marks' or 'elevations' where there is no survey with point numbers"
        )
    xyz = tin.points if survey is None else survey.points
    known = [one.elevation_unit for one in (tin, survey) if one is not None]
    if None not in known and known[0] != known[-1]:
        raise OptionError(
            "survey",
            f"with elevations in {known[-1]}",
            f"one with elevations in {known[0]}, as those of the surface",
        )
    return Marks(
        xyz[:, :2],
        [clean_text(str(number)) for number in numbers] if has_numbers else [],
        write_elevations(xyz[:, 2]) if points in ("elevations", "both") else [],
    )


def write_elevations(elevations: Iterable[float]) -> list[str]:
    """Write elevations with the decimals that they need, at most three, the same number for all.

    Examples
    --------
    >>> write_elevations([318.5, 320.25])
    ['318.50', '320.25']
    """
    values = np.asarray(elevations, np.float64)
    for decimals in range(_MOST_DECIMALS):
        if np.array_equal(values.round(decimals), values):
            break
    else:
        decimals = _MOST_DECIMALS
    return [f"{value + 0.0:.{decimals}f}" for value in values.tolist()]


def describe_count(tin: TIN, survey: Survey | None) -> str:
    """Say how many points a surface has; those of a survey may be more than its vertices."""
    count = len(tin.points) if survey is None else len(survey)
    return f"{counted(count, 'point')}, {counted(len(tin.triangles), 'triangle')}"
