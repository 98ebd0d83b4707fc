"""Numbers in the texts of elements: batches at once, and the element at fault by its line."""

from __future__ import annotations

import re
import warnings
from typing import TYPE_CHECKING

import numpy as np

from ....base.errors import ReadError
from ....base.sentences import FILE, counted

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ....base.arrays import AnyArray, Float64Array

LARGEST_ID = 2**63 - 2
"""NumPy makes the next number of all larger ones."""

_SHOWN_LETTERS = 60
_PLAIN = {
    "f": re.compile(r"[-+0-9.eE\s]*", re.ASCII),
    "i": re.compile(r"[-+0-9\s]*", re.ASCII),
}
_WORD = {
    "f": re.compile(r"[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?", re.ASCII),
    "i": re.compile(r"[-+]?[0-9]{1,18}", re.ASCII),
}
_NAMES = {"f": "numbers", "i": "whole numbers of at most 18 digits"}


def parse_rows(
    texts: Sequence[str], lines: Sequence[int], *, width: int, kind: type[np.generic], what: str
) -> AnyArray:
    """Return the numbers of elements, a row each.

    Parameters
    ----------
    texts : sequence of str
    lines : sequence of int
        Of the file, where each element begins.
    width : int
        Numbers in each.
    kind : type
        ``numpy.float64`` or ``numpy.int64``.
    what : str
        Name of the elements, for sentences.

    Raises
    ------
    ReadError
        If an element has fewer or more numbers, or what is no number.
    """
    letter = np.dtype(kind).kind
    if len(texts) != len(lines):
        raise fault(lines[-1], f"{what} holds another one")
    joined = " ".join(texts)
    if _PLAIN[letter].fullmatch(joined) and all(len(text.split()) == width for text in texts):
        found = _parse_plain(joined, kind)
        if found is not None and found.size == width * len(texts) and _is_in_range(found):
            return found.reshape(-1, width)
    for text, line in zip(texts, lines, strict=True):
        words = text.split()
        for word in words:
            _require_word(word, line, letter, what)
        if len(words) != width:
            shown = _shorten(" ".join(words))
            has = counted(len(words), "number")
            raise fault(line, f"{what} has {has} ('{shown}'), not {width}")
    raise fault(lines[0], f"{what} cannot be read as {_NAMES[letter]}")


def parse_list(text: str, line: int, *, width: int, what: str) -> Float64Array:
    """Return the points of a list as rows.

    Raises
    ------
    ReadError
        If it has a number of numbers that rows do not have, or what is no number.
    """
    found = _parse_plain(text, np.float64) if _PLAIN["f"].fullmatch(text) else None
    count = len(text.split())
    if found is None or found.size != count:
        for word in text.split():
            _require_word(word, line, "f", what)
        raise fault(line, f"{what} cannot be read as numbers")
    if count % width:
        has = counted(count, "number")
        raise fault(line, f"{what} has {has}, and {width} for each point are needed")
    return found.reshape(-1, width)


def parse_words(text: str, line: int, *, what: str) -> list[float]:
    """Return the few numbers of one element.

    Raises
    ------
    ReadError
        If there is what is no number.
    """
    words = text.split()
    for word in words:
        _require_word(word, line, "f", what)
    return [float(word) for word in words]


def fault(line: int, what: str) -> ReadError:
    """Return the error that names a line."""
    return ReadError(f"{FILE}, line {line}: {what}.", lines=[line])


def _parse_plain(text: str, kind: type[np.generic]) -> AnyArray | None:
    if not text.strip():
        return np.empty(0, kind)
    with warnings.catch_warnings():
        warnings.simplefilter("error", DeprecationWarning)
        try:
            return np.fromstring(text, kind, sep=" ")
        except (DeprecationWarning, ValueError):
            return None


def _is_in_range(found: AnyArray) -> bool:
    """Whether whole numbers are none that NumPy has clamped."""
    return found.dtype.kind == "f" or not len(found) or int(np.abs(found).max()) <= LARGEST_ID


def _require_word(word: str, line: int, letter: str, what: str) -> None:
    if not _WORD[letter].fullmatch(word):
        raise fault(line, f"{what} has '{_shorten(word)}', not {_NAMES[letter]}")


def _shorten(text: str) -> str:
    return text if len(text) <= _SHOWN_LETTERS else f"{text[:_SHOWN_LETTERS]}..."
