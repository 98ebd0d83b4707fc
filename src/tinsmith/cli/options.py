"""Options that commands share, gathered into one value for each purpose."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, dataclass, fields
from functools import wraps
from pathlib import Path
from typing import Any, TypeVar

import click

from ..base.policies import DrawingContent, DuplicatePolicy, FacePolicy, FeatureKind, LineReading
from .flags import LibraryOption, note_given
from .line_options import CODE_OPTIONS, LINE_OPTIONS
from .mesh_options import MESH_READING, MESH_WRITING
from .output.console import Console
from .parameters import (
    Decorator,
    FormatName,
    Words,
    choice_option,
    crs_option,
    number_option,
    under,
)

__all__ = [
    "CODE_FLAGS",
    "Coding",
    "Reading",
    "SurfaceWriting",
    "Triangulating",
    "Writing",
    "coding_options",
    "console_options",
    "format_options",
    "make_reading_options",
    "product_options",
    "reading_options",
    "triangulating_options",
    "vector_options",
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
    z_unit: str | None = None
    source_crs: str | None = None
    to_crs: str | None = None
    format: str | None = None
    columns: str | dict[str, str | int] | None = None
    delimiter: str | None = None
    decimal: str | None = None
    skip_bad: bool | None = None
    check_crs: bool | None = None
    band: int | None = None
    window: tuple[float, float, float, float] | None = None
    stride: int | None = None
    most_cells: int | None = None
    nodata: tuple[float, ...] | None = None
    fill: bool | None = None
    code_blocks: str | None = None
    oriented: bool | None = None
    refraction: float | None = None
    classes: str | None = None
    returns: str | None = None
    resolution: float | None = None
    every: int | None = None
    attributes: str | None = None
    layer: str | None = None
    z_field: str | None = None
    lines_as: str | None = None
    length_unit: str | None = None
    surface: str | None = None
    content: str | None = None
    faces: str | None = None
    texts: bool | None = None
    join: bool | None = None
    variable: str | None = None
    tile: str | None = None
    remote: bool | None = None


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
    lines_z_unit: str | None = None
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
            "z_unit": self.lines_z_unit,
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
    kind: str | None = None
    projected: bool = False
    append: bool = False
    overwrite: bool = False

    @property
    def options(self) -> dict[str, Any]:
        """All that a writer may take, by the names of its options."""
        return {name: value for name, value in asdict(self).items() if name != "output_format"}


@dataclass(frozen=True)
class SurfaceWriting(Writing):
    """How a surface is written; some other commands have flags of these names for themselves."""

    multipatch: bool = False
    ortho: Path | None = None
    surface_name: str | None = None
    solid: bool = False
    thickness: float | None = None
    scale: float | None = None
    size: float | None = None
    exaggeration: float | None = None
    precision: float | None = None
    max_level: int | None = None
    gzipped: bool = False

    @property
    def options(self) -> dict[str, Any]:
        """All that a writer may take, by the names of its options."""
        found = super().options
        return found | {"surface": found.pop("surface_name"), "drape": found.pop("ortho")}


def _gather(name: str, factory: type, *options: Decorator) -> Callable[[Function], Function]:
    """Return a decorator that adds options and hands them over as one value called ``name``."""
    names = [one.name for one in fields(factory)]

    def decorate(function: Function) -> Function:
        @wraps(function)
        def gathering(**given: Any) -> Any:
            note_given(click.get_current_context())
            value = factory(**{key: given.pop(key) for key in names if key in given})
            return function(**given, **{name: value})

        decorated: Any = gathering
        for option in reversed(options):
            decorated = option(decorated)
        return decorated  # type: ignore[no-any-return]

    return decorate


def _parse_columns(
    ctx: click.Context,  # noqa: ARG001 - click's signature
    param: click.Parameter,  # noqa: ARG001 - click's signature
    value: str | None,
) -> str | dict[str, str | int] | None:
    """Return roles with the name or number of their columns if there are equals signs."""
    if value is None or "=" not in value:
        return value
    pairs = [pair.partition("=") for pair in value.split(",")]
    if not all(role.strip() and which.strip() for role, _, which in pairs):
        raise click.BadParameter(f"'{value}' mixes roles with names: easting=X,northing=Y,...")
    return {
        role.strip(): int(which) if which.strip().isdecimal() else which.strip()
        for role, _, which in pairs
    }


def _parse_given(
    ctx: click.Context,  # noqa: ARG001 - click's signature
    param: click.Parameter,  # noqa: ARG001 - click's signature
    value: tuple[float, ...],
) -> tuple[float, ...] | None:
    """Return None for none."""
    return value or None


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
        "--z-unit",
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

_TEXT = under(
    "Input: text",
    click.option(
        "--columns",
        metavar="LAYOUT",
        callback=_parse_columns,
        help="Columns of a text file: letters (PNEZD, PENZD, XYZ, ENZ; - skips one), names in "
        "their order (x,y,z), or roles (easting=X,northing=Y,elevation=3).",
    ),
    click.option(
        "--delimiter", metavar="TEXT", help="Character or text between the columns of a text file."
    ),
    click.option(
        "--decimal", type=Words([".", ","]), help="Decimal mark of the numbers in a text file."
    ),
    click.option(
        "--skip-bad",
        is_flag=True,
        default=None,
        help="Leave out rows of a text file that cannot be read, and name them.",
    ),
)

_RASTERS = under(
    "Input: rasters",
    number_option("--band", "N", "Band of a raster, counted from 1.", type=int),
    click.option(
        "--window",
        metavar="XMIN YMIN XMAX YMAX",
        type=(float, float, float, float),
        help="Part of a raster or of lidar to read, in the units of its own CRS.",
    ),
    number_option("--stride", "N", "Read every Nth row and column of a raster.", type=int),
    number_option(
        "--nodata",
        "ELEVATION",
        "Elevation that stands for no data, such as -9999. May be given several times.",
        multiple=True,
        callback=_parse_given,
    ),
    click.option(
        "--fill", is_flag=True, default=None, help="Let the surface span the voids of a raster."
    ),
)

_MESHES = under(
    "Input: meshes, LandXML, DXF",
    *MESH_READING,
    click.option(
        "--surface",
        metavar="NAME",
        help="Surface of a LandXML, UGRID or CityJSON file that has several: its name, or in "
        "LandXML its number from 1.",
    ),
    choice_option(
        "--content",
        DrawingContent,
        "What to read of a LandXML or DXF file: the triangles of a surface, the points and lines "
        "that make one, or points alone.",
    ),
    choice_option(
        "--faces",
        FacePolicy,
        "Triangles of a mesh to read, where some make no surface (no area seen from above, or "
        "overlapping larger ones): only the others; most, if at most 1 % of the area makes none; "
        "or all, or none.",
    ),
    click.option(
        "--texts",
        is_flag=True,
        default=None,
        help="Read texts of a DXF file that are numbers as points with that elevation.",
    ),
)

_INSTRUMENTS = under(
    "Input: instruments",
    click.option(
        "--code-blocks",
        type=Words(("before", "after")),
        help="Whether the code blocks of a GSI file come before or after their points.",
    ),
    click.option(
        "--oriented",
        is_flag=True,
        default=None,
        help="Use the circle readings of a GSI file as azimuths, to reduce its shots.",
    ),
    number_option(
        "--refraction",
        "K",
        "Correct shots of GSI and SDR files for earth curvature and refraction with this "
        "coefficient, such as 0.13; default no correction.",
    ),
)

_LIDAR = under(
    "Input: lidar",
    click.option(
        "--classes", metavar="N,N", help="Classes of lidar points to read, such as 2 (ground)."
    ),
    click.option(
        "--returns",
        metavar="NAME,N",
        help="Returns of lidar points to read: first, last, only, or numbers.",
    ),
    click.option(
        "--resolution",
        metavar="DISTANCE",
        type=float,
        help="Read the levels of a COPC file down to this point spacing.",
    ),
    click.option("--every", metavar="N", type=int, help="Read every Nth point of lidar."),
)

_VECTORS = under(
    "Input: vector files",
    click.option(
        "--layer",
        metavar="NAME",
        help="Layer of a vector file; for a DXF file names or patterns of layers, separated by "
        "commas, such as 'TOPO*,BREAK?'.",
    ),
    click.option(
        "--z-field",
        metavar="NAME",
        help="Column of a vector file that holds the elevations; 'geometry' for its coordinates.",
    ),
    choice_option(
        "--lines-as",
        LineReading,
        "Read the lines of a vector file as breaklines, or their vertices as points.",
    ),
)

_READING = (
    *_COORDINATES,
    *_INPUT,
    *_TEXT,
    *_RASTERS,
    *_MESHES,
    *_INSTRUMENTS,
    *_LIDAR,
    *_VECTORS,
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
    return _gather("reading", Reading, *_READING, *under("Coordinates and units", unit))


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

triangulating_options = _gather("how", Triangulating, *_TRIANGULATION, *LINE_OPTIONS)

coding_options = _gather("how", Coding, *CODE_OPTIONS)

_format_option = click.option(
    "--output-format",
    metavar="NAME",
    type=FormatName("write"),
    help="Format of the output, in place of that of its suffix.",
)
_kind_option = choice_option("--kind", FeatureKind, "Content of a GeoJSON file.")


def _make_projected_option(whose: str) -> Decorator:
    words = f"Write the coordinates of a GeoJSON file in the CRS of the {whose}."
    return click.option("--projected", is_flag=True, help=words)


_LAYER_OPTIONS = (
    click.option(
        "--append",
        is_flag=True,
        help="Add features to the layer of a GeoPackage ('-o FILE.gpkg:LAYER' names it).",
    ),
    click.option(
        "--overwrite",
        is_flag=True,
        help="Replace a layer of a GeoPackage that another program wrote or changed.",
    ),
)
_VECTOR_WRITING = (
    _format_option,
    _kind_option,
    _make_projected_option("points"),
    *_LAYER_OPTIONS,
)
writing_options = _gather(
    "writing", SurfaceWriting, *under("Output", *_VECTOR_WRITING, *MESH_WRITING)
)
vector_options = _gather("writing", Writing, *under("Output", *_VECTOR_WRITING))
product_options = _gather(
    "writing",
    Writing,
    *under("Output", _format_option, _make_projected_option("TIN"), *_LAYER_OPTIONS),
)
format_options = _gather("writing", Writing, *under("Output", _format_option))

console_options = _gather(
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
