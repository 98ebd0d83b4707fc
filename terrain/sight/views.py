"""Viewsheds: the vertices and triangles of a surface that are seen from one place."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...errors import OptionError, PointsError
from ...tin.types import seal
from ...tin.validation.options import is_finite_number
from ..earthwork.reference import find_reference
from ..georeference import find_plane_units
from ..hydrology.paths import as_places
from ..relief.dissolving import dissolve, make_polygons
from ..results import Features
from ..slope import measure_plane_areas
from .lines import as_height, raise_places
from .rays import Rays, find_blocks, find_curvature

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ...tin import TIN
    from ..earthwork.reference import Reference

__all__ = ["viewshed", "visible_vertices"]

_CLASSES = ("visible", "partly", "hidden")
_COLORS = ("#7fbf7b", "#f6e8a6", "#b9aec4")
_DOUBT = 1e-12
"""Share of its terms below which a height above a plane may be rounding."""
_BREAKS = 4_000_000
"""Crossings that are held at a time, about."""


class _View(NamedTuple):
    """An eye, and how it sees."""

    eye: NDArray[np.float64]
    target_height: float
    radius: float
    fall: float


def visible_vertices(
    tin: TIN,
    eye: Any,
    *,
    eye_height: float = 0.0,
    target_height: float = 0.0,
    radius: float | None = None,
    curvature: bool = False,
    refraction: float | None = None,
) -> NDArray[np.bool_]:
    """Tell which vertices of a surface are seen from a place.

    Parameters
    ----------
    tin : TIN
    eye : (2,) array, or Features of one point
        CRS units.
    eye_height, target_height, curvature, refraction
        As in :func:`line_of_sight`; targets are the vertices.
    radius : float, optional
        What is farther away is not seen, in the plane; default any distance.

    Returns
    -------
    (n,) bool array

    Raises
    ------
    CrsError, OptionError, PointsError
        As :func:`line_of_sight`.

    Notes
    -----
    Each vertex is decided as :func:`line_of_sight` decides it; one that no triangle has is not
    seen. The time grows with the crossings of all lines, about as the number of vertices to the
    power 1.5; ``radius`` limits it.

    Examples
    --------
    >>> import tinsmith as ts
    >>> ridge = [[0, 0, 0], [0, 4, 0], [4, 0, 2], [4, 4, 2], [8, 0, 0], [8, 4, 0]]
    >>> ts.visible_vertices(ts.triangulate(ridge), [1, 2], eye_height=1)
    array([ True,  True,  True,  True, False, False])
    """
    reference = find_reference(tin, "Viewsheds")
    fall = find_curvature(reference, curvature, refraction)
    view, _ = _as_view(tin, eye, (eye_height, target_height), radius, fall)
    return seal(_see_vertices(tin, view))


def viewshed(
    tin: TIN,
    eye: Any,
    *,
    eye_height: float = 0.0,
    target_height: float = 0.0,
    radius: float | None = None,
    curvature: bool = False,
    refraction: float | None = None,
) -> Features:
    """Divide a surface into what is seen from a place, and what is hidden.

    Parameters
    ----------
    tin, eye, eye_height, target_height, radius, curvature, refraction
        As in :func:`visible_vertices`.

    Returns
    -------
    Features
        Polygons of the triangles of each class, with the columns ``class``: "visible" if all three
        corners are seen, "partly" if one or two are, "hidden" if none is; ``triangles``, ``area``
        in the plane, ``share`` of it, and ``color`` for a legend. With a radius triangles without
        a corner in it are left out.

    Raises
    ------
    CrsError, OptionError, PointsError
        As :func:`line_of_sight`.

    Notes
    -----
    Vertices are decided exactly, triangles by their corners alone: of a visible one a part may be
    hidden behind something narrow, of a hidden one a part may be seen between its corners. The
    triangles are as fine as the survey; for finer answers refine the surface first. With
    ``target_height`` 0 a triangle whose upper side is turned away from the eye is hidden.

    Examples
    --------
    >>> import tinsmith as ts
    >>> ridge = [[0, 0, 0], [0, 4, 0], [4, 0, 2], [4, 4, 2], [8, 0, 0], [8, 4, 0]]
    >>> seen = ts.viewshed(ts.triangulate(ridge), [1, 2], eye_height=0.5)
    >>> seen.columns["class"].tolist(), seen.columns["area"].tolist()
    (['visible', 'hidden'], [16.0, 16.0])
    """
    reference = find_reference(tin, "Viewsheds")
    fall = find_curvature(reference, curvature, refraction)
    view, notes = _as_view(tin, eye, (eye_height, target_height), radius, fall)
    seen = _see_vertices(tin, view)
    classes = np.array([2, 1, 1, 0])[seen[tin.triangles].sum(axis=1)]
    if view.target_height == 0.0 and fall == 0.0:
        classes[_faces_away(tin, view.eye)] = 2
    near = _measure_distances(tin.points, view.eye) <= view.radius
    classes[~near[tin.triangles].any(axis=1)] = -1
    return _as_features(tin, classes.astype(np.int64), reference, notes)


def _as_view(
    tin: TIN, eye: Any, heights: tuple[Any, Any], radius: Any, fall: float
) -> tuple[_View, tuple[str, ...]]:
    above = as_height("eye_height", heights[0]), as_height("target_height", heights[1])
    if radius is not None and (not is_finite_number(radius) or not radius > 0):
        raise OptionError("radius", radius, allowed="a finite number above 0, or None")
    xy, notes = as_places(tin, eye, "the eye")
    if len(xy) != 1:
        raise PointsError(f"There are {len(xy)} eyes: a viewshed has one.")
    reach = np.inf if radius is None else float(radius)
    return _View(raise_places(tin, xy, above[0])[0], above[1], reach, fall), notes


def _measure_distances(
    points: NDArray[np.float64], eye: NDArray[np.float64]
) -> NDArray[np.float64]:
    found: NDArray[np.float64] = np.hypot(points[:, 0] - eye[0], points[:, 1] - eye[1])
    return found


def _see_vertices(tin: TIN, view: _View) -> NDArray[np.bool_]:
    """Look at each vertex that a triangle has, the nearest first."""
    seen = np.zeros(len(tin.points), np.bool_)
    distances = _measure_distances(tin.points, view.eye)
    used = np.zeros(len(tin.points), np.bool_)
    used[tin.triangles] = True
    wanted = np.flatnonzero(used & (distances <= view.radius))
    seen[wanted[distances[wanted] == 0.0]] = True
    wanted = wanted[distances[wanted] > 0.0]
    wanted = wanted[np.argsort(distances[wanted], kind="stable")]
    begin = 0
    while begin < len(wanted):
        crossings = 2.0 + np.sqrt(begin + 1.0)  # of a line that long, about
        some = wanted[begin : begin + max(1, int(_BREAKS / crossings))]
        targets = tin.points[some].copy()
        targets[:, 2] += view.target_height
        eyes = np.broadcast_to(view.eye, targets.shape)
        seen[some] = ~find_blocks(tin, Rays(eyes, targets), view.fall).is_blocked
        begin += len(some)
    return seen


def _faces_away(tin: TIN, eye: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Tell which triangles have the eye below their plane."""
    a, b, c = (tin.points[tin.triangles[:, k]] for k in range(3))
    normals = np.cross(b - a, c - a)
    sizes = np.abs(normals) * np.abs(eye - a)
    offsets = (normals * (eye - a)).sum(axis=1)
    away: NDArray[np.bool_] = offsets < -_DOUBT * sizes.sum(axis=1)
    return away


def _as_features(
    tin: TIN, classes: NDArray[np.int64], reference: Reference, notes: tuple[str, ...]
) -> Features:
    found = dissolve(tin, classes)
    ground = measure_plane_areas(tin)
    inside = classes >= 0
    measured = np.bincount(classes[inside], ground[inside], len(_CLASSES))[found.classes]
    counts = np.bincount(classes[inside], minlength=len(_CLASSES))[found.classes]
    columns = {
        "class": np.array(_CLASSES, object)[found.classes],
        "triangles": counts,
        "area": measured,
        "share": 100.0 * measured / measured.sum(),
        "color": np.array(_COLORS, object)[found.classes],
    }
    return make_polygons(
        tin,
        found,
        columns=columns,
        units={"area": find_plane_units(tin.crs).area, "share": "%"},
        name="viewshed",
        notes=[*reference.notes, *notes],
    )
