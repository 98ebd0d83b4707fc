"""Triangles of any kind as files of every format of meshes, written without the package."""

from __future__ import annotations

import json
import struct
from pathlib import Path
from typing import Any

import numpy as np

from .selafin_files import make_selafin

__all__ = ["FACE_WRITERS", "write_faces"]

_TILE = "14/17000/12000"


def write_faces(
    kind: str, points: Any, triangles: Any, folder: Path
) -> tuple[Path, dict[str, Any]]:
    """Write triangles of whole steps (0 to 32,767); return the path and options of its reader."""
    return FACE_WRITERS[kind](np.asarray(points, float), np.asarray(triangles), Path(folder))


def _rows(values: Any, form: str = "{} {} {}\n") -> str:
    return "".join(form.format(*row) for row in np.asarray(values).tolist())


def _write_text(path: Path, text: str) -> tuple[Path, dict[str, Any]]:
    path.write_text(text)
    return path, {}


def _write_ply(points: Any, triangles: Any, folder: Path) -> Any:
    head = f"ply\nformat ascii 1.0\nelement vertex {len(points)}\n"
    head += "".join(f"property double {axis}\n" for axis in "xyz")
    head += f"element face {len(triangles)}\nproperty list uchar int vertex_indices\nend_header\n"
    return _write_text(folder / "a.ply", head + _rows(points) + _rows(triangles, "3 {} {} {}\n"))


def _write_obj(points: Any, triangles: Any, folder: Path) -> Any:
    faces = _rows(triangles + 1, "f {} {} {}\n")
    return _write_text(folder / "a.obj", _rows(points, "v {} {} {}\n") + faces)


def _write_off(points: Any, triangles: Any, folder: Path) -> Any:
    head = f"OFF\n{len(points)} {len(triangles)} 0\n"
    return _write_text(folder / "a.off", head + _rows(points) + _rows(triangles, "3 {} {} {}\n"))


def _write_2dm(points: Any, triangles: Any, folder: Path) -> Any:
    nodes = "".join(f"ND {k} {x} {y} {z}\n" for k, (x, y, z) in enumerate(points.tolist(), 1))
    rows = enumerate((triangles + 1).tolist(), 1)
    return _write_text(
        folder / "a.2dm",
        "MESH2D\n" + nodes + "".join(f"E3T {k} {a} {b} {c} 1\n" for k, (a, b, c) in rows),
    )


def _write_adcirc(points: Any, triangles: Any, folder: Path) -> Any:
    nodes = "".join(f"{k} {x} {y} {-z}\n" for k, (x, y, z) in enumerate(points.tolist(), 1))
    faces = enumerate((triangles + 1).tolist(), 1)
    elements = "".join(f"{k} 3 {a} {b} {c}\n" for k, (a, b, c) in faces)
    head = f"depths\n{len(triangles)} {len(points)}\n"
    return _write_text(folder / "a.gr3", head + nodes + elements)


def _write_selafin(points: Any, triangles: Any, folder: Path) -> Any:
    path = folder / "a.slf"
    frames = [(0.0, [points[:, 2]])]
    path.write_bytes(make_selafin(points[:, :2], triangles + 1, [("FOND", "M")], frames))
    return path, {}


def _write_stl(points: Any, triangles: Any, folder: Path) -> Any:
    facets = np.zeros(len(triangles), [("n", "<f4", 3), ("c", "<f4", (3, 3)), ("a", "<u2")])
    facets["c"] = points[triangles]
    path = folder / "a.stl"
    path.write_bytes(bytes(80) + struct.pack("<I", len(facets)) + facets.tobytes())
    return path, {}


def _write_with_meshio(suffix: str, **how: Any) -> Any:
    def write(points: Any, triangles: Any, folder: Path) -> Any:
        import meshio

        path = folder / f"a{suffix}"
        tags = {"gmsh:physical": [np.ones(len(triangles), int)],
                "gmsh:geometrical": [np.ones(len(triangles), int)]}  # fmt: skip
        data = tags if suffix == ".msh" else {}
        meshio.Mesh(points, [("triangle", triangles)], cell_data=data).write(path, **how)
        return path, {}

    return write


def _write_ugrid(points: Any, triangles: Any, folder: Path) -> Any:
    import netCDF4

    path = folder / "a.nc"
    with netCDF4.Dataset(path, "w") as file:
        file.Conventions = "UGRID-1.0"
        file.createDimension("node", len(points))
        file.createDimension("face", len(triangles))
        file.createDimension("three", 3)
        mesh = file.createVariable("mesh", "i4")
        mesh.cf_role, mesh.topology_dimension = "mesh_topology", 2
        mesh.node_coordinates, mesh.face_node_connectivity = "node_x node_y", "faces"
        for k, name in enumerate(("node_x", "node_y", "node_z")):
            values = file.createVariable(name, "f8", ("node",))
            values.standard_name = ("projection_x_coordinate", "projection_y_coordinate",
                                    "altitude")[k]  # fmt: skip
            values.units = "m"
            values[:] = points[:, k]
        file["node_z"].mesh, file["node_z"].location = "mesh", "node"
        faces = file.createVariable("faces", "i4", ("face", "three"))
        faces.start_index = 0
        faces[:] = triangles
    return path, {}


def _write_cityjson(points: Any, triangles: Any, folder: Path) -> Any:
    geometry = {
        "type": "CompositeSurface",
        "lod": "1",
        "boundaries": [[one] for one in triangles.tolist()],
    }
    city = {
        "type": "CityJSON",
        "version": "2.0",
        "CityObjects": {"a": {"type": "TINRelief", "geometry": [geometry]}},
        "vertices": np.rint(points * 1000).astype(int).tolist(),
        "transform": {"scale": [0.001] * 3, "translate": [0, 0, 0]},
    }
    return _write_text(folder / "a.city.json", json.dumps(city))


def _write_landxml(points: Any, triangles: Any, folder: Path) -> Any:
    rows = enumerate(points.tolist(), 1)
    told = "".join(f'<P id="{k}">{y} {x} {z}</P>' for k, (x, y, z) in rows)
    faces = _rows(triangles + 1, "<F>{} {} {}</F>")
    return _write_text(
        folder / "a.xml",
        '<LandXML version="1.2"><Units><Metric linearUnit="meter"/></Units><Surfaces><Surface '
        f'name="s"><Definition surfType="TIN"><Pnts>{told}</Pnts><Faces>{faces}</Faces>'
        "</Definition></Surface></Surfaces></LandXML>",
    )


def _write_12da(points: Any, triangles: Any, folder: Path) -> Any:
    faces = _rows(triangles[:, ::-1] + 1)
    return _write_text(
        folder / "a.12da",
        f"tin {{\nname s\npoints {{\n{_rows(points)}}}\ntriangles {{\n{faces}}}\n}}\n",
    )


def _write_dxf(points: Any, triangles: Any, folder: Path) -> Any:
    import ezdxf

    drawing = ezdxf.new()
    drawing.header["$INSUNITS"] = 6
    for corners in points[triangles].tolist():
        drawing.modelspace().add_3dface(corners)
    drawing.saveas(folder / "a.dxf")
    return folder / "a.dxf", {}


def _write_polygons(suffix: str) -> Any:
    def write(points: Any, triangles: Any, folder: Path) -> Any:
        import geopandas
        import shapely

        path = folder / f"a{suffix}"
        shapes = [shapely.Polygon(corners) for corners in points[triangles]]
        geopandas.GeoDataFrame(geometry=shapes, crs="EPSG:32616").to_file(path, engine="pyogrio")
        return path, {"elevation_unit": "m"}

    return write


def _write_tile(points: Any, triangles: Any, folder: Path) -> Any:
    from tinsmith.io.mesh.quantized_mesh.tile import Tile, TileName, encode_tile

    level, x, y = map(int, _TILE.split("/"))
    tile = Tile(np.rint(points).astype(np.int64), triangles.astype(np.int64), 0.0, 100.0)
    path = folder / "a.terrain"
    path.write_bytes(encode_tile(tile, TileName(level, x, y)))
    return path, {"tile": _TILE}


FACE_WRITERS = {
    "ply": _write_ply,
    "obj": _write_obj,
    "off": _write_off,
    "2dm": _write_2dm,
    "adcirc": _write_adcirc,
    "selafin": _write_selafin,
    "stl": _write_stl,
    "vtu": _write_with_meshio(".vtu"),
    "msh": _write_with_meshio(".msh", file_format="gmsh22", binary=False),
    "ugrid": _write_ugrid,
    "cityjson": _write_cityjson,
    "landxml": _write_landxml,
    "12da": _write_12da,
    "dxf": _write_dxf,
    "gpkg": _write_polygons(".gpkg"),
    "shp": _write_polygons(".shp"),
    "terrain": _write_tile,
}
