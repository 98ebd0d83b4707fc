"""Lines that the surface must hold: given, noded, draped, and what they cut away."""

from .clipping import HOLES, in_rings, require_cut, require_triangles
from .constraint_set import ABOVE_ALL, BELOW_ALL, LineSet, as_sequence
from .constraint_table import ConstraintTable
from .noding import node
from .polylines import Polylines

__all__ = [
    "ABOVE_ALL",
    "BELOW_ALL",
    "HOLES",
    "ConstraintTable",
    "LineSet",
    "Polylines",
    "as_sequence",
    "in_rings",
    "node",
    "require_cut",
    "require_triangles",
]
