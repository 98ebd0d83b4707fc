"""``tinsmith sections``: volumes between cross sections of two surfaces, and mass haul."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ....base.products import notes_of_surfaces
from ...command import command
from ...job import Job, name_features, surface_options
from ...option_groups import (
    add_sheets,
    axis_options,
    holds_alignments,
    name_title_block,
    read_axis,
    sheet_options,
    take_sheets,
)
from ...output import Facts, list_rows, mesh_counts, name_units
from ...parameters import number_option, output_option
from ...paths import INPUT, make_title
from ...product_options import product_options

if TYPE_CHECKING:
    from ....terrain import Table
    from ...output import Row

_OF_SHEETS = (
    *("scale", "paper", "orientation", "title", "date", "title_block", "ground_unit"),
    "exaggeration",
)


@command
@click.argument("ground", type=INPUT)
@click.argument("design", type=INPUT)
@output_option(
    "Table (.csv, .json), diagram of mass haul (.png) or drawn sections (.pdf, .svg, .dxf) to "
    "write."
)
@axis_options("LandXML, DXF, vector file or table of the axis.")
@product_options(
    "terrain.sections.quantities.section_volumes",
    "interval width left right start shrink_factor swell_factor",
    interval="A section at every multiple of it, and at both ends.",
    width="Of the sections, half of it to either side.",
    left="How far sections reach to the left instead.",
    right="How far sections reach to the right instead.",
    start="Station where a line begins; an alignment has its own.",
)
@number_option(
    "--exaggeration", "FACTOR", "How many times elevations are drawn larger.", default=1.0
)
@sheet_options("scale paper orientation title date title_block ground_unit")
@surface_options()
def sections(ground: Path, design: Path, line_file: Path | None, job: Job, **asked: Any) -> None:
    """Compute cut and fill from the TIN in GROUND to that in DESIGN, section by section.

    Each section has its areas; from one to the next there are the volumes between both surfaces,
    and those of the mean areas and of Simpson's rule, which contracts measure by; then the ordinate
    of mass haul. The axis is an alignment of LandXML, a DXF drawing, the line of a vector file, or
    the rows of a table.

    Example:
      tinsmith sections ground.csv design.csv --line road.xml --interval 20 --width 30
        -o quantities.csv -o mass-haul.png -o sheets.pdf
    """
    from ....terrain import mass_haul_picture, section_sheets, section_volumes

    if line_file is None:
        raise click.UsageError("An axis is needed: --line FILE.")
    if asked["interval"] is None:
        raise click.UsageError("The interval of the sections is needed: --interval LENGTH.")
    more = name_features(line_file, "the file of --line")
    more += name_title_block(asked["title_block"])
    planned = job.plan(job.list_inputs(ground, design, more=more), "Table", "picture", "sheets")
    sheets = take_sheets(asked, planned, _OF_SHEETS, "drawn sections")
    surfaces = job.read_tins([ground, design])
    first, second = surfaces
    axis = read_axis(line_file, asked.pop("alignment"), crs=first.crs)
    title = f"Mass haul: {make_title(ground)} to {make_title(design)}"
    start = asked.pop("start")
    if start != 0.0:
        if holds_alignments(line_file):
            raise click.UsageError("--start is for lines: an alignment has stations of its own.")
        axis = replace(axis, start=start)
    with job.step("Measuring") as progress:
        table = section_volumes(first, second, axis, progress=progress, **asked)
    planned.write("Table", table)
    planned.draw(lambda: mass_haul_picture(table, title=title))
    drawn = None
    if planned.holds("sheets"):
        with job.step("Drawing"):
            named = {"ground": first, "design": second}
            where = {name: asked[name] for name in ("interval", "width", "left", "right")}
            words = sheets.pop("title") or f"Cross sections: {make_title(design)}"
            drawn = section_sheets(named, axis, title=words, **where, **sheets)
        planned.save(drawn)
    rows = list(zip(("Ground", "Design"), map(mesh_counts, surfaces), strict=True))
    facts = _list_facts([ground, design], table, rows)
    if drawn is not None:
        add_sheets(facts, drawn, {*table.notes, *notes_of_surfaces(surfaces)})
    job.finish(planned, facts)


def _list_facts(files: list[Path], table: Table, rows: list[Row]) -> Facts:
    facts = Facts(inputs=[str(file) for file in files])
    facts.record(rows=list_rows(table.columns), units=name_units(table.units))
    facts.extend(rows)
    facts.add("Sections", f"{len(table):,}")
    for name in ("cut", "fill"):
        unit = table.units.get(f"{name}_total")
        symbol = getattr(unit, "symbol", unit) or ""
        by_areas = float(table[f"{name}_end_area"].sum())
        text = f"{table[f'{name}_total'][-1]:,.2f} {symbol}, by mean areas {by_areas:,.2f} {symbol}"
        facts.add(name.capitalize(), text)
    facts.add("Mass", f"{table['mass'][-1]:+,.2f} at the end")
    facts.note(table.notes)
    return facts
