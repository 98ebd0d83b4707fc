"""What a command on surfaces was asked for, and the steps that all of them take."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import wraps
from time import perf_counter
from typing import TYPE_CHECKING, Any

from .files import (
    add_lines,
    build_tin,
    describe_written,
    list_inputs,
    note_surfaces,
    plan_outputs,
    read_input,
    read_tin,
    write_figure,
    write_outputs,
)
from .options import (
    CODE_FLAGS,
    console_options,
    reading_options,
    triangulating_options,
    writing_options,
)
from .output.failures import Failure
from .paths import STANDARD, Named, describe_leftovers, require_separate, split_output

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from contextlib import AbstractContextManager
    from pathlib import Path

    from ..terrain import Features, Table
    from ..tin import TIN
    from .files import Output
    from .options import Reading, Triangulating, Writing
    from .output.console import Console
    from .output.facts import Facts
    from .parameters import Decorator

__all__ = ["Job", "Products", "surface_options"]


_DOTS = 150


@dataclass(frozen=True, kw_only=True)
class Products:
    """Outputs by what they hold: tables, features, TINs and pictures."""

    console: Console
    outputs: dict[str, list[Output]]
    pictures: list[Path] = field(default_factory=list)
    tabulates: bool = False
    """Whether tables are those of the features' columns."""

    def holds(self, kind: str) -> bool:
        """Whether something of a kind is to be written."""
        return bool(self.pictures if kind == "picture" else self.outputs.get(kind))

    def write(self, kind: str, product: Any) -> None:
        """Write a product, or what a function makes, to all outputs of its kind, if there are."""
        if callable(product):
            if not self.holds(kind):
                return
            product = product()
        write_outputs(product, self.outputs.get(kind, []), self.console)
        if kind == "Features" and self.tabulates and self.holds("Table"):
            table, note = _tabulate(product)
            self.console.note(note)
            write_outputs(table, self.outputs["Table"], self.console)

    def draw(self, make_figure: Callable[[], Any]) -> None:
        """Write the pictures."""
        for path in self.pictures:
            with self.console.step("Drawing"):
                write_figure(make_figure(), path, dpi=_DOTS)

    @property
    def paths(self) -> list[Path]:
        """All of them."""
        return [one.path for group in self.outputs.values() for one in group] + self.pictures

    @property
    def text(self) -> str:
        """What was written, a line each."""
        from .output.summaries import describe_file_size

        texts = [describe_written(group) for group in self.outputs.values() if group]
        return "\n".join(texts + [f"{path} ({describe_file_size(path)})" for path in self.pictures])


@dataclass(frozen=True, kw_only=True)
class Job:
    """Options that commands on surfaces share, and the steps from them to the last words."""

    outputs: tuple[Path, ...]
    reading: Reading
    how: Triangulating
    writing: Writing
    console: Console
    started: float = field(default_factory=perf_counter)
    """When the command began."""

    def plan(self, inputs: Sequence[Named], kind: str, *, report: Path | None = None) -> Products:
        """Choose the formats of outputs that all hold one thing, before any work is done."""
        planned = plan_outputs(
            self.outputs,
            self.writing,
            inputs=inputs,
            console=self.console,
            report=report,
            kinds=(kind,),
        )
        return Products(console=self.console, outputs={kind: planned})

    def plan_products(self, inputs: Sequence[Named], *kinds: str) -> Products:
        """Choose what each output holds, of several things, before any work is done."""
        return _plan_products(
            self.outputs, self.writing, inputs=inputs, console=self.console, kinds=kinds
        )

    def list_inputs(self, *files: Path, more: Sequence[Named] = ()) -> list[Named]:
        """Return all files that are read: surfaces, lines, and others."""
        return [*list_inputs(*files, how=self.how), *more]

    def step(self, text: str) -> AbstractContextManager[Callable[[float], None]]:
        """Return the context in which long work shows its progress."""
        return self.console.step(text)

    def read_tin(self, file: Path) -> TIN:
        """Read a TIN, or points and build theirs."""
        return read_tin(file, self.reading, self.how, self.console)[0]

    def read_tins(self, files: Sequence[Path]) -> list[TIN]:
        """Read TINs, or points and build theirs; files of lines are for the one file of points.

        Codes, and the longest edge, are for each file of points.

        Raises
        ------
        Failure
            If it cannot be told for which file an option is.
        """
        from ..tin import TIN

        found = [read_input(file, self.reading, self.console) for file in files]
        self._require_points(sum(not isinstance(one, TIN) for one in found))
        surfaces = [
            one
            if isinstance(one, TIN)
            else build_tin(add_lines(one, self.how, self.console), self.how, self.console)
            for one in found
        ]
        note_surfaces(surfaces, self.console)
        return surfaces

    def _require_points(self, n_surveys: int) -> None:
        of_each = [f"--{name.replace('_', '-')}" for name in ("max_edge", *CODE_FLAGS)]
        given = self.how.shaping
        named = [flag for flag in given if flag not in of_each]
        if (named and n_surveys != 1) or (given and n_surveys == 0):
            flag = (named or given)[0]
            raise Failure(
                f"{flag} needs {'a' if n_surveys == 0 else 'one'} file of points, and there are "
                f"{n_surveys}: 'tinsmith build' makes TINs of them first."
            )

    def finish(self, planned: Products, facts: Facts) -> None:
        """Tell what was done: a summary for people, and a record as JSON if it was asked for."""
        written = [("Written", planned.text)] if planned.paths else []
        seconds = perf_counter() - self.started
        self.console.summarise([*facts.lines, *written, ("Time", f"{seconds:.2f} s")])
        if self.console.as_json:
            outputs = [str(path) for path in planned.paths]
            self.console.emit_record({"outputs": outputs} | facts.values)


def surface_options(reading_options: Decorator = reading_options) -> Decorator:
    """Return a decorator that adds the shared options, and hands them over as ``job``.

    The options of reading may be those that a command has in their place.
    """
    groups = (reading_options, triangulating_options, writing_options, console_options)

    def decorate(function: Any) -> Any:
        @wraps(function)
        def gathering(**given: Any) -> Any:
            shared = ("outputs", "reading", "how", "writing", "console")
            job = Job(**{name: given.pop(name) for name in shared})
            return function(**given, job=job)

        decorated: Any = gathering
        for group in reversed(groups):
            decorated = group(decorated)
        return decorated

    return decorate


def _plan_products(
    paths: Sequence[Path],
    writing: Writing,
    *,
    inputs: Sequence[Named],
    console: Console,
    kinds: Sequence[str],
) -> Products:
    """Choose what each output holds, before any work is done.

    What there will be is of the ``kinds`` "Table", "Features", "TIN" and "picture". Features that
    have no table of their own are written to tables too.
    """
    tabulates = "Features" in kinds and "Table" not in kinds
    if tabulates:
        kinds = (*kinds, "Table")
    plain = [path for path in paths if split_output(path)[1] is None]
    require_separate(inputs, [Named(path, "--output") for path in plain])
    groups: dict[str, list[Path]] = {}
    for path in paths:
        groups.setdefault(_find_kind(split_output(path)[0], writing, kinds), []).append(path)
    pictures = groups.pop("picture", [])
    console.note(describe_leftovers(pictures))
    if sum(path == STANDARD for path in paths) > 1:
        raise Failure("'-o -' is given twice: standard output takes one thing.")
    planned = {
        kind: plan_outputs(group, writing, inputs=(), console=console, kinds=(kind,))
        for kind, group in groups.items()
    }
    return Products(console=console, outputs=planned, pictures=pictures, tabulates=tabulates)


def _tabulate(features: Features) -> tuple[Table, list[str]]:
    """Return features as a table: of points their coordinates too; and what it lacks, if any."""
    from ..base.results.table import tabulate_columns
    from ..io.tables.csv_tables import tabulate_points

    if features.kind == "points":
        return tabulate_points(features), []
    return tabulate_columns(features), [
        f"Tables hold the columns of the {features.kind}, not their geometries: GeoPackage and "
        "GeoJSON hold both."
    ]


def _find_kind(path: Path, writing: Writing, kinds: Sequence[str]) -> str:
    """Return what a suffix, or a format that is named, is meant for."""
    from ..io.registry.lookup import list_writers
    from ..terrain.drawing.pictures import PICTURE_SUFFIXES

    name = writing.output_format
    suffix = path.suffix.lower() if name is None else f".{name.strip().lower().lstrip('.')}"
    if suffix in PICTURE_SUFFIXES and "picture" in kinds:
        return "picture"
    for kind in ("Table", "Features", "TIN"):
        if kind in kinds and list_writers(path, name, kind):
            return kind
    return next(kind for kind in kinds if kind != "picture")  # whose refusal names what it takes
