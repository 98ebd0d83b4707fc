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
from ..output.console import plain
from ..paths import OUTPUT, name_of

if TYPE_CHECKING:
    from pathlib import Path

    from ...tin import TIN, Survey
    from ..files import Output
    from ..options import Reading, Triangulating, Writing
    from ..output.console import Console, Field

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
        inputs_of,
        plan_outputs,
        read_input,
        triangulated,
        with_lines,
        write_outputs,
        write_text,
    )
    from ..output.summaries import report_facts

    started = perf_counter()
    planned = plan_outputs(
        outputs, writing, inputs=inputs_of(points, how), console=console, report=report
    )
    survey = with_lines(_as_survey(read_input(points, reading, console), points), how, console)
    tin = triangulated(survey, how, console)
    gaps = _gaps(tin, how, console)
    write_outputs(tin, planned, console)
    if report is not None:
        write_text(report, plain(report_facts(tin.report, survey, gaps)) + "\n")
    seconds = perf_counter() - started
    console.summarise(_fields(points, survey, tin, gaps, planned, seconds))
    if console.as_json:
        console.emit(plain(_facts(points, survey, tin, gaps, planned, seconds)))


def _gaps(tin: TIN, how: Triangulating, console: Console) -> list[str]:
    """Tell of gaps that the surface spans, unless the user has said how far it may."""
    from ...terrain.gaps import describe_gaps

    if how.max_edge is not None:
        return []
    with console.steps() as steps, steps.step("Looking for gaps"):
        return describe_gaps(tin)


def _as_survey(found: Survey | TIN, path: Path) -> Survey:
    from ...tin import TIN
    from ..output.failures import Failure

    if isinstance(found, TIN):
        raise Failure(
            f"'{path}' holds a TIN already: use 'tinsmith convert' to write it in another format."
        )
    return found


def _fields(
    points: Path, survey: Survey, tin: TIN, gaps: list[str], outputs: list[Output], seconds: float
) -> list[Field]:
    from ..files import written_text
    from ..output.line_summaries import line_fields, tin_counts
    from ..output.summaries import crs_field, extent_fields, merge_field, reading_fields

    return [
        ("Points", f"{len(survey):,} from {name_of(points)}"),
        *reading_fields(survey),
        *merge_field(tin.report, survey),
        *line_fields(survey, tin),
        ("TIN", tin_counts(tin)),
        *(("Gaps", gap) for gap in gaps),
        *extent_fields(tin),
        crs_field(tin.crs),
        ("Written", written_text(outputs)),
        ("Time", f"{seconds:.2f} s"),
    ]


def _facts(
    points: Path, survey: Survey, tin: TIN, gaps: list[str], outputs: list[Output], seconds: float
) -> dict[str, Any]:
    from ..output.line_summaries import line_counts
    from ..output.summaries import report_facts, survey_facts, tin_facts

    return {
        "input": str(points),
        "survey": survey_facts(survey),
        "tin": tin_facts(tin),
        "counts": line_counts(tin.report),
        "report": report_facts(tin.report, survey, gaps),
        "outputs": [
            {"path": str(one.path), "format": one.format.name, "bytes": one.path.stat().st_size}
            for one in outputs
        ],
        "seconds": round(seconds, 3),
    }
