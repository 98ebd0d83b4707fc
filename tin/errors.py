"""Errors of the toolkit: one root, and each also the built-in that it resembles."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

from ..errors import TinsmithError

if TYPE_CHECKING:
    from .findings import Problem

__all__ = ["CheckError", "LinesError", "MissingExtraError", "PointsError", "TinsmithError"]


class PointsError(TinsmithError, ValueError):
    """Points, or options for them, that cannot make a TIN.

    Attributes
    ----------
    rows : tuple of int
        The first few row numbers (0-based, in the caller's own input) at fault; may be empty.
    """

    def __init__(self, message: str, *, rows: Iterable[int] = ()) -> None:
        super().__init__(message)
        self.rows = tuple(int(row) for row in rows)


class LinesError(TinsmithError, ValueError):
    """Breaklines, rings or options for them that the surface cannot hold.

    Attributes
    ----------
    lines : tuple of int
        The first few lines (0-based, in the caller's own input) at fault; may be empty.
    """

    def __init__(self, message: str, *, lines: Iterable[int] = ()) -> None:
        super().__init__(message)
        self.lines = tuple(int(line) for line in lines)


class CheckError(TinsmithError, ValueError):
    """A TIN that is not what it should be; the text is one sentence for each kind of problem.

    Attributes
    ----------
    problems : tuple of Problem
        As in :class:`tinsmith.tin.CheckResult`.
    """

    def __init__(self, message: str, *, problems: Sequence[Problem] = ()) -> None:
        super().__init__(message)
        self.problems = tuple(problems)


class MissingExtraError(TinsmithError, ImportError):
    """An optional library is not installed; the sentence names the extra that brings it.

    Attributes
    ----------
    extra : str
        Name of the extra, as in ``pip install "tinsmith[extra]"``.
    """

    def __init__(self, library: str, *, extra: str, purpose: str) -> None:
        super().__init__(
            f"{purpose} needs {library}, which is not installed: "
            f'run pip install "tinsmith[{extra}]".'
        )
        self.extra = extra
