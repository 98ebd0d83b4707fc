"""``tinsmith diff``: one surface subtracted from another."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ...command import command
from ...error_options import error_options, take_errors
from ...job import Job, surface_options
from ...output import Facts, mesh_counts, name_units
from ...parameters import input_file, output_files
from ...paths import make_title

if TYPE_CHECKING:
    from ....terrain import Table


@command
@input_file("file")
@input_file("other")
@output_files
@click.option(
    "--zero-line",
    is_flag=True,
    help="Write the line between cut and fill to vector files, in place of the polygons.",
)
@click.option("--title", metavar="TEXT", help="Title of the map; default the names of the files.")
@error_options
@surface_options()
def diff(
    file: Path, other: Path, zero_line: bool, title: str | None, job: Job, **asked: Any
) -> None:
    """Subtract the TIN in FILE from that in OTHER, exactly, where both exist.

    The difference is itself a TIN (.ply, .obj, .vtu ...), above 0 where OTHER is higher.
    Statistics, weighted by area, go to .csv or .json, the parts that are cut and filled to .gpkg,
    .geojson, .shp or .fgb, a map to .png. With --level-of-detection, or --confidence and standard
    errors, what differs by no more is unchanged.

    Example:
      tinsmith diff sample_data/site_survey.csv sample_data/design_pad.csv --codes -o pad.ply
    """
    from ....terrain import difference, earthwork_map

    files, errors = (file, other), take_errors(asked)
    planned = job.plan(job.list_inputs(*files), "TIN", "Table", "Features", "picture")
    surfaces = job.read_tins(files)
    with job.step("Overlaying") as progress:
        found = difference(*surfaces, progress=progress, **errors)
    planned.write("TIN", found.tin)
    planned.write("Table", lambda: found.statistics)
    planned.write("Features", lambda: found.zero_line if zero_line else found.zones)
    title = title or f"Difference: {make_title(other)} less {make_title(file)}"
    planned.draw(lambda: earthwork_map(found, ground=surfaces[0], title=title))
    table, tin = found.statistics, found.tin
    facts = Facts(*files)
    facts.extend(zip(("First", "Other"), map(mesh_counts, surfaces), strict=True))
    facts.add(
        "Difference", mesh_counts(tin), vertices=len(tin.points), triangles=len(tin.triangles)
    )
    facts.add("Mean", f"{_format(table, 'mean')}, root mean square {_format(table, 'rms')}")
    facts.add("Range", f"{_format(table, 'lowest')} to {_format(table, 'highest')}")
    middle = f"{_format(table, 'median')}, 90 % {_format(table, 'p05')} to {_format(table, 'p95')}"
    facts.add("Middle", f"{middle}, NMAD {_format(table, 'nmad')}")
    facts.add("Area", _format(table, "area"))
    if "level_of_detection" in found.volumes.columns:
        facts.add("Changed", _list_changed(found.volumes), volumes=_list_volumes(found.volumes))
    facts.record(
        statistics={name: values[0] for name, values in table.columns.items()},
        units=name_units(table.units),
        cut=found.cut,
        fill=found.fill,
    )
    facts.note(found.notes)
    job.finish(planned, facts)


def _list_volumes(table: Table) -> dict[str, Any]:
    return {name: values[0] for name, values in table.columns.items() if name != "region"}


def _list_changed(table: Table) -> str:
    changed = table["thresholded_cut_area"][0] + table["thresholded_fill_area"][0]
    unit: Any = table.units.get("level_of_detection")
    symbol = getattr(unit, "symbol", unit) or ""
    level = f"{table['level_of_detection'][0]:,.4g} {symbol}".rstrip()
    return f"{changed:,.2f} {table.units.get('area') or ''}".rstrip() + f" by more than {level}"


def _format(table: Table, name: str) -> str:
    unit: Any = table.units.get(name)
    digits = 2 if name == "area" else 4
    return f"{table[name][0]:,.{digits}f} {getattr(unit, 'symbol', unit) or ''}".rstrip()
