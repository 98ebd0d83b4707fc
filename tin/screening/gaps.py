"""Gaps that a TIN spans without a word: voids between points, bays and slivers along the hull."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...base.georeference import find_scales
from ...base.sentences import counted
from .. import _kernel
from ..constraints import trim
from ..topology import NO_NEIGHBOR
from .parts import find_parts

if TYPE_CHECKING:
    from ...base.arrays import BoolArray, Float64Array, Int64Array
    from ..surface import TIN
    from ..triangulation import Triangulation

_USUAL = 95.0
_FAR = 5.0
"""An edge is long beyond so many times the length that 95 % of the edges do not exceed,"""
_EVEN = ((1.6, 2.5), (2.5, 3.0))
"""or fewer times where points are even: where that length is no more than so many times the median,
as in a grid, and at random."""
_MOST, _ALIKE, _REGULAR = 80.0, 0.02, 1.1
"""Points are a regular grid where this percentile is as long to 2 %: then beyond 1.1 times."""

_DEEP = 1.0
"""A bay is as deep, on average, as so many of the usual edges, slivers along the hull are not;"""
_WIDE_BAY, _WIDE_VOID = 4.0, 10.0
"""the area of a bay, or of a void, is that of so many squares of them."""
_LARGE = 100.0
"""Where it is that of so many it is told of in a surface of any size,"""
_SHARE = 0.005
"""else where all of them are so much of the area."""

_STEEP = 30.0
_STEEPER = 5.0
"""A sliver is steep above 30 degrees, if its gradient is 5 times that of 90 % of the triangles."""
_HIGHER = 8.0
"""And its third corner is above or below its longest edge by 8 times what half of them rise,"""
_SLIVERS = 1e-2
"""and the area in space of all such slivers is so much of the plane area of the surface."""

_SAMPLE = 20_000
_FLAT = 1e-3
"""Triangles of so much of the median area tell nothing of how long edges usually are."""


class _Limit(NamedTuple):
    """How long edges may be."""

    length: float
    """Along the boundary."""
    inside: float
    """Where points are even surveyors leave out what is flat: no less than five times."""
    usual: float
    """What 95 % of the edges do not exceed."""


def describe_gaps(tin: TIN, *, slivers: bool = True) -> list[str]:
    """Tell of triangles that span places without points.

    A sentence for triangles along the boundary, one for those inside, and if it is asked for, one
    for steep slivers along the hull; none for edges of lines. Linear in the triangles. Long is an
    edge of more than five times the 95th percentile of edge lengths, so that neither scan lines nor
    contour lines, whose points are dense along them alone, are found to have gaps; where points are
    even, as in a grid, of 1.1 to three times along the boundary. Connected triangles are a gap if
    they are as deep and as wide as several of these edges, which slivers along a hull are not, and
    if they matter: half a per cent of the area, or room for a hundred points.

    Examples
    --------
    >>> from tinsmith import triangulate
    >>> square = [[0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]]
    >>> describe_gaps(triangulate(square))
    []
    """
    surface = tin.triangulation
    if len(surface.triangles) == 0:
        return []
    with np.errstate(all="ignore"):
        return _describe_gaps(tin, surface, slivers=slivers)


def _describe_gaps(tin: TIN, surface: Triangulation, *, slivers: bool) -> list[str]:
    limit = _find_limit(surface)
    stays = np.ones(len(surface.triangles), np.bool_)
    if not 0.0 < limit.length < np.inf:
        return []
    is_long = _kernel.find_long_edges(surface.points, surface.triangles, limit.length)
    is_long &= ~surface.constrained
    first, second, third = is_long.T
    inside = np.flatnonzero(first | second | third)
    if len(inside):
        stays = trim(surface, stays, limit.length, everywhere=False)
        inside = inside[stays[inside]]
        longest = _find_longest(surface, inside)
        inside = inside[longest > limit.inside]
    outside = np.flatnonzero(~stays)
    unit = "units" if tin.crs is None else tin.crs.horizontal_unit.symbol
    told = []
    if _matter(surface, outside, limit, is_bay=True):
        what = f"as across a bay: `max_edge={limit.length:g}` trims them"
        told.append(_describe(surface, outside, unit, "along the boundary", what, limit))
    else:
        stays[:] = True  # slivers with long edges are told if they are steep
    if _matter(surface, inside, limit, is_bay=False):
        option = f"`max_edge={limit.inside:g}` with `trim='everywhere'`"
        what = f"as over a void: {option} leaves them out"
        told.append(_describe(surface, inside, unit, "inside", what, limit))
    return [*told, *(_describe_slivers(tin, surface, stays) if slivers else ())]


# ---------------------------------------------------------------- how long edges may be


def _find_limit(surface: Triangulation) -> _Limit:
    some = slice(None, None, max(1, len(surface.triangles) // _SAMPLE))
    areas = _measure_areas(surface, some)
    is_wide = areas > _FLAT * np.median(areas)  # not those along a hull that is straight but for
    lengths = np.sqrt(_square_lengths(surface, some)[is_wide])  # rounding, which have no area
    if len(lengths) == 0:
        return _Limit(np.inf, np.inf, np.inf)
    median, most, usual = (float(one) for one in np.percentile(lengths, (50.0, _MOST, _USUAL)))
    far = next((times for ratio, times in _EVEN if usual <= ratio * median), _FAR)
    inside = _FAR
    if usual <= _EVEN[0][0] * median and usual <= (1.0 + _ALIKE) * most:
        far = inside = _REGULAR
    return _Limit(_round_up(far * usual), _round_up(inside * usual), usual)


def _square_lengths(surface: Triangulation, chosen: Any) -> Float64Array:
    """Return the squares of the lengths of the edges opposite the corners, (k, 3), in the plane."""
    corners = surface.points[surface.triangles[chosen], :2]
    sides = corners[:, [2, 0, 1]] - corners[:, [1, 2, 0]]
    squares: Float64Array = (sides**2).sum(axis=2)
    return squares


def _find_longest(surface: Triangulation, chosen: Int64Array) -> Float64Array:
    """Return the length of the longest edge of some triangles that is on no line."""
    squares = np.where(surface.constrained[chosen], 0.0, _square_lengths(surface, chosen))
    longest: Float64Array = np.sqrt(squares.max(axis=1, initial=0.0))
    return longest


def _round_up(length: float) -> float:
    """Round up to two digits."""
    if not 0.0 < length < np.inf:
        return length
    unit = 10.0 ** (np.floor(np.log10(length)) - 1)
    return float(f"{np.ceil(length / unit) * unit:.6g}")


# ---------------------------------------------------------------- what is a gap


def _matter(surface: Triangulation, chosen: Int64Array, limit: _Limit, *, is_bay: bool) -> bool:
    """Tell whether some triangles make gaps that are worth telling."""
    if len(chosen) == 0:
        return False
    parts = find_parts(surface, chosen)
    areas = np.bincount(parts, _measure_areas(surface, chosen))
    is_gap = areas >= (_WIDE_BAY if is_bay else _WIDE_VOID) * limit.usual**2
    if is_bay:
        lengths = np.sqrt(_square_lengths(surface, chosen))
        outer = np.where(surface.neighbors[chosen] == NO_NEIGHBOR, lengths, 0.0).sum(axis=1)
        is_gap &= 2.0 * areas >= _DEEP * limit.usual * np.bincount(parts, outer)
    if not is_gap.any():
        return False
    is_large = areas.max(where=is_gap, initial=0.0) >= _LARGE * limit.usual**2
    return bool(is_large) or _measure_share(surface, areas[is_gap].sum()) >= _SHARE


def _measure_areas(surface: Triangulation, chosen: Any) -> Float64Array:
    a, b, c = (surface.points[surface.triangles[chosen, k], :2] for k in range(3))
    (ux, uy), (vx, vy) = (b - a).T, (c - a).T
    areas: Float64Array = (ux * vy - uy * vx) / 2.0
    return areas


def _measure_share(surface: Triangulation, area: float) -> float:
    """Return the share of the whole area, of which a sample of triangles tells."""
    some = slice(None, None, max(1, len(surface.triangles) // _SAMPLE))
    mean = float(_measure_areas(surface, some).mean())
    return area / max(area, mean * len(surface.triangles))


# ---------------------------------------------------------------- sentences


def _describe(
    surface: Triangulation, chosen: Int64Array, unit: str, where: str, what: str, limit: _Limit
) -> str:
    """Tell of triangles with long edges: where they are, and what to do."""
    longest = _find_longest(surface, chosen).max()
    share = 100.0 * _measure_share(surface, float(_measure_areas(surface, chosen).sum()))
    return (
        f"{_count_triangles(len(chosen))} {where} with edges of up to "
        f"{longest:.6g} {unit}, far longer than the usual {limit.usual:.3g} "
        f"({share:.{3 if share >= 99.5 else 2}g} % of the area), {what}."
    )


def _describe_slivers(tin: TIN, surface: Triangulation, stays: BoolArray) -> list[str]:
    """Tell of triangles along the hull that are far steeper than the ground."""
    is_outer = (surface.neighbors == NO_NEIGHBOR) & ~surface.constrained
    first, second, third = is_outer.T
    outer = np.flatnonzero((first | second | third) & stays)
    some = slice(None, None, max(1, len(stays) // _SAMPLE))
    usual = np.percentile(_compute_gradients(surface, some), 90)
    slivers = outer[_compute_gradients(surface, outer) > _STEEPER * usual]
    # how far some triangles rise, or fall, from their longest edges to the third corner
    apex = _square_lengths(surface, slivers).argmax(axis=1)
    corners = surface.points[surface.triangles[slivers]]
    a, b, c = (corners[np.arange(len(slivers)), (apex + k) % 3] for k in range(3))
    along = (c - b)[:, :2]
    share = ((a - b)[:, :2] * along).sum(axis=1) / (along**2).sum(axis=1)
    rises: Float64Array = np.abs(a[:, 2] - b[:, 2] - share * (c - b)[:, 2])
    # what half of some triangles do not rise by
    z = surface.points[surface.triangles[some], 2]
    slivers = slivers[rises > _HIGHER * float(np.median(np.ptp(z, axis=1)))]
    degrees = _measure_slopes(tin, slivers)
    slivers, degrees = slivers[degrees > _STEEP], degrees[degrees > _STEEP]
    area = float((_measure_areas(surface, slivers) / np.cos(np.radians(degrees))).sum())
    if len(slivers) == 0 or _measure_share(surface, area) < _SLIVERS:
        return []
    shortest = float(np.sqrt(_square_lengths(surface, slivers).max(axis=1).min()))
    return [
        f"{_count_triangles(len(slivers))} along the hull as steep as {degrees.max():.1f} "
        f"degrees, where the ground is not: a `max_edge` below {shortest:.4g} trims them."
    ]


def _compute_gradients(surface: Triangulation, chosen: Any) -> Float64Array:
    """Return the gradients of some triangles, in whatever units there are."""
    a, b, c = (surface.points[surface.triangles[chosen, k]] for k in range(3))
    east, north, up = np.cross(b - a, c - a).T
    steep: Float64Array = np.nan_to_num(np.hypot(east, north) / up, nan=0.0)  # infinite is largest
    return steep


def _measure_slopes(tin: TIN, chosen: Int64Array) -> Float64Array:
    """Return the slopes of some triangles in degrees, all coordinates in one unit of length."""
    scales = find_scales(tin.crs, tin.elevation_unit, float(np.median(tin.points[:, 1])))
    a, b, c = (tin.points[tin.triangles[chosen, k]] * scales for k in range(3))
    east, north, up = np.cross(b - a, c - a).T
    slopes: Float64Array = np.degrees(np.arctan2(np.hypot(east, north), up))
    return slopes


def _count_triangles(count: int) -> str:
    return f"There {'is' if count == 1 else 'are'} {counted(count, 'triangle')}"
