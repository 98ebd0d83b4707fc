"""Virtual point clouds: one small file that names many of lidar, as QGIS opens it."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any
from urllib.parse import quote

import numpy as np

from ...base.atomic import replacing
from ...base.crs import CRS
from ..reprojection import find_bounds

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

_EXTENSIONS = (
    "https://stac-extensions.github.io/pointcloud/v1.0.0/schema.json",
    "https://stac-extensions.github.io/projection/v1.1.0/schema.json",
)
_SCHEMAS = [
    {"name": name, "size": size, "type": kind}
    for name, size, kind in (
        ("X", 8, "floating"),
        ("Y", 8, "floating"),
        ("Z", 8, "floating"),
        ("Intensity", 2, "unsigned"),
        ("ReturnNumber", 1, "unsigned"),
        ("NumberOfReturns", 1, "unsigned"),
        ("Classification", 1, "unsigned"),
    )
]
"""What every file that is written has; files may have more."""

_ENCODINGS = {".laz": "application/vnd.laszip", ".las": "application/vnd.las"}
_NO_CLOCK = "1970-01-01T00:00:00Z"
_WGS84 = "EPSG:4326"


@dataclass(frozen=True)
class NamedFile:
    """A file of a virtual point cloud.

    Attributes
    ----------
    path : Path
    count : int
        Points in it.
    low, high : sequence of float
        Bounds in space, (3,).
    """

    path: Path
    count: int
    low: Sequence[float]
    high: Sequence[float]


def write_virtual_cloud(path: Path, files: Sequence[NamedFile], crs: CRS) -> None:
    """Write a collection of items of STAC, one a file.

    Parameters
    ----------
    path : Path
        With the suffix ``.vpc``, in the folder of the files.
    files : sequence of NamedFile
    crs : CRS
        Of all of them.

    References
    ----------
    https://github.com/PDAL/wrench/blob/main/vpc-spec.md
    """
    items = [_describe(one, crs) for one in files]
    with replacing(path, binary=False) as file:
        json.dump({"type": "FeatureCollection", "features": items}, file, indent=1)


def _describe(one: NamedFile, crs: CRS) -> dict[str, Any]:
    low, high = np.asarray(one.low, np.float64), np.asarray(one.high, np.float64)
    bounds = find_bounds(low[:2], high[:2], crs, CRS.of(_WGS84))
    place: Mapping[str, Any] = {"geometry": None}
    if bounds is not None:
        west, south, east, north = bounds.xmin, bounds.ymin, bounds.xmax, bounds.ymax
        ring = [[west, south], [east, south], [east, north], [west, north], [west, south]]
        place = {
            "geometry": {"type": "Polygon", "coordinates": [ring]},
            "bbox": [west, south, float(low[2]), east, north, float(high[2])],
        }
    return {
        "type": "Feature",
        "stac_version": "1.0.0",
        "stac_extensions": list(_EXTENSIONS),
        "id": one.path.stem,
        **place,
        "properties": {
            "datetime": _NO_CLOCK,
            "pc:count": one.count,
            "pc:type": "lidar",
            "pc:encoding": _ENCODINGS[one.path.suffix.lower()],
            "pc:schemas": _SCHEMAS,
            "proj:wkt2": crs.to_wkt(),
            "proj:bbox": [*low.tolist(), *high.tolist()],
        },
        "links": [],
        "assets": {"data": {"href": f"./{quote(one.path.name)}", "roles": ["data"]}},
    }
