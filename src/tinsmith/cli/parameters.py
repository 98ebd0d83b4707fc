"""Parameters of commands by their kinds: a number, one of several words, a file."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import wraps
from typing import TYPE_CHECKING, Any, get_args

import click

from ..base.sentences import suggest
from .paths import INPUT, LINES, OUTPUT, STANDARD

if TYPE_CHECKING:
    from pathlib import Path

    from click.shell_completion import CompletionItem

Decorator = Callable[[Callable[..., Any]], Callable[..., Any]]


class LibraryOption(click.Option):
    """An option of a command that the library calls otherwise.

    It ``sets`` options of the library that have its value, where the command has no flag of that
    name, or stands ``instead`` of one, whatever other flag has that name.
    """

    def __init__(
        self, *declared: Any, sets: Sequence[str] = (), instead: str = "", **more: Any
    ) -> None:
        super().__init__(*declared, **more)
        self.sets = tuple(sets)
        self.instead = instead


def under(subject: str, *options: Decorator) -> tuple[Decorator, ...]:
    """Return options whose subject is a heading in the help of commands."""

    def tag(option: Decorator) -> Decorator:
        def decorate(function: Callable[..., Any]) -> Callable[..., Any]:
            decorated: Any = option(function)
            decorated.__click_params__[-1].subject = subject
            return decorated  # type: ignore[no-any-return]

        return decorate

    return tuple(map(tag, options))


class Words(click.Choice[str]):
    """One of a few words; the nearest one is named where another is given."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> str:
        """Return the word."""
        try:
            return str(super().convert(value, param, ctx))
        except click.BadParameter as error:
            text = f"{error.message}{suggest(str(value), self.choices)}"
            raise click.BadParameter(text, ctx, param) from None


class FormatName(click.ParamType[str]):
    """A format's name, which is looked up later; shells complete it. ``way``: "read" or "write"."""

    name = "format"

    def __init__(self, way: str) -> None:
        self._way = way

    def shell_complete(
        self,
        ctx: click.Context,  # noqa: ARG002 - click's signature
        param: click.Parameter,  # noqa: ARG002 - click's signature
        incomplete: str,
    ) -> list[CompletionItem]:
        """Return the names that begin so."""
        from click.shell_completion import CompletionItem

        from ..io import known_formats

        return [
            CompletionItem(one.name, help=one.description)
            for one in known_formats()
            if getattr(one, self._way) is not None and one.name.startswith(incomplete)
        ]


def number_option(
    flag: str,
    metavar: str,
    help: str,  # noqa: A002 - click's name
    *,
    name: str | None = None,
    type: Any = float,  # noqa: A002 - click's name
    default: float | None = None,
    **more: Any,
) -> Decorator:
    """Return an option for a number; a default is shown."""
    more |= {"metavar": metavar, "type": type, "help": help, "default": default}
    return click.option(flag, *_list(name), show_default=default is not None, **more)


def _list(name: str | None) -> list[str]:
    return [] if name is None else [name]


def numbers_option(flag: str, metavar: str, help: str) -> Decorator:  # noqa: A002 - click's name
    """Return an option for several numbers."""
    return click.option(flag, metavar=metavar, callback=parse_numbers, help=help)


def parsed(parse: Callable[[str, Any], Any]) -> Callable[..., Any]:
    """Make a callback of click of what takes a flag and its value; None, if none is given, stays.

    Values of options that may be given several times are tuples.
    """

    @wraps(parse)
    def callback(ctx: click.Context, param: click.Parameter, value: Any) -> Any:
        del ctx
        return None if value is None else parse(param.opts[0], value)

    return callback


@parsed
def parse_numbers(flag: str, value: str) -> list[float]:
    """Return numbers that are given with commas between them."""
    try:
        return [float(part) for part in value.split(",")]
    except ValueError:
        raise click.UsageError(
            f"Invalid {flag} '{value}': it must be numbers with commas between them."
        ) from None


def choice_option(
    flag: str,
    words: Any,
    help: str,  # noqa: A002 - click's name
    *,
    name: str | None = None,
    default: str | None = None,
) -> Decorator:
    """Return an option for one of the words of a Literal; a default is shown."""
    return click.option(
        flag,
        *_list(name),
        type=Words(get_args(words)),
        default=default,
        show_default=default is not None,
        help=help,
    )


def crs_option(flag: str, help: str) -> Decorator:  # noqa: A002 - click's name
    """Return an option for a CRS; one that does not exist is wrong usage."""
    return click.option(flag, metavar="CRS", callback=parse_crs, help=help)


@parsed
def parse_crs(flag: str, value: str) -> str:
    """Return the value, which must be a CRS that exists."""
    from ..base.crs import CRS
    from ..base.errors import CrsError

    try:
        CRS.of(value)
    except CrsError as error:
        raise refuse_value(flag, error) from error
    return value


@parsed
def parse_columns(_: str, value: str) -> str | dict[str, str | int]:
    """Return roles with the name or number of their columns if there are equals signs."""
    if "=" not in value:
        return value
    pairs = [pair.partition("=") for pair in value.split(",")]
    if not all(role.strip() and which.strip() for role, _, which in pairs):
        raise click.BadParameter(f"'{value}' mixes roles with names: easting=X,northing=Y,...")
    return {
        role.strip(): int(which) if which.strip().isdecimal() else which.strip()
        for role, _, which in pairs
    }


def refuse_value(flag: str, error: Exception, more: str = "") -> click.UsageError:
    """Return wrong usage, with the library's sentence on the value of an option, and more."""
    sentence = str(error)
    return click.UsageError(f"Invalid {flag}: {sentence[:1].lower()}{sentence[1:]}{more}")


def input_file(name: str, type: click.ParamType[Any] = INPUT) -> Decorator:  # noqa: A002 - click's
    """Return the argument for a file to read."""
    return click.argument(name, type=type)


def input_files(name: str) -> Decorator:
    """Return the argument for files to read, several of points being one survey."""
    return click.argument(name, type=INPUT, nargs=-1, required=True)


def output_option(help: str, *, required: bool = False) -> Decorator:  # noqa: A002 - click's name
    """Return the option for the files to write."""
    return click.option(
        "-o",
        "--output",
        "outputs",
        metavar="FILE",
        type=INPUT,
        multiple=True,
        required=required,
        help=f"{help} May be given several times.",
    )


output_files = output_option(
    "File to write; its suffix chooses the format. An existing file is replaced. "
    "- is standard output, with --output-format.",
    required=True,
)


def position_option(flag: str, name: str, help: str, *, multiple: bool = False) -> Decorator:  # noqa: A002 - click's name
    """Return an option for an easting and a northing."""
    return click.option(
        flag, name, metavar="X Y", nargs=2, type=float, multiple=multiple, help=help
    )


def file_option(
    flag: str,
    help: str,  # noqa: A002 - click's name
    *,
    name: str | None = None,
    type: click.ParamType[Any] = LINES,  # noqa: A002 - click's name
    required: bool = False,
) -> Decorator:
    """Return an option for one more file to read, of lines or points if nothing else is said."""
    how: dict[str, Any] = {"metavar": "FILE", "type": type, "required": required, "help": help}
    return click.option(flag, *_list(name), **how)


def report_option(help: str) -> Decorator:  # noqa: A002 - click's name
    """Return the option for a report as JSON."""
    return click.option("--report", metavar="FILE", type=OUTPUT, callback=_require_json, help=help)


@parsed
def _require_json(_: str, value: Path) -> Path:
    """Refuse a report whose name says that it is something else."""
    if value != STANDARD and value.suffix.lower() != ".json":
        raise click.BadParameter(f"a report is JSON, and the name '{value}' does not end in .json.")
    return value


def picture_option(help: str) -> Decorator:  # noqa: A002 - click's name
    """Return the option for the one picture that a command writes."""
    return click.option("-o", "--output", metavar="FILE", type=OUTPUT, help=help)
