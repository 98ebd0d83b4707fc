"""Lines near a table that name its coordinates without being its header: "# Format: NEZ".

Such a line gives the order of the columns if it names all of them and nothing else; where it only
speaks of coordinates, no convention may decide what the columns are.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...base.errors import ReadError
from .columns import describe_doubts, find_columns_by_header, find_unit_word
from .lines import COMMENT_PREFIXES
from .names import is_label, parse_name, read_words
from .vocabulary import list_words

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from ...base.arrays import Int64Array
    from .lines import TextLines

_LINES_ABOVE, _LINES_BELOW = 100, 20
_LONGEST_LINE = 300
_SHOWN_LETTERS = 60
_LETTERS = re.compile(r"[PNEXYZHD-]{3,8}", re.IGNORECASE)
_SPLITS = (r"[,;\t|]", r"[/|\\]", r"->|[-\u2013>\u2192]", r"\s+")
_BEFORE_BRACKET = re.compile(r"\s+(?=[(\[])")
_SPEAKING = list_words("coordinate word")
"""Words that stand for a coordinate wherever they are; "north" may be in the name of a site."""


_COORDINATES = {"easting", "northing", "elevation"}
_UNIT_NOUNS = list_words("unit noun")
_FILLERS = _UNIT_NOUNS | list_words("unit filler")
"""Words beside which "elevations" and a unit say what the unit of the elevations is."""


class Heading(NamedTuple):
    """A line that speaks of coordinates."""

    line: int
    """From 0."""
    text: str
    names: tuple[str, ...] = ()
    """One a column; () if the line does not give them."""
    units: tuple[str, ...] = ()
    """Cells of a line of units below it."""

    @property
    def label(self) -> str:
        """Name the line for a sentence."""
        text = self.text.strip()
        shown = text if len(text) <= _SHOWN_LETTERS else f"{text[:_SHOWN_LETTERS]}..."
        return f"line {self.line + 1} ('{shown}')"

    @property
    def note(self) -> str:
        """Say that it gives the order of the columns."""
        return f"L{self.label[1:]} gives the order of the columns."


def find_heading(lines: TextLines, rows: Int64Array, count: int) -> Heading | None:
    """Return the line near a table that gives the order of its columns, or speaks of coordinates.

    Parameters
    ----------
    lines : TextLines
    rows : (n,) int64 array
        Lines of the table, from 0.
    count : int
        Number of its columns.
    """
    speaking: Heading | None = None
    giving: Heading | None = None
    for line, text in _list_others(lines, rows):
        names = _read_order(text, count)
        if names is None and giving is not None and line == giving.line + 1 and not giving.units:
            giving = giving._replace(units=_read_units(text, count))
        whole = lines.decode_line(line)
        if names is None and speaking is None and _speaks_of_coordinates(text):
            speaking = Heading(line, whole)
        if names is not None and giving is not None and names != giving.names:
            raise ReadError(
                f"{giving.label} and {Heading(line, whole).label} give two orders of its columns: "
                "say with the option `columns` which is right."
            )
        if names is not None and giving is None:
            giving = Heading(line, whole, names)
    return giving or speaking


def _list_others(lines: TextLines, rows: Int64Array) -> Iterator[tuple[int, str]]:
    """Walk the lines above a table, between its first rows, and behind it, that are no rows."""
    is_other = ~lines.is_blank
    is_other[rows] = False
    others = np.flatnonzero(is_other)
    near = others[(others < rows[0]) | (others > rows[-1])]
    for line in np.unique([*near[:_LINES_ABOVE], *others[:_LINES_BELOW], *near[-_LINES_BELOW:]]):
        text = lines.decode_line(int(line)).strip()
        prefix = next((one for one in COMMENT_PREFIXES if text.startswith(one)), "")
        if len(text) <= _LONGEST_LINE:
            yield int(line), text.removeprefix(prefix).strip(" \t#/;!%\"'")


def _read_order(text: str, count: int) -> tuple[str, ...] | None:
    """Return the names that a line gives the columns; None if it does not give all."""
    for part in dict.fromkeys((text, re.split(r"[:=]", text)[-1].strip())):
        for split in _SPLITS:
            cells = [one.strip(" \"'") for one in re.split(split, _BEFORE_BRACKET.sub("", part))]
            cells = [one for one in cells if one]
            for names, before in _list_readings(cells, count):
                if (
                    len(names) == count > 0
                    and not is_label(names[0])
                    and (not before or parse_name(names[0]).role)  # or it is one of the words
                    and _are_names(names)
                    and not _name_coordinates(before)
                ):
                    return tuple(names)
    return None


def _list_readings(cells: Sequence[str], count: int) -> Iterator[tuple[list[str], list[str]]]:
    """Walk the names that cells may hold, and the words before them: "fields N", "E", "Z"."""
    yield list(cells[-count:]), list(cells[:-count])
    for k, cell in enumerate(cells):
        yield _take_letters([cell.strip(",;:.()[]")]), [*cells[:k], *cells[k + 1 :]]
    if len(cells) == count:
        *words, name = cells[0].split(" ")
        yield [name, *cells[1:]], words


def _take_letters(cells: Sequence[str]) -> list[str]:
    """Return the letters of a word such as PNEZD."""
    word = "".join(cells)
    if _LETTERS.fullmatch(word) is None:
        return []
    letters = word.replace("-", "").upper()
    return list(word.upper()) if len(set(letters)) == len(letters) else []


def _are_names(names: Sequence[str]) -> bool:
    try:
        return find_columns_by_header(names) is not None and not describe_doubts(names)
    except ReadError:
        return False


def _name_coordinates(words: Sequence[str]) -> bool:
    roles = {sense.role for word in words for _, sense in read_words(word).roles}
    return not roles.isdisjoint(_COORDINATES)


def _speaks_of_coordinates(text: str) -> bool:
    """Whether a line has a word for a coordinate, or those for two of them."""
    letters = [set(_take_letters([word])) for word in re.split(r"[\s,;:=/|-]+", text)]
    if any(one >= {*"NE"} or one >= {*"XY"} for one in letters):
        return True
    named = read_words(text).roles
    if any(word in _SPEAKING for word, _ in named):
        return True
    return {sense.role for _, sense in named} >= {"easting", "northing"}


def _read_units(text: str, count: int) -> tuple[str, ...]:
    """Return the cells of a line of nothing but units."""
    for split in _SPLITS:
        cells = tuple(one.strip(" ()[]") for one in re.split(split, text))
        if len(cells) == count and all(find_unit_word(f"({cell})") for cell in cells if cell):
            return cells
    return ()


# ------------------------------------------------------------------ axes and units


class AxesLine(NamedTuple):
    """A line that says which way X and Y point: "X = Northing, Y = Easting"."""

    label: str
    is_turned: bool
    """Whether X points north."""


def find_axes_line(lines: TextLines, rows: Int64Array) -> AxesLine | None:
    """Return the first line near a table that says which way X and Y point."""
    for line, text in _list_others(lines, rows):
        named = [
            (sense.role, sense.kind == "axis")
            for _, sense in read_words(text).roles
            if sense.role in ("easting", "northing")
            and (sense.kind in ("axis", "word") or (sense.kind == "letter" and "=" in text))
        ]
        pairs = [(named[k], named[k + 1]) for k in range(0, len(named) - 1, 2)]
        if pairs and len(named) % 2 == 0 and all(one[1] != other[1] for one, other in pairs):
            are_turned = {one[0] != other[0] for one, other in pairs}
            if len(are_turned) == 1:
                label = Heading(line, lines.decode_line(line)).label
                return AxesLine(label, are_turned.pop())
    return None


class UnitLine(NamedTuple):
    """A line that tells a unit."""

    unit: str
    """That of the elevations, as it is written; "" if the line leaves open what it is of."""
    label: str
    note: str


def find_unit_line(lines: TextLines, rows: Int64Array) -> UnitLine | None:
    """Return the first line near a table that tells a unit: "# elevations in US survey feet"."""
    for line, text in _list_others(lines, rows):
        words = read_words(text)
        plain = {word.casefold() for word in words.unknown}
        named = {sense.role for _, sense in words.roles}
        if not words.units or re.search(rf"\d\s*{re.escape(words.units[0])}", text):
            continue
        if len(named & _COORDINATES) > 1 and not plain & _UNIT_NOUNS:
            continue  # a header, whose units are known
        whole = Heading(line, lines.decode_line(line)).label
        if named == {"elevation"} and plain <= _FILLERS and len(set(words.units)) == 1:
            note = f"L{whole[1:]} gives the unit of the elevations."
            return UnitLine(words.units[0], whole, note)
        if plain & _UNIT_NOUNS or "elevation" in named or words.has_datum:
            return UnitLine(
                "",
                whole,
                f"L{whole[1:]} tells a unit, which is not looked at: the option `elevation_unit` "
                "says that of the elevations.",
            )
    return None
