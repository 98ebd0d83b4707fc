"""``tinsmith profile``: surfaces cut along a line, or square to it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ....base.sentences import counted
from ...command import command
from ...job import Job, name_features
from ...option_groups import axis_options, holds_alignments, read_axis
from ...output import Facts, mesh_counts
from ...parameters import LibraryOption, number_option, output_files, position_option
from ...paths import INPUT, make_title
from ...product_options import product_options
from ...tiling import choose_tiles, compute_tiles, describe_points, tiled_options

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ....terrain import Features, Table
    from ....tiled.cloud import TiledPoints
    from ....tin import TIN
    from ...output import Row
    from ...outputs import Products

Pair = tuple[float, float]


@command
@click.argument("files", nargs=-1, required=True, type=INPUT)
@output_files
@axis_options("Vector file of the lines, or LandXML of an alignment.")
@position_option("--from", "begin", "Start of a line.")
@position_option("--to", "end", "End of the line.")
@product_options("terrain.sections.profiles.profile", "interval start")
@click.option(
    "--sections",
    cls=LibraryOption,
    sets=("interval", "width"),
    metavar="INTERVAL WIDTH",
    nargs=2,
    type=float,
    help="Make cross sections perpendicular to the line, at this interval and of this width.",
)
@click.option(
    "--name",
    "names",
    metavar="TEXT",
    multiple=True,
    help="Name of a surface, once for each; default the name of its file.",
)
@number_option("--exaggeration", "FACTOR", "Of the picture; chosen if absent.")
@click.option(
    "--title", metavar="TEXT", help="Title of the picture; default the name of the first file."
)
@tiled_options()
def profile(
    files: tuple[Path, ...],
    line_file: Path | None,
    begin: Pair | None,
    end: Pair | None,
    names: tuple[str, ...],
    job: Job,
    **asked: Any,
) -> None:
    """Compute profiles of the TINs in FILES, or built from the points in them, along a line.

    There is a row wherever the line crosses an edge of a TIN, with the elevations of all TINs.
    Tables are written to .csv or .json, a picture to .png; cross sections also to .gpkg, .geojson
    and others as 3D lines; their picture is a sheet. Lines in another CRS are reprojected.

    Example:
      tinsmith profile sample_data/site_survey.csv --crs EPSG:32616 --codes
        --from 752690 4024225 --to 752850 4024330 -o profile.csv -o profile.png
    """
    ends = (begin is not None) + (end is not None)
    if (line_file is None) == (ends == 0) or ends == 1:
        raise click.UsageError("A line is needed: --line FILE, or --from X Y and --to X Y.")
    chosen, asked["is_named"] = _choose_names(files, names), bool(names)
    inputs = job.list_inputs(*files, more=name_features(line_file, "the file of --line"))
    with_sections = () if asked["sections"] is None else ("Features",)
    planned = job.plan(inputs, "Table", *with_sections, "picture")
    whole = "--sections" if with_sections else "a picture" if planned.holds("picture") else ""
    cloud = choose_tiles(job, *files, whole=whole)
    if cloud is not None:
        _cut_tiles(cloud, planned, line_file or [begin, end], asked, job)
        return
    surfaces = dict(zip(chosen, job.read_tins(files), strict=True))
    lines: Any = [begin, end]
    if line_file is not None:
        first = next(iter(surfaces.values()))
        lines = _read_lines(line_file, first, asked["alignment"], job)
    with job.step("Cutting"):
        table, sections = _cut(surfaces, lines, planned.holds("Features"), asked)
    figure = _draw(table, surfaces, files, asked) if planned.holds("picture") else None
    planned.write("Table", table)
    planned.write("Features", sections)
    planned.draw(lambda: figure)
    rows = [("Surface", f"{name}: {mesh_counts(tin)}") for name, tin in surfaces.items()]
    job.finish(planned, _list_facts(files, table, rows, getattr(lines, "notes", ())))


def _cut_tiles(
    cloud: TiledPoints, planned: Products, line: Any, asked: dict[str, Any], job: Job
) -> None:
    """Write the profile of tiles."""
    if isinstance(line, Path):
        line = _read_lines(line, cloud, asked["alignment"], job)
    given = {"line": line, "interval": asked["interval"], "start": asked["start"]}
    with compute_tiles(cloud, "profile", planned, job, **given) as table:
        planned.write("Table", table)
    rows = [("Surface", describe_points(cloud))]
    job.finish(planned, _list_facts(cloud.files, table, rows, getattr(line, "notes", ())))


def _read_lines(path: Path, surface: TIN | TiledPoints, name: str | None, job: Job) -> Any:
    """Return the alignment of a file, or its lines."""
    if holds_alignments(path) or name is not None:
        return read_axis(path, name, crs=surface.crs)
    return job.read_features(path, surface, "lines", "a profile runs along lines")


def _list_facts(
    files: Sequence[Path], table: Table, rows: list[Row], notes: Sequence[str]
) -> Facts:
    measured = [name for name, values in table.columns.items() if values.dtype.kind == "f"]
    facts = Facts(inputs=[str(file) for file in files])
    facts.extend(rows)
    facts.add("Rows", f"{len(table):,}", rows=len(table), columns=list(table.columns))
    facts.record(ranges={name: _find_range(table[name]) for name in measured})
    facts.note(dict.fromkeys([*notes, *table.notes]))
    return facts


# ---------------------------------------------------------------- what is given


def _choose_names(files: Sequence[Path], given: Sequence[str]) -> list[str]:
    names = list(given) or [make_title(file) or "surface" for file in files]
    if len(names) != len(files):
        raise click.UsageError(
            f"--name is given {counted(len(names), 'time')} for "
            f"{counted(len(files), 'surface')}: name each once."
        )
    repeated = next((name for name in names if names.count(name) > 1), None)
    if repeated is not None:
        raise click.UsageError(f"Two surfaces are called '{repeated}': --name tells them apart.")
    return names


# ---------------------------------------------------------------- what is made


def _cut(
    surfaces: dict[str, TIN], lines: Any, in_space: bool, asked: dict[str, Any]
) -> tuple[Table, Features | None]:
    """Return the rows, and the sections as lines in space if they are wanted."""
    from ....terrain import cross_sections, section_lines
    from ....terrain import profile as cut_profile

    is_named = len(surfaces) > 1 or asked["is_named"]
    given: Any = surfaces if is_named else next(iter(surfaces.values()))
    if asked["sections"] is None:
        rows = cut_profile(given, lines, interval=asked["interval"], start=asked["start"])
        return rows, None
    interval, width = asked["sections"]
    how = {"interval": interval, "width": width, "start": asked["start"]}
    table = cross_sections(given, lines, **how)
    return table, section_lines(given, lines, **how) if in_space else None


def _draw(
    table: Table, surfaces: dict[str, TIN], files: Sequence[Path], asked: dict[str, Any]
) -> Any:
    from ....terrain import profile_picture, section_picture

    crs = next((tin.crs for tin in surfaces.values() if tin.crs is not None), None)
    is_profile = asked["sections"] is None
    what, draw = ("Profile", profile_picture) if is_profile else ("Cross sections", section_picture)
    title = asked["title"] or f"{what}: {make_title(files[0])}"
    return draw(table, exaggeration=asked["exaggeration"], title=title, crs=crs)


def _find_range(values: Any) -> list[float | None]:
    known = values[values == values]
    return [float(known.min()), float(known.max())] if len(known) else [None, None]
