"""Corridors: templates carried along an axis, with side slopes to the ground."""

from .corridor import corridor
from .templates import Part, Side, Template

__all__ = ["Part", "Side", "Template", "corridor"]
