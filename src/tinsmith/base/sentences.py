"""Sentences for people: numbers with their nouns, words that agree, text that is safe to print."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

FILE = "⟨file⟩"
"""Mark of the file that is read or written, where a sentence is made that does not know it."""

_OPTION = re.compile(r"(?:\b[tT]he option )?`([a-z]\w*)(?:=([^`]*))?`")

_INFLECTED = re.compile(r"\[([^\[|\]]*)\|([^\[|\]]*)\]")
_ODD_LETTER = "\N{REPLACEMENT CHARACTER}"
_LONGEST = 60
_MOST_ITEMS = 5
_MOST_BITS = 200
_SMALL = 1000.0
"""Coordinates below may be degrees, which need more decimals for a millimetre."""
_LARGE = 1e15


def coordinate(value: float) -> str:
    """Return an easting, a northing or a degree for sentences, not rounded by a millimetre.

    With 3 decimals, below 1,000 with 8, as degrees need them; those that are 0 at the end are left
    out. Only what is too large or too small for that has an exponent.

    Examples
    --------
    >>> coordinate(4024250.12345), coordinate(500000.0), coordinate(-86.12345678)
    ('4024250.123', '500000', '-86.12345678')
    """
    value = float(value)
    size = abs(value)
    text = f"{value:.{8 if size < _SMALL else 3}f}"
    if not size < _LARGE or (size > 0.0 and size < 1e-6):
        return f"{value:.10g}"
    return text.rstrip("0").rstrip(".")


def height(value: float) -> str:
    """Return an elevation for sentences, with 6 digits or to the millimetre.

    Examples
    --------
    >>> height(318.9475), height(10234.5678), height(320.0)
    ('318.947', '10234.568', '320')
    """
    value = float(value)
    if not _SMALL <= abs(value) < _LARGE:
        return f"{value:.6g}"
    return f"{value:.3f}".rstrip("0").rstrip(".")


def write_spacing(spacing: float | tuple[float, float]) -> str:
    """Write the side of square cells, or both sides of others.

    Examples
    --------
    >>> write_spacing(0.5), write_spacing((2.0, 3.0))
    ('0.5', '2 by 3')
    """
    sides = spacing if isinstance(spacing, tuple) else (spacing,)
    return " by ".join(f"{side:g}" for side in sides)


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


def suggest(word: str, known: Iterable[str]) -> str:
    """Return the question whether the nearest of the known words was meant, "" if none is near.

    Examples
    --------
    >>> suggest("biuld", ["build", "view"]), suggest("x", ["build", "view"])
    (" Did you mean 'build'?", '')
    """
    from difflib import get_close_matches

    near = get_close_matches(word, known, n=1)
    return f" Did you mean '{near[0]}'?" if near else ""


def name_file(text: str, name: str) -> str:
    """Return a sentence with the name of a file in place of its mark, or before it if it has none.

    Examples
    --------
    >>> name_file(f"{FILE} is empty.", "a.csv"), name_file("row 2 is not a number.", "a.csv")
    ("'a.csv' is empty.", "'a.csv': row 2 is not a number.")
    """
    name = printable(name)
    if FILE in text:
        return text.replace(FILE, f"'{name}'")
    return text if f"'{name}'" in text else f"'{name}': {text}"


def name_options(text: str, find_flag: Callable[[str], str | None]) -> str:
    """Return a sentence with flags of a command in place of the options that it marks.

    Sentences of the library have options, and options with a value, between backticks. An option
    for which ``find_flag`` returns None is left as it is: the command has none.

    Examples
    --------
    >>> flag = "--{}".format
    >>> name_options("say with the option `crs` which; `crs='EPSG:2056'` or `fill=True`.", flag)
    "say with --crs which; --crs 'EPSG:2056' or --fill."
    """

    def name(found: re.Match[str]) -> str:
        flag, value = find_flag(found[1]), found[2]
        if flag is None:
            return found[0]
        if value in ("True", "False"):
            return flag if value == "True" else flag.replace("--", "--no-", 1)
        return flag if value is None else f"{flag} {value}"

    return _OPTION.sub(name, text)


def printable(text: str) -> str:
    """Return a text that a terminal shows as it is: a file may hold orders to terminals."""
    if text.isprintable():
        return text
    return "".join(letter if letter.isprintable() else _ODD_LETTER for letter in text)


def shown(value: Any) -> str:
    """Return a value as a sentence can hold it: short, and NumPy's numbers as plain ones.

    Examples
    --------
    >>> shown("x" * 99)[-9:], shown(list(range(9)))
    ('xxxxxx...', '[0, 1, 2, 3, 4, ...]')
    """
    bases = {(base.__module__, base.__name__) for base in type(value).__mro__}
    if bases & {("numpy", "ndarray"), ("numpy", "generic")}:  # which this module does not load
        if value.shape:
            return f"an array of shape {value.shape}"
        value = value.item()
    if type(value) in (list, tuple) and value:
        more = ", ..." if len(value) > _MOST_ITEMS else ""
        return _shorten(f"[{', '.join(shown(item) for item in value[:_MOST_ITEMS])}{more}]")
    if isinstance(value, int) and not isinstance(value, bool) and value.bit_length() > _MOST_BITS:
        return f"{'-' if value < 0 else ''}2^{value.bit_length() - 1} or more"
    try:
        text = " ".join(repr(value).split())
    except Exception:
        text = f"a {type(value).__name__}"
    return _shorten(text)


def _shorten(text: str) -> str:
    return text if len(text) <= _LONGEST else text[: _LONGEST - 3] + "..."
