"""Which column means what: by its name in the header, by the caller's word, or by its content."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import lru_cache
from typing import TYPE_CHECKING

from ..._sentences import counted
from ...errors import OptionError, ReadError

if TYPE_CHECKING:
    from collections.abc import Iterable

__all__ = [
    "COORDINATES",
    "Columns",
    "find_columns_by_header",
    "find_columns_by_word",
    "find_role",
    "find_unit_word",
    "list_meanings",
    "list_names",
    "name_columns",
]

COORDINATES = ("easting", "northing", "elevation")
_ROLES = (*COORDINATES, "number", "description")
_LETTERS = {
    "P": "number",
    "N": "northing",
    "E": "easting",
    "Z": "elevation",
    "H": "elevation",
    "D": "description",
    "X": "easting",
    "Y": "northing",
    "-": "",
}
_NAMES = {
    "easting": (
        *("easting", "east", "e", "eastings", "xcoordinate", "xcoord", "coordx", "xutm", "utmx"),
        *("utme", "pointx", "xcenter", "x", "rechtswert", "ostwert", "ost", "rw", "este", "est"),
        *("coordenadax", "gridx", "gride", "grideasting"),
        *("rechts", "abscisse"),
    ),
    "northing": (
        *("northing", "north", "n", "northings", "ycoordinate", "ycoord", "coordy", "yutm", "utmy"),
        *("utmn", "pointy", "ycenter", "y", "hochwert", "nordwert", "nord", "hw", "norte"),
        *("coordenaday", "gridy", "gridn", "gridnorthing"),
        *("hoch", "ordonnee"),
    ),
    "elevation": (
        *("elevation", "elev", "el", "z", "zcoordinate", "zcoord", "coordz", "pointz", "height"),
        *("rl", "reducedlevel", "level", "h", "hoehe", "hohe", "altitude", "alt", "cota", "quota"),
        *("altura", "elevacion", "kote", "hoyde", "orthometricheight", "orthoheight", "zvalue"),
        *("altitud", "elevacao", "hojd", "hoogte", "nhn"),
    ),
    "number": (
        *("point", "pt", "pointnumber", "pointno", "pointnum", "pointid", "pointname", "ptno"),
        *("ptnum", "ptnumber", "ptid", "ptname", "pnt", "pno", "p", "no", "nr", "num", "number"),
        *("id", "name", "punkt", "punktnummer", "punktnr", "pktnr", "punto", "fid", "objectid"),
        *("pkt", "ponto", "matricule", "numero"),
        "#",
    ),
    "description": (
        *("description", "desc", "descr", "code", "featurecode", "fieldcode", "rawdescription"),
        *("fulldescription", "d", "bemerkung", "beschreibung", "descripcion", "codigo", "remark"),
        *("remarks", "comment", "note", "notes", "feature", "label", "type"),
        *("libelle", "descricao", "descrizione", "codice"),
    ),
}
_DEGREES = {
    "easting": ("longitude", "long", "lon", "lng", "longitud", "lange", "laenge"),
    "northing": ("latitude", "lat", "latitud", "breite"),
}
_UNIT_NAMES = (
    *("m", "metre", "metres", "meter", "meters", "mm", "cm", "dm", "km", "ft", "foot", "feet"),
    *("usft", "us ft", "us-ft", "ussft", "ftus", "ft us", "ft-us", "us foot", "us feet", "sft"),
    *("us survey foot", "us survey feet", "survey foot", "survey feet", "usfoot", "usfeet"),
    *("us survey ft", "survey ft", "us-survey-foot", "us-survey-feet"),
    *("ift", "intft", "int ft", "international foot", "international feet", "ftint"),
    *("yd", "yard", "yards", "fathom", "fathoms"),
)
_UNIT_WORDS = "|".join(sorted(_UNIT_NAMES, key=len, reverse=True)).replace(" ", r"[\s._]+")
# The brackets inside keep the pattern linear: a text of nothing but brackets is tried once.
_UNIT = re.compile(
    r"[\[(](?P<inside>[^\[\]()]*)[\])]"
    rf"|(?<=[^\W_])[\W_]+(?P<behind>{_UNIT_WORDS})$",
    re.IGNORECASE,
)
_NUMBER_SIGN = re.compile(r"n\s?[°º#]", re.IGNORECASE)
_PLAIN_LETTERS = str.maketrans({"ø": "o", "æ": "ae", "ł": "l", "đ": "d", "œ": "oe"})
_ACCENTS = re.compile("[\u0300-\u036f]")
_SHOWN_LETTERS, _SHOWN_NAMES = 40, 12
_LONGEST_NAME = 200
"""Letters of a header cell that may be a name; a longer one is some other text."""
_ROLE_LETTERS = {
    "number": "P",
    "northing": "N",
    "easting": "E",
    "elevation": "Z",
    "description": "D",
}


@dataclass(frozen=True, slots=True)
class Columns:
    """What the columns of a table mean."""

    names: tuple[str, ...]
    """One a column, for attributes and sentences."""
    roles: Mapping[str, int]
    """Column number (from 0) of each role found: ``"easting"``, ``"northing"``, ``"elevation"``,
    ``"number"``, ``"description"``.
    """
    is_degrees: bool = False
    """Whether easting and northing are called longitude and latitude."""
    units: Mapping[str, str] = field(default_factory=dict)
    """Words that the header uses for the units of coordinates, by role; ``{}`` if none."""
    notes: tuple[str, ...] = ()
    """What was assumed to understand the header, in sentences."""

    @property
    def coordinates(self) -> list[int]:
        """Column numbers of easting, northing and elevation."""
        return [self.roles[role] for role in COORDINATES]

    def label(self, column: int) -> str:
        """Name a column for a sentence."""
        name = self.names[column]
        place = f"column {column + 1}"
        return place if name in ("", place) else f"{place} ('{shorten(name)}')"

    def permute(self, order: Sequence[int]) -> Columns:
        """Return the same with the columns of the coordinates exchanged.

        Parameters
        ----------
        order : sequence of 3 int
            ``[1, 0, 2]`` takes the northing for the easting and the easting for the northing.
        """
        moved = {role: self.coordinates[k] for role, k in zip(COORDINATES, order, strict=True)}
        return replace(self, roles={**self.roles, **moved})

    @property
    def word(self) -> str:
        """The letters that say the same as the option columns: "PNEZD"."""
        meaning = {column: role for role, column in self.roles.items()}
        letters = [_ROLE_LETTERS.get(meaning.get(i, ""), "-") for i in range(len(self.names))]
        return "".join(letters).rstrip("-")

    @property
    def layout(self) -> str:
        """The meaning of the columns in order, in words."""
        meaning = {column: role for role, column in self.roles.items()}
        return list_names([meaning.get(i, self.names[i]) for i in range(len(self.names))])


def shorten(name: str) -> str:
    """Cut a name that no sentence should hold whole."""
    return name if len(name) <= _SHOWN_LETTERS else f"{name[:_SHOWN_LETTERS]}..."


def list_names(names: Sequence[str]) -> str:
    """List the first names of a table for a sentence."""
    shown = ", ".join(shorten(name) for name in names[:_SHOWN_NAMES])
    return f"{shown}, ..." if len(names) > _SHOWN_NAMES else shown


def name_columns(names: Sequence[str], count: int) -> tuple[str, ...]:
    """Return ``count`` names, those that are missing or empty as "column 4", none twice."""
    unique: list[str] = []
    for i in range(count):
        name = names[i].strip() if i < len(names) else ""
        name = name or f"column {i + 1}"
        repeats = sum(other == name or other.startswith(f"{name} (") for other in unique)
        unique.append(f"{name} ({repeats + 1})" if repeats else name)
    return tuple(unique)


def find_role(name: str) -> str | None:
    """Return what a column of this name means, None if the name says nothing.

    Examples
    --------
    >>> find_role("Easting [m]"), find_role("Höhe"), find_role("intensity")
    ('easting', 'elevation', None)
    """
    rank = _rank(name)
    return rank[0] if rank else None


def _rank(name: str) -> tuple[str, bool, int] | None:
    """Return role, whether in degrees, and how far down the list of synonyms a name stands."""
    return _rank_of(name) if len(name) <= _LONGEST_NAME else None


@lru_cache(maxsize=1024)  # the same cells are asked for every layout
def _rank_of(name: str) -> tuple[str, bool, int] | None:
    plain = _simplify_name(name)
    for in_degrees, synonyms in ((False, _NAMES), (True, _DEGREES)):
        for role, known in synonyms.items():
            if plain in known:
                return role, in_degrees, known.index(plain)
    return None


def _simplify_name(name: str) -> str:
    """Strip unit, accents, case and punctuation of a name."""
    bare = _UNIT.sub("", name.strip())
    if bare.strip() == "#":
        return "#"
    if _NUMBER_SIGN.fullmatch(bare.strip()):
        return "no"
    letters = unicodedata.normalize("NFKD", bare).casefold().translate(_PLAIN_LETTERS)
    return re.sub(r"[\W_]", "", _ACCENTS.sub("", letters))


def find_unit_word(name: str) -> str | None:
    """Return the unit of length that a header cell names, as it is written; None if none.

    Examples
    --------
    >>> find_unit_word("Elevation (USft)"), find_unit_word("elev_ft")
    ('USft', 'ft')
    >>> find_unit_word("Height (NAVD88)") is None
    True
    """
    if len(name) > _LONGEST_NAME:
        return None
    for found in _UNIT.finditer(name.strip()):
        word = (found["inside"] or found["behind"] or "").strip()
        if " ".join(re.split(r"[\s._]+", word.casefold())).strip() in _UNIT_NAMES:
            return word
    return None


def find_columns_by_header(
    header: Sequence[str], units: Sequence[str] = (), *, strict: bool = True
) -> Columns | None:
    """Find the columns by the names in the header; None if a coordinate is not among them.

    Parameters
    ----------
    header : sequence of str
    units : sequence of str, optional
        Cells of the line of units below the header.
    strict : bool, optional
        Whether two equal names for a coordinate are refused.

    Raises
    ------
    ReadError
        If (``strict``) two columns have the same name for a coordinate.
    """
    found = _group_by_role(header)
    pair, in_degrees, notes = _choose_pair(header, found)
    roles = {role: columns[0] for role, columns in found.items() if role in _ROLES}
    roles |= pair
    if not set(COORDINATES) <= roles.keys():
        return None
    _give_number(header, roles)
    for role in COORDINATES if strict else ():
        same = [
            name for name in header if _simplify_name(name) == _simplify_name(header[roles[role]])
        ]
        if len(same) > 1:
            raise ReadError(
                f"the header has {len(same)} columns named '{shorten(same[0])}' for the {role}: "
                "say with the option columns which is meant."
            )
    if strict:
        _require_one_pair(header, found, roles)
    notes += _note_other_elevations(header, found["elevation"])
    named = _find_unit_words(header, units, roles)
    notes += _note_other_unit(header[roles["elevation"]], named.get("elevation"))
    return Columns(name_columns(header, len(header)), roles, in_degrees, named, tuple(notes))


def _find_unit_words(
    header: Sequence[str], units: Sequence[str], roles: Mapping[str, int]
) -> dict[str, str]:
    """Return the words for the units of the coordinates, in the header or the line below it."""
    found: dict[str, str] = {}
    for role in COORDINATES:
        column = roles[role]
        name = header[column] if column < len(header) else ""
        below = units[column].strip(" ()[]") if column < len(units) else ""
        word = find_unit_word(name) or find_unit_word(f"({below})")
        if word is not None:
            found[role] = word
    return found


def _group_by_role(header: Sequence[str]) -> dict[str, list[int]]:
    """Return the columns of each role, those first whose names say most clearly what they are."""
    ranked: dict[str, list[tuple[int, int]]] = {}
    for column, name in enumerate(header):
        rank = _rank(name)
        if rank is not None:
            role = rank[0] if not rank[1] else {"easting": "lon", "northing": "lat"}[rank[0]]
            ranked.setdefault(role, []).append((rank[2], column))
    return {role: [column for _, column in sorted(pairs)] for role, pairs in ranked.items()}


def _is_xy(name: str) -> bool:
    """Whether a name of an easting or northing is one with X or Y."""
    return any(letter in _simplify_name(name) for letter in "xy")


def _is_letter(name: str) -> bool:
    """Whether a name is a single letter: N beside Este and Norte is the number of the point."""
    return len(_simplify_name(name)) == 1


def _choose_pair(
    header: Sequence[str], found: Mapping[str, Sequence[int]]
) -> tuple[dict[str, int], bool, list[str]]:
    """Return the columns of easting and northing, whether in degrees, and what was assumed.

    Names of one kind belong together: of N, X and Y the first is a number and no northing, and of
    N, Este and Norte likewise.
    """
    eastings, northings = found.get("easting", []), found.get("northing", [])
    pairs = [(e, n) for e in eastings for n in northings if _is_xy(header[e]) == _is_xy(header[n])]
    pairs = pairs or [
        (e, n) for e in eastings for n in northings if _simplify_name(header[n]) != "n"
    ]
    pairs.sort(key=lambda pair: _is_letter(header[pair[0]]) != _is_letter(header[pair[1]]))
    if not pairs:
        if not found.keys() >= {"lon", "lat"}:
            return {}, False, []
        return {"easting": found["lon"][0], "northing": found["lat"][0]}, True, []
    chosen = min(pairs, key=lambda pair: _is_xy(header[pair[0]]))
    names = [f"'{shorten(name)}'" for name in header]
    notes = [
        f"The header names two pairs of coordinates: {names[chosen[0]]} and {names[chosen[1]]} "
        f"are taken, {names[e]} and {names[n]} are not."
        for e, n in pairs
        if e != chosen[0] and n != chosen[1]
    ][:1]
    if _is_xy(header[chosen[0]]) and chosen[1] < chosen[0]:
        notes.append(
            f"By the header {names[chosen[0]]} is the easting and {names[chosen[1]]} the "
            "northing; where X points north it is the other way round."
        )
    return {"easting": chosen[0], "northing": chosen[1]}, False, notes


def _give_number(header: Sequence[str], roles: dict[str, int]) -> None:
    """Take a column N beside X and Y for the number of the point."""
    column = next((i for i, name in enumerate(header) if _simplify_name(name) == "n"), None)
    if column is not None and column != roles["northing"] and "number" not in roles:
        roles["number"] = column


def _require_one_pair(
    header: Sequence[str], found: Mapping[str, Sequence[int]], roles: Mapping[str, int]
) -> None:
    """Refuse a northing that stands alone beside the pair N and E, or an easting: N, E, Northing.

    Raises
    ------
    ReadError
    """
    if not _is_letter(header[roles["easting"]]) or _is_xy(header[roles["easting"]]):
        return
    words = {
        role: [i for i in found[role] if not _is_letter(header[i]) and not _is_xy(header[i])]
        for role in ("easting", "northing")
    }
    for role in words:
        if words[role] and not all(words.values()):
            names = list_names([f"'{header[i]}'" for i in (roles[role], words[role][0])])
            raise ReadError(
                f"the header has several columns for the {role} ({names}): say with the option "
                "columns which is meant."
            )


def _note_other_unit(name: str, word: str | None) -> list[str]:
    """Say that what stands in brackets behind the elevation is no unit that is known."""
    found = None if word else _UNIT.search(name.strip())
    inside = (found["inside"] or "").strip() if found else ""
    if not inside or any(letter.isdecimal() for letter in inside):  # NAVD88 is no unit
        return []
    return [
        f"The header's '{shorten(name.strip())}' tells no unit that is known: the option z_unit "
        "says that of the elevations."
    ]


def _note_other_elevations(header: Sequence[str], columns: Sequence[int]) -> list[str]:
    if len({_simplify_name(header[column]) for column in columns}) < 2:
        return []
    others = ", ".join(f"'{shorten(header[column])}'" for column in columns[1:])
    return [
        f"The header's '{shorten(header[columns[0]])}' is taken as the elevation, not {others}."
    ]


def find_columns_by_word(
    word: str | Sequence[str] | Mapping[str, str | int],
    header: Sequence[str],
    count: int,
    units: Sequence[str] = (),
) -> Columns:
    """Find the columns by the caller's word.

    Parameters
    ----------
    word : str, sequence of str, or mapping of str to str or int
        Letters ("PNEZD"), names in the order of the columns, or role to name or number (from 1).
    header : sequence of str
        Names in the file; empty if there are none.
    count : int
        Number of columns of the file.
    units : sequence of str, optional
        Cells of the line of units below the header.

    Raises
    ------
    OptionError
        If the word names no such column, a role twice, or not all three coordinates.
    """
    if isinstance(word, Mapping):
        roles = {
            _require_role(role): _find_column(which, header, count) for role, which in word.items()
        }
        _require_coordinates(roles, word)
        _require_distinct(roles, word)
        names = name_columns(header, count)
        notes = _describe_contradictions(header, roles)
        in_degrees = _are_degrees(names, roles)
        return Columns(names, roles, in_degrees, _find_unit_words(header, units, roles), notes)
    given = list_meanings(word)
    named = [meaning for meaning in given if meaning in _ROLES]
    twice = next((one for one in named if named.count(one) > 1), None)
    if twice:
        raise OptionError("columns", word, f"a layout that does not name the {twice} twice")
    roles = _require_coordinates({one: i for i, one in enumerate(given) if one in _ROLES}, word)
    if len(given) > count:
        there, named_there = counted(count, "column"), counted(len(given), "column")
        allowed = f"a layout of the {there} of the file, not of {named_there}"
        raise OptionError("columns", word, allowed)
    names = tuple(_choose_name(given, header, i) for i in range(count))
    notes = _describe_contradictions(header, roles)
    in_degrees = _are_degrees(names, roles) or _are_degrees(_list_given_names(word), roles)
    return Columns(
        name_columns(names, count), roles, in_degrees, _find_unit_words(names, units, roles), notes
    )


def _are_degrees(names: Sequence[str], roles: Mapping[str, int]) -> bool:
    """Whether easting and northing are called longitude and latitude."""
    columns = [roles["easting"], roles["northing"]]
    ranks = [_rank(names[column]) if column < len(names) else None for column in columns]
    return all(rank is not None and rank[1] for rank in ranks)


def _require_distinct(roles: Mapping[str, int], word: object) -> None:
    for role, column in roles.items():
        same = [other for other, one in roles.items() if one == column and other != role]
        if same:
            allowed = (
                f"a layout that takes no column twice: column {column + 1} is {role} and {same[0]}"
            )
            raise OptionError("columns", word, allowed)


def _describe_contradictions(header: Sequence[str], roles: Mapping[str, int]) -> tuple[str, ...]:
    """Say where the caller takes a column for another coordinate than its name says."""
    wrong = [
        f"'{shorten(header[column])}' as the {role}"
        for role, column in roles.items()
        if column < len(header) and find_role(header[column]) in set(_ROLES) - {role}
    ]
    return (f"The option columns takes {_join_words(wrong)}, against the header.",) if wrong else ()


def _choose_name(given: Sequence[str], header: Sequence[str], column: int) -> str:
    """Prefer the name in the file, then the caller's."""
    if column < len(header):
        return header[column]
    return given[column] if column < len(given) else ""


def list_meanings(word: str | Sequence[str]) -> list[str]:
    """Return the role, or else the name, that letters or names give each column."""
    if isinstance(word, str) and _is_letters(word):
        return [_LETTERS[letter] for letter in word.upper()]
    return [find_role(name) or name.strip() for name in _list_given_names(word)]


def _is_letters(word: str) -> bool:
    return "," not in word and all(letter in _LETTERS for letter in word.upper())


def _list_given_names(word: str | Sequence[str]) -> list[str]:
    """Return the names in the order of the columns; letters are none."""
    if isinstance(word, str):
        return [] if _is_letters(word) else word.split(",")
    return list(word)


def _require_role(role: str) -> str:
    known = role if role in _ROLES else find_role(role)
    if known is None:
        raise OptionError("columns", role, _ROLES)
    return known


def _find_column(which: str | int, header: Sequence[str], count: int) -> int:
    if isinstance(which, int):
        if not 1 <= which <= count:
            raise OptionError("columns", which, f"a column from 1 to {count}")
        return which - 1
    found = [i for i, name in enumerate(header) if name.strip().casefold() == which.casefold()]
    if len(found) == 1:
        return found[0]
    there = f"the header has {list_names(header)}" if header else "the file has no header"
    number = "no" if not found else f"{len(found)}"
    allowed = f"the name of one column, and {number} columns have it: {there}"
    raise OptionError("columns", which, allowed)


def _require_coordinates(roles: dict[str, int], word: object) -> dict[str, int]:
    missing = [role for role in COORDINATES if role not in roles]
    if missing:
        raise OptionError(
            "columns",
            word,
            "letters (P number, N northing, E easting, Z elevation, D description, X easting, "
            f"Y northing, - other) or names that say which column is the {_join_words(missing)}",
        )
    return roles


def _join_words(words: Iterable[str]) -> str:
    *first, last = words
    return f"{', '.join(first)} and {last}" if first else last
