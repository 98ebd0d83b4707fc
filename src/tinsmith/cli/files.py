"""Files in and out: what was asked for on the command line, handed to the package io."""

from __future__ import annotations

import sys
import tempfile
from dataclasses import asdict, dataclass
from inspect import signature
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

import click

from .._sentences import counted
from .output.console import emit_file
from .output.failures import Failure, note_written
from .paths import STANDARD, Named, name_file, require_separate

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ..io import Format
    from ..terrain import Features, Raster, Table
    from ..tin import TIN, Survey
    from .options import Reading, Triangulating, Writing
    from .output.console import Console

    Product = TIN | Survey | Features | Raster | Table

__all__ = [
    "Output",
    "add_lines",
    "build_tin",
    "describe_written",
    "list_inputs",
    "open_standard_input",
    "plan_outputs",
    "read_input",
    "read_tin",
    "require_picture",
    "write_figure",
    "write_outputs",
    "write_text",
]

_TEXT_FORMATS = ("delimited", "geojson", "obj", "csv", "json")
"""Formats that a terminal can show."""


@dataclass(frozen=True)
class Output:
    """A file to write: where, as what, how; standard output also stands for a suffix."""

    path: Path
    format: Format
    options: dict[str, Any]
    suffix: str = ""


def read_input(path: Path, reading: Reading, console: Console) -> Survey | TIN:
    """Read points or a TIN, showing progress."""
    from ..io import read
    from ..io.reading import read_stream
    from ..tin import Bounds

    options = {name: value for name, value in asdict(reading).items() if value is not None}
    if reading.window is not None:
        options["window"] = Bounds(*reading.window)
    with console.steps() as steps, steps.step(f"Reading {name_file(Path(path.name))}"):
        if path == STANDARD:
            return read_stream(open_standard_input(), name_file(path), **options)
        found: Survey | TIN = read(path, **options)
        return found


def open_standard_input() -> IO[bytes]:
    """Return standard input, to be read once.

    Raises
    ------
    Failure
        If it is closed or a terminal.
    """
    if sys.stdin is None:
        raise Failure("Standard input is closed: pipe the data in, or name a file.")
    if sys.stdin.isatty():
        raise Failure("Standard input is a terminal: pipe the data in, or name a file.")
    return sys.stdin.buffer


def add_lines(survey: Survey, how: Triangulating, console: Console) -> Survey:
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


def build_tin(survey: Survey, how: Triangulating, console: Console) -> TIN:
    """Build the TIN of a survey, showing progress; rows at fault are named by point number too."""
    from ..errors import PointsError
    from ..tin import triangulate

    try:
        with console.steps() as steps, steps.step(f"Triangulating {counted(len(survey), 'point')}"):
            return triangulate(survey, **how.method)
    except PointsError as error:
        raise Failure(f"{error}{_name_rows(survey, error.rows)}") from error


def _name_rows(survey: Survey, rows: Sequence[int]) -> str:
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
    survey = add_lines(found, how, console)
    return build_tin(survey, how, console), survey


def list_inputs(file: Path, how: Triangulating | None = None) -> list[Named]:
    """Return all files that a command reads."""
    from ..io.vector.survey_lines import split_layer

    inputs = [Named(file, "the input")]
    given = {} if how is None else how.line_files
    for flag, paths in given.items():
        inputs += [Named(split_layer(path)[0], f"the file of {flag}") for path in paths]
    return inputs


def plan_outputs(
    paths: Sequence[Path],
    writing: Writing,
    *,
    inputs: Sequence[Named],
    console: Console,
    report: Path | None = None,
    kinds: Sequence[str] = ("TIN", "Survey"),
) -> list[Output]:
    """Choose the format of every output, and compare all paths, before any work is done.

    Parameters
    ----------
    paths : sequence of Path
    writing : Writing
    inputs : sequence of Named
    console : Console
    report : Path, optional
    kinds : sequence of str
        What will be written is one of these: "TIN", "Survey", "Features", "Raster", "Table".

    Raises
    ------
    FormatError
        If a suffix is unknown, a format cannot be written, or none takes an option given.
    WriteError
        If an output cannot be written where it should be.
    click.UsageError
        If a file is named twice, or standard output gets more than one thing.
    """
    outputs = [Named(path, "--output") for path in paths]
    if report is not None:
        outputs.append(Named(report, "--report"))
    require_separate(inputs, outputs)
    formats = [_choose_output_format(path, writing.output_format, kinds) for path in paths]
    given: dict[str, Any] = {} if writing.kind is None else {"kind": writing.kind}
    if writing.projected:
        given["projected"] = True
    taken = [set(given).intersection(one.options("write")) for one in formats]
    _require_taken(set(given).difference(*taken) if taken else set(given))
    _require_free_stdout(paths, formats, console)
    return [
        Output(path, one, {name: given[name] for name in names}, _choose_suffix(one, writing))
        for path, one, names in zip(paths, formats, taken, strict=True)
    ]


def require_picture(
    path: Path,
    *,
    place: str,
    inputs: Sequence[Named],
    suffixes: Sequence[str] = (".png",),
) -> None:
    """Refuse a picture that would overwrite an input, has another suffix, or cannot be written.

    Parameters
    ----------
    path : Path
    place : str
        The option that names it.
    inputs : sequence of Named
    suffixes : sequence of str

    Raises
    ------
    click.UsageError
        If the picture is an input.
    Failure, WriteError
        If its name ends otherwise, or it cannot be written there.
    """
    require_separate(inputs, [Named(path, place)])
    if path.suffix.lower() not in suffixes:
        raise Failure(
            f"Cannot write a picture to '{path}': its name must end in {', '.join(suffixes)}."
        )


def write_figure(figure: Any, path: Path, *, dpi: int) -> None:
    """Write a figure of matplotlib, whole or not at all, with no version in its bytes."""
    from .._atomic import replacing

    with replacing(path) as picture:
        figure.savefig(picture, format="png", dpi=dpi, metadata={"Software": None})
    note_written(path)


def _choose_suffix(one: Format, writing: Writing) -> str:
    """Return the suffix that --output-format names, or the first of the format."""
    named = f".{(writing.output_format or '').strip().lower().lstrip('.')}"
    return named if named in one.suffixes else one.suffixes[0]


def _require_free_stdout(paths: Sequence[Path], formats: list[Format], console: Console) -> None:
    """Refuse more than one thing on standard output, and bytes on a terminal."""
    chosen = [one for path, one in zip(paths, formats, strict=True) if path == STANDARD]
    if not chosen:
        return
    if console.as_json:
        raise click.UsageError("--json and '-o -' both write to standard output: choose one.")
    if chosen[0].name not in _TEXT_FORMATS and sys.stdout is not None and sys.stdout.isatty():
        raise click.UsageError(
            f"{chosen[0].name} is no text for a terminal: send standard output to a file or a pipe."
        )


def _require_taken(left_over: set[str]) -> None:
    if left_over:
        raise click.UsageError(f"No output takes the option --{min(left_over)}: GeoJSON does.")


def _choose_output_format(path: Path, name: str | None, kinds: Sequence[str]) -> Format:
    from ..io.registry import find_writer

    if name is None and path == STANDARD:
        raise click.UsageError("'-o -' needs --output-format: standard output has no suffix.")
    return find_writer(path, name, kinds)


def write_outputs(obj: Product, outputs: Sequence[Output], console: Console) -> None:
    """Write every output, showing progress."""
    with console.steps() as steps:
        for output in outputs:
            with steps.step(f"Writing {output.path.name}") as progress:
                options = dict(output.options)
                if _shows_progress(output.format):
                    options["progress"] = progress
                if output.path == STANDARD:
                    _write_to_stdout(obj, output, options)
                    continue
                _write_file(obj, output.path, output.format, options)
            note_written(output.path)


def _write_file(obj: Product, path: Path, one: Format, options: dict[str, Any]) -> None:
    from ..io import write

    write(obj, path, format=one.name, **options)


def _write_to_stdout(obj: Product, output: Output, options: dict[str, Any]) -> None:
    """Write a whole file first, so that nothing comes if it fails."""
    with tempfile.TemporaryDirectory(prefix="tinsmith-") as folder:
        path = Path(folder) / f"output{output.suffix}"
        _write_file(obj, path, output.format, options)
        emit_file(path)


def describe_written(outputs: Sequence[Output]) -> str:
    """Return what was written for a summary, a line each."""
    from .output.summaries import describe_file_size

    return "\n".join(
        "standard output"
        if one.path == STANDARD
        else f"{name_file(one.path)} ({describe_file_size(one.path)})"
        for one in outputs
    )


def _shows_progress(one: Format) -> bool:
    from importlib import import_module

    module, _, function = (one.write or "").partition(":")
    return "progress" in signature(getattr(import_module(module), function)).parameters


def write_text(path: Path, text: str) -> None:
    """Write a whole text file or none."""
    from .._atomic import replacing

    with replacing(path, binary=False) as file:
        file.write(text)
