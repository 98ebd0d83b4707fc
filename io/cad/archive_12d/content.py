"""What an archive holds: strings, tins, and what was left out.

The elements are those of the chapter "12d Archive File Format" of the reference manual of 12d
Model. Elements may stand on lines of their own or behind each other; what is not known is skipped
and counted.
"""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from ....base.sentences import counted
from .scanner import Scanner

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from ....base.arrays import BoolArray, Float64Array, Int64Array

_COLUMNS = {
    "2d": 2,
    "3d": 3,
    "4d": 3,
    "pipe": 3,
    "face": 3,
    "interface": 4,
    "polyline": 5,
    "super": 5,
}
"""Numbers of a vertex in the block ``data``, by the type of string."""

_COMMANDS = ("model", "colour", "style", "breakline", "null", "attributes", "project_attributes")
_TRUE = ("1", "true", "yes")
_SHOWN = 40
_CONSTRUCTION_POINTS = 4
"""Corners of a rectangle about the points of a full_tin, its first points."""

_VISIBLE = 2
"""Mark of a triangle that belongs to the surface."""

NULL = -999.0
"""The elevation that stands for none, unless the archive names another."""


@dataclass(frozen=True, slots=True, eq=False)
class String:
    """Vertices one after the other."""

    rows: Float64Array
    """(k, 3), easting, northing, elevation; NaN where there is none."""
    name: str
    is_line: bool
    """Whether the edges between its vertices are breaklines."""
    is_curved: bool
    """Whether there are arcs or other curves between vertices."""
    attributes: dict[str, str]


@dataclass(frozen=True, slots=True, eq=False)
class Tin:
    """A surface."""

    name: str
    points: Float64Array
    """(n, 3)."""
    triangles: Int64Array
    """(m, 3), points from 0, counter-clockwise."""
    n_hidden: int


@dataclass(frozen=True, slots=True, eq=False)
class Content:
    """What was read."""

    strings: list[String] = field(default_factory=list)
    tins: list[Tin] = field(default_factory=list)
    left_out: Counter[str] = field(default_factory=Counter)
    """Elements by their keywords."""


def parse(content: bytes) -> Content:
    """Read an archive.

    Raises
    ------
    ReadError
        If a block does not end, or its numbers are none.
    """
    parser = _Parser(Scanner.of(content))
    parser.parse()
    return parser.found


class _Parser:
    """What commands say of all that follows, and what was found."""

    def __init__(self, scanner: Scanner) -> None:
        self.scanner = scanner
        self.found = Content()
        self._null = NULL
        self._is_line = True

    def parse(self) -> None:
        """Read all elements."""
        scanner = self.scanner
        while (token := scanner.take()) is not None:
            word = token.word
            if word == "string":
                kind = scanner.take()
                if kind is not None and scanner.take_brace():
                    self._parse_string(kind.text.lower())
            elif word in ("tin", "full_tin") and scanner.take_brace():
                self.found.tins.append(_parse_tin(scanner, is_full=word == "full_tin"))
            elif word in _COMMANDS:
                self._parse_command(word)
            elif scanner.take_brace():
                self.found.left_out[token.text[:_SHOWN]] += 1
                scanner.skip_block(token.text[:_SHOWN])

    def _parse_command(self, word: str) -> None:
        if self.scanner.take_brace():
            self.scanner.skip_block(word)
        elif word == "null":
            self._null = _take_number(self.scanner, word, self._null)
        elif word == "breakline":
            self._is_line = _take_text(self.scanner).lower() != "point"
        else:
            self.scanner.take()

    def _parse_string(self, kind: str) -> None:
        """Read a string; one of a type that has no vertices is left out."""
        scanner = self.scanner
        told: dict[str, Any] = {"z": float("nan"), "is_line": self._is_line}

        def take_rows(word: str, columns: int) -> None:
            if scanner.take_brace():
                told["rows"] = scanner.take_rows(f"{word} of a string", columns)

        handlers: dict[str, Callable[[], object]] = {
            "name": lambda: told.update(name=_take_text(scanner)),
            "breakline": lambda: told.update(is_line=_take_text(scanner).lower() != "point"),
            "closed": lambda: told.update(is_closed=_take_text(scanner).lower() in _TRUE),
            "data_2d": lambda: take_rows("data_2d", 2),
            "data_3d": lambda: take_rows("data_3d", 3),
            "attributes": lambda: told.update(attributes=_parse_attributes(scanner)),
            "geometry_data": lambda: told.update(is_curved=_has_curves(scanner)),
        }
        if kind in _COLUMNS:
            handlers["data"] = lambda: take_rows("data", _COLUMNS[kind])
        if kind in ("2d", "super"):
            handlers["z"] = lambda: told.update(z=_take_number(scanner, "z", told["z"]))
        _read_block(scanner, "a string", handlers)
        if "rows" not in told:
            self.found.left_out[f"string {kind[:_SHOWN]}"] += 1
            return
        rows: Float64Array = told["rows"]
        has_radii = rows.shape[1] == 5 and bool((rows[:, 3] != 0).any())
        xyz = np.full((len(rows), 3), told["z"])
        xyz[:, : min(rows.shape[1], 3)] = rows[:, :3]
        xyz[xyz[:, 2] == self._null, 2] = np.nan
        if told.get("is_closed") and len(xyz) > 2 and (xyz[0] != xyz[-1]).any():
            xyz = np.concatenate([xyz, xyz[:1]])
        self.found.strings.append(
            String(
                xyz,
                told.get("name", "").strip(),
                told["is_line"],
                has_radii or told.get("is_curved", False),
                told.get("attributes", {}),
            )
        )


def _read_block(scanner: Scanner, what: str, handlers: Mapping[str, Callable[[], object]]) -> None:
    """Read a block up to its end: keywords by their handlers, other blocks are passed."""
    start = scanner.at
    while (token := scanner.take()) is not None and token.word != "}":
        handle = handlers.get(token.word)
        if handle is not None:
            handle()
        elif scanner.take_brace():
            scanner.skip_block(token.text[:_SHOWN])
    if token is None:
        raise scanner.describe_fault(start, f"the block of {what} does not end")


def _take_text(scanner: Scanner) -> str:
    """Return the word behind a keyword; "" where there is none."""
    token = scanner.peek()
    if token is None or token.word in ("{", "}"):
        return ""
    scanner.take()
    return token.text


def _take_number(scanner: Scanner, what: str, default: float) -> float:
    """Return the number behind a keyword; ``null`` leaves the default."""
    at, text = scanner.at, _take_text(scanner)
    if text.lower() in ("", "null"):
        return default
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise scanner.describe_fault(at, f"'{text[:_SHOWN]}' behind {what} is no number")
    return value


def _parse_attributes(scanner: Scanner) -> dict[str, str]:
    """Return attributes by name: a type, a name and a value each; groups are left out."""
    found: dict[str, str] = {}

    def take() -> None:
        name = _take_text(scanner)
        found[name] = _take_text(scanner)

    if scanner.take_brace():
        _read_block(scanner, "attributes", dict.fromkeys(("text", "integer", "real"), take))
    return found


def _has_curves(scanner: Scanner) -> bool:
    """Whether segments of a string are other than straight."""
    if not scanner.take_brace():
        return False
    start, is_curved = scanner.at, False
    while (token := scanner.take()) is not None and token.word != "}":
        if scanner.take_brace():
            is_curved |= token.word != "straight"
            scanner.skip_block("a segment")
    if token is None:
        raise scanner.describe_fault(start, "the block of geometry_data does not end")
    return is_curved


def _parse_tin(scanner: Scanner, *, is_full: bool) -> Tin:
    """Read a tin; of a full_tin the triangles that belong to the surface.

    Those of a full_tin that are not marked visible, or have a corner of the rectangle about its
    points, do not.
    """
    start = scanner.at
    told: dict[str, Any] = {"name": ""}

    def take_block(word: str, columns: int) -> None:
        if scanner.take_brace():
            told[f"{word} at"] = scanner.at
            told[word] = scanner.take_rows(f"{word} of a tin", columns)

    _read_block(
        scanner,
        "a tin",
        {
            "name": lambda: told.update(name=_take_text(scanner).strip()),
            "points": lambda: take_block("points", 3),
            "triangles": lambda: take_block("triangles", 3),
            "nulling": lambda: take_block("nulling", 1),
        },
    )
    points = told.get("points", np.empty((0, 3)))
    rows = told.get("triangles", np.empty((0, 3)))
    at = told.get("triangles at", start)
    wrong = ~((rows == np.floor(rows)) & (rows >= 1) & (rows <= len(points)))
    if wrong.any():
        row = int(np.argmax(wrong.any(axis=1)))
        named = float(rows[row][wrong[row]][0])
        raise scanner.describe_fault(
            at, f"triangle {row + 1} of a tin names point {named:.16g} of {len(points):,}"
        )
    triangles = rows.astype(np.int64)[:, [0, 2, 1]] - 1
    nulling = told.get("nulling", np.empty((0, 1))).ravel()
    if len(nulling) not in (0, len(triangles)):
        raise scanner.describe_fault(
            told["nulling at"],
            f"nulling of a tin has {counted(len(nulling), 'number')} for "
            f"{counted(len(triangles), 'triangle')}",
        )
    is_kept: BoolArray = np.ones(len(triangles), np.bool_)
    if len(nulling):
        is_kept &= nulling == _VISIBLE
    if is_full:
        is_kept &= (triangles >= _CONSTRUCTION_POINTS).all(axis=1)
    return Tin(told["name"], points, triangles[is_kept], int((~is_kept).sum()))
