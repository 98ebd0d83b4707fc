"""Which column means what: by its name in the header, by the caller's word, or by its content."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from .errors import FormatError, ReadError

if TYPE_CHECKING:
    from collections.abc import Iterable

__all__ = ["COORDINATES", "Columns", "columns_by_header", "columns_by_word", "meanings", "role_of"]

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
    ),
    "northing": (
        *("northing", "north", "n", "northings", "ycoordinate", "ycoord", "coordy", "yutm", "utmy"),
        *("utmn", "pointy", "ycenter", "y", "hochwert", "nordwert", "nord", "hw", "norte"),
        *("coordenaday", "gridy", "gridn", "gridnorthing"),
    ),
    "elevation": (
        *("elevation", "elev", "el", "z", "zcoordinate", "zcoord", "coordz", "pointz", "height"),
        *("rl", "reducedlevel", "level", "h", "hoehe", "hohe", "altitude", "alt", "cota", "quota"),
        *("altura", "elevacion", "kote", "hoyde", "orthometricheight", "orthoheight", "zvalue"),
    ),
    "number": (
        *("point", "pt", "pointnumber", "pointno", "pointnum", "pointid", "pointname", "ptno"),
        *("ptnum", "ptnumber", "ptid", "ptname", "pnt", "pno", "p", "no", "nr", "num", "number"),
        *("id", "name", "punkt", "punktnummer", "punktnr", "pktnr", "punto", "fid", "objectid"),
        "#",
    ),
    "description": (
        *("description", "desc", "descr", "code", "featurecode", "fieldcode", "rawdescription"),
        *("fulldescription", "d", "bemerkung", "beschreibung", "descripcion", "codigo", "remark"),
        *("remarks", "comment", "note", "notes", "feature", "label", "type"),
    ),
}
_DEGREES = {
    "easting": ("longitude", "long", "lon", "lng", "longitud", "lange", "laenge"),
    "northing": ("latitude", "lat", "latitud", "breite"),
}
_UNIT = re.compile(r"[\[(][^\])]*[\])]|(?<=.)_(?:m|ft|usft|metres?|meters?|feet)$", re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class Columns:
    """What the columns of a table mean.

    Attributes
    ----------
    names : tuple of str
        One a column, for attributes and sentences.
    roles : mapping of str to int
        Column number (from 0) of each role found: ``"easting"``, ``"northing"``,
        ``"elevation"``, ``"number"``, ``"description"``.
    is_degrees : bool
        Whether easting and northing are called longitude and latitude.
    """

    names: tuple[str, ...]
    roles: Mapping[str, int]
    is_degrees: bool = False

    @property
    def coordinates(self) -> list[int]:
        """Column numbers of easting, northing and elevation."""
        return [self.roles[role] for role in COORDINATES]

    def label(self, column: int) -> str:
        """Name a column for a sentence."""
        name = self.names[column]
        place = f"column {column + 1}"
        return place if name in ("", place) else f"{place} ('{name}')"

    def swapped(self) -> Columns:
        """Return the same with easting and northing exchanged."""
        easting, northing = self.roles["easting"], self.roles["northing"]
        return replace(self, roles={**self.roles, "easting": northing, "northing": easting})

    @property
    def layout(self) -> str:
        """The meaning of the columns in order, in words."""
        meaning = {column: role for role, column in self.roles.items()}
        return ", ".join(meaning.get(i, self.names[i]) for i in range(len(self.names)))


def numbered(names: Sequence[str], count: int) -> tuple[str, ...]:
    """Return ``count`` names, those that are missing or empty as "column 4", none twice."""
    unique: list[str] = []
    for i in range(count):
        name = names[i].strip() if i < len(names) else ""
        name = name or f"column {i + 1}"
        repeats = sum(other == name or other.startswith(f"{name} (") for other in unique)
        unique.append(f"{name} ({repeats + 1})" if repeats else name)
    return tuple(unique)


def role_of(name: str) -> str | None:
    """Return what a column of this name means, None if the name says nothing.

    Examples
    --------
    >>> role_of("Easting [m]"), role_of("Höhe"), role_of("intensity")
    ('easting', 'elevation', None)
    """
    rank = _rank(name)
    return rank[0] if rank else None


def _rank(name: str) -> tuple[str, bool, int] | None:
    """Return role, whether in degrees, and how far down the list of synonyms a name stands."""
    plain = _plain(name)
    for in_degrees, synonyms in ((False, _NAMES), (True, _DEGREES)):
        for role, known in synonyms.items():
            if plain in known:
                return role, in_degrees, known.index(plain)
    return None


def _plain(name: str) -> str:
    """Strip unit, accents, case and punctuation of a name."""
    bare = _UNIT.sub("", name.strip())
    if bare.strip() == "#":
        return "#"
    letters = unicodedata.normalize("NFKD", bare.casefold())
    return re.sub(r"[^a-z0-9]", "", letters.replace("ß", "ss"))


def columns_by_header(header: Sequence[str], *, strict: bool = True) -> Columns | None:
    """Find the columns by the names in the header; None if a coordinate is not among them.

    Raises
    ------
    ReadError
        If (``strict``) two columns have the same name for a coordinate.
    """
    best = _best_by_role(header)
    in_degrees = not {"easting", "northing"} <= best.keys() and {"lon", "lat"} <= best.keys()
    if in_degrees:
        best["easting"], best["northing"] = best["lon"], best["lat"]
    roles = {role: best[role][1] for role in _ROLES if role in best}
    if not set(COORDINATES) <= roles.keys():
        return None
    for role in COORDINATES if strict else ():
        same = [name for name in header if _plain(name) == _plain(header[roles[role]])]
        if len(same) > 1:
            raise ReadError(
                f"The header has {len(same)} columns named '{same[0]}' for the {role}: "
                "say with the option columns which is meant."
            )
    return Columns(numbered(header, len(header)), roles, in_degrees)


def _best_by_role(header: Sequence[str]) -> dict[str, tuple[int, int]]:
    """Return rank and column of the name that says most clearly what each role is."""
    best: dict[str, tuple[int, int]] = {}
    for column, name in enumerate(header):
        rank = _rank(name)
        if rank is None:
            continue
        role = rank[0] if not rank[1] else {"easting": "lon", "northing": "lat"}[rank[0]]
        candidate = (rank[2], column)
        best[role] = min(best.get(role, candidate), candidate)
    return best


def columns_by_word(
    word: str | Sequence[str] | Mapping[str, str | int], header: Sequence[str], count: int
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

    Raises
    ------
    FormatError
        If the word names no such column, a role twice, or not all three coordinates.
    """
    if isinstance(word, Mapping):
        roles = {_checked_role(role): _column(which, header, count) for role, which in word.items()}
        return Columns(numbered(header, count), _complete(roles, word))
    given = meanings(word)
    named = [meaning for meaning in given if meaning in _ROLES]
    twice = next((one for one in named if named.count(one) > 1), None)
    if twice:
        raise FormatError(f"The option columns ({word}) names the {twice} twice.")
    roles = _complete({one: i for i, one in enumerate(given) if one in _ROLES}, word)
    if len(given) > count:
        raise FormatError(
            f"The option columns names {len(given)} columns ({word}), but the file has {count}."
        )
    names = [_own_name(given, header, i) for i in range(count)]
    return Columns(numbered(names, count), roles)


def _own_name(given: Sequence[str], header: Sequence[str], column: int) -> str:
    """Prefer the name in the file, then the caller's."""
    if column < len(header):
        return header[column]
    return given[column] if column < len(given) else ""


def meanings(word: str | Sequence[str]) -> list[str]:
    """Return the role, or else the name, that letters or names give each column."""
    if isinstance(word, str):
        if "," not in word and all(letter in _LETTERS for letter in word.upper()):
            return [_LETTERS[letter] for letter in word.upper()]
        word = word.split(",")
    return [role_of(name) or name.strip() for name in word]


def _checked_role(role: str) -> str:
    known = role if role in _ROLES else role_of(role)
    if known is None:
        raise FormatError(
            f"The option columns names '{role}': one of {', '.join(_ROLES)} is needed.",
            known=_ROLES,
        )
    return known


def _column(which: str | int, header: Sequence[str], count: int) -> int:
    if isinstance(which, int):
        if not 1 <= which <= count:
            raise FormatError(f"The option columns names column {which}: 1 to {count} are there.")
        return which - 1
    found = [i for i, name in enumerate(header) if name.strip().casefold() == which.casefold()]
    if len(found) == 1:
        return found[0]
    there = f"the header has {', '.join(header)}" if header else "the file has no header"
    number = "no" if not found else f"{len(found)}"
    raise FormatError(
        f"The option columns names '{which}', of which there are {number} columns: {there}.",
        known=header,
    )


def _complete(roles: dict[str, int], word: object) -> dict[str, int]:
    missing = [role for role in COORDINATES if role not in roles]
    if missing:
        raise FormatError(
            f"The option columns ({word}) does not say which column is the {_listed(missing)}: "
            "it may be letters (P number, N northing, E easting, Z elevation, D description, "
            "X easting, Y northing, - other) or names.",
            known=tuple(_LETTERS),
        )
    return roles


def _listed(words: Iterable[str]) -> str:
    *first, last = words
    return f"{', '.join(first)} and {last}" if first else last
