"""``tinsmith flow``: where water runs on a TIN, and where it stands."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ....base.policies import FlowProduct
from ...command import file_command
from ...job import Job, name_features, surface_options
from ...output import describe_features, name_unit
from ...parameters import choice_option, file_option, number_option, position_option

if TYPE_CHECKING:
    from ....base.progress import Tell
    from ....terrain import Features
    from ....tin import TIN

_SHOWN = 8
_TOLD = ("kind", "end", "length", "drop", "pit_level", "spill_level", "depth", "area", "volume")
_FLAGS = {
    "begins": ("--from", ("paths", "catchments")),
    "points": ("--points", ("paths", "catchments")),
    "level": ("--level", ("ponds",)),
    "min_depth": ("--min-depth", ("depressions",)),
    "nested": ("--nested", ("depressions",)),
    "min_area": ("--min-area", ("accumulation",)),
    "min_angle": ("--min-angle", ("ridges",)),
    "fill_depressions": ("--fill-depressions", ("paths", "catchments", "accumulation")),
}


@file_command
@choice_option("--find", FlowProduct, "What to find.", default="depressions")
@position_option(
    "--from",
    "begins",
    "Start of a path, or outlet of a catchment. May be given several times.",
    multiple=True,
)
@file_option("--points", "Vector file of such points.")
@number_option("--level", "ELEVATION", "Level of the water, for ponds.")
@number_option("--min-depth", "HEIGHT", "Leave out shallower depressions.")
@click.option("--nested", is_flag=True, help="Include depressions that are part of larger ones.")
@number_option(
    "--min-angle",
    "DEGREES",
    "Leave out ridges and valleys with a smaller angle between their triangles.",
)
@number_option("--min-area", "AREA", "Leave out channels with a smaller drainage area.")
@click.option(
    "--fill-depressions",
    is_flag=True,
    help="Continue from the spill points of full depressions, to the boundary.",
)
@surface_options()
def flow(file: Path, find: FlowProduct, job: Job, **asked: Any) -> None:
    """Find where water flows on the TIN in FILE, or built from the points in it.

    Finds paths of steepest descent, pits, depressions with their volume, ponds at a level, ridges
    and valleys, catchments of pits or outlets, or the area that drains through each channel. Water
    leaves the surface at its boundary. Vector files get the features, tables (.csv, .json) their
    columns.

    Example:
      tinsmith flow sample_data/jacksboro.tif --min-depth 1 -o depressions.gpkg
      tinsmith flow site.ply --find paths --from 752700 4024300 -o path.geojson
      tinsmith flow site.ply --find catchments --fill-depressions -o basins.gpkg
    """
    from ....base.results import tabulate_columns

    for name, (flag, products) in _FLAGS.items():
        if asked[name] not in (None, False, ()) and find not in products:
            raise click.UsageError(f"{flag} is for --find {products[0]}, not {find}.")
    if find == "paths" and bool(asked["begins"]) == (asked["points"] is not None):
        raise click.UsageError("Where drops fall is needed: --from X Y, or --points FILE.")
    if asked["begins"] and asked["points"] is not None:
        raise click.UsageError("Outlets are given by --from X Y, or by --points FILE: not by both.")
    if find == "ponds" and asked["level"] is None:
        raise click.UsageError("A level is needed for ponds: --level ELEVATION.")
    inputs = job.list_inputs(file, more=name_features(asked["points"], "the file of --points"))
    planned = job.plan(inputs, "Features", "Table")
    tin = job.read_tin(file)
    with job.step("Finding") as progress:
        found = _find(tin, find, asked, job, progress)
    planned.write("Features", found)
    planned.write("Table", tabulate_columns(found))
    facts = describe_features(file, tin, found)
    facts.add("Found", f"{found.name}: {len(found):,}", find=find)
    for row in range(min(len(found), _SHOWN) if "angle" not in found.columns else 0):
        facts.add("" if row else "First", _describe_row(found, row))
    job.finish(planned, facts)


def _find(tin: TIN, find: str, asked: dict[str, Any], job: Job, progress: Tell) -> Features:
    from .... import terrain

    places: Any = [list(place) for place in asked["begins"]] or None
    if asked["points"] is not None:
        places = job.read_features(asked["points"], tin, "points")
    is_full = asked["fill_depressions"]
    if find == "paths":
        return terrain.flow_path(tin, places, fill_depressions=is_full)
    if find == "pits":
        return terrain.pits(tin)
    if find == "ponds":
        return terrain.ponds(tin, asked["level"])
    if find == "catchments":
        return terrain.catchments(tin, places, fill_depressions=is_full, progress=progress)
    if find == "accumulation":
        least = asked["min_area"] or 0.0
        return terrain.flow_accumulation(
            tin, min_area=least, fill_depressions=is_full, progress=progress
        )
    if find == "ridges":
        return terrain.ridges_and_valleys(tin, min_angle=asked["min_angle"] or 0.0)
    return terrain.depressions(tin, nested=asked["nested"], min_depth=asked["min_depth"] or 0.0)


# ---------------------------------------------------------------- for people


def _describe_row(found: Features, row: int) -> str:
    parts = []
    for name in _TOLD:
        if name in found.columns:
            value = found.columns[name][row]
            is_measured = found.columns[name].dtype.kind == "f"
            text = f"{value:,.2f}" if is_measured else str(value)
            unit = name_unit(found.units, name)
            parts.append(f"{name.replace('_', ' ')} {text} {unit}".strip())
    return ", ".join(parts)
