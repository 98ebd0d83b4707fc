"""Events: progress, summary, warnings and errors on stderr as JSON, a line each, for programs.

Each is an object whose ``event`` is one of

- ``step``: ``text`` is being done, of which ``fraction`` (0 to 1, or null if unknown) is behind;
- ``summary``: ``text`` under ``label``, as people see it at the end;
- ``warning``: ``text``;
- ``error``: ``text``, and the ``exit_code`` that follows.

What libraries print of their own accord stands between them as it is.
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any, Literal

import click

from .streams import write_error

if TYPE_CHECKING:
    from collections.abc import Sequence

_WANTED = "tinsmith.events"


def has_flag(flag: str, arguments: Sequence[str]) -> bool:
    """Whether a flag is among the options, also if these cannot be understood."""
    options = arguments[: arguments.index("--")] if "--" in arguments else arguments
    return flag in options


def note_events(ctx: click.Context, arguments: Sequence[str]) -> None:
    """Remember whether events are wanted, for what is told before options are understood."""
    ctx.find_root().meta[_WANTED] = has_flag("--events", arguments)


def wants_events() -> bool:
    """Whether the command that runs was asked for events."""
    context = click.get_current_context(silent=True)
    return context is not None and bool(context.find_root().meta.get(_WANTED))


def send_event(kind: Literal["step", "summary", "warning", "error"], **what: Any) -> None:
    """Write an event to stderr."""
    write_error(json.dumps({"event": kind, **what}))
