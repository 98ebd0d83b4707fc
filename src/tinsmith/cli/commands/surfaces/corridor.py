"""``tinsmith corridor``: a template carried along an axis, put into the ground."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from ...command import command
from ...job import Job, name_features, surface_options
from ...option_groups import alignment_option, holds_alignments, read_axis, read_line
from ...output import Facts
from ...parameters import file_option, output_files
from ...paths import INPUT, Named
from ...product_options import product_options


@command
@click.argument("ground", type=INPUT)
@click.argument("axis", type=INPUT)
@click.argument("template", type=INPUT)
@output_files
@alignment_option("AXIS")
@product_options(
    "terrain.sections.corridors.corridor.corridor",
    "vertical start end interval tolerance",
    vertical="Name of the vertical alignment, if there are several.",
    start="First station; default where elevations are designed.",
    end="Last station.",
    interval="A section at every multiple of it besides.",
    tolerance="How far chords may lie from curves.",
)
@file_option(
    "--superelevation",
    "Table of station, left, right: slopes for parts that turn.",
    name="turns",
    type=INPUT,
)
@surface_options()
def corridor(
    ground: Path,
    axis: Path,
    template: Path,
    alignment: str | None,
    turns: Path | None,
    job: Job,
    **asked: Any,
) -> None:
    r"""Carry the cross section in TEMPLATE along AXIS, with side slopes to the TIN in GROUND.

    AXIS is LandXML with an alignment and its vertical alignment, or a vector file of one line in
    space, or a table of its vertices, whose elevations are the profile. TEMPLATE is CSV or JSON
    with a row for each part, from the axis outwards; a column "station" makes it several, between
    which all changes evenly. The summary gives cut and fill.

    A table:
      side,name,width,slope,use,ratio
      both,lane,3.5,-0.025,,
      both,shoulder,1.5,-0.04,,
      both,,,,cut,1.5
      both,,,,fill,2

    Example:
      tinsmith corridor ground.csv road.xml road.csv -o design.gpkg
    """
    from ....io import read_superelevation, read_template
    from ....terrain import corridor as make_corridor
    from ....terrain import volume

    more = [*name_features(axis, "the axis"), Named(template, "the template")]
    if turns is not None:
        more.append(Named(turns, "--superelevation"))
        asked["superelevation"] = read_superelevation(turns)
    planned = job.plan(job.list_inputs(ground, more=more), "TIN")
    tin = job.read_tin(ground)
    section = read_template(template)
    notes: list[str] = []
    along: Any
    if holds_alignments(axis):
        along = read_axis(axis, alignment, crs=tin.crs)
    elif alignment is not None:
        raise click.UsageError("--alignment is for files that name alignments.")
    else:
        along = read_line(axis, tin, job.building.lines_elevation_unit, notes)
    with job.step("Laying out") as progress:
        made = make_corridor(tin, along, section, **asked, progress=progress)
    planned.write("TIN", made)
    table = volume(tin, made)
    unit = table.units.get("cut") or "cubic units of the CRS"
    volumes = {name: float(table[name][0]) for name in ("cut", "fill", "cut_area", "fill_area")}
    facts = Facts(ground)
    facts.add_tin("Corridor", made, volume=volumes)
    for name in ("cut", "fill"):
        facts.add(name.capitalize(), f"{volumes[name]:,.1f} {unit}")
    facts.note([*notes, *made.report.notes])
    job.finish(planned, facts)
