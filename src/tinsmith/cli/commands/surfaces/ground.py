"""``tinsmith ground``: the points on the ground, told from all others."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ....base.sentences import counted
from ...command import command
from ...job import Job
from ...output import Facts
from ...parameters import input_files, number_option, output_files
from ...paths import describe_inputs, name_file, name_files
from ...product_options import product_options
from ...tiling import choose_tiles, describe_points, showing_tiles, tiled_options

if TYPE_CHECKING:
    from ....tiled.tiled_points import TiledPoints
    from ...outputs import Output

_PARAMETERS = (
    "building cell terrain_slope iteration_angle iteration_distance edge_length tolerance "
    "horizontal_tolerance noise_depth"
)


@command
@input_files("points")
@output_files
@product_options(
    "terrain.ground_filter.classification.ground",
    _PARAMETERS,
    tolerance="Largest height of ground points above the surface, metres.",
    horizontal_tolerance="Horizontal tolerance, metres; this times the slope is added to "
    "--tolerance.",
    noise_depth="Points deeper than this below all around them are noise, metres.",
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
@number_option(
    "--reach",
    "METRES",
    "How far around a tile points are looked at; default three times --building.",
)
@tiled_options()
def ground(points: tuple[Path, ...], job: Job, **options: Any) -> None:
    """Classify the ground among POINTS by progressive densification of a TIN.

    LAS and LAZ files get all points with their classes (2 ground, 1 others, 7 low noise) and
    attributes, other files of points those of the ground, and files of TINs their TIN. In tiles
    every lidar file is written again to the folder of -o, with a virtual point cloud of all.

    Example:
      tinsmith ground cloud.laz -o classified.laz -o ground.gpkg
      tinsmith ground lidar/ -o classified/ --tiles 4
    """
    from ....terrain import ground as find_ground
    from ...output import describe_survey, summarise_reading

    given = {name: options[name] for name in _PARAMETERS.split()}
    given["returns"] = "all" if options["any_return"] else "last"
    lines = next((flag for flag, files in job.building.line_files.items() if files), "")
    whole = "--as-points" if options["as_points"] else lines
    cloud = choose_tiles(job, *points, whole=whole, joins=True)
    if cloud is not None:
        more = {"reach": options["reach"], "ground_only": options["ground_only"]}
        _label_tiles(cloud, points, job, given | more)
        return
    if options["reach"] is not None:
        raise click.UsageError("--reach is for tiles: here all points are looked at.")
    is_points = options["as_points"]
    planned = job.plan(
        job.list_inputs(*points), "TIN", "Survey", choose=lambda one: _choose(one, is_points)
    )
    job = job.with_fallback(attributes="all")
    survey = job.add_lines(job.read_survey(*points, need=": the ground is found among points."))
    job.note_found(survey)
    with job.step(f"Finding the ground among {counted(len(survey), 'point')}") as progress:
        made = find_ground(survey, **given, progress=progress)
    planned.write("classes", lambda: made.survey if options["ground_only"] else made.classified)
    planned.write("Survey", lambda: made.survey)
    planned.write("TIN", lambda: job.build_tin(made.survey))
    total = len(made.given)
    facts = Facts(input=describe_inputs(points), classes=made.counts)
    facts.record(survey=lambda: describe_survey(made.given), parameters=dict(made.parameters))
    facts.add("Points", f"{total:,} from {name_files(points)}")
    facts.extend(summarise_reading(made.given))
    for what, count in made.counts.items():
        facts.add(what.capitalize(), f"{counted(count, 'point')}, {count / total:.1%}")
    facts.note(made.notes)
    job.finish(planned, facts)


def _label_tiles(
    cloud: TiledPoints, points: tuple[Path, ...], job: Job, given: dict[str, Any]
) -> None:
    """Write all files again with their classes, in a folder."""
    from ....tiled.computing import labelling

    if len(job.outputs) != 1:
        raise click.UsageError("Tiles are written to a folder: name one by -o.")
    (folder,) = job.outputs
    if folder.suffix and not folder.is_dir():
        raise click.UsageError(
            f"Tiles are written to a folder, and '{folder}' has a suffix of files."
        )
    with showing_tiles(job) as how, labelling(cloud, folder, how, **given) as made:
        written = made.move(folder)
    names = {2: "ground", 7: "low noise"}
    counts = {"ground": 0, "others": 0, "low noise": 0}
    for number, count in made.counts.items():
        counts[names.get(number, "others")] += count
    facts = Facts(input=describe_inputs(points), classes=counts)
    facts.add("Points", describe_points(cloud))
    total = sum(counts.values())
    for what, count in counts.items():
        facts.add(what.capitalize(), f"{counted(count, 'point')}, {count / total:.1%}")
    facts.add("Files", f"{len(made.files)} in {name_file(folder)}", files=len(made.files))
    facts.note(made.notes)
    job.tell([written], facts)


def _choose(output: Output, is_points: bool) -> str:
    """Choose what an output holds: all points, those of the ground, or their TIN."""
    survey, tin = (output.formats.get(kind) for kind in ("Survey", "TIN"))
    if survey is not None and survey.holds_classes:
        return "classes"
    holds_tin = tin is not None and "triangles" not in tin.loses
    return "TIN" if holds_tin and not (is_points and survey is not None) else "Survey"
