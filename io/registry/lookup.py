"""The formats that are known: built-in ones and those of plug-ins, found by name and suffix.

Each family of formats names its own in a module ``formats``, loaded by its name as those of a
plug-in are. Another package adds a format through the entry-point group ``tinsmith.formats``: each
entry names a :class:`Format`.
"""

from __future__ import annotations

from functools import cache
from importlib import import_module
from importlib.metadata import entry_points
from typing import TYPE_CHECKING

from ..._sentences import shown
from ...errors import FormatError
from .format import Format

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

__all__ = [
    "choose_format",
    "find_format",
    "find_format_of_suffix",
    "find_suffixes",
    "find_writer",
    "known_formats",
    "list_suffixes",
]

_FAMILIES = ("delimited", "field_survey", "raster", "vector", "mesh", "tables")
"""Packages of ``tinsmith.io`` with a module ``formats``, in the order in which they are asked."""

_ENTRY_POINTS = "tinsmith.formats"
_ONE = {
    "TIN": "a TIN",
    "Survey": "a Survey",
    "Features": "Features",
    "Raster": "a Raster",
    "Table": "a Table",
}
"""What can be written, by the name of its class."""


@cache
def known_formats() -> tuple[Format, ...]:
    """Return the built-in formats, then those of installed plug-ins by name.

    Raises
    ------
    FormatError
        If a plug-in cannot be loaded, is no Format, or takes a name that is in use.

    Examples
    --------
    >>> "ply" in [form.name for form in known_formats()]
    True
    """
    formats = [one for family in _FAMILIES for one in _load_family(family)]
    for entry in sorted(entry_points(group=_ENTRY_POINTS), key=lambda entry: entry.name):
        added = _load_plug_in(entry.name, entry.load)
        if any(added.name == one.name for one in formats):
            raise FormatError(f"Plug-in '{entry.name}' takes the name '{added.name}', in use.")
        formats.append(added)
    return tuple(formats)


def _load_family(name: str) -> tuple[Format, ...]:
    module = import_module(f"tinsmith.io.{name}.formats")
    formats: tuple[Format, ...] = module.FORMATS
    return formats


def _load_plug_in(name: str, load: Callable[[], object]) -> Format:
    try:
        added = load()
    except Exception as error:
        raise FormatError(f"Format plug-in '{name}' cannot be loaded: {error}.") from error
    if not isinstance(added, Format):
        raise FormatError(f"Format plug-in '{name}' is a {type(added).__name__}, not a Format.")
    return added


def find_format(name: str) -> Format:
    """Look a format up by its name or one of its suffixes.

    Raises
    ------
    FormatError
        If there is none.

    Examples
    --------
    >>> find_format("csv").name
    'delimited'
    """
    wanted = name.strip().lower() if isinstance(name, str) else ""
    suffix = wanted if wanted.startswith(".") else f".{wanted}"
    for one in known_formats():
        if one.name == wanted or suffix in one.suffixes:
            return one
    names = tuple(one.name for one in known_formats())
    raise FormatError(f"Unknown format {shown(name)}: one of {', '.join(names)}.", known=names)


def choose_format(suffix: str, action: str) -> Format | None:
    """Return the format of a suffix, one that can do the action first."""
    fitting = [one for one in known_formats() if suffix in one.suffixes]
    able = [one for one in fitting if getattr(one, action) is not None]
    return next(iter(able + fitting), None)


def find_format_of_suffix(path: Path, action: str) -> Format:
    """Return the format of a file's suffix; refuse an unknown one."""
    found = choose_format(path.suffix.lower(), action)
    if found is not None:
        return found
    suffix = f"has the unknown suffix '{path.suffix}'" if path.suffix else "has no suffix"
    raise FormatError(
        f"'{path}' {suffix}: {list_suffixes(action)} can be "
        f"{'read' if action == 'read' else 'written'}; "
        "the option format names one whatever the suffix.",
        known=find_suffixes(action),
    )


def find_writer(path: Path, name: str | None, kinds: Sequence[str]) -> Format:
    """Choose the format to write a file in.

    Parameters
    ----------
    path : Path
    name : str or None
        Of a format, to choose it whatever the suffix.
    kinds : sequence of str
        What is to be written is one of these: "TIN", "Survey", "Features", "Raster", "Table".

    Raises
    ------
    FormatError
        If there is no such format, it cannot be written, or it holds other things.
    """
    known = find_format_of_suffix(path, "write") if name is None else find_format(name)
    fitting = [one for one in known_formats() if one.write is not None and {*kinds} & {*one.writes}]
    wanted = path.suffix.lower() if name is None else _as_suffix(name)
    named = [one for one in fitting if name is not None and one.name == name.strip().lower()]
    found = next(iter(named + [one for one in fitting if wanted in one.suffixes]), None)
    if found is not None:
        return found
    suffixes = tuple(dict.fromkeys(suffix for one in fitting for suffix in one.suffixes))
    if not any(one.write for one in known_formats() if one is known or wanted in one.suffixes):
        what = f"{known.description} can be read, not written"
    else:
        what = f"{known.description} holds {_listed(known.writes)}, not {_listed(kinds)}"
    raise FormatError(
        f"Cannot write '{path}': {what}; {_listed(kinds)} can be written to "
        f"{', '.join(suffixes) or 'no format'}.",
        known=suffixes,
    )


def _as_suffix(name: str) -> str:
    return f".{name.strip().lower().lstrip('.')}"


def _listed(kinds: Sequence[str]) -> str:
    return " or ".join(_ONE.get(kind, kind) for kind in kinds)


def find_suffixes(action: str) -> tuple[str, ...]:
    """Return the suffixes that can be read, or written."""
    suffixes = (
        suffix
        for one in known_formats()
        if getattr(one, action) is not None
        for suffix in one.suffixes
    )
    return tuple(dict.fromkeys(suffixes))


def list_suffixes(action: str) -> str:
    """List the suffixes that can be read, or written, for a sentence."""
    return ", ".join(find_suffixes(action))
