"""Contents: what there is to draw on the sheets of a plan, in coordinates of the ground."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.checks import is_finite_number
from ...base.errors import OptionError
from ...base.georeference import label_axes, require_same_crs
from ...base.sentences import counted
from ...tin.topology import find_offsets
from ..drawing import EDGE_KINDS, LineEdges, find_line_edges, join_edges, round_down
from ..isolines import contours, elevation_range
from .clipping import Paths
from .point_labels import gather_marks

if TYPE_CHECKING:
    from ...base.arrays import AnyArray, Float64Array
    from ...base.georeference import Label as AxisLabel
    from ...base.results import Features
    from ...tin import TIN, Survey
    from .footprint import Footprint
    from .point_labels import Marking, Marks
    from .stations import Stationed

_MOST_LEVELS = 2000
"""More contours than a sheet has room for: the interval was given in another unit, or by a slip."""
_LEVELS = 12


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
    marks: tuple[Marks, ...]
    label_size: float
    """Height of digits beside them, millimetres."""
    axis: Stationed | None
    axes: tuple[AxisLabel, AxisLabel]
    """How coordinates across and up the map are written."""
    notes: tuple[str, ...]


def gather_contents(
    tin: TIN,
    footprint: Footprint,
    *,
    interval: float | None,
    smooth: float | None,
    marking: Marking,
    survey: Survey | None,
    axis: Stationed | None,
) -> Contents:
    """Trace contours, and gather lines and points.

    Raises OptionError if an interval makes too many levels, or points have no such texts. Raises
    CrsError if the survey is in another CRS.
    """
    chosen = choose_interval(tin) if interval is None else interval
    lines = _trace(tin, chosen, smooth)
    notes = [*lines.notes, *marking.notes, *(axis.notes if axis else ())]
    if survey is not None:
        notes += require_same_crs(survey.crs, tin.crs, "the survey")
    linework, outline = _gather_lines(tin)
    return Contents(
        contours=lines,
        interval=float(chosen),
        linework=linework,
        outline=outline,
        footprint=footprint,
        marks=gather_marks(tin, survey, marking),
        label_size=marking.size,
        axis=axis,
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


def describe_count(tin: TIN, survey: Survey | None) -> str:
    """Say how many points a surface has; those of a survey may be more than its vertices."""
    count = len(tin.points) if survey is None else len(survey)
    return f"{counted(count, 'point')}, {counted(len(tin.triangles), 'triangle')}"
