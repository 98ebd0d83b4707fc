"""A mesh that is made of arrays when it is first changed, and made into arrays when asked."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .. import _kernel

if TYPE_CHECKING:
    from ...arrays import BoolArray, Float64Array, Int32Array

__all__ = ["LiveMesh"]


_Arrays = tuple["Float64Array", "Int32Array", "Int32Array", "BoolArray"]
_NOTHING: _Arrays = (
    np.empty((0, 2)),
    np.empty((0, 3), np.int32),
    np.empty((0, 3), np.int32),
    np.empty((0, 3), np.bool_),
)


class LiveMesh:
    """Triangles of a hull, as arrays until they are changed.

    Parameters
    ----------
    points : (n, 2 or 3) float64 array
        Of every slot.
    triangles, neighbors : (m, 3) int32 arrays
        By slot; in canonical order.
    fixed : (m, 3) bool array
    alive : (n,) bool array, optional
        Which slots hold a vertex; default all.
    """

    def __init__(
        self,
        points: Float64Array,
        triangles: Int32Array,
        neighbors: Int32Array,
        fixed: BoolArray,
        alive: BoolArray | None = None,
    ) -> None:
        self._given: _Arrays = (points, triangles, neighbors, fixed)
        self._alive = np.ones(len(points), np.bool_) if alive is None else alive
        self._count = int(self._alive.sum())
        self._mesh: _kernel.Mesh | None = None

    @classmethod
    def of(cls, mesh: _kernel.Mesh) -> LiveMesh:
        """Return one that is a mesh already."""
        live = cls(*_NOTHING)
        live._mesh = mesh
        return live

    @property
    def mesh(self) -> _kernel.Mesh:
        """The mesh, to be changed."""
        if self._mesh is None:
            self._mesh = _kernel.Mesh(*self._given)
            self._given = _NOTHING
        return self._mesh

    @property
    def slots(self) -> int:
        """Vertices that are or were there."""
        return len(self._alive) if self._mesh is None else self._mesh.slots

    @property
    def count(self) -> int:
        """Vertices that are there."""
        return self._count if self._mesh is None else self._mesh.count

    def alive(self) -> BoolArray:
        """Tell which slots hold a vertex."""
        return self._alive if self._mesh is None else self._mesh.alive()

    def arrays(self, threads: int) -> tuple[Int32Array, Int32Array, BoolArray]:
        """Return triangles, neighbours and fixed edges; vertices are numbered without gaps."""
        if self._mesh is not None:
            return self._mesh.arrays(threads)
        _, triangles, neighbors, fixed = self._given
        if self._alive.all():
            return triangles, neighbors, fixed
        number = (np.cumsum(self._alive) - 1).astype(np.int32)
        return number[triangles], neighbors, fixed
