"""Tables and pages are made of what JSON files hold: again from a file they are the same."""

from __future__ import annotations

import math

from benchmarks.measure import OURS, Outcome, Result
from benchmarks.report.__main__ import format_file
from benchmarks.report.page import write_report
from benchmarks.report.tables import TEXT, Table


def test_a_table_is_printed_row_by_row_and_comes_again_from_its_file(tmp_path, capsys):
    table = Table({"file": TEXT, "points": "{:,}", "total, kappa": "{:.2f}, {:.1f}", "s": "{:.1f}"})
    table.show("a.laz", 1234, (3.456, 90.04), 0.25)
    table.show("**mean**", None, (1.0, 80.0), math.nan)
    table.write(tmp_path / "table.json")
    wanted = (
        "| file | points | total, kappa | s |\n| --- | ---: | ---: | ---: |\n"
        "| a.laz | 1,234 | 3.46, 90.0 | 0.2 |\n| **mean** |  | 1.00, 80.0 |  |\n"
    )
    assert capsys.readouterr().out == str(table) == wanted
    assert format_file(tmp_path / "table.json") == wanted


def test_a_page_comes_again_from_its_file(tmp_path):
    outcome = Outcome(
        [
            Result("answers", "contours", OURS, 1000, 0.2, (0.2, 0.3)),
            Result("answers", "contours", "matplotlib", 1000, math.nan, note="no answer"),
            Result("products", "ground", OURS, 50, 1.5, (1.5,), "found",
                   {"processor_seconds": 2.0, "peak_bytes": None}),
        ],
        ["CGAL: skipped, it is not installed."],
    )  # fmt: skip
    page, data = write_report(outcome, {"machine": "one", "numpy": "2"}, "a command", tmp_path)
    assert "- CGAL: skipped" in page.read_text(encoding="utf-8")
    assert format_file(data) == page.read_text(encoding="utf-8")
