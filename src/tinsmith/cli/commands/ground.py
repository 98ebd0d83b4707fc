"""``tinsmith ground``: the points on the ground, told from all others."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from ...base.sentences import counted
from ..command import command
from ..parameters import input_files, number_option, output_files
from ..request import surface_options

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from ...base.policies import GroundReturns
    from ...terrain import GroundPoints
    from ...tin import Survey
    from ..files import Output
    from ..output.console import Row
    from ..products import Products
    from ..request import Request

__all__ = ["ground"]

_PARAMETERS = (
    "building",
    "cell",
    "terrain_slope",
    "iteration_angle",
    "iteration_distance",
    "edge_length",
    "tolerance",
    "horizontal_tolerance",
    "noise_depth",
)


@command
@input_files("points")
@output_files
@number_option("--building", "METRES", "Width of the largest building.", default=40.0)
@number_option("--cell", "METRES", "Side of the cells whose lowest points are seeds.", default=1.0)
@number_option(
    "--terrain-slope",
    "RATIO",
    "Slope limit of the openings that choose the seeds.",
    default=0.12,
)
@number_option(
    "--iteration-angle",
    "DEGREES",
    "Largest angle of an added point at the nearest corner of its triangle.",
    default=20.0,
)
@number_option(
    "--iteration-distance",
    "METRES",
    "Largest distance of an added point from the plane of its triangle.",
    default=1.4,
)
@number_option(
    "--edge-length",
    "METRES",
    "In triangles with shorter edges the angle is reduced in proportion.",
    default=5.0,
)
@number_option(
    "--tolerance", "METRES", "Largest height of ground points above the surface.", default=0.3
)
@number_option(
    "--horizontal-tolerance",
    "METRES",
    "Horizontal tolerance; this times the slope is added to --tolerance.",
    default=1.0,
)
@number_option(
    "--noise-depth",
    "METRES",
    "Points deeper than this below all around them are noise.",
    default=1.0,
)
@click.option(
    "--any-return",
    is_flag=True,
    help="Allow ground points of any return, not only the last.",
)
@click.option("--ground-only", is_flag=True, help="Write only the ground to LAS and LAZ files.")
@click.option(
    "--as-points",
    is_flag=True,
    help="Write ground points instead of their TIN.",
)
@surface_options()
def ground(points: tuple[Path, ...], request: Request, **options: Any) -> None:
    """Classify the ground among POINTS by progressive densification of a TIN.

    LAS and LAZ files get all points with their classes (2 ground, 1 others, 7 low noise) and
    attributes, other files of points those of the ground, and files of TINs their TIN.

    \b
    Example:
      tinsmith ground cloud.laz -o classified.laz -o ground.gpkg
    """  # noqa: D301 - click reads the control character
    from ...terrain import ground as find_ground
    from ..files import add_lines, note_found, read_inputs

    planned = _plan(request, points, options["as_points"])
    reading = request.reading.with_fallback(attributes="all")
    found = read_inputs(points, reading, request.console)
    survey = add_lines(_require_survey(found, points[0]), request.how, request.console)
    note_found(survey, request.console)
    with request.step(f"Finding the ground among {counted(len(survey), 'point')}") as progress:
        given = {name: options[name] for name in _PARAMETERS}
        returns: GroundReturns = "all" if options["any_return"] else "last"
        made = find_ground(survey, **given, returns=returns, progress=progress)
    _write(made, planned, request, is_ground_only=options["ground_only"])
    rows = _summarise(points, made)
    request.finish(planned, rows, lambda: _describe(points, made))


def _require_survey(found: Any, path: Path) -> Survey:
    from ...tin import TIN
    from ..output.failures import Failure

    if isinstance(found, TIN):
        raise Failure(f"'{path}' holds a TIN: the ground is found among points.")
    return found  # type: ignore[no-any-return]


def _plan(request: Request, points: Sequence[Path], is_as_points: bool) -> Products:
    """Choose what each output holds: all points, those of the ground, or their TIN."""
    from ..files import plan_outputs
    from ..products import Products

    planned = plan_outputs(
        request.outputs,
        request.writing,
        inputs=request.list_inputs(*points),
        console=request.console,
    )
    groups: dict[str, list[Output]] = {}
    for one in planned:
        groups.setdefault(_choose_content(one, is_as_points), []).append(one)
    return Products(console=request.console, outputs=groups)


def _choose_content(output: Output, is_as_points: bool) -> str:
    survey, tin = (output.formats.get(kind) for kind in ("Survey", "TIN"))
    if survey is not None and survey.name == "las":
        return "classes"
    holds_tin = tin is not None and "triangles" not in tin.loses
    return "TIN" if holds_tin and not (is_as_points and survey is not None) else "Survey"


def _write(
    made: GroundPoints, planned: Products, request: Request, *, is_ground_only: bool
) -> None:
    from ..files import build_tin

    if planned.holds("classes"):
        planned.write("classes", made.survey if is_ground_only else made.classified)
    if planned.holds("Survey"):
        planned.write("Survey", made.survey)
    if planned.holds("TIN"):
        planned.write("TIN", build_tin(made.survey, request.how, request.console))


def _summarise(points: Sequence[Path], made: GroundPoints) -> list[Row]:
    from ..output.summaries import summarise_reading
    from ..paths import name_files

    total = len(made.given)
    rows = [
        ("Points", f"{total:,} from {name_files(points)}"),
        *summarise_reading(made.given),
    ]
    for what, count in made.counts.items():
        rows.append((what.capitalize(), f"{counted(count, 'point')}, {count / total:.1%}"))
    return rows + [("Note", note) for note in made.notes]


def _describe(points: Sequence[Path], made: GroundPoints) -> dict[str, Any]:
    from ..output.summaries import describe_survey
    from ..paths import describe_inputs

    return {
        "input": describe_inputs(points),
        "survey": describe_survey(made.given),
        "classes": made.counts,
        "parameters": dict(made.parameters),
        "notes": list(made.notes),
    }
