"""Search for all that looks wrong with the points of a TIN, in much time or in little."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...base.crs import assume_elevation_unit
from ...base.errors import LinesError, PointsError
from ...base.progress import Progress
from ...base.sentences import counted, height, inflect
from .. import _kernel
from ..topology import find_boundary_vertices
from .heights import STRICT, Heights, find_heights
from .nodata import find_suspect_elevations, is_customary
from .parts import find_clustered, leave_out
from .places import find_places
from .records import find_crossings, find_repeated_numbers, find_repeated_places
from .slips import find_multiplied, name_factor
from .suspects import CERTAINTIES, DROPPED, REASONS, Rows, Suspect, list_overruled_points
from .voids import find_voids
from .wrong_lines import find_wrong_lines, fit_ground, mark_rings, name_lines_at

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ...base.arrays import BoolArray, Float64Array, Int32Array
    from ...base.progress import Tell
    from ..surface import TIN
    from ..triangulation import Triangulation
    from .voids import Void
    from .wrong_lines import WrongLine

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


class _Ground(NamedTuple):
    """What is left of a surface without what is wrong as a whole, and what that is."""

    surface: Triangulation
    """Without triangles at vertices of wrong lines, filled voids and the like."""
    rows: Rows
    wrong: Int32Array
    """Single vertices within it whose elevations count for nothing."""
    marked: Int32Array
    """Those and others of the kind."""
    suspects: list[Suspect]
    is_whole: bool
    """Whether no triangles were left out."""


def inspect_points(tin: TIN, progress: Tell | None = None) -> Screening:
    """Judge every point of a TIN; what :func:`tinsmith.blunders` tells, but for gaps."""
    done = Progress(progress)
    with np.errstate(all="ignore"):
        rows = Rows.of(tin)
        misplaced, notes = find_places(rows, tin.crs)
        done(0.2)
        rest = _take_out(tin, misplaced)
        ground = _find_ground(rest, Rows.of(rest), ())
        without = partial(_interpolate_without, rest, others=ground.wrong)
        every = np.arange(len(ground.surface.points), dtype=np.int32)
        heights = find_heights(
            ground.surface,
            every,
            ground.wrong,
            without=without if ground.is_whole else None,
            progress=done.stage(0.2, 0.9),
        )
        suspects = [*misplaced, *ground.suspects, *_judge_vertices(rest, ground, heights.found)]
        done(0.9)
        repeated, more = find_repeated_numbers(tin, rows)
        suspects += repeated
        suspects += find_repeated_places(tin, rows, heights.scale)
        suspects += find_crossings(tin, heights.scale, STRICT * heights.scale)
    return _order(suspects, [*notes, *more])


def screen_points(tin: TIN) -> Screening:
    """Look for blunders in little time: as :func:`inspect_points`, but of many points in part.

    Of more than 10,000 points only those further beyond all their neighbours than these are apart
    are judged, with scales from a sample; repeated numbers and places are left to others. Nothing
    is removed from the TIN meanwhile, but triangles are looked away from.
    """
    with np.errstate(all="ignore"):
        rows = Rows.of(tin)
        misplaced, notes = find_places(rows, tin.crs)
        ground = _find_ground(tin, rows, _find_vertices(rows, misplaced))
        surface, count = ground.surface, len(ground.surface.points)
        is_small, heights = count <= _FEW, []
        judged = np.arange(count, dtype=np.int32)
        if not is_small:
            judged = _kernel.find_peaks_and_pits(surface.points, surface.triangles)
        if is_small or len(judged) <= _MOST_PEAKS * count:
            sample = None if is_small else _SAMPLE
            found = find_heights(surface, judged, ground.wrong, sample=sample).found
            heights = _judge_vertices(tin, ground, found)
    return _order([*misplaced, *ground.suspects, *heights], notes)


# ---------------------------------------------------------------- what is wrong as a whole


def _find_ground(tin: TIN, rows: Rows, misplaced: Sequence[int] | Int32Array) -> _Ground:
    """Find codes, groups in another unit, filled voids and wrong lines, and leave them out."""
    surface = leave_out(tin.triangulation, misplaced)
    suspects = _find_marks(rows)
    marked = _find_vertices(rows, suspects)
    surface, wrong = _leave_out_unless_alone(surface, marked)
    voids = find_voids(surface)
    filled = np.concatenate([np.empty(0, np.int32), *(void.vertices for void in voids)])
    surface = leave_out(surface, filled)
    lines = _find_wrong_lines(tin, surface, rows, marked)
    off = [line.vertices for line in lines if line.certainty != "low"]
    surface = leave_out(surface, np.concatenate([np.empty(0, np.int32), *off]))
    surface, wrong = _leave_out_unless_alone(surface, wrong)
    suspects += [_tell_void(tin, rows, void) for void in voids]
    suspects += [_tell_line(tin, line) for line in lines]
    is_whole = surface is tin.triangulation
    return _Ground(surface, rows, wrong, marked, suspects, is_whole)


def _leave_out_unless_alone(
    surface: Triangulation, vertices: Int32Array
) -> tuple[Triangulation, Int32Array]:
    """Leave vertices out that lie together or on the boundary; return the others, too.

    The elevation of a vertex alone within the surface can be corrected by its neighbours.
    """
    if len(vertices) == 0:
        return surface, vertices
    count = len(surface.points)
    on_rim = find_boundary_vertices(surface.triangles, surface.neighbors, count)
    together = np.union1d(find_clustered(surface, vertices), vertices[on_rim[vertices]])
    alone = np.setdiff1d(vertices, together).astype(np.int32)
    return leave_out(surface, together), alone


def _find_marks(rows: Rows) -> list[Suspect]:
    """Find elevations that stand for none, or are in another unit than most."""
    z = rows.xyz[:, 2]
    found = []
    chosen = np.ones(len(z), np.bool_)
    multiplied = find_multiplied(z)
    if multiplied is not None:
        chosen = ~multiplied.is_wrong
        sentence = (
            f"Its elevation is {multiplied.words} those of the others, "
            f"{height(multiplied.lowest)} to {height(multiplied.highest)}."
        )
        for i in np.flatnonzero(multiplied.is_wrong).tolist():
            found.append(rows.suspect(i, "factor", sentence, "high"))
    for one in find_suspect_elevations(z[chosen]):
        sentence = (
            f"An elevation of {one.value:g} may stand for none: the others are "
            f"{height(one.lowest)} to {height(one.highest)}."
        )
        for i in np.flatnonzero(z == one.value).tolist():
            found.append(rows.suspect(i, "code", sentence, "high"))
    return found


def _find_wrong_lines(
    tin: TIN, surface: Triangulation, rows: Rows, marked: Int32Array
) -> list[WrongLine]:
    """Find lines that the points on none of them do not bear out."""
    lines = tin.lines
    if len(lines) == 0:
        return []
    is_point = np.zeros(len(surface.points), np.bool_)
    is_point[rows.vertices] = True
    has_row = is_point.copy()
    is_point[marked] = False
    is_point[lines.vertices] = False
    known = list_overruled_points(tin.report)
    unit = assume_elevation_unit(tin.crs, tin.elevation_unit)
    metre = 1.0 if unit is None or unit.metres is None else 1.0 / unit.metres
    return find_wrong_lines(surface, lines, is_point, has_row, known, metre=metre)


def _tell_void(tin: TIN, rows: Rows, void: Void) -> Suspect:
    at = np.flatnonzero(np.isin(rows.vertices, void.vertices))
    sentence = (
        f"{len(void.vertices):,} points that lie together have the elevation "
        f"{height(void.value)}, and "
        f"{height(void.lowest)} to {height(void.highest)} is all around: it may stand for none."
    )
    if len(at):
        return rows.suspect(int(at[0]), "void", sentence, "medium")
    place = tuple(tin.points[void.vertices[0]].tolist())
    return Suspect(-1, place, "void", sentence, "medium")


def _tell_line(tin: TIN, line: WrongLine) -> Suspect:
    name = line.name[:1].upper() + line.name[1:]
    count = len(line.vertices)
    which = "all" if count == line.n_vertices else f"{count:,} of"
    words = inflect(line.words, count)
    vertices = counted(line.n_vertices, "vertex", "vertices")
    sentence = (
        f"{name}: {which} {vertices} {words}; the points around give {height(line.lowest)} to "
        f"{height(line.highest)}."
    )
    place = tuple(tin.points[line.worst].tolist())
    return Suspect(
        -1, place, "line", sentence, line.certainty, line.offset, line.limit / STRICT, line.name
    )


# ---------------------------------------------------------------- elevations


def _find_vertices(rows: Rows, suspects: Sequence[Suspect]) -> Int32Array:
    """Return the vertices of some suspects that are among some rows, ascending."""
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


def _interpolate_without(tin: TIN, vertices: Int32Array, others: Int32Array) -> Float64Array:
    """Return the elevation at vertices of the surface without these and others; NaN outside."""
    rest = tin.to_tin()
    try:
        rest.remove(np.union1d(vertices, others))
    except (PointsError, LinesError):  # what is left has no triangle, or a line goes through
        return np.full(len(vertices), np.nan)
    elevations: Float64Array = rest.interpolate(tin.points[vertices, :2])
    return elevations


def _judge_vertices(tin: TIN, ground: _Ground, found: Heights) -> list[Suspect]:
    """Return the rows of vertices that are too high or too low, and vertices of lines alone."""
    if len(found.vertices) == 0:
        return []
    has_row = np.isin(found.vertices, ground.rows.vertices)
    is_confirmed = _confirm_beside_rings(tin, ground, found.vertices)
    clear = is_confirmed & has_row
    confirmed = found.choose(clear)
    return [
        *(_judge_rows(ground, confirmed) if clear.any() else ()),
        *_judge_vertices_of_lines(tin, ground.surface, found, is_confirmed & ~has_row),
    ]


def _confirm_beside_rings(tin: TIN, ground: _Ground, vertices: Int32Array) -> BoolArray:
    """Tell which vertices stay wrong where rings without points beside them are not looked at.

    Draped rings are made of the surface, which near its hull may be far from the ground.
    """
    stays = np.ones(len(vertices), np.bool_)
    lines = tin.lines
    if len(lines) == 0:
        return stays
    surface = ground.surface
    is_point = np.zeros(len(surface.points), np.bool_)
    is_point[ground.rows.vertices] = True
    is_point[ground.marked] = False
    is_ring = mark_rings(lines, len(surface.points)) & ~is_point
    beside = is_ring[surface.triangles].any(axis=1)
    is_near = np.zeros(len(surface.points), np.bool_)
    is_near[surface.triangles[beside]] = True
    at = np.flatnonzero(is_near[vertices])
    expected, limits, _ = fit_ground(surface, vertices[at], is_point)
    stays[at] = np.abs(surface.points[vertices[at], 2] - expected) > limits
    return stays


def _judge_rows(ground: _Ground, found: Heights) -> list[Suspect]:
    """Return the rows of vertices that are too high or too low, each by its own elevation."""
    rows, surface = ground.rows, ground.surface
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


def _judge_vertices_of_lines(
    tin: TIN, surface: Triangulation, found: Heights, chosen: BoolArray
) -> list[Suspect]:
    """Return vertices that are on lines alone, and too high or too low."""
    suspects = []
    at = np.flatnonzero(chosen)
    names = name_lines_at(tin.lines, found.vertices[at])
    for i, name in zip(at.tolist(), names, strict=True):
        place = tuple(surface.points[found.vertices[i]].tolist())
        own, residual, limit = place[2], float(found.residuals[i]), float(found.limits[i])
        _, sentence = _describe_height(own, own - residual, limit)
        subject = f"A vertex of {name}: " if name else "A vertex of no point: "
        certainty, scale = _rate(abs(residual) / limit), float(found.scales[i])
        suspects.append(
            Suspect(-1, place, "line", subject + sentence, certainty, residual, scale, name)
        )
    return suspects


def _describe_height(z: float, expected: float, limit: float) -> tuple[str, str]:
    """Return reason and sentence for an elevation that does not fit."""
    if is_customary(z):
        return "code", f"It may stand for none: the points around it give {height(expected)}."
    words = name_factor(z, expected, limit)
    if words is not None:
        return "factor", f"It is {words} the {height(expected)} that the points around it give."
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
        place = () if one.row >= 0 else (*one.place, one.line)
        chosen.setdefault((one.row, kind, *place), one)
    return list(chosen.values())


def _rank(one: Suspect) -> tuple[Any, ...]:
    times = abs(one.residual) / one.scale if one.scale > 0 else 0.0
    return (CERTAINTIES.index(one.certainty), -times, one.row, REASONS.index(one.reason), one.place)
