"""``tinsmith profile``: surfaces cut along a line, or square to it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Any

import click

from ..options import (
    console_options,
    output_files,
    product_options,
    reading_options,
    triangulating_options,
)
from ..output.console import plain
from ..output.failures import Failure
from ..paths import INPUT, LINES, Named, title_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ...terrain import Features, Table
    from ...tin import TIN
    from ..files import Output
    from ..options import Reading, Triangulating, Writing
    from ..output.console import Console, Field

__all__ = ["profile"]

_PICTURE = ".png"
_TABLES = (".csv", ".tsv", ".txt", ".json")
Pair = tuple[float, float]


@dataclass(frozen=True, kw_only=True)
class _Line:
    """Where to cut."""

    file: Path | None
    start: Pair | None
    end: Pair | None

    def require_one(self) -> None:
        """Refuse a line that is given twice, or by halves."""
        ends = (self.start is not None) + (self.end is not None)
        if (self.file is None) == (ends == 0) or ends == 1:
            raise click.UsageError("A line is needed: --line FILE, or --from X Y and --to X Y.")


@dataclass(frozen=True, kw_only=True)
class _Outputs:
    """What to write: tables, lines in space, and pictures."""

    tables: list[Output]
    lines: list[Output]
    pictures: list[Path]

    @property
    def paths(self) -> list[Path]:
        """All of them."""
        return [one.path for one in (*self.tables, *self.lines)] + self.pictures


@click.command(short_help="Cut surfaces along a line: tables, cross sections, a picture.")
@click.argument("files", nargs=-1, required=True, type=INPUT)
@output_files
@click.option("--line", "line_file", metavar="FILE", type=LINES, help="Vector file of the lines.")
@click.option("--from", "begin", metavar="X Y", nargs=2, type=float, help="Where a line begins.")
@click.option("--to", "end", metavar="X Y", nargs=2, type=float, help="Where it ends.")
@click.option(
    "--interval", metavar="LENGTH", type=float, help="Add a row at every multiple of this station."
)
@click.option(
    "--start", metavar="STATION", type=float, default=0.0, help="Station where the line begins."
)
@click.option(
    "--sections",
    metavar="INTERVAL WIDTH",
    nargs=2,
    type=float,
    help="Cut square to the line instead, at this interval and over this width.",
)
@click.option(
    "--name",
    "names",
    metavar="TEXT",
    multiple=True,
    help="Name of a surface, once for each; default its file's.",
)
@click.option(
    "--exaggeration", metavar="FACTOR", type=float, help="Of the picture; chosen if absent."
)
@click.option("--title", metavar="TEXT", help="Of the picture; default the first file's name.")
@reading_options
@triangulating_options
@product_options
@console_options
def profile(
    files: tuple[Path, ...],
    outputs: tuple[Path, ...],
    line_file: Path | None,
    begin: Pair | None,
    end: Pair | None,
    names: tuple[str, ...],
    reading: Reading,
    how: Triangulating,
    writing: Writing,
    console: Console,
    **asked: Any,
) -> None:
    """Cut the TINs in FILES, or those of the points in them, along a line.

    A row wherever the line crosses an edge of a TIN, with the elevations of all of them. Tables go
    to .csv or .json, a picture to .png; cross sections also to .gpkg, .geojson and others as lines
    in space. Lines in another CRS are reprojected.

    \b
    Example:
      tinsmith profile sample_data/site_survey.csv --crs EPSG:32616 --codes
        --from 752690 4024225 --to 752850 4024330 -o profile.csv -o profile.png
    """  # noqa: D301 - click reads the control character
    started = perf_counter()
    line = _Line(file=line_file, start=begin, end=end)
    line.require_one()
    chosen = _names(files, names)
    planned = _plan(outputs, files, line_file, how, writing, console, asked["sections"])
    surfaces = _read_surfaces(files, chosen, reading, how, console)
    notes: list[str] = []
    lines = _lines(line, next(iter(surfaces.values())), notes)
    table, sections = _cut(surfaces, lines, bool(planned.lines), console, asked)
    figure = _draw(table, surfaces, files, asked) if planned.pictures else None
    _write(table, sections, figure, planned, console)
    notes += table.notes
    console.summarise(
        [
            *[("Surface", f"{name}: {_counts(tin)}") for name, tin in surfaces.items()],
            ("Rows", f"{len(table):,}"),
            *[("Note", note) for note in notes],
            *_written(planned),
            ("Time", f"{perf_counter() - started:.2f} s"),
        ]
    )
    if console.as_json:
        console.emit(plain(_facts(files, table, notes, planned)))


# ---------------------------------------------------------------- what is given


def _names(files: Sequence[Path], given: Sequence[str]) -> list[str]:
    names = list(given) or [title_of(file) or "surface" for file in files]
    if len(names) != len(files):
        raise click.UsageError(
            f"--name is given {len(names)} times for {len(files)} surfaces: name each once."
        )
    repeated = next((name for name in names if names.count(name) > 1), None)
    if repeated is not None:
        raise click.UsageError(f"Two surfaces are called '{repeated}': --name tells them apart.")
    return names


def _plan(
    outputs: Sequence[Path],
    files: Sequence[Path],
    line_file: Path | None,
    how: Triangulating,
    writing: Writing,
    console: Console,
    sections: Pair | None,
) -> _Outputs:
    """Choose what each output holds, before any work is done."""
    from ...io.vector.survey_lines import path_and_layer
    from ..files import inputs_of, plan_outputs
    from ..paths import require_separate

    inputs = [Named(file, "the input") for file in files] + inputs_of(files[0], how)[1:]
    if line_file is not None:
        inputs.append(Named(path_and_layer(line_file)[0], "the file of --line"))
    require_separate(inputs, [Named(path, "--output") for path in outputs])
    pictures = [path for path in outputs if path.suffix.lower() == _PICTURE]
    if pictures and sections is not None:
        raise click.UsageError(f"'{pictures[0]}' shows a profile: it has no --sections.")
    others = [path for path in outputs if path not in pictures]
    is_table = {path: sections is None or _is_table(path, writing) for path in others}

    def plan(kind: str, wanted: bool) -> list[Output]:
        paths = [path for path in others if is_table[path] is wanted]
        return plan_outputs(paths, writing, inputs=(), console=console, kinds=(kind,))

    return _Outputs(tables=plan("Table", True), lines=plan("Features", False), pictures=pictures)


def _is_table(path: Path, writing: Writing) -> bool:
    name = writing.output_format
    suffix = path.suffix if name is None else f".{name.strip().lstrip('.')}"
    return suffix.lower() in _TABLES


def _read_surfaces(
    files: Sequence[Path],
    names: Sequence[str],
    reading: Reading,
    how: Triangulating,
    console: Console,
) -> dict[str, TIN]:
    """Read TINs; what shapes a TIN is for the one file that holds points."""
    from ...tin import TIN
    from ..files import read_input, triangulated, with_lines

    found = [read_input(file, reading, console) for file in files]
    surveys = [one for one in found if not isinstance(one, TIN)]
    if how.shaping and len(surveys) != 1:
        raise Failure(
            f"{how.shaping[0]} needs one file of points, and there are {len(surveys)}: "
            "'tinsmith build' makes TINs of the others first."
        )
    return {
        name: one
        if isinstance(one, TIN)
        else triangulated(with_lines(one, how, console), how, console)
        for name, one in zip(names, found, strict=True)
    }


def _lines(line: _Line, tin: TIN, notes: list[str]) -> Any:
    from ...io import read_lines
    from ...io.vector.survey_lines import path_and_layer

    if line.file is None:
        return [line.start, line.end]
    path, layer = path_and_layer(line.file)
    return read_lines(path, crs=tin.crs, layer=layer, drape=True, notes=notes)


# ---------------------------------------------------------------- what is made


def _cut(
    surfaces: dict[str, TIN], lines: Any, in_space: bool, console: Console, asked: dict[str, Any]
) -> tuple[Table, Features | None]:
    """Return the rows, and the sections as lines in space if they are wanted."""
    from ...terrain import cross_sections, section_lines
    from ...terrain import profile as cut_profile

    given: Any = surfaces if len(surfaces) > 1 else next(iter(surfaces.values()))
    with console.steps() as steps, steps.step("Cutting"):
        if asked["sections"] is None:
            rows = cut_profile(given, lines, interval=asked["interval"], start=asked["start"])
            return rows, None
        interval, width = asked["sections"]
        how = {"interval": interval, "width": width, "start": asked["start"]}
        table = cross_sections(given, lines, **how)
        return table, section_lines(given, lines, **how) if in_space else None


def _draw(
    table: Table, surfaces: dict[str, TIN], files: Sequence[Path], asked: dict[str, Any]
) -> Any:
    from ...terrain import profile_picture

    crs = next((tin.crs for tin in surfaces.values() if tin.crs is not None), None)
    title = asked["title"] or f"Profile: {title_of(files[0])}"
    return profile_picture(table, exaggeration=asked["exaggeration"], title=title, crs=crs)


def _write(
    table: Table, sections: Features | None, figure: Any, planned: _Outputs, console: Console
) -> None:
    from ..files import write_figure, write_outputs

    write_outputs(table, planned.tables, console)
    if sections is not None:
        write_outputs(sections, planned.lines, console)
    for path in planned.pictures:
        with console.steps() as steps, steps.step("Drawing"):
            write_figure(figure, path, dpi=150)


def _counts(tin: TIN) -> str:
    from ..output.line_summaries import mesh_counts

    return mesh_counts(tin)


def _written(planned: _Outputs) -> list[Field]:
    from ..files import written_text
    from ..output.summaries import file_size

    texts = [written_text(group) for group in (planned.tables, planned.lines) if group]
    texts += [f"{path} ({file_size(path)})" for path in planned.pictures]
    return [("Written", "\n".join(texts))]


def _facts(
    files: Sequence[Path], table: Table, notes: Sequence[str], planned: _Outputs
) -> dict[str, Any]:
    """Describe the table: its columns, and the least and largest of those that are measured."""
    measured = [name for name, values in table.columns.items() if values.dtype.kind == "f"]
    return {
        "inputs": [str(file) for file in files],
        "rows": len(table),
        "columns": list(table.columns),
        "ranges": {name: _range(table[name]) for name in measured},
        "notes": list(notes),
        "outputs": [str(path) for path in planned.paths],
    }


def _range(values: Any) -> list[float | None]:
    known = values[values == values]
    return [float(known.min()), float(known.max())] if len(known) else [None, None]
