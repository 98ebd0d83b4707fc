"""``tinsmith view``: a picture or a window in 3D."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from ..options import console_options, reading_options, triangulating_options
from ..output.failures import note_written
from ..parameters import input_files, number_option, picture_option
from ..paths import describe_inputs, make_title

if TYPE_CHECKING:
    from pathlib import Path

    from ..options import Reading, Triangulating
    from ..output.console import Console, Row

__all__ = ["view"]


@click.command(short_help="Show a TIN in 3D: in a window, as a page, as a picture.")
@input_files("files")
@picture_option("Picture to write (.png, .jpg, .tif) instead of opening a window.")
@number_option("--exaggeration", "FACTOR", "Vertical exaggeration; chosen if absent.")
@click.option("--edges", is_flag=True, help="Draw the edges of the triangles.")
@click.option(
    "--lines/--no-lines",
    default=True,
    show_default=True,
    help="Draw breaklines and rings.",
)
@click.option("--top", is_flag=True, help="Look straight down, north up.")
@click.option("--title", metavar="TEXT", help="Title in the picture; default the file's name.")
@reading_options
@triangulating_options
@console_options
def view(
    files: tuple[Path, ...],
    output: Path | None,
    reading: Reading,
    how: Triangulating,
    console: Console,
    **drawing: Any,
) -> None:
    """Show the TIN in FILES, or of the points in them.

    \b
    Example:
      tinsmith view sample_data/site_survey.csv --crs EPSG:32616 --codes -o site.html
    """  # noqa: D301 - click reads the control character
    from ...terrain import preview
    from ...terrain.preview.presentation import PREVIEW_SUFFIXES
    from ..files import list_inputs, read_tin_of_files, require_picture

    if output is not None:
        require_picture(
            output, place="--output", inputs=list_inputs(*files, how=how), suffixes=PREVIEW_SUFFIXES
        )

    tin, survey = read_tin_of_files(files, reading, how, console)
    top = drawing.pop("top")
    drawing["title"] = drawing["title"] or make_title(files[0])
    with console.steps() as steps, steps.step("Drawing"):
        seen = "top" if top else "oblique"
        shown: Any = preview(tin, survey=survey, output=output, view=seen, **drawing)
        if output is None:
            shown.show()
    if output is not None:
        note_written(output)
        console.summarise(_summarise_picture(output))
        if console.as_json:
            console.answer([], {"input": describe_inputs(files), "output": str(output)})


def _summarise_picture(output: Path) -> list[Row]:
    from ..output.summaries import describe_file_size

    return [("Written", f"{output} ({describe_file_size(output)})")]
