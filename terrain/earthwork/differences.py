"""The difference of two surfaces as a surface."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, NoReturn

import numpy as np

from ..._products import product
from ..._progress import Progress
from ...errors import OptionError, PointsError
from ...tin.validation.threads import thread_count
from .. import _kernel
from ..results import Features, Table
from ..results.columns import join_notes
from . import zones as parts
from .cells import fan_out
from .meshes import as_mesh, cut_at_zero, mend, part_places, rebuild
from .reference import Reference, Surface, find_common_reference, require_finite
from .slivers import leave_out_slivers, measure_rounding
from .statistics import percentiles

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from ..._progress import Tell
    from ...arrays import Float64Array, Int32Array
    from ...tin import TIN

    _Mesh = tuple[Float64Array, Int32Array]

__all__ = ["Difference", "difference"]

_SHARE_OF_VOLUME = 1e-7
"""Of the area times the largest difference: so much the volumes of the TIN may be off."""
_ROUNDINGS = 4.0
"""Or what so many roundings of every coordinate change: surfaces that agree differ by no more."""

_MOST_VERTICES = (2**31 - 1) // 4
"""Of an overlay: the kernel numbers them in 32 bits."""

_TOO_THIN = "The surfaces overlap only in what is thinner than coordinates can tell."

_SHARES = {"p05": 5.0, "p25": 25.0, "median": 50.0, "p75": 75.0, "p95": 95.0}


@dataclass(frozen=True, eq=False, repr=False)
class Difference:
    """The difference of two surfaces, made by :func:`tinsmith.difference`.

    Attributes
    ----------
    tin : TIN
        Its elevation is that of the other surface less that of the first: above 0 where there is
        fill, below where there is cut. Its edges are those of both TINs and the zero line.
    notes : tuple of str
        What was assumed or converted.

    Examples
    --------
    >>> import tinsmith as ts
    >>> flat = ts.triangulate([[0, 0, 1], [4, 0, 1], [4, 4, 1], [0, 4, 1]])
    >>> ramp = ts.triangulate([[0, 0, 0], [4, 0, 4], [4, 4, 4], [0, 4, 0]])
    >>> found = ts.difference(flat, ramp)
    >>> found.cut, found.fill, found.statistics["mean"]
    (2.0, 18.0, array([1.]))
    >>> found.zero_line.columns["length"]
    array([4.])
    """

    tin: TIN
    notes: tuple[str, ...]
    _reference: Reference
    _sums: dict[str, float]

    def with_notes(self, notes: Sequence[str]) -> Difference:
        """Return the same with further notes in front of its own, those of its parts too.

        Examples
        --------
        >>> import tinsmith as ts
        >>> flat = ts.triangulate([[0, 0, 1], [4, 0, 1], [4, 4, 1], [0, 4, 1]])
        >>> ts.difference(flat, flat).with_notes(["One row was left out."]).zones.notes
        ('One row was left out.', ...)
        """
        told = join_notes(notes, self.notes)
        if told == self.notes:
            return self
        reference = replace(self._reference, notes=told)
        return replace(self, tin=self.tin.with_notes(told), notes=told, _reference=reference)

    @property
    def cut(self) -> float:
        """Volume between the surfaces where the other one is below, CRS units cubed."""
        return self._sums["cut"] * self._reference.up

    @property
    def fill(self) -> float:
        """Volume between the surfaces where the other one is above, CRS units cubed."""
        return self._sums["fill"] * self._reference.up

    @cached_property
    def zero_line(self) -> Features:
        """The lines between parts that are cut, filled and unchanged, what is higher on the left.

        They are closed, or end at the boundary or where three parts meet. Where the surfaces
        agree on an area its border is a line, such as that of a design that meets the ground.
        """
        return parts.trace_zero_line(self.tin.triangulation, self._reference)

    @cached_property
    def zones(self) -> Features:
        """The connected parts that are cut, filled or unchanged as polygons.

        Columns ``kind`` ("cut", "fill", "unchanged"), ``area``, ``volume``, ``lowest``,
        ``highest``.
        """
        return parts.find_zones(self.tin.triangulation, self._reference)

    @cached_property
    def statistics(self) -> Table:
        """Mean, root mean square and others of the difference, weighted by area: one row.

        ``mean``, ``rms``, ``standard_deviation``, ``mean_absolute``, ``lowest``, ``highest``,
        percentiles ``p05``, ``p25``, ``median``, ``p75``, ``p95``, and the ``area``.
        """
        columns = _list_moments(self._sums)
        columns |= dict(zip(_SHARES, self.percentiles(list(_SHARES.values())), strict=True))
        units: dict[str, Any] = dict.fromkeys(columns, self._reference.elevation_unit)
        units["area"] = self._reference.units.area
        return Table(
            {name: np.array([value]) for name, value in columns.items()},
            units=units,
            name="difference",
            notes=self.notes,
        )

    def percentiles(self, shares: Sequence[float]) -> Float64Array:
        """Return the differences at and under which given shares of the area lie.

        Parameters
        ----------
        shares : sequence of float
            From 0 to 100.

        Returns
        -------
        (k,) float64 array, unit of elevations

        Examples
        --------
        >>> import tinsmith as ts
        >>> flat = ts.triangulate([[0, 0, 0], [4, 0, 0], [4, 4, 0], [0, 4, 0]])
        >>> ramp = ts.triangulate([[0, 0, 0], [4, 0, 8], [4, 4, 8], [0, 4, 0]])
        >>> ts.difference(flat, ramp).percentiles([10, 50])
        array([0.8, 4. ])
        """
        try:
            wanted = np.asarray(shares, np.float64)
        except (TypeError, ValueError):
            wanted = np.full(1, np.nan)
        if wanted.ndim != 1 or not ((wanted >= 0) & (wanted <= 100)).all():
            raise OptionError("percentiles", shares, allowed="numbers from 0 to 100")
        return percentiles(Surface(self.tin.points, self.tin.triangles), wanted.tolist())

    def __repr__(self) -> str:
        return f"<Difference: {self.tin!r}>"


def _list_moments(sums: dict[str, float]) -> dict[str, float]:
    area = sums["area"]
    mean, square = (sums["fill"] - sums["cut"]) / area, sums["squares"] / area
    return {
        "area": area,
        "mean": mean,
        "rms": float(np.sqrt(square)),
        "standard_deviation": float(np.sqrt(max(square - mean * mean, 0.0))),
        "mean_absolute": (sums["fill"] + sums["cut"]) / area,
        "lowest": sums["lowest"],
        "highest": sums["highest"],
    }


@product
def difference(
    tin: TIN, other: TIN, *, progress: Callable[[float], None] | None = None
) -> Difference:
    """Subtract a surface from another one, exactly where both are.

    Parameters
    ----------
    tin : TIN
        For example the ground as it is, or was.
    other : TIN
        The surface that it is subtracted from.
    progress : callable, optional
        Called with the fraction done, ascending to 1.0, between the stages, and more finely while
        the statistics are summed up. What it raises ends the call.

    Returns
    -------
    Difference
        A TIN of the difference with its zero line, cut and fill as polygons, and statistics.

    Raises
    ------
    CrsError
        As :func:`tinsmith.volume`.
    PointsError
        If the surfaces do not overlap, or only in what is thinner than coordinates can tell.

    Notes
    -----
    Vertices are those of both TINs and the places where their edges cross, rounded once: a cell
    that is thinner than the rounding is merged with the next. Triangles along the boundary that are
    as thin, as between the points of a slanted line, are left out of the TIN. Two TINs of n
    vertices each have an overlay of some 8 n vertices; memory goes with it, about 2 kB for each of
    the n. Statistics are those of the surfaces as they are; the TIN is refused if its volumes
    differ from theirs.

    Examples
    --------
    >>> import tinsmith as ts
    >>> flat = ts.triangulate([[0, 0, 1], [4, 0, 1], [4, 4, 1], [0, 4, 1]])
    >>> ramp = ts.triangulate([[0, 0, 0], [4, 0, 2], [4, 4, 2], [0, 4, 0]])
    >>> found = ts.difference(flat, ramp)
    >>> found.statistics["highest"], sorted(found.zones.columns["kind"])
    (array([1.]), ['cut', 'fill'])
    """
    done = Progress(progress)
    reference, first, second = find_common_reference(tin, other, "Differences")
    done(0.05)
    trimmed = _trim((tin, other), (first, second))
    made = _overlay(*trimmed)
    done(0.3)
    if len(made.triangles) == 0:
        _refuse_empty(first, second)
    require_finite(made.vertices)
    sums = _sum_differences(first, second, done.stage(0.3, 0.5))
    if not sums["area"] > 0.0:
        raise PointsError(_TOO_THIN)
    triangles, cells = fan_out(made.offsets, made.corners)
    slack = _measure_rounding(*trimmed, made.vertices, triangles, made.triangles[cells])
    given = cut_at_zero(made.vertices, triangles)
    done(0.6)
    made_sound = _make_sound(*given, _make_holder(tin, other))
    surface = _choose_surface(made_sound, reference, sums, slack)
    done.end()
    return Difference(surface, reference.notes, reference, sums)


def _choose_surface(
    candidates: Iterator[_Mesh], reference: Reference, sums: dict[str, float], slack: float
) -> TIN:
    """Return the first mesh whose volumes are those of the surfaces.

    Raises
    ------
    PointsError
        If there is none: rounding has moved a wall, or left nothing.
    """
    least = np.inf
    for mesh in candidates:
        surface = as_mesh(*mesh, crs=reference.crs, elevation_unit=reference.elevation_unit)
        apart = _measure_disagreement(surface, sums)
        most = max(sums["highest"], -sums["lowest"])
        if apart <= _SHARE_OF_VOLUME * sums["area"] * most + _ROUNDINGS * slack:
            return surface
        least = min(least, apart)
    if np.isfinite(least):
        raise PointsError(
            "The surfaces have walls that are thinner than coordinates can tell: the volume of "
            f"their difference as a TIN would be off by {least:.3g}. Round the points of both to "
            "a unit that they are surveyed in, such as a millimetre."
        )
    raise PointsError(
        "What both surfaces cover is thinner than coordinates can tell: round the points of both "
        "to a unit that they are surveyed in, such as a millimetre."
    )


def _trim(tins: Sequence[TIN], surfaces: Sequence[Surface]) -> tuple[Surface, Surface]:
    """Return two surfaces without the triangles that lie along a boundary by rounding only.

    Their planes have any slope: what is interpolated in them at a rounded place is wrong by much
    more than they have area.
    """
    rounding = max(measure_rounding(surface.points) for surface in surfaces)
    first, second = (
        Surface(
            surface.points,
            leave_out_slivers(surface.points, surface.triangles, tin.neighbors, rounding)[0],
        )
        for tin, surface in zip(tins, surfaces, strict=True)
    )
    return first, second


def _refuse_empty(first: Surface, second: Surface) -> NoReturn:
    """Refuse surfaces that do not overlap, or only in triangles that were left out.

    Raises
    ------
    PointsError
    """
    if len(_overlay(first, second).triangles):
        raise PointsError(_TOO_THIN)
    raise PointsError(
        f"The surfaces do not overlap: one covers {_describe_extent(first)}, the other "
        f"{_describe_extent(second)}."
    )


def _overlay(first: Surface, second: Surface) -> _kernel.OverlayMesh:
    try:
        return _kernel.overlay(first.points, first.triangles, second.points, second.triangles)
    except OverflowError:
        raise PointsError(
            f"The overlay of both surfaces has more than {_MOST_VERTICES:,} vertices: subtract "
            "parts of them."
        ) from None


def _sum_differences(first: Surface, second: Surface, progress: Tell | None) -> dict[str, float]:
    groups = np.zeros(len(first.triangles), np.int32)
    workers = thread_count(None, len(first.points) + len(second.points))
    sums = _kernel.sum_between(
        first.points,
        first.triangles,
        groups,
        1,
        second.points,
        second.triangles,
        1.0,
        workers,
        progress,
    )
    require_finite(sums)
    return dict(zip(_kernel.SUMS, sums[0].tolist(), strict=True))


def _measure_rounding(
    first: Surface,
    second: Surface,
    vertices: Float64Array,
    triangles: Int32Array,
    pairs: Int32Array,
) -> float:
    """Return how much a volume changes if the surfaces move by a rounding of their coordinates.

    That is the rounding times the rise over run of both, summed over the area of their overlay.
    """
    areas = np.abs(_measure_doubled(vertices, triangles))
    total = 0.0
    for k, surface in enumerate((first, second)):
        whole = np.abs(_measure_doubled(surface.points, surface.triangles))[pairs[:, k]]
        with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
            shares = np.fmin(areas / whole, 1.0)  # of a triangle thinner than its rounding, all
            total += float((shares * _measure_rises(surface)[pairs[:, k]]).sum())
    moved = float(np.spacing(np.abs(vertices[:, :2]).max())) * total
    return moved if np.isfinite(moved) else 0.0


def _measure_doubled(points: Float64Array, triangles: Int32Array) -> Float64Array:
    xy = points[triangles, :2]
    (ux, uy), (vx, vy) = (xy[:, 1] - xy[:, 0]).T, (xy[:, 2] - xy[:, 0]).T
    doubled: Float64Array = ux * vy - uy * vx
    return doubled


def _measure_rises(surface: Surface) -> Float64Array:
    """Return the rise over run of each triangle times its area, in the units that it has."""
    corners = surface.points[surface.triangles]
    u, v = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    (ux, uy, uz), (vx, vy, vz) = u.T, v.T
    with np.errstate(invalid="ignore", over="ignore"):
        rises: Float64Array = 0.5 * np.hypot(uy * vz - uz * vy, uz * vx - ux * vz)
    return rises


def _measure_disagreement(surface: TIN, sums: dict[str, float]) -> float:
    """Return by how much a volume of a TIN is not that of the surfaces."""
    found = _sum_classes(surface)
    return max(abs(found[name] - sums[name]) for name in ("cut", "fill"))


def _sum_classes(surface: TIN) -> dict[str, float]:
    """Return cut and fill in the triangles that count as cut and as filled."""
    mesh = surface.triangulation
    heights = np.ascontiguousarray(mesh.points[:, 2])
    groups = parts.classify(mesh).astype(np.int32) + np.int32(1)
    sums = _kernel.sum_heights(mesh.points, mesh.triangles, heights, groups, 3, 1.0)
    column = _kernel.SUMS.index
    return {"cut": float(sums[0, column("cut")]), "fill": float(sums[2, column("fill")])}


def _make_sound(
    points: Float64Array, triangles: Int32Array, holds: Callable[[Any], Any]
) -> Iterator[_Mesh]:
    """Yield the overlay mended, with walls a rounding wider, and triangulated anew.

    Where a new vertex moved the zero line, it is cut once more.
    """
    for placed in (points, part_places(points, triangles)):
        mended = mend(placed, triangles)
        if mended is not None:
            yield mended
    for found in rebuild(points, triangles, holds):
        yield mend(*cut_at_zero(*found)) or found


def _make_holder(tin: TIN, other: TIN) -> Callable[[Any], Any]:
    """Return a function that tells whether both surfaces hold places."""
    return lambda xy: (tin.locate(xy) >= 0) & (other.locate(xy) >= 0)


def _describe_extent(surface: Surface) -> str:
    used = surface.points[surface.triangles.ravel(), :2]
    (west, south), (east, north) = used.min(axis=0), used.max(axis=0)
    return f"{west:.10g} to {east:.10g} east, {south:.10g} to {north:.10g} north"
