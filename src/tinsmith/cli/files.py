"""Files in and out: what was asked for on the command line, handed to the package io."""

from __future__ import annotations

import os
import sys
from dataclasses import dataclass, replace
from inspect import signature
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

import click

from ..base.atomic import scratch_folder
from ..base.sentences import counted, suggest
from .flags import name_flags
from .format_options import make_flag
from .output.console import emit_file
from .output.failures import Failure, note_written
from .parameters import refuse_value
from .paths import STANDARD, Named, describe_leftovers, name_file, require_separate, split_output

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from ..io import Format
    from ..terrain import Features, Raster, Table
    from ..tin import TIN, Survey
    from .options import Coding, Reading, Triangulating, Writing
    from .output.console import Console

    Product = TIN | Survey | Features | Raster | Table

__all__ = [
    "Output",
    "add_coded_lines",
    "add_lines",
    "build_tin",
    "describe_written",
    "list_inputs",
    "note_found",
    "note_surfaces",
    "open_standard_input",
    "plan_outputs",
    "read_input",
    "read_inputs",
    "read_tin",
    "read_tin_of_files",
    "require_picture",
    "write_figure",
    "write_outputs",
    "write_text",
]


@dataclass(frozen=True)
class Output:
    """A file to write: where, as what, how; standard output also stands for a suffix."""

    path: Path
    formats: dict[str, Format]
    """By what may be written, such as "TIN"."""
    options: dict[str, Any]
    """Options given, of which each format takes its own."""
    suffix: str = ""
    layer: str | None = None
    """Name of the layer, of a file of layers; None for that of the product."""

    @property
    def options_taken(self) -> set[str]:
        """Names of the options that one of the formats has."""
        return {name for one in self.formats.values() for name in one.options("write")}


def read_input(path: Path, reading: Reading, console: Console) -> Survey | TIN:
    """Read points or a TIN, showing progress, and reproject them if that is asked for."""
    from ..io import reproject

    _require_format("--format", reading.format)
    target = reading.to_crs
    text = f"Reading {name_file(Path(path.name))}"
    with console.steps() as steps, steps.step(text) as progress:
        if target is None:
            return _read_once(path, reading, progress)
        return reproject(_read_to_reproject(path, reading, target), target)


def read_inputs(paths: Sequence[Path], reading: Reading, console: Console) -> Survey | TIN:
    """Read files as one survey, or a single one as what it is; as :func:`read_input`."""
    from ..io.reading import join_files

    found = [read_input(path, reading, console) for path in paths]
    if len(found) == 1:
        return found[0]
    return join_files(found, [Path(name_file(path)) for path in paths])


def _read_once(
    path: Path, reading: Reading, progress: Callable[[float], None] | None = None
) -> Survey | TIN:
    from ..io.reading import read_stream, read_with_fallbacks

    asked = reading.given
    fallbacks = {
        name: value for name, value in reading.fallbacks.items() if name not in reading.options
    }
    if path == STANDARD:
        asked.pop("remote", None)
        return read_stream(open_standard_input(), name_file(path), fallbacks, **asked)
    return read_with_fallbacks(path, fallbacks, **asked, progress=progress)


def _read_to_reproject(path: Path, reading: Reading, target: str) -> Survey | TIN:
    """Read in the input's own CRS; one in degrees, which no TIN has, in the one that is wanted."""
    from ..io.reprojection.placement import DegreesError

    try:
        return _read_once(path, reading)
    except DegreesError:
        if path == STANDARD:
            raise  # it is read only once
        source = reading.crs if reading.source_crs is None else reading.source_crs
        return _read_once(path, replace(reading, crs=target, source_crs=source))


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


def add_coded_lines(survey: Survey, how: Coding) -> Survey:
    """Add the lines of the points' codes to a survey, if they are asked for.

    A tolerance of curves or an order of shots without codes is wrong usage.
    """
    for flag in ("arc_tolerance", "shot_order"):
        if getattr(how, flag) is not None and not how.has_codes:
            name = flag.replace("_", "-")
            raise click.UsageError(f"--{name} needs --codes, --code-table or --code-style.")
    if not how.has_codes:
        return survey
    from ..io import lines_from_codes

    return lines_from_codes(survey, **how.coding)


def add_lines(survey: Survey, how: Triangulating, console: Console) -> Survey:
    """Add the lines of the points' codes and of files to a survey, showing progress.

    A height of water without water is wrong usage.
    """
    if how.water_z is not None and not how.water:
        raise click.UsageError("--water-z needs --water: a file of the polygons that it is for.")
    survey = add_coded_lines(survey, how)
    if not how.files:
        return survey
    from ..io import with_lines as with_lines_of_files

    with console.steps() as steps, steps.step("Reading lines"):
        return with_lines_of_files(survey, **how.files)


def build_tin(survey: Survey, how: Triangulating, console: Console) -> TIN:
    """Build the TIN of a survey, showing progress; rows at fault are named by point number too."""
    from ..base.errors import PointsError
    from ..tin import triangulate

    try:
        text = f"Triangulating {counted(len(survey), 'point')}"
        with console.steps() as steps, steps.step(text) as progress:
            return triangulate(survey, **how.method, progress=progress)
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
    return read_tin_of_files((path,), reading, how, console)


def read_tin_of_files(
    paths: Sequence[Path], reading: Reading, how: Triangulating, console: Console
) -> tuple[TIN, Survey | None]:
    """Read a TIN, or the points of several files and build theirs; as :func:`read_tin`."""
    from ..tin import TIN

    found = read_inputs(paths, reading, console)
    if isinstance(found, TIN):
        if how.shaping:
            raise Failure(
                f"'{paths[0]}' holds a TIN already, and {how.shaping[0]} needs points to build "
                "from: 'tinsmith edit' adds lines to a TIN."
            )
        note_surfaces([found], console)
        return found, None
    survey = add_lines(found, how, console)
    tin = build_tin(survey, how, console)
    note_surfaces([tin], console)
    return tin, survey


def note_found(found: Survey | TIN, console: Console) -> None:
    """Take note of what is known of what was read."""
    from ..tin import TIN
    from ..tin.report import describe_skipped

    if isinstance(found, TIN):
        note_surfaces([found], console)
    else:
        console.note([*describe_skipped(found.skipped), *found.notes])


def note_surfaces(surfaces: Sequence[TIN], console: Console) -> None:
    """Take note of what is known of surfaces, showing progress, for summary and record."""
    from ..base.products import notes_of_surfaces

    with console.step("Looking for blunders and gaps"):
        console.note(notes_of_surfaces(surface.snapshot() for surface in surfaces))


def list_inputs(*files: Path, how: Coding | None = None) -> list[Named]:
    """Return all files that a command reads."""
    inputs = [Named(file, "the input") for file in files]
    if how is not None and how.code_table is not None:
        inputs.append(Named(how.code_table, "the file of --code-table"))
    given = getattr(how, "line_files", {})
    for flag, paths in given.items():
        if not paths:
            continue
        from ..io.vector.survey_lines import split_layer

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

    What will be written is one of the ``kinds``: "TIN", "Survey", "Features", "Raster", "Table".

    Raises
    ------
    FormatError
        If a suffix is unknown, a format cannot be written, or none takes an option given.
    WriteError
        If an output cannot be written where it should be.
    click.UsageError
        If a file is named twice, or standard output gets more than one thing.
    """
    from ..io.registry.options import find_option_not_taken

    placed = [split_output(path) for path in paths]
    outputs = [Named(path, "--output") for path, layer in placed if layer is None]
    outputs += _list_layered(placed, inputs)
    if report is not None:
        outputs.append(Named(report, "--report"))
    given = writing.options
    more = [Named(file, make_flag(name, "write")) for name, file in given.items()]
    require_separate([*inputs, *(one for one in more if isinstance(one.path, Path))], outputs)
    console.note(describe_leftovers(path for path, _ in placed))
    planned = [
        Output(path, formats, given, _choose_suffix(formats, writing), layer)
        for path, layer, formats in (
            (path, layer, _choose_output_formats(path, writing.output_format, kinds))
            for path, layer in placed
        )
    ]
    _require_layered(planned)
    left = find_option_not_taken(given, [one.options_taken for one in planned])
    if left is not None:
        raise _describe_option_not_taken(left)
    _require_free_stdout(planned, console)
    return planned


def _list_layered(
    placed: Sequence[tuple[Path, str | None]], inputs: Sequence[Named]
) -> list[Named]:
    """Return outputs that name a layer, but for those in a file that is read: it keeps the rest."""
    read = {os.path.realpath(one.path) for one in inputs}
    files = {os.path.realpath(path): path for path, layer in placed if layer is not None}
    return [Named(path, "--output") for real, path in files.items() if real not in read]


def _require_layered(planned: Sequence[Output]) -> None:
    """Refuse the name of a layer for a format that has none, and two outputs of one layer."""
    seen = set()
    for one in planned:
        if one.layer is None:
            continue
        if not any(able.has_layers for able in one.formats.values()):
            what = next(iter(one.formats.values())).description
            raise click.UsageError(f"'{one.path}:{one.layer}': {what} takes no name of a layer.")
        if (one.path, one.layer) in seen:
            raise click.UsageError(f"The layer '{one.layer}' of '{one.path}' is named twice.")
        seen.add((one.path, one.layer))


def require_picture(
    path: Path,
    *,
    place: str,
    inputs: Sequence[Named],
    suffixes: Sequence[str] = (),
) -> None:
    """Refuse a picture that would overwrite an input, has another suffix, or cannot be written.

    ``place`` is the option that names it; ``suffixes`` are those of pictures if none are given.

    Raises
    ------
    click.UsageError
        If the picture is an input, or its name ends otherwise.
    WriteError
        If it cannot be written there.
    """
    from ..terrain.drawing.pictures import PICTURE_SUFFIXES

    require_separate(inputs, [Named(path, place)])
    known = suffixes or PICTURE_SUFFIXES
    if path.suffix.lower() not in known:
        raise click.UsageError(
            f"Cannot write a picture to '{path}': its name must end in {', '.join(known)}."
        )


def write_figure(figure: Any, path: Path, *, dpi: int) -> None:
    """Write a figure of matplotlib, whole or not at all."""
    from ..terrain.drawing.pictures import save_figure

    save_figure(figure, path, dpi=dpi)
    note_written(path)


def _choose_suffix(formats: dict[str, Format], writing: Writing) -> str:
    """Return the suffix that --output-format names, or the first of the format."""
    suffixes = [suffix for one in formats.values() for suffix in one.suffixes]
    named = f".{(writing.output_format or '').strip().lower().lstrip('.')}"
    return named if named in suffixes else next(iter(suffixes), "")


def _require_free_stdout(planned: Sequence[Output], console: Console) -> None:
    """Refuse more than one thing on standard output, and bytes on a terminal."""
    chosen = next((one for one in planned if one.path == STANDARD), None)
    if chosen is None:
        return
    if console.as_json:
        raise click.UsageError("--json and '-o -' both write to standard output: choose one.")
    for one in chosen.formats.values():
        if not one.is_text and sys.stdout is not None and sys.stdout.isatty():
            raise click.UsageError(
                f"The format '{one.name}' is binary: send standard output to a file or a pipe."
            )


def _describe_option_not_taken(name: str) -> click.UsageError:
    from ..io import known_formats

    takers = [one.name for one in known_formats() if name in one.options("write")]
    flag = make_flag(name, "write")
    return click.UsageError(
        f"No output takes the option {flag}: "
        + (f"only {', '.join(takers)} can." if takers else "no format can.")
    )


def _require_format(flag: str, name: str | None) -> None:
    """Refuse a name that no format has: that is wrong usage, whatever the data."""
    from ..base.errors import FormatError
    from ..io.registry.lookup import find_format

    try:
        if name is not None:
            find_format(name)
    except FormatError as error:
        raise refuse_value(flag, error, suggest(name or "", error.known)) from error


def _choose_output_formats(path: Path, name: str | None, kinds: Sequence[str]) -> dict[str, Format]:
    from ..base.errors import FormatError
    from ..io.registry.lookup import find_writers, known_formats, list_claims

    _require_format("--output-format", name)
    if name is None and path == STANDARD:
        raise click.UsageError("'-o -' needs --output-format: standard output has no suffix.")
    try:
        return find_writers(path, name, kinds)
    except FormatError as error:
        if name is not None or list_claims(known_formats(), path):
            raise
        sentence = name_flags(str(error), format="--output-format")
        raise click.UsageError(sentence) from error


def write_outputs(obj: Product, outputs: Sequence[Output], console: Console) -> None:
    """Write every output, showing progress."""
    with console.steps() as steps:
        for output in outputs:
            one = _find_format_of(obj, output)
            with steps.step(f"Writing {output.path.name}") as progress:
                taken = one.options("write")
                options = {name: output.options[name] for name in output.options if name in taken}
                if output.layer is not None:
                    options["layer"] = output.layer
                if "progress" in signature(one.load("write")).parameters:
                    options["progress"] = progress
                if output.path == STANDARD:
                    _write_to_stdout(obj, output, one, options)
                    continue
                _write_file(obj, output.path, one, options)
            note_written(output.path)


def _find_format_of(obj: Product, output: Output) -> Format:
    """Return the format for what there is to write after all."""
    from ..io.writing import find_kind

    kind = find_kind(obj, output.path)
    if kind in output.formats:
        return output.formats[kind]
    held = " or ".join(output.formats)
    ways = {
        "TIN": ": 'tinsmith build' makes a TIN of points.",
        "Raster": ": 'tinsmith raster' makes one of a surface.",
    }
    raise Failure(
        f"Cannot write '{output.path}': {next(iter(output.formats.values())).description} holds a "
        f"{held}, and there is a {kind}{ways.get(held, '.')}"
    )


def _write_file(obj: Product, path: Path, one: Format, options: dict[str, Any]) -> None:
    from ..io import write

    write(obj, path, format=one.name, **options)


def _write_to_stdout(obj: Product, output: Output, one: Format, options: dict[str, Any]) -> None:
    """Write a whole file first, so that nothing comes if it fails."""
    with scratch_folder() as folder:
        path = Path(folder) / f"output{output.suffix}"
        _write_file(obj, path, one, options)
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


def write_text(path: Path, text: str) -> None:
    """Write a whole text file or none."""
    from ..base.atomic import replacing

    with replacing(path, binary=False) as file:
        file.write(text)
