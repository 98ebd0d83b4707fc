"""Inspect points: all that looks wrong with them, in one table, and a surface without it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

import numpy as np

from ...base.errors import LinesError, OptionError, PointsError
from ...base.products import product
from ...base.progress import Progress
from ...base.results import Table
from ...tin import TIN, Surface, Survey, triangulate
from ...tin.screening import DROPPED, describe_gaps, find_number, inspect_points, screen_points

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from ...base.arrays import Int32Array, Int64Array
    from ...base.progress import Tell
    from ...tin.screening import Suspect


@product
def blunders(points: Survey | TIN, *, progress: Callable[[float], None] | None = None) -> Table:
    """Check points: find those that look like blunders.

    Every point is compared with the surface that the others make without it, and with the scale of
    such residuals around it. Only points whose neighbours fit well once they are corrected are
    named: a kerb or a cliff is no blunder, for its points stand out together.

    Parameters
    ----------
    points : Survey or TIN
        Points, which are triangulated with their lines, or a TIN of them.
    progress : callable, optional
        Called with the fraction done, ascending to 1.0, between the stages and the rounds in which
        elevations are judged. What it raises ends the call.

    Returns
    -------
    Table
        The most certain first: ``row`` of the points, counted from 0 (-1 for what is about lines),
        ``number`` of the point (an empty text if it has none), ``file`` and ``line`` that it was
        read from, counted from 1 (an empty text and 0 if that is not known), ``x``, ``y``, ``z``;
        ``residual``, above the surface without any of these, and robust ``scale`` of residuals
        around it (NaN where no height is told); ``reason``, ``certainty`` ("high", "medium",
        "low") and an ``explanation`` in a sentence. Notes tell what cannot be told, and of gaps
        that the surface spans, with the ``max_edge`` that opens them.

        Reasons: "spike", "pit" (too high, too low), "code" (an elevation that stands for none, such
        as -9999), "factor" (ten times, a tenth, feet for metres), "swapped" (easting and northing),
        "isolated" (far from all others), "outside" (of the CRS's area of use), "line" (whose
        elevations the points around do not bear out), "void" (filled with an elevation that stands
        for none), "number" and "place" (that another row has, too), "crossing" (of lines at
        different elevations).

    Raises
    ------
    OptionError
        If the points are neither a Survey nor a TIN.
    PointsError, LinesError
        If they cannot be triangulated.

    Notes
    -----
    A blunder smaller than ten times the scale around it, twice that on lines and on the boundary,
    is not told from the ground; nor are three or more together. A single boulder, manhole or tree
    that was measured by one point is a spike, too. Some 5 s of processor time for 1 M points.

    Examples
    --------
    >>> import numpy as np
    >>> import tinsmith as ts
    >>> x, y = np.divmod(np.arange(100.0), 10)
    >>> z = 320 + 0.01 * x * y
    >>> z[33] += 3.0; z[58] *= 10
    >>> found = ts.blunders(ts.Survey(points=np.column_stack([x, y, z])))
    >>> found["row"], found["reason"].tolist(), found["residual"].round(1)
    (array([58, 33]), ['factor', 'spike'], array([2883.6,    3. ]))
    """
    done = Progress(progress)
    tin = _as_tin(points, done.stage(0.0, 0.3))
    found = inspect_points(tin, done.stage(0.3, 0.9))
    table = _tabulate(tin, found.suspects, [*found.notes, *describe_gaps(tin)])
    done.end()
    return table


def screen(tin: TIN) -> Table:
    """Look for blunders in little time: as :func:`blunders`, but of many points in part.

    Of more than 10,000 points only those further beyond all their neighbours than these are apart
    are judged, with scales from a sample; repeated numbers and places are left to others.
    """
    found = screen_points(tin)
    return _tabulate(tin, found.suspects, found.notes)


def _as_tin(points: Any, progress: Tell | None) -> TIN:
    if isinstance(points, Surface):
        return cast("TIN", points)  # which is asked alone
    if not isinstance(points, Survey):
        raise OptionError("points", points, "a Survey or a TIN")
    return triangulate(points, progress=progress)


def _tabulate(tin: TIN, suspects: Sequence[Suspect], notes: Sequence[str]) -> Table:
    rows = np.array([one.row for one in suspects], np.int64)
    places = np.array([one.place for one in suspects], np.float64).reshape(-1, 3)
    attributes, sources = tin.row_attributes, _find_sources(tin, rows)
    elevation = tin.elevation_unit
    length = None if tin.crs is None else tin.crs.horizontal_unit
    columns: dict[str, Any] = {
        "row": rows,
        "number": np.array([find_number(attributes, row) for row in rows.tolist()], object),
        "file": np.array([file for file, _ in sources], object),
        "line": np.array([line for _, line in sources], np.int64),
        **dict(zip("xyz", places.T, strict=True)),
        "residual": np.array([one.residual for one in suspects], np.float64),
        "scale": np.array([one.scale for one in suspects], np.float64),
        "reason": np.array([one.reason for one in suspects], object),
        "certainty": np.array([one.certainty for one in suspects], object),
        "explanation": np.array([one.explanation for one in suspects], object),
    }
    units = dict.fromkeys("xy", length) | dict.fromkeys(("z", "residual", "scale"), elevation)
    return Table(columns, units=units, name="blunders", notes=tuple(notes))


def _find_sources(tin: TIN, rows: Int64Array) -> list[tuple[str, int]]:
    """Return file and line of some rows; an empty text and 0 where they are not known."""
    sources = tin.report.row_sources
    return [("", 0) if sources is None else sources.find(row) for row in rows.tolist()]


def list_wrong_rows(table: Table) -> Int64Array:
    """Return the rows that are wrong by themselves, but for those of low certainty, ascending."""
    is_wrong = np.isin(table["reason"].astype(str), DROPPED)
    is_wrong &= table["certainty"].astype(str) != "low"
    rows: Int64Array = np.unique(table["row"][is_wrong])
    return rows


def drop_blunders(tin: TIN, table: Table) -> tuple[TIN, Int64Array]:
    """Remove the points from a TIN, in place, that look like blunders.

    ``table`` is one of :func:`tinsmith.blunders`. Those of low certainty stay, and those that only
    say that another row has the same number or place; a vertex that stands for other rows, too; and
    one without which a line would vanish. Returns the TIN, whose report gives the reason, and the
    rows that were left out, ascending.
    """
    rows = list_wrong_rows(table)
    vertex_of = tin.vertex_of
    vertices = np.unique(vertex_of[rows])
    shared = np.setdiff1d(np.flatnonzero(np.isin(vertex_of, vertices)), rows)
    vertices = np.setdiff1d(vertices, vertex_of[shared])
    if not _remove(tin, vertices):
        for vertex in vertices[::-1]:  # those behind a removed one move up
            _remove(tin, vertex[None])
    gone: Int64Array = rows[tin.vertex_of[rows] < 0]
    return tin.with_reason(gone, "looks like a blunder"), gone


def _remove(tin: TIN, vertices: Int32Array) -> bool:
    try:
        tin.remove(vertices)
    except (PointsError, LinesError):
        return False
    return True
