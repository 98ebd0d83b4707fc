"""Lines that the surface must hold: given, noded, draped, and what they cut away."""

from .clipping import HOLES, in_rings
from .constraint_set import ABOVE_ALL, BELOW_ALL, LineSet
from .noding import node
from .polylines import Polylines

__all__ = ["ABOVE_ALL", "BELOW_ALL", "HOLES", "LineSet", "Polylines", "in_rings", "node"]
