"""The cells of a raster file, for a raster that is to fit upon it."""

from __future__ import annotations

import os
from functools import wraps
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any, TypeVar, cast

from ... import terrain
from ...base.atomic import as_path
from ...base.crs import CRS
from ...base.notes import naming_file
from ...terrain.gridding import Cells, to_grid
from ..isolated import (
    as_bytes,
    is_file_object,
    name_stream,
    open_ordinary_file,
    require_local,
    require_readable,
    spool,
    unpack_member,
)
from .reading import read_georeference

if TYPE_CHECKING:
    from collections.abc import Callable

    F = TypeVar("F", bound="Callable[..., Any]")


def read_cells(path: str | os.PathLike[str] | IO[bytes]) -> Cells:
    """Read where the cells of a raster file lie, and their CRS, from its header.

    Parameters
    ----------
    path : str, os.PathLike or binary file object
        A local file of a format that holds its own data, or a virtual raster of such files;
        ``/vsizip/site.zip/dem.tif`` names one of an archive. Of a file object the whole is copied.

    Raises
    ------
    ReadError
        If the file is missing, an address, or of another format, or it has no georeference.
    OptionError
        If its cells have no area.
    CrsError
        If its CRS is none of eastings and northings.
    MissingExtraError
        If rasterio is not installed.
    """
    if is_file_object(path):
        name = Path(name_stream(path, (".tif",)))
        with naming_file(name), spool(as_bytes(path), name) as copy:
            return _read_local(copy, str(name))
    place = cast("str | os.PathLike[str]", path)
    with naming_file(Path(place)), unpack_member(place) as member:
        require_local(member)
        with open_ordinary_file(as_path(member)) as local:
            require_readable(local)
            return _read_local(local, os.fspath(place))


def _read_local(path: Path, name: str) -> Cells:
    transform, shape, crs, stored_as = read_georeference(path)
    return Cells(to_grid(transform, shape, name), CRS.of(crs), stored_as)


def take_cells(like: Any) -> Any:
    """Return the cells of a path or a file object; what else a product takes as it is."""
    if isinstance(like, str | os.PathLike) or is_file_object(like):
        return read_cells(cast("Any", like))
    return like


def _reads_cells(function: F) -> F:
    """Let ``like`` of a product be the path of a raster file, or a file object, too."""

    @wraps(function)
    def call(*given: Any, like: Any = None, **options: Any) -> Any:
        if all(options.get(name) is None for name in ("spacing", "grid")):
            like = take_cells(like)  # what is refused is not read
        return function(*given, like=like, **options)

    return cast("F", call)


rasterize = _reads_cells(terrain.rasterize)
rasterize_canopy = _reads_cells(terrain.rasterize_canopy)
rasterize_counts = _reads_cells(terrain.rasterize_counts)
rasterize_heights = _reads_cells(terrain.rasterize_heights)
hillshade = _reads_cells(terrain.hillshade)
