"""Search for all that looks wrong with the points of a TIN, in much time or in little."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..._progress import Progress
from ...errors import LinesError, PointsError
from .heights import STRICT, find_heights, find_peaks_and_pits
from .nodata import find_suspect_elevations, is_customary
from .parts import leave_out
from .places import find_places
from .records import find_crossings, find_repeated_numbers, find_repeated_places
from .slips import name_factor
from .suspects import CERTAINTIES, DROPPED, REASONS, Rows, Suspect

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ..._progress import Tell
    from ...arrays import Float64Array, Int32Array
    from ..surface import TIN
    from ..triangulation import Triangulation
    from .heights import Heights

__all__ = ["Screening", "inspect_points", "screen_points"]

_SAMPLE = 8_192
_FEW = 10_000
"""So many points are inspected as a whole where others are screened."""
_MOST_PEAKS = 0.02
"""Of the points: where more stand out they are the ground, or what grows on it."""


class Screening(NamedTuple):
    """What looks wrong with the points of a TIN."""

    suspects: tuple[Suspect, ...]
    """The most certain first; one reason of each row but for what other rows have, too."""
    notes: tuple[str, ...]
    """What cannot be told of single points."""


def inspect_points(tin: TIN, progress: Tell | None = None) -> Screening:
    """Judge every point of a TIN; what :func:`tinsmith.blunders` tells, but for gaps."""
    done = Progress(progress)
    rows = Rows.of(tin)
    misplaced, notes = find_places(rows, tin.crs)
    codes = _find_codes(rows)
    done(0.2)
    heights, scale = _inspect_heights(tin, misplaced, codes, done.stage(0.2, 0.9))
    done(0.9)
    suspects = [*misplaced, *codes, *heights]
    repeated, more = find_repeated_numbers(tin, rows)
    suspects += repeated
    suspects += find_repeated_places(tin, rows, scale)
    suspects += find_crossings(tin, scale, STRICT * scale)
    return _order(suspects, [*notes, *more])


def screen_points(tin: TIN) -> Screening:
    """Look for blunders in little time: as :func:`inspect_points`, but of many points in part.

    Of more than 10,000 points only those further beyond all their neighbours than these are apart
    are judged, with scales from a sample; repeated numbers and places are left to others.
    """
    rows = Rows.of(tin)
    misplaced, notes = find_places(rows, tin.crs)
    codes = _find_codes(rows)
    heights = _screen_heights(tin, rows, misplaced, codes)
    return _order([*misplaced, *codes, *heights], notes)


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


def _inspect_heights(
    tin: TIN, misplaced: Sequence[Suspect], codes: Sequence[Suspect], progress: Tell | None
) -> tuple[list[Suspect], float]:
    """Return the rows that are too high or too low, and the usual scale of residuals.

    What is in a wrong place is taken out first; what is a code has no say.
    """
    ground = _take_out(tin, misplaced)
    rows = Rows.of(ground)
    wrong = _find_vertices(rows, codes)
    every = np.arange(len(ground.points), dtype=np.int32)

    def interpolate_without(vertices: Int32Array) -> Float64Array:
        return _interpolate_without(ground, vertices)

    heights = find_heights(
        ground.triangulation, every, wrong, without=interpolate_without, progress=progress
    )
    return _judge_rows(ground.triangulation, rows, heights.found), heights.scale


def _screen_heights(
    tin: TIN, rows: Rows, misplaced: Sequence[Suspect], codes: Sequence[Suspect]
) -> list[Suspect]:
    """Return the rows that are too high or too low, of many points those that stand out most.

    Nothing is removed, but triangles at what is in a wrong place.
    """
    surface = leave_out(tin.triangulation, _find_vertices(rows, misplaced))
    count = len(surface.points)
    is_whole = count <= _FEW
    judged = np.arange(count, dtype=np.int32) if is_whole else find_peaks_and_pits(surface)
    if not is_whole and len(judged) > _MOST_PEAKS * count:
        return []
    sample = None if is_whole else _SAMPLE
    heights = find_heights(surface, judged, _find_vertices(rows, codes), sample=sample)
    return _judge_rows(surface, rows, heights.found)


def _find_vertices(rows: Rows, suspects: Sequence[Suspect]) -> Int32Array:
    """Return the vertices of some suspects that are among some rows."""
    numbers = np.unique([one.row for one in suspects]).astype(np.int64)
    numbers = numbers[np.isin(numbers, rows.numbers)]
    return np.unique(rows.vertices[np.searchsorted(rows.numbers, numbers)])


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


def _interpolate_without(tin: TIN, vertices: Int32Array) -> Float64Array:
    """Return the elevation at some vertices of the surface without them; NaN outside of it."""
    rest = tin.to_tin()
    try:
        rest.remove(vertices)
    except (PointsError, LinesError):  # what is left has no triangle, or a line goes through
        return np.full(len(vertices), np.nan)
    elevations: Float64Array = rest.interpolate(tin.points[vertices, :2])
    return elevations


def _judge_rows(surface: Triangulation, rows: Rows, found: Heights) -> list[Suspect]:
    """Return the rows of vertices that are too high or too low, each by its own elevation."""
    if len(found.vertices) == 0:
        return []
    place = np.searchsorted(found.vertices, rows.vertices)
    place = np.minimum(place, len(found.vertices) - 1)
    suspects = []
    for i in np.flatnonzero(found.vertices[place] == rows.vertices).tolist():
        at = int(place[i])
        own, limit = float(rows.xyz[i, 2]), float(found.limits[at])
        expected = float(surface.points[rows.vertices[i], 2] - found.residuals[at])
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


# ---------------------------------------------------------------- order


def _order(suspects: Sequence[Suspect], notes: Sequence[str]) -> Screening:
    return Screening(tuple(sorted(_choose_reasons(suspects), key=_rank)), tuple(notes))


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
