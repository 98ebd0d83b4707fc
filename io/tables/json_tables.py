"""JSON: tables as rows, with units and notes."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from ...base.atomic import replacing
from ...base.results import unit_text
from ..vector.geojson.values import json_texts, properties_template

if TYPE_CHECKING:
    from pathlib import Path

    from ...base.progress import Tell
    from ...base.results import Table

_CHUNK_ROWS = 50_000


def write(table: Table, path: Path, *, progress: Tell | None = None) -> None:
    """Write a table as an object with ``name``, ``notes``, ``units`` and ``rows``.

    Notes
    -----
    Each row is an object of the columns. ``units`` has the symbol of each column that has a unit,
    ``"unknown"`` where it is not known. Numbers read back as the same float64; what is not finite,
    and a text that is missing, is ``null``.
    """
    with replacing(path, binary=False) as file:
        members: dict[str, Any] = {
            "name": table.name,
            "notes": list(table.notes),
            "units": {name: unit_text(table.units, name) for name in table.units},
        }
        lines = [f"{json.dumps(name)}:{json.dumps(value)}" for name, value in members.items()]
        file.write("{" + ",\n".join(lines) + ',\n"rows":[')
        separator = "\n"
        row = properties_template(list(table.columns))
        for start in range(0, len(table), _CHUNK_ROWS):
            part = slice(start, start + _CHUNK_ROWS)
            texts = [json_texts(column[part]) for column in table.columns.values()]
            file.write(separator + ",\n".join(map(row.__mod__, zip(*texts, strict=True))))
            separator = ",\n"
            if progress is not None:
                progress(min(1.0, (start + _CHUNK_ROWS) / len(table)))
        file.write("\n]}\n")
