"""Notes of what was guessed or lost, warnings of it, and the file of which they speak."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Iterable
from contextlib import contextmanager
from contextvars import ContextVar
from typing import TYPE_CHECKING, Any

from .errors import LossWarning, OptionError, TinsmithError
from .sentences import FILE, name_file

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

_PACKAGE = __name__.partition(".")[0]

_FILE: ContextVar[Path | None] = ContextVar("file", default=None)
"""The file that is read or written."""


@contextmanager
def naming_file(file: Path) -> Iterator[None]:
    """Let every error and warning of a reader or writer speak of its file."""
    token = _FILE.set(file)
    try:
        yield
    except TinsmithError as error:
        error.add_file(file)
        raise
    finally:
        _FILE.reset(token)


def warn(sentence: str, category: type[Warning] = LossWarning) -> None:
    """Warn whoever called the toolkit, with the name of the file that is read or written."""
    file = _FILE.get()
    if file is not None and FILE in sentence:
        sentence = name_file(sentence, str(file))
    # The first frame outside of this package is that of the caller.
    level, frame = 2, sys._getframe(1)
    while frame.f_back and str(frame.f_globals.get("__name__")).partition(".")[0] == _PACKAGE:
        level, frame = level + 1, frame.f_back
    warnings.warn(sentence, category, stacklevel=level)


def join_notes(*groups: Iterable[str]) -> tuple[str, ...]:
    """Return notes one group after the other, each once."""
    return tuple(dict.fromkeys(note for group in groups for note in as_notes(group)))


def as_notes(notes: Any) -> tuple[str, ...]:
    """Return notes as a tuple of sentences."""
    is_several = isinstance(notes, Iterable) and not isinstance(notes, str)
    texts = tuple(notes) if is_several else (None,)
    if not all(isinstance(text, str) for text in texts):
        raise OptionError("notes", notes, allowed="a sequence of texts")
    return texts
