"""The header of a raster, and its strips of cells, as a child process reads them."""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base import optional
from ...base.types import Affine
from ..isolated import Limits, choose_limits, run_isolated, stream_isolated
from .virtual import is_virtual, require_plain_sources

if TYPE_CHECKING:
    from collections.abc import Iterator
    from contextlib import AbstractContextManager
    from pathlib import Path

    from ..isolated import Answer


@dataclass(frozen=True, slots=True)
class Header:
    """What a raster says of itself, and how its cells are read; see raster_gdal.header."""

    path: Path
    count: int
    subdatasets: list[str]
    colours: list[str]
    dtypes: list[str]
    width: int
    height: int
    transform: Affine
    block_height: int
    block_width: int
    scales: list[float]
    offsets: list[float]
    nodata: list[float | None]
    """Values of cells without data that it declares, of each band."""
    units: list[str | None]
    crs: str | None
    meanings: list[dict[str, str]]
    """Of the first bands: what names and describes them."""
    tags: dict[str, str]
    """Units and standard names of the variables of netCDF."""
    limits: Limits | None

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """West, south, east, north of an upright box around all cells."""
        columns = np.array([0, self.width, 0, self.width])
        with np.errstate(over="ignore", invalid="ignore"):
            x, y = self.transform.apply(columns, np.array([0, 0, self.height, self.height]))
        return float(x.min()), float(y.min()), float(x.max()), float(y.max())


def read_header(path: Path) -> Header:
    """Let a child open a raster, and return what it says of itself."""
    optional.require("rasterio", "Reading a raster")
    sources = require_plain_sources(path) if is_virtual(path) else []
    limits = choose_limits(sum(one.stat().st_size for one in [path, *sources] if one.is_file()))
    found = run_isolated(
        f"{_choose_reader(path)}:read_header", _name_for_gdal(path), path=path, limits=limits
    ).value
    transform = Affine(*found.pop("transform"))
    return Header(path=path, transform=transform, limits=limits, **found)


def _choose_reader(path: Path) -> str:
    return f"{__package__}.virtual_child" if is_virtual(path) else f"{__package__}.gdal_child"


def _name_for_gdal(path: Path) -> dict[str, Any]:
    """Return what names the file to GDAL: an absolute path is never a scheme or a prefix."""
    return {"path": os.path.abspath(path), "is_virtual": is_virtual(path)}  # noqa: PTH100 - links stay


def stream_strips(
    dataset: Header, where: dict[str, Any]
) -> AbstractContextManager[Iterator[Answer]]:
    """Let a child read the strips of a file."""
    return stream_isolated(
        f"{_choose_reader(dataset.path)}:read_strips",
        {**_name_for_gdal(dataset.path), **where},
        path=dataset.path,
        limits=dataset.limits,
    )
