"""``tinsmith slope``: classes of slope or aspect, as polygons and as a table."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from ....base.policies import SlopeUnit
from ...command import file_command
from ...job import Job, surface_options
from ...options import CONSOLE, TRIANGULATING, WRITING, make_reading
from ...output import Facts, describe_counts, list_rows, name_units
from ...parameters import choice_option, numbers_option
from ...tiling import TILING, choose_tiles, compute_tiles, describe_points

if TYPE_CHECKING:
    from ....terrain import Table
    from ....tin import TIN
    from ...outputs import Products


@file_command
@choice_option(
    "--unit",
    SlopeUnit,
    "Unit of slopes: an angle, or rise over a run of 100 or of 1.",
    name="slope_unit",
    default="degrees",
)
@numbers_option(
    "--breaks", "S,S,...", "Limits between the classes, in that unit; default the usual ones."
)
@click.option("--aspect", is_flag=True, help="Classes of aspect instead of slope.")
@click.option(
    "--statistics",
    is_flag=True,
    help="Write a table of the mean slope and its like instead of classes; FILE may be larger than "
    "memory.",
)
@surface_options(make_reading("--length-unit"), TRIANGULATING, TILING, WRITING, CONSOLE)
def slope(
    file: Path,
    slope_unit: SlopeUnit,
    breaks: list[float] | None,
    aspect: bool,
    statistics: bool,
    job: Job,
) -> None:
    """Divide the TIN in FILE, or built from the points in it, into classes of slope.

    Vector files get the classes as polygons with a legend, tables (.csv, .json) their areas. The
    statistics in the summary are weighted by area.

    Example:
      tinsmith slope sample_data/site_survey.csv --crs EPSG:32616 -o slope.gpkg -o slope.csv
      tinsmith slope sample_data/jacksboro.tif --unit percent --breaks 5,15,30 -o slope.geojson
      tinsmith slope lidar/ --classes 2 --statistics -o slope.csv
    """
    if aspect and breaks is not None:
        raise click.UsageError("--breaks is for slopes: aspects have the eight directions.")
    if statistics and (aspect or breaks is not None):
        flag = "--aspect" if aspect else "--breaks"
        raise click.UsageError(f"{flag} is for classes, and not for --statistics.")
    if statistics:
        _summarise(file, slope_unit, job)
        return
    choose_tiles(job, file, whole="classes, but --statistics can be")
    planned = job.plan(job.list_inputs(file), "Features", "Table")
    tin = job.read_tin(file)
    facts = Facts(file)
    facts.add("TIN", describe_counts(tin))
    _classify(tin, slope_unit, breaks, aspect=aspect, planned=planned, facts=facts, job=job)
    job.finish(planned, facts)


def _summarise(file: Path, unit: SlopeUnit, job: Job) -> None:
    """Write statistics alone, in memory or in tiles."""
    from ....terrain import slope_statistics

    planned = job.plan(job.list_inputs(file), "Table")
    cloud = choose_tiles(job, file)
    facts = Facts(file)
    if cloud is not None:
        with compute_tiles(cloud, "slopes", planned, job, unit=unit) as made:
            planned.write("Table", made)
        facts.add("Points", describe_points(cloud))
    else:
        tin = job.read_tin(file)
        made = slope_statistics(tin, unit=unit)
        planned.write("Table", made)
        facts.add("TIN", describe_counts(tin))
    _add_statistics(facts, made)
    facts.note(made.notes)
    job.finish(planned, facts)


def _add_statistics(facts: Facts, statistics: Table) -> None:
    found = {name: f"{statistics[name][0]:.1f}" for name in statistics.columns}
    mark = str(statistics.units["mean"])
    behind = mark if mark == "°" else f" {mark}"
    median = f", median {found['p50']}{behind}" if "p50" in found else ""
    facts.add(
        "Slope",
        f"{found['minimum']} to {found['maximum']}{behind}, mean {found['mean']}{behind}{median}",
        slope={name: column[0] for name, column in statistics.columns.items()},
        slope_units=name_units(statistics.units),
    )


def _classify(
    tin: TIN,
    unit: SlopeUnit,
    breaks: list[float] | None,
    *,
    aspect: bool,
    planned: Products,
    facts: Facts,
    job: Job,
) -> None:
    """Write classes, and tell of them and of the statistics."""
    from ....base.results import tabulate_columns
    from ....terrain import aspect_classes, slope_classes, slope_statistics

    with job.step("Classifying"):
        made = aspect_classes(tin) if aspect else slope_classes(tin, breaks=breaks, unit=unit)
        statistics = slope_statistics(tin, unit=unit)
    planned.write("Features", made)
    planned.write("Table", tabulate_columns(made))
    _add_statistics(facts, statistics)
    area = made.units["area"] or "units²"
    classes = list_rows(made.columns)
    facts.add(
        "Classes",
        "\n".join(
            f"{one['label']}: {one['area']:,.1f} {area}, {one['share']:.1f} %" for one in classes
        ),
        classes=classes,
        class_units=name_units(made.units),
    )
    facts.note(made.notes)
