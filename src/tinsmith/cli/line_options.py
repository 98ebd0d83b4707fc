"""Options for lines: which files they come from, and how they meet the points."""

from __future__ import annotations

from typing import Any

import click

from ..policies import CodeStyle, CrossingPolicy, TrimPolicy
from .parameters import choice_option, number_option, under
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
        help="Make lines of the points' own codes, such as EP1 BEG, EP1, EP1 END, BLDG1 CLS.",
    ),
    click.option(
        "--code-table",
        metavar="FILE",
        type=LINES,
        help="As --codes, by a table of codes (TOML): what each becomes, and how they are written.",
    ),
    choice_option(
        "--code-style",
        CodeStyle,
        "As --codes, in this style; default that of the table, else the one that fits.",
    ),
    number_option(
        "--arc-tolerance",
        "LENGTH",
        "By which the chords of curves among the codes may leave them, in CRS units; default "
        "0.01 m.",
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
        help="Height of the water, or the column that holds it.",
    ),
    click.option(
        "--lines-z-unit",
        metavar="UNIT",
        help="Unit of the elevations in the files of lines, where they do not say.",
    ),
    click.option(
        "--drape", is_flag=True, help="Take the heights of lines in files from the surface."
    ),
    choice_option(
        "--crossing",
        CrossingPolicy,
        "Where lines cross: make a vertex there, or refuse.",
        default="split",
    ),
    click.option(
        "--conforming", is_flag=True, help="Split lines until every edge is Delaunay by itself."
    ),
)

_TRIMMING = under(
    "Triangulation",
    number_option("--max-edge", "LENGTH", "Drop triangles with longer edges, in CRS units."),
    choice_option(
        "--trim",
        TrimPolicy,
        "Where --max-edge drops them: from the outside inwards, or everywhere.",
        default="perimeter",
    ),
)

LINE_OPTIONS = (*_LINES, *CODE_OPTIONS, *_TRIMMING)
