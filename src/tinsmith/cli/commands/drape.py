"""``tinsmith drape``: points, lines and polygons of a file get the surface's elevations."""

from __future__ import annotations

from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, get_args

import click

from ...policies import OutsidePolicy
from ..options import (
    console_options,
    input_file,
    output_files,
    product_options,
    reading_options,
    triangulating_options,
)
from ..output.console import format_json
from ..paths import LINES, Named

if TYPE_CHECKING:
    from ...terrain import Features
    from ..options import Reading, Triangulating, Writing
    from ..output.console import Console

__all__ = ["drape"]


@click.command(short_help="Lay points, lines or polygons on a TIN.")
@input_file("file")
@click.argument("features", type=LINES)
@output_files
@click.option(
    "--outside",
    type=click.Choice(get_args(OutsidePolicy)),
    default="error",
    show_default=True,
    help="What lies outside the surface: refuse, keep without elevations, or leave out.",
)
@reading_options
@triangulating_options
@product_options
@console_options
def drape(
    file: Path,
    features: Path,
    outputs: tuple[Path, ...],
    outside: str,
    reading: Reading,
    how: Triangulating,
    writing: Writing,
    console: Console,
) -> None:
    """Lay the FEATURES of a vector file on the TIN in FILE, or on that of the points in it.

    Lines and polygons get a vertex wherever they cross an edge of the TIN; columns are kept.
    FEATURES in another CRS are reprojected; FILE:LAYER names a layer.

    \b
    Example:
      tinsmith drape site.ply roads.gpkg --outside cut -o roads_3d.gpkg
    """  # noqa: D301 - click reads the control character
    from ...io.vector.geometries import read_geometries
    from ...io.vector.survey_lines import split_layer
    from ...terrain import drape as drape_features
    from ..files import describe_written, list_inputs, plan_outputs, read_tin, write_outputs
    from ..output.line_summaries import mesh_counts

    started = perf_counter()
    path, layer = split_layer(features)
    inputs = [*list_inputs(file, how), Named(path, "the file of features")]
    planned = plan_outputs(outputs, writing, inputs=inputs, console=console, kinds=("Features",))
    tin, _ = read_tin(file, reading, how, console)
    with console.steps() as steps, steps.step("Draping"):
        given = read_geometries(path, crs=tin.crs, layer=layer)
        draped = drape_features(tin, given, outside=outside)  # type: ignore[arg-type]
    write_outputs(draped, planned, console)
    console.summarise(
        [
            ("Surface", mesh_counts(tin)),
            ("Draped", _counts(given, draped)),
            *[("Note", note) for note in draped.notes],
            ("Written", describe_written(planned)),
            ("Time", f"{perf_counter() - started:.2f} s"),
        ]
    )
    if console.as_json:
        facts = {"input": str(file), "features": str(features), "kind": draped.kind}
        counts = {"given": len(given), "draped": len(draped)}
        vertices = {
            "vertices_given": len(given.coordinates),
            "vertices_draped": len(draped.coordinates),
        }
        notes = {"notes": list(draped.notes), "outputs": [str(one.path) for one in planned]}
        console.emit(format_json(facts | counts | vertices | notes))


def _counts(given: Features, draped: Features) -> str:
    from ..._sentences import counted

    vertices = (
        f"{len(given.coordinates):,} to {counted(len(draped.coordinates), 'vertex', 'vertices')}"
    )
    return f"{counted(len(draped), 'feature')} of {len(given):,} ({draped.kind}), {vertices}"
