"""``tinsmith plan``: a TIN on sheets of paper, true to scale."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from ....base.sentences import counted
from ...command import command
from ...job import Job, name_features, surface_options
from ...option_groups import sheet_options
from ...options import CONSOLE, READING, TRIANGULATING
from ...output import Facts, note_written
from ...parameters import file_option, input_file, number_option, output_option
from ...paths import Named, make_title, require_separate
from ...product_options import product_options

_PLAN = "terrain.plans.production.plan"


@command
@input_file("file")
@output_option("Plan to write (.pdf, .svg, .png).", required=True)
@sheet_options("scale paper orientation title date ground_unit")
@product_options(_PLAN, "layout")
@file_option("--axis", "Vector file of the axis of strips.", name="axis_file")
@product_options(
    _PLAN,
    "interval smooth labels points grid",
    smooth="Smooth contours, as long as the surface stays within this height of the level.",
    points="Marks and labels of points.",
    grid="Style of the coordinate grid.",
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
    inputs = job.list_inputs(file, more=name_features(axis_file, "the file of --axis"))
    require_separate(inputs, [Named(path, "--output") for path in job.outputs])
    for path in job.outputs:
        if path.suffix.lower() not in PLAN_SUFFIXES:
            raise click.UsageError(
                f"Cannot write a plan to '{path}': its name must end in {', '.join(PLAN_SUFFIXES)}."
            )
    tin, survey = job.read_surface(file)
    asked["title"] = asked["title"] or make_title(file)
    axis = None
    if axis_file is not None:
        axis = job.read_features(axis_file, tin, "lines", "an axis is a line")
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
