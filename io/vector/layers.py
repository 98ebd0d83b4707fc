"""A layer of a vector file, by whatever road it was read."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...base import optional
from ...base.sentences import FILE

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from ...base.arrays import AnyArray, Int64Array, ObjectArray
    from ...base.crs import CRS


_POLYGON = 3


class Layer(NamedTuple):
    """What a layer holds."""

    path: Path
    numbers: Int64Array
    """(n,), feature numbers as GDAL counts them."""
    geometries: ObjectArray
    """(n,), Shapely geometries, none of them missing or empty."""
    columns: dict[str, AnyArray]
    """Each (n,), by their names in lower case; those that only capitals keep apart by their own."""
    crs: CRS | None
    notes: tuple[str, ...]
    """What was left out."""
    names: tuple[str, ...] = ()
    """Of the columns, as the file writes them."""
    elevation_unit: str = ""
    """What the file calls the unit of its elevations, apart from its CRS; empty if it does not."""

    def label(self, row: int) -> str:
        """Return what a feature is called in sentences."""
        return f"{FILE}: feature {self.numbers[row]}"

    def find_column(self, name: str) -> AnyArray | None:
        """Return the column of a name, whatever its capitals unless they keep two apart."""
        if name in self.columns:
            return self.columns[name]
        same = [key for key in self.columns if key.lower() == name.lower()]
        return self.columns[same[0]] if len(same) == 1 else None


def take_apart(features: Layer) -> tuple[ObjectArray, Int64Array]:
    """Return single geometries, and the row of the feature of each; collections may be nested."""
    shapely = optional.load("shapely")
    shapes, rows = features.geometries, np.arange(len(features.geometries))
    while (shapely.get_type_id(shapes) > _POLYGON).any():
        shapes, index = shapely.get_parts(shapes, return_index=True)
        rows = rows[index]
    there = ~shapely.is_empty(shapes)
    return shapes[there], rows[there]


def list_lines(features: Layer) -> tuple[ObjectArray, Int64Array, Int64Array]:
    """Return lines and rings, the row of the feature of each, and the number of its geometry."""
    shapely = optional.load("shapely")
    shapes, rows = take_apart(features)
    is_polygon = shapely.get_type_id(shapes) == _POLYGON
    rings, of_polygon = shapely.get_rings(shapes[is_polygon], return_index=True)
    slots = np.concatenate([np.flatnonzero(~is_polygon), np.flatnonzero(is_polygon)[of_polygon]])
    order = np.argsort(slots, kind="stable")
    slots = slots[order]
    return np.concatenate([shapes[~is_polygon], rings])[order], rows[slots], slots


def name_apart(names: Sequence[str]) -> list[str]:
    """Return names of which no two are the same: a number follows those that come again.

    Examples
    --------
    >>> name_apart(["a", "b", "a", "a_2"])
    ['a', 'b', 'a_2', 'a_2_2']
    """
    taken: dict[str, None] = {}
    for name in names:
        candidate, number = name, 1
        while candidate in taken:
            number += 1
            candidate = f"{name}_{number}"
        taken[candidate] = None
    return list(taken)


def name_columns(names: Sequence[str]) -> list[str]:
    """Return the names of columns in lower case, as they are where only capitals differ.

    Examples
    --------
    >>> name_columns(["Code", "Elev", "elev"])
    ['code', 'Elev', 'elev']
    """
    apart = name_apart(names)
    counts = Counter(name.lower() for name in apart)
    return [name.lower() if counts[name.lower()] == 1 else name for name in apart]
