"""The formats that are known: built-in ones and those of plug-ins, found by name and suffix.

Each family of formats names its own in a module ``formats``, loaded by its name as those of a
plug-in are. Another package adds a format through the entry-point group ``tinsmith.formats``: each
entry names a :class:`Format`. A suffix that two formats claim for the same thing, one of them of a
plug-in, is refused where it is used: ``format=`` chooses.
"""

from __future__ import annotations

from functools import cache
from importlib import import_module
from typing import TYPE_CHECKING

from ...base.errors import FormatError, choice
from ...base.sentences import shown
from .format import Format
from .plug_in_formats import load_plug_in_formats

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from pathlib import Path

_FAMILIES = ("delimited", "field_survey", "raster", "mesh", "vector", "cad", "tables", "lidar")
"""Packages of ``tinsmith.io`` with a module ``formats``, in the order in which they are asked."""

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

    Warns
    -----
    PlugInWarning
        If a plug-in cannot be loaded, is no Format, or takes a name that is in use; it is left out.

    Examples
    --------
    >>> "ply" in [form.name for form in known_formats()]
    True
    """
    built_in = [one for family in _FAMILIES for one in _load_family(family)]
    return (*built_in, *load_plug_in_formats(built_in))


def _load_family(name: str) -> tuple[Format, ...]:
    module = import_module(f"tinsmith.io.{name}.formats")
    formats: tuple[Format, ...] = module.FORMATS
    return formats


def find_format(name: str, action: str | None = None) -> Format:
    """Look a format up by its name or one of its suffixes.

    Parameters
    ----------
    name : str
    action : {"read", "write"}, optional
        What it should be able to, if one of several of that name and suffix is.

    Raises
    ------
    FormatError
        If there is none, or a plug-in claims a suffix that another format has.

    Examples
    --------
    >>> find_format("csv").name
    'delimited'
    """
    if action is not None:
        choice("action", action, ("read", "write"))
    called = find_formats(name)
    found = [one for one in called if action and getattr(one, action) is not None] or called
    wanted = name.strip().lower()
    named = [one for one in found if one.name == wanted and not one.is_built_in]
    return choose_clear(named or found, f"The suffix '{_as_suffix(name)}'")


def find_formats(name: str) -> list[Format]:
    """Return all formats that have a name or suffix; raise a FormatError if there is none."""
    wanted = name.strip().lower() if isinstance(name, str) else ""
    suffix = _as_suffix(wanted)
    found = [one for one in known_formats() if one.name == wanted or suffix in one.suffixes]
    if not found:
        names = tuple(one.name for one in known_formats())
        raise FormatError(f"Unknown format {shown(name)}: one of {', '.join(names)}.", known=names)
    return found


def list_claims(formats: Iterable[Format], path: Path) -> list[Format]:
    """Return those of the formats that claim the longest suffix of a file's name."""
    name = path.name.lower()
    fitting = [(one, _measure_match(one, name)) for one in formats]
    longest = max((length for _, length in fitting), default=0)
    return [one for one, length in fitting if 0 < length == longest]


def _measure_match(one: Format, name: str) -> int:
    """Return the length of the longest suffix of a format that a name ends in; 0 for none."""
    found = (len(suffix) for suffix in one.suffixes if name.endswith(suffix) and name != suffix)
    return max(found, default=0)


def choose_clear(claims: Sequence[Format], what: str) -> Format:
    """Return the first of several formats; refuse to choose between a plug-in and another.

    Parameters
    ----------
    claims : sequence of Format
    what : str
        What they claim, as the begin of a sentence.

    Raises
    ------
    FormatError
        If one of several is that of a plug-in.
    """
    if _is_clear(claims):
        return claims[0]
    raise _describe_clash(claims, what)


def _is_clear(claims: Sequence[Format]) -> bool:
    return len(claims) == 1 or (len(claims) > 1 and all(one.is_built_in for one in claims))


def _describe_clash(claims: Sequence[Format], what: str) -> FormatError:
    listed = ", ".join(f"{one.name} ({one.distribution})" for one in claims)
    return FormatError(
        f"{what} is claimed by {len(claims)} formats: {listed}; the option `format` names one.",
        known=tuple(one.name for one in claims),
    )


def choose_format(path: Path, action: str) -> Format | None:
    """Return the format of a file's suffix, one that can do the action first, or None.

    Raises
    ------
    FormatError
        If a plug-in claims a suffix that another format has.
    """
    claims = _list_claims_of_any(path, action)
    return choose_clear(claims, f"The suffix of '{path}'") if claims else None


def _list_claims_of_any(path: Path, action: str) -> list[Format]:
    """Return the formats of a file's suffix that can do the action, or else all of them."""
    able = [one for one in known_formats() if getattr(one, action) is not None]
    return list_claims(able, path) or list_claims(known_formats(), path)


def find_format_of_suffix(path: Path, action: str) -> Format:
    """Return the format of a file's suffix; refuse an unknown one."""
    found = choose_format(path, action)
    if found is None:
        raise _describe_unknown_suffix(path, action)
    return found


def _describe_unknown_suffix(path: Path, action: str) -> FormatError:
    suffix = f"has the unknown suffix '{path.suffix}'" if path.suffix else "has no suffix"
    return FormatError(
        f"'{path}' {suffix}: {list_suffixes(action)} can be "
        f"{'read' if action == 'read' else 'written'}; "
        "the option `format` names one whatever the suffix.",
        known=find_suffixes(action),
    )


def find_writer(path: Path, name: str | None, kinds: Sequence[str]) -> Format:
    """Choose the format to write a file in, by its suffix or the name of a format.

    What is to be written is one of the ``kinds``: "TIN", "Survey", "Features", "Raster", "Table".

    Raises
    ------
    FormatError
        If there is no such format, it cannot be written, or it holds other things; if a plug-in
        claims a suffix that another format has.
    """
    return next(iter(find_writers(path, name, kinds).values()))


def find_writers(path: Path, name: str | None, kinds: Sequence[str]) -> dict[str, Format]:
    """Choose the format of each kind of thing that may be written to a file, as for one.

    Kinds that no format holds are left out; the answer is never empty, else a FormatError is
    raised.
    """
    claims = {kind: list_writers(path, name, kind) for kind in kinds}
    clear = {kind: formats[0] for kind, formats in claims.items() if _is_clear(formats)}
    what = f"The suffix of '{path}'" if name is None else f"The format {shown(name)}"
    for formats in claims.values():
        if formats and not clear:
            raise _describe_clash(formats, what)
    if not clear:
        raise _describe_no_writer(path, name, kinds)
    return clear


def list_writers(path: Path, name: str | None, kind: str) -> list[Format]:
    """Return the formats that a kind of thing can be written in, of a name or else a suffix."""
    able = [one for one in known_formats() if one.write is not None]
    if name is None:
        return [one for one in list_claims(able, path) if kind in one.writes]
    fitting = [one for one in able if kind in one.writes]
    named = [one for one in fitting if one.name == name.strip().lower()]
    return named or [one for one in fitting if _as_suffix(name) in one.suffixes]


def _describe_no_writer(path: Path, name: str | None, kinds: Sequence[str]) -> FormatError:
    claims = _list_claims_of_any(path, "write") if name is None else [find_format(name, "write")]
    if not claims:
        return _describe_unknown_suffix(path, "write")
    known = claims[0]
    fitting = [one for one in known_formats() if one.write is not None and {*kinds} & {*one.writes}]
    suffixes = tuple(dict.fromkeys(suffix for one in fitting for suffix in one.suffixes))
    if known.write is None:
        which = f"a file '{path.suffix}'" if name is None else f"the format {shown(name)}"
        what = f"{which} can be read ({known.description}), not written"
    else:
        what = f"{known.description} holds {_list_words(known.writes)}, not {_list_words(kinds)}"
        if "TIN" in known.writes and [*kinds] == ["Survey"]:
            what += "; triangulate it first"
    return FormatError(
        f"Cannot write '{path}': {what}; {_list_words(kinds)} can be written to "
        f"{', '.join(suffixes) or 'no format'}.",
        known=suffixes,
    )


def _as_suffix(name: str) -> str:
    return f".{name.strip().lower().lstrip('.')}"


def _list_words(kinds: Sequence[str]) -> str:
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
