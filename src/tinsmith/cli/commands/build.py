"""``tinsmith build``: points in, TIN out."""

from __future__ import annotations

from time import perf_counter
from typing import TYPE_CHECKING

import click

from ..command import command
from ..job import surface_options
from ..parameters import input_files, output_files, report_option
from ..paths import describe_inputs, name_files

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from ...tin import TIN, Survey
    from ..job import Job
    from ..output.blunder_summaries import Suspects
    from ..output.console import Row
    from ..output.facts import Facts

__all__ = ["build"]


@command
@input_files("points")
@output_files
@report_option(
    "JSON file that accounts for every row merged or left out, and every crossing of lines."
)
@click.option(
    "--drop-blunders",
    is_flag=True,
    help="Leave out points that look like blunders, except doubtful ones; the report names "
    "each. 'tinsmith inspect' shows them beforehand.",
)
@click.option(
    "--from-contours",
    is_flag=True,
    help="POINTS are contour lines, which become breaklines: where they leave the surface flat, "
    "points are added along ridges, valleys, peaks and pits, and marked.",
)
@surface_options()
def build(
    points: tuple[Path, ...],
    report: Path | None,
    drop_blunders: bool,
    job: Job,
    from_contours: bool,
) -> None:
    """Build the exact Delaunay TIN of elevation points and lines.

    POINTS is a text file of survey points (CSV, TXT, XYZ) or an elevation raster (DEM); several
    files, or a folder of tiles, are read as one survey. 'tinsmith formats' lists what can be read
    and written. Breaklines, a boundary, holes and water are read from vector files, in any CRS, or
    made from the field codes of the points.

    \b
    Example:
      tinsmith build sample_data/site_survey.csv --crs EPSG:32616 --codes -o site.geojson
      tinsmith build sample_data/jacksboro.tif --stride 4 -o hills.ply -o hills.stl
      tinsmith build --from-contours contours.gpkg --z-field elevation -o hills.gpkg
    """  # noqa: D301 - click reads the control character
    from ...terrain import mend_flats
    from ..files import add_lines, build_tin, note_surfaces, read_inputs, write_text
    from ..inputs import as_contours, require_contours
    from ..output.blunder_summaries import describe_suspects, report_suspects
    from ..output.console import format_json
    from ..output.summaries import describe_report

    how, console = job.how, job.console
    planned = job.plan(job.list_inputs(*points), "TIN", report=report)
    reading = as_contours(job.reading) if from_contours else job.reading
    survey = _require_survey(read_inputs(points, reading, console), points[0])
    if from_contours:
        require_contours(survey, points[0])
    survey = add_lines(survey, how, console)
    tin = build_tin(survey, how, console)
    tin, suspects = _find_blunders(tin, job, drop=drop_blunders)
    if from_contours:
        with job.step("Mending flat triangles") as progress:
            tin = mend_flats(tin, progress=progress)
    note_surfaces([tin], console)
    planned.write("TIN", tin)
    account = describe_report(tin.report, survey, console.notes) | describe_suspects(suspects)
    if report is not None:
        write_text(report, format_json(account) + "\n")
    facts = _list_facts(points, survey, tin, report_suspects(suspects), is_mended=from_contours)
    facts.record(
        report=account,
        outputs=lambda: [
            {
                "path": str(one.path),
                "format": one.formats["TIN"].name,
                "bytes": one.path.stat().st_size,
            }
            for one in planned.outputs["TIN"]
        ],
        seconds=lambda: round(perf_counter() - job.started, 3),
    )
    job.finish(planned, facts)


def _find_blunders(tin: TIN, job: Job, *, drop: bool) -> tuple[TIN, Suspects]:
    """Look for points that look like blunders, and leave them out where that is asked for."""
    from ...terrain.inspection.dropping import drop_blunders
    from ...terrain.inspection.findings import blunders, screen
    from ..output.blunder_summaries import Suspects

    with job.step("Checking points") as progress:
        if not drop:
            return tin, Suspects(screen(tin), None)
        table = blunders(tin, progress=progress)
        tin, dropped = drop_blunders(tin, table)
        return tin, Suspects(table, dropped)


def _require_survey(found: Survey | TIN, path: Path) -> Survey:
    from ...tin import TIN
    from ..output.failures import Failure

    if isinstance(found, TIN):
        raise Failure(
            f"'{path}' holds a TIN already: use 'tinsmith convert' to write it in another format."
        )
    return found


def _list_facts(
    points: Sequence[Path], survey: Survey, tin: TIN, rows: list[Row], *, is_mended: bool
) -> Facts:
    from ..output.facts import Facts
    from ..output.line_summaries import count_lines, describe_counts, summarise_lines
    from ..output.summaries import (
        describe_survey,
        describe_tin,
        summarise_crs,
        summarise_extent,
        summarise_merges,
        summarise_reading,
    )

    facts = Facts()
    facts.record(input=describe_inputs(points), survey=lambda: describe_survey(survey))
    facts.add("Points", f"{len(survey):,} from {name_files(points)}")
    facts.extend(summarise_reading(survey))
    facts.extend(summarise_merges(tin.report, survey))
    facts.extend(summarise_lines(survey, tin))
    facts.add("TIN", describe_counts(tin), tin=lambda: describe_tin(tin))
    facts.record(counts=lambda: count_lines(tin.report))
    facts.extend([*rows, *_summarise_flats(tin, is_mended=is_mended)])
    facts.extend([*summarise_extent(tin), summarise_crs(tin.crs)])
    return facts


def _summarise_flats(tin: TIN, *, is_mended: bool) -> list[Row]:
    """Tell what was mended, or else of flat triangles if the points look like contours."""
    from ...terrain.inspection.flat_triangles.finding import describe_flats

    if is_mended:
        return [("Contours", tin.report.notes[-1])]
    advice = "'tinsmith build --from-contours' takes contour lines and mends them."
    return [("Flats", f"{sentence}: {advice}") for sentence in describe_flats(tin)]
