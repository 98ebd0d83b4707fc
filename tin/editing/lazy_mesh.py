"""A mesh that is made of arrays when it is first changed, and made into arrays when asked."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .. import _kernel

if TYPE_CHECKING:
    from ...base.arrays import BoolArray, Float64Array, Int32Array

__all__ = ["LiveMesh"]


class LiveMesh:
    """Vertices that are edited, with the triangles of their hull as arrays until these change.

    Parameters
    ----------
    points : (n, 3) float64 array
        Of every slot.
    triangles, neighbors : (m, 3) int32 arrays
        By slot; in canonical order.
    fixed : (m, 3) bool array
    lines : tuple of int
        First and end of the slots that are vertices of lines alone.
    alive : (n,) bool array, optional
        Which slots hold a vertex; default all.

    Attributes
    ----------
    edited : EditedMesh
    """

    def __init__(
        self,
        points: Float64Array,
        triangles: Int32Array,
        neighbors: Int32Array,
        fixed: BoolArray,
        *,
        lines: tuple[int, int] = (0, 0),
        alive: BoolArray | None = None,
    ) -> None:
        self.edited = _kernel.EditedMesh(points, *lines)
        if alive is not None and not alive.all():
            self.edited.leave_empty(np.flatnonzero(~alive).astype(np.int32))
        self._given: tuple[Int32Array, Int32Array, BoolArray] | None = triangles, neighbors, fixed

    def open(self) -> _kernel.EditedMesh:
        """Return the vertices, with a mesh of the triangles, to be changed."""
        if self._given is not None:
            self.edited.open(*self._given)
            self._given = None
        return self.edited

    @property
    def mesh(self) -> _kernel.Mesh:
        """The mesh."""
        return self.open().mesh

    def arrays(self, threads: int) -> tuple[Int32Array, Int32Array, BoolArray]:
        """Return triangles, neighbours and fixed edges; vertices are numbered without gaps."""
        if self._given is None:
            return self.edited.mesh.arrays(threads)
        triangles, neighbors, fixed = self._given
        if self.edited.count == self.edited.slots:
            return triangles, neighbors, fixed
        return self.edited.numbers()[triangles], neighbors, fixed
