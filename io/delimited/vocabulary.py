"""The words of headers: which name a coordinate, and which change nothing of its meaning.

A word that is in none of these tables is not known to be harmless, and a column whose name has one
is not taken as a coordinate. Words are written as :func:`simplify` returns them; phrases of several
words are joined ("ussurveyfoot").
"""

from __future__ import annotations

import csv
import re
import unicodedata
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Literal, NamedTuple, cast

if TYPE_CHECKING:
    from collections.abc import Iterator

Kind = Literal["word", "letter", "axis", "angle", "sure", "open", ""]
"""How a word names its role.

``"word"`` easting, ``"letter"`` E, ``"axis"`` X, Y, Z, which point elsewhere in some countries;
``"angle"`` longitude; ``"sure"`` an elevation and nothing else, ``"open"`` a height of some kind.
"""


class Sense(NamedTuple):
    """What a word or phrase says of a column."""

    what: Literal["role", "unit", "degree", "datum", "system", "noun"]
    role: str = ""
    """What a word for a role names; the name of a system."""
    kind: Kind = ""
    rank: int = 0
    """Of words for one role the first say it most clearly."""


_SENSES: dict[str, Sense] = {
    "easting": Sense("role", "easting", "word"),
    "northing": Sense("role", "northing", "word"),
    "elevation": Sense("role", "elevation", "sure"),
    "height": Sense("role", "elevation", "open"),
    "longitude": Sense("role", "easting", "angle"),
    "latitude": Sense("role", "northing", "angle"),
    "number": Sense("role", "number"),
    "description": Sense("role", "description"),
    "coordinate": Sense("noun"),
}
"""What the phrases say that a column of ``languages.tsv`` lists, parted by commas: "height" is for
words of a height of some kind, "coordinate" for those that say nothing more beside another."""

_OF_PLANE = ("utm", "grid")

_ZONE = "(fuso|huso|uso|fuseau|zone|zona|zon|strefa|pas)?[0-9]{0,3}(tm)?[nse]?"
_PLAIN_LETTERS = str.maketrans(
    {"ø": "o", "æ": "ae", "ł": "l", "đ": "d", "œ": "oe", "ı": "i", "ð": "d", "þ": "th"}
)
_SINGLE_LETTERS = {"ø": "ø", "ö": "ø"}
"""Short for "øst" and "öst", where O is short for "oeste"."""
_LOOK_ALIKES = str.maketrans("ΧΥΖΕΝΗχυζХУЕНЗхун", "XYZENHxyzXYEHZxyh")
"""Greek and Cyrillic letters that stand alone for the Latin letters of coordinates."""
_WORDS = re.compile(r"[^\s/'№]+|№")
_ACCENTS = re.compile("[\u0300-\u036f]")


def simplify(word: str) -> str:
    """Return a word without case and accents."""
    if len(word) == 1:
        word = word.translate(_LOOK_ALIKES)
        if word.casefold() in _SINGLE_LETTERS:
            return _SINGLE_LETTERS[word.casefold()]
    letters = unicodedata.normalize("NFKD", word).casefold().translate(_PLAIN_LETTERS)
    return _ACCENTS.sub("", letters)


@cache
def read_table() -> dict[tuple[str, str, Kind], tuple[str, ...]]:
    """Return the words of ``words.tsv``, in English but for some, by what they say of a column."""
    text = Path(__file__).with_name("words.tsv").read_text("utf-8")
    rows = (line.split("\t") for line in text.splitlines()[1:])
    return {
        (what, role, cast("Kind", kind)): tuple(words.split()) for what, role, kind, words in rows
    }


def list_words(what: str) -> frozenset[str]:
    """Return the words of ``words.tsv`` that say one thing."""
    return frozenset(read_table()[what, "", ""])


CONTEXT = list_words("point")
"""Words for a point, which beside that for a coordinate say nothing: POINT_X."""


@cache
def read_languages() -> dict[str, dict[str, str]]:
    """Return the words of ``languages.tsv`` by language and column.

    ``x_is_north`` is not empty where X is the northing on the plans of the countries that speak it.
    """
    text = Path(__file__).with_name("languages.tsv").read_text("utf-8")
    return {row.pop("language"): row for row in csv.DictReader(text.splitlines(), delimiter="\t")}


@cache
def _make_vocabulary() -> dict[str, Sense]:
    table = read_table()
    words = {
        word: Sense("role", role, kind, rank)
        for (what, role, kind), named in table.items()
        for rank, word in enumerate(named)
        if what == "role"
    }
    for sense in (Sense("unit"), Sense("degree"), Sense("noun")):
        words |= {simplify(word): sense for word in table[sense.what, "", ""]}
    for language in read_languages().values():
        for column, sense in _SENSES.items():
            for rank, phrase in enumerate(_list_phrases(language[column])):
                words.setdefault(phrase, sense._replace(rank=rank))
    return words


@cache
def _make_languages() -> dict[str, frozenset[str]]:
    english = {
        word for key, words in read_table().items() if key[0] in ("role", "noun") for word in words
    }
    found: dict[str, set[str]] = {}
    for name, language in read_languages().items():
        for column in _SENSES:
            for phrase in _list_phrases(language[column]):
                found.setdefault(phrase, set()).add(name)
    return {word: frozenset(names) for word, names in found.items() if word not in english}


def list_languages(phrase: str) -> frozenset[str]:
    """Return the languages that have a phrase, none if English has it; affixes apart.

    Examples
    --------
    >>> sorted(list_languages("wysokosc"))
    ['Polish']
    """
    known = _make_languages()
    if phrase in known:
        return known[phrase]
    for affix in _simplify_affixes():
        if phrase.endswith(affix) and affix in known:
            return known[affix]
    return frozenset()


def _list_phrases(text: str) -> Iterator[str]:
    """Return the phrases of a text as names are compared: their words joined."""
    for phrase in text.split(",") if text else ():
        yield "".join(simplify(word) for word in _WORDS.findall(phrase))


@cache
def _simplify_affixes() -> tuple[str, ...]:
    return tuple(map(simplify, read_table()["affix", "", ""]))


@cache
def _compile_patterns() -> tuple[re.Pattern[str], re.Pattern[str]]:
    """Return the patterns of datums and of systems."""
    datum, zoned, system = (
        "|".join(read_table()[f"{what} pattern", "", ""])
        for what in ("datum", "zoned system", "system")
    )
    return re.compile(datum), re.compile(f"({zoned}){_ZONE}|{system}")


def find_sense(phrase: str) -> list[Sense]:
    """Return what a phrase says; [] if it is not known.

    Examples
    --------
    >>> find_sense("hochwert")[0].role, find_sense("m")[0].what
    ('northing', 'unit')
    >>> [sense.what for sense in find_sense("utmx")], find_sense("sdev")
    (['system', 'role'], [])
    """
    known = _make_vocabulary().get(phrase)
    if known is not None:
        return [known]
    datum, system = _compile_patterns()
    if datum.fullmatch(phrase):
        return [Sense("datum")]
    if system.fullmatch(phrase):
        return [Sense("system", phrase)]
    for affix in _simplify_affixes():
        is_behind = phrase.endswith(affix)
        rest = phrase.removesuffix(affix) if is_behind else phrase.removeprefix(affix)
        role = _make_vocabulary().get(rest)
        is_role = rest != phrase and role is not None and role.what == "role"
        if is_role and role is not None and (affix not in _OF_PLANE or role.role != "elevation"):
            return [*(one for one in find_sense(affix) if one.what != "role"), role]
    return []
