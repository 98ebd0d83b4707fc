"""Flags of formats, made of the signatures and docstrings of their readers and writers.

A command that reads or writes files takes the options of every format. Those of the formats at
hand, which its arguments name by suffix or by ``--format``, are listed in its help.
"""

from __future__ import annotations

import re
from ast import literal_eval
from pathlib import Path
from typing import TYPE_CHECKING, Any, get_args

import click

from ..base import policies
from .parameters import LibraryOption, Words, parse_columns, parse_crs, parsed
from .paths import INPUT

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from ..io import Format
    from ..io.registry import FormatOption

_PREFIXES = {"read": "read__", "write": "write__"}
"""What the names of their values begin with, by what a format does."""

_OWN = {"read": ("source_crs", "unit"), "write": ("layer",)}
"""Options that commands have themselves: of every reader, or as ``-o FILE:LAYER``."""

_SUBJECTS = {"read": "Reading", "write": "Writing"}

_OUTPUTS = ("-o", "--output")


def list_format_options(
    own: Sequence[click.Parameter], ways: Sequence[str], arguments: Sequence[str], *, lists: bool
) -> list[click.Option]:
    """Return the options of formats that a command's arguments need.

    None has a flag of the command's ``own``. With ``lists`` all options of the formats at hand are
    wanted, for a list; else only if there is a flag that the command has not, which saves loading
    readers and writers. ``ways`` are what the command does with files: "read", "write".
    """
    found = _Flags({flag for one in own for flag in _list_flags(one)} | {"--help"})
    named = {text.partition("=")[0] for text in arguments if re.match("--[a-z]", text)}
    if not ways or not (lists or named - found.taken):
        return []
    from ..io import known_formats

    for way in ways:
        found.add(_find_formats(arguments, way), way)
    for way in ways:
        if missing := named - found.taken:
            found.add((one for one in known_formats() if getattr(one, way)), way, missing)
    return found.options


class _Flags:
    """Options of formats, none of which has a flag that is taken."""

    def __init__(self, taken: set[str]) -> None:
        self.taken = taken
        self.options: list[click.Option] = []

    def add(self, formats: Iterable[Format], way: str, wanted: set[str] | None = None) -> None:
        """Add the options of formats, or only those with one of the flags that are wanted."""
        for one in formats:
            for option in one.describe_options(way):
                name = f"{_PREFIXES[way]}{option.name}"
                if option.name in _OWN[way] or any(other.name == name for other in self.options):
                    continue
                flag = make_flag(option.name, way, self.taken)
                new = _make_option(option, name, flag, f"{_SUBJECTS[way]} {one.name}")
                if wanted is None or wanted & _list_flags(new):
                    self.options.append(new)
                    self.taken |= _list_flags(new)


def _list_flags(option: click.Parameter) -> set[str]:
    return {*option.opts, *option.secondary_opts}


def list_flags_of(one: Format) -> dict[str, list[tuple[str, str]]]:
    """Return flags and texts of a format's options, under a heading each for its ways."""
    context = click.Context(click.Command("formats"))
    found = {}
    for way, what in _SUBJECTS.items():
        records = [
            _make_option(option, option.name, make_flag(option.name, way), what).get_help_record(
                context
            )
            for option in one.describe_options(way)
            if option.name not in _OWN[way]
        ]
        if records:
            found[what] = [record for record in records if record is not None]
    return found


def take_options(given: dict[str, Any], way: str) -> dict[str, Any]:
    """Take the options of formats that were given out of what click hands to a command."""
    prefix = _PREFIXES[way]
    found = {name: given.pop(name) for name in list(given) if name.startswith(prefix)}
    return {name.removeprefix(prefix): value for name, value in found.items() if value is not None}


def make_flag(name: str, way: str, taken: Iterable[str] = ()) -> str:
    """Return the flag of an option; ``--output-NAME`` for a writer's where another has the name."""
    flag = f"--{name.replace('_', '-')}"
    if flag not in taken:
        return flag
    return f"--{'input' if way == 'read' else 'output'}-{name.replace('_', '-')}"


def find_format_flag(name: str, ways: Sequence[str], own: Sequence[click.Option]) -> str | None:
    """Return the flag for an option of any format; None if no format has it."""
    from ..io import known_formats

    taken = {flag for one in own for flag in one.opts}
    for way in ways:
        able = (one for one in known_formats() if getattr(one, way) and one.is_built_in)
        if any(name in one.options(way) for one in able):
            return make_flag(name, way, taken)
    return None


def _find_formats(arguments: Sequence[str], way: str) -> list[Format]:
    """Return the formats that a command's arguments name, by suffixes or their names."""
    from ..base.errors import FormatError
    from ..io import known_formats
    from ..io.registry import find_formats, list_claims

    flag = "--format" if way == "read" else "--output-format"
    named, paths = [], []
    for before, text in zip(["", *arguments], arguments):  # noqa: B905 - one more before
        start, _, value = text.partition("=")
        is_output = before in _OUTPUTS or start == "--output"
        if before == flag or (start == flag and value):
            named.append(value or text)
        elif not text.startswith("-") or start == "--output":
            paths += [Path(value or text)] if is_output == (way == "write") else []
    try:
        found = [one for name in named for one in find_formats(name) if getattr(one, way)]
    except FormatError:  # which the command refuses
        found = []
    able = [one for one in known_formats() if getattr(one, way)]
    claims = [one for path in paths for one in list_claims(able, path)]
    return list(dict.fromkeys(found or claims))


def _make_option(one: FormatOption, name: str, flag: str, subject: str) -> LibraryOption:
    how = find_parameters(one)
    declared = flag
    if how.get("is_flag") and one.default is not False:
        declared = f"{flag}/--no-{flag.removeprefix('--')}"
    plain = re.sub(r":\w+:`\.?(.*?)`", r"\1", one.text)
    text = plain.replace("`", "")
    is_stated = isinstance(one.default, str | int | float) and not isinstance(one.default, bool)
    made = LibraryOption(
        [declared, name],
        instead=one.name,
        default=None,
        help=text + (f"  [default: {one.default}]" if is_stated else ""),
        **how,
    )
    vars(made)["subject"] = subject
    return made


def find_parameters(one: FormatOption) -> dict[str, Any]:
    """Return what click needs to know of a value, by the types of the option."""
    annotation, kind = one.annotation, one.kind
    several = re.match(r".*\((\d),\) sequence of (int|float)", kind)
    words = _find_words(one)
    if words:
        return {"type": Words(words)}
    if "bool" in annotation or isinstance(one.default, bool):
        return {"is_flag": True}
    if several:
        number = int if several[2] == "int" else float
        bounds = "XMIN YMIN XMAX YMAX" if "Bounds" in annotation else None
        return {"type": (number,) * int(several[1]), "metavar": bounds}
    if "Mapping" in annotation:
        return {"callback": parse_columns, "metavar": "LAYOUT"}
    if "CrsLike" in annotation:
        return {"callback": parse_crs, "metavar": "CRS"}
    if "PathLike" in annotation:
        return {"type": INPUT, "metavar": "FILE"}
    if "UnitLike" in annotation or "str" in annotation or not annotation:
        return {"metavar": "UNIT" if "UnitLike" in annotation else "TEXT"}
    number = float if "float" in annotation else int
    metavar = "NUMBER" if number is float else "N"
    if "Sequence" in annotation:
        return {"type": number, "metavar": metavar, "multiple": True, "callback": _none_if_empty}
    return {"type": number, "metavar": metavar}


def _find_words(one: FormatOption) -> tuple[str, ...]:
    """Return the words of an option that takes one of a few."""
    for name in re.findall(r"\w+", f"{one.annotation} {one.kind}"):
        words = get_args(getattr(policies, name, None))
        if words:
            return words
    listed = re.match(r"(\{.*?\})(, optional)?$", one.kind)
    return () if listed is None or "..." in one.kind else tuple(sorted(literal_eval(listed[1])))


_none_if_empty = parsed(lambda _, value: value or None)
