"""Lines that the surface must hold: given, noded, draped, and what they cut away."""

from .breaklines import Breakline, Lines
from .clipping import (
    BOUNDARY,
    HOLES,
    OWN_BOUNDARY,
    RingSegments,
    clip,
    in_rings,
    require_cut,
    require_triangles,
)
from .constraint_set import ABOVE_ALL, BELOW_ALL, LineSet, as_sequence
from .constraint_table import ConstraintTable, label_line
from .draping import CutLines, cut_at_boundary, drape
from .noding import node
from .polylines import Polylines
from .pslg import Clip, Pslg, build_mesh, build_mesh_of_growth, find_lines_in

__all__ = [
    "ABOVE_ALL",
    "BELOW_ALL",
    "BOUNDARY",
    "HOLES",
    "OWN_BOUNDARY",
    "Breakline",
    "Clip",
    "ConstraintTable",
    "CutLines",
    "LineSet",
    "Lines",
    "Polylines",
    "Pslg",
    "RingSegments",
    "as_sequence",
    "build_mesh",
    "build_mesh_of_growth",
    "clip",
    "cut_at_boundary",
    "drape",
    "find_lines_in",
    "in_rings",
    "label_line",
    "node",
    "require_cut",
    "require_triangles",
]
