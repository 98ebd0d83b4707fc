"""The root of all errors, and those that every package may raise. Imports nothing of tinsmith."""

from __future__ import annotations

import re

__all__ = ["CrsError", "OptionError", "TinsmithError", "counted", "inflect"]


class TinsmithError(Exception):
    """Root of every error that tinsmith raises on purpose; its text is one clear sentence."""


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


class CrsError(TinsmithError, ValueError):
    """A coordinate reference system that is unknown, or that does not fit the purpose.

    Attributes
    ----------
    crs : object
        What was given.
    """

    def __init__(self, message: str, *, crs: object = None) -> None:
        super().__init__(message)
        self.crs = crs


_INFLECTED = re.compile(r"\[([^\[|\]]*)\|([^\[|\]]*)\]")


def inflect(sentence: str, count: int) -> str:
    """Take, of words written ``[singular|plural]``, those that fit a count.

    Examples
    --------
    >>> inflect("{count} [row is|rows are] missing.", 1)
    '{count} row is missing.'
    """
    return _INFLECTED.sub(r"\1" if count == 1 else r"\2", sentence)


def counted(number: int, noun: str, plural: str = "") -> str:
    """Return a number with its noun, for sentences.

    Examples
    --------
    >>> counted(1, "row"), counted(2000, "vertex", "vertices")
    ('1 row', '2,000 vertices')
    """
    return f"{number:,} {noun if number == 1 else plural or noun + 's'}"
