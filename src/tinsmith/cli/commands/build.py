"""``tinsmith build``: points in, TIN out."""

from __future__ import annotations

from functools import partial
from time import perf_counter
from typing import TYPE_CHECKING, Any

import click

from ..command import command
from ..parameters import input_files, output_files, report_option
from ..paths import describe_inputs, name_files
from ..request import surface_options

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from ...tin import TIN, Survey
    from ..output.blunder_summaries import Suspects
    from ..output.console import Row
    from ..products import Products
    from ..request import Request

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
    request: Request,
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
    from ..contour_input import as_contours, require_contours
    from ..files import add_lines, build_tin, note_surfaces, read_inputs, write_text
    from ..output.blunder_summaries import describe_suspects, tell_suspects
    from ..output.console import format_json
    from ..output.summaries import describe_report

    how, console = request.how, request.console
    planned = request.plan(request.list_inputs(*points), "TIN", report=report)
    reading = as_contours(request.reading) if from_contours else request.reading
    survey = _require_survey(read_inputs(points, reading, console), points[0])
    if from_contours:
        require_contours(survey, points[0])
    survey = add_lines(survey, how, console)
    tin = build_tin(survey, how, console)
    tin, suspects = _find_blunders(tin, request, drop=drop_blunders)
    if from_contours:
        with request.step("Mending flat triangles") as progress:
            tin = mend_flats(tin, progress=progress)
    note_surfaces([tin], console)
    planned.write("TIN", tin)
    account = describe_report(tin.report, survey, console.notes) | describe_suspects(suspects)
    if report is not None:
        write_text(report, format_json(account) + "\n")
    told = tell_suspects(suspects)
    rows = _summarise_build(points, survey, tin, told, is_mended=from_contours)
    describe = partial(_describe_build, points, survey, tin, account, planned, request.started)
    request.finish(planned, rows, describe)


def _find_blunders(tin: TIN, request: Request, *, drop: bool) -> tuple[TIN, Suspects]:
    """Look for points that look like blunders, and leave them out where that is asked for."""
    from ...terrain.inspection.dropping import drop_blunders
    from ...terrain.inspection.findings import blunders, screen
    from ..output.blunder_summaries import Suspects

    with request.step("Checking points") as progress:
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


def _summarise_build(
    points: Sequence[Path], survey: Survey, tin: TIN, told: list[Row], *, is_mended: bool
) -> list[Row]:
    from ..output.line_summaries import describe_counts, summarise_lines
    from ..output.summaries import (
        summarise_crs,
        summarise_extent,
        summarise_merges,
        summarise_reading,
    )

    return [
        ("Points", f"{len(survey):,} from {name_files(points)}"),
        *summarise_reading(survey),
        *summarise_merges(tin.report, survey),
        *summarise_lines(survey, tin),
        ("TIN", describe_counts(tin)),
        *told,
        *_summarise_flats(tin, is_mended=is_mended),
        *summarise_extent(tin),
        summarise_crs(tin.crs),
    ]


def _summarise_flats(tin: TIN, *, is_mended: bool) -> list[Row]:
    """Tell what was mended, or else of flat triangles if the points look like contours."""
    from ...terrain.inspection.flat_triangles.finding import describe_flats

    if is_mended:
        return [("Contours", tin.report.notes[-1])]
    advice = "'tinsmith build --from-contours' takes contour lines and mends them."
    return [("Flats", f"{sentence}: {advice}") for sentence in describe_flats(tin)]


def _describe_build(
    points: Sequence[Path],
    survey: Survey,
    tin: TIN,
    account: dict[str, Any],
    planned: Products,
    started: float,
) -> dict[str, Any]:
    from ..output.line_summaries import count_lines
    from ..output.summaries import describe_survey, describe_tin

    return {
        "input": describe_inputs(points),
        "survey": describe_survey(survey),
        "tin": describe_tin(tin),
        "counts": count_lines(tin.report),
        "report": account,
        "outputs": [
            {
                "path": str(one.path),
                "format": one.formats["TIN"].name,
                "bytes": one.path.stat().st_size,
            }
            for one in planned.outputs["TIN"]
        ],
        "seconds": round(perf_counter() - started, 3),
    }
