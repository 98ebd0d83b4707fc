"""Clip a surface by polygons."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.checks import require_tin
from ...base.errors import choice
from ...base.georeference import find_plane_units
from ...base.policies import ClippedPart
from ...base.products import product
from ...base.progress import Progress
from ...base.sentences import counted, inflect
from ...tin import topology
from ...tin.meshing import clip_tin
from ..surface import Surface, double_areas
from .regional import split_pieces, unite_regions
from .regions import as_regions

if TYPE_CHECKING:
    from collections.abc import Callable

    from ...base.arrays import Float64Array
    from ...tin import TIN
    from ...tin.meshing import Clipped

_ROUNDINGS = 16.0
"""Of the largest coordinate: as a strip so wide along a border an area may be off."""


@product
def clip(
    tin: TIN,
    polygons: Any,
    *,
    keep: ClippedPart = "inside",
    progress: Callable[[float], None] | None = None,
) -> TIN:
    """Keep the part of a surface inside polygons, or outside them, without changing it.

    Triangles wholly inside stay as they are, those that a polygon crosses are divided along it.
    The ``boundary`` of :func:`tinsmith.triangulate` does something else: it triangulates the points
    within the boundary anew, so that the surface is another one along it.

    Parameters
    ----------
    tin : TIN
    polygons : polygons
        One or several: Features, GeoDataFrame or whatever has a ``__geo_interface__``, a sequence
        of rings or polygons, a mapping of names to them. Their holes and parts count; what several
        of them hold counts once. Elevations of theirs are not looked at.
    keep : {"inside", "outside"}
        Which part of the surface is kept.
    progress : callable, optional
        Called with the fraction done, ascending to 1.0, by stages. What it raises ends the call.

    Returns
    -------
    TIN
        Vertices keep rows, elevations and attributes; those made where a polygon crosses edges, and
        its corners, lie on the planes of their triangles and have no attributes. Lines are cut off
        at the polygons, which become lines of the boundary, outside of them of holes.
        ``report.notes`` tell how much is left, and what the polygons hold beyond the surface.

    Raises
    ------
    CrsError
        If the polygons are in another CRS, or the CRS of the surface is not known and theirs is.
    LinesError
        If a polygon crosses itself or has no area; if polygons lie outside the surface, or cover
        all of it and what is outside is to be kept.
    OptionError
        If there is no polygon, or ``keep`` is none of the words.
    PointsError
        If triangles of the surface overlap, or vertices share a place.

    Notes
    -----
    A vertex on an edge is rounded to coordinates once, and the polygon and the edge bend by as much
    [1]_; elevations are interpolated along the edge, at corners in the triangle, to a rounding. So
    the surface is the same up to roundings of the coordinates, whatever the polygons touch, and its
    area and volumes are those of :func:`tinsmith.volume` in these ``regions``. Edges along the cut
    that are not Delaunay, and those of a surface of other triangles, are soft breaklines named
    "joint": with them the result is a constrained Delaunay triangulation, and can be edited. Where
    polygons cross one another, their common border is rounded as well.

    References
    ----------
    .. [1] J. D. Hobby, Practical segment intersection with finite precision output, Computational
       Geometry 13 (1999), doi:10.1016/S0925-7721(99)00021-8.

    Examples
    --------
    >>> import tinsmith as ts
    >>> tin = ts.triangulate([[0, 0, 5], [8, 0, 5], [8, 8, 9], [0, 8, 9], [4, 4, 8]])
    >>> part = ts.clip(tin, [[[1, 1], [6, 1], [6, 7], [1, 7]]])
    >>> part.area, part.report.notes
    (30.0, ('Clipped to 1 polygon: 30 of 64 square units are left, with 6 new vertices.',))
    >>> ts.clip(tin, [[[1, 1], [6, 1], [6, 7], [1, 7]]], keep="outside").area
    34.0
    """
    require_tin(tin)
    choice("keep", keep, ClippedPart)
    done = Progress(progress)
    names, parts, notes = as_regions(
        _as_several(polygons), tin.crs, option="polygons", noun="polygon"
    )
    one = parts.surface if len(names) == 1 else unite_regions(split_pieces(parts, len(names)))
    done(0.1)
    is_outside = keep == "outside"
    clipped = clip_tin(tin, _list_rings(one), outside=is_outside, progress=done.stage(0.1, 1.0))
    told = _describe(tin, clipped, one, counted(len(names), "polygon"), is_outside=is_outside)
    made = clipped.tin.with_name(tin.name)
    done.end()
    return made.replace(report=replace(made.report, notes=(*made.report.notes, *notes, *told)))


def _as_several(polygons: Any) -> Any:
    """Return polygons; one ring that is given alone as a sequence of one."""
    if hasattr(polygons, "__geo_interface__") or isinstance(polygons, dict):
        return polygons
    try:
        is_ring = np.asarray(polygons, float).ndim == 2
    except (TypeError, ValueError):
        return polygons
    return [polygons] if is_ring else polygons


def _list_rings(area: Surface) -> list[Float64Array]:
    """Return the rings around triangles, (k, 2) each."""
    neighbors = topology.neighbors_of(area.triangles, len(area.points))
    rings = topology.boundary_rings(area.triangles, neighbors)
    return [np.ascontiguousarray(area.points[ring, :2]) for ring in rings]


def _describe(
    tin: TIN, clipped: Clipped, area: Surface, polygons: str, *, is_outside: bool
) -> list[str]:
    """Tell how much is left, what was made, and what the polygons hold beyond the surface."""
    made, whole = clipped.tin.triangulation, tin.triangulation
    corners = counted(clipped.made, "new vertex", "new vertices")
    head = f"Cut away inside {polygons}" if is_outside else f"Clipped to {polygons}"
    if tin.crs is not None and tin.crs.is_geographic:
        left = f"{len(made.triangles):,} triangles are left, of {len(whole.triangles):,} before"
        return [f"{head}: {left}, with {corners}.", *_describe_joints(clipped.joints)]
    unit = find_plane_units(tin.crs).area or "square units"
    held = whole.area - made.area if is_outside else made.area
    notes = [f"{head}: {made.area:.9g} of {whole.area:.9g} {unit} are left, with {corners}."]
    beyond = 0.5 * float(double_areas(area.points, area.triangles).sum()) - held
    largest = max(float(np.abs(one.points[:, :2]).max()) for one in (whole, area))
    width = _ROUNDINGS * float(np.spacing(largest))
    around = float(np.hypot(*np.diff(area.points[area.find_border(), :2], axis=1)[:, 0].T).sum())
    if beyond > width * around:
        notes.append(
            f"The polygons reach beyond the surface by {beyond:.6g} {unit}, where there is none."
        )
    return notes + _describe_joints(clipped.joints)


def _describe_joints(count: int) -> list[str]:
    """Tell how many edges became soft breaklines."""
    if not count:
        return []
    edges = inflect(f"{counted(count, 'edge')} [is|are] not Delaunay, and stayed", count)
    kind = "a soft breakline" if count == 1 else "soft breaklines"
    return [f"So that the surface stays as it is, {edges} as {kind} named 'joint'."]
