"""Options that commands share, gathered into one value for each purpose."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, fields, replace
from functools import wraps
from pathlib import Path
from typing import Any, TypeVar

import click

from ..base.policies import DuplicatePolicy
from .flags import note_given
from .format_options import take_options
from .line_options import CODE_OPTIONS, LINE_OPTIONS
from .output.console import Console
from .parameters import (
    Decorator,
    FormatName,
    LibraryOption,
    choice_option,
    crs_option,
    number_option,
    under,
)

__all__ = [
    "CODE_FLAGS",
    "Coding",
    "Reading",
    "Triangulating",
    "Writing",
    "coding_options",
    "console_options",
    "gather_options",
    "make_reading_options",
    "reading_options",
    "triangulating_options",
    "writing_options",
]

Function = TypeVar("Function", bound=Callable[..., Any])

_METHOD = ("duplicates", "snap", "threads", "crossing", "conforming", "max_edge", "trim")
CODE_FLAGS = ("codes", "code_table", "code_style")
_FILES = ("breaklines", "soft_breaklines", "boundary", "holes", "erase", "water")


@dataclass(frozen=True)
class Reading:
    """How the input is read; None leaves it to the reader."""

    crs: str | None = None
    elevation_unit: str | None = None
    source_crs: str | None = None
    to_crs: str | None = None
    format: str | None = None
    length_unit: str | None = None
    check_crs: bool | None = None
    remote: bool | None = None
    options: dict[str, Any] = field(default_factory=dict)
    """Options of the format that were given."""
    fallbacks: dict[str, Any] = field(default_factory=dict)
    """Options that the command chooses, for a format that has them."""

    @property
    def given(self) -> dict[str, Any]:
        """All that :func:`tinsmith.io.read` is to take, by the names of its options."""
        usual = {
            "crs": self.crs,
            "elevation_unit": self.elevation_unit,
            "source_crs": self.source_crs,
            "format": self.format,
            "unit": self.length_unit,
            "check_crs": self.check_crs,
            "remote": self.remote,
        }
        return {name: value for name, value in usual.items() if value is not None} | self.options

    def with_fallback(self, **options: Any) -> Reading:
        """Return the same with options that count where a format has them."""
        return replace(self, fallbacks=self.fallbacks | options)


@dataclass(frozen=True)
class Coding:
    """How the points' own codes become lines."""

    codes: bool = False
    code_table: Path | None = None
    code_style: str | None = None
    arc_tolerance: float | None = None
    shot_order: str | None = None

    @property
    def has_codes(self) -> bool:
        """Whether lines are made of codes; a table or a style asks for it, too."""
        return self.codes or self.code_table is not None or self.code_style is not None

    @property
    def coding(self) -> dict[str, Any]:
        """Options of :func:`tinsmith.lines_from_codes`."""
        names = ("code_table", "code_style", "arc_tolerance", "shot_order")
        return {name: getattr(self, name) for name in names}


@dataclass(frozen=True)
class Triangulating(Coding):
    """How points become a TIN."""

    duplicates: str = "mean"
    snap: float = 0.0
    threads: int | None = None
    crossing: str = "split"
    conforming: bool = False
    max_edge: float | None = None
    trim: str = "perimeter"
    breaklines: tuple[Path, ...] = ()
    soft_breaklines: tuple[Path, ...] = ()
    boundary: tuple[Path, ...] = ()
    holes: tuple[Path, ...] = ()
    erase: tuple[Path, ...] = ()
    water: tuple[Path, ...] = ()
    water_z: float | str | None = None
    lines_elevation_unit: str | None = None
    drape: bool = False

    @property
    def method(self) -> dict[str, Any]:
        """Options of :func:`tinsmith.triangulate`."""
        return {name: getattr(self, name) for name in _METHOD}

    @property
    def files(self) -> dict[str, Any]:
        """Options of :func:`tinsmith.io.with_lines`; empty if there are no files."""
        given = {name: getattr(self, name) for name in _FILES}
        if not any(given.values()):
            return {}
        return given | {
            "water_z": self.water_z,
            "drape": self.drape,
            "elevation_unit": self.lines_elevation_unit,
        }

    @property
    def line_files(self) -> dict[str, tuple[Path, ...]]:
        """Files of lines, by the flag that names them."""
        return {f"--{name.replace('_', '-')}": getattr(self, name) for name in _FILES}

    @property
    def shaping(self) -> list[str]:
        """Names of the options given that need points to build from."""
        names = ("max_edge", *CODE_FLAGS, "conforming", *_FILES)
        return [f"--{name.replace('_', '-')}" for name in names if getattr(self, name)]


@dataclass(frozen=True)
class Writing:
    """How the output is written; None leaves it to the writer."""

    output_format: str | None = None
    options: dict[str, Any] = field(default_factory=dict)
    """Options of the formats that were given."""


def gather_options(
    name: str, factory: type, *options: Decorator, way: str | None = None
) -> Callable[[Function], Function]:
    """Return a decorator that adds options and hands them over as one value called ``name``.

    With a ``way``, "read" or "write", the options of formats are among them.
    """
    names = [one.name for one in fields(factory)]

    def decorate(function: Function) -> Function:
        @wraps(function)
        def gathering(**given: Any) -> Any:
            note_given(click.get_current_context())
            values = {key: given.pop(key) for key in names if key in given}
            if way is not None:
                values["options"] = take_options(given, way)
            return function(**given, **{name: factory(**values)})

        decorated: Any = gathering
        if way is not None:
            decorated.format_ways = (way, *getattr(function, "format_ways", ()))
        for option in reversed(options):
            decorated = option(decorated)
        return decorated  # type: ignore[no-any-return]

    return decorate


def _take_unchecked(
    context: click.Context, parameter: click.Parameter, is_checked: bool | None
) -> bool | None:
    """Take coordinates of every file of the command as they are, those of lines too."""
    del parameter
    if is_checked is False:
        from ..io.reprojection.contradictions import checking_crs

        context.with_resource(checking_crs(is_checked))
    return is_checked


_COORDINATES = under(
    "Coordinates and units",
    crs_option(
        "--crs",
        "Coordinate reference system of points whose file names none, such as EPSG:32616; "
        "points in another CRS are reprojected to it.",
    ),
    click.option(
        "--elevation-unit",
        metavar="UNIT",
        help="Unit of the elevations, if the file does not state it: m, ft, 'US survey foot'. "
        "Points that are reprojected get the unit of --crs.",
    ),
    click.option(
        "--check-crs/--no-check-crs",
        default=None,
        callback=_take_unchecked,
        help="Refuse coordinates that contradict their CRS (the default), or tell it only.",
    ),
    crs_option("--source-crs", "CRS that the points are in, if it is not --crs."),
    crs_option(
        "--to-crs",
        "Reproject the input to this CRS; the CRS of the input must be known from the file or "
        "--crs.",
    ),
)

_INPUT = under(
    "Input",
    click.option(
        "--format",
        metavar="NAME",
        type=FormatName("read"),
        help="Format of the input, in place of the detected one.",
    ),
    click.option(
        "--remote",
        is_flag=True,
        default=None,
        help="Allow an address (https://...) as input, which is downloaded first.",
    ),
)


def make_reading_options(*, unit_flag: str = "--unit") -> Callable[[Function], Function]:
    """Return the decorator that adds the options of reading.

    Parameters
    ----------
    unit_flag : str
        Flag of the unit of lengths, for a command whose own ``--unit`` is another.
    """
    unit = click.option(
        unit_flag,
        "length_unit",
        cls=LibraryOption,
        instead="unit",
        metavar="UNIT",
        help="Unit of coordinates and elevations, if the file does not state one; of a LandXML or "
        "DXF file also where it states one that differs from its CRS.",
    )
    options = (*_COORDINATES, *under("Coordinates and units", unit), *_INPUT)
    return gather_options("reading", Reading, *options, way="read")


reading_options = make_reading_options()

_TRIANGULATION = under(
    "Triangulation",
    choice_option(
        "--duplicates",
        DuplicatePolicy,
        "Elevation of points with equal easting and northing.",
        default="mean",
    ),
    number_option(
        "--snap", "DISTANCE", "Merge points no further apart than this, in CRS units.", default=0.0
    ),
    number_option(
        "--threads",
        "N",
        "Number of threads; default all cores. The result is the same.",
        type=click.IntRange(min=1),
    ),
)

triangulating_options = gather_options("how", Triangulating, *_TRIANGULATION, *LINE_OPTIONS)

coding_options = gather_options("how", Coding, *CODE_OPTIONS)

writing_options = gather_options(
    "writing",
    Writing,
    *under(
        "Output",
        click.option(
            "--output-format",
            metavar="NAME",
            type=FormatName("write"),
            help="Format of the output, in place of that of its suffix.",
        ),
    ),
    way="write",
)

console_options = gather_options(
    "console",
    Console,
    click.option("--json", "as_json", is_flag=True, help="Write the result as JSON to stdout."),
    click.option(
        "--events",
        is_flag=True,
        help="Write progress, summary, warnings and errors to stderr as JSON, one object per line.",
    ),
    click.option("-q", "--quiet", is_flag=True, help="No summary, no progress."),
)
