"""Points that are recorded twice: a number, or a place, that several rows have."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .naming import make_namer, write_number
from .suspects import Suspect

if TYPE_CHECKING:
    from ...base.arrays import Int64Array
    from ..surface import TIN
    from .suspects import Rows

_USUAL_SHARE = 0.1
"""Where more of the numbers are repeated they are no names of points."""
_SHOWN = 3


def find_repeated_numbers(tin: TIN, rows: Rows) -> tuple[list[Suspect], list[str]]:
    """Find rows that have the point number of another one; notes if most have."""
    numbers = tin.row_attributes.get("number")
    if numbers is None:
        return [], []
    given = rows.numbers[rows.numbers < len(numbers)]  # edits insert rows without one behind them
    own = numbers[given]
    if own.dtype.kind not in "iu":  # whole numbers stay as they are
        own = np.array([write_number(value) for value in own.tolist()], str)
    named = np.flatnonzero(own != "") if own.dtype.kind == "U" else np.arange(len(own))
    if len(named) == 0:
        return [], []
    _, first, counts = np.unique(own[named], return_inverse=True, return_counts=True)
    repeated = named[counts[first] > 1]
    if len(repeated) > max(2, _USUAL_SHARE * len(named)):
        return [], [f"{len(repeated):,} of {len(named):,} point numbers are repeated."]
    groups: dict[str, list[int]] = {}
    for i in repeated.tolist():
        groups.setdefault(str(own[i]), []).append(i)
    return [
        rows.suspect(
            i, "number", _name_others(tin, text, rows.numbers[same], rows.numbers[i]), "high"
        )
        for text, same in groups.items()
        for i in same
    ], []


def _name_others(tin: TIN, text: str, same: Int64Array, own: int) -> str:
    others = same[same != own].tolist()
    sources = tin.report.row_sources
    names = [f"row {row}" for row in others[:_SHOWN]]
    if sources is not None:
        found = [sources.find(row) for row in others[:_SHOWN]]
        names = [
            f"line {line} of '{file}'" if line else name
            for name, (file, line) in zip(names, found, strict=True)
        ]
    more = ", ..." if len(others) > _SHOWN else ""
    return f"Point number {text} is also that of {', '.join(names)}{more}."


def find_repeated_places(tin: TIN, rows: Rows, scale: float) -> list[Suspect]:
    """Find rows at one place whose elevations differ by more than heights do around."""
    found = []
    name = make_namer(tin)
    for merge in tin.report.merges():
        spread = max(merge.elevations) - min(merge.elevations)
        if spread <= scale:
            continue
        certainty = "high" if spread > 10 * scale else "low"
        for row, elevation in zip(merge.rows, merge.elevations, strict=True):
            others = [one for one in merge.rows if one != row]
            i = int(np.searchsorted(rows.numbers, row))
            if i == len(rows) or rows.numbers[i] != row:
                continue
            suspect = rows.suspect(
                i,
                "place",
                _start(
                    f"{name(others[:1])} has the same place, and elevations there differ by "
                    f"{spread:.6g}."
                ),
                certainty,
            )
            residual = elevation - merge.elevation
            found.append(suspect._replace(residual=residual, scale=scale))
    return found


def find_crossings(tin: TIN, scale: float, limit: float) -> list[Suspect]:
    """Find crossings of lines whose elevations differ there by more than a limit."""
    crossings, labels = tin.report.crossings, tin.report.line_labels
    found = []
    for xy, lines, (one, other), taken in zip(
        crossings.xy.tolist(),
        crossings.lines.tolist(),
        crossings.elevations.tolist(),
        crossings.vertex_elevations.tolist(),
        strict=True,
    ):
        apart = abs(one - other)
        if apart > limit:
            names = " and ".join(labels[line] for line in lines)
            sentence = f"{names} cross here, and their elevations differ by {apart:.6g}."
            certainty = "high" if apart > 3 * limit else "medium"
            place = (*xy, taken)
            found.append(Suspect(-1, place, "crossing", _start(sentence), certainty, apart, scale))
    return found


def _start(sentence: str) -> str:
    return sentence[:1].upper() + sentence[1:]
