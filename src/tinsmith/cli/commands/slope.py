"""``tinsmith slope``: classes of slope or aspect, as polygons and as a table."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from ...base.policies import SlopeUnit
from ..command import file_command
from ..options import make_reading_options
from ..parameters import choice_option, numbers_option
from ..request import surface_options

if TYPE_CHECKING:
    from pathlib import Path

    from ...terrain import Features, Table
    from ...tin import TIN
    from ..output.console import Row
    from ..request import Request

__all__ = ["slope"]


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
@surface_options(make_reading_options(unit_flag="--length-unit"))
def slope(
    file: Path,
    slope_unit: SlopeUnit,
    breaks: list[float] | None,
    aspect: bool,
    request: Request,
) -> None:
    """Divide the TIN in FILE, or built from the points in it, into classes of slope.

    Vector files get the classes as polygons with a legend, tables (.csv, .json) their areas. The
    statistics in the summary are weighted by area.

    \b
    Example:
      tinsmith slope sample_data/site_survey.csv --crs EPSG:32616 -o slope.gpkg -o slope.csv
      tinsmith slope sample_data/jacksboro.tif --unit percent --breaks 5,15,30 -o slope.geojson
    """  # noqa: D301 - click reads the control character
    from ...base.results.table import tabulate_columns
    from ...terrain import aspect_classes, slope_classes, slope_statistics

    if aspect and breaks is not None:
        raise click.UsageError("--breaks is for slopes: aspects have the eight directions.")
    planned = request.plan_products(request.list_inputs(file), "Features", "Table")
    tin = request.read_tin(file)
    with request.step("Classifying"):
        made = aspect_classes(tin) if aspect else slope_classes(tin, breaks=breaks, unit=slope_unit)
        statistics = slope_statistics(tin, unit=slope_unit)
    planned.write("Features", made)
    planned.write("Table", tabulate_columns(made))
    rows = _summarise_classes(tin, made, statistics)
    request.finish(planned, rows, lambda: _describe_classes(file, made, statistics))


def _summarise_classes(tin: TIN, made: Features, statistics: Table) -> list[Row]:
    from ..output.line_summaries import describe_counts

    found = {name: f"{statistics[name][0]:.1f}" for name in statistics.columns}
    mark = str(statistics.units["mean"])
    behind = mark if mark == "°" else f" {mark}"
    rows = zip(made.columns["label"], made.columns["area"], made.columns["share"], strict=True)
    area = made.units["area"] or "units²"
    classes = "\n".join(
        f"{label}: {size:,.1f} {area}, {share:.1f} %" for label, size, share in rows
    )
    return [
        ("TIN", describe_counts(tin)),
        (
            "Slope",
            f"{found['minimum']} to {found['maximum']}{behind}, mean {found['mean']}{behind}, "
            f"median {found['p50']}{behind}",
        ),
        ("Classes", classes),
        *(("Note", note) for note in made.notes),
    ]


def _describe_classes(file: Path, made: Features, statistics: Table) -> dict[str, Any]:
    from ...base.results.columns import unit_text

    names = list(made.columns)
    rows = zip(*(column.tolist() for column in made.columns.values()), strict=True)
    return {
        "input": str(file),
        "slope": {name: column[0] for name, column in statistics.columns.items()},
        "slope_units": {name: unit_text(statistics.units, name) for name in statistics.units},
        "classes": [dict(zip(names, row, strict=True)) for row in rows],
        "class_units": {name: unit_text(made.units, name) for name in made.units},
        "notes": list(made.notes),
    }
