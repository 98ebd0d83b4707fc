"""Faces of a drawing as one mesh: equal corners joined, quadrilaterals cut in two."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ....base.errors import ReadError
from ....base.sentences import counted
from ....tin.topology import find_offsets
from ...mesh.common import cut_into_fans, join_places
from ..surfaces import Mesh

if TYPE_CHECKING:
    from ....base.arrays import BoolArray, Float64Array

__all__ = ["make_mesh"]

_NO_AREA = 1e-12
"""Share of the squared length of a triangle that is no area, but the rounding of its corners."""


def make_mesh(faces: Float64Array) -> Mesh:
    """Return points in the order in which faces name them, and triangles.

    Parameters
    ----------
    faces : (m, 4, 3) float64 array
        Corners; a triangle repeats one.

    Raises
    ------
    ReadError
        If no face has three corners.
    """
    points, numbers = join_places(faces.reshape(-1, 3))
    corners = numbers.reshape(-1, 4)
    is_new = corners != np.roll(corners, 1, axis=1)
    is_new[:, 2] &= corners[:, 2] != corners[:, 0]
    is_new[:, 3] &= corners[:, 3] != corners[:, 1]
    counts = is_new.sum(axis=1)
    kept = counts > 2
    if not kept.any():
        raise ReadError("none of its faces has three corners.")
    notes: list[str] = []
    if not kept.all():
        lines = counted(int((~kept).sum()), "face")
        notes.append(f"Left out: {lines} with fewer than three different corners.")
    used = corners[kept][is_new[kept]]
    quads = corners[kept & (counts == 4)]
    triangles = cut_into_fans(used, find_offsets(counts[kept]), points).triangles
    with np.errstate(over="ignore", invalid="ignore"):  # what is too large is refused later
        if len(quads):
            notes.append(_describe_quads(points[quads]))
        is_line = _find_lines(points[triangles])
    if is_line.any() and not is_line.all():
        notes.append(f"Left out: {counted(int(is_line.sum()), 'triangle')} without any area.")
        triangles = triangles[~is_line]
    return Mesh(points, triangles, None, notes)


def _find_lines(corners: Float64Array) -> BoolArray:
    """Return which triangles are lines in space; those that are vertical only are none."""
    u, v = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    area = np.linalg.norm(np.cross(u, v), axis=1)
    longest = np.maximum((u * u).sum(axis=1), (v * v).sum(axis=1))
    is_line: BoolArray = area <= _NO_AREA * longest
    return is_line


def _describe_quads(corners: Float64Array) -> str:
    """Tell how many quadrilaterals were cut, and of how many the cut shapes the surface."""
    a, b, c, d = (corners[:, k] for k in range(4))
    normal = np.cross(b - a, c - a)
    apart = np.abs(((d - a) * normal).sum(axis=1))
    size = np.linalg.norm(normal, axis=1) * np.linalg.norm(c - a, axis=1)
    n_bent = int((apart > 1e-9 * size).sum())
    text = f"{counted(len(corners), 'face')} of four corners cut in two along an inner diagonal"
    bent = counted(n_bent, "face")
    return f"{text}." if not n_bent else f"{text}: {bent} of them not plane, so the cut matters."
