"""The group of commands: those of the package, then those of installed plug-ins.

Another package adds a command through the entry-point group ``tinsmith.commands``: each entry
names a :class:`click.Command`.
"""

from __future__ import annotations

import signal
import sys
from functools import cache
from importlib import import_module
from importlib.metadata import EntryPoint, entry_points
from typing import TYPE_CHECKING, Any

import click

from .. import __version__
from ..io.isolated.forking import permit_forks
from .output.failures import Failure, show_failure, translate_failures
from .output.streams import (
    Terminated,
    accept_any_text,
    raise_for_signals,
    reserve_standard_streams,
    silence,
)

if TYPE_CHECKING:
    from collections.abc import Sequence

__all__ = ["main"]

_BUILT_IN = (
    *("build", "info", "check", "view", "compare", "refine", "edit", "convert", "formats"),
    *("contours", "slope", "hillshade", "profile", "volume", "diff", "drape"),
    *("interpolate", "raster"),
)
_ENTRY_POINTS = "tinsmith.commands"


class _Commands(click.Group):
    """Loads a command when it is asked for, and turns every failure into a sentence."""

    def list_commands(self, ctx: click.Context) -> list[str]:  # noqa: ARG002 - click's signature
        return [*_BUILT_IN, *_find_plug_ins()]

    def get_command(
        self,
        ctx: click.Context,  # noqa: ARG002 - click's signature
        cmd_name: str,
    ) -> click.Command | None:
        if cmd_name in _BUILT_IN:
            module = import_module(f".commands.{cmd_name}", __package__)
            built_in: click.Command = getattr(module, cmd_name)
            return built_in
        entry = _find_plug_ins().get(cmd_name)
        return None if entry is None else _load_command(entry)

    def main(self, args: Sequence[str] | None = None, **how: Any) -> Any:  # type: ignore[override]
        """Run; click's own ``main``, but for failures, signals and streams that are closed."""
        if not how.pop("standalone_mode", True):
            return super().main(args, standalone_mode=False, **how)
        arguments = sys.argv[1:] if args is None else list(args)
        reserve_standard_streams()
        if args is None:  # this process is the command's own
            permit_forks()
        with raise_for_signals():
            sys.exit(self._exit_code(arguments, **how))

    def _exit_code(self, arguments: list[str], **how: Any) -> int:
        try:
            code = super().main(arguments, standalone_mode=False, **how)
        except click.ClickException as error:
            return show_failure(error, arguments)
        except BrokenPipeError:
            silence(sys.stdout)
            return 1
        except (click.Abort, KeyboardInterrupt):
            return 128 + signal.SIGINT
        except Terminated as ended:
            return 128 + ended.number
        return code if isinstance(code, int) else 0

    def invoke(self, ctx: click.Context) -> Any:
        accept_any_text()
        with translate_failures(ctx):
            return super().invoke(ctx)


@cache
def _find_plug_ins() -> dict[str, EntryPoint]:
    found = sorted(entry_points(group=_ENTRY_POINTS), key=lambda entry: entry.name)
    return {entry.name: entry for entry in found if entry.name not in _BUILT_IN}


def _load_command(entry: EntryPoint) -> click.Command:
    """Load a plug-in's command; a broken one stays in the list and says what is wrong."""
    try:
        command = entry.load()
    except Exception as error:
        return _make_broken_command(entry.name, f"{type(error).__name__}: {error}")
    if not isinstance(command, click.Command):
        return _make_broken_command(
            entry.name, f"it is a {type(command).__name__}, not a click command"
        )
    return command


def _make_broken_command(name: str, reason: str) -> click.Command:
    def fail(**_: object) -> None:
        raise Failure(f"The plug-in '{name}' cannot be loaded ({reason}): mend or uninstall it.")

    return click.Command(
        name,
        callback=fail,
        short_help="(plug-in that cannot be loaded)",
        context_settings={"ignore_unknown_options": True},
        params=[click.Argument(["arguments"], nargs=-1)],
    )


@click.command(
    cls=_Commands,
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100},
)
@click.version_option(__version__, message="tinsmith %(version)s")
def main() -> None:
    """Turn elevation points into exact terrain surfaces (TINs).

    \b
    Example:
      tinsmith build sample_data/site_survey.csv --crs EPSG:32616 -o site.geojson
      tinsmith view sample_data/site_survey.csv --crs EPSG:32616 -o site.png
    """  # noqa: D301 - click reads the control character
