"""The vertices of a surface that are seen from one place."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.products import product
from ...base.types import seal
from ...tin.predicates import EXACT_RANGE
from ...tin.validation import thread_count
from .. import _kernel
from ..surface import find_reference
from .lines import as_view, measure_distances
from .rays import Rays, find_blocks, find_curvature

if TYPE_CHECKING:
    from ...base.arrays import BoolArray, Float64Array, Int64Array, UInt8Array
    from ...tin import TIN
    from .lines import View

_HIDDEN, _SEEN, _UNKNOWN = 0, 1, 2
"""What the kernel says of a vertex."""
_BREAKS = 4_000_000
"""Crossings that are held at a time, about."""


@product
def visible_vertices(
    tin: TIN,
    eye: Any,
    *,
    eye_height: float = 0.0,
    target_height: float = 0.0,
    radius: float | None = None,
    curvature: bool = False,
    refraction: float | None = None,
) -> BoolArray:
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
    seen. A ray is turned about the eye, with the edges that it crosses in a balanced tree, so the
    time is about proportional to the number of vertices times its logarithm. Large parts that lie
    in one plane with the eye take longer.

    Examples
    --------
    >>> import tinsmith as ts
    >>> ridge = [[0, 0, 0], [0, 4, 0], [4, 0, 2], [4, 4, 2], [8, 0, 0], [8, 4, 0]]
    >>> ts.visible_vertices(ts.triangulate(ridge), [1, 2], eye_height=1)
    array([ True,  True,  True,  True, False, False])
    """
    reference = find_reference(tin, "Viewsheds")
    fall = find_curvature(reference, curvature, refraction)
    view, _ = as_view(tin, eye, (eye_height, target_height), radius, fall)
    return seal(see_vertices(tin, view))


def see_vertices(tin: TIN, view: View) -> BoolArray:
    """Look at each vertex that a triangle has."""
    distances = measure_distances(tin.points, view.eye)
    wanted = np.zeros(len(tin.points), np.bool_)
    wanted[tin.triangles] = True
    wanted &= distances <= view.radius
    is_eye = distances == 0.0
    verdicts = judge_vertices(tin, view, wanted & ~is_eye)
    seen: BoolArray = (verdicts == _SEEN) | (wanted & is_eye)
    unknown = np.flatnonzero(verdicts == _UNKNOWN)
    unknown = unknown[np.argsort(distances[unknown], kind="stable")]
    seen[unknown] = look_one_by_one(tin, view, unknown)
    return seen


def judge_vertices(
    tin: TIN, view: View, wanted: BoolArray, threads: int | None = None
) -> UInt8Array:
    """Return ``_SEEN``, ``_HIDDEN`` or ``_UNKNOWN`` for each vertex."""
    if not are_heights_exact(tin, view):
        return np.where(wanted, _UNKNOWN, _HIDDEN).astype(np.uint8)
    verdicts: UInt8Array = _kernel.find_seen_vertices(
        tin.points,
        tin.triangles,
        tin.neighbors,
        wanted,
        view.eye,
        view.target_height,
        view.radius,
        view.fall,
        thread_count(threads, len(tin.points)),
    )
    if view.fall != 0.0:  # the ground about the eye bulges before the first edge
        own = tin.triangles[_find_triangles_at(tin, view.eye)].ravel()
        verdicts[own[verdicts[own] == _SEEN]] = _UNKNOWN
    return verdicts


def are_heights_exact(tin: TIN, view: View) -> bool:
    """Tell whether exact arithmetic of doubles has room for all elevations."""
    heights = [tin.points[:, 2], tin.points[:, 2] + view.target_height, view.eye[2:]]
    smallest, largest = EXACT_RANGE
    sizes = np.abs(np.concatenate(heights))
    return bool(((sizes == 0.0) | ((sizes >= smallest) & (sizes <= largest))).all())


def look_one_by_one(tin: TIN, view: View, wanted: Int64Array) -> BoolArray:
    """Look at some vertices, sorted by distance, along a line of sight each."""
    seen = np.zeros(len(wanted), np.bool_)
    begin = 0
    while begin < len(wanted):
        crossings = 2.0 + np.sqrt(len(tin.points))  # of a line, about
        end = begin + max(1, int(_BREAKS / crossings))
        targets = tin.points[wanted[begin:end]].copy()
        targets[:, 2] += view.target_height
        eyes = np.broadcast_to(view.eye, targets.shape)
        seen[begin:end] = ~find_blocks(tin, Rays(eyes, targets), view.fall).is_blocked
        begin = end
    return seen


def _find_triangles_at(tin: TIN, eye: Float64Array) -> Int64Array:
    """Return the triangles that hold the eye, and perhaps some more."""
    is_near = np.ones(len(tin.triangles), np.bool_)
    for axis in (0, 1):
        corners = tin.points[:, axis][tin.triangles]
        is_near &= (corners.min(axis=1) <= eye[axis]) & (corners.max(axis=1) >= eye[axis])
    return np.flatnonzero(is_near)
