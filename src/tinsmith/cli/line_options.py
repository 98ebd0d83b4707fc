"""Options for lines: which files they come from, and how they meet the points."""

from __future__ import annotations

from typing import Any

import click

from ..base.policies import CodeStyle, CrossingPolicy, ShotOrder, TrimPolicy
from .parameters import LibraryOption, choice_option, number_option, under
from .paths import LINES

__all__ = ["CODE_OPTIONS", "LINE_OPTIONS"]


def _make_files_option(name: str, words: str) -> Any:
    return click.option(
        name,
        metavar="FILE",
        type=LINES,
        multiple=True,
        help=f"{words} May be given several times; FILE:LAYER names a layer.",
    )


def _parse_level(
    ctx: click.Context,  # noqa: ARG001 - click's signature
    param: click.Parameter,  # noqa: ARG001 - click's signature
    value: str | None,
) -> float | str | None:
    """Return a height as a number, anything else as the name of a column."""
    if value is None:
        return None
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
    choice_option(
        "--code-style",
        CodeStyle,
        "As --codes, in this style; default that of the table, else detected.",
    ),
    number_option(
        "--arc-tolerance",
        "LENGTH",
        "Largest distance of chords from the curves of field codes, in CRS units; default 0.01 m.",
    ),
    choice_option(
        "--shot-order",
        ShotOrder,
        "What gives the order of shots along lines; default their numbers, if they have any.",
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
    _make_files_option("--boundary", "Vector file of polygons: the surface ends there."),
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
    choice_option(
        "--crossing",
        CrossingPolicy,
        "Where lines cross: add a vertex, or refuse the input.",
        default="split",
    ),
    click.option("--conforming", is_flag=True, help="Split lines until every edge is Delaunay."),
)

_TRIMMING = under(
    "Triangulation",
    number_option("--max-edge", "LENGTH", "Remove triangles with longer edges, in CRS units."),
    choice_option(
        "--trim",
        TrimPolicy,
        "Where --max-edge removes triangles: from the outside inwards, or everywhere.",
        default="perimeter",
    ),
)

LINE_OPTIONS = (*_LINES, *CODE_OPTIONS, *_TRIMMING)
