"""``tinsmith interpolate``: the elevations of a surface at places."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from ..._sentences import counted
from ...policies import Extrapolation, InterpolationMethod
from ..output.failures import Failure
from ..parameters import Command, choice_option, crs_option, input_file, output_files
from ..paths import LINES, Named
from ..request import surface_options

if TYPE_CHECKING:
    from pathlib import Path

    from ...io.delimited.places import Places
    from ...terrain import Table
    from ...tin import TIN
    from ..output.console import Row
    from ..request import Request

__all__ = ["interpolate"]


@click.command(cls=Command)
@input_file("file")
@click.option(
    "--at",
    "places_file",
    metavar="FILE",
    type=LINES,
    required=True,
    help="CSV file of the places; its first line names the columns, all of which are kept.",
)
@output_files
@choice_option("--method", InterpolationMethod, "What lies between the vertices.", default="linear")
@choice_option(
    "--extrapolate",
    Extrapolation,
    "Take the nearest place of the surface outside it; default no elevation.",
)
@click.option(
    "--places-columns",
    metavar="X Y",
    nargs=2,
    help="Columns of easting and northing, if their names do not say.",
)
@click.option("--places-delimiter", metavar="TEXT", help="What separates the columns of places.")
@crs_option("--places-crs", "CRS of the places, if it is not the surface's.")
@click.option(
    "--column",
    metavar="NAME",
    default="elevation",
    show_default=True,
    help="Name of the column that is added.",
)
@surface_options()
def interpolate(
    file: Path,
    places_file: Path,
    request: Request,
    **asked: Any,
) -> None:
    """Find the elevations of the TIN in FILE, or that of the points in it, at places.

    \b
    Example:
      tinsmith interpolate sample_data/site_survey.csv --crs EPSG:32616
        --at places.csv --method natural -o elevations.csv
    """  # noqa: D301 - click reads the control character
    from ...io.delimited.places import read_places
    from ...terrain.georeference import describe_unknown

    inputs = request.list_inputs(file, more=[Named(places_file, "the file of --at")])
    planned = request.plan(inputs, "Table")
    tin = request.read_tin(file)
    places = read_places(
        places_file,
        columns=asked["places_columns"] or None,
        delimiter=asked["places_delimiter"],
    )
    notes = [*describe_unknown(tin.crs, tin.elevation_unit), *places.notes]
    with request.step(f"Interpolating {counted(len(places.xy), 'place')}"):
        table = _interpolate(tin, places, notes, request.how.threads, asked)
    planned.write("Table", table)
    outside = _count_outside(table, asked["column"])
    record = {"input": str(file), "places": len(table), "method": asked["method"]}
    record |= {"outside": outside, "notes": notes}
    rows = _summarise_places(tin, table, outside, notes, asked)
    request.finish(planned, rows, lambda: record)


def _interpolate(
    tin: TIN, places: Places, notes: list[str], threads: int | None, asked: dict[str, Any]
) -> Table:
    from ...terrain import Table

    column = asked["column"]
    if column in places.columns:
        raise Failure(f"The places have a column '{column}' already: name another with --column.")
    elevations = tin.interpolate(
        _reproject_places(tin, places, asked["places_crs"], notes),
        asked["method"],
        extrapolate=asked["extrapolate"],
        threads=threads,
    )
    return Table(
        {**places.columns, column: elevations},
        units={column: tin.elevation_unit},
        name="elevations",
        notes=notes,
    )


def _reproject_places(tin: TIN, places: Places, given: str | None, notes: list[str]) -> Any:
    """Return the places in the TIN's CRS; degrees and lengths are never mixed."""
    import numpy as np

    from ...crs import CRS
    from ...io import transform_points

    if given is None:
        if places.is_degrees and not (tin.crs is not None and tin.crs.is_geographic):
            raise Failure(
                "The places are longitudes and latitudes by their header, and the surface is not: "
                "name their CRS with --places-crs, such as EPSG:4326."
            )
        return places.xy
    source = CRS.of(given)
    if tin.crs is None:
        raise Failure("--places-crs needs a surface whose CRS is known: name it with --crs.")
    if source.is_same(tin.crs):
        return places.xy
    notes.append(f"Places were transformed from {source.label} to {tin.crs.label}.")
    flat = np.column_stack([places.xy, np.zeros(len(places.xy))])
    return transform_points(flat, source.horizontal, tin.crs.horizontal)[:, :2]


def _count_outside(table: Table, column: str) -> int:
    import numpy as np

    return int(np.isnan(table[column]).sum())


def _summarise_places(
    tin: TIN, table: Table, outside: int, notes: list[str], asked: dict[str, Any]
) -> list[Row]:
    from ..output.line_summaries import mesh_counts

    told = f"{outside:,} outside the surface, without elevation" if outside else "all inside"
    if asked["extrapolate"]:
        told = "elevations outside are those of the nearest place"
    return [
        ("Surface", mesh_counts(tin)),
        ("Places", f"{len(table):,}, {told}"),
        ("Method", asked["method"]),
        *[("Note", note) for note in notes],
    ]
