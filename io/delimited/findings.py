"""What a reader of survey points finds odd: places, elevations, numbers; told or refused."""

from __future__ import annotations

import re
from collections import Counter
from itertools import permutations
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.crs import METRE, Unit
from ...base.errors import CrsError, OptionError, ReadError
from ...base.sentences import FILE, counted, height
from ...tin.screening import describe_elevations
from .axes import are_named_plainly
from .cells import is_number, split_line
from .columns import COORDINATES, find_unit_word, list_names, names_coordinates
from .headerless import are_plausible_elevations, is_too_steep, measure_relief_and_extent
from .lines import COMMENT_PREFIXES
from .vocabulary import list_words

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from ...base.arrays import AnyArray, Float64Array, Int64Array
    from ...base.crs import CRS
    from ...tin.screening import AreaOfUse
    from .columns import Columns
    from .layout import Layout
    from .lines import TextLines
    from .table import Fault

_SHOWN = 5
_LARGEST_WHOLE = 1e15
"""Below, whole point numbers are written without an exponent or decimals."""
_SHOWN_NAME = 40
_STATISTICS = list_words("statistic")
_EXPONENT = re.compile(r"[-+]?[0-9](?:[.,](?P<decimals>[0-9]*))?[eE][+]?(?P<exponent>[0-9]{1,3})")
_SOME = 4_096
_FEW_POINTS = 3
_SAME_UNIT = 1e-3
"""Feet of either kind differ by 2e-6, any other two units by far more."""


def require_in_area(
    points: Float64Array,
    rows: Int64Array,
    columns: Columns,
    area: AreaOfUse | None,
    *,
    is_headed: bool = False,
) -> list[str]:
    """Say which points lie outside the area of use of their CRS.

    Parameters
    ----------
    points : (n, 3) float64 array
        As they are in the file.
    rows : (n,) int64 array
        Their lines, from 0.
    columns : Columns
    area : AreaOfUse or None
        None says nothing.
    is_headed : bool, optional
        Whether a header names the columns: where it does so in plain words, it is the CRS that
        must be wrong.

    Raises
    ------
    CrsError
        If most of them do, and with coordinates exchanged most would not.
    """
    if area is None:
        return []
    if area.is_local(points[:, :2]):  # which is told where the points are placed
        return []
    outside = area.find_outside(points[:, :2])
    if len(outside) == 0:
        return []
    if 2 * len(outside) > len(points):
        _require_no_exchange(points, columns, area, is_headed=is_headed)
    fits = area.covers(points[outside][:, [1, 0]])
    counts = len(points), len(outside), int(fits.sum())
    return [describe_outside(area, counts, rows[outside])]


def describe_outside(area: AreaOfUse, counts: tuple[int, int, int], rows: Int64Array) -> str:
    """Say that points lie outside an area of use.

    Parameters
    ----------
    area : AreaOfUse
    counts : tuple of int
        Points, those outside, and those of them that lie inside with coordinates exchanged.
    rows : (n,) int64 array
        Lines of the first points outside, from 0.
    """
    n_points, n_outside, n_fits = counts
    said = f"{_count(n_outside, n_points)} outside the area of use of {area.label}"
    if 2 * n_outside > n_points:
        return f"{said}: check that the CRS of the points is the right one."
    exchanged = f"; {_count(n_fits)} inside if exchanged" if n_fits else ""
    return f"{said} ({_name_lines(rows)}){exchanged}."


def require_one_header(
    faults: Sequence[Fault], lines: TextLines, delimiter: str, columns: Columns
) -> None:
    """Refuse a header among the bad rows that names the coordinates otherwise than they are taken.

    Raises
    ------
    ReadError
    """
    for fault in faults:
        cells = split_line(lines.decode_line(fault.line), delimiter)
        found = names_coordinates(cells)
        if found is not None and _differs(found, columns):
            taken = list_names([columns.label(columns.roles[role]) for role in COORDINATES])
            raise ReadError(
                f"{FILE}, line {fault.line + 1}: a header ({list_names(cells)}) names other "
                f"columns or units than easting, northing and elevation are taken from ({taken}): "
                "say with the option `columns` what they are, or read the parts of the file by "
                "themselves.",
                lines=[fault.line + 1],
            )


def _differs(found: Columns, columns: Columns) -> bool:
    """Whether a header names other columns or other units; one without units may repeat it."""
    has_units = bool(found.units) and dict(found.units) != dict(columns.units)
    return found.coordinates != columns.coordinates or has_units


def find_rounded_coordinates(
    lines: TextLines, rows: Int64Array, delimiter: str, columns: Columns
) -> list[str]:
    """Say which coordinates have an exponent that leaves tens or more open, as spreadsheets do."""
    found = []
    for row in rows[lines.find_with_exponents(rows)].tolist():
        cells = split_line(lines.decode_line(row), delimiter)
        cut = [cells[i] for i in columns.coordinates if i < len(cells) and _is_rounded(cells[i])]
        found += [(row + 1, cell) for cell in cut]
    if not found:
        return []
    line, cell = found[0]
    return [
        f"{counted(len(found), 'coordinate')} {'has' if len(found) == 1 else 'have'} an exponent "
        f"and no digits below the tens (line {line}: '{cell}'): check that no spreadsheet has "
        "rounded them."
    ]


def _is_rounded(cell: str) -> bool:
    found = _EXPONENT.fullmatch(cell)
    return found is not None and int(found["exponent"]) > len(found["decimals"] or "")


def find_commented_points(
    lines: TextLines, rows: Int64Array, layout: Layout, columns: Columns
) -> list[str]:
    """Say which lines that begin as comments do hold a point, as where its number is #12."""
    is_other = ~lines.is_blank
    is_other[rows - lines.first] = False
    found = []
    for line in lines.number(is_other)[:_SOME].tolist():
        text = lines.decode_line(line).strip()
        cells = split_line(text, layout.delimiter)
        is_row = len(cells) == layout.count and text.startswith(COMMENT_PREFIXES)
        if is_row and all(is_number(cells[i], layout.decimal) for i in columns.coordinates):
            found.append(line)
    if not found:
        return []
    what = "line that begins" if len(found) == 1 else "lines that begin"
    verb = "holds a point and is" if len(found) == 1 else "hold points and are"
    return [
        f"{len(found):,} {what} as comments do {verb} left out ({_name_lines(np.array(found))})."
    ]


def find_summary_rows(
    points: Float64Array, rows: Int64Array, names: Iterable[AnyArray | None]
) -> list[str]:
    """Say which rows are called like a statistic of the others, or are their sum."""
    notes = []
    for values in names:
        if values is None or values.dtype != object:
            continue
        found = [i for i, name in enumerate(values.tolist()) if _is_statistic(name)]
        if found:
            words = ", ".join(f"'{values[i]}'" for i in found[:_SHOWN])
            notes.append(
                f"{counted(len(found), 'row')} {'is' if len(found) == 1 else 'are'} read as points "
                f"and may be statistics of the others ({words}, {_name_lines(rows[found])})."
            )
    with np.errstate(over="ignore", invalid="ignore"):  # a sum may be beyond all doubles
        notes += describe_sum_row(points[:-1].sum(axis=0), points[-1:], rows[-1:], len(points))
    return notes


def describe_sum_row(
    total: Float64Array, last: Float64Array, row: Int64Array, count: int
) -> list[str]:
    """Say that the last of so many points, (1, 3), is the sum of all others, (3,)."""
    if count <= _FEW_POINTS or not np.allclose(total, last, rtol=1e-9):
        return []
    return [f"The last row (line {row[0] + 1}) is the sum of all others, and read as a point."]


def _is_statistic(name: str) -> bool:
    return name.strip(" :.").casefold() in _STATISTICS


def find_split_thousands(
    points: Float64Array, attributes: Mapping[str, AnyArray], delimiter: str
) -> list[str]:
    """Say which of the columns behind a layout may come of coordinates that commas have split."""
    is_head = ((points >= 0) & (points < 1000) & (points == np.floor(points))).all(axis=0)
    ends = [
        name
        for name, values in attributes.items()
        if values.dtype.kind in "iuf"
        and len(values)
        and bool(((values >= 0) & (values < 1000)).all())
    ]
    if delimiter != "," or not ends or not is_head.any():
        return []
    return [
        f"The layout does not name {list_names(ends)} (numbers below 1000, kept as attributes): if "
        "commas group thousands, check the columns and put quotes around such numbers."
    ]


def find_unit_words(attributes: Mapping[str, AnyArray]) -> list[str]:
    """Say which texts begin with a unit of length in most rows; where it differs, that it does."""
    notes = []
    for name, values in attributes.items():
        texts = [str(one) for one in values.tolist()] if values.dtype == object else []
        words = Counter(text.split(maxsplit=1)[0] for text in texts if text.strip())
        units = [word for word in words if find_unit_word(f"({word})") is not None]
        n_rows = sum(words[word] for word in units)
        if not units or 2 * n_rows <= words.total():
            continue
        shown = " or ".join(f"'{word}'" for word in units[:_SHOWN])
        place = "every row" if n_rows == len(texts) else f"{n_rows:,} of {len(texts):,} rows"
        advice = (
            "if this is the unit of the elevations, the option `elevation_unit` says so"
            if len(units) == 1
            else "if these are the units of the elevations, make them one"
        )
        notes.append(f"'{name[:_SHOWN_NAME]}' begins with {shown} in {place}: {advice}.")
    return notes


def _count(number: int, total: int = 0) -> str:
    of_all = f" of {counted(total, 'point')}" if total else ""
    return f"{number:,}{of_all} {'lies' if number == 1 else 'lie'}"


def _require_no_exchange(
    points: Float64Array, columns: Columns, area: AreaOfUse, *, is_headed: bool
) -> None:
    """Refuse points that lie in the area once their columns are exchanged."""
    orders = sorted(permutations(range(3)), key=lambda order: order != (1, 0, 2))
    for order in orders:
        moved = points[:, list(order)]
        if are_plausible_elevations(moved[:, 2]) and area.covers_most(moved[:, :2]):
            right = columns.permute(order)
            if is_headed and are_named_plainly(columns):
                raise CrsError(
                    f"the points lie outside the area of use of {area.label}, and would "
                    f"lie inside it if {columns.word} were {right.word}; the header says that they "
                    f"are not: check that {area.source.label} is the CRS of the points, or say "
                    "with the option `columns` what they are."
                )
            places = (
                f"{role} in {right.label(right.roles[role])}"
                for role in ("easting", "northing", "elevation")
            )
            raise CrsError(
                f"read as {columns.word} the points lie outside the area of use of "
                f"{area.label}, and read as {right.word} inside it: `columns='{right.word}'` takes "
                f"the {', the '.join(places)}."
            )


def require_unit_of_crs(columns: Columns, crs: CRS | None, *, is_stated: bool) -> list[str]:
    """Say where the header gives eastings and northings another unit than their CRS has.

    Parameters
    ----------
    columns : Columns
    crs : CRS or None
        Of the coordinates in the file.
    is_stated : bool
        Whether the caller has said what the columns are, against the header.
    """
    if crs is None:
        return _require_units_of_a_kind(columns, is_stated=is_stated)
    if crs.is_geographic:
        return []
    wanted = crs.horizontal_unit
    for role in ("easting", "northing"):
        unit = find_known_unit(columns.units.get(role))
        if unit is None or unit.metres is None or wanted.metres is None or unit == wanted:
            continue
        is_far = abs(unit.metres / wanted.metres - 1.0) > _SAME_UNIT
        sentence = (
            f"the header gives the {role} in {unit.name}, and {crs.label} measures in {wanted.name}"
        )
        if is_far and not is_stated:
            raise CrsError(
                f"{sentence}: the options `source_crs` and `crs` name the CRS that the "
                "points are in, and the one that they go to; `columns` tells the columns whatever "
                "the header says.",
                crs=crs,
            )
        return [f"{sentence[0].upper()}{sentence[1:]}, as which they are taken."]
    return []


def _require_units_of_a_kind(columns: Columns, *, is_stated: bool) -> list[str]:
    """Say where the header gives eastings another unit than elevations, or refuse it."""
    across, up = (find_known_unit(columns.units.get(role)) for role in ("easting", "elevation"))
    if across is None or across == (up or METRE):
        return []
    if up is not None and not is_stated:
        raise CrsError(
            f"the header gives the easting in {across.name} and the elevation in "
            f"{up.name}: the option `crs` names the CRS that the points are in, `columns` tells "
            "the columns whatever the header says."
        )
    if not is_stated and across.metres is not None and not 0.3 < across.metres <= 1.0:
        raise CrsError(
            f"the header gives the easting in {across.name}, in which elevations are not given: "
            "the option `crs` names the CRS that the points are in, `columns` tells the columns "
            "whatever the header says."
        )
    return [
        f"The header gives the easting in {across.name}, which is not kept where no CRS is named."
    ]


def find_known_unit(word: str | None) -> Unit | None:
    """Return the unit of length that a word names; None if it names none."""
    try:
        return Unit.of(word)
    except OptionError:
        return None


def find_odd_elevations(points: Float64Array, *, in_degrees: bool = False) -> list[str]:
    """Say whether elevations may stand for no data, or are none that the earth has.

    Parameters
    ----------
    points : (n, 3) float64 array
    in_degrees : bool, optional
        Whether they are known to lie in longitude and latitude, beside which all rises are steep.
    """
    z = points[:, 2]
    notes = describe_elevations(z)
    some = points[:: max(1, len(points) // _SOME)]
    relief, extent = measure_relief_and_extent(some)
    may_be_steep = len(points) >= _FEW_POINTS and not notes and not in_degrees
    if may_be_steep and is_too_steep(relief, extent):
        notes.append(
            f"The points rise by {relief:,.6g} within an extent of {extent:,.6g}: check the "
            "columns, and that eastings and northings are no degrees."
        )
    return notes


def require_ground(z: Float64Array, unit: Unit | None, *, is_free: bool) -> list[str]:
    """Refuse elevations that the earth does not have, or tell of them.

    Parameters
    ----------
    z : (n,) float64 array
    unit : Unit or None
        Metres or feet if it is not known.
    is_free : bool
        Whether they may be what they are: no CRS places them on the earth, or the caller or the
        format says which column is the elevation.
    """
    if len(z) == 0 or are_plausible_elevations(z, unit):
        return []
    low, high = np.percentile(z, [5, 95], method="nearest")
    sentence = f"most elevations lie between {height(low)} and {height(high)}, where no ground is"
    if is_free:
        return [f"{sentence[0].upper()}{sentence[1:]}: check the columns."]
    raise ReadError(
        f"{sentence}: say with the option `columns` what the columns are, or with the option "
        "`elevation_unit` the unit of the elevations."
    )


def find_repeated_numbers(numbers: AnyArray | None, rows: Int64Array) -> list[str]:
    """Say which point numbers occur more than once.

    Parameters
    ----------
    numbers : (n,) array or None
    rows : (n,) int64 array
        Lines of the points, from 0.
    """
    if numbers is None or len(numbers) < 2:
        return []
    if numbers.dtype.kind in "iu" and (numbers[1:] > numbers[:-1]).all():
        return []
    places: dict[Any, list[int]] = {}
    for row, number in enumerate(numbers.tolist()):
        if number != "" and number == number:  # no NaN
            places.setdefault(number, []).append(row)
    places = {number: at for number, at in places.items() if len(at) > 1}
    if not places:
        return []
    shown = "; ".join(
        f"{_format_value(one)} in {_name_lines(rows[at])}"
        for one, at in list(places.items())[:_SHOWN]
    )
    more = "; ..." if len(places) > _SHOWN else ""
    verb = "number occurs" if len(places) == 1 else "numbers occur"
    return [f"{len(places):,} point {verb} more than once: {shown}{more}."]


def _format_value(value: Any) -> str:
    """Write a point number in full: 12345678.0 as 12345678, for it names one point."""
    is_whole = isinstance(value, float) and value.is_integer() and abs(value) < _LARGEST_WHOLE
    return str(int(value)) if is_whole else str(value)


def describe_left_out(why: str, lines: Sequence[int]) -> str:
    """Say which points have been left out, and why; ``lines`` count from 1."""
    points = "point is" if len(lines) == 1 else "points are"
    return f"{len(lines):,} {points} left out, {why}: {_name_lines(np.asarray(lines) - 1)}."


def describe_faults(faults: Sequence[Fault]) -> str:
    """Say which bad rows have been left out, and what is wrong with the first of them."""
    shown = "; ".join(f"line {one.line + 1}: {one.what}" for one in faults[:_SHOWN])
    more = "; ..." if len(faults) > _SHOWN else ""
    rows = "row is" if len(faults) == 1 else "rows are"
    return f"{len(faults):,} bad {rows} left out ({shown}{more})."


def _name_lines(rows: Int64Array) -> str:
    """Name lines, counted from 1."""
    numbers = [f"{row + 1}" for row in rows[:_SHOWN].tolist()]
    more = ", ..." if len(rows) > _SHOWN else ""
    return f"line{'s' * (len(rows) > 1)} {', '.join(numbers)}{more}"
