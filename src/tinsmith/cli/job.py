"""What a command was asked for, and the steps from there to its last words."""

from __future__ import annotations

import sys
from dataclasses import dataclass, field, replace
from functools import wraps
from inspect import signature
from pathlib import Path
from time import perf_counter
from typing import IO, TYPE_CHECKING, Any

import click

from ..base.sentences import counted
from .command import note_given
from .format_options import take_options
from .options import (
    CODE_FLAGS,
    CONSOLE,
    READING,
    TRIANGULATING,
    WRITING,
    Reading,
    Triangulating,
    Writing,
)
from .output import Failure
from .outputs import describe_file, plan_products, require_format
from .paths import STANDARD, Named, name_file

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from contextlib import AbstractContextManager

    from ..terrain import Features, Raster
    from ..tiled.tiled_points import TiledPoints
    from ..tin import TIN, Survey
    from .options import Coding, Group
    from .output import Console, Facts
    from .outputs import Products
    from .parameters import Decorator


@dataclass(frozen=True, kw_only=True)
class Job:
    """Options that commands share, and what each of them does with files."""

    console: Console
    outputs: tuple[Path, ...] = ()
    reading: Reading = field(default_factory=Reading)
    how: Coding = field(default_factory=Triangulating)
    writing: Writing = field(default_factory=Writing)
    tiling: Any = None
    """Whether and how tiles are computed, of a command that can."""
    ground_coordinates: Any = None
    """Whether coordinates are scaled to the ground, of a command that can."""
    started: float = field(default_factory=perf_counter)
    """When the command began."""

    def step(self, text: str) -> AbstractContextManager[Callable[[float], None]]:
        """Return the context in which long work shows its progress."""
        return self.console.step(text)

    @property
    def building(self) -> Triangulating:
        """How points become a TIN."""
        if not isinstance(self.how, Triangulating):
            raise TypeError("the command has no options of triangulation")
        return self.how

    def with_fallback(self, **options: Any) -> Job:
        """Return the same with options of reading that count where a format has them."""
        reading = replace(self.reading, fallbacks=self.reading.fallbacks | options)
        return replace(self, reading=reading)

    def list_inputs(self, *files: Path, more: Sequence[Named] = ()) -> list[Named]:
        """Return all files that are read: surfaces, lines, and others."""
        inputs = [Named(file, "the input") for file in files]
        if self.how.code_table is not None:
            inputs.append(Named(self.how.code_table, "the file of --code-table"))
        for flag, paths in self.how.line_files.items():
            for path in paths:
                inputs += name_features(path, f"the file of {flag}")
        return [*inputs, *more]

    def plan(self, inputs: Sequence[Named], *kinds: str, **how: Any) -> Products:
        """Choose what each output holds, as :func:`.plan_products`, before any work is done."""
        return plan_products(
            self.outputs, self.writing, self.console, inputs=inputs, kinds=kinds, **how
        )

    def finish(self, planned: Products, facts: Facts) -> None:
        """Tell what was done: a summary for people, and a record as JSON if it was asked for."""
        self.tell(planned.paths, facts)

    def finish_tin(self, planned: Products, facts: Facts, label: str, tin: TIN) -> None:
        """Write a TIN, and tell of it with its report."""
        planned.write("TIN", tin)
        facts.add_tin(label, tin, report=tin.report.to_dict)
        facts.note(tin.report.notes)
        self.finish(planned, facts)

    def tell(self, paths: Sequence[Path], facts: Facts) -> None:
        """Tell what was done, and which files were written."""
        written = [("Written", "\n".join(map(describe_file, paths)))] if paths else []
        seconds = ("Time", f"{perf_counter() - self.started:.2f} s")
        self.console.summarise([*facts.lines, *written, seconds])
        if self.console.as_json:
            self.console.emit_record({"outputs": [str(path) for path in paths]} | facts.values)

    # ------------------------------------------------------------ points and surfaces

    def read(self, *paths: Path) -> Survey | TIN:
        """Read points or a TIN, showing progress; several files of points as one survey.

        They are reprojected if that is asked for.
        """
        return _join(self._read_each(paths), paths)

    def read_base(self, *paths: Path, need: str) -> tuple[TIN | None, Survey]:
        """Read points, and the TIN that they are for, if there are several files, the first of one.

        ``need`` is as for :meth:`read_survey`.
        """
        from ..io.reading import join_files
        from ..tin import TIN

        found = self._read_each(paths)
        first = found[0]
        base = first if len(found) > 1 and isinstance(first, TIN) else None
        if base is not None:
            found = found[1:]
        names = [Path(name_file(path)) for path in paths[-len(found) :]]
        survey = found[0] if len(found) == 1 else join_files(found, names)
        if isinstance(survey, TIN):
            raise Failure(f"'{paths[-1]}' holds a TIN{need}")
        return base, survey

    def _read_each(self, paths: Sequence[Path]) -> list[Survey | TIN]:
        from ..io import reproject

        require_format("--format", self.reading.format)
        found: list[Survey | TIN] = []
        for path in paths:
            with self.step(f"Reading {name_file(Path(path.name))}") as progress:
                if self.reading.to_crs is None:
                    found.append(_read_once(path, self.reading, progress))
                else:
                    one = _read_to_reproject(path, self.reading, self.reading.to_crs)
                    found.append(reproject(one, self.reading.to_crs))
        return found

    def read_survey(self, *paths: Path, need: str) -> Survey:
        """Read points, or refuse a TIN; ``need`` ends the sentence that says why."""
        from ..tin import TIN

        found = self.read(*paths)
        if isinstance(found, TIN):
            raise Failure(f"'{paths[0]}' holds a TIN{need}")
        return found

    def read_tin(self, *paths: Path) -> TIN:
        """Read a TIN, or points and build theirs."""
        return self.read_surface(*paths)[0]

    def read_surface(self, *paths: Path) -> tuple[TIN, Survey | None]:
        """Read a TIN, or points and build theirs; the points are None for a file of a TIN."""
        return self._make_surface(self.read(*paths), paths[0])

    def _make_surface(self, found: Survey | TIN, path: Path) -> tuple[TIN, Survey | None]:
        from ..tin import TIN

        if not isinstance(found, TIN):
            survey = self.add_lines(found)
            tin = self.build_tin(survey)
            self.note_surfaces(tin)
            return tin, survey
        if self.building.shaping:
            raise Failure(
                f"'{path}' holds a TIN already, and {self.building.shaping[0]} needs points to "
                "build from: 'tinsmith edit' adds lines to a TIN."
            )
        self.note_surfaces(found)
        return found, None

    def read_surfaces(
        self, files: Sequence[Path], *, apart: bool
    ) -> list[tuple[TIN, Survey | None]]:
        """Read what is shown together: TINs each by itself, files of points as one surface.

        ``apart`` takes each file of points by itself, too. The points are None for a file of a TIN.
        """
        from ..tin import TIN

        found = self._read_each(files)
        if apart or (len(found) > 1 and all(isinstance(one, TIN) for one in found)):
            return self._make_each(found)
        return [self._make_surface(_join(found, files), files[0])]

    def read_tins(self, files: Sequence[Path]) -> list[TIN]:
        """Read TINs, or points and build theirs; files of lines are for the one file of points.

        Codes, and the longest edge, are for each file of points. Refused where it cannot be told
        for which file an option is.
        """
        return [tin for tin, _ in self._make_each([self.read(file) for file in files])]

    def _make_each(self, found: Sequence[Survey | TIN]) -> list[tuple[TIN, Survey | None]]:
        from ..tin import TIN

        n_surveys = sum(not isinstance(one, TIN) for one in found)
        of_each = [f"--{name.replace('_', '-')}" for name in ("max_edge", *CODE_FLAGS)]
        given = self.building.shaping
        named = [flag for flag in given if flag not in of_each]
        if (named and n_surveys != 1) or (given and n_surveys == 0):
            raise Failure(
                f"{(named or given)[0]} needs {'a' if n_surveys == 0 else 'one'} file of points, "
                f"and there are {n_surveys}: 'tinsmith build' makes TINs of them first."
            )
        made: list[tuple[TIN, Survey | None]] = []
        for one in found:
            if isinstance(one, TIN):
                made.append((one, None))
            else:
                survey = self.add_lines(one)
                made.append((self.build_tin(survey), survey))
        self.note_surfaces(*(tin for tin, _ in made))
        return made

    def read_cells(self, path: Path) -> Raster | None:
        """Return the raster of a file; None if its cells are to be points, or it is no raster."""
        from ..base.errors import OptionError, ReadError
        from ..io.registry import choose_format

        given = self.reading.given
        chosen = None if "format" in given else choose_format(path, "read")
        if chosen is None or chosen.read_cells is None:
            return None
        read = chosen.load("read_cells")
        is_moved = self.reading.to_crs is not None
        if is_moved or self.building.shaping or {*given} - {*signature(read).parameters}:
            return None
        try:
            return read(path, **given)  # type: ignore[no-any-return]
        except (OptionError, ReadError):
            return None  # as points it can be read, or it is told why not

    def add_coded_lines(self, survey: Survey) -> Survey:
        """Add the lines of the points' codes to a survey, if they are asked for.

        A tolerance of curves or an order of shots without codes is wrong usage.
        """
        for flag in ("arc_tolerance", "shot_order"):
            if getattr(self.how, flag) is not None and not self.how.has_codes:
                name = flag.replace("_", "-")
                raise click.UsageError(f"--{name} needs --codes, --code-table or --code-style.")
        if not self.how.has_codes:
            return survey
        from ..io import lines_from_codes

        return lines_from_codes(survey, **self.how.coding)

    def add_lines(self, survey: Survey) -> Survey:
        """Add the lines of the points' codes and of files to a survey, showing progress.

        A height of water without water is wrong usage.
        """
        how = self.building
        if how.water_z is not None and not how.water:
            raise click.UsageError(
                "--water-z needs --water: a file of the polygons that it is for."
            )
        survey = self.add_coded_lines(survey)
        if not how.files:
            return survey
        from ..io import with_lines

        with self.step("Reading lines"):
            return with_lines(survey, **how.files)

    def build_tin(self, survey: Survey) -> TIN:
        """Build the TIN of a survey, showing progress; rows at fault are named by number too."""
        from ..base.errors import PointsError
        from ..tin import triangulate

        try:
            with self.step(f"Triangulating {counted(len(survey), 'point')}") as progress:
                return triangulate(survey, **self.building.method, progress=progress)
        except PointsError as error:
            numbers = survey.attributes.get("number")
            named = " Rows are points of the file, counted from 0." if error.rows else ""
            if named and numbers is not None:
                rows = ", ".join(str(numbers[row]) for row in error.rows)
                named = f" Their point numbers: {rows}."
            raise Failure(f"{error}{named}") from error

    def note_found(self, found: Survey | TIN) -> None:
        """Take note of what is known of what was read."""
        from ..tin import TIN
        from ..tin.report import describe_skipped

        if isinstance(found, TIN):
            self.note_surfaces(found)
        else:
            self.console.note([*describe_skipped(found.skipped), *found.notes])

    def note_surfaces(self, *surfaces: TIN) -> None:
        """Take note of what is known of surfaces, showing progress, for summary and record."""
        from ..base.products import notes_of_surfaces

        with self.step("Looking for blunders and gaps"):
            self.console.note(notes_of_surfaces(surface.snapshot() for surface in surfaces))

    # ------------------------------------------------------------ features of a vector file

    def read_features(
        self, given: Path, tin: Survey | TIN | TiledPoints, kind: str = "", purpose: str = ""
    ) -> Features:
        """Return the features of a vector file, ``FILE:LAYER``, in the CRS of a surface.

        Where "points" are asked for nothing else is taken, where "lines" are no points, and of
        polygons the rings; ``purpose`` ends the refusal. A text table holds points, or the vertices
        of one line or polygon, as it is asked.
        """
        from ..io.places import read_places
        from ..io.vector import is_point_table, read_geometries, split_layer
        from ..terrain import Features

        path, layer = split_layer(given)
        if kind == "points" and layer is None and is_point_table(path):
            return read_places(path, crs=tin.crs)
        table = kind if kind in ("lines", "polygons") else None
        found = read_geometries(path, crs=tin.crs, layer=layer, table=table)
        if kind in ("points", "lines") and (found.kind == "points") != (kind == "points"):
            raise Failure(f"'{given}' has {found.kind}: {purpose or 'points are needed'}.")
        if kind != "lines":
            return found
        lines = Features.of_lines(found.coordinates, found.offsets[0], crs=found.crs)
        return lines.with_notes(found.notes)


def _join(found: Sequence[Survey | TIN], paths: Sequence[Path]) -> Survey | TIN:
    """Return what was read as one survey, or the TIN of the only file."""
    from ..io.reading import join_files

    if len(found) == 1:
        return found[0]
    return join_files(list(found), [Path(name_file(path)) for path in paths])


def name_features(path: Path | None, place: str) -> list[Named]:
    """Return a vector file, if one is given, for the list of inputs; ``place`` says where."""
    from ..io.vector import split_layer

    return [] if path is None else [Named(split_layer(path)[0], place)]


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
    from ..io.reprojection import DegreesError

    try:
        return _read_once(path, reading)
    except DegreesError:
        if path == STANDARD:
            raise  # it is read only once
        source = reading.crs if reading.source_crs is None else reading.source_crs
        return _read_once(path, replace(reading, crs=target, source_crs=source))


def open_standard_input() -> IO[bytes]:
    """Return standard input, to be read once."""
    if sys.stdin is None or sys.stdin.isatty():
        what = "closed" if sys.stdin is None else "a terminal"
        raise Failure(f"Standard input is {what}: pipe the data in, or name a file.")
    return sys.stdin.buffer


def surface_options(*groups: Group) -> Decorator:
    """Return a decorator that adds groups of options, and hands them over as ``job``.

    Without a group these are all that commands on surfaces share. Options of formats, whose names
    are known only once arguments are, come from the ways of a group: to read, to write.
    """
    chosen = groups or (READING, TRIANGULATING, WRITING, CONSOLE)

    def decorate(function: Any) -> Any:
        @wraps(function)
        def gathering(**given: Any) -> Any:
            note_given(click.get_current_context())
            shared = {"outputs": given.pop("outputs")} if "outputs" in given else {}
            for group in chosen:
                values = {name: given.pop(name) for name in group.fields if name in given}
                if group.way:
                    values["options"] = take_options(given, group.way)
                shared[group.name] = group.factory(**values)
            return function(**given, job=Job(**shared))

        decorated: Any = gathering
        decorated.format_ways = tuple(group.way for group in chosen if group.way)
        for group in reversed(chosen):
            for option in reversed(group.options):
                decorated = option(decorated)
        return decorated

    return decorate
