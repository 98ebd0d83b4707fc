"""Lines as LandXML writes them: breaklines, boundaries and contours of the source data."""

from __future__ import annotations

from typing import TYPE_CHECKING
from xml.sax.saxutils import quoteattr

import numpy as np

from ....base.results import Features
from ....tin import Surface
from ..drawing import list_lines
from .content import FEATURE, KIND, LINE, PRIORITY, SOURCE

if TYPE_CHECKING:
    from ....base.arrays import Float64Array
    from ....tin import TIN, Survey

__all__ = ["format_source", "quote"]

_BOUNDARIES = {"boundary": ("outer", "void"), "hole": ("void", "island")}
"""Of the outer ring of a polygon, and of those in it."""


def quote(text: str) -> str:
    """Return a text as the value of an attribute, without letters that XML does not have."""
    plain = "".join(one if one.isprintable() else " " for one in text)
    return quoteattr(plain.encode("utf-8", "replace").decode("utf-8"))


def format_source(obj: TIN | Survey | Features, factor: float) -> str:
    """Return lines as the source data of a surface; empty if there are none.

    Lines of features that have one elevation are contours. A feature of each line of a TIN tells
    which it is, so that a reader that knows it restores their order.
    """
    found: dict[str, list[str]] = {"Boundaries": [], "Breaklines": [], "Contours": []}
    seen = set()
    for number, line in enumerate(list_lines(obj, factor)):
        rows, extra = line.coordinates, {} if line.kind == "hard" else {KIND: line.kind}
        if isinstance(obj, Surface):
            extra |= {LINE: str(number), SOURCE: str(line.source)}
        elif line.priority:
            extra[PRIORITY] = str(line.priority)
        if line.kind in _BOUNDARIES and (rows[0] == rows[-1]).all():
            extra.pop(KIND)
            kind = _BOUNDARIES[line.kind][line.polygon is not None and line[1:] in seen]
            seen.add(line[1:])
            found["Boundaries"].append(_format_boundary(rows, kind, line.name, extra))
        elif isinstance(obj, Features) and rows.shape[1] == 3 and np.ptp(rows[:, 2]) == 0:
            found["Contours"].append(_format_contour(rows))
        elif line.kind != "erase":
            found["Breaklines"].append(_format_breakline(rows, line.name, extra))
    parts = [f"<{name}>\n{''.join(part)}</{name}>\n" for name, part in found.items() if part]
    return f"<SourceData>\n{''.join(parts)}</SourceData>\n" if parts else ""


def _format_breakline(rows: Float64Array, name: str, extra: dict[str, str]) -> str:
    brk = "nondestructive" if rows.shape[1] == 2 else "standard"
    named = f" name={quote(name)}" if name else ""
    return (
        f'<Breakline brkType="{brk}"{named}>\n{_format_list(rows)}{_format_feature(extra)}'
        "</Breakline>\n"
    )


def _format_boundary(rows: Float64Array, kind: str, name: str, extra: dict[str, str]) -> str:
    if (rows[0, :2] != rows[-1, :2]).any():
        rows = np.concatenate([rows, rows[:1]])
    named = f" name={quote(name)}" if name else ""
    return (
        f'<Boundary bndType="{kind}" edgeTrim="true"{named}>\n{_format_list(rows)}'
        f"{_format_feature(extra)}</Boundary>\n"
    )


def _format_contour(rows: Float64Array) -> str:
    return f'<Contour elev="{float(rows[0, 2])!r}">\n{_format_list(rows[:, :2])}</Contour>\n'


def _format_list(rows: Float64Array) -> str:
    ordered = rows[:, [1, 0, *range(2, rows.shape[1])]].ravel().tolist()
    tag = f"PntList{rows.shape[1]}D"
    return f"<{tag}>{' '.join(map(repr, ordered))}</{tag}>\n"


def _format_feature(values: dict[str, str]) -> str:
    if not values:
        return ""
    properties = "".join(
        f'<Property label="{label}" value={quote(value)}/>\n' for label, value in values.items()
    )
    return f'<Feature name="{FEATURE}">\n{properties}</Feature>\n'
