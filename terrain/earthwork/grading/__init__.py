"""Surfaces put into others: pasted, and graded pads with their side slopes."""

from .grades import grade
from .pasting import paste

__all__ = ["grade", "paste"]
