"""Surveyed cross sections: lines of points across a channel, as callers give them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ....base.crs import CRS, Unit, require_one_unit, require_projected
from ....base.errors import CrsError, LinesError, OptionError
from ....base.sentences import coordinate, counted, inflect
from ....tin import Survey, triangulate
from ....tin.building import find_crs
from ....tin.screening import describe_screening, screen_points
from ...surface import as_features

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from ....base.arrays import AnyArray, BoolArray, Float64Array
    from ....base.crs import CrsLike, UnitLike
    from ....base.results import Features


class Surveyed(NamedTuple):
    """Lines of points, each across a channel, with their CRS and units."""

    lines: list[Float64Array]
    """(k, 3) each."""
    names: list[str]
    """What each is called in sentences: "Section 3"."""
    crs: CRS | None
    elevation_unit: Unit | None
    notes: tuple[str, ...]

    def screen(self) -> tuple[str, ...]:
        """Tell which points look like blunders, which a bed carries on along the channel."""
        tin = triangulate(np.concatenate(self.lines), crs=self.crs, duplicates="first")
        ends = np.cumsum([len(line) for line in self.lines])

        def name(rows: Sequence[int]) -> str:
            section = self.names[int(np.searchsorted(ends, rows[0], side="right"))]
            x, y = tin.points[rows[0], :2].tolist()
            return f"{section[:1].lower()}{section[1:]}, {coordinate(x)} {coordinate(y)}"

        return describe_screening(screen_points(tin), name)


def read_sections(
    given: Any, by: str | None, crs: CrsLike | None, elevation_unit: UnitLike | None
) -> Surveyed:
    """Return cross sections given as lines in space, or as points with a column that groups them.

    Raises LinesError, OptionError and CrsError as :func:`tinsmith.riverbed`.
    """
    notes: list[str] = []
    if isinstance(given, Survey):
        lines, names = _take_survey(given, by, notes)
        own: Any = given
    else:
        own = as_features(given, "section")
        lines, names = _take_features(own, by, notes)
    found = _find_crs(given, own, crs)
    asked, known = Unit.of(elevation_unit), own.elevation_unit
    if asked is not None and known is not None and asked != known:
        allowed = f"{known}, in which the elevations of the sections are"
        raise OptionError("elevation_unit", elevation_unit, allowed)
    unit = require_one_unit(found, asked or known)
    kept = [_clean(line, name, notes) for line, name in zip(lines, names, strict=True)]
    if len(kept) < 2:
        raise LinesError(f"There is {counted(len(kept), 'cross section')}: 2 or more are needed.")
    return Surveyed(kept, names, found, unit, (*own.notes, *notes))


def _find_crs(given: Any, own: Any, crs: CrsLike | None) -> CRS | None:
    """Return the one CRS of the sections and of what was said.

    Raises CrsError if there are several.
    """
    several = given if isinstance(given, list | tuple) else []
    known = [one for one in (CRS.of(crs), own.crs, *map(find_crs, several)) if one is not None]
    for one in known[1:]:
        if not one.is_same(known[0]):
            raise CrsError(
                f"The sections are in {one.label} and {known[0].label}: they must be in one CRS; "
                "reproject them first.",
                crs=one,
            )
    found = known[0] if known else None
    require_projected(
        found,
        "A bed cannot be interpolated in degrees, and the sections are in {crs}: a projected CRS "
        "is needed, such as UTM.",
    )
    return found


def _take_features(
    features: Features, by: str | None, notes: list[str]
) -> tuple[list[Float64Array], list[str]]:
    if features.kind == "points":
        if features.coordinates.shape[1] < 3:
            raise LinesError("The points of the sections have no elevations.")
        return _group(features.coordinates, _take_column(features.columns, by), notes)
    if features.kind != "lines" or len(features.offsets) > 1:
        raise LinesError("Cross sections are lines of one part each, or points.")
    lines = np.split(features.coordinates, features.offsets[0][1:-1])
    if by is None:
        return lines, [f"Section {number}" for number in range(1, len(lines) + 1)]
    return lines, [f"Section '{one}'" for one in _take_column(features.columns, by)]


def _take_survey(
    survey: Survey, by: str | None, notes: list[str]
) -> tuple[list[Float64Array], list[str]]:
    if by is not None:
        return _group(survey.points, _take_column(survey.attributes, by), notes)
    if not len(survey.breaklines):
        raise LinesError(
            "Points are no cross sections by themselves: give `by`, the column whose values tell "
            "the section of each."
        )
    lines = [np.asarray(getattr(one, "coords", one), float) for one in survey.breaklines]
    own = [getattr(one, "name", "") for one in survey.breaklines]
    on_lines = {tuple(row) for line in lines for row in line[:, :2].tolist()}
    lost = sum(tuple(row) not in on_lines for row in survey.points[:, :2].tolist())
    if lost:
        points = counted(lost, "point")
        notes.append(inflect(f"{points} that [is|are] on no section [was|were] left out.", lost))
    return lines, [
        f"Section '{name}'" if name else f"Section {number}" for number, name in enumerate(own, 1)
    ]


def _take_column(columns: Any, by: str | None) -> list[str]:
    """Return what a column says of each row, "" for nothing."""
    if by is None or by not in columns:
        has = ", ".join(map(repr, columns)) or "no column"
        raise OptionError("by", by, f"a column that tells the sections; there is {has}")
    return ["" if one is None or one != one else str(one).strip() for one in columns[by].tolist()]


def _group(
    points: Float64Array, labels: Sequence[str], notes: list[str]
) -> tuple[list[Float64Array], list[str]]:
    """Return the points of each section in their order across; what is alone is left out."""
    every = np.array(labels, object)
    lines: list[Float64Array] = []
    names, alone, sorted_names = [], [], []
    for name in filter(None, dict.fromkeys(labels)):
        own = points[every == name]
        if len(own) < 2:
            alone.append(name)
            continue
        order = _find_order(own)
        if (order != np.arange(len(own))).any():
            sorted_names.append(name)
        lines.append(own[order])
        names.append(f"Section '{name}'")
    notes.extend(_tell_groups(sum(not one for one in labels), alone, sorted_names))
    return lines, names


def _tell_groups(unnamed: int, alone: list[str], sorted_names: list[str]) -> Iterator[str]:
    if unnamed:
        points = counted(unnamed, "point")
        yield inflect(f"{points} without a section [was|were] left out.", unnamed)
    if alone:
        yield f"Sections of one point were left out: {_list(alone)}."
    if sorted_names:
        yield (
            "The points of these sections were not in order across the channel, and were sorted "
            f"along the direction in which they spread most: {_list(sorted_names)}."
        )


def _list(names: Sequence[str]) -> str:
    shown = ", ".join(f"'{one}'" for one in names[:5])
    return shown if len(names) <= 5 else f"{shown} and {len(names) - 5:,} more"


def _find_order(points: Float64Array) -> AnyArray:
    """Return the order of points across the channel.

    It is theirs, unless they make a shorter line along the direction in which they spread most.
    """
    centred = points[:, :2] - points[:, :2].mean(axis=0)
    along = centred @ np.linalg.svd(centred, full_matrices=False)[2][0]
    if along[-1] < along[0]:
        along = -along
    order: AnyArray = np.argsort(along, kind="stable")
    is_shorter = _measure_length(points[order]) < _measure_length(points)
    return order if is_shorter else np.arange(len(points))


def _measure_length(points: Float64Array) -> float:
    return float(np.hypot(*np.diff(points[:, :2], axis=0).T).sum())


def _clean(line: Float64Array, name: str, notes: list[str]) -> Float64Array:
    """Return a section without points that repeat the one before.

    Raises LinesError if it has no elevations, is vertical anywhere or crosses itself.
    """
    import shapely

    if line.shape[1] < 3 or not np.isfinite(line[:, 2]).all():
        raise LinesError(f"{name} has points without elevations: all need one.")
    is_new: BoolArray = np.append(True, (np.diff(line[:, :2], axis=0) != 0.0).any(axis=1))
    lost = np.flatnonzero(~is_new)
    if len(lost) and (line[lost, 2] != line[lost - 1, 2]).any():
        at = lost[line[lost, 2] != line[lost - 1, 2]][0]
        x, y = line[at, :2].tolist()
        raise LinesError(
            f"{name} is vertical at {coordinate(x)} {coordinate(y)}: a bed has one elevation at "
            "each place."
        )
    if len(lost):
        points = counted(len(lost), "point")
        notes.append(
            inflect(
                f"{name}: {points} that repeat[s|] the one before [was|were] left out.", len(lost)
            )
        )
    kept = line[is_new]
    if len(kept) < 2:
        raise LinesError(f"{name} has one place: two or more are needed.")
    if not shapely.is_simple(shapely.linestrings(kept[:, :2])):
        raise LinesError(f"{name} crosses itself.")
    return kept
