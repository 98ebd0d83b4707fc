"""Sokkia SDR files (SDR20 and 2x, SDR33), as Topcon, Nikon and others write them, too.

Records have fields at fixed columns; the first two digits say what they are, two letters what they
come from. Read are 00 header (units, order of coordinates), 01 instrument (zero of vertical
angles), 02 station, 03 height of the target, 06 scale, 07 back bearing, 08 coordinates, 09
observation on face 1 or 2. Point names have 4 columns and numbers 10 in SDR20, 16 and 16 in SDR33.
Angles are decimal.

References: Nikon, Total Station N Series Instruction Manual, SDR2x and SDR33 record formats;
MicroSurvey, SDR20 format versus SDR33 format.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ....base.crs import METRE
from ....base.errors import ReadError
from ....base.sentences import FILE
from ...delimited import is_number, read_lines
from .record_lines import describe_head_fault, find_head, read_records
from .records import Book, book_reader, require_refraction
from .reduction import Shot, Station, reduce_shot, to_radians

if TYPE_CHECKING:
    from pathlib import Path

    from ...delimited import TextLines

_ANGLES = {"1": "degrees", "2": "gon", "4": "mil"}
_RIGHT_ANGLE = math.pi / 2
_FIELDS = {"02": (1, 4), "07": (2, 2), "08": (1, 3), "09": (2, 3)}
"""By record: how many names and how many numbers it has."""


@dataclass(frozen=True, slots=True)
class _Columns:
    """Widths of a version: of names, of numbers and of descriptions."""

    name: int
    number: int
    text: int = 16

    def split(self, line: str, names: int, numbers: int) -> list[str]:
        """Return the fields of a record, the description last."""
        cells, at = [], 4
        for width in (self.name,) * names + (self.number,) * numbers:
            cells.append(line[at : at + width].strip())
            at += width
        return [*cells, line[at : at + self.text].strip()]


_VERSIONS = {"SDR33": _Columns(16, 16), "SDR2": _Columns(4, 10)}


@book_reader
def read(path: Path, *, encoding: str | None = None, refraction: float | None = None) -> Book:
    """Read points of an SDR file.

    Parameters
    ----------
    refraction : float, optional
        Coefficient of refraction by which shots are corrected, with the earth's curvature.

    Returns
    -------
    Survey
        Of the records of coordinates (08). Observations (09F1, 09F2) of points that have none are
        reduced where station, back bearing and height of the target are known, and else left out;
        so are those that the instrument has corrected itself (09MC), of which the file does not say
        by what.
    """
    coefficient = require_refraction(refraction)
    lines = read_lines(path, encoding=encoding)
    return read_records(lines, _Reader(lines, path, coefficient))


class _Reader:
    """Takes records as they come, and remembers the station."""

    def __init__(self, lines: TextLines, path: Path, refraction: float | None) -> None:
        self.book = Book(path)
        self.refraction = refraction
        head = find_head(lines)
        version = head[4:20].strip().upper()
        columns = next((one for name, one in _VERSIONS.items() if version.startswith(name)), None)
        if not head.startswith("00") or columns is None:
            what = (
                f" begins with '{head[:20]}', and an SDR file with the record 00 of SDR33 or SDR20."
            )
            raise describe_head_fault(what)
        angle, length, order = head[40:41], head[41:42], head[44:45]
        if angle not in _ANGLES or length not in "12" or order not in "12" or not length + order:
            raise describe_head_fault(
                f", line 1: the units of the header are '{head[40:46]}', and they must be digits "
                "for angles (1, 2 or 4), lengths (1 or 2), pressure, temperature and order of "
                "coordinates (1 or 2).",
            )
        self.book.unit = METRE if length == "1" else None
        self.columns, self.is_east_first, self.angle = columns, order == "2", _ANGLES[angle]
        self.is_from_horizon = False
        self.scale = 1.0
        self.stations: dict[str, tuple[float, float, float, float]] = {}
        self.orientations: dict[str, float] = {}
        self.target_height = math.nan
        self._waiting: list[tuple[int, str, str, Station | None, Shot]] = []
        self._known: set[str] = set()
        self._readers = {
            "01": self._read_instrument,
            "02": self._read_station,
            "03": self._read_target_height,
            "06": self._read_scale,
            "07": self._read_back_bearing,
            "08": self._read_coordinates,
            "09": self._read_observation,
        }

    def may_be_cut(self, line: str) -> bool:
        """Whether the last number of a record may go on."""
        if line[:2] not in self._readers:
            return False
        names, numbers = _FIELDS.get(line[:2], (0, 1))
        width = 4 + names * self.columns.name + numbers * self.columns.number
        return len(line) < width

    def read_record(self, line: str, number: int) -> None:
        """Take one record; of kinds that say nothing of points none."""
        reader = self._readers.get(line[:2])
        if reader is not None:
            reader(line, number)

    def _read_instrument(self, line: str, number: int) -> None:  # noqa: ARG002 - as all take it
        self.is_from_horizon = line[50:51] == "2"

    def _read_target_height(self, line: str, number: int) -> None:
        self.target_height = self._parse_number(line[4:20].strip(), number)

    def _read_scale(self, line: str, number: int) -> None:
        self.scale = self._parse_number(line[4:20].strip(), number)

    def _read_station(self, line: str, number: int) -> None:
        name, *cells, _ = self.columns.split(line, *_FIELDS["02"])
        x, y, z, height = (self._parse_number(cell, number) for cell in cells)
        self.stations[name] = (x, y, z, height) if self.is_east_first else (y, x, z, height)
        self.orientations.pop(name, None)

    def _read_back_bearing(self, line: str, number: int) -> None:
        name, _, *cells, _ = self.columns.split(line, *_FIELDS["07"])
        azimuth, circle = (
            to_radians(self._parse_number(cell, number), self.angle) for cell in cells
        )
        self.orientations[name] = azimuth - circle

    def _read_coordinates(self, line: str, number: int) -> None:
        name, *cells, code = self.columns.split(line, *_FIELDS["08"])
        x, y, z = (self._parse_number(cell, number) for cell in cells)
        xyz = (x, y, z) if self.is_east_first else (y, x, z)
        self._known.add(name)
        self.book.add(name, xyz, code, number, "coordinates")

    def _read_observation(self, line: str, number: int) -> None:
        station, name, *cells, code = self.columns.split(line, *_FIELDS["09"])
        kind = line[2:4]
        if kind not in ("F1", "F2"):
            self._waiting.append((number, name, code, None, Shot(*(math.nan,) * 4)))
            return
        distance, vertical, circle = (self._parse_number(cell, number) for cell in cells)
        shot = Shot(
            to_radians(circle, self.angle),
            self._find_zenith(to_radians(vertical, self.angle)),
            distance,
            self.target_height,
        )
        place = self.stations.get(station)
        known = None
        if place is not None and station in self.orientations and self.scale == 1.0:
            known = Station(*place, self.orientations[station])
        self._waiting.append((number, name, code, known, shot))

    def _find_zenith(self, vertical: float) -> float:
        return _RIGHT_ANGLE - vertical if self.is_from_horizon else vertical

    def finish(self) -> None:
        """Reduce the observations of points that have no coordinates."""
        done: set[str] = set()
        metres = 1.0 if self.book.unit is METRE else 0.3048
        for number, name, code, station, shot in self._waiting:
            if name in self._known:
                continue
            if station is None or not station.is_known or not shot.is_known:
                what = "shots without station, back bearing, heights, angles or distance"
                self.book.leave_out(what, number)
            elif name in done:
                self.book.leave_out("shots of points that have one already", number)
            else:
                done.add(name)
                xyz = reduce_shot(station, shot, refraction=self.refraction, metres=metres)
                self.book.add(name, xyz, code, number, "reduced")
        if self.scale != 1.0 and self._waiting:
            self.book.notes.append(
                f"The scale {self.scale:g} of the file is not 1: no shot was reduced."
            )

    def _parse_number(self, cell: str, line: int) -> float:
        """Return the number of a field, NaN if it is empty."""
        if not cell:
            return math.nan
        if not is_number(cell, "."):
            raise ReadError(
                f"{FILE}, line {line}: '{cell[:30]}' stands where a number must be.",
                lines=[line],
            )
        value = float(cell)
        if math.isinf(value):
            raise ReadError(
                f"{FILE}, line {line}: '{cell[:30]}' is no finite number.",
                lines=[line],
            )
        return value
