"""Outputs of a command: planned before any work is done, written by the package io."""

from __future__ import annotations

import os
import sys
from dataclasses import dataclass, field
from inspect import signature
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..base.atomic import replacing, scratch_folder
from ..base.sentences import suggest
from .command import name_flags
from .format_options import make_flag
from .output import Failure, emit_file, note_written
from .parameters import refuse_value
from .paths import STANDARD, Named, describe_leftovers, name_file, require_separate, split_output

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from ..io import Format
    from ..terrain import Features, Raster, Table
    from ..tin import TIN, Survey
    from .options import Writing
    from .output import Console

    Product = TIN | Survey | Features | Raster | Table

_DOTS = 150
DOCUMENTS = ("sheets", "report")
"""Kinds of what is drawn on sheets of paper."""
_WAYS = {
    "TIN": ": 'tinsmith build' makes a TIN of points.",
    "Raster": ": 'tinsmith raster' makes one of a surface.",
}


@dataclass(frozen=True)
class Output:
    """A file to write: where, as what, how; standard output also stands for a suffix."""

    path: Path
    formats: dict[str, Format]
    """By what may be written, such as "TIN"."""
    options: dict[str, Any]
    """Options given, of which each format takes its own."""
    suffix: str = ""
    """That --output-format names, or the first of the format."""
    layer: str | None = None
    """Name of the layer, of a file of layers; None for that of the product."""

    @property
    def options_taken(self) -> set[str]:
        """Names of the options that one of the formats has."""
        return {name for one in self.formats.values() for name in one.options("write")}


@dataclass(frozen=True, kw_only=True)
class Products:
    """Outputs by what they hold: tables, features, TINs and pictures."""

    console: Console
    outputs: dict[str, list[Output]]
    pictures: list[Path] = field(default_factory=list)
    tabulates: bool = False
    """Whether tables are those of the features' columns."""
    documents: list[Path] = field(default_factory=list)
    """Sheets or reports, whose pages may be files of their own."""
    pages: list[Path] = field(default_factory=list)
    """Files of documents that were written."""
    inputs: Sequence[Named] = ()
    """Files that are read."""

    def holds(self, kind: str) -> bool:
        """Whether something of a kind is to be written."""
        if kind in DOCUMENTS:
            return bool(self.documents)
        return bool(self.pictures if kind == "picture" else self.outputs.get(kind))

    def write(self, kind: str, product: Any) -> None:
        """Write a product, or what a function makes, to all outputs of its kind, if there are."""
        if callable(product):
            if not self.holds(kind):
                return
            product = product()
        _write_outputs(product, self.outputs.get(kind, []), self.console)
        if kind == "Features" and self.tabulates and self.holds("Table"):
            table, note = _tabulate(product)
            self.console.note(note)
            _write_outputs(table, self.outputs["Table"], self.console)

    def draw(self, make_figure: Callable[[], Any]) -> None:
        """Write the pictures."""
        for path in self.pictures:
            with self.console.step("Drawing"):
                write_figure(make_figure(), path, dpi=_DOTS)

    def save(self, document: Any) -> None:
        """Write sheets or a report, each page of it perhaps to a file of its own."""
        for path in self.documents:
            if hasattr(document, "list_files"):  # no page must overwrite an input either
                files = document.list_files(path)
                require_separate(self.inputs, [Named(one, "--output") for one in files])
            with self.console.step(f"Writing {path.name}"):
                written = document.save(path)
            for one in written:
                note_written(one)
            self.pages.extend(written)

    @property
    def paths(self) -> list[Path]:
        """All of them."""
        planned = [one.path for group in self.outputs.values() for one in group]
        return [*planned, *self.pictures, *self.pages]


def describe_file(path: Path) -> str:
    """Return the name of a file that was written, with its size, for people."""
    from .output import describe_file_size

    if path == STANDARD:
        return "standard output"
    return f"{name_file(path)} ({describe_file_size(path)})"


# ---------------------------------------------------------------- planned


def plan_products(
    paths: Sequence[Path],
    writing: Writing,
    console: Console,
    *,
    inputs: Sequence[Named],
    kinds: Sequence[str],
    report: Path | None = None,
    choose: Callable[[Output], str] | None = None,
) -> Products:
    """Choose what each output holds and its format, and compare all paths, before any work.

    What will be written is one of the ``kinds``: "TIN", "Survey", "Features", "Raster", "Table",
    "Alignment", "picture", "sheets", "report". Features that have no table of their own are written
    to tables too. With ``choose`` an output may be any of them until that function has seen its
    formats.
    """
    placed = [split_output(path) for path in paths]
    _compare_paths(placed, inputs, report, writing.options)
    console.note(describe_leftovers(path for path, _ in placed))
    tabulates = "Features" in kinds and "Table" not in kinds
    able = (*kinds, "Table") if tabulates else kinds
    outputs: dict[str, list[Output]] = {}
    drawn: dict[str, list[Path]] = {kind: [] for kind in ("picture", *DOCUMENTS)}
    for path, layer in placed:
        kind = "" if choose is not None else _find_kind(path, writing, able)
        if kind in drawn:
            drawn[kind].append(path)
            continue
        formats = _choose_formats(path, writing.output_format, (kind,) if kind else kinds)
        suffixes = [suffix for one in formats.values() for suffix in one.suffixes]
        named = f".{(writing.output_format or '').strip().lower().lstrip('.')}"
        suffix = named if named in suffixes else next(iter(suffixes), "")
        output = Output(path, formats, writing.options, suffix, layer)
        outputs.setdefault(kind if choose is None else choose(output), []).append(output)
    planned = [one for group in outputs.values() for one in group]
    _require_layered(planned)
    _require_taken(planned, writing.options)
    _require_free_stdout(planned, console)
    return Products(
        console=console,
        outputs=outputs,
        pictures=drawn.pop("picture"),
        tabulates=tabulates,
        documents=[path for paths in drawn.values() for path in paths],
        inputs=inputs,
    )


def _compare_paths(
    placed: Sequence[tuple[Path, str | None]],
    inputs: Sequence[Named],
    report: Path | None,
    options: dict[str, Any],
) -> None:
    """Refuse outputs that collide; one that names a layer of a file that is read keeps the rest."""
    read = {os.path.realpath(one.path) for one in inputs}
    layered = {os.path.realpath(path): path for path, layer in placed if layer is not None}
    written = [path for path, layer in placed if layer is None]
    written += [path for real, path in layered.items() if real not in read]
    outputs = [Named(path, "--output") for path in written]
    if report is not None:
        outputs.append(Named(report, "--report"))
    files = {name: file for name, file in options.items() if isinstance(file, Path)}
    more = [Named(file, make_flag(name, "write")) for name, file in files.items()]
    require_separate([*inputs, *more], outputs)


def _find_kind(path: Path, writing: Writing, kinds: Sequence[str]) -> str:
    """Return what a suffix, or a format that is named, is meant for."""
    from ..io.registry import list_writers
    from ..terrain.drawing import PICTURE_SUFFIXES

    name = writing.output_format
    suffix = path.suffix.lower() if name is None else f".{name.strip().lower().lstrip('.')}"
    if suffix in PICTURE_SUFFIXES and "picture" in kinds:
        return "picture"
    for kind in DOCUMENTS:
        if kind in kinds and name is None and suffix in list_document_suffixes(kind):
            return kind
    for kind in ("Table", "Alignment", "Features", "TIN"):
        if kind in kinds and list_writers(path, name, kind):
            return kind
    return next(
        kind for kind in kinds if kind not in ("picture", *DOCUMENTS)
    )  # whose refusal names what it takes


def list_document_suffixes(kind: str) -> Sequence[str]:
    """Return the suffixes of files of "sheets" or of a "report"."""
    from ..terrain.plans import REPORT_SUFFIXES, SHEET_SUFFIXES

    return SHEET_SUFFIXES if kind == "sheets" else REPORT_SUFFIXES


def require_format(flag: str, name: str | None) -> None:
    """Refuse a name that no format has: that is wrong usage, whatever the data."""
    from ..base.errors import FormatError
    from ..io.registry import find_format

    try:
        if name is not None:
            find_format(name)
    except FormatError as error:
        raise refuse_value(flag, error, suggest(name or "", error.known)) from error


def _choose_formats(path: Path, name: str | None, kinds: Sequence[str]) -> dict[str, Format]:
    from ..base.errors import FormatError
    from ..io.registry import find_writers, known_formats, list_claims

    require_format("--output-format", name)
    if name is None and path == STANDARD:
        raise click.UsageError("'-o -' needs --output-format: standard output has no suffix.")
    try:
        return find_writers(path, name, kinds)
    except FormatError as error:
        if name is not None or list_claims(known_formats(), path):
            raise
        sentence = name_flags(str(error), format="--output-format")
        raise click.UsageError(sentence) from error


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


def _require_taken(planned: Sequence[Output], given: dict[str, Any]) -> None:
    """Refuse an option of writing that no output takes."""
    from ..io import known_formats
    from ..io.registry import find_option_not_taken

    name = find_option_not_taken(given, [one.options_taken for one in planned])
    if name is not None:
        takers = [one.name for one in known_formats() if name in one.options("write")]
        able = f"only {', '.join(takers)} can." if takers else "no format can."
        flag = make_flag(name, "write")
        raise click.UsageError(f"No output takes the option {flag}: {able}")


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


def require_picture(
    path: Path, place: str, inputs: Sequence[Named], suffixes: Sequence[str] = ()
) -> None:
    """Refuse a picture that would overwrite an input, has another suffix, or cannot be written.

    ``place`` is the option that names it; ``suffixes`` are those of pictures if none are given.
    """
    from ..terrain.drawing import PICTURE_SUFFIXES

    require_separate(inputs, [Named(path, place)])
    known = suffixes or PICTURE_SUFFIXES
    if path.suffix.lower() not in known:
        raise click.UsageError(
            f"Cannot write a picture to '{path}': its name must end in {', '.join(known)}."
        )


# ---------------------------------------------------------------- written


def _write_outputs(product: Product, outputs: Sequence[Output], console: Console) -> None:
    from ..io import write

    with console.steps() as steps:
        for output in outputs:
            one = _find_format_of(product, output)
            with steps.step(f"Writing {output.path.name}") as progress:
                taken = one.options("write")
                options = {name: output.options[name] for name in output.options if name in taken}
                if output.layer is not None:
                    options["layer"] = output.layer
                if "progress" in signature(one.load("write")).parameters:
                    options["progress"] = progress
                if output.path == STANDARD:  # a whole file first, so that nothing comes if it fails
                    with scratch_folder() as folder:
                        path = Path(folder) / f"output{output.suffix}"
                        write(product, path, format=one.name, **options)
                        emit_file(path)
                    continue
                write(product, output.path, format=one.name, **options)
            note_written(output.path)


def _find_format_of(product: Product, output: Output) -> Format:
    """Return the format for what there is to write after all."""
    from ..io.writing import find_kind

    kind = find_kind(product, output.path)
    if kind in output.formats:
        return output.formats[kind]
    held = " or ".join(output.formats)
    raise Failure(
        f"Cannot write '{output.path}': {next(iter(output.formats.values())).description} holds a "
        f"{held}, and there is a {kind}{_WAYS.get(held, '.')}"
    )


def _tabulate(features: Features) -> tuple[Table, list[str]]:
    """Return features as a table: of points their coordinates too; and what it lacks, if any."""
    from ..base.results import tabulate_columns
    from ..io.tables.csv_tables import tabulate_points

    if features.kind == "points":
        return tabulate_points(features), []
    return tabulate_columns(features), [
        f"Tables hold the columns of the {features.kind}, not their geometries: GeoPackage and "
        "GeoJSON hold both."
    ]


def write_figure(figure: Any, path: Path, *, dpi: int) -> None:
    """Write a figure of matplotlib, whole or not at all."""
    from ..terrain.charts import save_figure

    save_figure(figure, path, dpi=dpi)
    note_written(path)


def write_text(path: Path, text: str) -> None:
    """Write a whole text file or none."""
    with replacing(path, binary=False) as file:
        file.write(text)
