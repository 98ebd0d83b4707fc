"""Points that look like blunders, for people and as JSON."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...base.sentences import counted, height
from .facts import list_rows

if TYPE_CHECKING:
    from ...base.arrays import Int64Array
    from ...terrain import Table
    from .console import Row

_SHOWN = 5


def count_reasons(table: Table) -> str:
    """Say how many findings of each reason there are."""
    if len(table) == 0:
        return "none"
    reasons, counts = np.unique(table["reason"].astype(str), return_counts=True)
    parts = [f"{count:,} {name}" for name, count in zip(reasons, counts.tolist(), strict=True)]
    return f"{len(table):,}: {', '.join(parts)}"


def list_findings(table: Table, most: int) -> list[Row]:
    """Return a line for each of the most certain findings."""
    rows = [
        (
            table["certainty"][i].capitalize(),
            f"{_name_point(table, i)} at {table['x'][i]:.3f} {table['y'][i]:.3f}, elevation "
            f"{height(table['z'][i])}: {table['reason'][i]}. {table['explanation'][i]}",
        )
        for i in range(min(len(table), most))
    ]
    return [*rows, ("", f"... {len(table) - most:,} more")] if len(table) > most else rows


def _name_point(table: Table, i: int) -> str:
    """Name a point as people find it again: by its number, and the line of its file."""
    row, number = int(table["row"][i]), table["number"][i]
    if row < 0:
        return "Lines"
    file, line = table["file"][i], int(table["line"][i])
    place = f"line {line} of '{file}'" if line else ""
    if number:
        return f"Point {number}" + (f" ({place})" if place else "")
    return place[:1].upper() + place[1:] or f"Row {row}"


class Suspects(NamedTuple):
    """What a build found."""

    table: Table
    """Of :func:`tinsmith.blunders`."""
    dropped: Int64Array | None
    """(k,), rows that were left out; None if that was not asked for."""


def report_suspects(found: Suspects) -> list[Row]:
    """Return the lines of a build on what looks like a blunder, but for what is doubtful."""
    from ...terrain.inspection import list_wrong_rows

    table = found.table
    rows = list_wrong_rows(table)
    is_clear = table["certainty"].astype(str) != "low"
    is_other = is_clear & np.isin(table["reason"].astype(str), ("line", "void"))
    others = [("Blunders", table["explanation"][i]) for i in np.flatnonzero(is_other)[:_SHOWN]]
    if len(rows) == 0:
        return others
    first = {int(row): i for i, row in reversed(list(enumerate(table["row"].tolist())))}
    shown = [_name_point(table, first[row]) for row in rows[:_SHOWN].tolist()]
    names = "; ".join(one[:1].lower() + one[1:] for one in shown)
    more = "; ..." if len(rows) > _SHOWN else ""
    looks = "looks like a blunder" if len(rows) == 1 else "look like blunders"
    text = f"{counted(len(rows), 'point')} {looks}: {names}{more}"
    done = "'tinsmith inspect' lists them"
    if found.dropped is not None:
        done = f"{len(found.dropped):,} left out"
    return [("Blunders", f"{text}; {done}"), *others]


def describe_suspects(found: Suspects) -> dict[str, Any]:
    """Return the part of a build's report on points that look like blunders."""
    dropped = set() if found.dropped is None else set(found.dropped.tolist())
    records = list_rows(found.table.columns)
    return {"blunders": [one | {"dropped": one["row"] in dropped} for one in records]}
