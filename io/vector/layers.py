"""What a layer of a vector file holds, however it was read."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from pathlib import Path

    import numpy as np
    from numpy.typing import NDArray

    from ...crs import CRS

__all__ = ["Features"]


class Features(NamedTuple):
    """What a layer holds.

    Attributes
    ----------
    path : Path
    numbers : (n,) int64 array
        Feature numbers as GDAL counts them.
    geometries : (n,) object array
        Shapely geometries, none of them missing or empty.
    columns : dict of str to (n,) array
        By their names in lower case.
    crs : CRS or None
    notes : tuple of str
        What was left out.
    names : tuple of str
        Of the columns, as the file writes them.
    elevation_unit : str
        What the file calls the unit of its elevations, apart from its CRS; empty if it does not.
    """

    path: Path
    numbers: NDArray[np.int64]
    geometries: NDArray[np.object_]
    columns: dict[str, NDArray[Any]]
    crs: CRS | None
    notes: tuple[str, ...]
    names: tuple[str, ...] = ()
    elevation_unit: str = ""

    def label(self, row: int) -> str:
        """Return what a feature is called in sentences."""
        return f"'{self.path}': feature {self.numbers[row]}"
