"""What is told of field codes: a sentence for each kind of oddity, and findings with their rows."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from ...base.sentences import inflect, printable
from ...base.types import Finding

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from .figures import Fault

_SHOWN = 5
_LONGEST = 40


class Remark(NamedTuple):
    """What is told of a kind of fault, and behind the faults that are shown."""

    sentence: str
    """Of one and of several: "{count} [line is|lines are] ..."."""
    hint: str


@cache
def read_remarks() -> dict[str, Remark]:
    """Return the rows of ``remarks.tsv`` by kinds of faults."""
    text = Path(__file__).with_name("remarks.tsv").read_text("utf-8")
    rows = (line.split("\t") for line in text.splitlines()[1:])
    return {kind: Remark(*texts) for kind, *texts in rows}


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
    remark = read_remarks()[kind]
    shown = ", ".join(_name(fault, name_row) for fault in found[:_SHOWN])
    more = " ..." if len(found) > _SHOWN else ""
    head = inflect(remark.sentence, len(found)).format(count=f"{len(found):,}")
    hint = remark.hint.format(words=words)
    return printable(f"{head} ({shown}{more}){hint}.")


def _name(fault: Fault, name_row: Callable[[int], str]) -> str:
    """Name a fault by its line or word, and its rows."""
    rows = ", ".join(name_row(row) for row in fault.rows[:_SHOWN])
    rows += " ..." if len(fault.rows) > _SHOWN else ""
    what = fault.what if len(fault.what) <= _LONGEST else f"{fault.what[:_LONGEST]}..."
    if fault.kind in ("unknown mark", "mark not applied"):
        return f"'{what}' at {rows}"
    return f"{what}: {rows}"
