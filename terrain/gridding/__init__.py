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
from .point_cells import CellBlock, add_cells, count_points, find_highest, make_empty
from .point_rasters import (
    describe_points_outside,
    measure_heights,
    rasterize_counts,
    rasterize_heights,
    require_points,
)
from .rasters import list_units, rasterize
from .relief_bands import DESCRIBED_MEANS, ReliefBand, describe_smooth

__all__ = [
    "DESCRIBED_MEANS",
    "CellBlock",
    "ReliefBand",
    "SurfaceBand",
    "add_cells",
    "as_cells",
    "count_points",
    "cover",
    "describe_extent",
    "describe_points_outside",
    "describe_smooth",
    "find_highest",
    "height_above",
    "list_units",
    "locate_edges",
    "make_empty",
    "measure_heights",
    "rasterize",
    "rasterize_counts",
    "rasterize_heights",
    "require_cells",
    "require_overlap",
    "require_points",
]
