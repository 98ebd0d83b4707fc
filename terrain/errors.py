"""Errors of the terrain room."""

from __future__ import annotations

from ..errors import OptionError, TinsmithError

__all__ = ["OptionError", "RenderError"]


class RenderError(TinsmithError, RuntimeError):
    """A picture that cannot be made or written; the sentence names the way out."""
