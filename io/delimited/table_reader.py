"""The table of a text file, read block by block; one block is the whole of a small file.

The first block decides what the columns are, and where the points lie. What is told of all rows is
gathered until the end.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...base.crs import CRS, Unit
from ...base.errors import ReadError
from ...base.sentences import counted
from ...tin.screening import AreaOfUse, parse_nodata
from ..registry import StreamEnd
from ..reprojection import Placing, is_geographic, settle_unit
from .axes import require_no_geocentric, require_one_hemisphere, settle_axes
from .findings import (
    describe_faults,
    describe_left_out,
    describe_outside,
    describe_sum_row,
    find_commented_points,
    find_known_unit,
    find_odd_elevations,
    find_repeated_numbers,
    find_rounded_coordinates,
    find_split_thousands,
    find_summary_rows,
    find_unit_words,
    require_ground,
    require_in_area,
    require_one_header,
    require_unit_of_crs,
)
from .format_comments import find_axes_line, find_unit_line
from .headerless import find_columns_by_content
from .layout import LayoutOptions, continue_layout, find_layout, require_announced
from .table import (
    describe_columns,
    describe_faults_of_rows,
    leave_out_cut_row,
    read_cells,
    read_table,
    require_one_mark,
)

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ...base.arrays import AnyArray, BoolArray, Float64Array, Int64Array
    from ...base.crs import CrsLike, UnitLike
    from ...base.progress import Tell
    from .columns import Columns
    from .layout import Layout
    from .lines import TextLines
    from .table import Cells, Fault, Table

_WGS84 = "EPSG:4326"
_SOME = 4_096
"""Points of each block that the elevations and places of all are judged by."""

_MOST_KEPT = 1 << 18
"""Such points of all blocks; of more every other one is kept."""

_MOST_NOTES = 20
"""Notes of single blocks that are told."""


@dataclass(frozen=True, slots=True)
class Asked(LayoutOptions):
    """The options of :func:`read`."""

    crs: CrsLike | None = None
    elevation_unit: UnitLike | None = None
    encoding: str | None = None
    source_crs: CrsLike | None = None
    nodata: float | Sequence[float] | None = None
    skip_bad: bool = False
    progress: Tell | None = None


class Taken(NamedTuple):
    """The points of a block that are left."""

    points: Float64Array
    rows: Int64Array
    """Their lines, from 0."""
    attributes: dict[str, AnyArray]


@dataclass(slots=True)
class _Head:
    """What the first block tells."""

    layout: Layout
    meaning: Columns
    source: CRS | None
    area: AreaOfUse | None
    is_turned: bool | None = None
    unit: Unit | None = None


@dataclass(slots=True, eq=False)
class _Account:
    """What became of the rows so far, and what is to be told, in the order in which it is."""

    n_rows: int = 0
    n_seen: int = 0
    n_taken: int = 0
    n_grouped: int = 0
    faults: list[Fault] = field(default_factory=list)
    lines: dict[str, list[int]] = field(default_factory=dict)
    """Lines (from 1) of the points that are left out."""
    skipped: Counter[str] = field(default_factory=Counter)
    left_out: dict[str, list[int]] = field(default_factory=dict)
    """Lines (from 1) that are no rows."""
    at_first: list[str] = field(default_factory=list)
    words: list[str] = field(default_factory=list)
    turned: list[str] = field(default_factory=list)
    odd: list[str] = field(default_factory=list)
    total: Float64Array = field(default_factory=lambda: np.zeros(3))
    n_blocks: int = 0

    def add_lines(self, layout: Layout) -> None:
        """Add the lines of a block that are no rows."""
        self.n_rows += len(layout.rows)
        self.skipped.update(layout.skipped)
        for what, at in layout.left_out.items():
            self.left_out.setdefault(what, []).extend(at)

    def leave_out(self, what: str, rows: Int64Array) -> None:
        """Add rows that are left out."""
        if len(rows):
            self.lines.setdefault(what, []).extend((rows + 1).tolist())

    def describe_rows(self) -> list[str]:
        """Say what became of the rows of all blocks."""
        notes = list(self.words)
        if self.n_grouped:
            grouped = counted(self.n_grouped, "coordinate")
            notes.append(f"Thousands separators were taken out of {grouped}.")
        if self.faults:
            notes.append(describe_faults(self.faults))
        for what, why in _REASONS.items():
            if what in self.lines:
                notes.append(describe_left_out(why, self.lines[what]))
        return notes


_FLAT, _NODATA, _BAD = "points without elevation", "nodata points", "bad rows"
_REASONS = {_FLAT: "without an elevation", _NODATA: "with a nodata elevation"}


class TableReader:
    """Reads the table of a text file.

    Parameters
    ----------
    suffix : str
        Of the file.
    asked : Asked
    """

    def __init__(self, suffix: str, asked: Asked) -> None:
        self._suffix, self._asked = suffix, asked
        self._nodata = parse_nodata(asked.nodata)
        self._declared, self._target = CRS.of(asked.source_crs), CRS.of(asked.crs)
        self._is_stated = asked.columns is not None
        self._head: _Head | None = None
        self._account = _Account()
        self._places: _Places | None = None

    def read(self, lines: TextLines, progress: Tell | None) -> Taken | None:
        """Read the rows of a block; None if it has none.

        Raises
        ------
        ReadError, CrsError, OptionError
            As the reader of the format.
        """
        if self._head is None:
            layout, cells = self._begin(lines, progress)
        else:
            layout = continue_layout(lines, self._head.layout, comment=self._asked.comment)
            self._account.add_lines(layout)
            self._account.at_first += layout.notes
            if len(layout.rows) == 0:
                return None
            _require_no_headings(lines, layout)
            cells = read_cells(lines, layout, progress=progress)
            self._require_no_faults(cells.faults, lines, layout)
            require_one_mark(cells, self._head.meaning, layout, is_continued=True)
        self._account.n_blocks += 1
        return self._read_rows(cells, layout, lines)

    def _begin(self, lines: TextLines, progress: Tell | None) -> tuple[Layout, Cells]:
        """Find what the columns are, and where the points lie."""
        account = self._account
        layout = find_layout(lines, self._suffix, self._asked)
        account.add_lines(layout)
        cells = read_cells(lines, layout, progress=progress)
        self._require_no_faults(cells.faults, lines, layout)
        source = _find_source_crs(layout, self._declared, self._target)
        area = AreaOfUse.of(source, self._target)
        meaning, notes = _find_columns(cells, layout, area, self._nodata)
        noted = require_unit_of_crs(meaning, source or self._target, is_stated=self._is_stated)
        require_one_mark(cells, meaning, layout)
        account.at_first += [*layout.notes, *notes, *noted]
        self._head = _Head(layout, meaning, source, area)
        is_headed = layout.columns is not None and not self._is_stated
        self._places = _Places(area, is_headed=is_headed)
        return layout, cells

    def _require_no_faults(self, faults: Sequence[Fault], lines: TextLines, layout: Layout) -> None:
        if faults and not self._asked.skip_bad:
            raise describe_faults_of_rows(faults, self._account.n_rows, lines, layout)

    def _read_rows(self, cells: Cells, layout: Layout, lines: TextLines) -> Taken:
        assert self._head is not None
        account, head, skip_bad = self._account, self._head, self._asked.skip_bad
        is_alone = lines.first == 0 and lines.is_last
        table = read_table(cells, layout, head.meaning, lines, keeps_empty=not is_alone)
        if lines.is_last:
            table, noted = leave_out_cut_row(table, lines, layout, head.meaning, skip_bad=skip_bad)
            account.at_first += noted
        self._require_no_faults(table.faults, lines, layout)
        account.faults += table.faults
        if lines.is_last and 2 * len(account.faults) > account.n_rows:
            raise describe_faults_of_rows(account.faults, account.n_rows, lines, layout)
        require_one_header(table.faults, lines, layout.delimiter, head.meaning)
        account.n_grouped += table.n_grouped
        account.words += self._name_block(lines, find_unit_words(table.attributes))
        taken = self._take_rows(table)
        if lines.is_last:
            self._require_points()
        if account.n_blocks == 1:
            declared = Unit.of(self._asked.elevation_unit)
            head.unit, noted = _find_unit(layout, lines, declared)
            account.at_first += noted
        return self._settle(taken, lines, layout)

    def _take_rows(self, table: Table) -> Taken:
        """Leave out points without an elevation."""
        account, z = self._account, table.points[:, 2]
        is_flat = np.isnan(z)
        is_nodata = np.isin(z, self._nodata) if len(self._nodata) else np.zeros(len(z), np.bool_)
        account.n_seen += len(z)
        account.leave_out(_FLAT, table.rows[is_flat])
        account.leave_out(_NODATA, table.rows[is_nodata])
        kept: BoolArray | slice = ~(is_flat | is_nodata)
        if isinstance(kept, np.ndarray) and kept.all():
            kept = slice(None)
        attributes = {name: values[kept] for name, values in table.attributes.items()}
        taken = Taken(table.points[kept], table.rows[kept], attributes)
        account.n_taken += len(taken.points)
        return taken

    def _require_points(self) -> None:
        if self._account.n_taken == 0:
            rows = counted(self._account.n_seen, "row")
            raise ReadError(f"of {rows}, none has an elevation.")

    def _settle(self, taken: Taken, lines: TextLines, layout: Layout) -> Taken:
        """Refuse places that no header can mean, take X for the northing where the CRS does."""
        assert self._head is not None
        assert self._places is not None
        account, head, columns = self._account, self._head, self._head.meaning
        if self._places.is_headed and len(taken.points):
            if columns.is_degrees:
                require_one_hemisphere(taken.attributes)
            require_no_geocentric(taken.points, columns)
            taken, columns = self._settle_axes(taken, lines, layout)
        self._places.add(taken, columns)
        in_degrees = is_geographic(head.source)
        numbers, names = (taken.attributes.get(role) for role in ("number", "description"))
        odd = [
            *find_odd_elevations(taken.points, in_degrees=in_degrees),
            *find_repeated_numbers(numbers, taken.rows),
            *find_rounded_coordinates(lines, taken.rows, layout.delimiter, columns),
            *find_summary_rows(taken.points, taken.rows, (numbers, names)),
            *find_commented_points(lines, layout.rows, layout, columns),
            *(() if layout.columns is None else _find_split(taken, layout, columns)),
        ]
        if lines.is_last and lines.first > 0 and len(taken.points):
            total = account.total + taken.points[:-1].sum(axis=0)
            odd += describe_sum_row(total, taken.points[-1:], taken.rows[-1:], account.n_taken)
        with np.errstate(over="ignore", invalid="ignore"):
            account.total = account.total + taken.points.sum(axis=0)
        account.odd += self._name_block(lines, odd)
        return taken

    def _settle_axes(self, taken: Taken, lines: TextLines, layout: Layout) -> tuple[Taken, Columns]:
        assert self._head is not None
        head, is_first = self._head, self._head.is_turned is None
        crs = head.source or self._target
        line = find_axes_line(lines, layout.rows) if lines.first == 0 else None
        points, columns, turned = settle_axes(taken.points, head.meaning, crs, head.area, line)
        is_turned = points is not taken.points
        if is_first:
            head.is_turned = is_turned
            self._account.turned += turned
        elif is_turned != head.is_turned:
            raise ReadError(
                f"the points from line {lines.first + 1} on have easting and northing in another "
                "order than those before, by the area of use of their CRS: say with the option "
                "`columns` what the columns are.",
                lines=[lines.first + 1],
            )
        return taken._replace(points=points), columns

    def _name_block(self, lines: TextLines, notes: Sequence[str]) -> list[str]:
        """Return notes of a block, with its lines if there are others."""
        if lines.first == 0 and lines.is_last:
            return list(notes)
        span = f"Lines {lines.first + 1:,} to {lines.last + 1:,}"
        return [f"{span}: {note[:1].lower()}{note[1:]}" for note in notes]

    # -------------------------------------------------------------------- at the end

    def begin_placing(self) -> Placing:
        """Return what brings the points to their CRS."""
        assert self._head is not None
        return Placing(self._head.source, self._target, self._head.unit, looks_at_area=False)

    def finish(self) -> list[str]:
        """Return what is to be told of all rows.

        Raises
        ------
        ReadError, CrsError
            If they contradict what the head of the file says, or their CRS.
        """
        assert self._head is not None
        assert self._places is not None
        head, account = self._head, self._account
        require_announced(head.layout.announced, account.n_rows)
        self._require_points()
        noted = self._places.describe()
        is_free = self._is_stated or head.area is None  # a plan of its own may lie anywhere
        on_ground = require_ground(self._places.elevations, head.unit, is_free=is_free)
        rows = account.describe_rows()
        return _shorten(
            [*account.at_first, *on_ground, *rows, *account.turned, *noted], account.odd
        )

    def conclude(self, notes: Sequence[str]) -> StreamEnd:
        """Return what is left out, beside notes."""
        account = self._account
        bad = [fault.line + 1 for fault in account.faults]
        lines = {**account.left_out, **({_BAD: bad} if bad else {}), **account.lines}
        left_out = {what: tuple(at) for what, at in lines.items()}
        skipped = {what: count for what, count in account.skipped.items() if count}
        return StreamEnd(
            notes,
            {**skipped, **{what: len(at) for what, at in left_out.items()}},
            {"skipped_lines": left_out},
        )


def _shorten(notes: Sequence[str], odd: Sequence[str]) -> list[str]:
    """Return all notes, but not those of more than some blocks."""
    more = len(odd) - _MOST_NOTES
    if more <= 0:
        return [*notes, *odd]
    return [*notes, *odd[:_MOST_NOTES], f"{counted(more, 'further note')} of single lines."]


class _Places:
    """Where the points of all blocks lie, as they are in the file."""

    def __init__(self, area: AreaOfUse | None, *, is_headed: bool) -> None:
        self.is_headed = is_headed
        self._area = area
        self._some: list[Taken] = []
        self._share = 1
        self._columns: Columns | None = None
        self._is_local = True
        self._counts = [0, 0, 0]
        self._rows: list[int] = []

    @property
    def elevations(self) -> Float64Array:
        """Elevations of the points, of several blocks some of each."""
        return np.concatenate([one.points[:, 2] for one in self._some])

    def add(self, taken: Taken, columns: Columns) -> None:
        """Look at further points; the first ones are kept until there are others."""
        if len(taken.points) == 0:
            return
        if len(self._some) == 1:
            self._count(self._some[0])
            self._some[0] = _thin(self._some[0])
        self._columns = columns
        if self._some:
            self._count(taken)
            taken = _thin(taken, self._share)
        self._some.append(taken)
        if len(self._some) > 1 and sum(len(one.points) for one in self._some) > _MOST_KEPT:
            self._some = [
                Taken(one.points[::2].copy(), one.rows[::2].copy(), {}) for one in self._some
            ]
            self._share *= 2

    def _count(self, taken: Taken) -> None:
        area, xy = self._area, taken.points[:, :2]
        if area is None:
            return
        was_local, n_before = self._is_local, self._counts[0]
        self._is_local &= area.is_local(xy)
        self._counts[0] += len(xy)
        if self._is_local:
            return
        if was_local:
            self._counts[1] = n_before  # all of these lie about the origin
        outside = area.find_outside(xy)
        self._counts[1] += len(outside)
        if len(outside):
            self._counts[2] += int(area.covers(xy[outside][:, [1, 0]]).sum())
            self._rows += taken.rows[outside[: _FIRST - len(self._rows)]].tolist()

    def describe(self) -> list[str]:
        """Say which points lie outside the area of use.

        Raises
        ------
        CrsError
            As :func:`.findings.require_in_area`.
        """
        assert self._columns is not None
        is_headed, area = self.is_headed, self._area
        if len(self._some) == 1:
            points, rows, _ = self._some[0]
            return require_in_area(points, rows, self._columns, area, is_headed=is_headed)
        if area is None or self._is_local or not self._counts[1]:
            return []
        if 2 * self._counts[1] > self._counts[0]:
            points = np.concatenate([one.points for one in self._some])
            rows = np.concatenate([one.rows for one in self._some])
            require_in_area(points, rows, self._columns, area, is_headed=is_headed)
        n_points, n_outside, n_fits = self._counts
        rows = np.array(self._rows, np.int64)
        return [describe_outside(area, (n_points, n_outside, n_fits), rows)]


_FIRST = 6
"""Lines of points outside that are kept: one more than are named."""


def _thin(taken: Taken, share: int = 1) -> Taken:
    step = slice(None, None, max(1, len(taken.points) * share // _SOME))
    return Taken(taken.points[step].copy(), taken.rows[step].copy(), {})


def _require_no_headings(lines: TextLines, layout: Layout) -> None:
    """Refuse a line between the rows that says what those above it are in."""
    is_other = ~lines.is_blank
    is_other[layout.rows - lines.first] = False
    if not is_other.any():
        return
    own = replace(lines, first=0)
    rows = layout.rows - lines.first
    unit, axes = find_unit_line(own, rows), find_axes_line(own, rows)
    if (unit is not None and unit.unit) or axes is not None:
        raise ReadError(
            f"a line between lines {lines.first + 1} and {lines.last + 1} tells the unit or the "
            "axes of the points, behind many of them: write it above the table.",
            lines=[lines.first + 1],
        )


def _find_split(taken: Taken, layout: Layout, columns: Columns) -> list[str]:
    unnamed = {f"column {i + 1}" for i in range(max(columns.coordinates) + 1, layout.count)}
    beyond = {name: values for name, values in taken.attributes.items() if name in unnamed}
    return find_split_thousands(taken.points, beyond, layout.delimiter)


def _find_unit(
    layout: Layout, lines: TextLines, declared: Unit | None
) -> tuple[Unit | None, list[str]]:
    """Return the unit of elevations by the header, a line near the table or the caller."""
    named = find_known_unit(layout.elevation_unit)
    line = find_unit_line(lines, layout.rows)
    if line is None or not line.unit:
        return settle_unit(declared, named), [line.note] if line else []
    own = find_known_unit(line.unit)
    if named not in (None, own) or declared not in (None, own):
        raise ReadError(
            f"{line.label} tells {line.unit} as the unit of the elevations, and the "
            f"{'header' if named else 'option `elevation_unit`'} another: make them agree.",
        )
    return own, [line.note]


def _find_source_crs(layout: Layout, source_crs: CRS | None, crs: CRS | None) -> CRS | None:
    """Return the CRS of the coordinates in the file, None if it is the one declared."""
    in_degrees = layout.columns is not None and layout.columns.is_degrees
    return (
        CRS.of(_WGS84)
        if source_crs is None and in_degrees and not is_geographic(crs)
        else source_crs
    )


def _find_columns(
    cells: Cells,
    layout: Layout,
    area: AreaOfUse | None,
    nodata: Float64Array,
) -> tuple[Columns, list[str]]:
    """Return what the columns mean, by word or header, else by what is in them."""
    if layout.columns is not None:
        return layout.columns, []
    columns = [one.without(nodata) for one in describe_columns(cells, layout)]
    found, note = find_columns_by_content(
        columns,
        area,
        is_scan=layout.is_scan,
        is_announced=layout.is_announced,
        heading=layout.heading.label if layout.heading else "",
    )
    return found, [note]
