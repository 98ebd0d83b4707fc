"""Notes of what was guessed or lost, warnings of it, and the file of which they speak."""

from __future__ import annotations

import re
import sys
import warnings
from collections.abc import Iterable, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from .errors import LossWarning, OptionError, TinsmithError
from .sentences import FILE, counted, name_file

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

_OWN = (__name__.partition(".")[0], "contextlib")
"""Modules whose frames are not the caller's; context managers run between those of the package."""

_FILE: ContextVar[Path | None] = ContextVar("file", default=None)
"""The file that is read or written."""

_ORIGINALS: ContextVar[Mapping[Path, Path]] = ContextVar("originals", default=MappingProxyType({}))
"""Files as the user names them, by the copies of them that are read."""

_COLLECTED: ContextVar[list[str] | None] = ContextVar("collected", default=None)
"""Warnings of what is lost, where they are collected."""

_QUOTED_OR_NUMBER = re.compile(r"'[^']*'|[-\d.,]+")


@contextmanager
def naming_file(file: Path) -> Iterator[None]:
    """Let every error and warning of a reader or writer speak of its file, not of a copy of it."""
    original = _find_original(file)
    token = _FILE.set(original)
    try:
        yield
    except TinsmithError as error:
        error.add_file(original)
        raise
    finally:
        _FILE.reset(token)


@contextmanager
def naming_copy(copy: Path, file: Path) -> Iterator[None]:
    """Let errors and warnings about a copy of a file, such as an unpacked one, name the file."""
    original = _find_original(file)
    token = _ORIGINALS.set({**_ORIGINALS.get(), copy: original})
    try:
        yield
    except TinsmithError as error:
        _rename(error, copy, original)
        raise
    finally:
        _ORIGINALS.reset(token)


def _find_original(file: Path) -> Path:
    """Return the file of which a path is a copy, itself if it is none."""
    originals = _ORIGINALS.get()
    return originals.get(file, file) if originals else file  # it may be no path, and no key


def _rename(error: TinsmithError, copy: Path, file: Path) -> None:
    """Put the name of a file in the place of that of its copy, as libraries tell it."""
    if error.args and isinstance(error.args[0], str):
        # What names the file already may hold the name of the copy.
        kept = {name: name for name in (str(file), file.name)}
        names = {str(copy): str(file), **kept, copy.name: file.name}
        text = re.sub("|".join(map(re.escape, names)), lambda found: names[found[0]], error.args[0])
        error.args = (text, *error.args[1:])
    if error.file == copy:
        error.file = file


@contextmanager
def collecting_warnings() -> Iterator[list[str]]:
    """Collect what would be warned of what is lost, for whoever called from another process.

    Yields
    ------
    list of str
        The sentences so far, each once.
    """
    found: list[str] = []
    token = _COLLECTED.set(found)
    try:
        yield found
    finally:
        _COLLECTED.reset(token)


def list_collected() -> tuple[str, ...]:
    """Return the warnings that were collected so far, none where they are not."""
    return tuple(_COLLECTED.get() or ())


def warn(sentence: str, category: type[Warning] = LossWarning) -> None:
    """Warn whoever called the toolkit, with the name of the file that is read or written."""
    file = _FILE.get()
    if file is not None and FILE in sentence:
        sentence = name_file(sentence, str(file))
    collected = _COLLECTED.get()
    if collected is not None and category is LossWarning:
        collected += [] if sentence in collected else [sentence]
        return
    # The first frame outside of this package is that of the caller.
    level, frame = 2, sys._getframe(1)
    while frame.f_back and str(frame.f_globals.get("__name__")).partition(".")[0] in _OWN:
        level, frame = level + 1, frame.f_back
    warnings.warn(sentence, category, stacklevel=level)


def join_notes(*groups: Iterable[str]) -> tuple[str, ...]:
    """Return notes one group after the other, each once."""
    return tuple(dict.fromkeys(note for group in groups for note in as_notes(group)))


def join_alike(notes: Iterable[str]) -> tuple[str, ...]:
    """Return notes of several files; of those that differ in names and numbers only the first.

    How many files have a note like it is told.

    Examples
    --------
    >>> join_alike(["'a' lost 2 codes.", "'b' lost 3 codes.", "All is well.", "All is well."])
    ("'a' lost 2 codes. (1 further file likewise.)", 'All is well.')
    """
    kinds: dict[str, list[str]] = {}
    for note in notes:
        kinds.setdefault(_QUOTED_OR_NUMBER.sub("", note), []).append(note)
    joined = []
    for several in kinds.values():
        others = len(several) - 1
        is_same = len({*several}) == 1
        more = f" ({counted(others, 'further file')} likewise.)" if others and not is_same else ""
        joined.append(f"{several[0]}{more}")
    return join_notes(joined)


def as_notes(notes: Any) -> tuple[str, ...]:
    """Return notes as a tuple of sentences."""
    try:
        texts = (None,) if isinstance(notes, str) else tuple(notes)
    except (TypeError, LookupError):  # nothing to go through
        texts = (None,)
    if not all(isinstance(text, str) for text in texts):
        raise OptionError("notes", notes, allowed="a sequence of texts")
    return texts
