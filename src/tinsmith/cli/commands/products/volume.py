"""``tinsmith volume``: cut and fill, or how much a pond holds."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ....base.products import notes_of_surfaces
from ....base.sentences import counted
from ...command import command
from ...error_options import error_options, name_flag, take_errors
from ...job import Job, name_features
from ...option_groups import name_title_block, sheet_options
from ...output import Facts, list_rows, mesh_counts, name_units
from ...parameters import file_option, number_option, output_option
from ...paths import INPUT, STANDARD, make_title
from ...tiling import (
    choose_other,
    choose_tiles,
    compute_tiles,
    describe_points,
    tiled_options,
)

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ....terrain import Table
    from ....tiled.tiled_points import TiledPoints
    from ...output import Row
    from ...outputs import Products

_SHOWN = 12
_CUBIC_YARD = 27.0
"""Cubic feet, of either foot."""
_FEET = ("ft³", "US ft³")
_LEAST_AREA = 0.005
"""Areas below are written as 0.00: what rounding leaves of a region inside the surface."""


@command
@click.argument("files", metavar="GROUND [DESIGN]", nargs=-1, required=True, type=INPUT)
@output_option(
    "Table (.csv, .json), parts that are cut and filled (.gpkg, .geojson, .shp, .fgb), map (.png) "
    "or report to sign (.pdf) to write."
)
@number_option("--base", "ELEVATION", "Level in place of a design.")
@file_option(
    "--regions",
    "Vector file of polygons within which to measure; a column name, region, id or label names "
    "them.",
)
@click.option(
    "--stage-storage",
    is_flag=True,
    help="Tabulate area and volume of water in GROUND at each level.",
)
@number_option("--level", "ELEVATION", "Level of the table.", name="levels", multiple=True)
@number_option("--interval", "LENGTH", "Interval of the levels of the table.")
@sheet_options("title date title_block ground_unit")
@error_options
@tiled_options()
def volume(files: tuple[Path, ...], regions: Path | None, job: Job, **asked: Any) -> None:
    r"""Compute cut and fill from the TIN in GROUND to that in DESIGN, or to a level.

    Both triangulations are overlaid exactly; either file may hold points, from which the TIN is
    built. Fill is where the design, or the level, is above the ground, cut where it is below. With
    the standard errors of elevations volumes get theirs.

    Example:
      tinsmith volume sample_data/site_survey.csv sample_data/design_pad.csv --codes -o pad.csv
      tinsmith volume sample_data/site_survey.csv --crs EPSG:32616 --base 325 -o cut.gpkg
      tinsmith volume sample_data/site_survey.csv --stage-storage --interval 0.5 -o stages.csv
      tinsmith volume sample_data/site_survey.csv --base 325 --standard-error 0.02 -o errors.csv
    """
    from ....terrain import difference, earthwork_map, stage_storage, volume_report
    from ....terrain import volume as measure

    errors = take_errors(asked)
    _require_one_base(files, asked, errors)
    more = name_features(regions, "the file of --regions")
    inputs = job.list_inputs(*files, more=[*more, *name_title_block(asked["title_block"])])
    kinds = ["Table"] if asked["stage_storage"] else ["Table", "Features", "picture", "report"]
    planned = job.plan(inputs, *kinds)
    words = _take_words(files, asked, planned)
    whole = _name_whole(asked, planned, errors)
    cloud = choose_tiles(job, files[0], whole=whole, others=files[1:])
    if cloud is not None:
        _measure_tiles(cloud, planned, files, {"regions": regions, "base": asked["base"]}, job)
        return
    surfaces = job.read_tins(files)
    chosen = None if regions is None else job.read_features(regions, surfaces[0], "polygons")
    base = asked["base"] if len(surfaces) == 1 else None
    report = None
    how = {"base": base, "regions": chosen, **errors}
    with job.step("Measuring") as progress:
        if asked["stage_storage"]:
            levels, interval = asked["levels"] or None, asked["interval"]
            table = stage_storage(surfaces[0], levels=levels, interval=interval, region=chosen)
        elif planned.holds("report"):
            told = {"files": files, **words, **how}
            report = volume_report(*surfaces, progress=progress, **told)
            found = report.difference
            table = found.volumes
        elif planned.holds("Features") or planned.holds("picture"):
            found = difference(*surfaces, progress=progress, **how)
            table = found.volumes  # of the same overlay
        else:
            table = measure(*surfaces, progress=progress, **how)
    planned.write("Table", table)
    planned.write("Features", lambda: found.zones)
    title = asked["title"] or f"Cut and fill: {' to '.join(make_title(file) for file in files)}"
    planned.draw(lambda: earthwork_map(found, ground=surfaces[0], title=title))
    counts = map(mesh_counts, surfaces)
    rows = list(zip(("Ground", "Design"), counts))  # noqa: B905 - one or both
    facts = _list_facts(files, table, rows)
    if report is not None:
        planned.save(report)
        facts.add("Report", counted(len(report), "page"), pages=len(report))
        known = {*table.notes, *notes_of_surfaces(surfaces)}
        facts.note(note for note in report.notes if note not in known)
    job.finish(planned, facts)


def _name_whole(asked: dict[str, Any], planned: Products, errors: dict[str, Any]) -> str:
    """Return what needs the whole surface at once, if something does."""
    if asked["stage_storage"]:
        return "--stage-storage"
    if planned.holds("report"):
        return "a report"
    if planned.holds("Features") or planned.holds("picture"):
        return "a map"
    return name_flag(next(iter(errors))) if errors else ""


def _take_words(files: Sequence[Path], asked: dict[str, Any], planned: Products) -> dict[str, Any]:
    """Take what a report says; refuse it where there is none."""
    words = {name: asked.pop(name) for name in ("date", "title_block", "ground_unit")}
    if planned.holds("report"):
        if STANDARD in files:
            raise click.UsageError(
                "A report has the SHA-256 of each file, and standard input is none: name the file."
            )
        names = " to ".join(make_title(file) for file in files)
        return words | {"title": asked["title"] or f"Volumes: {names}"}
    for name, value in words.items():
        if value is not None:
            flag = f"--{name.replace('_', '-')}"
            raise click.UsageError(f"{flag} is for a report: name a file that ends in .pdf.")
    return words


def _measure_tiles(
    cloud: TiledPoints, planned: Products, files: Sequence[Path], asked: dict[str, Any], job: Job
) -> None:
    """Write the volumes of tiles to a level or a design."""
    chosen = (
        None if asked["regions"] is None else job.read_features(asked["regions"], cloud, "polygons")
    )
    rows: list[Row] = [("Ground", describe_points(cloud))]
    other: Any = None
    if len(files) == 2:
        design = choose_other(job, files[1])
        other = job.read_tin(files[1]) if design is None else design
        rows.append(("Design", mesh_counts(other) if design is None else describe_points(design)))
    given = {"base": asked["base"], "other": other, "regions": chosen, "crs": cloud.crs}
    with compute_tiles(cloud, "volume", planned, job, **given) as table:
        planned.write("Table", table)
    job.finish(planned, _list_facts(files, table, rows))


def _list_facts(files: Sequence[Path], table: Table, counts: list[Row]) -> Facts:
    facts = Facts(inputs=[str(file) for file in files])
    facts.record(rows=list_rows(table.columns), units=name_units(table.units))
    facts.extend(counts)
    facts.extend(_list_stages(table) if "level" in table.columns else _list_volumes(table))
    if len(table) > _SHOWN:
        facts.add("", f"... {len(table) - _SHOWN} more")
    facts.note(table.notes)
    return facts


# ---------------------------------------------------------------- what is given


def _require_one_base(files: Sequence[Path], asked: dict[str, Any], errors: dict[str, Any]) -> None:
    if len(files) > 2:
        raise click.UsageError(
            f"{len(files)} files are given: one ground and at most one design are allowed."
        )
    bases = (len(files) == 2) + (asked["base"] is not None) + asked["stage_storage"]
    if bases != 1:
        raise click.UsageError(
            "One of these is needed: a file of the DESIGN, --base ELEVATION, or --stage-storage."
        )
    if not asked["stage_storage"] and (asked["levels"] or asked["interval"] is not None):
        raise click.UsageError("--level and --interval are for --stage-storage.")
    if asked["levels"] and asked["interval"] is not None:
        raise click.UsageError("--level and --interval are both given: choose one.")
    if asked["stage_storage"] and errors:
        raise click.UsageError(f"{name_flag(next(iter(errors)))} is not for --stage-storage.")


# ---------------------------------------------------------------- for people


def _list_volumes(table: Table) -> list[Row]:
    rows = []
    for row in range(min(len(table), _SHOWN)):
        if len(table) > 1 or table["region"][row] != "all":
            rows.append(("Region", str(table["region"][row])))
        for name in ("cut", "fill"):
            area = _format_quantity(table, f"{name}_area", row)
            rows.append((name.capitalize(), f"{_format_volume(table, name, row)} over {area}"))
        rows.append(("Net", f"{_format_volume(table, 'net', row)} (fill less cut)"))
        rows.append(("Area", _format_area(table, row)))
        if "level_of_detection" in table.columns:
            rows.append(("Beyond", _format_beyond(table, row)))
    return rows


def _format_volume(table: Table, name: str, row: int) -> str:
    """Write a volume and its standard error."""
    text, error = _format_quantity(table, name, row), f"{name}_error"
    return f"{text} ± {_format_quantity(table, error, row)}" if error in table.columns else text


def _format_beyond(table: Table, row: int) -> str:
    level = _format_quantity(table, "level_of_detection", row, digits=4)
    parts = [
        f"{name} {_format_quantity(table, f'thresholded_{name}', row)}"
        for name in ("cut", "fill", "net")
    ]
    return f"{', '.join(parts)}, where the difference exceeds {level}"


def _format_area(table: Table, row: int) -> str:
    text = f"{_format_quantity(table, 'area', row)} compared"
    alone = {"area_alone": "of the ground alone", "base_area_alone": "without ground"}
    for name, what in alone.items():
        if name in table.columns and table[name][row] >= _LEAST_AREA:
            text += f", {_format_quantity(table, name, row)} {what}"
    return text


def _list_stages(table: Table) -> list[Row]:
    rows = []
    for row in range(min(len(table), _SHOWN)):
        spills = "" if table["is_contained"][row] else ", reaches the boundary"
        area, held = _format_quantity(table, "area", row), _format_quantity(table, "volume", row)
        rows.append(("Level", f"{_format_quantity(table, 'level', row)}: {held}, {area}{spills}"))
    return rows


def _format_quantity(table: Table, name: str, row: int, digits: int = 2) -> str:
    unit = table.units.get(name)
    symbol = getattr(unit, "symbol", unit) or ""
    value = float(table[name][row])
    text = f"{value:,.{digits}f} {symbol}".rstrip()
    if symbol in _FEET:
        text += f" ({value / _CUBIC_YARD:,.2f} yd³)"
    return text
