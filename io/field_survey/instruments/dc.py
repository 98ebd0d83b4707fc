"""Trimble DC files (.dc) of Survey Controller, Survey Pro and Access: points with coordinates.

Records have fields at fixed columns: two letters of what they are, two of what they come from, then
fields of 16 columns. Read are 00 header (units, order of coordinates), 69 grid position and, of
older programs, 08 coordinates: name, northing, easting, elevation, code; behind them one digit each
for method and classification. A position of GNSS (66 geographic, 67 a vector, 68 local) needs the
job's datum, projection, calibration and geoid, an observation (70, 79, 80) the corrections of the
instrument: neither is reduced here.

References: North Carolina DOT, TSCe Survey Controller, DC v10.0 file record definitions (header and
columns); Traverse PC, Trimble DC10.7 (which record is what).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ....base.crs import METRE
from ...delimited import read_lines
from .record_lines import describe_head_fault, find_head, parse_coordinate, read_records
from .records import Book, book_reader

if TYPE_CHECKING:
    from pathlib import Path

    from ...delimited import TextLines

_WIDTH = 16
_POINTS = ("69", "08")
_END_OF_NUMBERS = 4 + 4 * _WIDTH
_END_OF_CODE = _END_OF_NUMBERS + _WIDTH
_POSITIONS = ("66", "68")
_OBSERVATIONS = ("67", "70", "79", "80")


@book_reader
def read(path: Path, *, encoding: str | None = None) -> Book:
    """Read points of a Trimble DC file; ``elevation_unit`` says which feet a file in feet is in.

    Returns
    -------
    Survey
        Of the grid positions (69) and coordinates (08), with ``number``, ``description`` (the
        codes), and ``method`` with the method and classification if there are several. Positions of
        GNSS and observations of points that have no such record are left out and counted.

    Raises
    ------
    ReadError
        If it has no header, a number is none, or no point has coordinates.
    """
    lines = read_lines(path, encoding=encoding)
    return read_records(lines, _Reader(lines, path))


class _Reader:
    """Takes records as they come."""

    def __init__(self, lines: TextLines, path: Path) -> None:
        self.book = Book(path)
        # Read units and the order of coordinates, and return whether eastings come first.
        head = find_head(lines)
        if not head.startswith("00"):
            what = f" begins with '{head[:20]}', and a Trimble DC file with the record 00."
            raise describe_head_fault(what)
        length, order = head[41:42], head[44:45]
        if length not in ("1", "2", "3") or order not in ("1", "2"):
            raise describe_head_fault(
                f", line 1: the units of the header are '{head[40:46].strip()}', and they must be "
                "digits for angles, lengths (1, 2 or 3), pressure, temperature, order of "
                "coordinates (1 or 2) and direction of angles.",
            )
        self.book.unit = METRE if length == "1" else None
        self.is_east_first = order == "2"
        self._known: set[str] = set()
        self._waiting: list[tuple[int, str, str]] = []

    def may_be_cut(self, line: str) -> bool:
        """Whether the last number of a record may go on."""
        return line[:2] in _POINTS and len(line) < _END_OF_NUMBERS

    def read_record(self, line: str, number: int) -> None:
        """Take one record; of kinds that say nothing of points none."""
        kind = line[:2]
        if kind in _POINTS:
            name, *cells, code = (
                line[at : at + _WIDTH].strip() for at in range(4, _END_OF_CODE, _WIDTH)
            )
            first, second, z = (parse_coordinate(cell, number) for cell in cells)
            x, y = (first, second) if self.is_east_first else (second, first)
            self._known.add(name)
            self.book.add(
                name, (x, y, z), code, number, line[_END_OF_CODE : _END_OF_CODE + 2].strip()
            )
        elif kind in _POSITIONS or kind in _OBSERVATIONS:
            self._waiting.append((number, kind, line[4 : 4 + _WIDTH].strip()))

    def finish(self) -> None:
        """Account for positions and observations of points that have no coordinates."""
        for number, kind, name in self._waiting:
            if kind in _OBSERVATIONS:
                what = f"observations ({kind}), which are not reduced,"
            elif name in self._known:
                continue
            else:
                what = f"positions ({kind}) of GNSS without grid coordinates"
            self.book.leave_out(what, number)
        classes = sorted({method[1:2] for method in self.book.methods} - {""})
        if len(classes) > 1:
            self.book.notes.append(
                f"Its points have the classifications {', '.join(classes)}: all are read, for the "
                "attribute method (its second digit) to choose from."
            )
        if self._waiting and not self.book.points:
            self.book.notes.insert(
                0, "export the job with grid coordinates, or as JobXML with its reductions."
            )
