"""Which triangles refinement leaves although they miss what was asked for, and why."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..report import Unmended
from .shape_quality import measure_smallest_angles

if TYPE_CHECKING:
    from ...base.arrays import Float64Array, Int32Array

__all__ = ["find_unmended"]


def find_unmended(points: Float64Array, triangles: Int32Array, left: Int32Array) -> Unmended:
    """Find the triangles that the core left, whatever the order of their corners.

    Parameters
    ----------
    points : (n, 3) float64 array
    triangles : (m, 3) int32 array
    left : (k, 4) int32 array
        Corners, and why.
    """
    if len(left) == 0:
        return Unmended.none()
    why_of = {tuple(sorted(row[:3])): row[3] for row in left.tolist()}
    is_near = np.zeros(int(triangles.max()) + 1, np.bool_)
    is_near[left[:, :3]] = True
    near = np.flatnonzero(is_near[triangles].all(axis=1))
    why = [why_of.get(tuple(row), -1) for row in np.sort(triangles[near], axis=1).tolist()]
    codes = np.array(why, np.int8)
    found = near[codes >= 0]
    angles = measure_smallest_angles(points[triangles[found], :2])
    return Unmended(found.astype(np.int32), codes[codes >= 0], angles)
