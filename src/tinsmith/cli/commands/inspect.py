"""``tinsmith inspect``: points that look like blunders."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from ..command import command
from ..job import surface_options
from ..parameters import input_files, output_option
from ..paths import describe_inputs, make_title, name_files

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from ...terrain import Features, Table
    from ...tin import TIN
    from ..job import Job
    from ..output.facts import Facts

__all__ = ["inspect"]

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

    \b
    Example:
      tinsmith inspect sample_data/site_survey.csv --crs EPSG:32616
      tinsmith inspect sample_data/site_survey.csv --codes -o suspects.gpkg -o suspects.png
    """  # noqa: D301 - click reads the control character
    from ...terrain import blunder_map, blunders
    from ..files import read_tin_of_files

    planned = job.plan_products(job.list_inputs(*points), "Table", "Features", "picture")
    tin = read_tin_of_files(points, job.reading, job.how, job.console)[0]
    with job.step("Checking points") as progress:
        table = blunders(tin, progress=progress)
    planned.write("Table", table)
    planned.write("Features", lambda: _place_suspects(table, tin))
    title = title or f"{make_title(points[0])}: points that look like blunders"
    planned.draw(lambda: blunder_map(tin, table, title=title))
    job.finish(planned, _list_facts(points, tin, table))


def _place_suspects(table: Table, tin: TIN) -> Features:
    """Return the rows of the table as points."""
    import numpy as np

    from ...terrain import Features

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


def _list_facts(points: Sequence[Path], tin: TIN, table: Table) -> Facts:
    from ..output.blunder_summaries import count_reasons, list_findings
    from ..output.facts import Facts, list_rows, name_units
    from ..output.line_summaries import describe_counts

    facts = Facts()
    facts.record(input=describe_inputs(points), units=name_units(table.units))
    facts.add("Points", f"{len(tin.vertex_of):,} from {name_files(points)}")
    facts.add("TIN", describe_counts(tin))
    facts.add("Findings", count_reasons(table), blunders=lambda: list_rows(table.columns))
    facts.extend(list_findings(table, _SHOWN))
    facts.note(table.notes)
    return facts
