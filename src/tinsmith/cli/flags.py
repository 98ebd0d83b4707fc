"""Options in sentences: the library calls them by their Python names, here they are flags."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import click
from click.core import ParameterSource

from ..base.sentences import name_options

__all__ = ["LibraryOption", "find_flag", "find_given_flag", "name_flags", "note_given"]

_CONTEXT = "tinsmith.context"


class LibraryOption(click.Option):
    """An option of a command that the library calls otherwise.

    Parameters
    ----------
    sets : sequence of str
        Options of the library that have its value, where the command has no flag of that name.
    instead : str
        The one for which it stands whatever other flag has that name.
    """

    def __init__(
        self, *declared: Any, sets: Sequence[str] = (), instead: str = "", **more: Any
    ) -> None:
        super().__init__(*declared, **more)
        self.sets = tuple(sets)
        self.instead = instead


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
    found = [
        (rank, option.opts[0])
        for option in _list_options(_find_running_command(root))
        if (rank := _rank(option, name)) is not None
    ]
    return min(found, default=(0, None))[1]


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
        for one in _list_options(context.command)
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


def _list_options(command: click.Command) -> list[click.Option]:
    return [
        one
        for one in command.params
        if isinstance(one, click.Option) and one.name and one.opts[0].startswith("--")
    ]


def _find_running_command(context: click.Context) -> click.Command:
    """Return the command that runs, also when it has failed and only its group is left."""
    command = context.command
    if isinstance(command, click.Group) and context.invoked_subcommand:
        return command.get_command(context, context.invoked_subcommand) or command
    return command
