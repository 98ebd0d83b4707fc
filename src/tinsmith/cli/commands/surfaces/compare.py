"""``tinsmith compare``: the paper's algorithms beside the exact kernel."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from ....base.sentences import counted
from ...command import command
from ...job import Job, surface_options
from ...options import CONSOLE, READING
from ...output import Facts, Failure
from ...parameters import input_file, number_option, picture_option
from ...paths import make_title, name_file

if TYPE_CHECKING:
    from collections.abc import Callable

    from ....base.arrays import AnyArray
    from ....tin import Comparison, Outcome

_COLUMN = 16


@command
@input_file("file")
@picture_option("Picture to write (.png): the triangles side by side, faults marked.")
@number_option(
    "--sample",
    "N",
    "Use N of the points, chosen at random but the same every time.",
    type=click.IntRange(min=3),
)
@surface_options(READING, CONSOLE)
def compare(file: Path, output: Path | None, sample: int | None, job: Job) -> None:
    """Triangulate the points in FILE by the paper's algorithms and by the exact kernel.

    Shown for each are triangles, time, memory, searches, angles, and faults. Without --sample at
    most 2,500 points are allowed, because the paper's algorithms take quadratic time.

    Example:
      tinsmith compare sample_data/site_survey.csv --sample 200 -o comparison.png
    """
    from ....terrain import comparison_picture
    from ....tin import compare as compare_points
    from ...outputs import describe_file, require_picture, write_figure

    if output is not None:
        require_picture(output, "--output", job.list_inputs(file))
    found = job.read_survey(file, need=": 'tinsmith compare' needs points.")
    job.note_found(found)
    points = _sample_points(found.points, sample)
    with job.step(f"Comparing on {counted(len(points), 'point')}"):
        result = compare_points(points, limit=len(points))
    if output is not None:
        title = f"{make_title(file) or 'points'}: {len(result.points):,} points"
        with job.step("Drawing"):
            write_figure(comparison_picture(result, title=title), output, dpi=120)
    facts = Facts(file, **result.to_dict())
    hull = f"{len(result.points):,} points, {len(result.hull):,} of them on the hull"
    make = "makes" if result.expected == 1 else "make"
    due = f"2n - 2 - h = {counted(result.expected, 'triangle')} {make} a triangulation"
    facts.extend([("File", name_file(file)), ("Points", f"{hull}: {due}"), ("", "")])
    for label, text in _ROWS:
        cells = (text(outcome, result) for outcome in result.outcomes)
        facts.add(label, "".join(f"{cell:>{_COLUMN}}" for cell in cells))
    if output is not None:
        facts.add("Written", describe_file(output), output=str(output))
    job.console.answer(facts)


def _sample_points(points: AnyArray, count: int | None) -> AnyArray:
    """Return some of the points, in their order; all of them if no number is given."""
    import numpy as np

    from ....tin.paper import MOST_POINTS

    if count is None:
        if len(points) > MOST_POINTS:
            raise Failure(
                f"{len(points):,} points would take too long, because the paper's algorithms "
                f"take quadratic time: use --sample {MOST_POINTS}."
            )
        return points
    if count > len(points):
        raise Failure(f"--sample {count:,} is more than the {len(points):,} points of the file.")
    rows = np.random.default_rng(0).choice(len(points), count, replace=False)
    return points[np.sort(rows)]


# ---------------------------------------------------------------- for people


def _count_without_removal(outcome: Outcome, _: Comparison) -> str:
    count = outcome.candidates_without_removal
    return "-" if count is None else f"{count / len(outcome.triangles):,.1f}"


def _format_share(part: float, whole: float) -> str:
    return f"{100 * part / whole:.2f} %"


_ROWS: list[tuple[str, Callable[[Outcome, Comparison], str]]] = [
    ("", lambda one, _: one.name),
    (
        "Triangles",
        lambda one, _: f"{len(one.triangles):,}" + (" (stopped)" if one.is_stopped else ""),
    ),
    ("Open edges", lambda one, _: f"{len(one.unextended):,}"),
    ("In circle", lambda one, _: _format_share(one.violating.sum(), len(one.triangles))),
    ("Overlapping", lambda one, _: _format_share(one.overlapping.sum(), len(one.triangles))),
    ("  area", lambda one, all_: _format_share(one.overlap, all_.area)),
    ("Gaps, area", lambda one, all_: _format_share(one.gap, all_.area)),
    ("Least angle", lambda one, _: f"{one.angles.min():.2f}°"),
    ("  below 20°", lambda one, _: _format_share(one.angle_counts[:2].sum(), len(one.triangles))),
    ("Searched", lambda one, _: f"{one.candidates / len(one.triangles):,.1f}"),
    ("  no removal", _count_without_removal),
    ("Tests", lambda one, _: f"{one.tests:,}"),
    ("Time", lambda one, _: f"{1000 * one.seconds:,.2f} ms"),
    ("Memory", lambda one, _: f"{one.memory / 1000:,.0f} kB"),
]
"""Searched: points looked at for each triangle; In circle: triangles with a point in theirs."""
