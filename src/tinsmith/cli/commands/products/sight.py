"""``tinsmith sight``: what is seen from a place on a TIN."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ...command import file_command
from ...job import Job, name_features, surface_options
from ...output import describe_features, name_unit
from ...parameters import file_option, number_option, position_option

if TYPE_CHECKING:
    from collections.abc import Callable

    from ....terrain import Features
    from ....tin import TIN
    from ...output import Row

_SHOWN = 12


@file_command
@position_option(
    "--from", "eye", "Position of the eye; several go with as many targets.", multiple=True
)
@file_option("--eye", "Vector file of points, instead of coordinates.", name="eyes")
@position_option(
    "--to",
    "targets",
    "Position of a target, for a line of sight; without one the viewshed. May be given several "
    "times.",
    multiple=True,
)
@file_option("--targets", "Vector file of points, instead of coordinates.", name="points")
@number_option("--eye-height", "HEIGHT", "Height of the eye above the ground.", default=0.0)
@number_option("--target-height", "HEIGHT", "Height of targets above the ground.", default=0.0)
@number_option("--radius", "LENGTH", "Radius of the viewshed; default unlimited.")
@click.option("--curvature", is_flag=True, help="Take earth curvature and refraction into account.")
@number_option(
    "--sight-refraction",
    "COEFFICIENT",
    "Coefficient of refraction, with --curvature; default 0.13.",
)
@click.option(
    "--whole-triangles",
    is_flag=True,
    help="Classify whole triangles by their corners, without dividing them.",
)
@surface_options()
def sight(file: Path, job: Job, **asked: Any) -> None:
    """Find what is visible from a point on the TIN in FILE, or built from the points in it.

    Without targets the result is the viewshed: the visible and the hidden part, as polygons that
    divide triangles. Vector files get the features, tables (.csv, .json) their columns. Ground
    that only touches a line of sight does not block it. Points of files are reprojected; several
    eyes need as many targets.

    Example:
      tinsmith sight site.ply --from 752700 4024300 --eye-height 1.7 -o viewshed.gpkg
      tinsmith sight site.ply --from 752700 4024300 --to 752800 4024300 -o line.csv
    """
    from ....base.results import tabulate_columns

    _require_fitting(asked)
    more = name_features(asked["eyes"], "the file of --eye")
    more += name_features(asked["points"], "the file of --targets")
    planned = job.plan(job.list_inputs(file, more=more), "Features", "Table")
    tin = job.read_tin(file)
    with job.step("Looking") as progress:
        found = _look(tin, asked, job, progress)
    planned.write("Features", found)
    planned.write("Table", tabulate_columns(found))
    facts = describe_features(file, tin, found)
    describe = _describe_line if "visible" in found.columns else _name_class
    facts.extend(describe(found, row) for row in range(min(len(found), _SHOWN)))
    job.finish(planned, facts)


def _require_fitting(asked: dict[str, Any]) -> None:
    if bool(asked["eye"]) == (asked["eyes"] is not None):
        raise click.UsageError("One eye is needed: --from X Y, or --eye FILE.")
    has_targets = asked["points"] is not None
    if asked["targets"] and has_targets:
        raise click.UsageError("Targets are given by --to X Y, or by --targets FILE: not by both.")
    if (asked["targets"] or has_targets) and asked["radius"] is not None:
        raise click.UsageError("--radius is for a viewshed, without --to.")
    if (asked["targets"] or has_targets) and asked["whole_triangles"]:
        raise click.UsageError("--whole-triangles is for a viewshed, without --to.")
    coefficient = asked["sight_refraction"]
    if coefficient is not None and not asked["curvature"]:
        raise click.UsageError("--sight-refraction is for --curvature.")
    if coefficient is not None and not -1.0 <= coefficient <= 1.0:
        raise click.UsageError("--sight-refraction is a coefficient from -1 to 1.")


def _look(tin: TIN, asked: dict[str, Any], job: Job, progress: Callable[[float], None]) -> Features:
    """Return lines of sight, or the viewshed where no targets are given."""
    from .... import terrain

    names = ("eye_height", "target_height", "curvature")
    how = {name: asked[name] for name in names} | {"refraction": asked["sight_refraction"]}
    eyes: Any = [list(one) for one in asked["eye"]]
    eye = eyes[0] if len(eyes) == 1 else eyes
    if asked["eyes"] is not None:
        eye = job.read_features(asked["eyes"], tin, "points")
    targets: Any = [list(one) for one in asked["targets"]] or None
    if asked["points"] is not None:
        targets = job.read_features(asked["points"], tin, "points")
    if targets is not None:
        return terrain.line_of_sight(tin, eye, targets, **how)
    of_viewshed = {name: asked[name] for name in ("radius", "whole_triangles")}
    return terrain.viewshed(tin, eye, progress=progress, **of_viewshed, **how)


def _describe_line(found: Features, row: int) -> Row:
    columns, unit = found.columns, name_unit(found.units, "distance")
    text = f"visible at {columns['distance'][row]:,.2f} {unit}".rstrip()
    if not columns["visible"][row]:
        text = (
            f"blocked after {columns['block_distance'][row]:,.2f} of "
            f"{columns['distance'][row]:,.2f} {unit}, at {columns['block_x'][row]:.2f} "
            f"{columns['block_y'][row]:.2f}"
        )
    return f"Target {row}", text


def _name_class(found: Features, row: int) -> Row:
    columns, unit = found.columns, name_unit(found.units, "area")
    name = str(columns["class"][row]).capitalize()
    return name, f"{columns['area'][row]:,.1f} {unit}, {columns['share'][row]:.1f} %"
