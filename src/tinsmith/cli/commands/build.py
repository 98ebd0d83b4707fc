"""``tinsmith build``: points in, TIN out."""

from __future__ import annotations

from time import perf_counter
from typing import TYPE_CHECKING, Any

import click

from ..options import (
    console_options,
    input_file,
    output_files,
    reading_options,
    triangulating_options,
    writing_options,
)
from ..output.console import format_json
from ..paths import OUTPUT, name_file

if TYPE_CHECKING:
    from pathlib import Path

    from ...tin import TIN, Survey
    from ..files import Output
    from ..options import Reading, Triangulating, Writing
    from ..output.console import Console, Row

__all__ = ["build"]


@click.command(short_help="Build a TIN from elevation points.")
@input_file("points")
@output_files
@reading_options
@triangulating_options
@writing_options
@click.option(
    "--report",
    metavar="FILE",
    type=OUTPUT,
    help="JSON file that accounts for every row merged or left out, and every crossing of lines.",
)
@console_options
def build(
    points: Path,
    outputs: tuple[Path, ...],
    reading: Reading,
    how: Triangulating,
    writing: Writing,
    report: Path | None,
    console: Console,
) -> None:
    """Build the exact Delaunay TIN of the elevation points in POINTS, and of lines.

    POINTS is a text file of survey points (CSV, TXT, XYZ) or an elevation raster (DEM).
    'tinsmith formats' lists what can be read and written. Breaklines, a boundary, holes and water
    come from vector files, in any CRS, or from the codes of the points.

    \b
    Example:
      tinsmith build sample_data/site_survey.csv --crs EPSG:32616 --codes -o site.geojson
      tinsmith build sample_data/jacksboro.tif --stride 4 -o hills.ply -o hills.stl
    """  # noqa: D301 - click reads the control character
    from ..files import (
        add_lines,
        build_tin,
        list_inputs,
        plan_outputs,
        read_input,
        write_outputs,
        write_text,
    )
    from ..output.summaries import describe_report

    started = perf_counter()
    planned = plan_outputs(
        outputs,
        writing,
        inputs=list_inputs(points, how),
        console=console,
        report=report,
        kinds=("TIN",),
    )
    survey = add_lines(_require_survey(read_input(points, reading, console), points), how, console)
    tin = build_tin(survey, how, console)
    gaps = _warn_of_gaps(tin, how, console)
    write_outputs(tin, planned, console)
    if report is not None:
        write_text(report, format_json(describe_report(tin.report, survey, gaps)) + "\n")
    seconds = perf_counter() - started
    console.summarise(_summarise_build(points, survey, tin, gaps, planned, seconds))
    if console.as_json:
        console.emit(format_json(_describe_build(points, survey, tin, gaps, planned, seconds)))


def _warn_of_gaps(tin: TIN, how: Triangulating, console: Console) -> list[str]:
    """Tell of gaps that the surface spans, unless the user has said how far it may."""
    from ...terrain.gaps import describe_gaps

    if how.max_edge is not None:
        return []
    with console.steps() as steps, steps.step("Looking for gaps"):
        return describe_gaps(tin)


def _require_survey(found: Survey | TIN, path: Path) -> Survey:
    from ...tin import TIN
    from ..output.failures import Failure

    if isinstance(found, TIN):
        raise Failure(
            f"'{path}' holds a TIN already: use 'tinsmith convert' to write it in another format."
        )
    return found


def _summarise_build(
    points: Path, survey: Survey, tin: TIN, gaps: list[str], outputs: list[Output], seconds: float
) -> list[Row]:
    from ..files import describe_written
    from ..output.line_summaries import describe_counts, summarise_lines
    from ..output.summaries import (
        summarise_crs,
        summarise_extent,
        summarise_merges,
        summarise_reading,
    )

    return [
        ("Points", f"{len(survey):,} from {name_file(points)}"),
        *summarise_reading(survey),
        *summarise_merges(tin.report, survey),
        *summarise_lines(survey, tin),
        ("TIN", describe_counts(tin)),
        *(("Gaps", gap) for gap in gaps),
        *summarise_extent(tin),
        summarise_crs(tin.crs),
        ("Written", describe_written(outputs)),
        ("Time", f"{seconds:.2f} s"),
    ]


def _describe_build(
    points: Path, survey: Survey, tin: TIN, gaps: list[str], outputs: list[Output], seconds: float
) -> dict[str, Any]:
    from ..output.line_summaries import count_lines
    from ..output.summaries import describe_report, describe_survey, describe_tin

    return {
        "input": str(points),
        "survey": describe_survey(survey),
        "tin": describe_tin(tin),
        "counts": count_lines(tin.report),
        "report": describe_report(tin.report, survey, gaps),
        "outputs": [
            {
                "path": str(one.path),
                "format": one.formats["TIN"].name,
                "bytes": one.path.stat().st_size,
            }
            for one in outputs
        ],
        "seconds": round(seconds, 3),
    }
