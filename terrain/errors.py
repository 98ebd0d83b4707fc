"""Errors of the terrain room."""

from __future__ import annotations

from ..tin import TinsmithError

__all__ = ["OptionError", "RenderError"]


class OptionError(TinsmithError, ValueError):
    """An option outside what is allowed.

    Attributes
    ----------
    option : str
        Name of the parameter.
    value : object
        What was given.
    """

    def __init__(self, option: str, value: object, *, allowed: str) -> None:
        super().__init__(f"Invalid {option} {value!r}: it must be {allowed}.")
        self.option = option
        self.value = value


class RenderError(TinsmithError, RuntimeError):
    """A picture that cannot be made or written; the sentence names the way out."""
