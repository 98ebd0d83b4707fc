"""``tinsmith interpolate``: the elevations of a surface at places."""

from __future__ import annotations

from time import perf_counter
from typing import TYPE_CHECKING, Any, get_args

import click

from ..._sentences import counted
from ...policies import Extrapolation, InterpolationMethod
from ..options import (
    console_options,
    input_file,
    output_files,
    product_options,
    reading_options,
    triangulating_options,
)
from ..output.console import format_json
from ..output.failures import Failure
from ..paths import LINES, Named

if TYPE_CHECKING:
    from pathlib import Path

    from ...io.delimited.places import Places
    from ...terrain import Table
    from ...tin import TIN
    from ..files import Output
    from ..options import Reading, Triangulating, Writing
    from ..output.console import Console

__all__ = ["interpolate"]


@click.command(short_help="Find the elevations of a surface at the places of a CSV file.")
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
@click.option(
    "--method",
    type=click.Choice(get_args(InterpolationMethod)),
    default="linear",
    show_default=True,
    help="What lies between the vertices.",
)
@click.option(
    "--extrapolate",
    type=click.Choice(get_args(Extrapolation)),
    help="Take the nearest place of the surface outside it; default no elevation.",
)
@click.option(
    "--places-columns",
    metavar="X Y",
    nargs=2,
    help="Columns of easting and northing, if their names do not say.",
)
@click.option("--places-delimiter", metavar="TEXT", help="What separates the columns of places.")
@click.option("--places-crs", metavar="CRS", help="CRS of the places, if it is not the surface's.")
@click.option(
    "--column",
    metavar="NAME",
    default="elevation",
    show_default=True,
    help="Name of the column that is added.",
)
@reading_options
@triangulating_options
@product_options
@console_options
def interpolate(
    file: Path,
    places_file: Path,
    outputs: tuple[Path, ...],
    reading: Reading,
    how: Triangulating,
    writing: Writing,
    console: Console,
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
    from ..files import list_inputs, plan_outputs, read_tin, write_outputs

    started = perf_counter()
    inputs = [*list_inputs(file, how), Named(places_file, "the file of --at")]
    planned = plan_outputs(outputs, writing, inputs=inputs, console=console, kinds=("Table",))
    tin, _ = read_tin(file, reading, how, console)
    places = read_places(
        places_file,
        columns=asked["places_columns"] or None,
        delimiter=asked["places_delimiter"],
    )
    notes = [*describe_unknown(tin.crs, tin.elevation_unit), *places.notes]
    table = _table(tin, places, notes, how.threads, asked, console)
    write_outputs(table, planned, console)
    _tell(table, tin, planned, notes, started, asked, console)
    if console.as_json:
        facts = {"input": str(file), "places": len(table), "method": asked["method"]}
        facts |= {"outside": _outside(table, asked["column"]), "notes": notes}
        console.emit(format_json(facts | {"outputs": [str(one.path) for one in planned]}))


def _table(
    tin: TIN,
    places: Places,
    notes: list[str],
    threads: int | None,
    asked: dict[str, Any],
    console: Console,
) -> Table:
    from ...terrain import Table

    column = asked["column"]
    if column in places.columns:
        raise Failure(f"The places have a column '{column}' already: name another with --column.")
    with console.steps() as steps, steps.step(f"Interpolating {counted(len(places.xy), 'place')}"):
        elevations = tin.interpolate(
            _in_crs_of(tin, places, asked["places_crs"], notes),
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


def _in_crs_of(tin: TIN, places: Places, given: str | None, notes: list[str]) -> Any:
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


def _outside(table: Table, column: str) -> int:
    import numpy as np

    return int(np.isnan(table[column]).sum())


def _tell(
    table: Table,
    tin: TIN,
    planned: list[Output],
    notes: list[str],
    started: float,
    asked: dict[str, Any],
    console: Console,
) -> None:
    from ..files import describe_written
    from ..output.line_summaries import mesh_counts

    outside = _outside(table, asked["column"])
    told = f"{outside:,} outside the surface, without elevation" if outside else "all inside"
    if asked["extrapolate"]:
        told = "elevations outside are those of the nearest place"
    console.summarise(
        [
            ("Surface", mesh_counts(tin)),
            ("Places", f"{len(table):,}, {told}"),
            ("Method", asked["method"]),
            *[("Note", note) for note in notes],
            ("Written", describe_written(planned)),
            ("Time", f"{perf_counter() - started:.2f} s"),
        ]
    )
