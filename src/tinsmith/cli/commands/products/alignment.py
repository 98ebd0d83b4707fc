"""``tinsmith alignment``: what an alignment is made of, and where points are along it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ....base.sentences import counted
from ...command import command
from ...job import Job, surface_options
from ...option_groups import alignment_option, read_axis
from ...options import CONSOLE, WRITING
from ...output import Facts, Failure
from ...parameters import crs_option, file_option, input_file, number_option, output_option
from ...paths import Named

if TYPE_CHECKING:
    from ....terrain import Alignment, Table

_SHOWN = 40


@command
@input_file("file")
@output_option(
    "Table (.csv, .json), alignment (.xml, LandXML) or polyline (.gpkg, .geojson, ...) to write."
)
@alignment_option("the file")
@file_option(
    "--at",
    "CSV file of points, whose stations and offsets are added as columns.",
    name="points_file",
)
@number_option("--interval", "LENGTH", "Write points at multiples of it, and where elements meet.")
@number_option("--offset", "LENGTH", "Of these points: to the right, negative to the left.")
@number_option(
    *("--tolerance", "LENGTH", "How far a polyline that is written may lie from curves."),
    default=0.001,
)
@crs_option("--crs", "CRS of coordinates, where the file does not name it; nothing is reprojected.")
@click.option("--unit", metavar="UNIT", help="Unit of all lengths, where the file does not say.")
@surface_options(WRITING, CONSOLE)
def alignment(file: Path, points_file: Path | None, job: Job, **asked: Any) -> None:
    """Describe the alignment in FILE: LandXML, a DXF drawing, or a file of one line.

    Its elements are listed, with --interval points along it, with --at where points are. Tables
    are written to .csv or .json, the alignment itself to LandXML (.xml), or as a polyline to .gpkg,
    .geojson and others.

    Example:
      tinsmith alignment road.xml -o elements.csv
      tinsmith alignment road.xml --interval 20 -o stations.csv
      tinsmith alignment road.xml --at stakes.csv -o offsets.csv
    """
    if points_file is not None and asked["interval"] is not None:
        raise click.UsageError("--at and --interval are both given: choose one.")
    if asked["offset"] is not None and asked["interval"] is None:
        raise click.UsageError("--offset is for points at an --interval.")
    more = [] if points_file is None else [Named(points_file, "the file of --at")]
    planned = job.plan(job.list_inputs(file, more=more), "Table", "Features", "Alignment")
    chosen = {name: asked[name] for name in ("crs", "unit") if asked[name] is not None}
    road = read_axis(file, asked["alignment"], **chosen)
    table = _make_table(road, points_file, asked)
    planned.write("Table", table)
    planned.write("Features", lambda: road.to_features(asked["tolerance"]))
    planned.write("Alignment", road)
    job.finish(planned, _list_facts(file, road, table))


def _make_table(road: Alignment, points_file: Path | None, asked: dict[str, Any]) -> Table:
    if points_file is not None:
        return _find_stations(road, points_file)
    if asked["interval"] is not None:
        return road.tabulate_points(asked["interval"], offset=asked["offset"] or 0.0)
    return road.tabulate()


def _find_stations(road: Alignment, path: Path) -> Table:
    """Return the points of a file with their stations and offsets as further columns."""
    from ....io.delimited import read_query_points

    points = read_query_points(path, crs=road.crs)
    if points.is_degrees:
        raise Failure(
            "The points are longitudes and latitudes by their header, and an alignment is measured "
            "in lengths: transform them to its CRS first."
        )
    found = road.stations_of(points.xy)
    added = {name: values for name, values in found.columns.items() if name not in ("x", "y")}
    taken = sorted(set(added) & set(points.columns))
    if taken:
        raise click.UsageError(f"The points of --at have a column '{taken[0]}' already.")
    units = {name: unit for name, unit in found.units.items() if name in added}
    made = replace(found, columns={**points.columns, **added}, units=units)
    return made.with_notes(points.notes)


def _list_facts(file: Path, road: Alignment, table: Table) -> Facts:
    facts = Facts(file)
    crs = "not known" if road.crs is None else road.crs.caption
    facts.add("Alignment", road.name or "without a name", name=road.name)
    facts.add("CRS", crs)
    length = f"{road.length:.3f}, from station {road.start:.3f} to {road.end:.3f}"
    facts.add("Length", length, length=road.length, start=road.start, end=road.end)
    kinds = [element.kind for element in road.elements]
    listed = ", ".join(counted(kinds.count(kind), kind) for kind in dict.fromkeys(kinds))
    facts.add("Elements", listed, elements=len(kinds))
    for equation in road.equations:
        facts.add("Equation", f"{equation.station:.3f} = {equation.ahead:.3f} ahead")
    for vertical in road.verticals[:_SHOWN]:
        facts.add("Vertical", repr(vertical).strip("<>"))
    facts.add("Rows", f"{len(table):,}", rows=len(table), columns=list(table.columns))
    facts.note(table.notes)
    return facts
