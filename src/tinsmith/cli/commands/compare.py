"""``tinsmith compare``: the paper's algorithms beside the exact kernel."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from ...base.sentences import counted
from ..command import command
from ..options import console_options, reading_options
from ..output.failures import Failure
from ..parameters import input_file, number_option, picture_option
from ..paths import make_title, name_file

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from ...base.arrays import AnyArray
    from ...tin import Comparison, Outcome
    from ..options import Reading
    from ..output.console import Console, Row

__all__ = ["compare"]

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
@reading_options
@console_options
def compare(
    file: Path, output: Path | None, sample: int | None, reading: Reading, console: Console
) -> None:
    """Triangulate the points in FILE by the paper's algorithms and by the exact kernel.

    Shown for each are triangles, time, memory, searches, angles, and faults. Without --sample at
    most 2,500 points are allowed, because the paper's algorithms take quadratic time.

    \b
    Example:
      tinsmith compare sample_data/site_survey.csv --sample 200 -o comparison.png
    """  # noqa: D301 - click reads the control character
    from ...tin import TIN
    from ...tin import compare as compare_points
    from ..files import list_inputs, note_found, read_input, require_picture

    if output is not None:
        require_picture(output, place="--output", inputs=list_inputs(file))
    found = read_input(file, reading, console)
    if isinstance(found, TIN):
        raise Failure(f"'{file}' holds a TIN: 'tinsmith compare' needs points.")
    note_found(found, console)
    points = _sample_points(found.points, sample)
    with console.steps() as steps, steps.step(f"Comparing on {counted(len(points), 'point')}"):
        result = compare_points(points, limit=len(points))
    record = {"input": str(file)} | result.to_dict()
    if output is not None:
        _draw_comparison(result, file, output, console)
        record["output"] = str(output)
    console.answer(_summarise_comparison(file, result, output), record)


def _sample_points(points: AnyArray, count: int | None) -> AnyArray:
    """Return some of the points, in their order; all of them if no number is given."""
    import numpy as np

    from ...tin.paper.comparison import MOST_POINTS

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


def _draw_comparison(result: Comparison, file: Path, output: Path, console: Console) -> None:
    """Write the picture, whole or not at all."""
    from ...terrain import comparison_picture
    from ..files import write_figure

    title = f"{make_title(file) or 'points'}: {len(result.points):,} points"
    with console.steps() as steps, steps.step("Drawing"):
        figure = comparison_picture(result, title=title)
        write_figure(figure, output, dpi=120)


# ---------------------------------------------------------------- for people


def _summarise_comparison(file: Path, result: Comparison, output: Path | None) -> list[Row]:
    from ..output.summaries import describe_file_size

    hull = f"{len(result.points):,} points, {len(result.hull):,} of them on the hull"
    make = "makes" if result.expected == 1 else "make"
    due = f"2n - 2 - h = {counted(result.expected, 'triangle')} {make} a triangulation"
    rows = [("File", name_file(file)), ("Points", f"{hull}: {due}"), ("", "")]
    rows += [_make_row(label, result, text) for label, text in _ROWS]
    if output is not None:
        rows.append(("Written", f"{output} ({describe_file_size(output)})"))
    return rows


def _make_row(label: str, result: Comparison, text: Callable[[Outcome, Comparison], str]) -> Row:
    cells = (text(outcome, result) for outcome in result.outcomes)
    return label, "".join(f"{cell:>{_COLUMN}}" for cell in cells)


def _count_triangles_made(outcome: Outcome, _: Comparison) -> str:
    return f"{len(outcome.triangles):,}" + (" (stopped)" if outcome.is_stopped else "")


def _count_without_removal(outcome: Outcome, _: Comparison) -> str:
    count = outcome.candidates_without_removal
    return "-" if count is None else f"{count / len(outcome.triangles):,.1f}"


def _format_share(part: float, whole: float) -> str:
    return f"{100 * part / whole:.2f} %"


_ROWS: list[tuple[str, Callable[[Outcome, Comparison], str]]] = [
    ("", lambda one, _: one.name),
    ("Triangles", _count_triangles_made),
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
