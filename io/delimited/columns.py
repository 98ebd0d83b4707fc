"""Which column means what: by its name in the header, by the caller's word, or by its content."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from ...base.crs import Unit
from ...base.errors import OptionError, ReadError
from ...base.sentences import counted
from .coordinate_columns import find_group
from .names import parse_name, shorten

if TYPE_CHECKING:
    from collections.abc import Iterable

    from .coordinate_columns import Group

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
_SHOWN_NAMES, _SHOWN_DOUBTS = 12, 3
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
    """Return what a column of this name means, None if the name does not say it beyond doubt.

    Examples
    --------
    >>> find_role("Easting [m]"), find_role("Höhe"), find_role("intensity"), find_role("Z (sdev)")
    ('easting', 'elevation', None, None)
    """
    found = parse_name(name)
    return found.role if found.role in _ROLES and not found.doubt else None


def find_unit_word(name: str) -> str | None:
    """Return the unit of length that a header cell names, as it is written; None if none.

    Examples
    --------
    >>> find_unit_word("Elevation (USft)"), find_unit_word("elev_ft")
    ('USft', 'ft')
    >>> find_unit_word("Height (NAVD88)") is None
    True
    """
    return parse_name(name).unit or None


def find_columns_by_header(header: Sequence[str], units: Sequence[str] = ()) -> Columns | None:
    """Find the columns by the names in the header; None if a coordinate is not among them.

    Parameters
    ----------
    header : sequence of str
    units : sequence of str, optional
        Cells of the line of units below the header.
    """
    group = find_group(header)
    if group is None:
        return None
    if group.refusal:
        raise ReadError(group.refusal)
    return _describe_group(header, units, group)


def names_coordinates(header: Sequence[str]) -> Columns | None:
    """Return the columns that a line seems to name, in whatever way; None if it is no header."""
    has_numbers = any(cell.lstrip("+-.")[:1].isdecimal() for cell in header)
    group = find_group(header, with_doubtful=not has_numbers)
    return None if group is None else _describe_group(header, (), group)


def _describe_group(header: Sequence[str], units: Sequence[str], group: Group) -> Columns:
    named = _find_unit_words(header, units, group.roles)
    names = name_columns(header, len(header))
    return Columns(names, group.roles, group.is_angle, named, group.notes)


def describe_doubts(header: Sequence[str]) -> str:
    """Say which names of coordinates say something more that is not understood; "" if none does."""
    doubts = [
        f"'{shorten(name.strip())}' is not taken as the {parsed.role}: '{shorten(parsed.doubt)}' "
        "may change what it means"
        for name, parsed in ((name, parse_name(name)) for name in header)
        if parsed.role in COORDINATES and parsed.doubt
    ]
    if not doubts:
        return ""
    taken = names_coordinates(header)
    word = "" if taken is None else f"; `columns='{taken.word}'` takes the values as they stand"
    return "; ".join(doubts[:_SHOWN_DOUBTS]) + word


def _find_unit_words(
    header: Sequence[str], units: Sequence[str], roles: Mapping[str, int]
) -> dict[str, str]:
    """Return the words for the units of the coordinates, in the header or the line below it."""
    found: dict[str, str] = {}
    for role in COORDINATES:
        column = roles[role]
        name = header[column] if column < len(header) else ""
        below = units[column].strip(" ()[]") if column < len(units) else ""
        own, other = find_unit_word(name), find_unit_word(f"({below})")
        if own and other and Unit.of(own) != Unit.of(other):
            raise ReadError(
                f"the header gives the {role} in {own} ('{shorten(name)}'), and the line below it "
                f"in {other}: make them agree."
            )
        word = own or other
        if word is not None:
            found[role] = word
    return found


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
    return all(
        column < len(names) and parse_name(names[column]).kind == "angle" for column in columns
    )


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
    return (
        (f"The option `columns` takes {_join_words(wrong)}, against the header.",) if wrong else ()
    )


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
