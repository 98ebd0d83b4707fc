"""``tinsmith check``: prove that a TIN is sound."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from ....base.sentences import counted
from ...command import command
from ...job import Job, surface_options
from ...options import CONSOLE, READING, TRIANGULATING
from ...output import Facts, Failure
from ...parameters import input_file
from ...paths import name_file

if TYPE_CHECKING:
    from ....tin.checking import CheckResult

_PROVED = {
    1: "indices, neighbours and edge flags agree",
    2: "sound, and its triangles tile the hull with no gap or overlap",
    3: "exactly Delaunay, and its triangles tile the hull with no gap or overlap",
}
_NOUNS = {"vertices": "vertex", "triangles": "triangle", "edges": "edge"}


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
@surface_options(READING, TRIANGULATING, CONSOLE)
def check(file: Path, level: int, job: Job) -> None:
    """Check the TIN in FILE, or built from the points in it, in exact arithmetic.

    The exit code is 1 if a problem is found. A surface of another program may be sound and not
    Delaunay, or have a concave boundary: that is told apart.

    Example:
      tinsmith check sample_data/site_survey.csv
    """
    from ....tin.checking import check as check_tin

    tin, survey = job.read_surface(file)
    with job.step(f"Checking {counted(len(tin.triangles), 'triangle')}"):
        result = check_tin(tin, level=level, points=survey)
    facts = Facts(file, **result.to_dict())
    facts.add("File", name_file(file))
    counts = (
        counted(result.counts[name], one, name)
        for name, one in _NOUNS.items()
        if name in result.counts
    )
    facts.add("Counted", ", ".join(counts))
    verdict = "" if result.ok else _describe_verdict(result)
    facts.add(f"Level {result.level}", verdict or _PROVED[result.level])
    label = "Reason" if result.is_surface else "Problem"
    facts.extend((label, problem.sentence) for problem in result.problems)
    facts.extend(("Note", note.sentence) for note in result.notes)
    job.console.answer(facts)
    if verdict:
        raise Failure(f"The TIN of '{file}' is {verdict}.")


def _describe_verdict(result: CheckResult) -> str:
    """Tell what a TIN with problems is: a surface at least, or not sound."""
    if result.is_surface:
        lacking = "Delaunay" if result.level > 2 else "one of a convex hull"
        return f"a sound surface, not {lacking}"
    kinds = ", ".join(dict.fromkeys(problem.kind for problem in result.problems))
    return f"not sound: {kinds}"
