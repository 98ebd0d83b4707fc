"""``tinsmith info``: what is in a file."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ....base.sentences import coordinate, counted
from ...command import command
from ...job import Job, surface_options
from ...options import CODING, CONSOLE, READING
from ...output import Facts, Failure
from ...parameters import input_files
from ...paths import OUTPUT, describe_inputs, make_title, name_file, name_files
from ...tiling import add_plan

if TYPE_CHECKING:
    from ....io.inventory import Inventory
    from ....io.registry import SourceHeader
    from ....tin import TIN


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
    from ....io.reading import is_folder
    from ....tin import TIN
    from ...output import describe_survey, summarise_survey
    from ...outputs import require_picture

    if plot is not None:
        require_picture(plot, "--plot", job.list_inputs(*files))
    folder = next((file for file in files if is_folder(file)), None)
    tiles = [] if folder is None else _find_tiles(folder, job)
    if folder is not None and tiles:
        flags = {
            "--plot": plot is not None,
            "--codes": job.how.has_codes,
            "further files": files[1:],
        }
        asked = next((flag for flag, is_given in flags.items() if is_given), None)
        if asked is not None:
            raise Failure(f"Of the folder '{folder}' only headers are read: no {asked} with it.")
        job.console.answer(_describe_folder(folder, tiles, job))
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
    from ...output import (
        describe_tin,
        find_symbols,
        measure_quality,
        summarise_quality,
        summarise_tin,
    )
    from ...outputs import describe_file, write_figure

    shapes = measure_quality(tin)
    if plot is not None and shapes is None:
        raise Failure(
            f"The coordinates of '{file}' are degrees, in which triangles have no true shape: "
            "--plot needs a projected CRS, such as UTM."
        )
    if plot is not None and shapes is not None:
        from ....terrain import histogram

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


# ---------------------------------------------------------------- a folder, by its headers


def _find_tiles(folder: Path, job: Job) -> list[Path]:
    """Return the files of points of a folder; none where it has no such, but is one itself."""
    from ....base.errors import ReadError
    from ....io.reading import list_files

    try:
        return list_files(folder, job.reading.format)
    except ReadError:
        return []  # the reader tells better


def _describe_folder(path: Path, files: list[Path], job: Job) -> Facts:
    """Return what there is to tell of the files of points of a folder."""
    from ....io.inventory import take_inventory
    from ....tiled import tiles

    given = {name: value for name, value in job.reading.given.items() if name != "remote"}
    found = take_inventory(files, **given)
    facts = Facts(path, kind="files")
    size = sum(one.size for one in found.headers)
    facts.add("Files", f"{counted(len(files), 'file')}, {size / 1e6:,.1f} MB", bytes=size)
    points = "unknown" if found.count is None else f"{found.count:,}"
    facts.add("Points", points, points=found.count)
    _add_place(facts, found)
    if len(found.headers) == len(files):
        add_plan(facts, tiles(files, **given).plan())
    facts.record(
        files=[_describe_file(one) for one in found.headers],
        disagreements=[one._asdict() for one in found.disagreements],
        overlaps=[one._asdict() for one in found.overlaps],
    )
    for one in found.disagreements:
        facts.add(one.kind.replace("_", " ").capitalize(), one.sentence)
    facts.note(dict.fromkeys(note for header in found.headers for note in header.notes))
    return facts


def _add_place(facts: Facts, found: Inventory) -> None:
    boxes = [one.bounds for one in found.headers if one.bounds is not None and one.count != 0]
    names = list(dict.fromkeys(_name_crs(one) for one in found.headers))
    if boxes and len(names) == 1:
        west, south = (min(getattr(box, side) for box in boxes) for side in ("xmin", "ymin"))
        east, north = (max(getattr(box, side) for box in boxes) for side in ("xmax", "ymax"))
        bounds = {"xmin": west, "ymin": south, "xmax": east, "ymax": north}
        text = (
            f"{coordinate(west)} to {coordinate(east)} east, {coordinate(south)} to "
            f"{coordinate(north)} north"
        )
        facts.add("Extent", text, bounds=bounds)
    facts.add("CRS", "; ".join(names), crs=names)
    records = list(dict.fromkeys(one.records for one in found.headers if one.records))
    if records:
        facts.add("Records", "; ".join(records), records=records)
    if found.densities:
        low, high = min(found.densities), max(found.densities)
        text = f"{low:.3g} to {high:.3g} points per square unit within the bounds of a file"
        facts.add("Density", text, density={"lowest": low, "highest": high})


def _name_crs(header: SourceHeader) -> str:
    return "not known" if header.crs is None else header.crs.label


def _describe_file(one: SourceHeader) -> dict[str, Any]:
    from ....io.inventory import measure_density

    return {
        "path": str(one.path),
        "format": one.format,
        "bytes": one.size,
        "points": one.count,
        "bounds": None if one.bounds is None else asdict(one.bounds),
        "crs": None if one.crs is None else str(one.crs),
        "elevation_unit": None if one.elevation_unit is None else one.elevation_unit.text,
        "records": one.records,
        "density": measure_density(one),
    }
