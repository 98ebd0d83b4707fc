"""Surfaces put into others: pasted, and graded pads with their side slopes."""

from .balances import BalancedPad, balance
from .grades import grade
from .merging import merge
from .pads import Pad
from .pasting import join_surfaces, paste
from .patches import outline_patch, require_on_ground
from .seams import arrange_rings, find_area, find_first_near, measure_tolerance
from .slopes import Slope, lie_on, meet_ground, require_ground

__all__ = [
    "BalancedPad",
    "Pad",
    "Slope",
    "arrange_rings",
    "balance",
    "find_area",
    "find_first_near",
    "grade",
    "join_surfaces",
    "lie_on",
    "measure_tolerance",
    "meet_ground",
    "merge",
    "outline_patch",
    "paste",
    "require_ground",
    "require_on_ground",
]
