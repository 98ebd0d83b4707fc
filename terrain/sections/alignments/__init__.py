"""Alignments: axes of lines, arcs and transition curves, with stations and elevations."""

from .alignment import Alignment
from .elements import Element
from .stationing import StationEquation
from .values import as_numbers, as_places
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
