"""``tinsmith contours``: contour lines, bands and labels of a TIN."""

from __future__ import annotations

from time import perf_counter
from typing import TYPE_CHECKING, Any

import click

from ..._sentences import counted
from ..options import (
    console_options,
    input_file,
    output_files,
    reading_options,
    triangulating_options,
    writing_options,
)
from ..output.console import format_json
from ..paths import make_title

if TYPE_CHECKING:
    from pathlib import Path

    from ...terrain import Features
    from ...tin import TIN
    from ..options import Reading, Triangulating, Writing
    from ..output.console import Console, Row

__all__ = ["contours"]


@click.command(short_help="Draw contour lines, bands or labels of a TIN.")
@input_file("file")
@output_files
@click.option(
    "--interval", metavar="HEIGHT", type=float, help="Between levels, in the unit of elevations."
)
@click.option(
    "--levels", metavar="Z,Z,...", help="Explicit levels instead of an interval, with commas."
)
@click.option(
    "--base",
    metavar="ELEVATION",
    type=float,
    default=0.0,
    show_default=True,
    help="A level from which the others are counted.",
)
@click.option(
    "--index",
    metavar="N",
    type=click.IntRange(min=0),
    default=5,
    show_default=True,
    help="Every Nth contour is an index contour, counted from the base; 0 for none.",
)
@click.option(
    "--smooth",
    metavar="HEIGHT",
    type=float,
    help="Round the corners, as far as the surface stays within this much of the level.",
)
@click.option("--simplify", metavar="HEIGHT", type=float, help="Drop points, likewise.")
@click.option("--bands", is_flag=True, help="Write the bands between levels, as polygons.")
@click.option(
    "--labels", is_flag=True, help="Write labels of the lines, as points with a rotation."
)
@click.option(
    "--label-spacing",
    metavar="DISTANCE",
    type=float,
    help="Between labels of a line, in CRS units; default a third of the extent.",
)
@reading_options
@triangulating_options
@writing_options
@console_options
def contours(
    file: Path,
    outputs: tuple[Path, ...],
    reading: Reading,
    how: Triangulating,
    writing: Writing,
    console: Console,
    **options: Any,
) -> None:
    """Draw contours of the TIN in FILE, or that of the points in it, at an interval or at levels.

    A level counts as just below its value: lines are closed or end at the boundary, and flat areas
    at a level lie above it. Smoothed and simplified lines do not touch one another.

    \b
    Example:
      tinsmith contours sample_data/site_survey.csv --crs EPSG:32616 --interval 0.5 -o site.gpkg
      tinsmith contours sample_data/site_survey.csv --crs EPSG:32616 --interval 0.5 -o site.png
      tinsmith contours sample_data/site_survey.csv --crs EPSG:32616 --interval 1 --bands -o b.gpkg
    """  # noqa: D301 - click reads the control character
    from ..files import list_inputs, read_tin
    from ..surfaces import plan_products

    started = perf_counter()
    _require_one_product(options)
    options["levels"] = _numbers(options["levels"])
    inputs, kinds = list_inputs(file, how), ["Features", "picture"]
    planned = plan_products(outputs, writing, inputs=inputs, console=console, kinds=kinds)
    tin, _ = read_tin(file, reading, how, console)
    with console.steps() as steps, steps.step("Tracing contours"):
        made = _product(tin, options)
    planned.write("Features", made, console)
    planned.draw(lambda: _draw(tin, made, options, make_title(file)), console)
    written = [str(path) for path in planned.paths]
    console.summarise(
        [
            *_fields(made),
            *(("Note", note) for note in made.notes),
            ("Written", planned.text),
            ("Time", f"{perf_counter() - started:.2f} s"),
        ]
    )
    if console.as_json:
        console.emit(format_json(_facts(file, made, written)))


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


def _numbers(text: str | None) -> list[float] | None:
    if text is None:
        return None
    try:
        return [float(part) for part in text.split(",")]
    except ValueError:
        raise click.UsageError(
            f"Invalid --levels '{text}': it must be numbers with commas between them."
        ) from None


def _product(tin: TIN, options: dict[str, Any]) -> Features:
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
    lines = _product(tin, options | {"labels": False}) if is_labels else made
    labels = made if is_labels else contour_labels(lines)
    return contour_map(tin, lines, labels=labels, title=title)


def _fields(made: Features) -> list[Row]:
    if made.kind == "polygons":
        return [("Bands", counted(len(made), "band"))]
    if made.kind == "points":
        return [("Labels", counted(len(made), "label"))]
    closed = int(made.columns["is_closed"].sum())
    counts = f"{counted(len(made), 'line')}, {closed:,} of them closed"
    return [("Contours", counts), ("Points", f"{len(made.coordinates):,}"), *_level_fields(made)]


def _level_fields(made: Features) -> list[Row]:
    from ...terrain.results.columns import unit_text

    levels = sorted(set(made.columns["elevation"].tolist()))
    if not levels:
        return []
    unit = unit_text(made.units, "elevation")
    shown = f" {unit}" if unit and unit != "unknown" else ""
    return [("Levels", f"{len(levels):,}, from {levels[0]:g} to {levels[-1]:g}{shown}")]


def _facts(file: Path, made: Features, outputs: list[str]) -> dict[str, Any]:
    from ...terrain.results.columns import unit_text

    record: dict[str, Any] = {
        "input": str(file),
        "kind": made.name,
        "features": len(made),
        "points": len(made.coordinates),
        "units": {name: unit_text(made.units, name) for name in made.columns},
        "notes": list(made.notes),
        "outputs": outputs,
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
