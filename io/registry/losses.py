"""What a format does not hold of what is written to it, told in a sentence each."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.notes import warn
from ...base.results import Features
from ...base.sentences import FILE, counted, shown

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from ...base.arrays import AnyArray
    from ...tin import Survey
    from .format import Format

_FORMULA = re.compile(r"\s*[=+@-].")
_BREAKS = re.compile("[\r\n\x00]+")
_PLURALS = {"boundary": "boundaries", "water body": "water bodies"}


def warn_of_lost_attributes(names: Iterable[str], reason: str) -> None:
    """Warn of attributes of points that a file does not hold, and why, if there are any."""
    lost = ", ".join(names)
    if lost:
        warn(f"{FILE} does not hold the attributes {lost}: {reason}.")


def select_attributes(
    attributes: Mapping[str, Any], names: tuple[str, ...], reason: str
) -> dict[str, AnyArray]:
    """Return the attributes of points that a format holds, on one line each; tell of the others."""
    warn_of_lost_attributes((name for name in attributes if name not in names), reason)
    held = {name: attributes[name] for name in names if name in attributes}
    return keep_on_one_line(held)


def keep_on_one_line(columns: Mapping[str, Any]) -> dict[str, AnyArray]:
    """Return columns with blanks in the place of line breaks within texts, and tell of them."""
    kept: dict[str, AnyArray] = {}
    broken = []
    for name, given in columns.items():
        values = np.asarray(given)
        texts = values.tolist() if values.dtype.kind in "OU" else []
        if any(isinstance(text, str) and _BREAKS.search(text) for text in texts):
            plain = [_BREAKS.sub(" ", one) if isinstance(one, str) else one for one in texts]
            values = np.array(plain, object)
            broken.append(name)
        kept[name] = values
    if broken:
        warn(f"{FILE}: line breaks within the texts of {', '.join(broken)} became blanks.")
    return kept


def warn_of_formulas(columns: Mapping[str, Any]) -> None:
    """Warn of texts that spreadsheets compute as formulas; numbers written as texts are none."""
    found = [
        text
        for values in map(np.asarray, columns.values())
        if values.dtype.kind in "OU"
        for text in values.tolist()
        if isinstance(text, str) and _FORMULA.match(text) and not _is_number(text)
    ]
    if found:
        warn(
            f"{FILE}: {counted(len(found), 'text')} begin with =, +, - or @, which spreadsheets "
            f"compute as formulas (first: {shown(found[0])}): import these columns as text."
        )


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def warn_of_lost_lines(survey: Survey, chosen: Format) -> None:
    """Warn of lines of a survey that the format does not hold."""
    counts = {
        "breakline": len(survey.breaklines),
        "boundary": len(survey.boundary),
        "hole": len(survey.holes),
        "erased area": len(survey.erase),
        "water body": len(survey.water),
    }
    all_lost = "survey lines" in chosen.loses
    names = counts if all_lost else ("erased area",) if "erased areas" in chosen.loses else ()
    lost = [counted(counts[name], name, _PLURALS.get(name, "")) for name in names if counts[name]]
    if lost:
        warn(
            f"{FILE} does not hold the lines of the survey ({', '.join(lost)}): the format "
            f"{chosen.name} has no place for them."
        )


def warn_of_unknown_elevations(obj: object) -> None:
    """Warn of features with vertices of unknown elevation, where a file has all or none of them."""
    if not isinstance(obj, Features) or not obj.has_elevations:
        return
    count = int(np.isnan(obj.coordinates[:, 2]).sum())
    if count:
        what = (
            f"{counted(count, 'point')} of unknown elevation got the elevation 0"
            if obj.kind == "points"
            else f"lines with {counted(count, 'vertex', 'vertices')} of unknown elevation lost "
            "all their elevations"
        )
        warn(f"{FILE}: {what}.")
