"""Errors of the terrain room."""

from __future__ import annotations

from ..tin import TinsmithError

__all__ = ["RenderError"]


class RenderError(TinsmithError, RuntimeError):
    """A picture that cannot be made; the sentence says what is missing or not allowed."""
