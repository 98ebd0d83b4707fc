"""Existing triangles as the build of inputs, so that they can be edited.

The vertices are the rows. Lines, and flagged edges of no line as soft breaklines, are kept; where
the boundary is not convex, or given by lines, there is no surface beyond it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...base.errors import PointsError, TinsmithError
from .. import topology
from ..building.assembly import assemble
from ..building.inputs import BuildInputs
from ..building.options import BuildOptions
from ..constraints.constraint_set import BELOW_ALL, LineSet
from ..constraints.constraint_table import ConstraintTable
from ..topology import find_offsets
from ..validation.points import as_points

if TYPE_CHECKING:
    from ...base.arrays import Float64Array, Int32Array
    from ...base.policies import LineKind
    from ..building.version import Version
    from ..triangulation import Triangulation

__all__ = ["build_of_triangles", "gather_inputs_of_triangles"]


def gather_inputs_of_triangles(version: Version) -> BuildInputs:
    """Return what existing triangles are built of.

    Raises
    ------
    PointsError
        If a vertex is not finite.
    """
    surface, lines = version.triangulation, version.lines
    chains = [(kind, name, chain) for kind, name, chain in _list_named_chains(version)]
    is_breakline = [kind in ("hard", "soft") for kind, _, _ in chains]
    ordered = [chain for chain, is_first in zip(chains, is_breakline, strict=True) if is_first]
    ordered += [("soft", "", edge) for edge in _find_edges_of_no_line(version)]
    n_breaklines = len(ordered)
    ordered += [chain for chain, first in zip(chains, is_breakline, strict=True) if not first]
    has_own_boundary = not surface.fills_hull or "boundary" in lines.kinds
    boundary = [np.append(ring, ring[:1]) for ring in surface.rings] if has_own_boundary else []
    sources = np.concatenate(
        [np.arange(n_breaklines), np.zeros(len(ordered) - n_breaklines), np.full(len(boundary), -1)]
    )
    return BuildInputs(
        points=as_points(surface.points),
        is_masked=None,
        lines=_make_line_set(
            surface.points,
            [chain for _, _, chain in ordered] + boundary,
            [kind for kind, _, _ in ordered] + ["boundary"] * len(boundary),
            [name for _, name, _ in ordered] + [""] * len(boundary),
            sources.astype(np.int32),
        ),
        boundary=[],
        extent=[],
        holes=[],
        erase=[],
        options=BuildOptions(),
        crs=None,
        has_own_boundary=has_own_boundary,
    )


def _list_named_chains(version: Version) -> list[tuple[LineKind, str, Int32Array]]:
    lines = version.lines
    return list(zip(lines.kinds, lines.names, lines.chains(), strict=True))


def _make_line_set(
    points: Float64Array,
    chains: list[Int32Array],
    kinds: list[LineKind],
    names: list[str],
    sources: Int32Array,
) -> LineSet:
    vertices = np.concatenate([*chains, np.empty(0, np.int32)])
    priorities = np.where(sources < 0, BELOW_ALL, 0.0)
    return LineSet(
        np.ascontiguousarray(points[vertices, :2]),
        points[vertices, 2],
        find_offsets(map(len, chains)),
        ConstraintTable(tuple(kinds), sources, priorities, tuple(names)),
    )


def _find_edges_of_no_line(version: Version) -> list[Int32Array]:
    """Return the flagged edges of no line; those of the boundary count if there are no lines."""
    surface, lines = version.triangulation, version.lines
    flagged = surface.constrained
    if len(lines):
        flagged = flagged & (surface.neighbors > topology.NO_NEIGHBOR)
    edges = np.unique(np.sort(topology.edges_at(surface.triangles, flagged), axis=1), axis=0)
    n = len(surface.points)
    is_segment = np.isin(topology.edge_keys(edges, n), topology.edge_keys(lines.segments(), n))
    return list(edges[~is_segment])


def build_of_triangles(given: Version, inputs: BuildInputs) -> Version:
    """Build existing triangles from their inputs.

    Raises
    ------
    PointsError
        If the build has other triangles.
    """
    try:
        built = assemble(inputs)
    except TinsmithError:
        raise _explain_unfit() from None
    if not _have_same_triangles(built.triangulation, given.triangulation):
        raise _explain_unfit()
    return built


def _have_same_triangles(found: Triangulation, given: Triangulation) -> bool:
    if len(found.triangles) != len(given.triangles) or len(found.points) != len(given.points):
        return False
    return bool((_as_set(found.triangles) == _as_set(given.triangles)).all())


def _explain_unfit() -> PointsError:
    return PointsError(
        "The TIN cannot be edited: its triangles overlap, or are not the Delaunay triangulation of "
        "its points and lines that edits must keep; triangulate its points first."
    )


def _as_set(triangles: Int32Array) -> Int32Array:
    first = np.argmin(triangles, axis=1)
    rolled = np.take_along_axis(triangles, (first[:, None] + np.arange(3)) % 3, axis=1)
    return rolled[np.lexsort(rolled.T[::-1])]
