"""``tinsmith coregister``: one surface shifted upon another."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...command import command
from ...job import Job, name_features, surface_options
from ...output import Facts, list_rows, mesh_counts, name_units
from ...parameters import file_option, input_file, output_files
from ...product_options import product_options

if TYPE_CHECKING:
    from ....terrain import Coregistration


@command
@input_file("file")
@input_file("reference")
@output_files
@file_option("--stable", "Vector file of polygons where the ground is the same in both.")
@file_option("--unstable", "Vector file of polygons where it is not: slides, glaciers, woods.")
@product_options(
    "terrain.gridding.coregistration.coregister",
    "spacing",
    spacing="Side of the cells in which the surfaces are compared; default the mean distance of "
    "the vertices of the coarser one.",
)
@surface_options()
def coregister(
    file: Path,
    reference: Path,
    stable: Path | None,
    unstable: Path | None,
    job: Job,
    spacing: float | None,
) -> None:
    """Shift the TIN in FILE horizontally and vertically upon that in REFERENCE.

    The shift is found by the method of Nuth and Kaab (2011) on stable ground, with weights that
    leave out what has changed. The shifted TIN goes to files of TINs (.ply, .gpkg, ...), statistics
    of the differences before and after, with their NMAD, to .csv or .json. Ground that is flat, or
    slopes to one side alone, is refused.

    Example:
      tinsmith coregister new.gpkg old.gpkg --unstable slides.geojson -o shifted.gpkg -o shift.csv
    """
    from ....terrain import coregister as find_shift

    files, polygons = (file, reference), {"stable": stable, "unstable": unstable}
    more = [
        named
        for name, path in polygons.items()
        for named in name_features(path, f"the file of --{name}")
    ]
    planned = job.plan(job.list_inputs(*files, more=more), "TIN", "Table")
    surfaces = job.read_tins(files)
    chosen: dict[str, Any] = {
        name: None if path is None else job.read_features(path, surfaces[1], "polygons")
        for name, path in polygons.items()
    }
    with job.step("Finding the shift") as progress:
        found = find_shift(*surfaces, **chosen, spacing=spacing, progress=progress)
    planned.write("TIN", found.tin)
    planned.write("Table", found.statistics)
    facts = Facts(*files)
    facts.extend(zip(("Surface", "Reference"), map(mesh_counts, surfaces), strict=True))
    _tell_shift(facts, found)
    facts.add_tin("Shifted", found.tin, report=found.tin.report.to_dict)
    facts.note(found.notes)
    job.finish(planned, facts)


def _tell_shift(facts: Facts, found: Coregistration) -> None:
    """Tell the shift, and how the surfaces differ before and after it."""
    east, north, up = found.shift
    crs, unit = found.tin.crs, found.tin.elevation_unit
    along = "" if crs is None else f" {crs.horizontal_unit.symbol}"
    rising = "" if unit is None else f" {unit.symbol}"
    words = f"{east:,.4f}{along} east, {north:,.4f}{along} north, {up:,.4f}{rising} up"
    facts.add("Shift", words, shift=list(found.shift), steps=found.steps)
    table = found.statistics
    for name, label in (("nmad", "NMAD"), ("median", "Median"), ("rms", "RMS")):
        before, after = (_format(table, name, row) for row in (0, 1))
        facts.add(label, f"{before} before, {after} after")
    facts.add("Cells", f"{int(table['cells'][1]):,}")
    rows = list_rows(table.columns)
    facts.record(statistics=rows, units=name_units(table.units))


def _format(table: Any, name: str, row: int) -> str:
    unit = getattr(table.units.get(name), "symbol", "") or ""
    return f"{table[name][row]:,.4f} {unit}".rstrip()
