"""Options that several commands share: axes, sheets of paper, coordinates on the ground."""

from .axes import alignment_option, axis_options, holds_alignments, read_axis, read_line
from .ground_coordinates import GROUND_COORDINATES, tell_factor
from .sheets import sheet_options

__all__ = [
    "GROUND_COORDINATES",
    "alignment_option",
    "axis_options",
    "holds_alignments",
    "read_axis",
    "read_line",
    "sheet_options",
    "tell_factor",
]
