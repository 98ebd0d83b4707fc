"""Commands of plug-ins: loaded when asked for; one that is at fault does no harm to others.

Another package adds a command through the entry-point group ``tinsmith.commands``: each entry
names a :class:`click.Command`.
"""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

import click

from ..base.plug_ins import describe_failure, find_plug_ins
from .output import Failure

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ..base.plug_ins import PlugIn

_GROUP = "tinsmith.commands"


@cache
def find_commands() -> dict[str, list[PlugIn]]:
    """Return the commands of installed plug-ins by name, several where they claim one name."""
    found: dict[str, list[PlugIn]] = {}
    for one in find_plug_ins(_GROUP):
        found.setdefault(one.name, []).append(one)
    return found


def load_command(name: str, claims: Sequence[PlugIn]) -> click.Command:
    """Load a plug-in's command; in place of a faulty one stands one that says what is wrong."""
    command, fault = _try_to_load(claims)
    if command is not None:
        return command

    def fail(**_: object) -> None:
        raise Failure(fault)

    return click.Command(
        name,
        callback=fail,
        short_help="(cannot be used)",
        context_settings={"ignore_unknown_options": True, "help_option_names": list[str]()},
        params=[click.Argument(["arguments"], nargs=-1)],
    )


def _try_to_load(claims: Sequence[PlugIn]) -> tuple[click.Command | None, str]:
    """Return the command, or None and a sentence that says what is wrong."""
    first = claims[0]
    if len(claims) > 1:
        owners = " and ".join(one.distribution for one in claims)
        return None, f"Two plug-ins have a command '{first.name}', {owners}: uninstall one."
    try:
        command = first.load()
    except (Exception, SystemExit) as error:
        reason = describe_failure(error)
    else:
        if isinstance(command, click.Command):
            return command, ""
        reason = f"it is a {type(command).__name__}, not a click command"
    return None, (
        f"The plug-in '{first.name}' of {first.distribution} cannot be loaded ({reason}): "
        "repair or uninstall it."
    )


def describe_faults(built_in: Sequence[str], name: str | None = None) -> list[str]:
    """Return a sentence for each command of a plug-in that cannot be used, or that of a name.

    ``built_in`` are the names of the commands of the package, which no plug-in replaces.
    """
    faults = []
    for called, claims in find_commands().items():
        if name not in (None, called):
            continue
        if called in built_in:
            owners = " and ".join(one.distribution for one in claims)
            why = "tinsmith has one of that name"
            faults.append(f"The command '{called}' of the plug-in {owners} is left out: {why}.")
        else:
            faults.append(_try_to_load(claims)[1])
    return [fault for fault in faults if fault]


def find_owner(name: str | None, built_in: Sequence[str]) -> str:
    """Return whose command has a name: "tinsmith", or the plug-in's distribution."""
    claims = find_commands().get(name or "")
    if name in built_in or not claims:
        return "tinsmith"
    return f"the plug-in {claims[0].distribution}"
