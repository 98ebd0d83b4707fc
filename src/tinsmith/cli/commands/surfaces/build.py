"""``tinsmith build``: points in, TIN out."""

from __future__ import annotations

from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Any

import click

from ....base.sentences import counted
from ...command import command
from ...job import Job
from ...output import Facts, Failure, describe_counts
from ...parameters import input_files, number_option, output_files, report_option
from ...paths import describe_inputs, name_files
from ...tiling import (
    choose_tiles,
    describe_lost,
    describe_points,
    tiled_options,
    write_surface,
)

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from ....tin import TIN, Survey
    from ...output import Row, Suspects


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
@number_option(
    "--tolerance",
    "HEIGHT",
    "Of 3D Tiles: leave out vertices within it on the finest level already; default none.",
)
@number_option(
    "--node-points",
    "N",
    "Of 3D Tiles: points of a square of the finest level, about; default 8192.",
    type=click.IntRange(min=1),
)
@tiled_options()
def build(
    points: tuple[Path, ...],
    report: Path | None,
    drop_blunders: bool,
    job: Job,
    from_contours: bool,
    tolerance: float | None,
    node_points: int | None,
) -> None:
    """Build the exact Delaunay TIN of elevation points and lines.

    POINTS is a text file of survey points (CSV, TXT, XYZ) or an elevation raster (DEM); several
    files, or a folder of tiles, are read as one survey. If the first file holds a TIN, the points
    and breaklines of the others are inserted into it, and all of its own stay. 'tinsmith formats'
    lists what can be read and written. Breaklines, a boundary, holes and water are read from vector
    files, in any CRS, or made from the field codes of the points.

    In tiles (--tiles N, or where memory is short) the surface is written as one file (.ply), or as
    a folder: a file for each tile, or squares at several scales for globes with --output-format
    3dtiles or quantized-mesh.

    Example:
      tinsmith build sample_data/site_survey.csv --crs EPSG:32616 --codes -o site.geojson
      tinsmith build sample_data/jacksboro.tif --stride 4 -o hills.ply -o hills.stl
      tinsmith build --from-contours contours.gpkg --z-field elevation -o hills.gpkg
    """
    from ....terrain import mend_flats
    from ...output import describe_report, describe_suspects, format_json, report_suspects
    from ...outputs import write_text

    given = {"tolerance": tolerance, "node_points": node_points}
    scales = {name: value for name, value in given.items() if value is not None}
    whole = {
        "--report": report is not None,
        "--drop-blunders": drop_blunders,
        "--from-contours": from_contours,
    }
    if _is_built_in_tiles(points, job, whole, scales):
        return
    for name in scales:
        raise click.UsageError(f"--{name.replace('_', '-')} is for 3D Tiles, which need --tiles.")
    planned = job.plan(job.list_inputs(*points), "TIN", report=report)
    base, survey = _read(points, job, is_contours=from_contours)
    if base is None:
        built = job.build_tin(survey)
    else:
        if drop_blunders:
            raise click.UsageError("--drop-blunders is for points, and the first file holds a TIN.")
        built = _insert(base, survey, points[0], job)
    tin, suspects = _find_blunders(built, job, drop=drop_blunders)
    if from_contours:
        with job.step("Mending flat triangles") as progress:
            tin = mend_flats(tin, progress=progress)
    job.note_surfaces(tin)
    planned.write("TIN", tin)
    account = describe_report(tin, survey, job.console.notes) | describe_suspects(suspects)
    if report is not None:
        write_text(report, format_json(account) + "\n")
    rows = [*report_suspects(suspects), *_summarise_flats(tin, is_mended=from_contours)]
    if base is None:
        facts = _list_facts(points, survey, tin, rows)
    else:
        facts = _list_inserted(points, survey, base, tin)
        facts.extend(rows)
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


def _is_built_in_tiles(
    points: Sequence[Path], job: Job, whole: Mapping[str, bool], scales: Mapping[str, Any]
) -> bool:
    """Write the surface in tiles, if it is to be, and tell whether it is.

    ``whole`` are options that need all points at a time, ``scales`` those of 3D Tiles.
    """
    asked = next((flag for flag, is_given in whole.items() if is_given), "")
    cloud = choose_tiles(job, *points, whole=asked)
    if cloud is None:
        return False
    output = write_surface(cloud, job, scales)
    facts = Facts(points[0])
    facts.add("Points", describe_points(cloud))
    kind = "folder" if output.is_dir() else "file"
    facts.add("Written", f"{output}, a {kind}", outputs=[str(output)])
    facts.note(describe_lost(cloud))
    seconds = round(perf_counter() - job.started, 3)
    facts.add("Time", f"{seconds:.2f} s", seconds=seconds)
    job.console.answer(facts)
    return True


def _read(points: Sequence[Path], job: Job, *, is_contours: bool) -> tuple[TIN | None, Survey]:
    """Read points with their lines, and the TIN that they are for, if the first file holds one.

    Of contours lines are breaklines, where formats have a choice; most of them must be level.
    """
    import numpy as np

    need = " already: use 'tinsmith convert' to write it in another format."
    if not is_contours:
        base, survey = job.read_base(*points, need=need)
        return base, job.add_lines(survey)
    if job.reading.options.get("lines_as") == "points":
        raise click.UsageError("--from-contours takes lines as breaklines, --lines-as as points.")
    job = job.with_fallback(lines_as="breaklines")
    survey = job.read_survey(*points, need=need)
    lines = [np.asarray(getattr(line, "coords", line)) for line in survey.breaklines]
    if not lines:
        raise Failure(f"'{points[0]}' has no lines: --from-contours needs contour lines.")
    level = sum(line.shape[1] == 3 and bool((line[:, 2] == line[0, 2]).all()) for line in lines)
    if 2 * level < len(lines):
        raise Failure(
            f"'{points[0]}': of {counted(len(lines), 'line')} {level:,} are level: these are not "
            "contours, since all points of a contour have the same elevation."
        )
    return None, job.add_lines(survey)


def _insert(base: TIN, survey: Survey, path: Path, job: Job) -> TIN:
    """Insert points with their lines into a TIN."""
    how = job.building
    names = ("max_edge", "walls", "conforming", "snap")
    for name in (name for name in names if getattr(how, name)):
        flag = f"--{name.replace('_', '-')}"
        raise Failure(f"'{path}' holds a TIN already, and {flag} needs points to build from.")
    tin = base.copy()
    duplicates: Any = how.duplicates
    with job.step(f"Inserting {counted(len(survey), 'point')}"):
        tin.insert(survey, duplicates=duplicates)
    return tin


def _find_blunders(tin: TIN, job: Job, *, drop: bool) -> tuple[TIN, Suspects]:
    """Look for points that look like blunders, and leave them out where that is asked for."""
    from ....terrain.inspection import blunders, drop_blunders, screen
    from ...output import Suspects

    with job.step("Checking points") as progress:
        if not drop:
            return tin, Suspects(screen(tin), None)
        table = blunders(tin, progress=progress)
        tin, dropped = drop_blunders(tin, table)
        return tin, Suspects(table, dropped)


def _summarise_flats(tin: TIN, *, is_mended: bool) -> list[Row]:
    """Tell what was mended, or else of flat triangles if the points look like contours."""
    from ....terrain.inspection.flat_triangles.finding import describe_flats

    if is_mended:
        return [("Contours", tin.report.notes[-1])]
    advice = "'tinsmith build --from-contours' takes contour lines and mends them."
    return [("Flats", f"{sentence}: {advice}") for sentence in describe_flats(tin)]


def _list_inserted(points: Sequence[Path], survey: Survey, base: TIN, tin: TIN) -> Facts:
    from ...output import describe_survey, summarise_crs, summarise_reading

    facts = Facts(input=describe_inputs(points), survey=lambda: describe_survey(survey))
    facts.add("Read", f"a TIN of {describe_counts(base)} from {name_files(points[:1])}")
    lines = f", {counted(len(survey.breaklines), 'breakline')}" if survey.breaklines else ""
    inserted = f"{counted(len(survey), 'point')}{lines} from {name_files(points[1:])}"
    facts.add("Inserted", inserted)
    facts.extend(summarise_reading(survey))
    facts.add_tin("TIN", tin)
    facts.extend([summarise_crs(tin.crs)])
    facts.note([*survey.notes, *(note for edit in tin.edits[-1:] for note in edit.notes)])
    return facts


def _list_facts(points: Sequence[Path], survey: Survey, tin: TIN, rows: list[Row]) -> Facts:
    from ...output import (
        count_lines,
        describe_survey,
        describe_tin,
        summarise_crs,
        summarise_extent,
        summarise_lines,
        summarise_merges,
        summarise_reading,
    )

    facts = Facts(input=describe_inputs(points), survey=lambda: describe_survey(survey))
    facts.add("Points", f"{len(survey):,} from {name_files(points)}")
    facts.extend(summarise_reading(survey))
    facts.extend(summarise_merges(tin.report, survey))
    facts.extend(summarise_lines(survey, tin))
    facts.add("TIN", describe_counts(tin), tin=lambda: describe_tin(tin))
    facts.extend(rows, counts=lambda: count_lines(tin.report))
    facts.extend([*summarise_extent(tin), summarise_crs(tin.crs)])
    return facts
