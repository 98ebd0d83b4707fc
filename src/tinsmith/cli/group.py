"""The group of commands: those of the package, then those of installed plug-ins."""

from __future__ import annotations

import signal
import sys
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from .. import __version__
from ..base.sentences import suggest
from .command_list import FOLDERS, SECTIONS, SUMMARIES
from .output import (
    Terminated,
    accept_any_text,
    note_events,
    raise_for_signals,
    report_warning,
    reserve_standard_streams,
    show_failure,
    silence,
    translate_failures,
)
from .plug_in_commands import describe_faults, find_commands, find_owner, load_command

if TYPE_CHECKING:
    from collections.abc import Sequence

_BUILT_IN = tuple(SUMMARIES)


class _Commands(click.Group):
    """Loads a command when it is asked for, and turns every failure into a sentence."""

    def list_commands(self, ctx: click.Context) -> list[str]:  # noqa: ARG002 - click's signature
        return [*_BUILT_IN, *(name for name in find_commands() if name not in _BUILT_IN)]

    def get_command(
        self,
        ctx: click.Context,  # noqa: ARG002 - click's signature
        cmd_name: str,
    ) -> click.Command | None:
        if cmd_name in _BUILT_IN:
            where = f".commands.{FOLDERS[cmd_name]}.{cmd_name}"
            module = import_module(where, __package__)
            built_in: click.Command = getattr(module, cmd_name)
            return built_in
        claims = find_commands().get(cmd_name)
        return None if claims is None else load_command(cmd_name, claims)

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """List the commands of the package, then those of plug-ins; tell of faulty ones."""
        for heading, summaries in SECTIONS.items():
            with formatter.section(heading):
                formatter.write_dl(list(summaries.items()))
        added = self.list_commands(ctx)[len(_BUILT_IN) :]
        found = {name: self.get_command(ctx, name) for name in added}
        rows = [(name, one.get_short_help_str(200)) for name, one in found.items() if one]
        if rows:
            with formatter.section("Commands of plug-ins"):
                formatter.write_dl(rows)
        for fault in describe_faults(_BUILT_IN):
            report_warning(fault)

    def main(self, args: Sequence[str] | None = None, **how: Any) -> Any:  # type: ignore[override]
        """Run; click's own ``main``, but for failures, signals and streams that are closed."""
        if not how.pop("standalone_mode", True):
            return super().main(args, standalone_mode=False, **how)
        arguments = sys.argv[1:] if args is None else list(args)
        reserve_standard_streams()
        code: Any = 0
        with raise_for_signals():
            try:
                code = super().main(arguments, standalone_mode=False, **how)
            except click.ClickException as error:
                code = show_failure(error, arguments)
            except BrokenPipeError:
                silence(sys.stdout)
                code = 1
            except (click.Abort, KeyboardInterrupt):
                code = 128 + signal.SIGINT
            except Terminated as ended:
                code = 128 + ended.number
            sys.exit(code if isinstance(code, int) else 0)

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Parse the group's own options, and remember how what follows is to be told."""
        note_events(ctx, args)
        return super().parse_args(ctx, args)

    def invoke(self, ctx: click.Context) -> Any:
        accept_any_text()
        with translate_failures(ctx, lambda: find_owner(ctx.invoked_subcommand, _BUILT_IN)):
            return super().invoke(ctx)

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """Find the command, and tell if a plug-in has one of the same name."""
        for fault in describe_faults(_BUILT_IN, args[0]) if args and args[0] in _BUILT_IN else []:
            report_warning(fault)
        name = args[0] if args else ""
        if not name.startswith("-") and self.get_command(ctx, name) is None:
            if ctx.resilient_parsing:
                return None, None, args[1:]
            meant = suggest(name, self.list_commands(ctx))
            raise click.UsageError(f"No such command '{name}'.{meant}", ctx)
        return super().resolve_command(ctx, args)


def _print_version(
    ctx: click.Context,
    param: click.Parameter,  # noqa: ARG001 - click's signature
    value: bool,
) -> None:
    """Say which version runs, and for which Python and machine its core was compiled."""
    if not value or ctx.resilient_parsing:
        return
    core = find_spec("tinsmith.tin._core")
    name = "" if core is None or core.origin is None else Path(core.origin).name
    build = name.removeprefix("_core.").rpartition(".")[0] or "missing"
    python = ".".join(map(str, sys.version_info[:3]))
    click.echo(f"tinsmith {__version__} (core {build}, Python {python})")
    ctx.exit()


@click.command(
    cls=_Commands,
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100},
)
@click.option(
    "--version",
    is_flag=True,
    is_eager=True,
    expose_value=False,
    callback=_print_version,
    help="Show the version, that of the compiled core and Python's, and exit.",
)
def main() -> None:
    """Turn elevation points into exact terrain surfaces (TINs).

    \b
    Example:
      tinsmith build sample_data/site_survey.csv --crs EPSG:32616 -o site.geojson
      tinsmith view sample_data/site_survey.csv --crs EPSG:32616 -o site.png
    """  # noqa: D301 - click reads the control character
