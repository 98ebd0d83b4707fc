"""Sentences for people: numbers with their nouns, words that agree, text that is safe to print."""

from __future__ import annotations

import re

__all__ = ["counted", "inflect", "printable"]

_INFLECTED = re.compile(r"\[([^\[|\]]*)\|([^\[|\]]*)\]")
_ODD_LETTER = "\N{REPLACEMENT CHARACTER}"


def counted(number: int, noun: str, plural: str = "") -> str:
    """Return a number with its noun, for sentences.

    Examples
    --------
    >>> counted(1, "row"), counted(2000, "vertex", "vertices")
    ('1 row', '2,000 vertices')
    """
    return f"{number:,} {noun if number == 1 else plural or noun + 's'}"


def inflect(sentence: str, count: int) -> str:
    """Take, of words written ``[singular|plural]``, those that fit a count.

    Examples
    --------
    >>> inflect("{count} [row is|rows are] missing.", 1)
    '{count} row is missing.'
    """
    return _INFLECTED.sub(r"\1" if count == 1 else r"\2", sentence)


def printable(text: str) -> str:
    """Return a text that a terminal shows as it is: a file may hold orders to terminals."""
    if text.isprintable():
        return text
    return "".join(letter if letter.isprintable() else _ODD_LETTER for letter in text)
