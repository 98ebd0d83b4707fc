"""Errors of the world room: files, formats, coordinate reference systems."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..errors import CrsError, TinsmithError, counted

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

_ODD_LETTER = "\N{REPLACEMENT CHARACTER}"

__all__ = ["CrsError", "FormatError", "ReadError", "WriteError", "counted", "printable"]


def printable(text: str) -> str:
    """Return a text that a terminal shows as it is: a file may hold orders to terminals."""
    if text.isprintable():
        return text
    return "".join(letter if letter.isprintable() else _ODD_LETTER for letter in text)


class ReadError(TinsmithError, ValueError):
    """A file that cannot be read, or whose content is not what it should be.

    Attributes
    ----------
    path : Path or None
        The file.
    lines : tuple of int
        The first few line numbers at fault, counted from 1 as an editor does; may be empty.
    """

    def __init__(
        self, message: str, *, path: Path | None = None, lines: Sequence[int] = ()
    ) -> None:
        super().__init__(printable(message))
        self.path = path
        self.lines = tuple(int(line) for line in lines)

    @property
    def line(self) -> int | None:
        """The first line at fault, None if the fault is not in one line."""
        return self.lines[0] if self.lines else None


class WriteError(TinsmithError, OSError):
    """A file that cannot be written; a file that was there before is left whole.

    Attributes
    ----------
    path : Path or None
        The file.
    """

    def __init__(self, message: str, *, path: Path | None = None) -> None:
        super().__init__(message)
        self.path = path


class FormatError(TinsmithError, ValueError):
    """No format fits, or an option, or its value, that the format does not have.

    Attributes
    ----------
    known : tuple of str
        The names, suffixes, options or values that would be accepted; may be empty.
    """

    def __init__(self, message: str, *, known: Sequence[str] = ()) -> None:
        super().__init__(printable(message))
        self.known = tuple(known)
