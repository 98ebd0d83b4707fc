"""Which triangles refinement leaves although they miss what was asked for, and why."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from .._sentences import counted
from .quality import smallest_angles

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["UNMENDED_WHY", "Unmended", "find_unmended"]

UNMENDED_WHY = (
    "lines or the rim meet there under a small angle",
    "only far shorter edges would help",
    "a line or the rim in the way has no room for a further vertex",
)
"""Why a triangle stays as it is; ``Unmended.why`` holds places in this list."""


class Unmended(NamedTuple):
    """Triangles of a refined mesh with too small an angle, too large, or with too long an edge.

    Attributes
    ----------
    triangles : (k,) int32 array
        Their numbers, ascending; of the mesh as refined, before any edits.
    why : (k,) int8 array
        Places in ``UNMENDED_WHY``.
    angles : (k,) float64 array
        Smallest angle of each in the plane, degrees.
    """

    triangles: NDArray[np.int32]
    why: NDArray[np.int8]
    angles: NDArray[np.float64]

    @classmethod
    def none(cls) -> Unmended:
        """Return none."""
        return cls(np.empty(0, np.int32), np.empty(0, np.int8), np.empty(0))

    def sentences(self) -> tuple[str, ...]:
        """Tell for each reason how many there are, and the least angle of them."""
        return tuple(
            f"{counted(group['count'], 'triangle')} with angles from "
            f"{group['least_angle']:.3g} degrees on could not be mended: {group['why']}."
            for group in self.to_list()
        )

    def to_list(self) -> list[dict[str, Any]]:
        """Return for each reason count, least angle and numbers, as plain values."""
        return [
            {
                "why": UNMENDED_WHY[code],
                "count": int((self.why == code).sum()),
                "least_angle": float(self.angles[self.why == code].min()),
                "triangles": self.triangles[self.why == code].tolist(),
            }
            for code in np.unique(self.why).tolist()
        ]


def find_unmended(
    points: NDArray[np.float64], triangles: NDArray[np.int32], left: NDArray[np.int32]
) -> Unmended:
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
    angles = smallest_angles(points[triangles[found], :2])
    return Unmended(found.astype(np.int32), codes[codes >= 0], angles)
