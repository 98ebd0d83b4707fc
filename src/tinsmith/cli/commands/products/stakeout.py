"""``tinsmith stakeout``: design elevations, cut and fill, stations and offsets of points."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ....base.sentences import counted
from ...command import command
from ...job import Job, name_features, surface_options
from ...option_groups import GROUND_COORDINATES, axis_options, read_axis, tell_factor
from ...options import CONSOLE, TRIANGULATING, WRITING, make_reading
from ...output import Facts, list_rows, mesh_counts, name_units
from ...parameters import file_option, input_file, numbers_option, output_option
from ...paths import Named
from ...product_options import product_options

if TYPE_CHECKING:
    from ....terrain import Features, Table


@command
@input_file("design")
@output_option("List (.csv, .json) or points (.dxf, .gpkg, .geojson, ...) to write.")
@file_option("--at", "File of the points to set out; a CSV file names its columns.", name="places")
@file_option("--ground", "Ground as it is, for cut and fill: a TIN, or points.")
@axis_options("LandXML, DXF, vector file or table of an axis: for stations and offsets.")
@product_options(
    "terrain.sections.staking.stakeout_points.stakeout",
    "stations interval layout unit",
    stations="In place of --at: points at these lengths along the axis.",
    interval="In place of --at: at multiples of it along the axis, and where elements meet.",
    layout="Columns by letters, such as PNEZD: point, northing, easting, Z (design), description, "
    "Ground, Cut, Fill, Station, Offset, Reason. Default all that are known.",
    unit="Of all lengths of the list; default that of the CRS.",
)
@numbers_option(
    "--offsets",
    "NUMBER,...",
    "At each station: to the right, negative to the left; default on the axis.",
)
@surface_options(make_reading("--length-unit"), TRIANGULATING, GROUND_COORDINATES, WRITING, CONSOLE)
def stakeout(
    design: Path,
    places: Path | None,
    ground: Path | None,
    line_file: Path | None,
    job: Job,
    **asked: Any,
) -> None:
    """List points to set out on the TIN in DESIGN, or built from the points in it.

    Each point has the elevation of the design; with --ground cut and fill, with --line station and
    offset. One beyond the design stays in the list, and is named. --decimals and --no-header give
    lists as instruments take them; drawings have the points, with labels.

    Example:
      tinsmith stakeout design.gpkg --at stakes.csv --ground ground.gpkg -o list.csv
      tinsmith stakeout design.gpkg --line road.xml --interval 10 --offsets=-3.5,0,3.5
        --layout PNEZD --decimals 3 --no-header -o list.csv
    """
    from ....terrain import stakeout as list_stakes

    given = [f"--{name}" for name in ("stations", "interval") if asked[name] is not None]
    ways = [*([] if places is None else ["--at"]), *given]
    if len(ways) != 1:
        raise click.UsageError(
            "Points to set out are needed: one of --at, --stations and --interval."
            if not ways
            else f"{ways[0]} and {ways[1]} are both given: choose one."
        )
    if given and line_file is None:
        raise click.UsageError(f"{given[0]} needs an axis: --line FILE.")
    if asked["offsets"] is not None and not given:
        raise click.UsageError("--offsets is for points at --stations or at an --interval.")
    job.ground_coordinates.require_fitting()
    surfaces = [design] if ground is None else [design, ground]
    more = name_features(line_file, "the file of --line")
    if places is not None:
        more.append(Named(places, "the file of --at"))
    planned = job.plan(job.list_inputs(*surfaces, more=more), "Table", "Features")
    tins = job.read_tins(surfaces)
    crs = tins[0].crs
    name = asked.pop("alignment")
    axis = None if line_file is None else read_axis(line_file, name, crs=crs)
    factor = job.ground_coordinates.find_factor(tins[0])
    layout = asked.pop("layout")
    how = {
        "points": None if places is None else _read_places(places, crs),
        "ground": tins[1] if ground is not None else None,
        "alignment": axis,
        "factor": factor,
        **{key: value for key, value in asked.items() if value is not None},
    }
    with job.step("Listing"):
        table = list_stakes(tins[0], layout=layout, **how)
    planned.write("Table", table)
    planned.write("Features", lambda: _make_points(table if layout is None else None, tins[0], how))
    facts = _list_facts(surfaces, table)
    for words, tin in zip(("Design", "Ground"), tins, strict=False):
        facts.add(words, mesh_counts(tin))
    tell_factor(facts, factor)
    job.finish(planned, facts)


def _read_places(path: Path, crs: Any) -> Features:
    from ....io.places import read_places

    return read_places(path, crs=crs)


def _make_points(table: Table | None, design: Any, how: dict[str, Any]) -> Features:
    """Return the points for drawings and layers, in the unit of the CRS."""
    from ....terrain import stake_points
    from ....terrain import stakeout as list_stakes

    if table is None or how.get("unit") is not None:
        table = list_stakes(design, **(how | {"unit": None}))
    factor = how["factor"]
    return stake_points(table, crs=design.crs if factor is None else factor.ground_crs)


def _list_facts(files: list[Path], table: Table) -> Facts:
    facts = Facts(inputs=[str(file) for file in files])
    facts.record(rows=list_rows(table.columns), units=name_units(table.units))
    numbers = [one for one in table.columns.values() if one.dtype.kind == "f"]
    missing = sum(any(value != value for value in row) for row in zip(*numbers, strict=True))
    text = counted(len(table), "point")
    if missing:
        text += f", {missing:,} with a number missing"
    facts.add("Points", text, points=len(table), missing=missing, columns=list(table.columns))
    facts.note(table.notes)
    return facts
