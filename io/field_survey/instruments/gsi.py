"""Leica GSI files, of words with 8 or 16 characters.

A line is a block of words; each begins with its word index, tells units and how the value came to
be in front of a sign, and ends with a blank: ``81..00+00515836`` is an easting of 515.836 m. Word
indices read: 11 point, 21 circle, 22 zenith angle, 31 slope distance, 41 to 49 code block, 71 to 79
remarks, 81 to 83 easting, northing, elevation of the target, 84 to 86 those of the station, 87
height of the target, 88 of the instrument. Unit digits: 0 mm, 1 thousandths of feet, 2 gon, 3
degrees, 4 degrees, minutes and seconds, 5 mil, 6 tenths of mm, 7 ten-thousandths of feet, 8
hundredths of mm.

Reference: Leica Geosystems, TPS1100 User Manual 2.2, chapter Data format.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple

from ....base.crs import METRE
from ....base.errors import OptionError, ReadError
from ....base.sentences import FILE, counted, inflect
from ...delimited import read_lines
from .records import Book, book_reader, require_refraction
from .reduction import Shot, Station, reduce_shot, to_radians

if TYPE_CHECKING:
    from collections.abc import Container, Iterator
    from pathlib import Path

    from ...delimited import TextLines

_WIDTHS = (8, 16)
_HEAD = 7  # word index, information and sign
_LENGTHS = {"0": (1e3, True), "6": (1e4, True), "8": (1e5, True), "1": (1e3, False)}
_LENGTHS["7"] = (1e4, False)
"""By unit digit: how many of the last digit make a unit, and whether it is a metre."""
_ANGLES = {"2": "gon", "3": "degrees", "4": "sexagesimal", "5": "mil"}
_ANGLE_DIGITS = 1e5
_MIL_DIGITS = 1e4
_NO_VALUE = re.compile(r"0*-+")
"""What Leica writes for a value that could not be computed."""
_WORD = re.compile(r"(?:\d\d[\d.]|\d{3})[\d.]{3}[+-]")
_TARGET, _STATION = (81, 82, 83), (84, 85, 86)
_SAME_PLACE = 0.05
"""Metres within which a shot that is reduced proves the circle oriented."""


class _Word(NamedTuple):
    number: int
    unit: str
    sign: str
    data: str


@dataclass
class _Block:
    """The words of one measurement or code, and its line from 1."""

    line: int
    words: dict[int, _Word] = field(default_factory=dict)

    @property
    def is_code(self) -> bool:
        """Whether it is a block of codes."""
        return 41 in self.words and 11 not in self.words


@book_reader
def read(
    path: Path,
    *,
    encoding: str | None = None,
    code_blocks: str | None = None,
    oriented: bool = False,
    refraction: float | None = None,
) -> Book:
    """Read points of a Leica GSI file.

    Parameters
    ----------
    code_blocks : {"before", "after"}, optional
        Whether a block of codes (word 41) stands before or after the point that it is for; default
        where the first and last block show it.
    oriented : bool, optional
        Whether the circle reads azimuths, so that shots without coordinates are reduced.
    refraction : float, optional
        Coefficient of refraction by which shots are corrected, with the earth's curvature.

    Returns
    -------
    Survey
        With ``number``, and ``description`` of the remarks (word 71) or codes (41). Shots without
        coordinates are reduced where station, heights and orientation are known, and else left out.

    Raises
    ------
    ReadError
        If a word is no word, lengths are in feet and in metres, or no point has coordinates.
    """
    if code_blocks not in (None, "before", "after"):
        raise OptionError("code_blocks", code_blocks, ("before", "after"))
    coefficient = require_refraction(refraction)
    blocks = list(_iterate_blocks(read_lines(path, encoding=encoding)))
    if not any(11 in block.words for block in blocks):
        raise ReadError(f"{FILE} has no block of a point (word 11).")
    reader = _Reader(Book(path), oriented=oriented, refraction=coefficient)
    codes = _assign_codes(blocks, code_blocks, reader.book)
    reader.find_unit(blocks)
    reader.find_oriented(blocks)
    for i, block in enumerate(blocks):
        if not block.is_code:
            reader.add(block, codes.get(i, ""))
    reader.note_missing()
    return reader.book


# ------------------------------------------------------------------ words


def _iterate_blocks(lines: TextLines) -> Iterator[_Block]:
    """Walk the blocks; one begins with a line, and with each point or code in it."""
    for number in range(len(lines)):
        text = lines.decode_line(number).rstrip()
        if not text.strip():
            continue
        block: _Block | None = None
        for word in _split(text, number + 1):
            if block is None or (word.number in (11, 41) and block.words):
                if block is not None:
                    yield block
                block = _Block(number + 1)
            block.words.setdefault(word.number, word)
        if block is not None:
            yield block


def _split(text: str, line: int) -> Iterator[_Word]:
    """Walk the words of a line."""
    has_star = text.startswith("*")
    text = text[has_star:]
    width = 16 if has_star else len(text.split(" ", 1)[0]) - _HEAD
    if width not in _WIDTHS:
        raise _fail(line, text.split(" ", 1)[0], "8 characters behind its sign, or 16")
    step = _HEAD + width
    at = 0
    while at < len(text):
        word = text[at : at + step]
        is_cut = len(word.rstrip()) <= _HEAD or len(word) < step
        if _WORD.match(word) is None or is_cut or text[at + step : at + step + 1].strip():
            raise _fail(line, word, f"index, information, sign and {width} characters")
        index = word[:3] if word[2].isdigit() and word[:2] not in ("11", "41") else word[:2]
        yield _Word(int(index), word[5], word[6], word[_HEAD:])
        at += step
        while at < len(text) and text[at] == " ":
            at += 1


def _fail(line: int, word: str, allowed: str) -> ReadError:
    return ReadError(
        f"{FILE}, line {line}: '{word[:30]}' is no word of GSI: it must have {allowed}.",
        lines=[line],
    )


def _strip(word: _Word) -> str:
    """Return the text of a word without the zeros that fill it."""
    return word.data.strip().lstrip("0") or ("0" if word.data.strip() else "")


# ------------------------------------------------------------------ codes


def _assign_codes(blocks: list[_Block], where: str | None, book: Book) -> dict[int, str]:
    """Return the description of each block of a point: its remarks, else the code beside it."""
    found = {i: _join(block, range(71, 80)) for i, block in enumerate(blocks) if not block.is_code}
    found = {i: text for i, text in found.items() if text}
    for i, block in enumerate(blocks):
        if 42 in block.words and not block.is_code:  # a code within the block of its point
            found.setdefault(i, _join(block, range(41, 50)))
    coded = [i for i, block in enumerate(blocks) if block.is_code]
    if not coded:
        return found
    # 1 if codes stand before their points, -1 if after, 0 if nothing shows it.
    if where is not None:
        step = 1 if where == "before" else -1
    else:
        first, last = blocks[0].is_code, blocks[-1].is_code
        step = 0 if first == last else (1 if first else -1)
    if step == 0:
        book.notes.append(
            inflect(
                f"{counted(len(coded), 'block')} of codes [is|are] not read: nothing shows whether "
                "codes stand before or after their points, and the option `code_blocks` says it.",
                len(coded),
            )
        )
        return found
    for i in coded:
        beside = i + step
        if 0 <= beside < len(blocks) and not blocks[beside].is_code:
            found.setdefault(beside, _join(blocks[i], range(41, 50)))
    return found


def _join(block: _Block, indices: range) -> str:
    words = [_strip(block.words[i]) for i in indices if i in block.words]
    return " ".join(word for word in words if word and word != "0")


# ------------------------------------------------------------------ points


class _Reader:
    """Takes blocks as they come, and remembers the station."""

    def __init__(self, book: Book, *, oriented: bool, refraction: float | None) -> None:
        self.book = book
        self.oriented = oriented
        self.refraction = refraction
        self.proved: set[tuple[float, ...]] = set()
        self._station = (math.nan,) * 3
        self._height = math.nan
        self._without_orientation = 0

    def find_unit(self, blocks: list[_Block]) -> None:
        """Require lengths in feet or in metres, not in both."""
        units: dict[bool, int] = {}
        for block in blocks:
            for index in (31, *_TARGET, *_STATION, 87, 88):
                word = block.words.get(index)
                if word is not None and word.unit in _LENGTHS:
                    units.setdefault(_LENGTHS[word.unit][1], block.line)
        if len(units) > 1:
            raise ReadError(
                f"{FILE} has lengths in metres (line {units[True]}) and in feet (line "
                f"{units[False]}): all must be in one unit.",
                lines=sorted(units.values()),
            )
        self.book.unit = None if False in units else METRE

    def find_oriented(self, blocks: list[_Block]) -> None:
        """Find the stations from which shots with coordinates prove the circle oriented."""
        for block in blocks:
            self._set_up(block)
            station, shot = self._find_station(), self._find_shot(block)
            target = [self._read_length(block, index) for index in _TARGET]
            if not (station.is_known and shot.is_known and all(map(math.isfinite, target))):
                continue
            reduced = reduce_shot(station, shot, refraction=None, metres=self._metres)
            if math.dist(reduced[:2], target[:2]) * self._metres <= _SAME_PLACE:
                self.proved.add(self._station)
        self._station, self._height = (math.nan,) * 3, math.nan

    @property
    def _metres(self) -> float:
        return 1.0 if self.book.unit is METRE else 0.3048

    def add(self, block: _Block, code: str) -> None:
        """Add the point of a block."""
        self._set_up(block)
        if 11 not in block.words:
            return
        name = _strip(block.words[11])
        x, y, z = (self._read_length(block, index) for index in _TARGET)
        if math.isfinite(x) and math.isfinite(y):
            self.book.add(name, (x, y, z), code, block.line, "coordinates")
        elif {21, 22, 31} & block.words.keys():
            station, shot = self._find_station(), self._find_shot(block)
            if not (station.is_known and shot.is_known):
                self.book.leave_out(
                    "shots without station, heights, angles or distance", block.line
                )
            elif not (self.oriented or self._station in self.proved):
                self._without_orientation += 1
                self.book.leave_out("shots without orientation", block.line)
            else:
                xyz = reduce_shot(station, shot, refraction=self.refraction, metres=self._metres)
                self.book.add(name, xyz, code, block.line, "reduced")

    def note_missing(self) -> None:
        """Say what is missing for shots that were left out."""
        if self._without_orientation:
            self.book.notes.append(
                "The file does not say whether its circle reads azimuths: the option `oriented` "
                "says that it does."
            )

    def _set_up(self, block: _Block) -> None:
        if all(index in block.words for index in _STATION):
            x, y, z = (self._read_length(block, index) for index in _STATION)
            place = (x, y, z)
            if place != self._station:
                self._height = math.nan
            self._station = place
        if 88 in block.words:
            self._height = self._read_length(block, 88)

    def _find_station(self) -> Station:
        return Station(*self._station, self._height, 0.0)

    def _find_shot(self, block: _Block) -> Shot:
        circle, zenith = self._read_angle(block, 21), self._read_angle(block, 22)
        return Shot(circle, zenith, self._read_length(block, 31), self._read_length(block, 87))

    def _read_length(self, block: _Block, index: int) -> float:
        word = self._find_word(block, index, _LENGTHS, "a unit digit 0, 1, 6, 7 or 8")
        return (
            math.nan if word is None else self._parse_number(block, word) / _LENGTHS[word.unit][0]
        )

    def _read_angle(self, block: _Block, index: int) -> float:
        word = self._find_word(block, index, _ANGLES, "a unit digit 2, 3, 4 or 5")
        if word is None:
            return math.nan
        unit = _ANGLES[word.unit]
        value = self._parse_number(block, word) / (_MIL_DIGITS if unit == "mil" else _ANGLE_DIGITS)
        angle = to_radians(value, unit)
        if math.isnan(angle) and not math.isnan(value):
            raise self._fail_value(block, word, "minutes and seconds below 60")
        return angle

    def _find_word(
        self, block: _Block, index: int, units: Container[str], allowed: str
    ) -> _Word | None:
        """Return a word whose unit must be one of some; None if the block does not have it."""
        word = block.words.get(index)
        if word is not None and word.unit not in units:
            raise self._fail_value(block, word, allowed)
        return word

    def _parse_number(self, block: _Block, word: _Word) -> float:
        if _NO_VALUE.fullmatch(word.data.strip()):
            return math.nan
        if not (word.data.isascii() and word.data.isdigit()):
            raise self._fail_value(block, word, "digits alone")
        return float(word.sign + word.data)

    def _fail_value(self, block: _Block, word: _Word, allowed: str) -> ReadError:
        return ReadError(
            f"{FILE}, line {block.line}: word {word.number} is "
            f"'{word.unit}{word.sign}{word.data}', and it must have {allowed}.",
            lines=[block.line],
        )
