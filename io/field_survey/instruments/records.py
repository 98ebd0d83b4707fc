"""Points as an instrument recorded them, made a survey."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import wraps
from inspect import signature
from typing import TYPE_CHECKING, Any

import numpy as np

from ....base.checks import as_number
from ....base.crs import CRS, FOOT, METRE, US_SURVEY_FOOT, Unit, require_same_unit
from ....base.errors import CrsError, ReadError
from ....base.sentences import FILE, counted, inflect
from ....base.types import RowSources
from ....tin import Survey
from ...delimited import find_odd_elevations, find_repeated_numbers, require_ground
from ...reprojection import place, settle_unit
from .reduction import NOT_APPLIED

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from ....base.crs import CrsLike, UnitLike

_SHOWN = 5
_MOST_REFRACTION = 5.0
_FEET = (FOOT, US_SURVEY_FOOT)


def require_refraction(value: object) -> float | None:
    """Return a coefficient of refraction, or refuse it."""
    if value is None:
        return None
    most, unit = _MOST_REFRACTION, "such as 0.13"
    return as_number("refraction", value, "a coefficient", least=-most, most=most, unit=unit)


@dataclass
class Book:
    """What a file of an instrument holds, as it is read."""

    path: Path
    unit: Unit | None = METRE
    """Of its lengths; None for feet of which it does not say whether they are of the US."""
    names: list[str] = field(default_factory=list)
    points: list[tuple[float, float, float]] = field(default_factory=list)
    codes: list[str] = field(default_factory=list)
    lines: list[int] = field(default_factory=list)
    methods: list[str] = field(default_factory=list)
    left_out: dict[str, list[int]] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)

    def add(
        self, name: str, xyz: tuple[float, float, float], code: str, line: int, method: str
    ) -> None:
        """Add a point; one without an elevation, or without a place, is left out."""
        if not (math.isfinite(xyz[0]) and math.isfinite(xyz[1])):
            self.leave_out("points without coordinates", line)
        elif not math.isfinite(xyz[2]):
            self.leave_out("points without elevation", line)
        else:
            self.names.append(name)
            self.points.append(xyz)
            self.codes.append(code)
            self.lines.append(line)
            self.methods.append(method)

    def leave_out(self, what: str, line: int) -> None:
        """Account for a record, by its line from 1, that makes no point."""
        self.left_out.setdefault(what, []).append(line)

    def make_survey(
        self,
        *,
        crs: CrsLike | None,
        elevation_unit: UnitLike | None,
        source_crs: CrsLike | None = None,
    ) -> Survey:
        """Return the survey."""
        if not self.points:
            lost = ", ".join(_count(what, len(lines)) for what, lines in self.left_out.items())
            why = f": {lost}" if lost else ""
            first = self.notes[0] if self.notes else ""
            hint = f" ({first[:-1]})" if first else ""
            raise ReadError(f"{FILE} holds no point with coordinates{why}{hint}.")
        target, source = CRS.of(crs), CRS.of(source_crs)
        # Bring points into the order of the file, in which lines run.
        order = sorted(range(len(self.lines)), key=self.lines.__getitem__)
        for name in ("names", "points", "codes", "lines", "methods"):
            column = getattr(self, name)
            setattr(self, name, [column[i] for i in order])
        points = np.array(self.points, np.float64)
        unit = self._settle(source or target, Unit.of(elevation_unit))
        points[:, :2] = self._scale(points[:, :2], source or target, unit)
        placed = place(points, source=source, target=target, unit=unit, looks_at_order=False)
        numbers = parse_names(self.names)
        rows = np.array(self.lines, np.int64) - 1
        attributes: dict[str, Any] = {"number": numbers}
        if any(self.codes):
            attributes["description"] = np.array(self.codes, object)
        if len(set(self.methods)) > 1:
            attributes["method"] = np.array(self.methods, object)
        return Survey(
            points=placed.points,
            attributes=attributes,
            crs=placed.crs,
            elevation_unit=placed.elevation_unit,
            source=self.path.name,
            row_sources=RowSources.of_file(self.path.name, rows + 1),
            skipped={what: len(lines) for what, lines in self.left_out.items()},
            skipped_lines={what: tuple(lines) for what, lines in self.left_out.items()},
            notes=[
                *self.notes,
                *self._describe_reduced(),
                *(_describe_left_out(what, lines) for what, lines in self.left_out.items()),
                *require_ground(points[:, 2], unit, is_free=True),
                *find_odd_elevations(points),
                *find_repeated_numbers(numbers, rows),
                *placed.notes,
            ],
        )

    def _settle(self, crs: CRS | None, declared: Unit | None) -> Unit:
        """Return the unit of the file's lengths: feet are those of the CRS, or as declared."""
        if self.unit is not None:
            unit = settle_unit(declared, self.unit)
            return self.unit if unit is None else unit
        known = None if crs is None or crs.is_geographic else crs.horizontal_unit
        if declared is not None and declared not in _FEET:
            require_same_unit(FOOT, declared, f"as {FILE} itself says")
        if declared is not None:
            return declared
        if known in _FEET:
            self.notes.append(
                f"Its lengths are feet, taken to be the {known.name} of {crs.label if crs else ''}."
            )
            return known
        raise ReadError(
            f"{FILE} is in feet and does not say which: give `elevation_unit='ft'` (0.3048 m) or "
            "`elevation_unit='US survey foot'` (1200/3937 m).",
        )

    def _scale(self, xy: Any, crs: CRS | None, unit: Unit) -> Any:
        """Return eastings and northings in the unit of the CRS."""
        if crs is None or crs.is_geographic:
            if unit != METRE:
                self.notes.append(f"Eastings and northings are in {unit.name}.")
            return xy
        wanted = crs.horizontal_unit
        if unit == wanted:
            return xy
        if wanted.metres is None or unit.metres is None:
            raise CrsError(f"{crs.label} has no unit of length.", crs=crs)
        self.notes.append(
            f"Eastings and northings were converted from {unit.name}, the unit of the file, to "
            f"{wanted.name}, that of {crs.label}."
        )
        return xy * (unit.metres / wanted.metres)

    def _describe_reduced(self) -> list[str]:
        count = self.methods.count("reduced")
        if count == 0:
            return []
        points = inflect(f"{counted(count, 'point')} [is|are]", count)
        return [f"{points} reduced from angles and distances, with {NOT_APPLIED} applied."]


def book_reader(gather: Callable[..., Book]) -> Callable[..., Survey]:
    """Make a reader of a function that gathers what a file holds, by its path and options.

    The reader takes ``crs``, ``elevation_unit`` and ``source_crs`` too.
    """

    @wraps(gather)
    def read(
        path: Path,
        *,
        crs: CrsLike | None = None,
        elevation_unit: UnitLike | None = None,
        source_crs: CrsLike | None = None,
        **options: Any,
    ) -> Survey:
        book = gather(path, **options)
        return book.make_survey(crs=crs, elevation_unit=elevation_unit, source_crs=source_crs)

    usual = signature(read, follow_wrapped=False).parameters
    own = dict(signature(gather).parameters)
    place, *texts = [own.pop(name) for name in ("path", "encoding") if name in own]
    order = [place, usual["crs"], usual["elevation_unit"], *texts, usual["source_crs"]]
    vars(read)["__signature__"] = signature(gather).replace(parameters=[*order, *own.values()])
    return read


def _describe_left_out(what: str, lines: Sequence[int]) -> str:
    shown = ", ".join(f"{line}" for line in lines[:_SHOWN])
    more = ", ..." if len(lines) > _SHOWN else ""
    verb = "is" if len(lines) == 1 else "are"
    places = f"line{'s' * (len(lines) > 1)} {shown}{more}"
    return f"{_count(what, len(lines))} {verb} left out: {places}."


def _count(what: str, number: int) -> str:
    """Count points or shots of some kind, such as "shots without orientation"."""
    noun, _, rest = what.partition("s ")
    return f"{counted(number, noun)} {rest}"


def parse_names(names: Sequence[str]) -> np.ndarray[Any, Any]:
    """Return the numbers of points: whole numbers where all are, else texts."""
    if all(name.isascii() and name.isdigit() and len(name) < 18 for name in names):
        plain = all(name == "0" or name[0] != "0" for name in names)
        if plain:
            return np.array([int(name) for name in names], np.int64)
    return np.array(names, object)
