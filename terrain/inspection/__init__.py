"""Blunders: points of a survey that do not fit the others."""

from .dropping import drop_blunders, list_wrong_rows
from .findings import DROPPED, blunders, screen

__all__ = ["DROPPED", "blunders", "drop_blunders", "list_wrong_rows", "screen"]
