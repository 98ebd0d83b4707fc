"""Tables of Markdown, made of records that JSON can hold."""

from __future__ import annotations

import argparse
import json
import math
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

__all__ = ["TEXT", "Table", "add_option", "format_table"]

TEXT = "{}"
"""The form of a column of words, which stand to the left; numbers stand to the right."""


def format_table(heads: Mapping[str, bool], rows: Iterable[Sequence[str]]) -> str:
    """Return a table; ``heads`` says which columns are words."""
    rule = ["---" if is_text else "---:" for is_text in heads.values()]
    return "".join(f"{_format_row(row)}\n" for row in ([*heads], rule, *rows))


def add_option(parser: argparse.ArgumentParser) -> None:
    """Add the option ``--json``, a file for :meth:`Table.write`."""
    what = "write the figures, too: python -m benchmarks.report FILE prints them again"
    parser.add_argument("--json", type=Path, metavar="FILE", help=what)


class Table:
    """Records under named columns, shown row by row while they are measured.

    Parameters
    ----------
    columns : dict of str to str
        How the values of each are written, as for ``str.format``; a list has several fields.
    """

    def __init__(self, columns: Mapping[str, str]) -> None:
        self.columns = dict(columns)
        self.records: list[Sequence[Any]] = []

    @classmethod
    def read(cls, path: Path) -> Table:
        """Return the table in a file."""
        content = json.loads(path.read_text(encoding="utf-8"))
        table = cls(content["columns"])
        table.records = content["records"]
        return table

    def write(self, path: Path | None) -> None:
        """Write columns and records as JSON, if a file is given."""
        if path is None:
            return
        content = {"columns": self.columns, "records": self.records}
        path.write_text(json.dumps(content, indent=1, allow_nan=False) + "\n", encoding="utf-8")

    def show(self, *record: Any) -> None:
        """Add a record, and print its row, below the heads if it is the first."""
        values = [None if isinstance(v, float) and math.isnan(v) else v for v in record]
        self.records.append(values)
        lines = self._format([values]).splitlines()
        print("\n".join(lines if len(self.records) == 1 else lines[-1:]), flush=True)

    def __str__(self) -> str:
        return self._format(self.records)

    def _format(self, records: Iterable[Sequence[Any]]) -> str:
        heads = {name: form == TEXT for name, form in self.columns.items()}
        forms = self.columns.values()
        return format_table(
            heads, ([_format_cell(*cell) for cell in zip(forms, r, strict=True)] for r in records)
        )


def _format_row(cells: Iterable[str]) -> str:
    return f"| {' | '.join(cells)} |"


def _format_cell(form: str, value: Any) -> str:
    if value is None:
        return ""
    return form.format(*value) if isinstance(value, list | tuple) else form.format(value)
