"""Barriers: edges across which natural neighbour and C1 interpolation do not look."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .. import topology

if TYPE_CHECKING:
    from ...base.arrays import BoolArray
    from ..triangulation import Triangulation
    from .breaklines import Lines

__all__ = ["find_barriers"]


def find_barriers(surface: Triangulation, lines: Lines) -> BoolArray:
    """Tell which edges are breaks of slope, (m, 3) flags of the edge opposite each corner.

    All that are constrained are, but those of soft breaklines alone. Constrained edges of no line
    that is known count as hard.
    """
    if "soft" not in lines.kinds:
        return surface.constrained
    n_vertices = len(surface.points)
    keys = topology.edge_keys(lines.steps(), n_vertices)
    is_soft = np.array([kind == "soft" for kind in lines.kinds])[lines.step_chains()]
    soft_only = np.setdiff1d(keys[is_soft], keys[~is_soft])
    start, end = topology.directed_edges(surface.triangles)
    own = topology.edge_keys(np.stack([start, end], axis=-1), n_vertices)
    return surface.constrained & ~np.isin(own, soft_only)
