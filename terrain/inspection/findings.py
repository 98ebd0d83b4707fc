"""Inspect points: all that looks wrong with them, in one table."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ..._products import product
from ..._progress import Progress
from ..._sentences import counted
from ...errors import LinesError, OptionError, PointsError
from ...tin import TIN, Surface, Survey, triangulate
from ..results import Table
from .gaps import describe_gaps
from .heights import STRICT, find_heights, find_peaks_and_pits
from .nodata import find_suspect_elevations, is_customary
from .places import find_places
from .records import find_crossings, find_repeated_numbers, find_repeated_places
from .slips import name_factor
from .suspects import CERTAINTIES, REASONS, Rows, Suspect

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from ..._progress import Tell
    from ...arrays import AnyArray, Int64Array
    from .heights import Heights

__all__ = ["DROPPED", "blunders", "describe_findings", "screen"]

DROPPED = ("outside", "swapped", "factor", "isolated", "code", "spike", "pit")
"""Reasons for which a point may be left out; other ones leave open which point is wrong."""

_SAMPLE = 8_192
_FEW = 10_000
"""So many points are inspected as a whole where others are screened."""
_MOST_PEAKS = 0.02
"""Of the points: where more stand out they are the ground, or what grows on it."""


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
        The most certain first: ``row`` of the points, counted from 0 (-1 for a crossing of lines),
        ``number`` of the point (an empty text if it has none), ``x``, ``y``, ``z``; ``residual``,
        above the surface without any of these, and robust ``scale`` of residuals around it (NaN
        where no height is told); ``reason``, ``certainty`` ("high", "medium", "low") and an
        ``explanation`` in a sentence. Notes tell what cannot be told, and a ``max_edge`` that
        trims slivers along the boundary.

        Reasons: "spike", "pit" (too high, too low), "code" (an elevation that stands for none, such
        as -9999), "factor" (ten times, a tenth, feet for metres), "swapped" (easting and northing),
        "isolated" (far from all others), "outside" (of the CRS's area of use), "number" and "place"
        (that another row has, too), "crossing" (of lines at different elevations).

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
    rows = Rows.of(tin)
    suspects, notes = find_places(rows, tin.crs)
    codes = _find_codes(rows)
    done(0.4)
    heights, scale = _find_heights(tin, suspects, codes, progress=done.stage(0.4, 0.8))
    done(0.8)
    suspects += [*codes, *heights]
    repeated, more = find_repeated_numbers(tin, rows)
    suspects += repeated
    suspects += find_repeated_places(tin, rows, scale)
    suspects += find_crossings(tin, scale, STRICT * scale)
    table = _tabulate(tin, suspects, [*notes, *more, *describe_gaps(tin)])
    done.end()
    return table


def screen(tin: TIN) -> Table:
    """Look for blunders in little time: as :func:`blunders`, but of many points in part.

    Of more than 10,000 points only those further beyond all their neighbours than these are apart
    are judged, with scales from a sample; repeated numbers and places are left to others.
    """
    rows = Rows.of(tin)
    suspects, notes = find_places(rows, tin.crs)
    codes = _find_codes(rows)
    heights, _ = _find_heights(tin, suspects, codes, is_whole=len(tin.points) <= _FEW)
    return _tabulate(tin, [*suspects, *codes, *heights], notes)


def describe_findings(tin: Surface) -> tuple[str, ...]:
    """Say what looks wrong with a surface, in little time: blunders and gaps."""
    table = screen(tin)
    is_wrong = np.isin(table["reason"].astype(str), DROPPED)
    is_wrong &= table["certainty"].astype(str) != "low"
    count = int(is_wrong.sum())
    told = [f"{counted(count, 'point')} may be blunders."] if count else []
    return (*told, *table.notes, *describe_gaps(tin))


def _as_tin(points: Any, progress: Tell | None) -> TIN:
    if isinstance(points, Surface):
        return points
    if not isinstance(points, Survey):
        raise OptionError("points", points, "a Survey or a TIN")
    return triangulate(points, progress=progress)


# ---------------------------------------------------------------- elevations


def _find_codes(rows: Rows) -> list[Suspect]:
    """Find elevations that stand for none."""
    found = []
    for one in find_suspect_elevations(rows.xyz[:, 2]):
        sentence = (
            f"An elevation of {one.value:g} may stand for none: the others are "
            f"{one.lowest:g} to {one.highest:g}."
        )
        for i in np.flatnonzero(rows.xyz[:, 2] == one.value).tolist():
            found.append(rows.suspect(i, "code", sentence, "high"))
    return found


def _find_heights(
    tin: TIN,
    misplaced: Sequence[Suspect],
    codes: Sequence[Suspect],
    *,
    is_whole: bool = True,
    progress: Tell | None = None,
) -> tuple[list[Suspect], float]:
    """Return the rows that are too high or too low, and the usual scale of residuals.

    What is in a wrong place is taken out first; what is a code has no say.
    """
    ground = _take_out(tin, misplaced)
    rows = Rows.of(ground)
    numbers = np.unique([one.row for one in codes]).astype(np.int64)
    numbers = numbers[np.isin(numbers, rows.numbers)]
    wrong = np.unique(rows.vertices[np.searchsorted(rows.numbers, numbers)])
    count = len(ground.points)
    judged = np.arange(count, dtype=np.int32) if is_whole else find_peaks_and_pits(ground)
    if not is_whole and len(judged) > _MOST_PEAKS * count:
        return [], np.nan
    sample = None if is_whole else _SAMPLE
    heights = find_heights(ground, judged, wrong, sample=sample, progress=progress)
    return _judge_rows(ground, rows, heights.found), heights.scale


def _take_out(tin: TIN, misplaced: Sequence[Suspect]) -> TIN:
    vertices = np.unique(tin.vertex_of[[one.row for one in misplaced]]) if misplaced else ()
    if len(vertices) == 0:
        return tin
    ground = tin.to_tin()
    try:
        ground.remove(vertices)
    except (PointsError, LinesError):  # no triangle would be left, or a line would vanish
        return tin
    return ground


def _judge_rows(tin: TIN, rows: Rows, found: Heights) -> list[Suspect]:
    """Return the rows of vertices that are too high or too low, each by its own elevation."""
    if len(found.vertices) == 0:
        return []
    place = np.searchsorted(found.vertices, rows.vertices)
    place = np.minimum(place, len(found.vertices) - 1)
    suspects = []
    for i in np.flatnonzero(found.vertices[place] == rows.vertices).tolist():
        at = int(place[i])
        own, limit = float(rows.xyz[i, 2]), float(found.limits[at])
        expected = float(tin.points[rows.vertices[i], 2] - found.residuals[at])
        if abs(own - expected) > limit:
            told = _describe_height(own, expected, limit)
            one = rows.suspect(i, *told, _rate(abs(own - expected) / limit))
            scale = float(found.scales[at])
            suspects.append(one._replace(residual=own - expected, scale=scale))
    return suspects


def _describe_height(z: float, expected: float, limit: float) -> tuple[str, str]:
    """Return reason and sentence for an elevation that does not fit."""
    if is_customary(z):
        return "code", f"It may stand for none: the points around it give {expected:.6g}."
    words = name_factor(z, expected, limit)
    if words is not None:
        return "factor", f"It is {words} the {expected:.6g} that the points around it give."
    side = "above" if z > expected else "below"
    return (
        "spike" if z > expected else "pit",
        f"It is {abs(z - expected):.4g} {side} the surface of the points around it.",
    )


def _rate(times: float) -> str:
    return "high" if times > 3.0 else "medium" if times > 1.5 else "low"


# ---------------------------------------------------------------- the table


def _tabulate(tin: TIN, suspects: Sequence[Suspect], notes: Sequence[str]) -> Table:
    """Return suspects as a table, one reason of each row but for what others have, too."""
    ordered = sorted(_choose_reasons(suspects), key=_rank)
    rows = np.array([one.row for one in ordered], np.int64)
    places = np.array([one.place for one in ordered], np.float64).reshape(-1, 3)
    elevation = tin.elevation_unit
    length = None if tin.crs is None else tin.crs.horizontal_unit
    columns: dict[str, Any] = {
        "row": rows,
        "number": _find_numbers(tin, rows),
        **dict(zip("xyz", places.T, strict=True)),
        "residual": np.array([one.residual for one in ordered], np.float64),
        "scale": np.array([one.scale for one in ordered], np.float64),
        "reason": np.array([one.reason for one in ordered], object),
        "certainty": np.array([one.certainty for one in ordered], object),
        "explanation": np.array([one.explanation for one in ordered], object),
    }
    units = dict.fromkeys("xy", length) | dict.fromkeys(("z", "residual", "scale"), elevation)
    return Table(columns, units=units, name="blunders", notes=tuple(notes))


def _choose_reasons(suspects: Sequence[Suspect]) -> list[Suspect]:
    """Return one suspect of each row and kind: what is wrong with it, or what others have, too."""
    chosen: dict[Any, Suspect] = {}
    for one in sorted(suspects, key=lambda one: REASONS.index(one.reason)):
        kind = "wrong" if one.reason in DROPPED else one.reason
        chosen.setdefault((one.row, kind) if one.row >= 0 else one.place, one)
    return list(chosen.values())


def _rank(one: Suspect) -> tuple[Any, ...]:
    times = abs(one.residual) / one.scale if one.scale > 0 else 0.0
    return (CERTAINTIES.index(one.certainty), -times, one.row, REASONS.index(one.reason), one.place)


def _find_numbers(tin: TIN, rows: Int64Array) -> AnyArray:
    numbers = tin.row_attributes.get("number")
    found = np.full(len(rows), "", object)
    if numbers is not None:
        found[:] = ["" if row < 0 else str(numbers[row]) for row in rows.tolist()]
    return found
