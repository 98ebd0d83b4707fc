"""Points of lidar as GeoParquet, in groups of rows that lie together, with their bounds."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from pathlib import Path

__all__ = ["write_row_groups"]

_GROUP = 65_536
_CELL = 100.0
"""Metres: points are in the order of such cells."""


def write_row_groups(source: Path, path: Path, *, classification: int = 2) -> Path:
    """Write the points of one class of a LAZ file as GeoParquet 1.1, unless that is there."""
    import geopandas
    import laspy
    import shapely

    if path.exists():
        return path
    cloud = laspy.read(source)
    xyz = np.asarray(cloud.xyz)[np.asarray(cloud.classification) == classification]
    column, row = np.floor((xyz[:, :2] - xyz[:, :2].min(axis=0)) / _CELL).astype(np.int64).T
    xyz = xyz[np.lexsort([column, row])]
    frame = geopandas.GeoDataFrame(geometry=shapely.points(xyz), crs=cloud.header.parse_crs())
    beside = path.with_suffix(".part")
    frame.to_parquet(beside, row_group_size=_GROUP, write_covering_bbox=True)
    beside.rename(path)
    return path
