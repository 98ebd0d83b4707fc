"""``tinsmith contours``: contour lines, bands and labels of a TIN."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ....base.sentences import counted, height
from ...command import file_command
from ...job import Job
from ...output import Facts, list_rows, name_unit, name_units
from ...parameters import LibraryOption, number_option
from ...paths import make_title
from ...product_options import product_options
from ...tiling import choose_tiles, compute_tiles, tiled_options

if TYPE_CHECKING:
    from ....base.progress import Tell
    from ....terrain import Features
    from ....tiled.tiled_points import TiledPoints
    from ....tin import TIN
    from ...outputs import Products


@file_command
@product_options(
    "terrain.isolines.lines.contours",
    "interval levels base",
    interval="Contour interval, in the unit of elevations.",
    levels="Explicit levels instead of an interval, separated by commas.",
)
@number_option(
    "--index",
    "N",
    "Every Nth contour is an index contour, counted from the base; 0 for none.",
    type=click.IntRange(min=0),
    default=5,
)
@product_options("terrain.isolines.lines.contours", "smooth simplify")
@click.option("--bands", is_flag=True, help="Write the bands between levels, as polygons.")
@click.option(
    "--labels", is_flag=True, help="Write labels of the lines, as points with a rotation."
)
@number_option(
    "--label-spacing",
    "DISTANCE",
    "Distance between labels of a line, in CRS units; default a third of the extent.",
    cls=LibraryOption,
    sets=("spacing",),
)
@tiled_options()
def contours(file: Path, job: Job, **options: Any) -> None:
    """Draw contours of the TIN in FILE, or built from the points in it.

    Levels are given by an interval or one by one. A level is treated as infinitesimally below its
    value: lines are closed or end at the boundary, and flat areas at a level lie above it. Smoothed
    and simplified lines do not touch one another.

    Example:
      tinsmith contours sample_data/site_survey.csv --crs EPSG:32616 --interval 0.5 -o site.gpkg
      tinsmith contours sample_data/site_survey.csv --crs EPSG:32616 --interval 0.5 -o site.png
      tinsmith contours sample_data/site_survey.csv --crs EPSG:32616 --interval 1 --bands -o b.gpkg
    """
    _require_one_product(options)
    planned = job.plan(job.list_inputs(file), "Features", "picture")
    whole = ("smooth", "simplify", "labels")
    asked = [f"--{name}" for name in whole if options[name]]
    asked += ["a picture"] if planned.holds("picture") else []
    cloud = choose_tiles(job, file, whole=next(iter(asked), ""))
    if cloud is not None:
        _contour_tiles(cloud, planned, options, file, job)
        return
    tin = job.read_tin(file)
    with job.step("Tracing contours") as progress:
        made = _make_product(tin, options, progress)
    planned.write("Features", made)
    planned.draw(lambda: _draw(tin, made, options, make_title(file)))
    job.finish(planned, _list_facts(file, made))


def _contour_tiles(
    cloud: TiledPoints, planned: Products, options: dict[str, Any], file: Path, job: Job
) -> None:
    """Write the contours or bands of tiles."""
    given = {name: options[name] for name in ("interval", "levels", "base")}
    if not options["bands"]:
        given["index"] = options["index"] or None
    product = "bands" if options["bands"] else "contours"
    with compute_tiles(cloud, product, planned, job, **given) as made:
        planned.write("Features", made)
    job.finish(planned, _list_facts(file, made))


def _require_one_product(options: dict[str, Any]) -> None:
    """Refuse options that do not go together."""
    if options["bands"] and options["labels"]:
        raise click.UsageError("--bands and --labels are two products: write one at a time.")
    if options["bands"]:
        for name in ("smooth", "simplify"):
            if options[name] is not None:
                raise click.UsageError(f"--{name} is for lines: bands are exact.")
    if options["label_spacing"] is not None and not options["labels"]:
        raise click.UsageError("--label-spacing needs --labels.")
    if (options["interval"] is None) == (options["levels"] is None):
        raise click.UsageError("Either --interval or --levels is needed, and not both.")


def _make_product(tin: TIN, options: dict[str, Any], progress: Tell | None = None) -> Features:
    from ....terrain import contour_bands, contour_labels
    from ....terrain import contours as trace

    where = {name: options[name] for name in ("interval", "levels", "base")}
    if options["bands"]:
        return contour_bands(tin, **where)
    lines = trace(
        tin,
        **where,
        index=options["index"] or None,
        smooth=options["smooth"],
        simplify=options["simplify"],
        progress=progress,
    )
    if not options["labels"]:
        return lines
    return contour_labels(lines, spacing=options["label_spacing"])


def _draw(tin: TIN, made: Features, options: dict[str, Any], title: str) -> Any:
    """Return a map of what was made; labels stand on their lines."""
    from ....terrain import contour_labels, contour_map

    if options["bands"]:
        return contour_map(tin, bands=made, title=title)
    is_labels = options["labels"]
    lines = _make_product(tin, options | {"labels": False}) if is_labels else made
    labels = made if is_labels else contour_labels(lines)
    return contour_map(tin, lines, labels=labels, title=title)


def _list_facts(file: Path, made: Features) -> Facts:
    facts = Facts(file, kind=made.name, features=len(made), points=len(made.coordinates))
    facts.record(units=name_units(made.units, made.columns))
    facts.note(made.notes)
    if made.kind == "polygons":
        bands = list_rows({name: made.columns[name] for name in ("from", "to", "area")})
        facts.add("Bands", counted(len(made), "band"), bands=bands)
        return facts
    if made.kind == "points":
        facts.add("Labels", counted(len(made), "label"))
        return facts
    closed = int(made.columns["is_closed"].sum())
    text = f"{counted(len(made), 'line')}, {closed:,} of them closed"
    facts.add("Contours", text, closed=closed, length=float(made.columns["length"].sum()))
    facts.add("Points", f"{len(made.coordinates):,}")
    levels = sorted(set(made.columns["elevation"].tolist()))
    facts.record(levels=levels)
    if levels:
        unit = name_unit(made.units, "elevation")
        ends = f"from {height(levels[0])} to {height(levels[-1])}"
        facts.add("Levels", f"{len(levels):,}, {ends} {unit}".rstrip())
    return facts
