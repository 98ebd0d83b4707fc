"""Commands: what they take, and how their help lists it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from .format_options import list_format_options
from .parameters import input_file, output_files

if TYPE_CHECKING:
    from collections.abc import Callable

__all__ = ["OF_BUILDING", "Command", "command", "file_command"]

_OWN = "Options"
_BUILDER = "build"
OF_BUILDING = ("Triangulation", "Lines and areas", "Codes of points")
"""Subjects of options that only the help of one command lists: of points that become a TIN."""
_OF_FORMATS = "tinsmith.options_of_formats"


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
        """Read the arguments."""
        lists = ctx.resilient_parsing or bool({"-h", "--help"} & {*args})
        ctx.meta[_OF_FORMATS] = list_format_options(
            self.params, self.format_ways, args, lists=lists
        )
        if not ctx.resilient_parsing:
            _require_once(self.make_parser(ctx).parse_args(args=list(args))[2])
        return super().parse_args(ctx, args)

    def format_options(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the options under their subjects."""
        sections: dict[str, list[tuple[str, str]]] = {_OWN: []}
        for one in self.get_params(ctx):
            record = one.get_help_record(ctx) if isinstance(one, click.Option) else None
            subject = getattr(one, "subject", _OWN)
            if record is not None and (subject not in OF_BUILDING or self.name == _BUILDER):
                sections.setdefault(subject, []).append(record)
        for heading in sections:
            with formatter.section(heading):
                formatter.write_dl(sections[heading])

    def format_epilog(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Tell where the options are listed that this help leaves out."""
        left = list(dict.fromkeys(getattr(one, "subject", _OWN) for one in self.params))
        left = [one for one in left if one in OF_BUILDING and self.name != _BUILDER]
        text = ""
        if left:
            text = (
                f"Taken too, for points from which a TIN is built: {', '.join(left).lower()}, as "
                f"'tinsmith {_BUILDER} --help' lists them. "
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


def _require_once(given: list[click.Parameter]) -> None:
    """Refuse an option that was given more often than it is looked at."""
    for one in {id(one): one for one in given}.values():
        is_single = isinstance(one, click.Option) and not (one.multiple or one.is_flag or one.count)
        if is_single and sum(other is one for other in given) > 1:
            raise click.UsageError(
                f"{max(one.opts, key=len)} is given several times: it takes one."
            )


def command(function: Callable[..., Any]) -> click.Command:
    """Make a command of a function."""
    return click.command(cls=Command)(function)


def file_command(function: Callable[..., Any]) -> click.Command:
    """Make a command that reads one file, and writes what it makes of it to others."""
    return command(input_file("file")(output_files(function)))
