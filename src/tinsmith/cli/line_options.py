"""Options for lines: which files they come from, and how they meet the points."""

from __future__ import annotations

from typing import Any

import click

from .parameters import LibraryOption, under
from .paths import LINES
from .product_options import list_product_options

_TRIANGULATE = "tin.construction.triangulate"


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
    *list_product_options(_TRIANGULATE, "crossing conforming"),
)

_TRIMMING = under("Triangulation", *list_product_options(_TRIANGULATE, "max_edge trim"))

LINE_OPTIONS = (*_LINES, *CODE_OPTIONS, *_TRIMMING)
