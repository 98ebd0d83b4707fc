"""``tinsmith check``: prove that a TIN is sound."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from ...base.sentences import counted
from ..command import command
from ..options import console_options, reading_options, triangulating_options
from ..output.failures import Failure
from ..parameters import input_file
from ..paths import name_file

if TYPE_CHECKING:
    from pathlib import Path

    from ...tin.checking.checker import CheckResult
    from ..options import Reading, Triangulating
    from ..output.console import Console, Row

__all__ = ["check"]

_PROVED = {
    1: "indices, neighbours and edge flags agree",
    2: "sound, and its triangles tile the hull with no gap or overlap",
    3: "exactly Delaunay, and its triangles tile the hull with no gap or overlap",
}


@command
@input_file("file")
@click.option(
    "--level",
    type=click.IntRange(1, 3),
    default=3,
    show_default=True,
    help="1: indices and neighbours. 2: also orientation, hull, areas. "
    "3: also every edge exactly Delaunay, every point present.",
)
@reading_options
@triangulating_options
@console_options
def check(file: Path, level: int, reading: Reading, how: Triangulating, console: Console) -> None:
    """Check the TIN in FILE, or built from the points in it, in exact arithmetic.

    The exit code is 1 if a problem is found. A surface of another program may be sound and not
    Delaunay, or have a concave boundary: that is told apart.

    \b
    Example:
      tinsmith check sample_data/site_survey.csv
    """  # noqa: D301 - click reads the control character
    from ...tin.checking.checker import check as check_tin
    from ..files import read_tin

    tin, survey = read_tin(file, reading, how, console)
    triangles = counted(len(tin.triangles), "triangle")
    with console.steps() as steps, steps.step(f"Checking {triangles}"):
        result = check_tin(tin, level=level, points=survey)
    console.answer(_summarise_check(file, result), {"input": str(file)} | result.to_dict())
    if not result.ok:
        raise Failure(f"The TIN of '{file}' is {_describe_verdict(result)}.")


def _summarise_check(file: Path, result: CheckResult) -> list[Row]:
    counts = ", ".join(
        counted(result.counts[name], one, name)
        for name, one in (("vertices", "vertex"), ("triangles", "triangle"), ("edges", "edge"))
        if name in result.counts
    )
    verdict = _PROVED[result.level] if result.ok else _describe_verdict(result)
    label = "Reason" if result.is_surface else "Problem"
    return [
        ("File", name_file(file)),
        ("Counted", counts),
        (f"Level {result.level}", verdict),
        *((label, problem.sentence) for problem in result.problems),
        *(("Note", note.sentence) for note in result.notes),
    ]


def _describe_verdict(result: CheckResult) -> str:
    """Tell what a TIN with problems is: a surface at least, or not sound."""
    if result.is_surface:
        lacking = "Delaunay" if result.level > 2 else "one of a convex hull"
        return f"a sound surface, not {lacking}"
    kinds = ", ".join(dict.fromkeys(problem.kind for problem in result.problems))
    return f"not sound: {kinds}"
