"""``tinsmith profile``: surfaces cut along a line, or square to it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ....base.products import notes_of_surfaces
from ....base.sentences import counted
from ...command import command
from ...job import Job, name_features
from ...option_groups import (
    add_sheets,
    axis_options,
    holds_alignments,
    name_title_block,
    read_axis,
    sheet_options,
    take_sheets,
)
from ...output import Facts, mesh_counts
from ...parameters import LibraryOption, number_option, output_files, position_option
from ...paths import INPUT, make_title
from ...product_options import product_options
from ...tiling import choose_tiles, compute_tiles, describe_points, tiled_options

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ....terrain import Features, ProfileSheets, Table
    from ....tiled.tiled_points import TiledPoints
    from ....tin import TIN
    from ...output import Row
    from ...outputs import Products

Pair = tuple[float, float]
_OF_SHEETS = ("scale", "paper", "orientation", "date", "title_block", "ground_unit", "vertical")


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
@number_option("--exaggeration", "FACTOR", "Of a picture, where absent chosen, or of sheets.")
@click.option(
    "--title", metavar="TEXT", help="Title of the picture; default the name of the first file."
)
@click.option("--vertical", metavar="NAME", help="Gradient line of the alignment on sheets.")
@sheet_options("scale paper orientation date title_block ground_unit")
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
    Tables are written to .csv or .json, a picture to .png, sheets true to scale to .pdf, .svg or
    .dxf; cross sections also to .gpkg, .geojson and others as 3D lines; their picture is a sheet.
    Lines in another CRS are reprojected.

    Example:
      tinsmith profile sample_data/site_survey.csv --crs EPSG:32616 --codes
        --from 752690 4024225 --to 752850 4024330 -o profile.csv -o profile.png
    """
    ends = (begin is not None) + (end is not None)
    if (line_file is None) == (ends == 0) or ends == 1:
        raise click.UsageError("A line is needed: --line FILE, or --from X Y and --to X Y.")
    chosen, asked["is_named"] = _choose_names(files, names), bool(names)
    more = name_features(line_file, "the file of --line")
    inputs = job.list_inputs(*files, more=[*more, *name_title_block(asked["title_block"])])
    with_sections = asked["sections"] is not None
    planned = job.plan(inputs, "Table", "Features" if with_sections else "sheets", "picture")
    sheets = take_sheets(asked, planned, _OF_SHEETS, "a drawn profile")
    drawn = "a picture" if planned.holds("picture") or planned.holds("sheets") else ""
    whole = "--sections" if with_sections else drawn
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
    facts = _list_facts(files, table, rows, getattr(lines, "notes", ()))
    if planned.holds("sheets"):
        made = _draw_sheets(surfaces, lines, files, asked | sheets)
        planned.save(made)
        add_sheets(facts, made, {*table.notes, *notes_of_surfaces(surfaces.values())})
    job.finish(planned, facts)


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


def _draw_sheets(
    surfaces: dict[str, TIN], lines: Any, files: Sequence[Path], asked: dict[str, Any]
) -> ProfileSheets:
    from ....terrain import profile_sheets

    how = {name: asked[name] for name in (*_OF_SHEETS, "start")}
    title = asked["title"] or f"Profile: {make_title(files[0])}"
    exaggeration = 10.0 if asked["exaggeration"] is None else asked["exaggeration"]
    return profile_sheets(surfaces, lines, title=title, exaggeration=exaggeration, **how)


def _find_range(values: Any) -> list[float | None]:
    known = values[values == values]
    return [float(known.min()), float(known.max())] if len(known) else [None, None]
