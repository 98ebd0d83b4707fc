"""Commands: what they take, how their help lists it, and their flags in the library's sentences."""

from __future__ import annotations

import re
from inspect import cleandoc
from typing import TYPE_CHECKING, Any

import click
from click.core import ParameterSource

from ..base.sentences import name_options
from .format_options import find_format_flag, list_format_options
from .parameters import input_file, output_files

if TYPE_CHECKING:
    from collections.abc import Callable

_OWN = "Options"
LISTED_BY = {
    **dict.fromkeys(("Triangulation", "Lines and areas", "Codes of points"), "build"),
    "Tiles, for more points than memory holds": "raster",
    **dict.fromkeys(("Reprojection", "Coordinates on the ground", "Input", "Output"), "convert"),
    "Sheets": "plan",
    "Errors of elevations": "volume",
}
"""Subjects of options that only the help of one of the commands lists that have them."""
_OF_FORMATS = "tinsmith.options_of_formats"
_CONTEXT = "tinsmith.context"
_VERBATIM = re.compile(r"^(?=(?:Example|A script|A table):$)", re.MULTILINE)
"""Where lines of a help begin that are not wrapped."""


class Command(click.Command):
    """A command whose help lists its own options first, then shared ones by subject.

    Options that take one value are refused when they are given twice: of two pads, or two lines,
    the first would be lost in silence.
    """

    @property
    def format_ways(self) -> tuple[str, ...]:
        """What it does with files whose formats have options: "read", "write"."""
        ways: tuple[str, ...] = getattr(self.callback, "format_ways", ())
        return ways

    def get_params(self, ctx: click.Context) -> list[click.Parameter]:
        """Return the command's options, and those of the formats at hand."""
        return [*super().get_params(ctx), *ctx.meta.get(_OF_FORMATS, ())]

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Read the arguments; refuse an option that is given more often than it is looked at."""
        lists = ctx.resilient_parsing or bool({"-h", "--help"} & {*args})
        ctx.meta[_OF_FORMATS] = list_format_options(
            self.params, self.format_ways, args, lists=lists
        )
        given = [] if ctx.resilient_parsing else self.make_parser(ctx).parse_args(list(args))[2]
        for one in {id(one): one for one in given}.values():
            if not isinstance(one, click.Option) or one.multiple or one.is_flag or one.count:
                continue
            if sum(other is one for other in given) > 1:
                flag = max(one.opts, key=len)
                raise click.UsageError(f"{flag} is given several times: it takes one.")
        return super().parse_args(ctx, args)

    def format_options(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the options under their subjects."""
        sections: dict[str, list[tuple[str, str]]] = {_OWN: []}
        for one in self.get_params(ctx):
            record = one.get_help_record(ctx) if isinstance(one, click.Option) else None
            subject = getattr(one, "subject", _OWN)
            if record is not None and LISTED_BY.get(subject, self.name) == self.name:
                sections.setdefault(subject, []).append(record)
        for heading in sections:
            with formatter.section(heading):
                formatter.write_dl(sections[heading])

    def format_epilog(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Tell where the options are listed that this help leaves out."""
        subjects = dict.fromkeys(getattr(one, "subject", _OWN) for one in self.params)
        elsewhere: dict[str, list[str]] = {}
        for one in subjects:
            if LISTED_BY.get(one, self.name) != self.name:
                elsewhere.setdefault(LISTED_BY[one], []).append(one.lower())
        text = "".join(
            f"Taken too: {', '.join(left)}, as 'tinsmith {name} --help' lists them. "
            for name, left in elsewhere.items()
        )
        if self.format_ways:
            text += (
                f"A format has options of its own: 'tinsmith {self.name} FILE --help' lists those "
                "of the file's, 'tinsmith formats NAME' any."
            )
        if text:
            formatter.write_paragraph()
            formatter.write_text(text)
        super().format_epilog(ctx, formatter)


def command(function: Callable[..., Any]) -> click.Command:
    """Make a command of a function, whose documentation is its help: examples as they are."""
    text = _VERBATIM.sub("\b\n", cleandoc(function.__doc__ or ""))
    return click.command(cls=Command, help=text)(function)


def file_command(function: Callable[..., Any]) -> click.Command:
    """Make a command that reads one file, and writes what it makes of it to others."""
    return command(input_file("file")(output_files(function)))


# ------------------------------------------------------- options in sentences of the library


def name_flags(text: str, **renamed: str) -> str:
    """Return a sentence of the library with the flags of this command for the options it marks.

    ``renamed`` has flags of options that the library calls by another name.
    """
    return name_options(text, lambda name: renamed.get(name) or find_flag(name))


def note_given(context: click.Context) -> None:
    """Remember the command that runs, for a failure when only its group is left."""
    context.find_root().meta[_CONTEXT] = context


def find_flag(name: str) -> str | None:
    """Return the flag of the command that runs, or failed, for an option of the library."""
    root = click.get_current_context(silent=True)
    if root is None:
        return None
    context = root.find_root().meta.get(_CONTEXT, root)
    running = context.command
    if isinstance(running, click.Group) and context.invoked_subcommand:
        running = running.get_command(context, context.invoked_subcommand) or running
    options = _list_options(running, context)
    flags = _rank_flags(options, name)
    return (
        flags[0] if flags else find_format_flag(name, getattr(running, "format_ways", ()), options)
    )


def find_given_flag(name: str) -> tuple[click.Context, str] | None:
    """Return the context and the flag by which a value of a library's option was given.

    None if it came from elsewhere than the command line.
    """
    root = click.get_current_context(silent=True)
    context = None if root is None else root.find_root().meta.get(_CONTEXT)
    if context is None:
        return None
    given = [
        one
        for one in _list_options(context.command, context)
        if context.get_parameter_source(one.name or "") is ParameterSource.COMMANDLINE
    ]
    flags = _rank_flags(given, name)
    return (context, flags[0]) if flags else None


def _list_options(of: click.Command, context: click.Context) -> list[click.Option]:
    return [
        one
        for one in of.get_params(context)
        if isinstance(one, click.Option) and one.name and one.opts[0].startswith("--")
    ]


def _rank_flags(options: list[click.Option], name: str) -> list[str]:
    """Return the flags of those options that are that of the library with a name, nearest first."""
    ranked = []
    for one in options:
        plain = one.opts[0].removeprefix("--").replace("-", "_")
        sets = getattr(one, "sets", ())
        ways = (getattr(one, "instead", "") == name, plain == name, one.name == name, name in sets)
        if any(ways):
            ranked.append((ways.index(True), one.opts[0]))
    return [flag for _, flag in sorted(ranked)]
