"""What is told of field codes: a sentence for each kind of oddity, and findings with their rows."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...base.sentences import inflect, printable
from ...base.types import Finding

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from .figures import Fault

__all__ = ["SENTENCES", "describe_faults", "make_finding"]

_SHOWN = 5
_LONGEST = 40

SENTENCES = {
    "end without a begin": (
        "{count} [line ends|lines end] at [its|their] first shot, and [stays|stay] a point"
    ),
    "nothing to continue": ("{count} [shot continues|shots continue] a line that goes on nowhere"),
    "mark not applied": "{count} [mark is|marks are] known and not applied",
    "line without an end": "{count} [line is|lines are] begun and not ended, where others are",
    "end of no curve": "{count} [curve ends|curves end] that [was|were] not begun",
    "curve of too few points": (
        "{count} [curve has|curves have] too few points and [is|are] straight"
    ),
    "curve without an end": (
        "{count} [curve has|curves have] no end and [is|are] the arc through three shots"
    ),
    "curve without a leg": (
        "{count} tangent [curve has|curves have] no leg beside [it|them] and [is|are] straight"
    ),
    "curve not tangent to the leg behind it": (
        "{count} [curve leaves its|curves leave their] second leg by more than 10°"
    ),
    "curve that turns back": (
        "{count} tangent [curve points|curves point] away from [its|their] end and [is|are] "
        "straight"
    ),
    "repeated point": (
        "{count} [shot stands|shots stand] at the place of the one before and [is|are] taken once"
    ),
    "no rectangle": "{count} [rectangle has|rectangles have] three corners in one line",
    "rectangle out of square": (
        "{count} [rectangle is|rectangles are] out of square by more than 5°"
    ),
    "code behind others": (
        "{count} [code stands|codes stand] behind others only, and [makes a line|make lines] all "
        "the same"
    ),
    "open figure": (
        "{count} [ring is|rings are] not closed by a mark, and closed from last to first shot"
    ),
    "open building": "{count} [building is|buildings are] not closed",
    "line that crosses itself": "{count} [line crosses itself|lines cross themselves]",
    "line that jumps": (
        "{count} [line jumps on a segment|lines jump on segments] more than ten times as long as "
        "the others"
    ),
    "contour that is not level": "{count} contour [line has|lines have] several elevations",
    "mark before a code": (
        "{count} [mark stands before its code and is|marks stand before their codes and are] not "
        "read"
    ),
    "unknown code": "{count} [code is|codes are] not in the code table",
    "unknown line code": "{count} unknown [code has|codes have] marks of lines",
    "too few points": (
        "{count} [line is left out, which has|lines are left out, which have] too few points"
    ),
    "unknown mark": (
        "{count} unknown [mark behind line codes is|marks behind line codes are] taken for remarks"
    ),
}
"""By kind: what is told, of one and of several."""

_HINTS = {
    "too few points": ": a line needs two, a closed one three",
    "unknown mark": (": {words} are known; a remark stands in quotes or behind a comma, / or ;"),
    "mark not applied": ": offsets, recalled points and others are for drawings",
    "code behind others": ": a remark stands in quotes or behind a comma, / or ;",
    "mark before a code": ': place = "before" in a code table reads them',
    "unknown code": ": their points are points of the surface",
    "unknown line code": ": their points are points of the surface; a code table defines codes",
    "line that crosses itself": ": check codes, marks and the order of the shots",
    "line that jumps": ": check codes, marks and the order of the shots",
}


def describe_faults(
    faults: Iterable[Fault], name_row: Callable[[int], str], words: str
) -> tuple[list[str], list[Finding]]:
    """Return a note for each kind of fault, and a finding for each fault.

    Parameters
    ----------
    faults : iterable of Fault
    name_row : callable
        Names a row for a sentence.
    words : str
        The marks that are known, for a sentence.
    """
    by_kind: dict[str, list[Fault]] = {}
    for fault in dict.fromkeys(faults):
        by_kind.setdefault(fault.kind, []).append(fault)
    notes = [_note(kind, found, name_row, words) for kind, found in by_kind.items()]
    findings = [make_finding(fault, name_row) for found in by_kind.values() for fault in found]
    return notes, findings


def make_finding(fault: Fault, name_row: Callable[[int], str]) -> Finding:
    """Return what a report holds of a fault."""
    sentence = f"{fault.kind[0].upper()}{fault.kind[1:]}: {_name(fault, name_row)}."
    return Finding(fault.kind, fault.rows, printable(sentence))


def _note(kind: str, found: Sequence[Fault], name_row: Callable[[int], str], words: str) -> str:
    shown = ", ".join(_name(fault, name_row) for fault in found[:_SHOWN])
    more = " ..." if len(found) > _SHOWN else ""
    head = inflect(SENTENCES[kind], len(found)).format(count=f"{len(found):,}")
    hint = _HINTS.get(kind, "").format(words=words)
    return printable(f"{head} ({shown}{more}){hint}.")


def _name(fault: Fault, name_row: Callable[[int], str]) -> str:
    """Name a fault by its line or word, and its rows."""
    rows = ", ".join(name_row(row) for row in fault.rows[:_SHOWN])
    rows += " ..." if len(fault.rows) > _SHOWN else ""
    what = fault.what if len(fault.what) <= _LONGEST else f"{fault.what[:_LONGEST]}..."
    if fault.kind in ("unknown mark", "mark not applied"):
        return f"'{what}' at {rows}"
    return f"{what}: {rows}"
