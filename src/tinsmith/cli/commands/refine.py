"""``tinsmith refine``: a mesh for finite elements."""

from __future__ import annotations

from time import perf_counter
from typing import TYPE_CHECKING, Any

import click

from ..._sentences import counted
from ..flags import name_flags
from ..options import (
    console_options,
    input_file,
    output_files,
    reading_options,
    triangulating_options,
    writing_options,
)
from ..output.console import format_json
from ..output.failures import Failure, refuse_option

if TYPE_CHECKING:
    from pathlib import Path

    from ...tin import TIN, Quality
    from ...tin.report import Unmended
    from ..options import Reading, Triangulating, Writing
    from ..output.console import Console, Row

__all__ = ["refine"]


@click.command(short_help="Make a finite element mesh of a TIN.")
@input_file("file")
@output_files
@click.option(
    "--min-angle",
    metavar="DEGREES",
    type=float,
    default=25.0,
    show_default=True,
    help="Least angle of a triangle, up to 33.",
)
@click.option(
    "--max-area", metavar="AREA", type=float, help="Largest triangle, in CRS units squared."
)
@click.option(
    "--max-side",
    metavar="LENGTH",
    type=float,
    help="Longest side of a triangle, in CRS units. (--max-edge trims the TIN before.)",
)
@click.option(
    "--max-vertices",
    metavar="N",
    type=int,
    default=10_000_000,
    show_default=True,
    help="So many vertices are allowed.",
)
@reading_options
@triangulating_options
@writing_options
@console_options
def refine(
    file: Path,
    outputs: tuple[Path, ...],
    min_angle: float,
    max_area: float | None,
    max_side: float | None,
    max_vertices: int,
    reading: Reading,
    how: Triangulating,
    writing: Writing,
    console: Console,
) -> None:
    """Add points to the TIN in FILE, or that of the points in it, until its triangles are good.

    Rim, boundary, holes and breaklines stay, and the new points lie on the surface.

    \b
    Example:
      tinsmith refine sample_data/site_survey.csv --codes --max-area 20 -o site.msh -o site.vtu
    """  # noqa: D301 - click reads the control character
    from ...errors import OptionError, TinsmithError
    from ...tin import quality
    from ...tin import refine as refine_tin
    from ..files import describe_written, list_inputs, plan_outputs, read_tin, write_outputs
    from ..output.line_summaries import mesh_counts

    started = perf_counter()
    planned = plan_outputs(
        outputs, writing, inputs=list_inputs(file, how), console=console, kinds=("TIN",)
    )
    tin, _ = read_tin(file, reading, how, console)
    _require_lengths(tin, file)
    triangles = counted(len(tin.triangles), "triangle")
    with console.steps() as steps, steps.step(f"Refining {triangles}"):
        try:
            refined = refine_tin(
                tin,
                min_angle=min_angle,
                max_area=max_area,
                max_edge=max_side,
                max_vertices=max_vertices,
                threads=how.threads,
            )
        except OptionError as error:  # its max_edge is not --max-edge, which trims
            raise refuse_option(error, max_edge="max_side") from error
        except TinsmithError as error:
            raise Failure(name_flags(str(error), max_edge="--max-side")) from error
    write_outputs(refined, planned, console)
    shapes = quality(refined)
    written = [str(one.path) for one in planned]
    console.summarise(
        [
            ("Read", mesh_counts(tin)),
            ("Mesh", mesh_counts(refined)),
            *_summarise_angles(quality(tin), shapes, refined.report.unmended),
            ("Written", describe_written(planned)),
            ("Time", f"{perf_counter() - started:.2f} s"),
        ]
    )
    if console.as_json:
        console.emit(format_json(_describe_refinement(file, refined, shapes, written)))


def _require_lengths(tin: TIN, file: Path) -> None:
    from ...io.reprojection.transformation import is_geographic

    if is_geographic(tin.crs):
        raise Failure(
            f"'{file}' is in degrees, where angles and areas are not those on the ground: build "
            "the TIN in a projected CRS, such as EPSG:32616."
        )


def _summarise_angles(given: Quality, refined: Quality, unmended: Unmended) -> list[Row]:
    before, after = given.min_angle, refined.min_angle
    rows = [("Angles", f"from {after.min():.1f}° on, before from {before.min():.1f}°")]
    return rows + [("", sentence) for sentence in unmended.sentences()]


def _describe_refinement(
    file: Path, refined: TIN, shapes: Quality, outputs: list[str]
) -> dict[str, Any]:
    from ..output.summaries import describe_tin

    return {
        "input": str(file),
        "tin": describe_tin(refined) | {"quality": shapes.summary()},
        "report": refined.report.to_dict(),
        "outputs": outputs,
    }
