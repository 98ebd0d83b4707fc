"""Options in sentences: the library calls them by their Python names, here they are flags."""

from __future__ import annotations

import re

import click
from click.core import ParameterSource

__all__ = ["find_given_flag", "name_flags", "note_given"]

_CONTEXT = "tinsmith.context"
_FLAGS_OF = {
    "cells": ("spacing",),
    "interval": ("interval", "sections"),
    "level": ("levels",),
    "spacing": ("spacing", "label_spacing"),
    "unit of elevations": ("z_unit", "lines_z_unit"),
    "width": ("sections",),
}
"""Parameters of commands for options that the library calls otherwise."""

_LENGTH_UNIT = "length_unit"
"""What the library calls ``unit``."""


def name_flags(text: str, **renamed: str) -> str:
    """Return a sentence of the library with flags in place of the names of its options.

    Only what cannot be taken for another word is replaced: ``the option crs``, ``Invalid snap``,
    ``max_edge``, ``crs='EPSG:32616'``.

    Parameters
    ----------
    text : str
    **renamed : str
        Flags of options that the library calls by another name.
    """
    context = click.get_current_context(silent=True)
    if context is None:
        return text
    flags = _list_flags(_find_running_command(context)) | renamed
    text = text.replace(", or None.", ".")
    text = re.sub(r"(?<=its options are )[\w, ]+", lambda found: _name_known(found[0], flags), text)
    for name, flag in flags.items():
        text = re.sub(rf"\b[Tt]he option '?{name}\b'?", flag, text)
        text = re.sub(rf"\b(Invalid|Unknown option) '?{name}\b'?(?! of\b)", rf"\1 {flag}", text)
        text = re.sub(rf"(?<![\w-]){name}=True\b", flag, text)
        text = re.sub(rf"(?<![\w-]){name}=False\b", flag.replace("--", "--no-", 1), text)
        text = re.sub(rf"(?<![\w-]){name}=(?=['\"\w.-])", f"{flag} ", text)
        if "_" in name:
            text = re.sub(rf"(?<![\w'\"./-]){name}(?![\w'\"/-])(?!\.\w)", flag, text)
    return text


def note_given(context: click.Context) -> None:
    """Remember the command that runs, for a failure when only its group is left."""
    context.find_root().meta[_CONTEXT] = context


def find_given_flag(option: str) -> tuple[click.Context, str] | None:
    """Return the flag by which a value of a library's option came from the command line.

    Parameters
    ----------
    option : str
        As an OptionError names it.

    Returns
    -------
    context : click.Context
        Of the command.
    flag : str
        Such as ``--max-edge``; None instead of both if the value came from elsewhere.
    """
    root = click.get_current_context(silent=True)
    context = None if root is None else root.find_root().meta.get(_CONTEXT)
    if context is None:
        return None
    name = option.removeprefix("number of ")
    names = (name.replace("-", "_"), *_FLAGS_OF.get(name, ()))
    for one in context.command.params:
        is_flag = isinstance(one, click.Option) and one.opts[0].startswith("--") and one.name
        if not is_flag:
            continue
        called = {one.name, one.opts[0].removeprefix("--").replace("-", "_")}
        source = context.get_parameter_source(one.name)
        if source is ParameterSource.COMMANDLINE and called.intersection(names):
            return context, one.opts[0]
    return None


def _name_known(names: str, flags: dict[str, str]) -> str:
    """Return the flags of those options in a list that have one here."""
    return ", ".join(flags[name] for name in names.split(", ") if name in flags)


def _find_running_command(context: click.Context) -> click.Command:
    """Return the command that runs, also when it has failed and only its group is left."""
    command = context.command
    if isinstance(command, click.Group) and context.invoked_subcommand:
        return command.get_command(context, context.invoked_subcommand) or command
    return command


def _list_flags(command: click.Command) -> dict[str, str]:
    """Return the flag for each name that the library may use, longest names first."""
    flags = {}
    for option in command.params:
        if isinstance(option, click.Option) and option.opts[0].startswith("--") and option.name:
            flags[option.opts[0].removeprefix("--").replace("-", "_")] = option.opts[0]
            flags.setdefault(option.name, option.opts[0])
    for option in command.params:
        if option.name == _LENGTH_UNIT:  # before any unit that a command has of its own
            flags["unit"] = option.opts[0]
    return dict(sorted(flags.items(), key=lambda item: -len(item[0])))
