"""``tinsmith plan``: a TIN on sheets of paper, true to scale."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ...base.policies import (
    ContourLabeling,
    GridStyle,
    PaperOrientation,
    PointMarking,
    SheetLayout,
)
from ...base.sentences import counted
from ..command import command
from ..inputs import name_features, read_lines
from ..options import console_options, reading_options, triangulating_options
from ..output.failures import note_written
from ..parameters import choice_option, file_option, input_file, number_option, output_option
from ..paths import Named, make_title, require_separate

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ...terrain import Plan
    from ..options import Reading, Triangulating
    from ..output.console import Console

__all__ = ["plan"]


@command
@input_file("file")
@output_option("Plan to write (.pdf, .svg, .png).", required=True)
@click.option(
    "--scale",
    metavar="SCALE",
    help="Scale, such as 500 for 1:500, or '1\"=20 ft'; default the largest usual one that fits.",
)
@click.option(
    "--paper",
    metavar="NAME",
    default="A3",
    show_default=True,
    help="A4 to A0, Letter, Legal, Tabloid, 'ANSI A' to 'ANSI E', 'ARCH A' to 'ARCH E', or width "
    "and height in millimetres such as 900x600.",
)
@choice_option(
    "--orientation",
    PaperOrientation,
    "Orientation of the paper; default the one with the larger scale.",
)
@choice_option(
    "--layout",
    SheetLayout,
    "One sheet, rows of sheets, or strips along the axis of a long surface.",
    default="single",
)
@file_option("--axis", "Vector file of the axis of strips.", name="axis_file")
@number_option("--interval", "HEIGHT", "Contour interval; chosen if absent.")
@number_option(
    "--smooth",
    "HEIGHT",
    "Smooth contours, as long as the surface stays within this height of the level.",
)
@choice_option("--labels", ContourLabeling, "Contours that are labelled.", default="index")
@choice_option("--points", PointMarking, "Marks and labels of points.", default="none")
@choice_option("--grid", GridStyle, "Style of the coordinate grid.", default="crosses")
@click.option("--title", metavar="TEXT", help="Title of the plan; default the name of the file.")
@click.option("--date", metavar="TEXT", help="Date in the title block, as text.")
@click.option(
    "--ground-unit",
    metavar="UNIT",
    help="Unit of eastings and northings, if the CRS is not known.",
)
@number_option(
    "--dpi", "N", "Pixels per inch of a PNG.", type=click.IntRange(50, 1200), default=200
)
@reading_options
@triangulating_options
@console_options
def plan(
    file: Path,
    outputs: tuple[Path, ...],
    reading: Reading,
    how: Triangulating,
    console: Console,
    dpi: int,
    **asked: Any,
) -> None:
    """Draw a scaled plan of the TIN in FILE, or built from the points in it.

    The plan has contours with labels, lines, water, points, a coordinate grid, title block, north
    arrow, scale bar and legend. Several sheets are pages of a PDF, or separate files.

    \b
    Example:
      tinsmith plan sample_data/site_survey.csv --crs EPSG:32616 --codes --scale 1000 -o plan.pdf
    """  # noqa: D301 - click reads the control character
    from ... import terrain
    from ..files import list_inputs, read_tin
    from ..output.facts import Facts
    from ..output.summaries import describe_file_size

    if asked["scale"] is None and asked["layout"] != "single":
        raise click.UsageError(f"--layout {asked['layout']} needs --scale.")
    axis_file = asked.pop("axis_file")
    inputs = [*list_inputs(file, how=how), *name_features(axis_file, "the file of --axis")]
    _require_plans(outputs, inputs)
    tin, survey = read_tin(file, reading, how, console)
    asked["title"] = asked["title"] or make_title(file)
    asked["paper"] = _parse_paper(asked["paper"])
    axis = None if axis_file is None else read_lines(axis_file, tin, "an axis is a line")
    with console.step("Drawing"):
        made = terrain.plan(tin, axis=axis, survey=survey, **asked)
    written = [path for output in outputs for path in _save(made, output, dpi, inputs, console)]
    facts = Facts(file)
    facts.add("Scale", made.scale_text, scale=made.scale)
    sheets = f"{counted(len(made), 'sheet')}, {made.paper_name}"
    facts.add("Sheets", sheets, paper=list(made.paper), sheets=len(made))
    facts.add("Contours", f"every {made.interval:.12g}", interval=made.interval)
    facts.record(frames=made.frames.tolist(), outputs=[str(path) for path in written])
    facts.note([*getattr(axis, "notes", ()), *made.notes])
    files = "\n".join(f"{path} ({describe_file_size(path)})" for path in written)
    console.summarise([*facts.lines, ("Written", files)])
    if console.as_json:
        console.emit_record(facts.values)


# ---------------------------------------------------------------- what is given


def _require_plans(outputs: Sequence[Path], inputs: Sequence[Named]) -> None:
    """Refuse outputs of another suffix, and such as would overwrite an input."""
    from ...terrain.plans.files import PLAN_SUFFIXES

    require_separate(inputs, [Named(path, "--output") for path in outputs])
    for path in outputs:
        if path.suffix.lower() not in PLAN_SUFFIXES:
            raise click.UsageError(
                f"Cannot write a plan to '{path}': its name must end in {', '.join(PLAN_SUFFIXES)}."
            )


def _parse_paper(text: str) -> str | tuple[float, float]:
    """Return the name of a paper, or width and height such as 900x600."""
    parts = text.lower().replace("mm", "").split("x")
    try:
        width, height = (float(part) for part in parts)
    except ValueError:
        return text
    return width, height


# ---------------------------------------------------------------- what is made


def _save(
    made: Plan, output: Path, dpi: int, inputs: Sequence[Named], console: Console
) -> list[Path]:
    """Write the sheets; files of their own must not overwrite an input either."""
    require_separate(inputs, [Named(path, "--output") for path in made.list_files(output)])
    with console.step(f"Writing {output.name}"):
        written = made.save(output, dpi=dpi)
    for path in written:
        note_written(path)
    return written
