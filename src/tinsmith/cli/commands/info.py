"""``tinsmith info``: what is in a file."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from ..options import console_options, input_file, reading_options
from ..output.failures import Failure
from ..paths import OUTPUT, name_of, title_of

if TYPE_CHECKING:
    from pathlib import Path

    from ...tin import TIN, Quality
    from ..options import Reading
    from ..output.console import Console, Field

__all__ = ["info"]


@click.command(short_help="Describe a file of points or a TIN.")
@input_file("file")
@click.option(
    "--plot",
    metavar="FILE",
    type=OUTPUT,
    help="Picture (.png) to write: histograms of angles, aspect ratios and edge lengths of a TIN.",
)
@reading_options
@console_options
def info(file: Path, plot: Path | None, reading: Reading, console: Console) -> None:
    """Describe FILE: survey points, an elevation raster or a TIN.

    Counts, extent, elevations and CRS; of a TIN also areas, slopes and the shapes of its
    triangles.

    \b
    Example:
      tinsmith info sample_data/jacksboro.tif
      tinsmith info sample_data/site_survey.csv --crs EPSG:32616 --json
    """  # noqa: D301 - click reads the control character
    from ...tin import TIN
    from ..files import inputs_of, read_input, require_picture
    from ..output.summaries import survey_facts, survey_fields

    if plot is not None:
        require_picture(plot, place="--plot", inputs=inputs_of(file))
    found = read_input(file, reading, console)
    if isinstance(found, TIN):
        _describe(found, file, plot, console)
        return
    if plot is not None:
        raise Failure(
            f"'{file}' holds points, and --plot needs a TIN: 'tinsmith build' makes one of them."
        )
    facts = {"input": str(file)} | survey_facts(found)
    console.answer([("File", name_of(file)), *survey_fields(found)], facts)


def _describe(tin: TIN, file: Path, plot: Path | None, console: Console) -> None:
    from ..output.summaries import file_size, quality_fields, quality_of, tin_facts, tin_fields

    shapes = quality_of(tin)
    fields: list[Field] = [("File", name_of(file)), *tin_fields(tin), *quality_fields(shapes)]
    facts = {"input": str(file)} | tin_facts(tin)
    facts["quality"] = None if shapes is None else shapes.summary()
    if plot is not None:
        _plot(shapes, tin, file, plot, console)
        fields.append(("Written", f"{plot} ({file_size(plot)})"))
        facts["plot"] = str(plot)
    console.answer(fields, facts)


def _plot(shapes: Quality | None, tin: TIN, file: Path, plot: Path, console: Console) -> None:
    """Write the histograms, whole or not at all."""
    from ...terrain import histogram
    from ..files import write_figure
    from ..output.summaries import units

    if shapes is None:
        raise Failure(
            f"The coordinates of '{file}' are degrees, in which triangles have no true shape: "
            "--plot needs a projected CRS, such as UTM."
        )
    with console.steps() as steps, steps.step("Drawing"):
        title = f"Triangle quality: {title_of(file)}".rstrip(": ")
        figure = histogram(shapes, title=title, unit=units(tin)[0].strip())
        write_figure(figure, plot, dpi=150)
