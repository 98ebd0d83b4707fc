"""Options that commands share, in groups: one value for each purpose."""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import Any

import click

from .output import Console
from .parameters import (
    Decorator,
    FormatName,
    LibraryOption,
    crs_option,
    number_option,
    parsed,
    under,
)
from .paths import LINES
from .product_options import list_product_options

_OF_FORMATS = ("options", "fallbacks")
_METHOD = ("duplicates", "snap", "threads", "crossing", "walls", "conforming", "max_edge", "trim")
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
        usual = {one.name: getattr(self, one.name) for one in fields(self)[: -len(_OF_FORMATS)]}
        usual["unit"] = usual.pop("length_unit")
        del usual["to_crs"]
        return {name: value for name, value in usual.items() if value is not None} | self.options


@dataclass(frozen=True)
class Coding:
    """How the points' own codes become lines."""

    codes: bool = False
    code_table: Path | None = None
    code_style: str | None = None
    arc_tolerance: float | None = None
    shot_order: str | None = None

    @property
    def line_files(self) -> dict[str, tuple[Path, ...]]:
        """Files of lines, by the flag that names them: there are none."""
        return {}

    @property
    def has_codes(self) -> bool:
        """Whether lines are made of codes; a table or a style asks for it, too."""
        return self.codes or self.code_table is not None or self.code_style is not None

    @property
    def coding(self) -> dict[str, Any]:
        """Options of :func:`tinsmith.lines_from_codes`."""
        names = (one.name for one in fields(Coding) if one.name != "codes")
        return {name: getattr(self, name) for name in names}


@dataclass(frozen=True)
class Triangulating(Coding):
    """How points become a TIN."""

    duplicates: str = "mean"
    snap: float = 0.0
    threads: int | None = None
    crossing: str = "split"
    walls: float | None = None
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
            "walls": self.walls is not None,
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
        names = ("max_edge", *CODE_FLAGS, "walls", "conforming", *_FILES)
        return [f"--{name.replace('_', '-')}" for name in names if getattr(self, name)]


@dataclass(frozen=True)
class Writing:
    """How the output is written; None leaves it to the writer."""

    output_format: str | None = None
    options: dict[str, Any] = field(default_factory=dict)
    """Options of the formats that were given."""


@dataclass(frozen=True)
class Group:
    """Options that a command hands over as one value of its job."""

    name: str
    """Of the field of the job."""
    factory: type
    options: tuple[Decorator, ...]
    way: str = ""
    """"read" or "write": the options of formats are among them."""

    @property
    def fields(self) -> list[str]:
        """Names of the values."""
        return [one.name for one in fields(self.factory)]


def _take_unchecked(
    context: click.Context, parameter: click.Parameter, is_checked: bool | None
) -> bool | None:
    """Take coordinates of every file of the command as they are, those of lines too."""
    del parameter
    if is_checked is False:
        from ..io.reprojection import checking_crs

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
)

_REPROJECTION = under(
    "Reprojection",
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


def make_reading(unit_flag: str = "--unit") -> Group:
    """Return the options of reading, with a flag of the unit of lengths that is free."""
    unit = click.option(
        unit_flag,
        "length_unit",
        cls=LibraryOption,
        instead="unit",
        metavar="UNIT",
        help="Unit of coordinates and elevations, if the file does not state one; of a LandXML or "
        "DXF file also where it states one that differs from its CRS.",
    )
    options = (*_COORDINATES, *under("Coordinates and units", unit), *_REPROJECTION, *_INPUT)
    return Group("reading", Reading, options, "read")


READING = make_reading()

_TRIANGULATE = "tin.construction.triangulate"


def _make_files_option(name: str, words: str) -> Any:
    return click.option(
        name,
        metavar="FILE",
        type=LINES,
        multiple=True,
        help=f"{words} May be given several times; FILE:LAYER names a layer.",
    )


@parsed
def _parse_level(_: str, value: str) -> float | str:
    """Return a height as a number, anything else as the name of a column."""
    try:
        return float(value)
    except ValueError:
        return value


CODE_OPTIONS = under(
    "Codes of points",
    click.option(
        "--codes",
        is_flag=True,
        help="Make lines from the field codes of the points, such as EP1 BEG, EP1, EP1 END, BLDG1 "
        "CLS.",
    ),
    click.option(
        "--code-table",
        metavar="FILE",
        type=LINES,
        help="As --codes, with a table of codes (TOML) that defines their kinds and marks.",
    ),
    *list_product_options(
        "io.field_survey.field_codes.lines_from_codes",
        "code_style arc_tolerance shot_order",
        code_style="As --codes, in this style; default that of the table, else detected.",
    ),
)

_LINES = under(
    "Lines and areas",
    _make_files_option(
        "--breaklines",
        "Vector file (GeoPackage, Shapefile, GeoJSON ...) of lines that must be edges of the "
        "surface; columns kind, priority and name are honoured.",
    ),
    _make_files_option(
        "--soft-breaklines", "Vector file of lines that are edges but no breaks of slope."
    ),
    _make_files_option(
        "--boundary",
        "Vector file of polygons: the surface ends there, and is triangulated anew along them; "
        "'tinsmith clip' cuts a finished one.",
    ),
    _make_files_option("--holes", "Vector file of polygons without surface inside."),
    _make_files_option(
        "--erase", "Vector file of polygons: points inside are left out and spanned."
    ),
    _make_files_option("--water", "Vector file of flat polygons."),
    click.option(
        "--water-z",
        metavar="Z",
        callback=_parse_level,
        help="Elevation of the water, or the column that holds it.",
    ),
    click.option(
        "--lines-elevation-unit",
        cls=LibraryOption,
        sets=("elevation_unit",),
        metavar="UNIT",
        help="Unit of the elevations in the files of lines, if they do not state it.",
    ),
    click.option(
        "--drape", is_flag=True, help="Take the elevations of lines in files from the surface."
    ),
    *list_product_options(
        _TRIANGULATE,
        "crossing walls conforming",
        walls="How far apart breaklines along one line with two elevations are put; the second one "
        "may be in a column of the line: top, foot or bottom.",
    ),
)

_TRIMMING = under("Triangulation", *list_product_options(_TRIANGULATE, "max_edge trim"))

LINE_OPTIONS = (*_LINES, *CODE_OPTIONS, *_TRIMMING)

_TRIANGULATION = under(
    "Triangulation",
    *list_product_options(_TRIANGULATE, "duplicates snap"),
    number_option(
        "--threads",
        "N",
        "Number of threads; default all cores. The result is the same.",
        type=click.IntRange(min=1),
    ),
)

TRIANGULATING = Group("how", Triangulating, (*_TRIANGULATION, *LINE_OPTIONS))

CODING = Group("how", Coding, CODE_OPTIONS)

WRITING = Group(
    "writing",
    Writing,
    under(
        "Output",
        click.option(
            "--output-format",
            metavar="NAME",
            type=FormatName("write"),
            help="Format of the output, in place of that of its suffix.",
        ),
    ),
    "write",
)

CONSOLE = Group(
    "console",
    Console,
    (
        click.option("--json", "as_json", is_flag=True, help="Write the result as JSON to stdout."),
        click.option(
            "--events",
            is_flag=True,
            help="Write progress, summary, warnings and errors to stderr as JSON, one object per "
            "line.",
        ),
        click.option("-q", "--quiet", is_flag=True, help="No summary, no progress."),
    ),
)
