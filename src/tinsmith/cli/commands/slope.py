"""``tinsmith slope``: classes of slope or aspect, as polygons and as a table."""

from __future__ import annotations

from time import perf_counter
from typing import TYPE_CHECKING, Any, get_args

import click

from ...policies import SlopeUnit
from ..options import (
    console_options,
    input_file,
    output_files,
    product_options,
    reading_options,
    triangulating_options,
)
from ..output.console import format_json

if TYPE_CHECKING:
    from pathlib import Path

    from ...terrain import Features, Table
    from ...tin import TIN
    from ..options import Reading, Triangulating, Writing
    from ..output.console import Console, Row

__all__ = ["slope"]


def _as_breaks(
    ctx: click.Context,  # noqa: ARG001 - click's signature
    param: click.Parameter,  # noqa: ARG001 - click's signature
    value: str | None,
) -> list[float] | None:
    """Return limits given with commas."""
    if value is None:
        return None
    try:
        return [float(part) for part in value.split(",")]
    except ValueError:
        raise click.BadParameter(f"'{value}' are no numbers with commas: 5,10,25.") from None


@click.command(short_help="Divide a TIN into classes of slope or aspect.")
@input_file("file")
@output_files
@click.option(
    "--unit",
    type=click.Choice(get_args(SlopeUnit)),
    default="degrees",
    show_default=True,
    help="Of slopes: an angle, or rise over a run of 100 or of 1.",
)
@click.option(
    "--breaks",
    metavar="S,S,...",
    callback=_as_breaks,
    help="Limits between the classes, in that unit; usual ones if absent.",
)
@click.option("--aspect", is_flag=True, help="Classes of the direction in which it falls instead.")
@reading_options
@triangulating_options
@product_options
@console_options
def slope(
    file: Path,
    outputs: tuple[Path, ...],
    unit: SlopeUnit,
    breaks: list[float] | None,
    aspect: bool,
    reading: Reading,
    how: Triangulating,
    writing: Writing,
    console: Console,
) -> None:
    """Divide the TIN in FILE, or that of the points in it, into classes of slope.

    Vector files get the classes as polygons with a legend, tables (.csv, .json) their areas. The
    statistics in the summary are weighted by area.

    \b
    Example:
      tinsmith slope sample_data/site_survey.csv --crs EPSG:32616 -o slope.gpkg -o slope.csv
      tinsmith slope sample_data/jacksboro.tif --unit percent --breaks 5,15,30 -o slope.geojson
    """  # noqa: D301 - click reads the control character
    from ...terrain import aspect_classes, slope_classes, slope_statistics
    from ...terrain.relief.classes import tabulate_classes
    from ..files import list_inputs, read_tin
    from ..surfaces import plan_products

    if aspect and breaks is not None:
        raise click.UsageError("--breaks is for slopes: aspects have the eight directions.")
    started = perf_counter()
    planned = plan_products(
        outputs,
        writing,
        inputs=list_inputs(file, how),
        console=console,
        kinds=("Features", "Table"),
    )
    tin, _ = read_tin(file, reading, how, console)
    with console.steps() as steps, steps.step("Classifying"):
        made = aspect_classes(tin) if aspect else slope_classes(tin, breaks=breaks, unit=unit)
        statistics = slope_statistics(tin, unit=unit)
    planned.write("Features", made, console)
    planned.write("Table", tabulate_classes(made), console)
    console.summarise(
        [
            *_fields(tin, made, statistics),
            ("Written", planned.text),
            ("Time", f"{perf_counter() - started:.2f} s"),
        ]
    )
    if console.as_json:
        console.emit(format_json(_facts(file, made, statistics, planned.paths)))


def _fields(tin: TIN, made: Features, statistics: Table) -> list[Row]:
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


def _facts(file: Path, made: Features, statistics: Table, paths: list[Path]) -> dict[str, Any]:
    from ...terrain.results.columns import unit_text

    names = list(made.columns)
    rows = zip(*(column.tolist() for column in made.columns.values()), strict=True)
    return {
        "input": str(file),
        "slope": {name: column[0] for name, column in statistics.columns.items()},
        "slope_units": {name: unit_text(statistics.units, name) for name in statistics.units},
        "classes": [dict(zip(names, row, strict=True)) for row in rows],
        "class_units": {name: unit_text(made.units, name) for name in made.units},
        "notes": list(made.notes),
        "outputs": [str(path) for path in paths],
    }
