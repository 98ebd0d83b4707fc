"""Drawing: what pages, plans, charts and notebooks share: lines, numbers, 3D models, HTML."""

from .arguments import PICTURE_SUFFIXES, UNTITLED, parse_text, parse_title, require_features
from .furniture import NORTH_ARROW, Legend, make_legend, make_scale_bar
from .lettering import Lettering, fit_text
from .linework import (
    EDGE_KINDS,
    LINE_STYLES,
    LineEdges,
    add_lines,
    add_polylines,
    find_line_edges,
    join_edges,
)
from .models import choose_origin
from .north_up import draw_north_up
from .palette import (
    BACKGROUNDS,
    COMPASS,
    STEEPNESS,
    TRIANGULATIONS,
    Color,
    Palette,
    choose_palette,
    interpolate_colors,
    interpolate_tints,
    parse_hex,
)
from .rounding import choose_ticks, format_number, round_down

__all__ = [
    "BACKGROUNDS",
    "COMPASS",
    "EDGE_KINDS",
    "LINE_STYLES",
    "NORTH_ARROW",
    "PICTURE_SUFFIXES",
    "STEEPNESS",
    "TRIANGULATIONS",
    "UNTITLED",
    "Color",
    "Legend",
    "Lettering",
    "LineEdges",
    "Palette",
    "add_lines",
    "add_polylines",
    "choose_origin",
    "choose_palette",
    "choose_ticks",
    "draw_north_up",
    "find_line_edges",
    "fit_text",
    "format_number",
    "interpolate_colors",
    "interpolate_tints",
    "join_edges",
    "make_legend",
    "make_scale_bar",
    "parse_hex",
    "parse_text",
    "parse_title",
    "require_features",
    "round_down",
]
