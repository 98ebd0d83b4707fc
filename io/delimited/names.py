"""What the name of one column says, read to its last word.

A name is divided into words, brackets into parts of their own, and every word must be known: one
for a role, a unit, a datum, a CRS, or one that says nothing. What is left over may change the
meaning ("sdev", "depth", "x0.01", a minus sign), so that the column is not taken for a coordinate.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from functools import lru_cache
from typing import TYPE_CHECKING, NamedTuple

from .vocabulary import CONTEXT, find_sense, list_languages, list_words, simplify

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from .vocabulary import Kind, Sense

_LONGEST_NAME = 200
"""Letters of a header cell that may be a name; a longer one is some other text."""
_LONGEST_PHRASE = 6
_SHOWN_LETTERS = 40
_NUMBER_SIGN = re.compile(r"(?<![^\W_])n\s?[°º#]|№|#", re.IGNORECASE)
_NO_NAME = re.compile(r"\s*([-+.,]*[0-9]|[^\w#№]*$)")
"""Numbers, among them 1e5, and texts without a letter."""
_MARKS = "\u0300-\u036f\u0591-\u05c7\u064b-\u065f\u0670\u0e31\u0e34-\u0e3a\u0e47-\u0e4e"
"""Accents that stand alone, vowels of Hebrew, Arabic and Thai."""
_WORD = re.compile(rf"(?:[^\W\d_][{_MARKS}]*)+|\d+|[^\w\s]|_")
_JOINED_WORDS = re.compile(
    r"(?<=[a-z]{2})(?=[A-Z])|(?<=[A-Za-z])(?=[\u3040-\u9fff\uac00-\ud7af])"
    r"|(?<=[\u3040-\u9fff\uac00-\ud7af])(?=[A-Za-z])"
)
_LABELS = list_words("label")
_OPENING, _CLOSING = "([{", ")]}"
_NO_BRACKETS = str.maketrans(dict.fromkeys(_OPENING + _CLOSING, " "))
_SEPARATORS = frozenset('_.,:;/|"=\u2013-')
_COORDINATES = ("easting", "northing", "elevation")
_ALONE = frozenset({"alt"})
"""Short for "altitude", and the German for "old" beside another word."""


@dataclass(frozen=True, slots=True)
class ColumnName:
    """What the name of a column says."""

    role: str = ""
    """``"easting"``, ``"northing"``, ``"elevation"``, ``"number"``, ``"description"``,
    ``"hemisphere"``; "" if none.
    """
    kind: Kind = ""
    """How it is named: what belongs together is named in one way."""
    system: str = ""
    """The CRS or grid named beside it: ``"local"``, ``"utm32"``."""
    unit: str = ""
    """The unit of length, as it is written."""
    doubt: str = ""
    """What is not understood, as it is written: the column is not to be taken for its role."""
    word: str = ""
    """The words for the role."""
    rank: int = 0
    """Of several names for one role, that with the least says it most clearly."""


class _Word(NamedTuple):
    """A word or sign of a name: how it is compared, and where it stands."""

    plain: str
    start: int
    end: int


@dataclass(slots=True)
class _Found:
    """What the words of a name say."""

    roles: list[tuple[str, Sense]] = field(default_factory=list)
    systems: list[str] = field(default_factory=list)
    units: list[tuple[str, str]] = field(default_factory=list)
    has_degrees: bool = False
    has_datum: bool = False
    unknown: list[str] = field(default_factory=list)


def shorten(name: str) -> str:
    """Cut a name that no sentence should hold whole."""
    return name if len(name) <= _SHOWN_LETTERS else f"{name[:_SHOWN_LETTERS]}..."


def parse_name(name: str) -> ColumnName:
    """Return what a name says of its column.

    Examples
    --------
    >>> parse_name("X (Northing)").role, parse_name("Elev (ft NAVD88)").unit
    ('northing', 'ft')
    >>> parse_name("Z (sdev)").doubt, parse_name("-Z").doubt
    ('sdev', '-')
    """
    is_name = len(name) <= _LONGEST_NAME and _NO_NAME.match(name) is None
    return _parse(name) if is_name else ColumnName()


@lru_cache(maxsize=2048)  # the same cells are asked for every layout
def _parse(name: str) -> ColumnName:
    text = _NUMBER_SIGN.sub(" no ", name).strip()
    found = _Found()
    for number, words in enumerate(_divide(text)):
        n_unknown, n_units = len(found.unknown), len(found.units)
        _read_part(words, text, found, is_bracket=number > 0)
        if number and len(found.unknown) > n_unknown:
            del found.units[n_units:]  # (error in m)
    role, word, doubt = _settle_role(found.roles)
    unit = found.units[0][1] if found.units else ""
    doubt = next(iter(found.unknown), "") or doubt or _find_clash(found, role)
    if found.has_degrees and role is not None and role.kind in ("letter", "axis", "word"):
        role = role._replace(kind="angle")
    if role is None:
        return ColumnName(unit=unit, doubt=doubt)
    system = " ".join(found.systems)
    return ColumnName(role.role, role.kind, system, unit, doubt, word, role.rank)


def find_languages(name: str) -> frozenset[str]:
    """Return the languages that a name may be in; none if English or all of them have its words.

    Examples
    --------
    >>> sorted(find_languages("Wysokość")), sorted(find_languages("X"))
    (['Polish'], [])
    """
    found: frozenset[str] = frozenset()
    for words in _divide(_NUMBER_SIGN.sub(" no ", name)):
        place = 0
        for count, _ in _divide_phrases(words):
            spoken = list_languages("".join(word.plain for word in words[place : place + count]))
            found = (found & spoken or found) if found and spoken else found | spoken
            place += count
    return found


def is_label(word: str) -> bool:
    """Whether a word stands before names and is none itself: "order:", "columns"."""
    bare = word.strip()
    is_marked = bare.endswith((":", "=")) and not read_words(bare).roles
    is_marked |= not any(sign.isalnum() or sign in "#№" for sign in bare)
    return is_marked or simplify(bare.rstrip(":=")) in _LABELS


def is_phrase(name: str) -> bool:
    """Whether the words of a name are known as one: "Point No."."""
    found = _divide(_NUMBER_SIGN.sub(" no ", name))
    return len(found) == 1 and [count for count, _ in _divide_phrases(found[0])] == [len(found[0])]


class Words(NamedTuple):
    """What the words of a line of text say."""

    roles: tuple[tuple[str, Sense], ...]
    """Words that name what a column may be."""
    units: tuple[str, ...]
    """Units of length, as they are written."""
    unknown: tuple[str, ...]
    has_datum: bool
    """Whether a height system is named: NAVD88."""


def read_words(text: str) -> Words:
    """Return what the words of a line of text say.

    Examples
    --------
    >>> read_words("elevations in US survey feet").units
    ('US survey feet',)
    """
    text = _NUMBER_SIGN.sub(" no ", text).translate(_NO_BRACKETS)
    found = _Found()
    _read_part(_divide(text)[0], text, found, is_bracket=True)
    units = tuple(shown for _, shown in found.units)
    return Words(tuple(found.roles), units, tuple(found.unknown), found.has_datum)


def _divide(text: str) -> list[list[_Word]]:
    """Return the words outside brackets, and those of each bracket."""
    outside: list[_Word] = []
    parts, current = [outside], outside
    for found in _WORD.finditer(text):
        sign = found[0]
        if sign in _OPENING:
            current = []
            parts.append(current)
        elif sign in _CLOSING:
            current = outside
        elif sign not in _SEPARATORS or _is_sign(sign, current, text[found.end() :]):
            current.extend(_divide_capitals(found))
    return parts


def _is_sign(sign: str, before: Sequence[_Word], behind: str) -> bool:
    """Whether a dash is a minus: one that parts no words."""
    return sign == "-" and (not before or not behind.strip() or behind[0] in _CLOSING)


def _divide_capitals(found: re.Match[str]) -> Iterator[_Word]:
    start = found.start()
    for word in _JOINED_WORDS.split(found[0]):
        yield _Word(simplify(word), start, start + len(word))
        start += len(word)


def _read_part(words: list[_Word], text: str, found: _Found, *, is_bracket: bool) -> None:
    """Read the words of a part, the longest phrase that is known at a time."""
    place = 0
    for count, senses in _divide_phrases(words):
        phrase = "".join(word.plain for word in words[place : place + count])
        shown = text[words[place].start : words[place + count - 1].end]
        is_first = place == 0 and not is_bracket
        if not senses or (is_first and senses[0].what in ("unit", "degree")):
            found.unknown.append(shown)
            senses = []
        for sense in senses:
            if sense.what == "role":
                found.roles.append((phrase, sense))
            elif sense.what == "unit":
                found.units.append((phrase, _end_short_form(shown, words[place + count - 1], text)))
            elif sense.what == "system":
                found.systems.append(sense.role)
            found.has_degrees |= sense.what == "degree"
            found.has_datum |= sense.what == "datum"
        place += count


def _end_short_form(shown: str, last: _Word, text: str) -> str:
    """Return a unit with the point behind it: "ft."."""
    return f"{shown}." if text[last.end : last.end + 1] == "." else shown


def _divide_phrases(words: Sequence[_Word]) -> list[tuple[int, list[Sense]]]:
    """Return the numbers of words of the phrases that leave the fewest unknown, and their senses.

    Of "E_L93" the phrases are E and L93, not EL and 93.
    """
    best: list[tuple[int, int, list[tuple[int, list[Sense]]]]] = [(0, 0, [])]
    for start in range(len(words) - 1, -1, -1):
        found = []
        for count in range(min(_LONGEST_PHRASE, len(words) - start), 0, -1):
            senses = find_sense("".join(word.plain for word in words[start : start + count]))
            if count == 1 or len(senses) == 1:  # two are an axis and a word, which stand alone
                n_unknown, n_phrases, rest = best[-count]
                score = (n_unknown + (not senses), n_phrases + 1)
                found.append((*score, [(count, senses), *rest]))
        best.append(min(found, key=lambda one: one[:2]))
    return best[-1][2]


def _settle_role(found: Sequence[tuple[str, Sense]]) -> tuple[Sense | None, str, str]:
    """Return the role that the words for roles agree on, its word, and what contradicts it."""
    named = [(word, one) for word, one in found if one.role in _COORDINATES]
    others = [(word, one) for word, one in found if one.role not in _COORDINATES]
    if not named:
        roles = {one.role for _, one in others if one.role != "number"} or {"number"}
        if not others or len(roles) > 1:
            return None, "", ""
        return next((one, word, "") for word, one in others if one.role in roles)
    # "X (Northing)": the word says which way the axis points.
    plain = [(word, one) for word, one in named if one.kind not in ("axis", "letter")]
    plain = plain or [(word, one) for word, one in named if one.kind != "axis"] or named
    role = min(plain, key=lambda pair: pair[1].kind != "sure")[1]
    wrong = [w for w, one in others if w not in CONTEXT] + [
        w for w, one in named if not _agree(one, role)
    ]
    if len(named) > 1 and any(w in _ALONE for w, _ in named):
        wrong.append(next(w for w, _ in named if w in _ALONE))
    return role, " ".join(w for w, _ in named), next(iter(wrong), "")


def _agree(one: Sense, role: Sense) -> bool:
    """Whether a word may stand beside the one that settles the role."""
    if one.kind == "axis" and role.kind != "axis":
        return (one.role == "elevation") == (role.role == "elevation")
    return one.role == role.role and {one.kind, role.kind} != {"word", "angle"}


def _find_clash(found: _Found, role: Sense | None) -> str:
    """Return what contradicts the role or something else of the name; "" if nothing does."""
    if role is None:
        return ""
    is_elevation, is_angle = role.role == "elevation", role.kind == "angle"
    other = next((shown for phrase, shown in found.units if phrase != found.units[0][0]), "")
    if other:
        return other
    if found.units and (is_angle or found.has_degrees):
        return found.units[0][1]
    if found.has_degrees and is_elevation:
        return "degrees"
    return ""
