"""Paper: sheets and what is drawn on them in millimetres, as PDF, SVG, PNG and DXF."""

from .canvas import GREY, INK, Canvas, Drawable, Pen
from .captions import Caption, Office, Revision
from .dxf import Model, name_layers
from .files import (
    PLAN_SUFFIXES,
    REPORT_SUFFIXES,
    SHEET_SUFFIXES,
    Document,
    NoRoom,
    join_no_room,
)
from .lettering import (
    CAPITAL,
    PURPOSE,
    Room,
    clean_text,
    find_missing_letters,
    fit_text,
    measure_text,
    outline_text,
)
from .papers import MM_PER_INCH, Layout, Paper, PaperLike, arrange_sheet

__all__ = [
    "CAPITAL",
    "GREY",
    "INK",
    "MM_PER_INCH",
    "PLAN_SUFFIXES",
    "PURPOSE",
    "REPORT_SUFFIXES",
    "SHEET_SUFFIXES",
    "Canvas",
    "Caption",
    "Document",
    "Drawable",
    "Layout",
    "Model",
    "NoRoom",
    "Office",
    "Paper",
    "PaperLike",
    "Pen",
    "Revision",
    "Room",
    "arrange_sheet",
    "clean_text",
    "find_missing_letters",
    "fit_text",
    "join_no_room",
    "measure_text",
    "name_layers",
    "outline_text",
]
