"""Existing triangles as the build of inputs, so that they can be edited.

The vertices are the rows. Lines, and flagged edges of no line as soft breaklines, are kept; where
the boundary is not convex, or given by lines, there is no surface beyond it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...base.errors import PointsError, TinsmithError
from ..building import BuildInputs, BuildOptions, assemble
from ..constraints import BELOW_ALL, ConstraintTable, LineSet
from ..topology import find_offsets
from ..validation import as_points

if TYPE_CHECKING:
    from ...base.arrays import Int32Array
    from ..building import Version
    from ..triangulation import Triangulation


def gather_inputs_of_triangles(version: Version) -> BuildInputs:
    """Return what existing triangles are built of.

    Raises
    ------
    PointsError
        If a vertex is not finite.
    """
    surface, lines = version.triangulation, version.lines
    given = list(zip(lines.kinds, lines.names, lines.chains(), strict=True))
    named = [one for one in given if one[0] in ("hard", "soft")]
    named += [
        ("soft", "", edge) for edge in version.find_edges_of_no_line(on_boundary=not len(lines))
    ]
    sources = list(range(len(named)))
    named += [one for one in given if one[0] not in ("hard", "soft")]
    sources += [0] * (len(named) - len(sources))
    has_own_boundary = not surface.fills_hull or "boundary" in lines.kinds
    if has_own_boundary:
        named += [("boundary", "", np.append(ring, ring[:1])) for ring in surface.rings]
    sources += [-1] * (len(named) - len(sources))
    vertices = np.concatenate([*(chain for _, _, chain in named), np.empty(0, np.int32)])
    return BuildInputs(
        points=as_points(surface.points),
        is_masked=None,
        lines=LineSet(
            np.ascontiguousarray(surface.points[vertices, :2]),
            surface.points[vertices, 2],
            find_offsets([len(chain) for _, _, chain in named]),
            ConstraintTable(
                tuple(kind for kind, _, _ in named),
                np.array(sources, np.int32),
                np.where(np.array(sources) < 0, BELOW_ALL, 0.0),
                tuple(name for _, name, _ in named),
            ),
        ),
        boundary=[],
        extent=[],
        holes=[],
        erase=[],
        options=BuildOptions(),
        crs=None,
        has_own_boundary=has_own_boundary,
    )


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
