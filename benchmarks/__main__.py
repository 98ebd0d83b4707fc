"""Run the benchmarks: ``python -m benchmarks [SECTION ...]``."""

from __future__ import annotations

import argparse
import shlex
import sys
from pathlib import Path
from typing import Any

from .datasets.lines import LINE_DATASETS
from .datasets.points import DATASETS
from .measure import Outcome
from .report.machine import describe
from .report.page import write_report
from .sections import (
    answers,
    edits,
    kernel,
    lines,
    locate,
    products,
    readers,
    startup,
    variants,
    writers,
)

SECTIONS: dict[str, Any] = {
    module.SECTION: module
    for module in (
        kernel,
        variants,
        lines,
        edits,
        locate,
        readers,
        writers,
        answers,
        products,
        startup,
    )
}
"""Modules by the names of their sections, in the order of the page."""

RESULTS = Path(__file__).parent / "results"
LEAST_POINTS = 200

OPTIONS: dict[str, dict[str, Any]] = {
    "--points": {
        "type": int,
        "metavar": "N",
        "help": "points, rows, triangles; default 100,000",
    },
    "--full": {
        "action": "store_true",
        "help": "1,000,000, and 10,000,000 uniform points for the kernel",
    },
    "--only": {
        "nargs": "+",
        "choices": (*DATASETS, *LINE_DATASETS),
        "metavar": "DATASET",
        "help": f"kernel: of {', '.join(DATASETS)}; lines: of {', '.join(LINE_DATASETS)}; "
        "default all",
    },
    "--tools": {
        "nargs": "+",
        "choices": kernel.ALL_TOOLS,
        "metavar": "TOOL",
        "default": kernel.ALL_TOOLS,
        "help": f"kernel: of {', '.join(kernel.ALL_TOOLS)}; default all",
    },
    "--repeats": {
        "type": int,
        "default": 5,
        "metavar": "K",
        "help": "rounds; seconds are their median; default 5",
    },
    "--limit": {
        "type": float,
        "metavar": "SECONDS",
        "help": "for one triangulation; default 5, with --full 40",
    },
    "--output": {
        "type": Path,
        "default": RESULTS,
        "metavar": "FOLDER",
        "help": "for benchmarks.md, .json and .png; or a page to write alone, .md; "
        "python -m benchmarks.report FILE.json prints a page again",
    },
}


def main(arguments: list[str] | None = None) -> None:
    """Measure what the command line asks for; write the report and say where it is."""
    parser = _make_parser()
    given = parser.parse_args(arguments)
    if given.points is not None and given.points < LEAST_POINTS:
        parser.error(f"--points {given.points}: at least {LEAST_POINTS} are needed")
    said = sys.argv[1:] if arguments is None else arguments
    command = shlex.join(["python", "-m", "benchmarks", *said])
    outcome = Outcome()
    for section in given.sections or SECTIONS:
        outcome.add(_measure_section(section, given))
        written = write_report(outcome, describe(), command, given.output)
    for path in written:
        print(path)
    for line in outcome.skipped:
        print(line)


def _make_parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m benchmarks", description=__doc__)
    names = f"of {', '.join(SECTIONS)}; default all"
    parser.add_argument(
        "sections", nargs="*", metavar="SECTION", choices=[[], *SECTIONS], help=names
    )
    for flag, how in OPTIONS.items():
        parser.add_argument(flag, **how)
    return parser


def _measure_section(section: str, given: argparse.Namespace) -> Outcome:
    n = given.points or (1_000_000 if given.full else 100_000)
    if section == kernel.SECTION:
        cases = kernel.list_cases(n, is_full=given.full)
        chosen = [(name, size) for name, size in cases if not given.only or name in given.only]
        limit = given.limit or (40.0 if given.full else 5.0)
        return kernel.run(chosen, tools=given.tools, repeats=given.repeats, limit=limit)
    if section == lines.SECTION:
        names = [name for name in LINE_DATASETS if not given.only or name in given.only]
        return lines.run(n, names=names, repeats=given.repeats, limit=given.limit or 40.0)
    if section == locate.SECTION:
        return locate.run(n, n, repeats=given.repeats)
    return SECTIONS[section].run(n, repeats=given.repeats)


if __name__ == "__main__":
    main()
