"""``tinsmith interpolate``: the elevations of a surface at points of a file."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ....base.policies import Extrapolation, InterpolationMethod
from ....base.sentences import counted
from ...command import command
from ...job import Job
from ...output import Facts, Failure, mesh_counts
from ...parameters import choice_option, crs_option, file_option, input_file, output_files
from ...paths import Named
from ...tiling import choose_tiles, compute_tiles, describe_points, tiled_options

if TYPE_CHECKING:
    from ....base.crs import CRS
    from ....io.delimited import QueryPoints
    from ....terrain import Table
    from ....tin import TIN


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
@tiled_options()
def interpolate(file: Path, points_file: Path, job: Job, **asked: Any) -> None:
    """Interpolate elevations of the TIN in FILE, or built from its points, at other points.

    Example:
      tinsmith interpolate sample_data/site_survey.csv --crs EPSG:32616
        --at places.csv --method natural -o elevations.csv
    """
    inputs = job.list_inputs(file, more=[Named(points_file, "the file of --at")])
    planned = job.plan(inputs, "Table")
    cloud = choose_tiles(job, file, whole=_name_whole(asked))
    if cloud is not None:
        points = _read_places(points_file, cloud.crs, asked)
        with compute_tiles(cloud, "places", planned, job, places=points.xy) as made:
            table = _add_columns(points, made["elevation"], made.units["elevation"], asked)
            table = table.with_notes(made.notes)
            planned.write("Table", table)
        surface = describe_points(cloud)
    else:
        tin = job.read_tin(file)
        points = _read_places(points_file, tin.crs, asked)
        table = _interpolate(tin, points, asked, job)
        planned.write("Table", table)
        surface = mesh_counts(tin)
    elevations = table[asked["column"]]
    outside = int((elevations != elevations).sum())
    text = f"{outside:,} outside the surface, without elevation" if outside else "all inside"
    if asked["extrapolate"]:
        text = "elevations outside are those of the nearest point of the boundary"
    facts = Facts(file)
    facts.add("Surface", surface)
    facts.add("Points", f"{len(table):,}, {text}", points=len(table), outside=outside)
    facts.add("Method", asked["method"], method=asked["method"])
    facts.note(table.notes)
    job.finish(planned, facts)


def _name_whole(asked: dict[str, Any]) -> str:
    """Return the option that needs the whole surface, if one does."""
    if asked["extrapolate"] is not None:
        return "--extrapolate"
    return "" if asked["method"] == "linear" else f"--method {asked['method']}"


def _interpolate(tin: TIN, points: QueryPoints, asked: dict[str, Any], job: Job) -> Table:
    from ....base.georeference import describe_unknown

    with job.step(f"Interpolating {counted(len(points.xy), 'point')}"):
        elevations = tin.interpolate(
            points.xy,
            method=asked["method"],
            extrapolate=asked["extrapolate"],
            threads=job.building.threads,
        )
        table = _add_columns(points, elevations, tin.elevation_unit, asked)
    return table.with_notes(describe_unknown(tin.crs, tin.elevation_unit))


def _add_columns(points: QueryPoints, elevations: Any, unit: Any, asked: dict[str, Any]) -> Table:
    """Return the table of the points with their elevations."""
    from ....terrain import Table

    column = asked["column"]
    return Table(
        {**points.columns, column: elevations},
        units={column: unit},
        name="elevations",
        notes=points.notes,
    )


# ---------------------------------------------------------------- the points


def _read_places(path: Path, crs: CRS | None, asked: dict[str, Any]) -> QueryPoints:
    """Read the points of --at, in the CRS of the surface."""
    from ....base.crs import CRS
    from ....io.delimited import read_query_points

    given, column = asked["at_crs"], asked["column"]
    points = read_query_points(
        path,
        columns=asked["at_columns"] or None,
        delimiter=asked["at_delimiter"],
        crs=CRS.of(given) or crs,
    )
    if column in points.columns:
        raise Failure(f"The points have a column '{column}' already: name another with --column.")
    return _reproject(points, crs, given)


def _reproject(points: QueryPoints, crs: CRS | None, given: str | None) -> QueryPoints:
    """Return the points in the surface's CRS; degrees and lengths are never mixed."""
    import numpy as np

    from ....base.crs import CRS
    from ....io import transform_points

    if given is None:
        if points.is_degrees and not (crs is not None and crs.is_geographic):
            raise Failure(
                "The points are longitudes and latitudes by their header, and the surface is not: "
                "name their CRS with --at-crs, such as EPSG:4326."
            )
        return points
    source = CRS.of(given)
    if crs is None:
        raise Failure("--at-crs needs a surface whose CRS is known: name it with --crs.")
    if source.is_same(crs):
        return points
    note = f"Points were transformed from {source.label} to {crs.label}."
    flat = np.column_stack([points.xy, np.zeros(len(points.xy))])
    moved = transform_points(flat, source.horizontal, crs.horizontal)[:, :2]
    return replace(points, xy=moved, notes=(*points.notes, note))
