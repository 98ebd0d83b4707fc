"""``tinsmith plan``: a TIN on sheets of paper, true to scale."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from ....base.sentences import counted
from ...command import command
from ...job import Job, name_features, surface_options
from ...option_groups import (
    alignment_option,
    name_title_block,
    read_axis,
    sheet_options,
)
from ...options import CONSOLE, READING, TRIANGULATING
from ...output import Facts, note_written
from ...parameters import file_option, input_file, number_option, output_option, parsed
from ...paths import Named, make_title, require_separate
from ...product_options import product_options

_PLAN = "terrain.plans.production.plan"


@parsed
def _parse_spots(_flag: str, text: str) -> float | str | Path:
    """Return a spacing, "peaks", or the file of points."""
    try:
        return float(text)
    except ValueError:
        return text if text == "peaks" else Path(text)


@command
@input_file("file")
@output_option("Plan to write (.pdf, .svg, .png, .dxf).", required=True)
@sheet_options("scale paper orientation title date title_block ground_unit")
@product_options(_PLAN, "layout")
@file_option(
    "--axis", "Axis to draw, and of strips: LandXML, DXF, vector file or table.", name="axis_file"
)
@alignment_option("the file of --axis")
@product_options(
    _PLAN,
    "station_interval station_range interval smooth labels points label_size decimals grid",
    smooth="Smooth contours, as long as the surface stays within this height of the level.",
    points="Points as 'marks', or labelled with some of numbers, elevations, codes: with commas "
    "between them.",
    label_size="Height of digits at points and spot heights, millimetres.",
    grid="Style of the coordinate grid.",
)
@click.option(
    "--spots",
    metavar="SPACING|peaks|FILE",
    callback=_parse_spots,
    help="Spot heights: on a grid, at peaks and pits, or at the points of a vector file.",
)
@number_option(
    "--dpi", "N", "Pixels per inch of a PNG.", type=click.IntRange(50, 1200), default=200
)
@surface_options(READING, TRIANGULATING, CONSOLE)
def plan(file: Path, job: Job, dpi: int, axis_file: Path | None, **asked: Any) -> None:
    """Draw a scaled plan of the TIN in FILE, or built from the points in it.

    The plan has contours with labels, lines, water, points, a coordinate grid, title block, north
    arrow, scale bar and legend. Several sheets are pages of a PDF, or separate files.

    Example:
      tinsmith plan sample_data/site_survey.csv --crs EPSG:32616 --codes --scale 1000 -o plan.pdf
    """
    from .... import terrain
    from ....terrain.plans import PLAN_SUFFIXES
    from ...outputs import describe_file

    if asked["scale"] is None and asked["layout"] != "single":
        raise click.UsageError(f"--layout {asked['layout']} needs --scale.")
    spots = asked["spots"]
    more = name_features(axis_file, "the file of --axis")
    if isinstance(spots, Path):
        more += name_features(spots, "the file of --spots")
    inputs = job.list_inputs(file, more=[*more, *name_title_block(asked["title_block"])])
    require_separate(inputs, [Named(path, "--output") for path in job.outputs])
    for path in job.outputs:
        if path.suffix.lower() not in PLAN_SUFFIXES:
            raise click.UsageError(
                f"Cannot write a plan to '{path}': its name must end in {', '.join(PLAN_SUFFIXES)}."
            )
    tin, survey = job.read_surface(file)
    asked["title"] = asked["title"] or make_title(file)
    name = asked.pop("alignment")
    axis = None if axis_file is None else read_axis(axis_file, name, crs=tin.crs)
    if isinstance(spots, Path):
        asked["spots"] = job.read_features(spots, tin, "points", "spot heights are at points")
    with job.step("Drawing"):
        made = terrain.plan(tin, axis=axis, survey=survey, **asked)
    written = []
    for path in job.outputs:  # sheets in files of their own must not overwrite an input either
        require_separate(inputs, [Named(one, "--output") for one in made.list_files(path)])
        with job.step(f"Writing {path.name}"):
            sheets = made.save(path, dpi=dpi)
        for one in sheets:
            note_written(one)
        written += sheets
    facts = Facts(file)
    facts.add("Scale", made.scale_text, scale=made.scale)
    text = f"{counted(len(made), 'sheet')}, {made.paper_name}"
    facts.add("Sheets", text, paper=list(made.paper), sheets=len(made))
    facts.add("Contours", f"every {made.interval:.12g}", interval=made.interval)
    facts.record(frames=made.frames.tolist(), outputs=[str(path) for path in written])
    facts.note([*getattr(axis, "notes", ()), *made.notes])
    files = "\n".join(map(describe_file, written))
    job.console.summarise([*facts.lines, ("Written", files)])
    if job.console.as_json:
        job.console.emit_record(facts.values)
