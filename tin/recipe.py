"""Recipe: all that a TIN is a function of."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal, get_args

import numpy as np

from . import _kernel
from .constrained import CrossingPolicy, LineOptions
from .duplicates import DuplicatePolicy
from .errors import LinesError, PointsError
from .line_set import (
    LineSet,
    as_sequence,
    gather_extent,
    gather_lines,
    gather_regions,
    gather_rings,
)
from .options import is_finite_number, is_one_of, shown
from .points import as_masked_points
from .survey import Survey
from .threads import thread_count

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from .lines import Breakline, Water

__all__ = ["Recipe", "TrimPolicy", "recipe_of"]

TrimPolicy = Literal["perimeter", "everywhere"]


@dataclass(frozen=True, eq=False, kw_only=True)
class Recipe:
    """Points, lines and options, checked: the same recipe gives the same TIN.

    Attributes
    ----------
    points : (n, 3) float64 array
    is_masked : (n,) bool array or None
        Rows that are left out; None if there are none.
    lines : LineSet
    boundary, extent : list of (k, 2) float64 arrays
        Rings, the first corner not repeated.
    holes, erase : list of lists of (k, 2) float64 arrays
        The rings of each region: the outer one, then its islands.
    max_edge : float
        Infinity for none.
    """

    points: NDArray[np.float64]
    is_masked: NDArray[np.bool_] | None
    lines: LineSet
    boundary: list[NDArray[np.float64]]
    extent: list[NDArray[np.float64]]
    holes: list[list[NDArray[np.float64]]]
    erase: list[list[NDArray[np.float64]]]
    max_edge: float
    trim: TrimPolicy
    conforming: bool
    options: LineOptions
    crs: str | None
    skipped: Mapping[str, int] = field(default_factory=dict)
    notes: Sequence[str] = ()

    @property
    def is_plain(self) -> bool:
        """Whether there are only points, all of which count, and all of the hull is the surface."""
        is_whole = not (self.lines.kinds or self.erase or np.isfinite(self.max_edge))
        return is_whole and self.is_masked is None


def recipe_of(
    points: Survey | ArrayLike,
    *,
    breaklines: Sequence[Breakline | ArrayLike],
    boundary: Sequence[Any],
    holes: Sequence[Any],
    erase: Sequence[Any],
    water: Sequence[Water],
    max_edge: float | None,
    trim: TrimPolicy,
    crossing: CrossingPolicy,
    conforming: bool,
    duplicates: DuplicatePolicy,
    snap: float,
    threads: int | None,
    crs: str | None,
) -> Recipe:
    """Check everything; lines come on top of the survey's own.

    Raises
    ------
    PointsError, LinesError
        As :func:`tinsmith.triangulate`.
    """
    _require_options(duplicates, snap, trim, crossing, max_edge)
    survey = points if isinstance(points, Survey) else None
    own = survey if survey is not None else Survey(points=np.empty((0, 3)))
    xyz, is_masked = as_masked_points(
        points.points if isinstance(points, Survey) else points, threads=threads
    )
    outer = [*own.boundary, *as_sequence(boundary, "boundary")]
    inner = [*own.holes, *as_sequence(holes, "holes")]
    lines = gather_lines(
        [*own.breaklines, *as_sequence(breaklines, "breaklines")],
        outer,
        inner,
        [*own.water, *as_sequence(water, "water")],
    )
    if len(xyz) < 3 and not lines.kinds:
        raise PointsError(
            f"{len(xyz)} points cannot make a TIN: at least three not collinear ones are needed."
        )
    _require_simple_rings(lines)
    rings = gather_rings(outer, "boundary")
    if own.extent:
        lines = LineSet.joined([lines, gather_extent(own.extent, len(rings))])
    return Recipe(
        points=xyz,
        is_masked=is_masked,
        lines=lines,
        boundary=rings,
        extent=gather_rings(own.extent, "extent"),
        holes=gather_regions(inner, "hole"),
        erase=gather_regions([*own.erase, *as_sequence(erase, "erase")], "erase"),
        max_edge=np.inf if max_edge is None else float(max_edge),
        trim=trim,
        conforming=bool(conforming),
        options=LineOptions(duplicates, float(snap), crossing, thread_count(threads, len(xyz))),
        crs=crs if crs is not None else own.crs,
        skipped=own.skipped,
        notes=own.notes,
    )


def _require_options(
    duplicates: str, snap: float, trim: str, crossing: str, max_edge: float | None
) -> None:
    for name, value, kind in (
        ("duplicates", duplicates, DuplicatePolicy),
        ("trim", trim, TrimPolicy),
        ("crossing", crossing, CrossingPolicy),
    ):
        if not is_one_of(value, get_args(kind)):
            allowed = ", ".join(get_args(kind))
            raise PointsError(f"Invalid {name} {shown(value)}: one of {allowed}.")
    if not (is_finite_number(snap) and snap >= 0):
        raise PointsError(f"Invalid snap {shown(snap)}: a distance >= 0 in CRS units is needed.")
    if max_edge is not None and not (is_finite_number(max_edge) and max_edge > 0):
        raise PointsError(
            f"Invalid max_edge {shown(max_edge)}: a length > 0 in CRS units is needed."
        )


def _require_simple_rings(lines: LineSet) -> None:
    for line, kind in enumerate(lines.kinds):
        if kind in ("hard", "soft"):
            continue
        rows = np.arange(lines.offsets[line], lines.offsets[line + 1], dtype=np.int32)
        corners = np.append(rows[:-1], rows[0]) - rows[0]
        xy = np.ascontiguousarray(lines.xy[rows[:-1]])
        segments = np.ascontiguousarray(np.stack([corners[:-1], corners[1:]], axis=1))
        crossings = _kernel.crossings(xy, segments)
        if len(crossings):
            x, y = _kernel.intersections(xy, segments, crossings[:1])[0]
            label = lines.label(line)
            raise LinesError(
                f"{label[0].upper() + label[1:]} crosses itself at {len(crossings)} places "
                f"(first: x {x:.6g}, y {y:.6g}): a ring must not.",
                lines=[line],
            )
