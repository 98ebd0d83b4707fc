"""``tinsmith riverbed``: the bed of a river between surveyed cross sections."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from ...command import command
from ...job import Job, name_features, surface_options
from ...options import CONSOLE, READING, WRITING
from ...output import Facts
from ...parameters import file_option, output_files
from ...paths import INPUT
from ...product_options import product_options


@command
@click.argument("sections", type=INPUT)
@click.argument("centreline", type=INPUT)
@output_files
@product_options(
    "terrain.sections.rivers.beds.riverbed",
    "spacing by omit_returns",
    by="Column that tells the section of a point; of lines none is needed.",
    omit_returns="Leave out points at which a section goes back across the channel.",
)
@file_option("--banks", "Vector file of two lines: the banks, which every section crosses.")
@file_option("--thalweg", "Vector file of one line: the deepest flow.")
@surface_options(READING, WRITING, CONSOLE)
def riverbed(
    sections: Path,
    centreline: Path,
    banks: Path | None,
    thalweg: Path | None,
    job: Job,
    **asked: Any,
) -> None:
    """Interpolate the bed of a river between the cross sections in SECTIONS, along CENTRELINE.

    SECTIONS is a vector file of lines in space, or a table of points with a column that tells the
    section of each (--by). CENTRELINE is a vector file of one line, or a table of its vertices.
    Between two sections elevations are linear along the channel at the same share of the width, or
    of each part between ends, banks and thalweg.

    Example:
      tinsmith riverbed sections.csv line.geojson --by section --spacing 10 -o bed.gpkg
    """
    from ....terrain import riverbed as make_bed

    files = {"banks": banks, "thalweg": thalweg}
    more = [*name_features(centreline, "the centreline"), *name_features(banks, "--banks")]
    more += name_features(thalweg, "--thalweg")
    planned = job.plan(job.list_inputs(sections, more=more), "TIN")
    reading = job.with_fallback(lines_as="breaklines")
    survey = reading.read_survey(sections, need=": cross sections are needed.")
    line = job.read_features(centreline, survey, "lines", "a centreline is a line")
    long: dict[str, Any] = {
        name: None if file is None else job.read_features(file, survey, "lines", "lines are needed")
        for name, file in files.items()
    }
    with job.step("Interpolating") as progress:
        bed = make_bed(survey, line, **long, **asked, progress=progress)
    facts = Facts(sections)
    job.finish_tin(planned, facts, "Bed", bed)
