"""Corridors: quantities along an axis between two surfaces."""

from .quantities import find_balanced, section_volumes

__all__ = ["find_balanced", "section_volumes"]
