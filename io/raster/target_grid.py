"""The cells of a raster file, for a raster that is to fit upon it."""

from __future__ import annotations

import os
from functools import wraps
from typing import TYPE_CHECKING, Any

from ... import terrain
from ...base.atomic import as_path
from ...base.crs import CRS
from ...terrain.gridding import Cells, to_grid
from ..door import names_its_file
from ..isolated import open_ordinary_file, require_local, require_readable
from .reading import read_georeference

if TYPE_CHECKING:
    from ...terrain import Raster


@names_its_file
def read_cells(path: str | os.PathLike[str]) -> Cells:
    """Read where the cells of a raster file lie, and their CRS, from its header.

    Parameters
    ----------
    path : str or os.PathLike
        A local file of a format that holds its own data, or a virtual raster of such files.

    Raises
    ------
    ReadError
        If the file is missing, an address, or of another format, or it has no georeference.
    OptionError
        If its cells are turned or not square.
    CrsError
        If its CRS is none of eastings and northings.
    MissingExtraError
        If rasterio is not installed.
    """
    require_local(path)
    file = as_path(path)
    with open_ordinary_file(file) as local:
        require_readable(local)
        transform, shape, crs = read_georeference(local)
    return Cells(to_grid(transform, shape, os.fspath(path)), CRS.of(crs))


@wraps(terrain.rasterize)
def rasterize(*given: Any, like: Any = None, **options: Any) -> Raster:
    """Turn a surface into a raster; ``like`` may be the path of a raster file, too."""
    if isinstance(like, str | os.PathLike):
        given_twice = any(options.get(name) is not None for name in ("spacing", "grid"))
        like = like if given_twice else read_cells(like)  # what is refused is not read
    return terrain.rasterize(*given, like=like, **options)
