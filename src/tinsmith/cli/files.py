"""Files in and out: what was asked for on the command line, handed to the io room."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from inspect import signature
from typing import TYPE_CHECKING, Any

import click

from .failures import Failure, note_written

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from ..io import Format
    from ..tin import TIN, Survey
    from .console import Console
    from .options import Reading, Triangulating, Writing

__all__ = [
    "Output",
    "plan_outputs",
    "read_input",
    "read_tin",
    "triangulated",
    "with_lines",
    "write_outputs",
    "write_text",
]


@dataclass(frozen=True)
class Output:
    """A file to write: where, as what, and how."""

    path: Path
    format: Format
    options: dict[str, Any]


def read_input(path: Path, reading: Reading, console: Console) -> Survey | TIN:
    """Read points or a TIN, showing progress."""
    from ..io import read
    from ..tin import Bounds

    options = {name: value for name, value in asdict(reading).items() if value is not None}
    if reading.window is not None:
        options["window"] = Bounds(*reading.window)
    with console.steps() as steps, steps.step(f"Reading {path.name}"):
        return read(path, **options)


def with_lines(survey: Survey, how: Triangulating, console: Console) -> Survey:
    """Add the lines of the points' codes and of files to a survey, showing progress.

    Raises
    ------
    click.UsageError
        If there is a height of water, but no water.
    """
    from ..io import lines_from_codes
    from ..io import with_lines as with_lines_of_files

    if how.water_z is not None and not how.water:
        raise click.UsageError("--water-z needs --water: a file of the polygons that it is for.")
    if how.codes:
        survey = lines_from_codes(survey)
    if not how.files:
        return survey
    with console.steps() as steps, steps.step("Reading lines"):
        return with_lines_of_files(survey, **how.files)


def triangulated(survey: Survey, how: Triangulating, console: Console) -> TIN:
    """Build the TIN of a survey, showing progress; rows at fault are named by point number too."""
    from ..tin import PointsError, triangulate

    try:
        with console.steps() as steps, steps.step(f"Triangulating {len(survey):,} points"):
            return triangulate(survey, **how.method)
    except PointsError as error:
        raise Failure(f"{error}{_row_names(survey, error.rows)}") from error


def _row_names(survey: Survey, rows: Sequence[int]) -> str:
    if not rows:
        return ""
    numbers = survey.attributes.get("number")
    if numbers is None:
        return " Rows are points of the file, counted from 0."
    return f" Their point numbers: {', '.join(str(numbers[row]) for row in rows)}."


def read_tin(
    path: Path, reading: Reading, how: Triangulating, console: Console
) -> tuple[TIN, Survey | None]:
    """Read a TIN, or points and build theirs; the points are None for a file that holds a TIN."""
    from ..tin import TIN

    found = read_input(path, reading, console)
    if isinstance(found, TIN):
        if how.shaping:
            raise Failure(
                f"'{path}' holds a TIN already, and {how.shaping[0]} needs points to build from: "
                "'tinsmith edit' adds lines to a TIN."
            )
        return found, None
    survey = with_lines(found, how, console)
    return triangulated(survey, how, console), survey


def plan_outputs(paths: Sequence[Path], writing: Writing, *, source: Path) -> list[Output]:
    """Choose the format of every output before any work is done.

    Raises
    ------
    FormatError
        If a suffix is unknown, a format cannot be written, or none takes an option given.
    click.UsageError
        If an output is named twice, or is the input.
    """
    _require_distinct([*paths, source])
    formats = [_output_format(path, writing.output_format) for path in paths]
    given: dict[str, Any] = {} if writing.kind is None else {"kind": writing.kind}
    if writing.projected:
        given["projected"] = True
    taken = [set(given).intersection(one.options("write")) for one in formats]
    _require_taken(set(given).difference(*taken) if taken else set(given))
    return [
        Output(path, one, {name: given[name] for name in names})
        for path, one, names in zip(paths, formats, taken, strict=True)
    ]


def require_picture(path: Path, *, source: Path) -> None:
    """Refuse a picture that would overwrite the input, or is no PNG.

    Raises
    ------
    click.UsageError
        If the picture is the input.
    Failure
        If its name does not end in .png.
    """
    if path.resolve() == source.resolve():
        raise click.UsageError(f"'{path}' is the input: it cannot be the output too.")
    if path.suffix.lower() != ".png":
        raise Failure(f"Cannot write a picture to '{path}': its name must end in .png.")


def write_figure(figure: Any, path: Path, *, dpi: int) -> None:
    """Write a figure of matplotlib, whole or not at all, with no version in its bytes."""
    from ..io.atomic import replacing

    with replacing(path) as picture:
        figure.savefig(picture, format="png", dpi=dpi, metadata={"Software": None})
    note_written(path)


def _require_distinct(paths: Sequence[Path]) -> None:
    places = [path.resolve() for path in paths]
    for place, path in zip(places[:-1], paths[:-1], strict=True):
        if place == places[-1]:
            raise click.UsageError(f"'{path}' is the input: it cannot be the output too.")
        if places.count(place) > 1:
            raise click.UsageError(f"'{path}' is named twice as output.")


def _require_taken(left_over: set[str]) -> None:
    if left_over:
        raise click.UsageError(f"No output takes the option --{min(left_over)}: GeoJSON does.")


def _output_format(path: Path, name: str | None) -> Format:
    from ..io import FormatError, find_format, known_formats

    if name is not None:
        return find_format(name)
    able = [one for one in known_formats() if one.write is not None]
    for one in able:
        if path.suffix.lower() in one.suffixes:
            return one
    suffixes = tuple(suffix for one in able for suffix in one.suffixes)
    what = f"the suffix '{path.suffix}'" if path.suffix else "no suffix"
    raise FormatError(
        f"Cannot write '{path}': no format that can be written has {what}; "
        f"{', '.join(suffixes)} can be written.",
        known=suffixes,
    )


def write_outputs(obj: TIN | Survey, outputs: Sequence[Output], console: Console) -> None:
    """Write every output, showing progress."""
    from ..io import write

    with console.steps() as steps:
        for output in outputs:
            with steps.step(f"Writing {output.path.name}") as progress:
                options = dict(output.options)
                if _shows_progress(output.format):
                    options["progress"] = progress
                write(obj, output.path, format=output.format.name, **options)
            note_written(output.path)


def _shows_progress(one: Format) -> bool:
    from importlib import import_module

    module, _, function = (one.write or "").partition(":")
    return "progress" in signature(getattr(import_module(module), function)).parameters


def write_text(path: Path, text: str) -> None:
    """Write a whole text file or none."""
    from ..io.atomic import replacing

    with replacing(path, binary=False) as file:
        file.write(text)
