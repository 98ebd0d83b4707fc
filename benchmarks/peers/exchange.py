"""Other programs that write and read the formats of lidar, GIS, CAD and viewers."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import numpy as np

from tinsmith.base.arrays import Float64Array
from tinsmith.tin import TIN

__all__ = [
    "read_cloud_with_laspy",
    "read_triangles",
    "write_cloud_with_laspy",
    "write_drawing_with_ezdxf",
    "write_triangles_with_arrow",
    "write_triangles_with_pyogrio",
    "write_with_trimesh",
]

_DRIVERS = {".gpkg": "GPKG", ".fgb": "FlatGeobuf", ".shp": "ESRI Shapefile"}
_SCALE = 0.001


# ------------------------------------------------------------------------------- lidar


def write_cloud_with_laspy(points: Float64Array, path: Path) -> None:
    """Write points as LAZ 1.4 of format 6, with millimetres."""
    import laspy

    header = laspy.LasHeader(version="1.4", point_format=6)
    header.scales, header.offsets = np.full(3, _SCALE), np.floor(points.min(axis=0))
    cloud = laspy.LasData(header)
    cloud.x, cloud.y, cloud.z = points.T
    cloud.classification = np.full(len(points), 2, np.uint8)
    cloud.write(path)


def read_cloud_with_laspy(path: Path) -> Float64Array:
    """Return the coordinates; laspy decompresses every attribute."""
    import laspy

    cloud = laspy.read(path)
    return np.stack([np.asarray(cloud.x), np.asarray(cloud.y), np.asarray(cloud.z)], axis=1)


# --------------------------------------------------------------------------------- GIS


def _make_polygons(tin: TIN) -> Any:
    import shapely

    return shapely.polygons(tin.points[tin.triangles[:, [0, 1, 2, 0]]])


def write_triangles_with_pyogrio(tin: TIN, path: Path) -> None:
    """Write triangles as polygons with a number, through shapely."""
    import pyogrio.raw
    import shapely

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        pyogrio.raw.write(
            str(path),
            shapely.to_wkb(_make_polygons(tin), flavor="iso"),
            [np.arange(len(tin.triangles))],
            ["id"],
            geometry_type="Polygon Z",
            crs=str(tin.crs),
            driver=_DRIVERS[path.suffix],
        )


def write_triangles_with_arrow(tin: TIN, path: Path) -> None:
    """Write triangles and their number as GeoParquet through shapely, pandas and pyarrow."""
    import geopandas

    numbers = {"id": np.arange(len(tin.triangles))}
    frame = geopandas.GeoDataFrame(numbers, geometry=_make_polygons(tin), crs=str(tin.crs))
    frame.to_parquet(path)


def read_triangles(path: Path) -> Float64Array:
    """Return the corners of the polygons of a layer, (m, 3, 3), in the order of their columns."""
    import shapely

    if path.suffix == ".parquet":
        from pyarrow import parquet

        wkb = parquet.read_table(path, columns=["geometry"]).column(0).to_numpy()
    else:
        import pyogrio.raw

        layer = "triangles" if path.suffix == ".gpkg" and _has_layers(path) else None
        wkb = pyogrio.raw.read(path, layer=layer, columns=[])[2]
    corners = shapely.get_coordinates(shapely.from_wkb(wkb), include_z=True)
    return corners.reshape(-1, 4, 3)[:, :3]


def _has_layers(path: Path) -> bool:
    import pyogrio

    return len(pyogrio.list_layers(path)) > 1


# ------------------------------------------------------------------------- CAD, viewers


def write_drawing_with_ezdxf(tin: TIN, path: Path) -> None:
    """Write triangles as 3DFACEs of an R2010 drawing."""
    import ezdxf

    drawing = ezdxf.new("R2010")
    space = drawing.modelspace()
    for a, b, c in tin.points[tin.triangles].tolist():
        space.add_3dface([a, b, c, c])
    drawing.saveas(path)


def write_with_trimesh(tin: TIN, path: Path) -> None:
    """Write a mesh of single precision about an origin."""
    import trimesh

    origin = tin.points.min(axis=0)
    trimesh.Trimesh(tin.points - origin, tin.triangles, process=False).export(path)
