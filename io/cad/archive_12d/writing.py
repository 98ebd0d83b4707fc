"""Write an archive of 12d Model: a tin and its lines, or the points and lines of a survey.

Triangles are clockwise, as 12d Model has them; lines are super strings with ``breakline line``,
points one with ``breakline point``. Attributes tell what a line is, beside its name.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ....base.atomic import replacing
from ....base.errors import FormatError
from ....base.sentences import FILE
from ....tin import TIN, Surface, Survey
from ...mesh import format_rows, list_chains
from ...registry import warn_of_lost_attributes
from ..drawing import choose_length_unit, choose_name, list_lines, scale_elevations
from ..surfaces import Line
from .names import CONSTRAINED, KIND, POLYGON, PRIORITY, SOURCE

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from ....base.arrays import Float64Array
    from ....base.progress import Tell

_COLOUR = {"tin": "green", "points": "yellow", "hard": "red", "soft": "orange", "water": "cyan"}
"""Colours of every project of 12d Model, by what has them; other lines are magenta."""


def write(
    obj: TIN | Survey,
    path: Path,
    *,
    name: str | None = None,
    progress: Tell | None = None,
) -> None:
    """Write a TIN with its lines, or the points and lines of a survey, as an archive of 12d Model.

    Parameters
    ----------
    name : str, optional
        Name of the tin and of the model of its strings; default its own, else "surface".

    Raises
    ------
    FormatError
        If it is neither a TIN nor a survey.
    OptionError
        If the name is no text.
    CrsError
        If coordinates are angles.

    Warns
    -----
    LossWarning
        If elevations are converted, as a project of 12d Model has one unit for all lengths, or
        attributes of points are left out.
    """
    if not isinstance(obj, Surface | Survey):
        raise FormatError(
            f"Cannot write {FILE}: a {type(obj).__name__} is neither a TIN nor a Survey."
        )
    quoted = _quote(choose_name(obj, name))
    factor = 1.0
    if obj.crs is not None:
        _, factor = choose_length_unit(obj, None, is_known=lambda _: True, format_name="12d Model")
    if isinstance(obj, Survey):
        warn_of_lost_attributes(obj.attributes, "the archive has strings of points without them")
    points = scale_elevations(obj.points, factor)
    tell = progress or _ignore
    with replacing(path, binary=False) as file:
        file.write(f"model {quoted}\n")
        if isinstance(obj, Surface):
            done, total = 0, len(points) + len(obj.triangles)
            for count, text in _format_tin(obj, points, quoted):
                file.write(text)
                done += count
                tell(done / total)
        elif len(points):
            file.write(_format_string(points, "points", "point", _COLOUR["points"], []))
        for line in list_lines(obj, factor):
            file.write(_format_line(line))
        for chain in list_chains(obj)[len(obj.lines) :] if isinstance(obj, Surface) else ():
            file.write(_format_line(Line(points[chain], CONSTRAINED)))
    tell(1.0)


def _ignore(done: float) -> None:
    """Tell nobody."""


def _format_tin(tin: TIN, points: Float64Array, name: str) -> Iterator[tuple[int, str]]:
    """Yield the text of a tin, with the count of points and triangles in each part."""
    yield 0, f"tin {{\n  name {name}\n  colour {_COLOUR['tin']}\n  points {{\n"
    yield from format_rows("    %r %r %r\n", points)
    yield 0, "  }\n  triangles {\n"
    yield from format_rows("    %d %d %d\n", tin.triangles[:, [0, 2, 1]].astype(np.int64) + 1)
    yield 0, "  }\n}\n"


def _format_line(line: Line) -> str:
    told = [("text", KIND, _quote(line.kind))] if line.kind != "hard" else []
    if line.source is not None:
        told.append(("integer", SOURCE, str(line.source)))
    if line.polygon is not None:
        told.append(("text", POLYGON, _quote(line.polygon)))
    if line.priority:
        told.append(("integer", PRIORITY, str(line.priority)))
    colour = _COLOUR.get(line.kind, "magenta")
    return _format_string(line.coordinates, line.name, "line", colour, told)


def _format_string(
    rows: Float64Array,
    name: str,
    breakline: str,
    colour: str,
    attributes: list[tuple[str, str, str]],
) -> str:
    n_columns = rows.shape[1]
    form = f"    {' '.join(['%r'] * n_columns)}\n"
    body = "".join(text for _, text in format_rows(form, rows))
    own = "".join(f'    {kind} "{key}" {value}\n' for kind, key, value in attributes)
    own = f"  attributes {{\n{own}  }}\n" if own else ""
    flat = "  z null\n" if n_columns == 2 else ""
    return (
        f"string super {{\n  name {_quote(name)}\n  colour {colour}\n  breakline {breakline}\n"
        f"{own}{flat}  data_{n_columns}d {{\n{body}  }}\n}}\n"
    )


def _quote(text: str) -> str:
    """Return a text in quotes, on one line."""
    plain = "".join(one if one.isprintable() else " " for one in text)
    plain = plain.encode("utf-8", "replace").decode("utf-8")
    return '"' + plain.replace("\\", "\\\\").replace('"', '\\"') + '"'
