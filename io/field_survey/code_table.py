"""Tables of field codes: what each code becomes, and how codes are written; from TOML files."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn, get_args

from ...base.atomic import as_path
from ...base.errors import OptionError, ReadError
from ...base.policies import CodeKind, CodeStyle
from ...base.sentences import printable, shown
from .descriptions import LONGEST_CODE
from .styles import MEANINGS, STYLES, Meaning, Style

if TYPE_CHECKING:
    import os

_KEYS = ("style", "case", "place", "separators", "comments", "arc_tolerance", "marks", "codes")
_RULE_KEYS = ("kind", "closed", "arc_tolerance", "description")
_LETTERS = "-./:_+=&,;(#!|*"
"""Letters that may part words, or begin a remark."""
_LONGEST_TOLERANCE = 1e9
_LARGEST = 10 * 2**20
"""Bytes of a table that are read."""


@dataclass(frozen=True, slots=True)
class Rule:
    """What a code becomes."""

    kind: CodeKind
    """One of ``CodeKind``."""
    is_closed: bool = False
    """Whether its lines are rings, marked so or not."""
    arc_tolerance: float | None = None
    """By which chords may leave the arcs of its curves, CRS units; None is that of the table."""
    description: str = ""


@dataclass(frozen=True, slots=True)
class CodeTable:
    """What codes become, and how they are written."""

    rules: Mapping[str, Rule] = field(default_factory=dict)
    """By code; upper case unless ``is_exact``."""
    style: Style | None = None
    """None finds it out."""
    arc_tolerance: float | None = None
    is_exact: bool = False
    """Whether upper and lower case differ."""
    is_complete: bool = True
    """Whether a code that it does not have is worth telling."""
    source: str = "the code table"
    """For sentences."""


def read_code_table(table: str | os.PathLike[str] | Mapping[str, Any]) -> CodeTable:
    """Read a table of field codes.

    Parameters
    ----------
    table : path-like or mapping
        A TOML file, or what one holds; docs/field-codes.md has the keys.

    Returns
    -------
    CodeTable

    Raises
    ------
    ReadError
        If the file cannot be read, is no TOML, or has a key or value that a table cannot have; the
        sentence names it, and what is allowed.

    Examples
    --------
    >>> table = read_code_table({"codes": {"EP": "hard", "BLDG": {"kind": "building"}}})
    >>> table.rules["EP"].kind
    'hard'
    """
    if isinstance(table, Mapping):
        return _Reader("the code table", None).read(table)
    path = as_path(table, "code_table")
    return _Reader(f"'{path}'", path).read(_load(path))


def _load(path: Path) -> dict[str, Any]:
    try:
        if path.stat().st_size > _LARGEST:
            raise ReadError(
                f"'{path}' is too large for a table of codes: at most {_LARGEST:,} bytes are read.",
                path=path,
            )
        return tomllib.loads(path.read_bytes().decode("utf-8-sig"))
    except OSError as error:
        if isinstance(error, ReadError):
            raise
        raise ReadError(f"Cannot read '{path}': {error.strerror or error}.", path=path) from error
    except UnicodeDecodeError as error:
        raise ReadError(f"'{path}' is not UTF-8 text, as TOML is.", path=path) from error
    except (tomllib.TOMLDecodeError, RecursionError) as error:
        what = str(error).rstrip(".") if isinstance(error, ValueError) else "too deeply nested"
        raise ReadError(printable(f"'{path}' is no TOML: {what}."), path=path) from error


@dataclass(frozen=True, slots=True)
class _Reader:
    """Checks what a table holds, key after key."""

    name: str
    path: Path | None

    def read(self, table: Mapping[str, Any]) -> CodeTable:
        """Return the table."""
        self._require_keys(table, _KEYS, "")
        case = self._choose(table, "case", ("ignore", "exact"), "ignore")
        is_exact = case == "exact"
        style = self._read_style(table, is_exact=is_exact)
        codes = table.get("codes")
        if not isinstance(codes, Mapping) or not codes:
            self._fail("codes", codes, "a table of codes, such as EP = 'hard'")
        rules: dict[str, Rule] = {}
        for code, value in codes.items():
            name = code if is_exact else code.upper()
            is_word = not any(letter.isspace() or letter in "\"'" for letter in name)
            if not 0 < len(name) <= LONGEST_CODE or not is_word:
                allowed = f"a word of up to {LONGEST_CODE} letters without blanks and quotes"
                self._fail("a code", code, allowed)
            if name in rules:
                self._fail("a code", code, "there once: another one is written alike but for case")
            rules[name] = self._read_rule(code, value)
        if style is not None:
            self._require_apart(rules, style)
        return CodeTable(
            rules, style, self._read_tolerance(table, ""), is_exact=is_exact, source=self.name
        )

    def _read_rule(self, code: str, value: Any) -> Rule:
        where = f"codes.{code}"
        if isinstance(value, str):
            return Rule(self._choose({where: value}, where, get_args(CodeKind)))
        if not isinstance(value, Mapping):
            self._fail(where, value, f"one of {', '.join(get_args(CodeKind))}, or a table")
        self._require_keys(value, _RULE_KEYS, f"{where}.")
        if "kind" not in value:
            self._fail(f"{where}.kind", None, f"one of {', '.join(get_args(CodeKind))}")
        closed, text = value.get("closed", False), value.get("description", "")
        if not isinstance(closed, bool):
            self._fail(f"{where}.closed", closed, "true or false")
        if not isinstance(text, str):
            self._fail(f"{where}.description", text, "a text")
        kind = self._choose(value, "kind", get_args(CodeKind), where=f"{where}.")
        return Rule(kind, closed, self._read_tolerance(value, f"{where}."), text)

    def _read_style(self, table: Mapping[str, Any], *, is_exact: bool) -> Style | None:
        """Return the style that the table names or describes, None if it leaves it open."""
        described = {"marks", "separators", "comments", "place"} & table.keys()
        if "style" not in table and not described and not is_exact:
            return None
        name = self._choose(table, "style", get_args(CodeStyle), "words")
        style = replace(STYLES[name], is_exact=is_exact)
        if "marks" in table:
            style = replace(
                style, marks=self._read_marks(table["marks"], is_exact=is_exact), others=""
            )
        separators = self._read_letters(table, "separators", style.separators)
        kept = "".join(one for one in style.comments if one not in separators)
        comments = self._read_letters(table, "comments", kept)
        if both := sorted(set(separators) & set(comments)):
            self._fail("comments", comments, f"other letters than the separators ('{both[0]}')")
        place = self._choose(table, "place", ("behind", "before"), "behind")
        own = name if not described else f"{name} with changes" if "style" in table else "own words"
        return replace(style, name=own, separators=separators, comments=comments, place=place)

    def _read_marks(self, marks: Any, *, is_exact: bool) -> dict[str, Meaning]:
        """Return the words by which the table replaces those of its style."""
        if not isinstance(marks, Mapping):
            self._fail("marks", marks, f"a table of {', '.join(MEANINGS)}")
        self._require_keys(marks, MEANINGS, "marks.")
        found: dict[str, Meaning] = {}
        for meaning in MEANINGS:
            words = marks.get(meaning, [])
            words = [words] if isinstance(words, str) else words
            if not isinstance(words, list) or not all(isinstance(one, str) for one in words):
                self._fail(f"marks.{meaning}", words, "a word, or a list of words")
            for word in words:
                name = word if is_exact else word.upper()
                if not name or any(letter.isspace() or letter in "\"'" for letter in name):
                    self._fail(f"marks.{meaning}", word, "a word without blanks and quotes")
                if name in found:
                    what = f"another word: {name} says '{found[name]}' already"
                    self._fail(f"marks.{meaning}", word, what)
                found[name] = meaning
        return found

    def _read_letters(self, table: Mapping[str, Any], key: str, default: str) -> str:
        value = table.get(key, default)
        letters = (
            "".join(value)
            if isinstance(value, list) and all(isinstance(one, str) for one in value)
            else value
        )
        if not isinstance(letters, str) or any(one not in _LETTERS + " " for one in letters):
            self._fail(key, value, f"letters out of {_LETTERS}")
        return letters.replace(" ", "")

    def _read_tolerance(self, table: Mapping[str, Any], where: str) -> float | None:
        value = table.get("arc_tolerance")
        if value is None:
            return None
        is_number = isinstance(value, int | float) and not isinstance(value, bool)
        if not is_number or not 0 < value <= _LONGEST_TOLERANCE:
            self._fail(f"{where}arc_tolerance", value, "a length above 0, in units of the CRS")
        return float(value)

    def _require_apart(self, rules: Mapping[str, Rule], style: Style) -> None:
        """Refuse a word that is both a code and a mark."""
        both = next((code for code in rules if style.find_meaning(code) is not None), None)
        if both is not None:
            meaning = style.find_meaning(both)
            what = (
                f"no mark: in the style {style.name} it says '{meaning}'; 'marks' sets other words"
            )
            self._fail("a code", both, what)

    def _choose(
        self,
        table: Mapping[str, Any],
        key: str,
        words: tuple[str, ...],
        default: str | None = None,
        where: str = "",
    ) -> Any:
        value = table.get(key, default)
        if not isinstance(value, str) or value not in words:
            self._fail(where + key, value, f"one of {', '.join(words)}")
        return value

    def _require_keys(self, table: Mapping[str, Any], allowed: tuple[str, ...], where: str) -> None:
        for key in table:
            if key not in allowed:
                raise ReadError(
                    printable(
                        f"{self._begin()}: unknown key {shown(f'{where}{key}')}; allowed are "
                        f"{', '.join(allowed)}."
                    ),
                    path=self.path,
                )

    def _fail(self, key: str, value: Any, allowed: str) -> NoReturn:
        given = "is missing" if value is None else f"is {shown(value)}"
        raise ReadError(
            printable(f"{self._begin()}: {key} {given}, and it must be {allowed}."), path=self.path
        )

    def _begin(self) -> str:
        return self.name[0].upper() + self.name[1:]


def make_rules(rules: Mapping[str, Any]) -> dict[str, Rule]:
    """Return rules of plain roles."""
    if not isinstance(rules, Mapping):
        raise OptionError("rules", rules, "a mapping of codes to roles")
    kinds = get_args(CodeKind)
    for code, role in rules.items():
        if not isinstance(role, str) or role not in kinds:
            raise OptionError(
                "rules", {code: role}, f"a role for each code, one of {', '.join(kinds)}"
            )
    return {str(code).upper(): Rule(role) for code, role in rules.items()}
