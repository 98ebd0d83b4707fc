"""Write a TIN as CityJSON 2.0: one TINRelief of one CompositeSurface.

Vertices are whole numbers on a decimal grid that ``transform`` tells. The CRS is its OGC address
where it has an EPSG number; attributes of the city object keep what CityJSON has no place for, the
unit of elevations and a CRS without a number.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ....base.atomic import replacing
from ....base.errors import OptionError, WriteError
from ....base.notes import warn
from ....base.sentences import FILE, counted
from ....tin.topology import mark_corners
from ..common import format_crs, format_unit, require_tin

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from ....base.arrays import Float64Array, Int64Array
    from ....base.progress import Tell
    from ....tin import TIN

_BATCH = 65_536
_NAME = "terrain"


_MOST_DIGITS = 15
_LARGEST_EXACT = 2.0**53


@dataclass(frozen=True)
class DecimalGrid:
    """Places at a whole number of steps from an origin."""

    digits: int
    """Decimals: the step is 10 to the power of minus this."""
    origin: int
    """In whole units."""

    @property
    def step(self) -> float:
        """Distance of two neighbours."""
        return float(f"1e-{self.digits}")

    def count(self, values: Float64Array) -> Int64Array:
        """Return the nearest place of each value."""
        return np.asarray(np.rint((values - self.origin) * 10.0**self.digits), np.int64)

    def restore(self, counts: Int64Array) -> Float64Array:
        """Return the decimals, each rounded once to the nearest float64."""
        whole = counts.astype(np.float64) + self.origin * 10.0**self.digits
        return np.asarray(whole / 10.0**self.digits)


def choose_digits(values: Float64Array) -> int:
    """Return the fewest decimals that hold every value; else those at which float64 ends.

    Examples
    --------
    >>> choose_digits(np.array([745000.25, 1.5]))
    2
    """
    largest = float(np.abs(values).max(initial=1.0))
    most = int(np.clip(np.floor(np.log10(_LARGEST_EXACT / max(largest, 1.0))), 0, _MOST_DIGITS))
    for digits in range(most):
        factor = 10.0**digits
        if (np.rint(values * factor) / factor == values).all():
            return digits
    return most


def write(
    surface: TIN, path: Path, *, precision: float | None = None, progress: Tell | None = None
) -> None:
    """Write a TIN as CityJSON 2.0.

    Parameters
    ----------
    precision : float, optional
        Step of the coordinates, a power of ten such as 0.001, in the units of each axis; default
        the coarsest that holds every digit.

    Raises
    ------
    OptionError
        If ``precision`` is no power of ten from 1e-15 to 1.
    WriteError
        Also if triangles lose their area at this precision.

    Warns
    -----
    LossWarning
        If the CRS has no EPSG number: programs other than this one do not find it.
    """
    tin = require_tin(surface, format_name="CityJSON")
    used = mark_corners(tin.triangles, len(tin.points))
    points = tin.points[used]
    triangles = (np.cumsum(used) - 1)[tin.triangles]
    grids = [_choose_grid(axis, precision) for axis in points.T]
    counts = np.stack([grid.count(axis) for grid, axis in zip(grids, points.T, strict=True)], 1)
    _require_areas(counts, triangles, grids)
    done, total = 0, len(counts) + len(triangles)
    head, middle = _format_head(tin, grids, counts), ']}]}},\n"vertices":[\n'
    with replacing(path, binary=False) as file:
        for start, rows, form in (
            (head, triangles, "[[%d,%d,%d]]"),
            (middle, counts, "[%d,%d,%d]"),
        ):
            file.write(start)
            for n_rows, text in _iterate_rows(rows, form):
                file.write(text)
                done += n_rows
                if progress is not None:
                    progress(done / total)
        file.write("]}\n")


def _choose_grid(values: Float64Array, precision: float | None) -> DecimalGrid:
    digits = choose_digits(values) if precision is None else _count_digits(precision)
    return DecimalGrid(digits, int(np.floor(values.min())))


def _count_digits(precision: float) -> int:
    for digits in range(_MOST_DIGITS + 1):
        if precision == float(f"1e-{digits}"):
            return digits
    raise OptionError("precision", precision, "a power of ten from 1e-15 to 1, such as 0.001")


def _require_areas(counts: Int64Array, triangles: Int64Array, grids: list[DecimalGrid]) -> None:
    """Refuse a grid on which triangles are turned over or lose their area."""
    places = np.column_stack([grids[k].restore(counts[:, k]) for k in (0, 1)])
    places -= places.min(axis=0)
    a, b, c = (places[triangles[:, k]] for k in range(3))
    u, v = b - a, c - a
    lost = int((u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0] <= 0).sum())
    if lost:
        raise WriteError(
            f"Cannot write {FILE}: at a precision of {grids[0].step:g} "
            f"{counted(lost, 'triangle')} would have no area; choose a finer one."
        )


def _format_head(tin: TIN, grids: list[DecimalGrid], counts: Int64Array) -> str:
    low = [grid.restore(column.min()) for grid, column in zip(grids, counts.T, strict=True)]
    high = [grid.restore(column.max()) for grid, column in zip(grids, counts.T, strict=True)]
    metadata: dict[str, Any] = {"geographicalExtent": [float(value) for value in (*low, *high)]}
    if url := _find_reference(tin):
        metadata["referenceSystem"] = url
    transform = {
        "scale": [grid.step for grid in grids],
        "translate": [float(grid.origin) for grid in grids],
    }
    attributes = {}
    if unit := format_unit(tin):
        attributes["elevationUnit"] = unit
    if tin.crs is not None and tin.crs.to_epsg() is None:
        attributes["crs"] = format_crs(tin.crs)
    relief = '"type":"TINRelief",' + (
        f'"attributes":{json.dumps(attributes)},' if attributes else ""
    )
    return (
        f'{{"type":"CityJSON","version":"2.0",\n"metadata":{json.dumps(metadata)},\n'
        f'"transform":{json.dumps(transform)},\n"CityObjects":{{"{_NAME}":{{{relief}'
        '"geometry":[{"type":"CompositeSurface","lod":"1","boundaries":[\n'
    )


def _find_reference(tin: TIN) -> str | None:
    if tin.crs is None:
        return None
    epsg = tin.crs.to_epsg()
    if epsg is None:
        warn(
            f"CityJSON names a CRS by its EPSG number, and {tin.crs.label} has none: it is kept as "
            "an attribute that other programs do not look for."
        )
        return None
    return f"https://www.opengis.net/def/crs/EPSG/0/{epsg}"


def _iterate_rows(rows: Int64Array, row: str) -> Iterator[tuple[int, str]]:
    for start in range(0, len(rows), _BATCH):
        part = rows[start : start + _BATCH]
        text = ",\n".join([row] * len(part)) % tuple(part.ravel().tolist())
        yield len(part), text + ("\n" if start + len(part) == len(rows) else ",\n")
