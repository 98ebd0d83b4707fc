"""``tinsmith grade``: a pad with side slopes, put into the ground."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ....base.sentences import counted
from ...command import file_command
from ...job import Job, name_features, surface_options
from ...output import Facts, Failure, list_rows, mesh_counts, name_units
from ...parameters import file_option
from ...product_options import product_options

if TYPE_CHECKING:
    from ....terrain import Table
    from ....tin import TIN

_FACTORS = {"shrink_factor": 1.0, "swell_factor": 1.0, "surplus": 0.0}


@file_command
@file_option("--pad", "Vector file of one polygon: the pad.", required=True)
@product_options(
    "terrain.earthwork.grading.grades.grade",
    "elevation cut_slope fill_slope gradient",
    cut_slope="Slope of cuts, horizontal over vertical: 2 is 2:1.",
    fill_slope="Slope of fills, horizontal over vertical.",
)
@click.option(
    "--balance",
    is_flag=True,
    help="Find the elevation at which the cut makes the fill, in place of --elevation.",
)
@product_options("terrain.earthwork.grading.balances.balance", "shrink_factor swell_factor surplus")
@file_option(
    "--fixed",
    "Vector file of polygons that the pad and its slopes do not change: the ground stays, or the "
    "level in a column z, level, elevation or height, or of the corners.",
)
@surface_options()
def grade(
    file: Path,
    pad: Path,
    elevation: float | None,
    balance: bool,
    fixed: Path | None,
    job: Job,
    **asked: Any,
) -> None:
    r"""Grade a pad into the TIN in FILE, or built from the points in it.

    Side slopes rise from the edge of the pad in cuts and fall in fills, to the daylight line,
    where they meet the ground. The summary gives cut and fill; with --balance those at the
    elevation where they are in balance, which a table (.csv, .json) tells too.

    Example:
      tinsmith grade sample_data/site_survey.csv --codes --crs EPSG:32616 --pad pad.geojson \
        --elevation 326 --cut-slope 2 --fill-slope 3 -o graded.gpkg
      tinsmith grade sample_data/site_survey.csv --codes --crs EPSG:32616 --pad pad.geojson \
        --balance --shrink-factor 0.9 --cut-slope 2 --fill-slope 3 -o graded.gpkg -o pad.csv
    """
    from ....terrain import balance as balance_pad
    from ....terrain import grade as grade_tin
    from ....terrain import volume

    factors = {name: asked.pop(name) for name in _FACTORS}
    _require_one(elevation, factors, balance=balance)
    kinds = ("TIN", "Table") if balance else ("TIN",)
    more = [*name_features(pad, "--pad"), *name_features(fixed, "--fixed")]
    planned = job.plan(job.list_inputs(file, more=more), *kinds)
    tin = job.read_tin(file)
    notes: list[str] = []
    ring = _read_ring(pad, tin, job, notes, drape=elevation is not None or balance)
    if fixed is not None:
        asked["fixed"] = _read_fixed(fixed, tin, job, notes)
    rows: list[tuple[str, str]] = []
    with job.step("Grading") as progress:
        if balance:
            found = balance_pad(tin, ring, **asked, **factors, progress=progress)
            graded, table, rows = found.tin, found.table, _list_balance(found.table)
        else:
            graded = grade_tin(tin, ring, elevation, **asked, progress=progress)
            table = volume(tin, graded)
    planned.write("TIN", graded)
    planned.write("Table", table)
    unit = table.units.get("cut") or "cubic units of the CRS"
    volumes = {name: float(table[name][0]) for name in ("cut", "fill", "cut_area", "fill_area")}
    facts = Facts(file)
    facts.add("Ground", mesh_counts(tin))
    facts.add_tin("Graded", graded, volume=volumes)
    for name in ("cut", "fill"):
        facts.add(name.capitalize(), f"{volumes[name]:,.1f} {unit}")
    facts.extend(rows)
    if balance:
        facts.record(balance=list_rows(table.columns)[0], units=name_units(table.units))
    facts.note([*notes, *table.notes])
    job.finish(planned, facts)


def _require_one(elevation: float | None, factors: dict[str, float], *, balance: bool) -> None:
    """Refuse an elevation of what is sought, and factors of what is not."""
    if balance and elevation is not None:
        raise click.UsageError("--elevation and --balance are both given: choose one.")
    for name, value in factors.items():
        if not balance and value != _FACTORS[name]:
            raise click.UsageError(f"--{name.replace('_', '-')} is for --balance.")


def _read_ring(path: Path, tin: TIN, job: Job, notes: list[str], *, drape: bool) -> Any:
    """Return the one ring of a file of a pad."""
    from ....io import read_polygons
    from ....io.vector import split_layer

    named, layer = split_layer(path)
    found: Any = read_polygons(
        named,
        crs=tin.crs,
        target_unit=tin.elevation_unit,
        elevation_unit=job.building.lines_elevation_unit,
        layer=layer,
        drape=drape,
        notes=notes,
    )
    if len(found) != 1 or len(found[0]) != 1:
        rings = sum(map(len, found))
        held = f"{counted(len(found), 'polygon')} of {counted(rings, 'ring')}"
        raise Failure(f"'{named}' holds {held}: a pad is one ring.")
    return found[0][0]


def _read_fixed(path: Path, tin: TIN, job: Job, notes: list[str]) -> Any:
    """Return the rings of a file of fixed regions, with their levels."""
    from ....io.vector import read_fixed_regions, split_layer

    named, layer = split_layer(path)
    return read_fixed_regions(
        named,
        crs=tin.crs,
        target_unit=tin.elevation_unit,
        elevation_unit=job.building.lines_elevation_unit,
        layer=layer,
        notes=notes,
    )


def _list_balance(table: Table) -> list[tuple[str, str]]:
    unit: Any = table.units.get("elevation")
    volume = table.units.get("cut") or "cubic units"
    symbol = getattr(unit, "symbol", unit) or ""
    step = "cm" if symbol == "m" else f"0.01 {symbol}".rstrip()
    values = {name: float(column[0]) for name, column in table.columns.items()}
    made = f"{values['fill_from_cut']:,.1f} {volume} of fill made of the cut"
    if values["haul"] != values["cut"]:
        made += f", {values['haul']:,.1f} {volume} loose to haul"
    return [
        ("Elevation", f"{values['elevation']:,.4f} {symbol}".rstrip()),
        ("Balance", f"{round(values['balance'], 1) + 0.0:,.1f} {volume} left, {made}"),
        ("Sensitivity", f"{values['sensitivity'] / 100:,.2f} {volume} less for each {step} higher"),
    ]
