"""Ridges and valleys: edges from which both triangles fall away, and to which both fall."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from ...base.checks import as_number
from ...base.products import product
from ...base.results import Features
from ..surface import find_reference
from .falls import find_falls

if TYPE_CHECKING:
    from ...base.arrays import AnyArray, Float64Array, Int64Array
    from ...tin import TIN
    from .falls import Falls

_MOST_DEGREES = 180.0


@product
def ridges_and_valleys(tin: TIN, *, min_angle: float = 0.0) -> Features:
    """Find the edges that are ridges or valleys.

    Parameters
    ----------
    tin : TIN
    min_angle : float, optional
        Leave out edges at which the surface bends by less, in degrees.

    Returns
    -------
    Features
        A line for each edge, from its upper end, with the columns ``kind``, ``angle`` (between the
        normals of both triangles, degrees) and ``slope`` (of the edge, degrees). At a "valley" both
        triangles fall towards the edge, so that water runs along it; at a "ridge" both fall away
        from it, so that it parts waters [1]_.

    Raises
    ------
    CrsError
        If coordinates are degrees.
    OptionError
        If the angle is not from 0 to 180.

    Notes
    -----
    Decided exactly. Edges of the boundary are neither.

    References
    ----------
    .. [1] A. U. Frank, B. Palmer, V. B. Robinson, Formal methods for the accurate definition of
       some fundamental terms in physical geography, Proc. 2nd Int. Symposium on Spatial Data
       Handling (1986), 583-599.

    Examples
    --------
    >>> import tinsmith as ts
    >>> roof = ts.triangulate([[0, 0, 0], [4, 0, 0], [0, 2, 1], [4, 2, 1], [0, 4, 0], [4, 4, 0]])
    >>> found = ts.ridges_and_valleys(roof)
    >>> found.columns["kind"], found.coordinates[:, 1], found.columns["angle"].round(2)
    (array(['ridge'], dtype=object), array([2., 2.]), array([53.13]))
    """
    min_angle = as_number("min_angle", min_angle, least=0, most=_MOST_DEGREES, unit="degrees")
    reference = find_reference(tin, "Ridges and valleys")
    falls = find_falls(tin)
    triangle, edge = np.nonzero(falls.neighbors > np.arange(len(falls.triangles))[:, None])
    own, beyond = falls.signs[triangle, edge], falls.sign_beyond(triangle, edge)
    chosen = np.flatnonzero((own == beyond) & (own != 0))
    triangle, edge, own = triangle[chosen], edge[chosen], own[chosen]
    angles = _measure_angles(falls, triangle, edge, reference.up)
    kept = angles >= min_angle
    triangle, edge, own, angles = triangle[kept], edge[kept], own[kept], angles[kept]
    start, end = (falls.points[vertices] for vertices in falls.ends(triangle, edge))
    is_up = (start[:, 2] < end[:, 2])[:, None]
    high, low = np.where(is_up, end, start), np.where(is_up, start, end)
    step = high - low
    run = np.hypot(step[:, 0], step[:, 1])
    return Features.of_lines(
        np.stack([high, low], axis=1).reshape(-1, 3),
        2 * np.arange(len(own) + 1),
        columns={
            "kind": np.array(["", "valley", "ridge"], object)[own],
            "angle": angles,
            "slope": np.degrees(np.arctan2(step[:, 2] * reference.up, run)),
        },
        units={"angle": "°", "slope": "°"},
        crs=tin.crs,
        elevation_unit=tin.elevation_unit,
        name="ridges and valleys",
        notes=reference.notes,
    )


def _measure_angles(
    falls: Falls, triangle: Int64Array, edge: Int64Array, up: float
) -> Float64Array:
    """Return the angle between the normals of the triangles at edges, degrees."""
    one = _measure_normals(falls, triangle, up)
    other = _measure_normals(falls, falls.neighbors[triangle, edge], up)
    sine = np.linalg.norm(np.cross(one, other), axis=1)
    found: Float64Array = np.degrees(np.arctan2(sine, (one * other).sum(axis=1)))
    return found


def _measure_normals(falls: Falls, triangle: AnyArray, up: float) -> Float64Array:
    corners = falls.points[falls.triangles[triangle]] * (1.0, 1.0, up)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    lengths = np.linalg.norm(normals, axis=1)
    unit: Float64Array = normals / np.where(lengths > 0.0, lengths, math.inf)[:, None]
    return unit
