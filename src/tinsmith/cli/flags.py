"""Options in sentences: the library calls them by their Python names, here they are flags."""

from __future__ import annotations

import click
from click.core import ParameterSource

from ..base.sentences import name_options
from .format_options import find_format_flag

__all__ = ["find_flag", "find_given_flag", "name_flags", "note_given"]

_CONTEXT = "tinsmith.context"


def name_flags(text: str, **renamed: str) -> str:
    """Return a sentence of the library with the flags of this command for the options it marks.

    Parameters
    ----------
    text : str
    **renamed : str
        Flags of options that the library calls by another name.
    """
    return name_options(text, lambda name: renamed.get(name) or find_flag(name))


def find_flag(name: str) -> str | None:
    """Return the flag of the command that runs, or failed, for an option of the library."""
    root = click.get_current_context(silent=True)
    if root is None:
        return None
    context = root.find_root().meta.get(_CONTEXT, root)
    command = _find_running_command(context)
    options = _list_options(command, context)
    found = [
        (rank, option.opts[0]) for option in options if (rank := _rank(option, name)) is not None
    ]
    if found:
        return min(found)[1]
    return find_format_flag(name, getattr(command, "format_ways", ()), options)


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
    given = [
        (rank, one.opts[0])
        for one in _list_options(context.command, context)
        if (rank := _rank(one, option)) is not None
        and context.get_parameter_source(one.name or "") is ParameterSource.COMMANDLINE
    ]
    return (context, min(given)[1]) if given else None


def _rank(option: click.Option, name: str) -> int | None:
    """Return how nearly an option is that of the library with a name, 0 best; None if not."""
    if name == getattr(option, "instead", ""):
        return 0
    if option.opts[0].removeprefix("--").replace("-", "_") == name:
        return 1
    if option.name == name:
        return 2
    return 3 if name in getattr(option, "sets", ()) else None


def _list_options(command: click.Command, context: click.Context) -> list[click.Option]:
    return [
        one
        for one in command.get_params(context)
        if isinstance(one, click.Option) and one.name and one.opts[0].startswith("--")
    ]


def _find_running_command(context: click.Context) -> click.Command:
    """Return the command that runs, also when it has failed and only its group is left."""
    command = context.command
    if isinstance(command, click.Group) and context.invoked_subcommand:
        return command.get_command(context, context.invoked_subcommand) or command
    return command
