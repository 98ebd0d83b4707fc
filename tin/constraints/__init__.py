"""Lines that the surface must hold: given, noded, draped, and what they cut away."""

from .breaklines import Breakline, Lines
from .clipping import HOLES, in_rings, require_cut, require_triangles
from .constraint_set import ABOVE_ALL, BELOW_ALL, LineSet, as_sequence
from .constraint_table import ConstraintTable, label_line
from .draping import CutLines, cut_at_boundary, drape
from .noding import node
from .polylines import Polylines
from .pslg import Clip, Pslg, build_mesh

__all__ = [
    "ABOVE_ALL",
    "BELOW_ALL",
    "HOLES",
    "Breakline",
    "Clip",
    "ConstraintTable",
    "CutLines",
    "LineSet",
    "Lines",
    "Polylines",
    "Pslg",
    "as_sequence",
    "build_mesh",
    "cut_at_boundary",
    "drape",
    "in_rings",
    "label_line",
    "node",
    "require_cut",
    "require_triangles",
]
