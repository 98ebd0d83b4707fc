"""Formats of plug-ins: loaded one by one; one that is at fault is left out with a warning."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any, get_args

from ...base.plug_ins import describe_failure, find_plug_ins, warn_of_plug_in
from .format import KINDS, Format, Loss

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from ...base.plug_ins import PlugIn

_GROUP = "tinsmith.formats"
_NAME = re.compile(r"[a-z0-9][a-z0-9_-]*")
_SUFFIX = re.compile(r"(?:\.[a-z0-9_-]+)+")
_TARGET = re.compile(r"[A-Za-z_][\w.]*:[A-Za-z_]\w*")


def load_plug_in_formats(built_in: Sequence[Format]) -> list[Format]:
    """Load the formats of installed plug-ins, by name; what is at fault is left out.

    Parameters
    ----------
    built_in : sequence of Format
        Whose names and suffixes no plug-in's name may be.

    Warns
    -----
    PlugInWarning
        If one cannot be loaded, is no sound Format, or takes a name that is in use.
    """
    known = list(built_in)
    for plug_in in find_plug_ins(_GROUP):
        added = _load(plug_in, known)
        if added is not None:
            known.append(added)
    return known[len(built_in) :]


def _load(plug_in: PlugIn, known: Sequence[Format]) -> Format | None:
    try:
        found = plug_in.load()
    except (Exception, SystemExit) as error:
        reason = f"it cannot be loaded ({describe_failure(error)})"
    else:
        reason = find_fault(found) or _find_clash(found, known)
        if not reason:
            added: Format = replace(found, distribution=plug_in.distribution)
            return added
    warn_of_plug_in(f"format '{plug_in.name}'", plug_in.distribution, f"{reason}; it is left out")
    return None


def find_fault(one: Any) -> str:
    """Return what is wrong with an object that should be a Format, as end of a sentence; or "".

    Examples
    --------
    >>> find_fault(Format(name="mine", description="Mine", suffixes=("mine",), read="mine:read"))
    "its suffix 'mine' is not a dot and small letters, as in '.csv'"
    """
    if not isinstance(one, Format):
        return f"it is a {type(one).__name__}, not a Format"
    if not (isinstance(one.name, str) and _NAME.fullmatch(one.name)):
        return f"its name {one.name!r} is not of small letters, digits and dashes"
    if not isinstance(one.description, str):
        return f"its description {one.description!r} is no text"
    return (
        _find_fault_of_suffixes(one) or _find_fault_of_functions(one) or _find_fault_of_facts(one)
    )


def _find_fault_of_suffixes(one: Format) -> str:
    if not isinstance(one.suffixes, tuple):
        return f"its suffixes {one.suffixes!r} are no tuple"
    for suffix in one.suffixes:
        if not (isinstance(suffix, str) and _SUFFIX.fullmatch(suffix)):
            return f"its suffix {suffix!r} is not a dot and small letters, as in '.csv'"
    return ""


def _find_fault_of_functions(one: Format) -> str:
    targets = [target for target in (one.read, one.write) if target is not None]
    if not targets:
        return "it has neither a reader nor a writer"
    for target in targets:
        if not (isinstance(target, str) and _TARGET.fullmatch(target)):
            return f"{target!r} does not name a function as 'module:function' does"
    for sniff in (one.sniff, one.sniff_folder):
        if sniff is not None and not callable(sniff):
            return f"{sniff!r} recognises no content: it is no function"
    return ""


def _find_fault_of_facts(one: Format) -> str:
    for what, words, allowed in (
        ("reads", one.reads, KINDS),
        ("writes", one.writes, KINDS),
        ("loses", one.loses, get_args(Loss)),
    ):
        if not isinstance(words, tuple) or not {*map(str, words)} <= {*allowed}:
            return f"{what} is {words!r}, and each must be one of {', '.join(allowed)}"
    if not (
        isinstance(one.side_files, Mapping)
        and all(
            isinstance(ends, tuple)
            and all(isinstance(end, str) and end[:1] in (".", "*") for end in ends)
            for ends in one.side_files.values()
        )
    ):
        return f"its side files {one.side_files!r} are no mapping of suffixes to ends of names"
    if one.find_sources is not None and not callable(one.find_sources):
        return f"{one.find_sources!r} finds no sources: it is no function"
    if not (_is_nonnegative(one.rounding) and _is_nonnegative(one.relative_rounding)):
        return "its rounding is no number from 0 on"
    if not all(isinstance(text, str) for text in (one.precision, one.losses, one.extra or "")):
        return "its precision, losses and extra are no texts"
    return ""


def _is_nonnegative(value: object) -> bool:
    return isinstance(value, int | float) and value >= 0


def _find_clash(added: Format, known: Iterable[Format]) -> str:
    for one in known:
        if added.name == one.name:
            return f"the name '{added.name}' is that of a format of {one.distribution}"
        if one.is_built_in and f".{added.name}" in one.suffixes:
            return f"the name '{added.name}' stands for the suffix of the format {one.name}"
    return ""
