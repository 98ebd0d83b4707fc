"""CSV (RFC 4180): tables, and features that are points, with units in the header."""

from __future__ import annotations

import csv
import re
from itertools import chain
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.atomic import replacing
from ...base.checks import as_flag, require_count
from ...base.errors import FormatError
from ...base.results import Features, Table, unit_text
from ...base.sentences import FILE
from ..registry import warn_of_formulas

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from pathlib import Path

    from ...base.arrays import AnyArray
    from ...base.progress import Tell
    from ...base.results import Units

_CHUNK_ROWS = 100_000
_AXES = ("easting", "northing", "elevation")
_MOST_DECIMALS = 15
_ZERO = re.compile(r"-0(\.0*)?")


def write(
    obj: Table | Features,
    path: Path,
    *,
    header: bool = True,
    decimals: int | None = None,
    progress: Tell | None = None,
) -> None:
    """Write a table, or points with their columns: cells parted by commas, in a ``.tsv`` by tabs.

    Features that are lines or polygons, and a column of points with the name of a coordinate, are
    refused with a FormatError.

    Parameters
    ----------
    header : bool
        Whether the first line names the columns, as instruments in the field often do not take it.
    decimals : int, optional
        Digits behind the point, from 0 to 15, of numbers that are no integers; default those that
        read back as the same number.

    Notes
    -----
    The header has the unit of a column in brackets: ``volume (m³)``, ``depth (unknown)`` where it
    is not known, and nothing where there is none. Every number is written so that it reads back
    as the same float64, unless decimals are asked for; NaN and missing texts are empty. Lines end
    with CR LF, as RFC 4180 has it. Notes and the CRS have no place in a CSV.
    """
    as_flag("header", header)
    if decimals is not None:
        require_count("decimals", decimals, least=0, most=_MOST_DECIMALS)
    table = obj if isinstance(obj, Table) else _require_points(obj)
    names = [[header_text(name, table.units) for name in table.columns]] if header else []
    columns = list(table.columns.values())
    warn_of_formulas(table.columns)
    delimiter = "\t" if path.suffix.lower() == ".tsv" else ","
    with replacing(path, binary=False) as file:
        writer = csv.writer(file, delimiter=delimiter, lineterminator="\r\n")
        writer.writerows(chain(names, _iterate_rows(columns, len(table), decimals, progress)))


def header_text(name: str, units: Units) -> str:
    """Return the name of a column with its unit in brackets, if it has one.

    Examples
    --------
    >>> header_text("volume", {"volume": "m³"}), header_text("depth", {"depth": None})
    ('volume (m³)', 'depth (unknown)')
    """
    unit = unit_text(units, name)
    return f"{name} ({unit})" if unit else name


def _require_points(features: Features) -> Table:
    """Return points as a table, or refuse features that cannot be one."""
    if features.kind != "points":
        raise FormatError(
            f"Cannot write {FILE}: CSV holds points, not {features.kind}; GeoJSON and GeoPackage "
            "hold them."
        )
    axes = zip(_AXES, features.coordinates.T, strict=False)  # places may have no elevation
    taken = [
        name
        for name, values in axes
        if name in features.columns
        and not (
            np.array_equal(features.columns[name], values)
            and features.units.get(name, features.elevation_unit) == features.elevation_unit
        )
    ]
    if taken:
        raise FormatError(
            f"Cannot write {FILE}: the points have a coordinate and a column that are both "
            f"called '{taken[0]}': rename the column."
        )
    return tabulate_points(features)


def tabulate_points(features: Features) -> Table:
    """Return points as a table of their coordinates and columns; a column of such a name counts."""
    axes = _AXES[: features.coordinates.shape[1]]
    units = {} if features.crs is None else dict.fromkeys(axes[:2], features.crs.horizontal_unit)
    heights = {"elevation": features.elevation_unit} if features.has_elevations else {}
    return Table(
        {**dict(zip(axes, features.coordinates.T, strict=True)), **features.columns},
        units={**units, **heights, **features.units},
        name=features.name,
        notes=features.notes,
    )


def _iterate_rows(
    columns: Sequence[AnyArray], count: int, decimals: int | None, progress: Tell | None
) -> Iterator[tuple[Any, ...]]:
    for start in range(0, count, _CHUNK_ROWS):
        stop = min(start + _CHUNK_ROWS, count)
        yield from zip(*(_format_cells(one[start:stop], decimals) for one in columns), strict=True)
        if progress is not None:
            progress(stop / count)


def _format_cells(values: AnyArray, decimals: int | None) -> list[Any]:
    """Return values as CSV has them: empty where there is none."""
    if values.dtype.kind == "b":
        return [("false", "true")[value] for value in values.tolist()]
    cells: list[Any] = values.tolist()
    if values.dtype.kind != "f":
        return cells
    if decimals is not None:
        texts = ["" if value != value else f"{value:.{decimals}f}" for value in cells]
        return [text.removeprefix("-") if _ZERO.fullmatch(text) else text for text in texts]
    if np.isnan(values).any():
        return ["" if value != value else value for value in cells]
    return cells  # csv writes the shortest digits of a float, and nothing for None
