"""Model: vertices, the steps of lines, and what of the hull is the surface.

A model is what a TIN is a function of once rows are merged and lines cut where they meet. The
triangulation of its vertices with its steps is unique, so any way to it gives the same TIN.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...errors import LinesError
from .. import _kernel, topology
from .breaklines import LineKind, Lines
from .clipping import BOUNDARY, RIM, RingSteps, Surface, clipped, edge_keys, is_inside, trimmed
from .polylines import Pieces

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["Clip", "LineInfo", "Model", "force", "lines_in", "mesh_of", "mesh_of_growth"]


class LineInfo(NamedTuple):
    """What a line is; source -1 is an edge of the rim that was cut.

    Of a ring, ``group`` tells whose side it changes, as in :mod:`.clipping`.
    """

    kind: LineKind
    source: int = -1
    name: str = ""
    priority: float = 0.0
    group: int = BOUNDARY


@dataclass(frozen=True, eq=False, kw_only=True)
class Clip:
    """Which triangles of the hull are the surface.

    Attributes
    ----------
    boundary, extent : lists of (k, 2) float64 arrays
        Rings.
    holes : list of lists of (k, 2) float64 arrays
        The rings of each, the outer one and its islands.
    has_rim : bool
        Whether there are lines of the rim, beyond which there is no surface.
    max_edge : float
        Infinity for none.
    is_trimmed_everywhere : bool
    """

    boundary: list[NDArray[np.float64]] = field(default_factory=list)
    extent: list[NDArray[np.float64]] = field(default_factory=list)
    holes: list[list[NDArray[np.float64]]] = field(default_factory=list)
    has_rim: bool = False
    max_edge: float = np.inf
    is_trimmed_everywhere: bool = False

    @property
    def is_none(self) -> bool:
        """Whether all of the hull is the surface."""
        return not (self._has_rings or np.isfinite(self.max_edge))

    @property
    def _has_rings(self) -> bool:
        return bool(self.boundary or self.extent or self.holes or self.has_rim)

    def keeps(self, surface: Surface, ring_steps: RingSteps) -> NDArray[np.bool_]:
        """Tell which triangles are kept.

        Raises
        ------
        LinesError
            If there are none, or if a hole cuts nothing away.
        """
        keep = np.ones(len(surface.triangles), np.bool_)
        if self._has_rings:
            keep = is_inside(surface, ring_steps, self.boundary, self.extent, self.holes)
            _require_triangles(keep, "The boundary and the holes leave no triangle of the surface")
        if np.isfinite(self.max_edge):
            everywhere = self.is_trimmed_everywhere
            keep = trimmed(surface, keep, self.max_edge, everywhere=everywhere)
            _require_triangles(keep, f"No triangle is left with max_edge {self.max_edge:g}")
        return keep


def _require_triangles(keep: NDArray[np.bool_], sentence: str) -> None:
    if not keep.any():
        raise LinesError(f"{sentence}: a TIN needs one at least.")


@dataclass(frozen=True, eq=False, kw_only=True)
class Model:
    """Vertices and lines of the whole hull.

    Attributes
    ----------
    points : (v, 3) float64 array
        Distinct places.
    pieces : Pieces
        Chains of vertices; ``pieces.lines`` are places in ``infos``.
    infos : tuple of LineInfo
    clip : Clip
    vertex_of : (n,) int32 array
        The vertex of each row of the caller's points, -1 for none.
    """

    points: NDArray[np.float64]
    pieces: Pieces
    infos: tuple[LineInfo, ...]
    clip: Clip
    vertex_of: NDArray[np.int32]

    def surface(self, hull: Surface) -> tuple[Surface, NDArray[np.int32]]:
        """Cut the triangulated hull; return the surface and the new number of each vertex."""
        if self.clip.is_none:
            return hull, np.arange(len(hull.points), dtype=np.int32)
        steps, line_of = self.pieces.steps()
        group = np.array([_group_of(info) for info in self.infos], np.int64)[line_of]
        is_ring = group >= (RIM if self.clip.has_rim else BOUNDARY)
        keep = self.clip.keeps(hull, RingSteps(steps[is_ring], group[is_ring]))
        if keep.all():
            return hull, np.arange(len(hull.points), dtype=np.int32)
        return clipped(hull, keep)

    def loses_vertices_at_rim(self, hull: Surface) -> bool:
        """Tell whether vertices lie beyond the rim, which is so only if a rounding bent it.

        Rings that end at the rim need it none the less, to have an inside.
        """
        if not self.clip.has_rim:
            return False
        without = replace(self, clip=replace(self.clip, has_rim=False))
        try:
            (_, within), (_, everywhere) = self.surface(hull), without.surface(hull)
        except LinesError:  # nothing is left: the same without the rim, or it was its fault
            return True
        return bool(((within < 0) & (everywhere >= 0)).any())


def _group_of(info: LineInfo) -> int:
    if info.kind not in ("boundary", "hole"):
        return RIM - 1
    return RIM if info.source < 0 else info.group


def mesh_of(points: NDArray[np.float64], pieces: Pieces, *, threads: int) -> _kernel.Mesh:
    """Triangulate distinct points, and fix the steps of lines that are cut where they meet."""
    mesh = mesh_of_growth(points, _kernel.grow(points, threads=threads))
    force(mesh, pieces)
    return mesh


def mesh_of_growth(points: NDArray[np.float64], growth: _kernel.Growth) -> _kernel.Mesh:
    """Return the triangulation of distinct points as a mesh, with no edge fixed."""
    return _kernel.Mesh(points, growth.triangles, growth.neighbors)


def force(mesh: _kernel.Mesh, pieces: Pieces) -> None:
    """Fix all steps."""
    steps, _ = pieces.steps()
    passed, blocked = mesh.force(steps)
    if len(passed) or len(blocked):
        raise AssertionError("lines were not cut at all places where they meet")


def lines_in(
    pieces: Pieces,
    infos: tuple[LineInfo, ...],
    number_of: NDArray[np.int32],
    surface: Surface,
    *,
    is_whole: bool,
) -> Lines:
    """Return the lines as far as they are edges of the surface, by its numbers of vertices."""
    is_given = np.array([info.source >= 0 for info in infos], np.bool_)
    steps, line_of = pieces.steps()
    is_edge = is_given[line_of]
    if not is_whole:
        is_edge &= _are_edges(number_of[steps], surface)
    left = pieces.kept(is_edge)
    return Lines(
        vertices=number_of[left.vertices],
        offsets=left.offsets,
        kinds=tuple(infos[i].kind for i in left.lines),
        sources=np.array([infos[i].source for i in left.lines], np.int32),
        names=tuple(infos[i].name for i in left.lines),
    )


def _are_edges(steps: NDArray[np.int32], surface: Surface) -> NDArray[np.bool_]:
    n = len(surface.points)
    triangle, corner = np.nonzero(surface.constrained)
    edges = np.stack(topology.ends(surface.triangles, triangle, corner), axis=1)
    is_edge = np.asarray((steps >= 0).all(axis=1), np.bool_)
    is_edge[is_edge] = np.isin(edge_keys(steps[is_edge], n), edge_keys(edges.astype(np.int32), n))
    return is_edge
