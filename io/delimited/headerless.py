"""The columns of a table without a header, told by what is in them.

Every customary layout that the columns could have is a candidate. What speaks against one is an
objection in words; the candidate without any is taken, and the objections to the others are the
reason. Where several are left a convention may decide, else the table is refused.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from ...base.crs import Unit
from ...base.errors import ReadError
from ...base.sentences import counted, inflect, shown
from ...tin.screening import find_suspect_elevations
from .columns import Columns, find_columns_by_word

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from ...base.arrays import Float64Array
    from ...tin.screening import AreaOfUse
    from .parsing import Column

_FOOT = 0.3048
_LOWEST, _HIGHEST = -37_000.0, 30_000.0
"""Feet of the deepest trench and the highest summit, in whatever unit: nothing lies beyond."""

_STEEPEST = 3.0
"""Relief over extent: no ground rises by more than 70 degrees from one end to the other."""

_SOME = 4_096
_FEW_ROWS = 3
_DISTINCT_SHARE = 0.5
_ODD_SHARE = 0.1
_DECIMAL_DIGITS = 4
_FEWEST_ROWS = 4
_SAME_STEP = 1e-6
_MOST_DIGITS = 6
_WRITTEN = 1e-4
"""Of the last decimal, how far a number may be from what is written with so many."""
_MOST_DEGREES, _MOST_MINUTES = 360.0, 60.0
_FEW_DEGREES = 3
_SHARE_OF_NUMBERS = 0.9
_WHOLE = re.compile(r"[+-]?[0-9]+([eE][+-]?[0-9]+)?")


@dataclass(frozen=True, slots=True)
class _Candidate:
    """A layout: its letters, the column of the first coordinate, and what speaks against it."""

    word: str
    start: int
    is_northing_first: bool
    objections: list[str] = field(default_factory=list)
    is_outside: bool = False

    @property
    def is_plausible(self) -> bool:
        return not self.objections and not self.is_outside

    def coordinates(self, columns: Sequence[Column]) -> Float64Array:
        """Return some of the points that it gives."""
        first, second, third = range(self.start, self.start + 3)
        order = (second, first, third) if self.is_northing_first else (first, second, third)
        step = max(1, len(columns[0].values) // _SOME)
        points = np.column_stack([columns[i].values[::step] for i in order])
        return points[np.isfinite(points).all(axis=1)]


def find_columns_by_content(
    columns: Sequence[Column],
    area: AreaOfUse | None,
    *,
    is_scan: bool = False,
    is_announced: bool = False,
    heading: str = "",
) -> tuple[Columns, str]:
    """Tell the columns by what is in them.

    Parameters
    ----------
    columns : sequence of Column
    area : AreaOfUse or None
        Where the points must lie, if their CRS is known.
    is_scan : bool
        Whether the suffix says that rows begin with x, y, z.
    is_announced : bool
        Whether a point count on top says it, too.
    heading : str
        Line near the table that speaks of coordinates, and does not say which columns they are.

    Returns
    -------
    columns : Columns
    note : str
        What they are taken for, and why.
    """
    if _are_angles_in_parts(columns):
        raise ReadError(
            "it has no header, and its columns may be degrees and minutes: tinsmith takes decimal "
            "degrees, or say with the option `columns` what they are."
        )
    candidates = _propose_layouts(columns)
    may_differ = len({one.start for one in candidates}) > 1
    for candidate in candidates:
        candidate.objections.extend(_find_objections(candidate, columns))
        if may_differ:
            candidate.objections.extend(_compare_columns(candidate, columns))
    candidates, agrees = _mark_outside(candidates, columns, area)
    left = [one for one in candidates if one.is_plausible]
    chosen, reason = _choose_customary(left, columns, is_scan=is_scan, is_announced=is_announced)
    doubt = heading and f"{heading} speaks of coordinates"
    if chosen is not None and not agrees and area is not None:
        doubt = doubt or f"as such they lie outside the area of use of {area.label}"
    if len(left) == 1:
        chosen, reason, doubt = left[0], _explain_choice(candidates, area), ""
    if chosen is None:
        raise ReadError(_describe_refusal(candidates, left, area))
    _require_no_doubt(chosen, columns, doubt)
    found = find_columns_by_word(chosen.word, [], len(columns))
    return found, f"No header: the columns are taken as {found.layout} ({chosen.word}){reason}."


def _require_no_doubt(chosen: _Candidate, columns: Sequence[Column], doubt: str) -> None:
    """Refuse x, y, z where they are but a convention that something speaks against."""
    if chosen.start == 0:
        doubt = doubt or _find_doubt(columns)
    if not doubt and _have_no_elevations(columns[chosen.start : chosen.start + 3]):
        doubt = "its elevations would be whole numbers beside coordinates with decimals"
    if doubt:
        raise ReadError(
            f"it has no header, and it is in doubt whether its columns are {chosen.word}, since "
            f"{doubt}: `columns='{chosen.word}'` says so, other letters or names what else they "
            "are."
        )


# ------------------------------------------------------------------ candidates


def _propose_layouts(columns: Sequence[Column]) -> list[_Candidate]:
    """Return the customary layouts that columns of numbers and text could have."""
    is_text = [column.is_text for column in columns]
    if len(columns) < 3 or len(columns) - sum(is_text) < 3:
        raise ReadError(_describe_too_few_numbers(columns))
    found: list[_Candidate] = []
    if len(columns) > 3 and not any(is_text[1:4]) and _may_number(columns[0]):
        found += _propose_both_orders(columns, 1)
    if not any(is_text[:3]):
        found += _propose_both_orders(columns, 0)
    if not found:
        raise ReadError(
            "it has no header, and its columns are not those of a known layout: say with the "
            "option `columns` what they are, for example `columns='PNEZD'`."
        )
    return found


def _describe_too_few_numbers(columns: Sequence[Column]) -> str:
    does = inflect(f"{counted(len(columns), 'column')} [does|do]", len(columns))
    sentence = f"its {does} not hold three of numbers: easting, northing and elevation are needed"
    texts = (
        f"column {i} has {shown(one.text)}" for i, one in enumerate(columns, start=1) if one.text
    )
    return "; ".join([sentence, *texts]) + "."


def _may_number(column: Column) -> bool:
    """Whether a column may number the points: by names, or whole numbers in any order."""
    return column.is_text or column.is_whole or column.is_padded


def _propose_both_orders(columns: Sequence[Column], start: int) -> Iterator[_Candidate]:
    first = "" if start == 0 else "P"
    if start == 1 and columns[0].is_text and columns[0].distinct_share < _DISTINCT_SHARE:
        first = "D"  # a few words again and again are codes
    text = next((i for i in range(start + 3, len(columns)) if columns[i].is_text), None)
    has_tail = text is not None and first != "D"
    tail = "-" * (text - start - 3) + "D" if text is not None and has_tail else ""
    yield _Candidate(f"{first}NEZ{tail}", start, is_northing_first=True)
    middle = "ENZ" if start else "XYZ"
    yield _Candidate(f"{first}{middle}{tail}", start, is_northing_first=False)


# ------------------------------------------------------------------ objections


def _find_objections(candidate: _Candidate, columns: Sequence[Column]) -> Iterator[str]:
    """Say what speaks against a layout, CRS aside."""
    points = candidate.coordinates(columns)
    used = columns[candidate.start : candidate.start + 3]
    if len(points) and not are_plausible_elevations(points[:, 2]):
        low, high = np.percentile(points[:, 2], [5, 95], method="nearest")
        yield f"would have elevations of {low:,.0f} to {high:,.0f}"
    if any(column.is_padded for column in used):
        yield "would have coordinates with leading zeros"
    if candidate.start == 0:
        yield from _find_signs_of_numbers(columns)


def _compare_columns(candidate: _Candidate, columns: Sequence[Column]) -> Iterator[str]:
    """Say what speaks against other columns; where only axes may be exchanged it tells nothing."""
    if any(one.text_share > _ODD_SHARE for one in columns[candidate.start : candidate.start + 3]):
        yield "would have coordinates that are no numbers"
    points = candidate.coordinates(columns)
    no_data = [one.value for one in find_suspect_elevations(points[:, 2])]
    points = points[~np.isin(points[:, 2], no_data)]
    relief, extent = measure_relief_and_extent(points)
    if is_too_steep(relief, extent):
        yield f"would rise by {relief:,.6g} within an extent of {extent:,.6g}"


def _find_signs_of_numbers(columns: Sequence[Column]) -> Iterator[str]:
    """Say what makes the first column one of point numbers, rather than of coordinates."""
    first, second = columns[0], columns[1]
    if not first.is_whole or len(first.values) < _FEW_ROWS:
        return
    others_divide = not second.is_whole and not columns[2].is_whole
    if first.counts_rows and (len(columns) > 3 or others_divide):
        yield "would have coordinates that count 1, 2, 3"
    elif len(columns) > 3 and not second.is_whole and first.distinct_share >= _DISTINCT_SHARE:
        yield "would have whole numbers in one coordinate and decimals in the other"


def are_plausible_elevations(z: Float64Array, unit: Unit | None = None) -> bool:
    """Whether at least half of some elevations are such as the earth has, in metres or feet."""
    if unit is not None and unit.metres is not None:
        z = z * (unit.metres / _FOOT)  # as feet are the smallest unit that limits are given in
    return bool(2 * ((z >= _LOWEST) & (z <= _HIGHEST)).sum() >= len(z))


def is_too_steep(relief: float, extent: float) -> bool:
    """Whether no ground rises by so much within an extent."""
    return relief > _STEEPEST * extent > 0.0


def measure_relief_and_extent(points: Float64Array) -> tuple[float, float]:
    """Return relief and extent, outliers aside."""
    if len(points) == 0:
        return 0.0, 0.0
    low, high = np.percentile(points, [5, 95], axis=0, method="nearest")
    with np.errstate(over="ignore", invalid="ignore"):
        span = high - low
        return float(span[2]), float(np.hypot(span[0], span[1]))


def _mark_outside(
    candidates: Sequence[_Candidate], columns: Sequence[Column], area: AreaOfUse | None
) -> tuple[list[_Candidate], bool]:
    """Find out which candidates lie outside the area of use; if all do, it tells nothing.

    And whether one lies inside.
    """
    if area is None:
        return list(candidates), False
    inside = [area.covers_most(one.coordinates(columns)[:, :2]) for one in candidates]
    if not any(inside):
        return list(candidates), False
    return [
        _Candidate(one.word, one.start, one.is_northing_first, one.objections, not is_in)
        for one, is_in in zip(candidates, inside, strict=True)
    ], True


# ------------------------------------------------------------------ the choice


def _choose_customary(
    left: Sequence[_Candidate], columns: Sequence[Column], *, is_scan: bool, is_announced: bool
) -> tuple[_Candidate | None, str]:
    """Return x, y, z where that is the convention: files that say so, and numbers alone."""
    xyz = next((one for one in left if one.start == 0 and not one.is_northing_first), None)
    if xyz is None or len(left) < 2:
        return None, ""
    is_numbered = any(one.start > 0 for one in left)
    first, second, third = (column.is_whole for column in columns[:3])
    if is_announced or (is_scan and (not is_numbered or (first == second != third))):
        return xyz, ", the convention for files of this kind"
    may_be_code = len(columns) in (4, 5) and columns[3].is_whole
    has_other = is_numbered or xyz.word != "XYZ" or may_be_code
    return (None, "") if has_other else (xyz, ", the convention for columns of numbers alone")


def _explain_choice(candidates: Iterable[_Candidate], area: AreaOfUse | None) -> str:
    """Say what speaks against the candidates that were not taken."""
    reasons: dict[str, list[str]] = {}
    for one in candidates:
        if not one.is_plausible:
            reasons.setdefault(_name_objection(one, area), []).append(one.word)
    clauses = [f"{_join_choices(words)} {why}" for why, words in reasons.items()]
    return f", since {_join_choices(clauses)}"


def _join_choices(words: Sequence[str]) -> str:
    """Join words with commas and an "and"."""
    return " and ".join(filter(None, (", ".join(words[:-1]), words[-1])))


def _name_objection(one: _Candidate, area: AreaOfUse | None) -> str:
    if one.is_outside and area is not None:
        return f"would lie outside the area of use of {area.label}"
    return one.objections[0]


def _describe_refusal(
    candidates: Sequence[_Candidate], left: Sequence[_Candidate], area: AreaOfUse | None
) -> str:
    """Say which layouts are plausible, or why none is, and what would settle it."""
    named = left or candidates
    settled = " or ".join(f"`columns='{one.word}'`" for one in named)
    if not left:
        faults = "; ".join(f"{one.word} {_name_objection(one, area)}" for one in candidates)
        return f"it has no header, and no customary layout fits: {faults}. Say which by {settled}."
    first = " (its first column may be point numbers)" if {one.start for one in left} > {0} else ""
    may_decide = "; the CRS of the points may decide, too" if area is None else ""
    return (
        f"it has no header, and its columns may be {' or '.join(one.word for one in left)}{first}: "
        f"say which by {settled}{may_decide}."
    )


# ------------------------------------------------------------------ doubts


def _find_doubt(columns: Sequence[Column]) -> str:
    """Say why the first three columns may not be x, y, z; "" if nothing speaks against it.

    Parameters
    ----------
    columns : sequence of Column
        At least three, the first three of numbers.
    """
    some = [_take_some(column) for column in columns[:4]]
    first, second, third = some[:3]
    if len(first) < _FEWEST_ROWS:
        return ""
    are_divided = [_count_digits(values) > 0 for values in some[:3]]
    is_scattered = _is_distinct(first) or _is_distinct(second)  # and no grid
    if _has_one_step(columns[0].values) and not _has_one_step(columns[1].values):
        step = columns[0].values[1] - columns[0].values[0]
        return (
            f"its first column grows by {step:.10g} from row to row, as numbers, distances and "
            "times do"
        )
    if is_scattered and are_divided[1:] == [True, True] and not are_divided[0]:
        return "its first column may be point numbers: all are whole, and the others have decimals"
    if are_divided == [True, True, False] and _is_monotone(columns[2].values):
        return "its third column may be point numbers: they are whole, and the others have decimals"
    if is_scattered and _count_digits(first) < _count_digits(second) == _count_digits(third):
        return "its first column has fewer decimals than the others, as no coordinate has"
    if len(some) == 4 and _is_monotone(columns[0].values) and _has_better_elevation(columns):
        return (
            "its first column grows from row to row, and its fourth is flatter than the third, so "
            "that easting and northing may be the second and third"
        )
    return ""


def _have_no_elevations(columns: Sequence[Column]) -> bool:
    """Whether the last of coordinates may be numbers or codes: whole, and the others divided.

    A grid may have such elevations.
    """
    some = [_take_some(column) for column in columns]
    if len(some[0]) < _FEWEST_ROWS or columns[2].is_text:
        return False
    digits = [_count_digits(values) for values in some]
    is_scattered = _is_distinct(some[0]) and _is_distinct(some[1])
    return min(digits[:2]) > 0 and digits[2] == 0 and is_scattered


def _are_angles_in_parts(columns: Sequence[Column]) -> bool:
    """Whether columns may be degrees, minutes and seconds, or degrees and minutes, twice."""
    for start in (0, 1):
        for size in (3, 2):
            parts = columns[start : start + 2 * size]
            is_whole = len(parts) == 2 * size and len(columns) > 2 * size + start - (size == 3)
            if is_whole and all(_is_angle(parts[k : k + size]) for k in (0, size)):
                return True
    return False


def _is_angle(columns: Sequence[Column]) -> bool:
    """Whether columns are whole degrees, whole minutes if seconds follow, and less than sixty."""
    if any(column.is_text for column in columns):
        return False
    degrees, *parts = (_take_some(column) for column in columns)
    if len(degrees) < 2 or any(len(one) == 0 for one in parts):
        return False
    are_degrees = _count_digits(degrees) == 0 and np.abs(degrees).max() <= _MOST_DEGREES
    are_near = len(np.unique(degrees)) <= _FEW_DEGREES
    are_parts = all(((one >= 0) & (one < _MOST_MINUTES)).all() for one in parts)
    are_whole = all(_count_digits(one) == 0 for one in parts[:-1])
    return bool(are_degrees and are_near and are_parts and are_whole and _count_digits(parts[-1]))


def _take_some(column: Column) -> Float64Array:
    values = column.values[:: max(1, len(column.values) // _SOME)]
    return values[np.isfinite(values)]


def _count_digits(values: Float64Array) -> int:
    """Return with how many decimals numbers are written."""
    for digits in range(_MOST_DIGITS):
        scaled = values * 10.0**digits
        with np.errstate(invalid="ignore", over="ignore"):
            if (np.abs(scaled - np.round(scaled)) < _WRITTEN).all():
                return digits
    return _MOST_DIGITS


def _is_distinct(values: Float64Array) -> bool:
    return len(np.unique(values)) >= _SHARE_OF_NUMBERS * len(values)


def _has_one_step(values: Float64Array) -> bool:
    steps = np.diff(values)
    if len(steps) < _FEWEST_ROWS - 1 or not np.isfinite(steps).all() or steps[0] == 0.0:
        return False
    rounding = 4.0 * np.finfo(np.float64).eps * np.abs(values).max()
    return bool((np.abs(steps - steps[0]) <= _SAME_STEP * abs(steps[0]) + rounding).all())


def _is_monotone(values: Float64Array) -> bool:
    steps = np.diff(values)
    return bool((steps > 0).all() or (steps < 0).all())


def _has_better_elevation(columns: Sequence[Column]) -> bool:
    """Whether the fourth column is a flatter surface over the two before than the third is."""
    if columns[3].is_text:
        return False
    table = np.column_stack([column.values for column in columns[:4]])
    table = table[np.isfinite(table).all(axis=1)]
    if len(table) < _FEWEST_ROWS or _count_digits(table[:, 3]) == 0:
        return False
    span = np.ptp(table, axis=0)
    return bool(span[3] * np.hypot(span[0], span[1]) < span[2] * np.hypot(span[1], span[2]))


# ------------------------------------------------------------------ commas


def require_no_split_decimals(body: Sequence[Sequence[str]], delimiter: str) -> None:
    """Refuse rows that may be decimal commas split at a comma: 4,25,7,50 for 4.25 and 7.50."""
    if delimiter != "," or not body:
        return
    numbers = [i for i in range(len(body[0])) if all(_WHOLE.fullmatch(row[i]) for row in body)]
    start = len(numbers) - 6
    if start not in (0, 1) or numbers != list(range(len(numbers))):
        return
    if all(_may_be_decimals(row[start + i]) for row in body for i in (1, 3, 5)):
        raise ReadError(
            "its commas may be delimiters or decimal marks: say with the option `columns` what the "
            "columns are, or write the table with another delimiter."
        )


def _may_be_decimals(cell: str) -> bool:
    """Whether a whole number looks like what stands behind a decimal comma."""
    return len(cell) <= _DECIMAL_DIGITS or "e" in cell.lower()
