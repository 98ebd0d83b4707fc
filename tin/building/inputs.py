"""Inputs of a build: all that a TIN is a function of."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.crs import CRS, Unit, require_one_unit, require_same_unit
from ...base.errors import CrsError, LinesError
from ...base.ranges import describe_span, require_degrees
from ...base.records import require, require_finite
from ...base.sentences import coordinate, counted, height
from .. import _kernel
from ..constraints import (
    Clip,
    LineSet,
    as_sequence,
    gather_extent,
    gather_lines,
    gather_regions,
    gather_rings,
    require_length,
    starts_with_elevations,
)
from ..validation import as_masked_points, require_three, thread_count
from .reference import adds_to, settle_crs
from .survey import Survey

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from ...base.arrays import BoolArray, Float64Array, Int64Array
    from ...base.crs import CrsLike, UnitLike
    from ...base.types import GeometriesLike, PointsLike, RowSources
    from ..constraints import Breakline, Water
    from .options import BuildOptions

_NAMES = ("points", "breaklines", "boundary", "holes", "erase", "water")


@dataclass(frozen=True, eq=False, kw_only=True)
class BuildInputs:
    """Points, lines and options, checked: the same inputs give the same TIN."""

    points: Float64Array
    """(n, 3)."""
    is_masked: BoolArray | None
    """(n,), rows that are left out; None if there are none."""
    lines: LineSet
    boundary: list[Float64Array]
    extent: list[Float64Array]
    """Rings, (k, 2) each, the first corner not repeated."""
    holes: list[list[Float64Array]]
    erase: list[list[Float64Array]]
    """The rings of each region, (k, 2): the outer one, then its islands."""
    options: BuildOptions
    crs: CRS | None
    elevation_unit: Unit | None = None
    has_own_boundary: bool = False
    """Whether some of the lines are edges of the boundary of existing triangles."""
    from_raster: bool = False
    skipped: Mapping[str, int] = field(default_factory=dict)
    row_sources: RowSources | None = None
    notes: Sequence[str] = ()
    source: str = ""
    """Name of the file that the points come from; empty if there is none."""

    def _require_sound(self, n_rows: int) -> None:
        """Refuse stored inputs of other than so many rows, whose points are still missing."""
        self.lines._require_sound()
        if self.is_masked is not None:
            require(self.is_masked.shape == (n_rows,), "masked rows")
        for rings in (self.boundary, self.extent, *self.holes, *self.erase):
            for ring in rings:
                require(ring.ndim == 2 and ring.shape[1] in (2, 3) and len(ring) >= 3, "a ring")
                require_finite(ring, ring.shape, "a ring")
        if self.has_own_boundary:
            return  # of existing triangles, whose rings are those of the surface
        n_holes = sum(map(len, self.holes))
        count = {"boundary": len(self.boundary) + len(self.extent), "hole": n_holes}
        for kind, source in zip(self.lines.kinds, self.lines.sources.tolist(), strict=True):
            require(source < count.get(kind, source + 1), "rings of lines")

    @property
    def is_plain(self) -> bool:
        """Whether there are only points, all of which count, and all of the hull is the surface."""
        is_whole = not (self.lines.kinds or self.erase or self.is_trimmed)
        return is_whole and self.is_masked is None

    @property
    def clip(self) -> Clip:
        """Which part of the hull is the surface."""
        return Clip(
            boundary=self.boundary,
            extent=self.extent,
            holes=self.holes,
            has_own_boundary=self.has_own_boundary,
            max_edge=self.options.max_edge,
            is_trimmed_everywhere=self.options.trim == "everywhere",
        )

    @property
    def is_clipped(self) -> bool:
        """Whether only a part of the hull may be the surface."""
        return not self.clip.is_none

    @property
    def is_trimmed(self) -> bool:
        """Whether triangles at long edges are dropped."""
        return self.options.max_edge is not None

    @property
    def threads(self) -> int:
        """How many threads build it."""
        return thread_count(self.options.threads, len(self.points))

    def with_sources_of(self, rows: Int64Array | None) -> BuildInputs:
        """Return the same inputs, whose rows are these of all rows ever given; None for all."""
        if rows is None or self.row_sources is None:
            return self
        sources = self.row_sources
        is_known = rows < len(sources.lines)
        taken = sources.take(np.where(is_known, rows, 0))
        lines = np.where(is_known, taken.lines, 0)
        return replace(self, row_sources=taken._replace(lines=lines))

    def with_lines(self, lines: LineSet) -> BuildInputs:
        """Return the same inputs with other lines, rings among them.

        Raises
        ------
        LinesError
            If all vertices of a line are at one place, or a ring crosses itself.
        """
        require_length(lines)
        _require_simple_rings(lines)
        if self.has_own_boundary:
            return replace(self, lines=lines)
        rings = {
            kind: [
                lines.xy[lines.offsets[line] : lines.offsets[line + 1] - 1]
                for line, own in enumerate(lines.kinds)
                if own == kind
            ]
            for kind in ("boundary", "hole")
        }
        corners = iter(rings["hole"])
        return replace(
            self,
            lines=lines,
            boundary=rings["boundary"][: len(self.boundary)],
            extent=rings["boundary"][len(self.boundary) :],
            holes=[[next(corners) for _ in hole] for hole in self.holes],
        )


@cache
def _make_empty_survey() -> Survey:
    """Return what there is besides points that are given alone."""
    return Survey(points=np.empty((0, 3)))


def gather_inputs(
    points: Survey | PointsLike,
    options: BuildOptions,
    *,
    breaklines: Sequence[Breakline | ArrayLike] | GeometriesLike,
    boundary: Sequence[Any] | GeometriesLike,
    holes: Sequence[Any] | GeometriesLike,
    erase: Sequence[Any] | GeometriesLike,
    water: Sequence[Water] | GeometriesLike,
    crs: CrsLike | None,
    elevation_unit: UnitLike | None,
) -> BuildInputs:
    """Check everything; lines come on top of the survey's own."""
    own = points if isinstance(points, Survey) else _make_empty_survey()
    system, unit = _settle_reference(own, CRS.of(crs), Unit.of(elevation_unit))
    given = zip(_NAMES, (points, breaklines, boundary, holes, erase, water), strict=True)
    system, told = settle_crs(system, dict(given))
    rows = points.points if isinstance(points, Survey) else points
    xyz, is_masked = as_masked_points(rows, threads=options.threads)
    # refuse points that are no longitudes and latitudes; tell of a wide span
    require_degrees(xyz, system, "Points")
    told += describe_span(xyz if is_masked is None else xyz[~is_masked], system, "Points")
    outer = [*own.boundary, *as_sequence(boundary, "boundary")]
    inner = [*own.holes, *as_sequence(holes, "holes")]
    open_lines = [*own.breaklines, *as_sequence(breaklines, "breaklines")]
    flat = [*own.water, *as_sequence(water, "water")]
    lines = gather_lines(open_lines, outer, inner, flat)
    if not lines.kinds and not own.extent:
        require_three(len(xyz))
    _require_simple_rings(lines)
    require_degrees(lines.xy, system, "Vertices of lines")
    rings = gather_rings(outer, "boundary")
    if own.extent:
        lines = LineSet.join([lines, gather_extent(own.extent, len(rings))])
    return BuildInputs(
        points=xyz,
        is_masked=is_masked,
        lines=lines,
        boundary=rings,
        extent=gather_rings(own.extent, "extent"),
        holes=gather_regions(inner, "hole"),
        erase=gather_regions([*own.erase, *as_sequence(erase, "erase")], "erase"),
        options=options,
        crs=system,
        elevation_unit=require_one_unit(system, unit),
        from_raster=own.from_raster,
        skipped=own.skipped,
        row_sources=own.row_sources,
        notes=(*own.notes, *told, *_describe_rings(outer, inner)),
        source=own.source or "",
    )


def _describe_rings(boundary: Sequence[Any], holes: Sequence[Any]) -> list[str]:
    """Tell where rings close with several elevations."""
    starts = [*starts_with_elevations(boundary, "boundary"), *starts_with_elevations(holes, "hole")]
    if not starts:
        return []
    label, start = starts[0]
    x, y, lowest = start[0].tolist()
    return [
        f"{len(starts)} ring{'s close' if len(starts) > 1 else ' closes'} with more than one "
        f"elevation (first: {label} at x {coordinate(x)}, y {coordinate(y)}, {height(lowest)} to "
        f"{height(start[-1, 2])}): the lowest was taken."
    ]


def _settle_reference(
    own: Survey, crs: CRS | None, unit: Unit | None
) -> tuple[CRS | None, Unit | None]:
    """Return CRS and unit of elevations, which a caller may add to the survey's own, not change."""
    if crs is not None and own.crs is not None and not adds_to(own.crs, crs):
        raise CrsError(
            f"The survey is in {own.crs.label}, and {crs.label} is another CRS: its points must be "
            "reprojected first, for example while they are read.",
            crs=crs,
        )
    if own.elevation_unit is not None and unit is not None:
        require_same_unit(own.elevation_unit, unit, "that of the survey")
    system = own.crs if crs is None else crs
    return system, require_one_unit(system, unit or own.elevation_unit)


def _require_simple_rings(lines: LineSet) -> None:
    for line, kind in enumerate(lines.kinds):
        if kind in ("hard", "soft") or lines.sources[line] < 0:
            continue
        rows = np.arange(lines.offsets[line], lines.offsets[line + 1], dtype=np.int32)
        corners = np.append(rows[:-1], rows[0]) - rows[0]
        xy = np.ascontiguousarray(lines.xy[rows[:-1]])
        segments = np.ascontiguousarray(np.stack([corners[:-1], corners[1:]], axis=1))
        crossings = _kernel.crossings(xy, segments)
        if len(crossings):
            x, y = _kernel.intersections(xy, segments, crossings[:1])[0]
            label = lines.label(line)
            places = counted(len(crossings), "place")
            raise LinesError(
                f"{label[0].upper() + label[1:]} crosses itself at {places} "
                f"(first: x {coordinate(x)}, y {coordinate(y)}): a ring must not.",
                lines=[line],
            )
