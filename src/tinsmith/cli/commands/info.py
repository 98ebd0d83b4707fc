"""``tinsmith info``: what is in a file."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from ..command import command
from ..job import Job, surface_options
from ..options import CODING, CONSOLE, READING
from ..output.facts import Facts
from ..output.failures import Failure
from ..parameters import input_files
from ..paths import OUTPUT, describe_inputs, make_title, name_file, name_files

if TYPE_CHECKING:
    from ...tin import TIN


@command
@input_files("files")
@click.option(
    "--plot",
    metavar="FILE",
    type=OUTPUT,
    help="Picture (.png) to write: histograms of angles, aspect ratios and edge lengths of a TIN.",
)
@surface_options(READING, CODING, CONSOLE)
def info(files: tuple[Path, ...], plot: Path | None, job: Job) -> None:
    """Describe FILES: survey points, an elevation raster or a TIN.

    Several files of points are read as one survey; of a folder the headers are compared. Shown are
    counts, extent, elevations and CRS; for a TIN also areas, slopes and the shape of triangles;
    with --codes the lines made from field codes, and irregularities in them.

    Example:
      tinsmith info sample_data/jacksboro.tif
      tinsmith info sample_data/site_survey.csv --crs EPSG:32616 --json
    """
    from ...io.reading import is_folder
    from ...tin import TIN
    from ..output.inventory import describe_folder, find_tiles
    from ..output.summaries import describe_survey, summarise_survey
    from ..outputs import require_picture

    if plot is not None:
        require_picture(plot, "--plot", job.list_inputs(*files))
    folder = next((file for file in files if is_folder(file)), None)
    tiles = [] if folder is None else find_tiles(folder, job)
    if folder is not None and tiles:
        flags = {
            "--plot": plot is not None,
            "--codes": job.how.has_codes,
            "further files": files[1:],
        }
        asked = next((flag for flag, is_given in flags.items() if is_given), None)
        if asked is not None:
            raise Failure(f"Of the folder '{folder}' only headers are read: no {asked} with it.")
        job.console.answer(describe_folder(folder, tiles, job))
        return
    found, file = job.read(*files), files[0]
    job.note_found(found)
    if isinstance(found, TIN):
        if job.how.has_codes:
            raise Failure(f"'{file}' holds a TIN, and codes are those of points.")
        job.console.answer(_list_facts(found, file, plot, job))
        return
    if plot is not None:
        raise Failure(
            f"'{file}' holds points, and --plot needs a TIN: 'tinsmith build' makes one of them."
        )
    survey = job.add_coded_lines(found)
    record = describe_survey(survey) if job.console.as_json else {}
    facts = Facts(input=describe_inputs(files), **record)
    facts.add("File", name_files(files))
    facts.extend(lambda: summarise_survey(survey))
    job.console.answer(facts)


def _list_facts(tin: TIN, file: Path, plot: Path | None, job: Job) -> Facts:
    """Return what is known of a TIN; write the histograms, whole or not at all."""
    from ..output.summaries import (
        describe_tin,
        find_symbols,
        measure_quality,
        summarise_quality,
        summarise_tin,
    )
    from ..outputs import describe_file, write_figure

    shapes = measure_quality(tin)
    if plot is not None and shapes is None:
        raise Failure(
            f"The coordinates of '{file}' are degrees, in which triangles have no true shape: "
            "--plot needs a projected CRS, such as UTM."
        )
    if plot is not None and shapes is not None:
        from ...terrain import histogram

        with job.step("Drawing"):
            title = f"Triangle quality: {make_title(file)}".rstrip(": ")
            figure = histogram(shapes, title=title, unit=find_symbols(tin)[0].strip())
            write_figure(figure, plot, dpi=150)
    # Record and lines both measure the whole surface: only what is asked for.
    facts = Facts(file, **(describe_tin(tin) if job.console.as_json else {}))
    facts.record(quality=None if shapes is None else shapes.summary())
    facts.add("File", name_file(file))
    facts.extend(lambda: [*summarise_tin(tin), *summarise_quality(shapes)])
    if plot is not None:
        facts.add("Written", describe_file(plot), plot=str(plot))
    return facts
