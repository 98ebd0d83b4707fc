"""``tinsmith contours``: contour lines, bands and labels of a TIN."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from ...base.sentences import counted, height
from ..command import file_command
from ..parameters import LibraryOption, number_option, numbers_option
from ..paths import make_title
from ..request import surface_options

if TYPE_CHECKING:
    from pathlib import Path

    from ...base.progress import Tell
    from ...terrain import Features
    from ...tin import TIN
    from ..output.console import Row
    from ..request import Request

__all__ = ["contours"]


@file_command
@number_option("--interval", "HEIGHT", "Contour interval, in the unit of elevations.")
@numbers_option(
    "--levels", "Z,Z,...", "Explicit levels instead of an interval, separated by commas."
)
@number_option("--base", "ELEVATION", "Level from which the others are counted.", default=0.0)
@number_option(
    "--index",
    "N",
    "Every Nth contour is an index contour, counted from the base; 0 for none.",
    type=click.IntRange(min=0),
    default=5,
)
@number_option(
    "--smooth",
    "HEIGHT",
    "Smooth the lines, as long as the surface stays within this height of the level.",
)
@number_option("--simplify", "HEIGHT", "Remove points of lines, within this height of the level.")
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
@surface_options()
def contours(
    file: Path,
    request: Request,
    **options: Any,
) -> None:
    """Draw contours of the TIN in FILE, or built from the points in it.

    Levels are given by an interval or one by one. A level is treated as infinitesimally below its
    value: lines are closed or end at the boundary, and flat areas at a level lie above it. Smoothed
    and simplified lines do not touch one another.

    \b
    Example:
      tinsmith contours sample_data/site_survey.csv --crs EPSG:32616 --interval 0.5 -o site.gpkg
      tinsmith contours sample_data/site_survey.csv --crs EPSG:32616 --interval 0.5 -o site.png
      tinsmith contours sample_data/site_survey.csv --crs EPSG:32616 --interval 1 --bands -o b.gpkg
    """  # noqa: D301 - click reads the control character
    _require_one_product(options)
    planned = request.plan_products(request.list_inputs(file), "Features", "picture")
    tin = request.read_tin(file)
    with request.step("Tracing contours") as progress:
        made = _make_product(tin, options, progress)
    planned.write("Features", made)
    planned.draw(lambda: _draw(tin, made, options, make_title(file)))
    rows = [*_summarise_contours(made), *(("Note", note) for note in made.notes)]
    request.finish(planned, rows, lambda: _describe_contours(file, made))


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
    from ...terrain import contour_bands, contour_labels
    from ...terrain import contours as trace

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
    from ...terrain import contour_labels, contour_map

    if options["bands"]:
        return contour_map(tin, bands=made, title=title)
    is_labels = options["labels"]
    lines = _make_product(tin, options | {"labels": False}) if is_labels else made
    labels = made if is_labels else contour_labels(lines)
    return contour_map(tin, lines, labels=labels, title=title)


def _summarise_contours(made: Features) -> list[Row]:
    if made.kind == "polygons":
        return [("Bands", counted(len(made), "band"))]
    if made.kind == "points":
        return [("Labels", counted(len(made), "label"))]
    closed = int(made.columns["is_closed"].sum())
    counts = f"{counted(len(made), 'line')}, {closed:,} of them closed"
    return [
        ("Contours", counts),
        ("Points", f"{len(made.coordinates):,}"),
        *_summarise_levels(made),
    ]


def _summarise_levels(made: Features) -> list[Row]:
    from ...base.results.columns import unit_text

    levels = sorted(set(made.columns["elevation"].tolist()))
    if not levels:
        return []
    unit = unit_text(made.units, "elevation")
    shown = f" {unit}" if unit and unit != "unknown" else ""
    return [
        (
            "Levels",
            f"{len(levels):,}, from {height(levels[0])} to {height(levels[-1])}{shown}",
        )
    ]


def _describe_contours(file: Path, made: Features) -> dict[str, Any]:
    from ...base.results.columns import unit_text

    record: dict[str, Any] = {
        "input": str(file),
        "kind": made.name,
        "features": len(made),
        "points": len(made.coordinates),
        "units": {name: unit_text(made.units, name) for name in made.columns},
        "notes": list(made.notes),
    }
    if made.kind == "lines":
        record["levels"] = sorted(set(made.columns["elevation"].tolist()))
        record["length"] = float(made.columns["length"].sum())
        record["closed"] = int(made.columns["is_closed"].sum())
    if made.kind == "polygons":
        names = ("from", "to", "area")
        rows = zip(*(made.columns[name].tolist() for name in names), strict=True)
        record["bands"] = [dict(zip(names, row, strict=True)) for row in rows]
    return record
