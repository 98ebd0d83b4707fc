"""Viewsheds: the parts of a surface that are seen from one place."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ..earthwork.reference import find_reference
from ..georeference import find_plane_units
from ..relief.dissolving import dissolve, make_polygons
from ..results import Features
from ..slope import measure_plane_areas
from .eyes import as_view, measure_distances
from .rays import find_curvature
from .vertices import see_vertices

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ...tin import TIN
    from ..earthwork.reference import Reference

__all__ = ["viewshed"]

_CLASSES = ("visible", "partly", "hidden")
_COLORS = ("#7fbf7b", "#f6e8a6", "#b9aec4")
_DOUBT = 1e-12
"""Share of its terms below which a height above a plane may be rounding."""


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
    view, notes = as_view(tin, eye, (eye_height, target_height), radius, fall)
    seen = see_vertices(tin, view)
    classes = np.array([2, 1, 1, 0])[seen[tin.triangles].sum(axis=1)]
    if view.target_height == 0.0 and fall == 0.0:
        classes[_faces_away(tin, view.eye)] = 2
    near = measure_distances(tin.points, view.eye) <= view.radius
    classes[~near[tin.triangles].any(axis=1)] = -1
    return _as_features(tin, classes.astype(np.int64), reference, notes)


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
