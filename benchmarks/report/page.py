"""What was measured as one page of Markdown, one JSON file and one plot."""

from __future__ import annotations

import json
import math
import textwrap
from collections.abc import Callable, Iterable, Sequence
from dataclasses import asdict
from pathlib import Path
from statistics import median
from typing import Any

from ..measure import OURS, Outcome, Result, is_installed
from ..peers.answers import AS_MANY, EQUAL
from ..peers.line_tools import ALL_LINE_TOOLS
from ..peers.triangulators import (
    CGAL,
    DELAUNAY32,
    DELAUNAY32_ALL_CORES,
    KERNEL,
    KERNEL_ALL_CORES,
)
from ..sections import answers, kernel
from .goals import judge_goals
from .tables import format_table

__all__ = ["format_page", "write_report"]

NAME = "benchmarks"
PLOTS = {"kernel": ".png", "lines": "-lines.png"}
LEAST_FOR_MEMORY = 50_000
"""Below this many points memory is that of the libraries, not of the points."""

INTRODUCTION = """\
# {title}

tinsmith compared with libraries for the same tasks. The tools run alternately (A B C A B C) in one
command, on one core each unless stated otherwise; seconds are medians. **Every result that is timed
is verified**: that of tinsmith by `ts.check`; that of an exact library must be the same
triangulation or differ only in how ties between cocircular points are broken; points and triangles
that other libraries lose are listed below the table.
"""
HOW_TO_REPEAT = """\
## How to repeat this

`make bench` runs everything at 100,000 points in some minutes; this page was made by

```sh
{command}
```

CGAL, Delaunay32, CDT and detria are C++ libraries: with `g++` and CGAL's headers (Debian:
`libcgal-dev`), and the sources of the others (the command says where), small programs are compiled.
Tools that are not installed are skipped and named. Data sets are made by seeded generators in
`benchmarks/`.
"""
KERNEL_NOTES = """\
Seconds, and in brackets the ratio to the whole call `ts.triangulate(points)`: above 1 tinsmith is
faster. That call checks the input, merges duplicates and makes all arrays of the TIN; *kernel* is
the compiled part alone, triangles and neighbours. Of the other libraries only the triangulation is
timed, without the conversion of the points to their types; CGAL (`insert(begin, end)`, exact
predicates) and Delaunay32, both compiled with `-O3 -march=native`, run without Python. Delaunay32
is given integers, the coordinates rounded to millimetres, so that its points are others. Points
are in the order of the data set; startinpy inserts them in that order and is slowest in random
order. † wrong, incomplete or not finished in time, see below.
"""


def write_report(
    outcome: Outcome, machine: dict[str, str], command: str, target: Path
) -> list[Path]:
    """Write the page, its data and, where matplotlib is installed, its plots.

    Parameters
    ----------
    outcome : Outcome
    machine : dict of str to str
    command : str
    target : Path
        A folder for ``benchmarks.md``, ``.json`` and ``.png``; or the page itself, ``.md``, which
        then stands without its data.

    Returns
    -------
    list of Path
        The files written.
    """
    is_page = target.suffix == ".md"
    folder, name = (target.parent, target.stem) if is_page else (target, NAME)
    folder.mkdir(parents=True, exist_ok=True)
    plots = _name_plots(outcome.results, name)
    if plots and not is_installed("matplotlib"):
        outcome.skip({"plot": "matplotlib is not installed"})
        plots = {}
    content = _as_content(outcome, machine, command, [*plots])
    written = [folder / f"{name}.md"]
    written[0].write_text(format_page(content, name), encoding="utf-8")
    if not is_page:
        written.append(folder / f"{name}.json")
        text = json.dumps(content, indent=1, allow_nan=False) + "\n"
        written[1].write_text(text, encoding="utf-8")
    for section, plot in plots.items():
        from .plot import draw

        written.append(draw(_select_section(outcome.results, section), folder / plot))
    return written


def _make_title(results: Sequence[Result]) -> str:
    """Return what is measured, with the usual number of points rounded to a power of ten."""
    counts = [result.count for result in results if result.section in PLOTS]
    if not counts:
        return "Benchmarks"
    is_of_lines = all(result.section != "kernel" for result in results)
    subject = "Benchmarks with breaklines" if is_of_lines else "Benchmarks"
    return f"{subject}: {10 ** round(math.log10(median(counts))):,} points"


def _name_plots(results: Sequence[Result], name: str) -> dict[str, str]:
    """Return the names of the plots to draw, by section."""
    return {
        section: f"{name}{ending}"
        for section, ending in PLOTS.items()
        if _select_section(results, section)
    }


def _as_content(
    outcome: Outcome, machine: dict[str, str], command: str, plots: list[str]
) -> dict[str, Any]:
    """Return all that a page says, as JSON holds it."""
    return {
        "command": command,
        "machine": machine,
        "results": [_drop_nan(asdict(result)) for result in outcome.results],
        "skipped": outcome.skipped,
        "plots": plots,
    }


def _drop_nan(values: dict[str, object]) -> dict[str, object]:
    return {k: None if isinstance(v, float) and math.isnan(v) else v for k, v in values.items()}


def _read_result(values: dict[str, Any]) -> Result:
    seconds = math.nan if values["seconds"] is None else values["seconds"]
    return Result(**{**values, "seconds": seconds, "runs": tuple(values["runs"])})


def format_page(content: dict[str, Any], name: str) -> str:
    """Return the page of what a file of results holds; ``name`` is that of the file."""
    results = [_read_result(values) for values in content["results"]]
    machine, skipped = content["machine"], content["skipped"]
    versions = ", ".join(f"{k} {v}" for k, v in machine.items() if k != "machine")
    title = _make_title(results)
    parts = [INTRODUCTION.format(title=title), f"Machine: {machine['machine']}. {versions}.\n"]
    plots = _name_plots(results, name)
    for section, render in SECTIONS.items():
        own = _select_section(results, section)
        if own:
            parts.append(render(own, plots[section] if section in content["plots"] else ""))
    if skipped:
        parts.append("\n".join(["## Left out", "", *(f"- {x}" for x in skipped), ""]))
    parts.append(HOW_TO_REPEAT.format(command=content["command"]))
    return "\n".join(parts)


def _select_section(results: Iterable[Result], section: str) -> list[Result]:
    return [result for result in results if result.section == section]


TEXT_COLUMNS = ("data set, points", "task", "tool", "remark", "goal", "data set")


def _format_table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a table, text to the left, numbers to the right."""
    return format_table({name: name in TEXT_COLUMNS for name in head}, rows)


def _format_seconds(seconds: float) -> str:
    if math.isnan(seconds):
        return "-"
    if seconds < 0.0995:
        return f"{seconds * 1000:.3g} ms"
    return f"{seconds:.1f} s" if seconds >= 9.95 else f"{seconds:.2f} s"


def _format_speed_ratio(seconds: float, ours: float) -> str:
    ratio = seconds / ours
    return f"{ratio:.0f}" if ratio >= 9.95 else f"{ratio:.2f}"


# ------------------------------------------------------------------------ kernel


class _KernelRow:
    """All results on one data set of one size, by tool."""

    def __init__(self, results: list[Result]) -> None:
        self.by_tool = {result.tool: result for result in results}
        self.task, self.count = results[0].task, results[0].count

    @property
    def label(self) -> str:
        return f"{self.task}, {self.count:,}"

    def cell(self, tool: str) -> str:
        result = self.by_tool.get(tool)
        if result is None:
            return ""
        if math.isnan(result.seconds):
            return "- †"
        mark = " †" if _is_wrong(result) else ""
        if tool == OURS or OURS not in self.by_tool:
            return f"{_format_seconds(result.seconds)}{mark}"
        return f"{_format_seconds(result.seconds)} ({self.ratio(tool, OURS)}){mark}"

    def ratio(self, tool: str, to: str) -> str:
        if tool not in self.by_tool or to not in self.by_tool:
            return ""
        return _format_speed_ratio(self.by_tool[tool].seconds, self.by_tool[to].seconds)

    def extra(self, tool: str, name: str, form: str = ",.0f") -> str:
        result = self.by_tool.get(tool)
        value = None if result is None else result.extra.get(name)
        return "" if value is None else format(value, form)


def _is_wrong(result: Result) -> bool:
    return not result.extra["is_right"]


def _make_kernel_rows(results: list[Result]) -> list[_KernelRow]:
    groups: dict[tuple[str, int], list[Result]] = {}
    for result in results:
        groups.setdefault((result.task, result.count), []).append(result)
    return [_KernelRow(group) for group in groups.values()]


def _format_kernel_part(results: list[Result], plot: str) -> str:
    rows = _make_kernel_rows(results)
    tools = [tool for tool in kernel.ALL_TOOLS if any(tool in row.by_tool for row in rows)]
    parts = ["## Triangulation\n", KERNEL_NOTES]
    parts += _format_plot(plot)
    parts.append(_format_times(rows, tools))
    parts += format_goals(results)
    parts += ["### Differences from tinsmith: lost points, errors, ties\n", _format_remarks(rows)]
    parts += ["### Memory\n", MEMORY_NOTES, _format_memory(rows, tools)]
    parts += ["### Work\n", WORK_NOTES, _format_work(rows)]
    return "\n".join(parts)


def _format_plot(plot: str) -> list[str]:
    return [f"![Time per point of every tool on every data set]({plot})\n"] if plot else []


GOALS_NOTES = """\
The project's goals, for one thread at 1,000,000 points unless stated otherwise, and the figures of
this page. Each ratio is the least favourable of its data sets.
"""


def format_goals(results: list[Result]) -> list[str]:
    """Return the page's part about goals; nothing where no goal can be judged."""
    lines = judge_goals(results)
    if not lines:
        return []
    head = ["goal", "data set", "required", "aim", "reached", ""]
    return ["### Required and reached\n", GOALS_NOTES, _format_table(head, lines)]


BESIDE = ((CGAL, KERNEL), (DELAUNAY32, KERNEL), (DELAUNAY32_ALL_CORES, KERNEL_ALL_CORES))
"""A peer, and which of ours is compared with it."""


def _format_times(rows: list[_KernelRow], tools: list[str]) -> str:
    beside = [(peer, own) for peer, own in BESIDE if {peer, own} <= set(tools)]
    head = ["data set, points", *tools, *(f"{peer} / {own}" for peer, own in beside)]
    body = [
        [row.label, *map(row.cell, tools), *(row.ratio(peer, own) for peer, own in beside)]
        for row in rows
    ]
    return _format_table(head, body)


def _format_remarks(rows: list[_KernelRow]) -> str:
    """One line a tool and remark, for the answers that are not equal to ours."""
    rows_of: dict[str, list[str]] = {}
    for row in rows:
        for tool, result in row.by_tool.items():
            if tool != kernel.WORK and result.note not in (EQUAL, AS_MANY):
                mark = " †" if _is_wrong(result) else ""
                rows_of.setdefault(tool, []).append(f"{row.label}: {result.note}{mark}")
    lines = [
        f"- {tool}\n" + "\n".join(f"  - {x}" for x in texts) for tool, texts in rows_of.items()
    ]
    return "\n".join([*lines, ""]) if lines else "Every triangulation is equal to ours.\n"


MEMORY_NOTES = """\
Bytes per point: the increase of the resident memory of a process that runs only this tool, from
the state with the points loaded; it includes the result. *Beyond input and output*: without the
arrays returned (82 bytes per point for the whole call, 48 for the kernel).
"""


def _format_memory(rows: list[_KernelRow], tools: list[str]) -> str:
    ours = [tool for tool in kernel.OUR_TOOLS if tool in tools]
    head = ["data set, points", *tools, *(f"{tool}, beyond input and output" for tool in ours)]
    body = [
        [
            row.label,
            *(row.extra(tool, "peak_bytes_per_point") for tool in tools),
            *(row.extra(tool, "beyond_output_bytes_per_point") for tool in ours),
        ]
        for row in rows
        if row.count >= LEAST_FOR_MEMORY
    ]
    return (
        _format_table(head, body) if body else f"Too few points: {LEAST_FOR_MEMORY:,} are needed.\n"
    )


WORK_NOTES = """\
Per triangle: searches for a third point (below 1 where the kernel switches to insertion); full
searches, which go beyond the gathered neighbourhood; candidates examined; rows of cells that full
searches enter; decisions that needed exact arithmetic. Rasters are grown for this table; as a rule
they are written without a search. These counts do not depend on the machine; `count_work` in
`tin/_kernel.py` returns them for any points.
"""
WORK_COUNTS = ("searches", "full_searches", "candidates", "cell_rows", "exact_decisions")


def _format_work(rows: list[_KernelRow]) -> str:
    head = ["data set, points", *(name.replace("_", " ") for name in WORK_COUNTS)]
    return _format_table(
        head,
        [[row.label, *(row.extra(kernel.WORK, c, ".3f") for c in WORK_COUNTS)] for row in rows],
    )


# ------------------------------------------------------------------------- lines

LINES_NOTES = """\
Seconds for the whole call `ts.triangulate(points, breaklines=lines)`, and in brackets the ratio of
the other libraries to it. tinsmith itself finds which vertices of lines are points, where lines
cross and which points lie on them; the others are given distinct points and the lines as pairs of
point numbers, prepared beforehand. CGAL: `insert` all points and `insert_constraint` by vertex
handles, or `insert_constraints` by indices, exact predicates. Delaunay32: as above, on coordinates
rounded to millimetres. *CDT* is A. Amirkhanov's library of that name, with its own order of
insertion; *detria* has exact predicates. Triangle: switches `pcQz`. The number of points includes
vertices of lines.

- *short lines*: uniform points, lines of ten segments; *long lines*: across the whole area
- *nested rings*: contours of one hill; *hills*: 70 rings on each of many hills
- *raster lines*: between points of a 0.1 m raster, many of them through further points
"""
LINES_MEMORY_NOTES = """\
As for triangulation without lines. The input of every tool is prepared beforehand.
"""


def _format_lines_part(results: list[Result], plot: str) -> str:
    rows = _make_kernel_rows(results)
    tools = [tool for tool in ALL_LINE_TOOLS if any(tool in row.by_tool for row in rows)]
    parts = ["## Triangulation with breaklines\n", LINES_NOTES, *_format_plot(plot)]
    parts += [_format_times(rows, tools), *format_goals(results)]
    parts += ["### Differences from tinsmith with lines\n", _format_remarks(rows)]
    parts += ["### Memory with lines\n", LINES_MEMORY_NOTES, _format_memory(rows, tools)]
    return "\n".join(parts)


# ------------------------------------------------------------------ other sections


def _make_part_formatter(title: str, unit: str, notes: str) -> Callable[[list[Result], bool], str]:
    def render(results: list[Result], plot: str) -> str:
        del plot
        ours = {result.task: result for result in results if result.tool == OURS}
        head = ["task", "tool", unit, "seconds", "times tinsmith", "remark"]
        rows = [_make_other_row(result, ours[result.task]) for result in results]
        return "\n".join(
            [f"## {title}\n", notes, _format_table(head, rows), *format_goals(results)]
        )

    return render


def _make_other_row(result: Result, ours: Result) -> list[str]:
    remark = result.note
    if "prepare_seconds" in result.extra:
        remark = f"{_format_seconds(result.extra['prepare_seconds'])} to prepare"
    rate, our_rate = result.seconds / result.count, ours.seconds / ours.count
    return [
        result.task,
        result.tool,
        f"{result.count:,}",
        _format_seconds(result.seconds),
        _format_speed_ratio(rate, our_rate),
        remark,
    ]


EDITS_NOTES = """\
Random edits of a TIN of uniform points, one call each; *batch* inserts as many points as the TIN
has in one call; one core each. *tinsmith* edits a TIN that was never edited: its first edit keeps
what the next ones need; *opened* does not count that, as the peers, which are meshes from the
start, do not count their building; *and its arrays* includes reading the triangles afterwards;
*building* is a triangulation of the points of the batch alone. CGAL (`Delaunay_triangulation_2`)
and startinpy have stable vertex handles and no history. CGAL has no elevations; a move in
startinpy is a removal and an insertion, and its points are sorted along a curve first, which is
not timed.
"""

ANSWERS_NOTES = """\
Products of one TIN. Preparation is from the TIN to its index. Every result is compared with that
of tinsmith, as stated below the table; a difference stops the run.
"""


def _format_answers_part(results: list[Result], plot: str) -> str:
    part = _make_part_formatter("Products of a TIN", "points", ANSWERS_NOTES)
    compared = [_format_item(text) for text in answers.describe_modules()]
    return "\n".join([part(results, plot), "### What is compared\n", *compared, ""])


PRODUCTS_NOTES = """\
Products of a surface, each in a separate process; results are checked. Elapsed seconds and
processor seconds; memory is the increase above that of the process with its input.
"""


def _format_products_part(results: list[Result], plot: str) -> str:
    del plot
    head = ["task", "points", "seconds", "of the processor", "memory", "remark"]
    rows = [
        [
            result.task,
            f"{result.count:,}",
            _format_seconds(result.seconds),
            _format_seconds(result.extra["processor_seconds"]),
            _format_bytes(result.extra["peak_bytes"]),
            result.note,
        ]
        for result in results
    ]
    return "\n".join(["## Products of a surface\n", PRODUCTS_NOTES, _format_table(head, rows)])


def _format_bytes(count: int | None) -> str:
    return "" if count is None else f"{count / 1e6:,.0f} MB"


def _format_item(text: str) -> str:
    """Return an item of a list, in lines as long as those of the page."""
    return textwrap.fill(text, 100, initial_indent="- ", subsequent_indent="  ")


SECTIONS: dict[str, Callable[[list[Result], str], str]] = {
    "kernel": _format_kernel_part,
    "variants": _make_part_formatter(
        "Variants of the kernel",
        "points",
        "Vector instructions, the two methods between which the kernel chooses, and small inputs;\n"
        "alternately in one process, all with the same arrays.\n",
    ),
    "lines": _format_lines_part,
    "edits": _make_part_formatter(
        "Edits",
        "edits",
        EDITS_NOTES,
    ),
    "locate": _make_part_formatter(
        "Queries",
        "points",
        "Random query points on a TIN of uniform points, near the origin of coordinates as SciPy\n"
        "needs it; ratios are per point. Preparation is from the points to the first result.\n",
    ),
    "readers": _make_part_formatter(
        "Readers",
        "rows",
        "One file of each format, in the file cache of the system; numbers read are compared.\n",
    ),
    "writers": _make_part_formatter(
        "Writers", "triangles", "From the TIN to the file; every file is read back and compared.\n"
    ),
    "answers": _format_answers_part,
    "products": _format_products_part,
    "startup": _make_part_formatter(
        "Starting up",
        "points",
        "The command line with very little input, in new processes: mostly the time to start.\n",
    ),
}
