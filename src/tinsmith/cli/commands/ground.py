"""``tinsmith ground``: the points on the ground, told from all others."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from ...base.sentences import counted
from ..command import command
from ..job import surface_options
from ..parameters import input_files, number_option, output_files

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from ...base.policies import GroundReturns
    from ...terrain import GroundPoints
    from ...tin import Survey
    from ..files import Output
    from ..job import Job, Products
    from ..output.facts import Facts

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
def ground(points: tuple[Path, ...], job: Job, **options: Any) -> None:
    """Classify the ground among POINTS by progressive densification of a TIN.

    LAS and LAZ files get all points with their classes (2 ground, 1 others, 7 low noise) and
    attributes, other files of points those of the ground, and files of TINs their TIN.

    \b
    Example:
      tinsmith ground cloud.laz -o classified.laz -o ground.gpkg
    """  # noqa: D301 - click reads the control character
    from ...terrain import ground as find_ground
    from ..files import add_lines, note_found, read_inputs

    planned = _plan(job, points, options["as_points"])
    reading = job.reading.with_fallback(attributes="all")
    found = read_inputs(points, reading, job.console)
    survey = add_lines(_require_survey(found, points[0]), job.how, job.console)
    note_found(survey, job.console)
    with job.step(f"Finding the ground among {counted(len(survey), 'point')}") as progress:
        given = {name: options[name] for name in _PARAMETERS}
        returns: GroundReturns = "all" if options["any_return"] else "last"
        made = find_ground(survey, **given, returns=returns, progress=progress)
    _write(made, planned, job, is_ground_only=options["ground_only"])
    job.finish(planned, _list_facts(points, made))


def _require_survey(found: Any, path: Path) -> Survey:
    from ...tin import TIN
    from ..output.failures import Failure

    if isinstance(found, TIN):
        raise Failure(f"'{path}' holds a TIN: the ground is found among points.")
    return found  # type: ignore[no-any-return]


def _plan(job: Job, points: Sequence[Path], is_as_points: bool) -> Products:
    """Choose what each output holds: all points, those of the ground, or their TIN."""
    from ..files import plan_outputs
    from ..job import Products

    planned = plan_outputs(
        job.outputs,
        job.writing,
        inputs=job.list_inputs(*points),
        console=job.console,
    )
    groups: dict[str, list[Output]] = {}
    for one in planned:
        groups.setdefault(_choose_content(one, is_as_points), []).append(one)
    return Products(console=job.console, outputs=groups)


def _choose_content(output: Output, is_as_points: bool) -> str:
    survey, tin = (output.formats.get(kind) for kind in ("Survey", "TIN"))
    if survey is not None and survey.holds_classes:
        return "classes"
    holds_tin = tin is not None and "triangles" not in tin.loses
    return "TIN" if holds_tin and not (is_as_points and survey is not None) else "Survey"


def _write(made: GroundPoints, planned: Products, job: Job, *, is_ground_only: bool) -> None:
    from ..files import build_tin

    planned.write("classes", lambda: made.survey if is_ground_only else made.classified)
    planned.write("Survey", lambda: made.survey)
    planned.write("TIN", lambda: build_tin(made.survey, job.how, job.console))


def _list_facts(points: Sequence[Path], made: GroundPoints) -> Facts:
    from ..output.facts import Facts
    from ..output.summaries import describe_survey, summarise_reading
    from ..paths import describe_inputs, name_files

    total = len(made.given)
    facts = Facts()
    facts.record(input=describe_inputs(points), classes=made.counts)
    facts.record(survey=lambda: describe_survey(made.given), parameters=dict(made.parameters))
    facts.add("Points", f"{total:,} from {name_files(points)}")
    facts.extend(summarise_reading(made.given))
    for what, count in made.counts.items():
        facts.add(what.capitalize(), f"{counted(count, 'point')}, {count / total:.1%}")
    facts.note(made.notes)
    return facts
