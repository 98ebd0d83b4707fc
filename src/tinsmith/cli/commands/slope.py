"""``tinsmith slope``: classes of slope or aspect, as polygons and as a table."""

from __future__ import annotations

from pathlib import Path

import click

from ...base.policies import SlopeUnit
from ..command import file_command
from ..job import Job, surface_options
from ..options import CONSOLE, TRIANGULATING, WRITING, make_reading
from ..output.counts import describe_counts
from ..output.facts import Facts, list_rows, name_units
from ..parameters import choice_option, numbers_option


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
@surface_options(make_reading("--length-unit"), TRIANGULATING, WRITING, CONSOLE)
def slope(
    file: Path, slope_unit: SlopeUnit, breaks: list[float] | None, aspect: bool, job: Job
) -> None:
    """Divide the TIN in FILE, or built from the points in it, into classes of slope.

    Vector files get the classes as polygons with a legend, tables (.csv, .json) their areas. The
    statistics in the summary are weighted by area.

    Example:
      tinsmith slope sample_data/site_survey.csv --crs EPSG:32616 -o slope.gpkg -o slope.csv
      tinsmith slope sample_data/jacksboro.tif --unit percent --breaks 5,15,30 -o slope.geojson
    """
    from ...base.results.table import tabulate_columns
    from ...terrain import aspect_classes, slope_classes, slope_statistics

    if aspect and breaks is not None:
        raise click.UsageError("--breaks is for slopes: aspects have the eight directions.")
    planned = job.plan(job.list_inputs(file), "Features", "Table")
    tin = job.read_tin(file)
    with job.step("Classifying"):
        made = aspect_classes(tin) if aspect else slope_classes(tin, breaks=breaks, unit=slope_unit)
        statistics = slope_statistics(tin, unit=slope_unit)
    planned.write("Features", made)
    planned.write("Table", tabulate_columns(made))
    found = {name: f"{statistics[name][0]:.1f}" for name in statistics.columns}
    mark = str(statistics.units["mean"])
    behind = mark if mark == "°" else f" {mark}"
    facts = Facts(file)
    facts.add("TIN", describe_counts(tin))
    facts.add(
        "Slope",
        f"{found['minimum']} to {found['maximum']}{behind}, mean {found['mean']}{behind}, "
        f"median {found['p50']}{behind}",
        slope={name: column[0] for name, column in statistics.columns.items()},
        slope_units=name_units(statistics.units),
    )
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
    job.finish(planned, facts)
