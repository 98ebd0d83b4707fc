"""``tinsmith interpolate``: the elevations of a surface at points of a file."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ...base.policies import Extrapolation, InterpolationMethod
from ...base.sentences import counted
from ..command import command
from ..job import Job, surface_options
from ..output.counts import mesh_counts
from ..output.facts import Facts
from ..output.failures import Failure
from ..parameters import choice_option, crs_option, file_option, input_file, output_files
from ..paths import Named

if TYPE_CHECKING:
    from ...io.delimited.query_points import QueryPoints
    from ...tin import TIN


@command
@input_file("file")
@file_option(
    "--at",
    "CSV file of points; its first line names the columns, all of which are kept.",
    name="points_file",
    required=True,
)
@output_files
@choice_option(
    "--method", InterpolationMethod, "Interpolation between the vertices.", default="linear"
)
@choice_option(
    "--extrapolate",
    Extrapolation,
    "Outside the surface use its nearest point; default no elevation.",
)
@click.option(
    "--at-columns",
    metavar="X Y",
    nargs=2,
    help="Columns of easting and northing, if their names are not recognised.",
)
@click.option("--at-delimiter", metavar="TEXT", help="Delimiter of the columns of --at.")
@crs_option("--at-crs", "CRS of the points of --at, if it is not that of the surface.")
@click.option(
    "--column",
    metavar="NAME",
    default="elevation",
    show_default=True,
    help="Name of the column that is added.",
)
@surface_options()
def interpolate(file: Path, points_file: Path, job: Job, **asked: Any) -> None:
    """Interpolate elevations of the TIN in FILE, or built from its points, at other points.

    Example:
      tinsmith interpolate sample_data/site_survey.csv --crs EPSG:32616
        --at places.csv --method natural -o elevations.csv
    """
    from ...base.crs import CRS
    from ...base.georeference import describe_unknown
    from ...io.delimited.query_points import read_query_points
    from ...terrain import Table

    inputs = job.list_inputs(file, more=[Named(points_file, "the file of --at")])
    planned = job.plan(inputs, "Table")
    tin = job.read_tin(file)
    points = read_query_points(
        points_file,
        columns=asked["at_columns"] or None,
        delimiter=asked["at_delimiter"],
        crs=CRS.of(asked["at_crs"]) or tin.crs,
    )
    notes = [*describe_unknown(tin.crs, tin.elevation_unit), *points.notes]
    with job.step(f"Interpolating {counted(len(points.xy), 'point')}"):
        column = asked["column"]
        if column in points.columns:
            raise Failure(
                f"The points have a column '{column}' already: name another with --column."
            )
        elevations = tin.interpolate(
            _reproject(tin, points, asked["at_crs"], notes),
            method=asked["method"],
            extrapolate=asked["extrapolate"],
            threads=job.building.threads,
        )
        table = Table(
            {**points.columns, column: elevations},
            units={column: tin.elevation_unit},
            name="elevations",
            notes=notes,
        )
    planned.write("Table", table)
    outside = int((elevations != elevations).sum())
    text = f"{outside:,} outside the surface, without elevation" if outside else "all inside"
    if asked["extrapolate"]:
        text = "elevations outside are those of the nearest point of the boundary"
    facts = Facts(file)
    facts.add("Surface", mesh_counts(tin))
    facts.add("Points", f"{len(table):,}, {text}", points=len(table), outside=outside)
    facts.add("Method", asked["method"], method=asked["method"])
    facts.note(notes)
    job.finish(planned, facts)


def _reproject(tin: TIN, points: QueryPoints, given: str | None, notes: list[str]) -> Any:
    """Return the points in the TIN's CRS; degrees and lengths are never mixed."""
    import numpy as np

    from ...base.crs import CRS
    from ...io import transform_points

    if given is None:
        if points.is_degrees and not (tin.crs is not None and tin.crs.is_geographic):
            raise Failure(
                "The points are longitudes and latitudes by their header, and the surface is not: "
                "name their CRS with --at-crs, such as EPSG:4326."
            )
        return points.xy
    source = CRS.of(given)
    if tin.crs is None:
        raise Failure("--at-crs needs a surface whose CRS is known: name it with --crs.")
    if source.is_same(tin.crs):
        return points.xy
    notes.append(f"Points were transformed from {source.label} to {tin.crs.label}.")
    flat = np.column_stack([points.xy, np.zeros(len(points.xy))])
    return transform_points(flat, source.horizontal, tin.crs.horizontal)[:, :2]
