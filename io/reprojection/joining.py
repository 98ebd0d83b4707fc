"""Several surveys as one: in one CRS and one unit of elevations, with what each had."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.errors import CrsError, ReadError
from ...base.georeference import agree
from ...base.sentences import coordinate, counted
from ...base.types import RowSources
from ...tin import Survey
from ...tin.building import join_columns
from .surfaces import scale_survey

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ...base.arrays import Float64Array
    from ...base.crs import CRS

SOURCE_FILE = "source_file"
"""The attribute that says which file a point is from; lines of codes end with their file."""

_LINES = ("breaklines", "boundary", "holes", "erase", "water")


def join_surveys(surveys: Sequence[Survey], names: Sequence[str]) -> Survey:
    """Return several surveys as one, in the order given.

    Parameters
    ----------
    surveys : sequence of Survey
        At least one.
    names : sequence of str
        What each is called: in sentences, and in the attribute ``source_file``.

    Returns
    -------
    Survey
        Points, lines and attributes of all. An attribute that a survey lacks has no value at its
        points. ``notes`` tell points of several surveys at one place.

    Raises
    ------
    CrsError
        If they are in several CRSs, or the CRS of some is not known; if it cannot be told whether
        elevations are in one unit.
    ReadError
        If one has voids, as a raster may have: there is no surface between the rings of several.
    """
    if len(surveys) == 1:
        return surveys[0]
    _require_no_extents(surveys, names)
    scaled, notes = _bring_to_one_unit(surveys, names)
    points = np.vstack([one.points for one in scaled])
    counts = [len(one) for one in scaled]
    columns = join_columns([one.attributes for one in scaled], counts)
    columns[SOURCE_FILE] = np.repeat(np.array(names, object), counts)
    skipped: dict[str, int] = {}
    for one in scaled:
        for what, count in one.skipped.items():
            skipped[what] = skipped.get(what, 0) + count
    starts = np.cumsum([0, *counts]).tolist()
    of_all = set(scaled[0].notes).intersection(*(one.notes for one in scaled))
    own = [
        note if note in of_all else f"'{name}': {note}"
        for one, name in zip(scaled, names, strict=True)
        for note in one.notes
    ]
    return Survey(
        points=points,
        attributes=columns,
        crs=scaled[0].crs,
        elevation_unit=scaled[0].elevation_unit,
        source=", ".join(names),
        from_raster=all(one.from_raster for one in scaled),
        skipped=skipped,
        skipped_lines={
            f"{what} of {name}": lines
            for one, name in zip(scaled, names, strict=True)
            for what, lines in one.skipped_lines.items()
        },
        notes=[
            *list(dict.fromkeys(own)),
            *notes,
            *_describe_shared_places(points, counts, names),
            *_describe_shared_numbers(scaled, names),
        ],
        findings=[
            finding._replace(rows=tuple(row + start for row in finding.rows))
            for one, start in zip(scaled, starts, strict=False)
            for finding in one.findings
        ],
        row_sources=RowSources.join([one.row_sources for one in scaled], names, counts),
        **{kind: [line for one in scaled for line in getattr(one, kind)] for kind in _LINES},
    )


def _require_no_extents(surveys: Sequence[Survey], names: Sequence[str]) -> None:
    for one, name in zip(surveys, names, strict=True):
        if one.extent:
            raise ReadError(
                f"'{name}' has voids, around which there is no surface, and cannot be joined with "
                "others: make one raster of them first, such as a virtual one (VRT).",
                path=Path(name),
            )


def _bring_to_one_unit(
    surveys: Sequence[Survey], names: Sequence[str]
) -> tuple[list[Survey], tuple[str, ...]]:
    """Return the surveys with elevations in the unit of the first that is known."""
    for one, name in zip(surveys, names, strict=True):
        _require_one_crs(surveys[0], names[0], one, name)
    found = agree(surveys, [f"'{name}'" for name in names])
    units = {one.elevation_unit for one in surveys}
    if found.crs is None and len(units) > 1:
        other = next(i for i, factor in enumerate(found.factors) if factor != 1.0)
        raise ReadError(
            f"Elevations of '{names[other]}' are in {surveys[other].elevation_unit} and others in "
            f"{found.elevation_unit}, and no CRS tells the unit of the eastings: declare the CRS.",
            path=Path(names[other]),
        )
    scaled = [
        scale_survey(one, factor, found.elevation_unit)
        for one, factor in zip(surveys, found.factors, strict=True)
    ]
    return scaled, found.notes if len(units) > 1 else ()


def _require_one_crs(first: Survey, its_name: str, other: Survey, name: str) -> None:
    ours, theirs = first.crs, other.crs
    if ours is theirs or (ours is not None and theirs is not None and ours.is_same(theirs)):
        return
    raise CrsError(
        f"'{its_name}' and '{name}' are not in one CRS: {_name_crs(ours)} and {_name_crs(theirs)}; "
        "declare the one that is wanted, to which others are reprojected, or read them one by one.",
        crs=theirs,
    )


def _name_crs(crs: CRS | None) -> str:
    return "none is known" if crs is None else crs.label


def _describe_shared_places(
    points: Float64Array, counts: Sequence[int], names: Sequence[str]
) -> list[str]:
    order = np.lexsort((points[:, 1], points[:, 0]))  # rows of one place in their own order
    sorted_xy = points[order, :2]
    is_new = np.append(True, (sorted_xy[1:] != sorted_xy[:-1]).any(axis=1))
    first = order[np.flatnonzero(is_new)[np.cumsum(is_new) - 1]]
    file_of = np.repeat(np.arange(len(counts)), counts)
    is_shared = file_of[order] != file_of[first]
    if not is_shared.any():
        return []
    rows, earlier = order[is_shared], first[is_shared]
    least = int(np.argmin(rows))
    row, other = int(rows[least]), int(earlier[least])
    gap = float(np.abs(points[rows, 2] - points[earlier, 2]).max())
    x, y = points[row, :2].tolist()
    difference = f"elevations differ by up to {gap:.6g}" if gap else "with the same elevations"
    stand = "stands" if len(rows) == 1 else "stand"
    first_two = f"'{names[file_of[row]]}' and '{names[file_of[other]]}'"
    return [
        f"{counted(len(rows), 'point')} of one file {stand} where a point of another does (first: "
        f"{first_two} at x {coordinate(x)}, y {coordinate(y)}): {difference}."
    ]


def _describe_shared_numbers(surveys: Sequence[Survey], names: Sequence[str]) -> list[str]:
    seen: dict[Any, int] = {}
    shared: dict[Any, tuple[int, int]] = {}
    for place, one in enumerate(surveys):
        for number in set(np.asarray(one.attributes.get("number", ())).tolist()):
            if number in (None, "") or number != number:
                continue
            if seen.setdefault(number, place) != place:
                shared.setdefault(number, (seen[number], place))
    if not shared:
        return []
    number, (first, second) = next(iter(shared.items()))
    verb = "number is" if len(shared) == 1 else "numbers are"
    return [
        f"{len(shared):,} point {verb} in several files (first: {number} in '{names[first]}' and "
        f"'{names[second]}'); the attribute {SOURCE_FILE} tells them apart."
    ]
