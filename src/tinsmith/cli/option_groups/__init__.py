"""Options that several commands share: axes, sheets of paper, coordinates on the ground."""

from .axes import alignment_option, axis_options, holds_alignments, read_axis, read_line
from .ground_coordinates import GROUND_COORDINATES, tell_factor
from .sheets import add_sheets, name_title_block, sheet_options, take_sheets

__all__ = [
    "GROUND_COORDINATES",
    "add_sheets",
    "alignment_option",
    "axis_options",
    "holds_alignments",
    "name_title_block",
    "read_axis",
    "read_line",
    "sheet_options",
    "take_sheets",
    "tell_factor",
]
