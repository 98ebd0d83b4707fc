"""Viewsheds: the parts of a surface that are seen from one place."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.checks import as_flag
from ...base.georeference import find_plane_units
from ...base.products import product
from ...base.progress import Progress
from ..drawing import palette
from ..surface import dissolve, double_areas, find_reference, make_polygons
from .lines import as_view, measure_distances
from .parts import divide
from .rays import find_curvature
from .vertices import are_heights_exact, see_vertices

if TYPE_CHECKING:
    from collections.abc import Callable

    from ...base.arrays import BoolArray, Int64Array
    from ...base.results import Features
    from ...tin import TIN
    from ..surface import Mesh
    from .lines import View

    _Numbers = Int64Array

_CLASSES = ("visible", "partly", "hidden")
_DOUBT = 1e-12
"""Share of its terms below which a height above a plane may be rounding."""


@product
def viewshed(
    tin: TIN,
    eye: Any,
    *,
    eye_height: float = 0.0,
    target_height: float = 0.0,
    radius: float | None = None,
    curvature: bool = False,
    refraction: float | None = None,
    whole_triangles: bool = False,
    progress: Callable[[float], None] | None = None,
) -> Features:
    """Divide a surface into what is seen from a place, and what is hidden.

    Parameters
    ----------
    tin, eye, eye_height, target_height, radius, curvature, refraction
        As in :func:`visible_vertices`.
    whole_triangles : bool, optional
        Do not divide triangles: each is "visible" if all three corners are seen, "partly" if one or
        two are, "hidden" if none is, or with ``target_height`` 0 if its upper side is turned away.
        So they are judged with curvature, too.
    progress : callable, optional
        Called with the fraction done, ascending to 1.0, as triangles are judged and joined. What it
        raises ends the call.

    Returns
    -------
    Features
        Polygons of what is visible and what is hidden, with the columns ``class``, ``triangles``
        (that have a part in it), ``area`` in the plane, ``share`` of it, and ``color`` for a
        legend. They tile the surface. With a radius triangles that do not come within it are left
        out, and the others are judged as far as they reach, which ``notes`` tell.

    Raises
    ------
    CrsError, OptionError, PointsError
        As :func:`line_of_sight`.

    Notes
    -----
    Triangles are taken from the eye outwards. The horizon of the edges before each throws a shadow
    on it, which ends in straight lines; these and rays from the eye along the ends of edges bound
    the visible parts. They are computed in doubles: what comes within 1e-12 of heights of touching
    counts as visible, and corners are rounded. Vertices of the surface are decided exactly by
    :func:`visible_vertices`.

    Examples
    --------
    >>> import tinsmith as ts
    >>> ridge = [[0, 0, 0], [0, 4, 0], [4, 0, 2], [4, 4, 2], [8, 0, 0], [8, 4, 0]]
    >>> seen = ts.viewshed(ts.triangulate(ridge), [1, 2], eye_height=0.5)
    >>> seen.columns["class"].tolist(), seen.columns["area"].tolist()
    (['visible', 'hidden'], [16.0, 16.0])
    """
    done = Progress(progress)
    as_whole = as_flag("whole_triangles", whole_triangles)
    reference = find_reference(tin, "Viewsheds")
    fall = find_curvature(reference, curvature, refraction)
    view, said = as_view(tin, eye, (eye_height, target_height), radius, fall)
    notes = [*reference.notes, *said]
    if not as_whole and (fall != 0.0 or not are_heights_exact(tin, view)):
        as_whole = True
        why = "Over a curved earth" if fall != 0.0 else "With such elevations"
        notes.append(f"{why} triangles are not divided: they are judged by their corners.")
    done(0.05)
    is_near = _find_near(tin, view)
    reach = float(measure_distances(tin.points, view.eye)[tin.triangles[is_near]].max())
    if reach > view.radius:
        notes.append(
            f"Triangles that come within the radius of {view.radius:g} are taken whole: what is "
            f"told reaches as far as {reach:.6g}."
        )
        view = view._replace(radius=reach)
    mesh, classes, owners = _judge_triangles(tin, view) if as_whole else _divide(tin, view)
    done(0.7)
    classes[~is_near[owners]] = -1
    found = _as_features(tin, mesh, classes, owners, notes)
    done.end()
    return found


def _find_near(tin: TIN, view: View) -> BoolArray:
    """Tell which triangles come within the radius."""
    if np.isinf(view.radius):
        return np.ones(len(tin.triangles), np.bool_)
    eye = view.eye[:2]
    start = tin.points[tin.triangles, :2]
    way = np.roll(start, -1, axis=1) - start
    share = ((eye - start) * way).sum(axis=2) / (way**2).sum(axis=2)
    nearest = start + np.clip(share, 0.0, 1.0)[:, :, None] * way
    is_near: BoolArray = (view.radius >= np.hypot(*(nearest - eye).T).T).any(axis=1)
    is_near[tin.locate(eye[None])] = True
    return is_near


def _judge_triangles(tin: TIN, view: View) -> tuple[Mesh, _Numbers, _Numbers]:
    """Return the surface, the class of each triangle by its corners, and their numbers."""
    seen = see_vertices(tin, view)
    classes = np.array([2, 1, 1, 0])[seen[tin.triangles].sum(axis=1)]
    if view.target_height == 0.0 and view.fall == 0.0:
        a, b, c = (tin.points[tin.triangles[:, k]] for k in range(3))
        normals = np.cross(b - a, c - a)
        sizes = np.abs(normals) * np.abs(view.eye - a)
        heights = (normals * (view.eye - a)).sum(axis=1)  # of the eye above the planes
        classes[heights < -_DOUBT * sizes.sum(axis=1)] = 2
    return tin, classes.astype(np.int64), np.arange(len(classes))


def _divide(tin: TIN, view: View) -> tuple[Mesh, _Numbers, _Numbers]:
    """Return parts of triangles, the class of each, and the triangle that it is a part of."""
    parts, is_seen = divide(tin, view)
    return parts, np.where(is_seen, 0, 2), parts.owners


def _as_features(
    tin: TIN, mesh: Mesh, classes: _Numbers, owners: _Numbers, notes: list[str]
) -> Features:
    found = dissolve(mesh, classes)
    ground = 0.5 * double_areas(mesh.points, mesh.triangles)
    inside = classes >= 0
    measured = np.bincount(classes[inside], ground[inside], len(_CLASSES))[found.classes]
    counts = [np.count_nonzero(np.bincount(owners[classes == one])) for one in found.classes]
    columns = {
        "class": np.array(_CLASSES, object)[found.classes],
        "triangles": np.array(counts, np.int64),
        "area": measured,
        "share": 100.0 * measured / measured.sum(),
        "color": np.array(palette.SIGHT, object)[found.classes],
    }
    return make_polygons(
        tin,
        found,
        columns=columns,
        units={"area": find_plane_units(tin.crs).area, "share": "%"},
        name="viewshed",
        notes=notes,
        points=mesh.points,
    )
