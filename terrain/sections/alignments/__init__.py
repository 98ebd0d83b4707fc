"""Alignments: axes of lines, arcs and transition curves, with stations and elevations."""

from .alignment import Alignment
from .arguments import as_numbers, as_places
from .elements import Element
from .stationing import StationEquation
from .verticals import VerticalAlignment, VerticalPoint

__all__ = [
    "Alignment",
    "Element",
    "StationEquation",
    "VerticalAlignment",
    "VerticalPoint",
    "as_numbers",
    "as_places",
]
