"""``tinsmith info``: what is in a file."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from ..command import command
from ..options import coding_options, console_options, reading_options
from ..output.failures import Failure
from ..parameters import input_files
from ..paths import OUTPUT, describe_inputs, make_title, name_file, name_files

if TYPE_CHECKING:
    from pathlib import Path

    from ...tin import TIN, Quality
    from ..options import Coding, Reading
    from ..output.console import Console, Row

__all__ = ["info"]


@command
@input_files("files")
@click.option(
    "--plot",
    metavar="FILE",
    type=OUTPUT,
    help="Picture (.png) to write: histograms of angles, aspect ratios and edge lengths of a TIN.",
)
@reading_options
@coding_options
@console_options
def info(
    files: tuple[Path, ...], plot: Path | None, reading: Reading, how: Coding, console: Console
) -> None:
    """Describe FILES: survey points, an elevation raster or a TIN.

    Several files of points are read as one survey. Shown are counts, extent, elevations and CRS;
    for a TIN also areas, slopes and the shape of triangles; with --codes the lines made from field
    codes, and irregularities in them.

    \b
    Example:
      tinsmith info sample_data/jacksboro.tif
      tinsmith info sample_data/site_survey.csv --crs EPSG:32616 --json
    """  # noqa: D301 - click reads the control character
    from ...tin import TIN
    from ..files import add_coded_lines, list_inputs, note_found, read_inputs, require_picture
    from ..output.summaries import describe_survey, summarise_survey

    if plot is not None:
        require_picture(plot, place="--plot", inputs=list_inputs(*files, how=how))
    found, file = read_inputs(files, reading, console), files[0]
    note_found(found, console)
    if isinstance(found, TIN):
        if how.has_codes:
            raise Failure(f"'{file}' holds a TIN, and codes are those of points.")
        _describe(found, file, plot, console)
        return
    if plot is not None:
        raise Failure(
            f"'{file}' holds points, and --plot needs a TIN: 'tinsmith build' makes one of them."
        )
    found = add_coded_lines(found, how)
    if console.as_json:
        console.answer([], {"input": describe_inputs(files)} | describe_survey(found))
    else:
        console.answer([("File", name_files(files)), *summarise_survey(found)], {})


def _describe(tin: TIN, file: Path, plot: Path | None, console: Console) -> None:
    from ..output.summaries import measure_quality

    shapes = measure_quality(tin)
    if plot is not None:
        _plot(shapes, tin, file, plot, console)
    # Both measure the whole surface: only what is asked for.
    if console.as_json:
        console.answer([], _make_record(tin, file, plot, shapes))
    else:
        console.answer(_summarise(tin, file, plot, shapes), {})


def _make_record(tin: TIN, file: Path, plot: Path | None, shapes: Quality | None) -> dict[str, Any]:
    from ..output.summaries import describe_tin

    record = {"input": str(file)} | describe_tin(tin)
    record["quality"] = None if shapes is None else shapes.summary()
    return record if plot is None else record | {"plot": str(plot)}


def _summarise(tin: TIN, file: Path, plot: Path | None, shapes: Quality | None) -> list[Row]:
    from ..output.summaries import describe_file_size, summarise_quality, summarise_tin

    rows = [("File", name_file(file)), *summarise_tin(tin), *summarise_quality(shapes)]
    return rows if plot is None else [*rows, ("Written", f"{plot} ({describe_file_size(plot)})")]


def _plot(shapes: Quality | None, tin: TIN, file: Path, plot: Path, console: Console) -> None:
    """Write the histograms, whole or not at all."""
    from ...terrain import histogram
    from ..files import write_figure
    from ..output.summaries import find_symbols

    if shapes is None:
        raise Failure(
            f"The coordinates of '{file}' are degrees, in which triangles have no true shape: "
            "--plot needs a projected CRS, such as UTM."
        )
    with console.steps() as steps, steps.step("Drawing"):
        title = f"Triangle quality: {make_title(file)}".rstrip(": ")
        figure = histogram(shapes, title=title, unit=find_symbols(tin)[0].strip())
        write_figure(figure, plot, dpi=150)
