"""Alignments: axes of lines, arcs and transition curves, with stations and elevations."""

from .alignment import Alignment
from .elements import Element
from .stationing import StationEquation
from .verticals import VerticalAlignment, VerticalPoint

__all__ = ["Alignment", "Element", "StationEquation", "VerticalAlignment", "VerticalPoint"]
