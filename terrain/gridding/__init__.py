"""Gridding: a surface as a raster of cells, and cells' grids."""

from .bands import SurfaceBand
from .grids import (
    as_cells,
    cover,
    describe_extent,
    locate_edges,
    require_cells,
    require_overlap,
)
from .ground_heights import height_above
from .rasters import list_units, rasterize
from .relief_bands import DESCRIBED_MEANS, ReliefBand, describe_smooth

__all__ = [
    "DESCRIBED_MEANS",
    "ReliefBand",
    "SurfaceBand",
    "as_cells",
    "cover",
    "describe_extent",
    "describe_smooth",
    "height_above",
    "list_units",
    "locate_edges",
    "rasterize",
    "require_cells",
    "require_overlap",
]
