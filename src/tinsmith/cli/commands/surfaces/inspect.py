"""``tinsmith inspect``: points that look like blunders."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from ...command import command
from ...job import Job, surface_options
from ...output import Facts, describe_counts, list_rows, name_units
from ...parameters import input_files, output_option
from ...paths import describe_inputs, make_title, name_files

if TYPE_CHECKING:
    from ....terrain import Features, Table
    from ....tin import TIN

_SHOWN = 12


@command
@input_files("points")
@output_option("Table (.csv, .json), points (.gpkg, .geojson, .shp, .fgb) or map (.png) to write.")
@click.option("--title", metavar="TEXT", help="Title of the map; default the name of the file.")
@surface_options()
def inspect(points: tuple[Path, ...], title: str | None, job: Job) -> None:
    """Find points in POINTS that look like blunders, with the reason.

    Each point is compared with the surface of all others. Reported are spikes and pits, codes for
    missing elevations, factors of ten and of feet, exchanged axes, points far from all others,
    lines that the points do not bear out, filled voids, repeated point numbers and positions, and
    lines that cross at different elevations. Nothing is changed; 'tinsmith build --drop-blunders'
    leaves such points out.

    Example:
      tinsmith inspect sample_data/site_survey.csv --crs EPSG:32616
      tinsmith inspect sample_data/site_survey.csv --codes -o suspects.gpkg -o suspects.png
    """
    from ....terrain import blunder_map, blunders
    from ...output import count_reasons, list_findings

    planned = job.plan(job.list_inputs(*points), "Table", "Features", "picture")
    tin = job.read_tin(*points)
    with job.step("Checking points") as progress:
        table = blunders(tin, progress=progress)
    planned.write("Table", table)
    planned.write("Features", lambda: _place_suspects(table, tin))
    title = title or f"{make_title(points[0])}: points that look like blunders"
    planned.draw(lambda: blunder_map(tin, table, title=title))
    facts = Facts(input=describe_inputs(points), units=name_units(table.units))
    facts.add("Points", f"{len(tin.vertex_of):,} from {name_files(points)}")
    facts.add("TIN", describe_counts(tin))
    facts.add("Findings", count_reasons(table), blunders=lambda: list_rows(table.columns))
    facts.extend(list_findings(table, _SHOWN))
    facts.note(table.notes)
    job.finish(planned, facts)


def _place_suspects(table: Table, tin: TIN) -> Features:
    """Return the rows of the table as points."""
    import numpy as np

    from ....terrain import Features

    columns = {name: values for name, values in table.columns.items() if name not in "xyz"}
    return Features.of_points(
        np.column_stack([table[name] for name in "xyz"]),
        columns=columns,
        units={name: unit for name, unit in table.units.items() if name in columns},
        crs=tin.crs,
        elevation_unit=tin.elevation_unit,
        name="suspects",
        notes=table.notes,
    )
