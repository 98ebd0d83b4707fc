"""Files that say something odd of their numbers: depths, errors, times, polygons, units."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np

import tinsmith as ts

from .placed_files import READ, write_points
from .selafin_files import make_selafin

__all__ = [
    "DEPTHS",
    "ERRORS",
    "QUADRILATERALS",
    "TIMES",
    "write_above_ground",
    "write_lines_in_feet",
    "write_points_in_degrees",
]

CRS = "EPSG:32616"
FOOT = 0.3048
_DRIVERS = {"geojsonseq": "GeoJSONSeq", "vector": "GML"}
File = tuple[Path, dict[str, Any]]
"""A file, and options to read it with."""


def _write(path: Path, text: str) -> File:
    path.write_text(text)
    return path, {}


def _rows(points: Any, form: str = "{} {} {}\n") -> str:
    return "".join(form.format(*row) for row in np.asarray(points).tolist())


# -------------------------------------------------------------------------------- text, cells


def _write_header(*names: str) -> Any:
    def write(points: Any, folder: Path) -> File:
        columns = np.column_stack([points, *[points[:, 2]] * (len(names) - 3)])
        rows = "".join(",".join(map(str, row)) + "\n" for row in columns.tolist())
        return _write(folder / "a.csv", ",".join(names) + "\n" + rows)

    return write


def _write_cells(n_times: int = 1, **attributes: str) -> Any:
    def write(points: Any, folder: Path) -> File:
        import netCDF4

        path = folder / "a.nc"
        with netCDF4.Dataset(path, "w") as data:
            for name, start in zip("xy", points[0, :2].tolist(), strict=True):
                data.createDimension(name, 4)
                axis = data.createVariable(name, "f8", (name,))
                axis[:] = start + 10 * np.arange(4)
                axis.standard_name, axis.units = f"projection_{name}_coordinate", "m"
            axes = ("y", "x") if n_times == 1 else ("time", "y", "x")
            if n_times > 1:
                data.createDimension("time", n_times)
                data.createVariable("time", "f8", ("time",))[:] = np.arange(n_times)
            level = data.createVariable("level", "f4", axes)
            level.setncatts({"units": "m", **attributes})
            level[:] = np.arange(16.0 * n_times).reshape([n_times, 4, 4][-len(axes) :]) + 30
        return path, {}

    return write


def _write_bands(points: Any, folder: Path) -> File:
    import rasterio
    from rasterio.transform import Affine

    size = {"width": 4, "height": 4, "count": 1, "dtype": "float32"}
    place = Affine(10, 0, points[0, 0], 0, -10, points[0, 1])
    with rasterio.open(folder / "a.tif", "w", driver="GTiff", transform=place, **size) as data:
        data.write(np.full((1, 4, 4), 0.3, "float32"))
        data.set_band_description(1, "uncertainty")
    return folder / "a.tif", {}


# ------------------------------------------------------------------------------------ meshes


def _write_ugrid(n_times: int = 1, **attributes: str) -> Any:
    def write(points: Any, folder: Path) -> File:
        import netCDF4

        path = folder / "a.nc"
        with netCDF4.Dataset(path, "w") as data:
            for name, size in (("node", 4), ("face", 1), ("corner", 4), ("time", n_times)):
                data.createDimension(name, size)
            mesh = data.createVariable("mesh", "i4")
            mesh.setncatts({"cf_role": "mesh_topology", "topology_dimension": 2})
            mesh.setncatts({"node_coordinates": "x y", "face_node_connectivity": "faces"})
            for k, name in enumerate("xy"):
                axis = data.createVariable(name, "f8", ("node",))
                axis.standard_name, axis.units = f"projection_{name}_coordinate", "m"
                axis[:] = points[:, k]
            axes = ("node",) if n_times == 1 else ("time", "node")
            level = data.createVariable("level", "f8", axes)
            level.setncatts({"mesh": "mesh", "location": "node", "units": "m", **attributes})
            level[:] = points[:, 2] if n_times == 1 else [points[:, 2]] * n_times
            data.createVariable("faces", "i4", ("face", "corner"))[:] = [_RING]
        return path, {}

    return write


_RING = [0, 1, 2, 3]


def _order(points: Any) -> Any:
    """Return four points as corners of a convex quadrilateral."""
    low = points.min(axis=0)
    return low + np.array([[0, 0, 0], [9, 0, 0], [9, 8, 0], [0, 8, 3.0]])


def _write_quadrilateral(name: str, form: str) -> Any:
    def write(points: Any, folder: Path) -> File:
        rows = _order(points)
        names = "".join(f"ND {k} {x} {y} {z}\n" for k, (x, y, z) in enumerate(rows.tolist(), 1))
        text = form.replace("POINTS", _rows(rows)).replace("OBJ", _rows(rows, "v {} {} {}\n"))
        return _write(folder / name, text.replace("NODES", names))

    return write


_PLY = (
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\n"
    "property double z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
    "POINTS4 0 1 2 3\n"
)


def _write_with_meshio(suffix: str) -> Any:
    def write(points: Any, folder: Path) -> File:
        import meshio

        tags = {"gmsh:physical": [np.ones(1, int)], "gmsh:geometrical": [np.ones(1, int)]}
        is_gmsh = suffix == ".msh"
        mesh = meshio.Mesh(
            _order(points), [("quad", np.array([_RING]))], cell_data=tags if is_gmsh else {}
        )
        mesh.write(folder / f"a{suffix}", **({"file_format": "gmsh"} if is_gmsh else {}))
        return folder / f"a{suffix}", {}

    return write


def _write_cityjson(points: Any, folder: Path) -> File:
    rows = _order(points)
    low = rows.min(axis=0)
    surface = {"type": "CompositeSurface", "lod": "1", "boundaries": [[_RING]]}
    city = {
        "type": "CityJSON",
        "version": "2.0",
        "CityObjects": {"a": {"type": "TINRelief", "geometry": [surface]}},
        "vertices": np.rint((rows - low) * 1000).astype(int).tolist(),
        "transform": {"scale": [0.001] * 3, "translate": low.tolist()},
    }
    return _write(folder / "a.city.json", json.dumps(city))


def _write_landxml(points: Any, folder: Path) -> File:
    rows = enumerate(_order(points).tolist(), 1)
    told = "".join(f'<P id="{k}">{y} {x} {z}</P>' for k, (x, y, z) in rows)
    return _write(
        folder / "a.xml",
        '<LandXML version="1.2"><Units><Metric linearUnit="meter"/></Units><Surfaces><Surface '
        f'name="s"><Definition surfType="TIN"><Pnts>{told}</Pnts><Faces><F>1 2 3 4</F></Faces>'
        "</Definition></Surface></Surfaces></LandXML>",
    )


def _write_dxf(points: Any, folder: Path) -> File:
    import ezdxf

    drawing = ezdxf.new()
    drawing.header["$INSUNITS"] = 6
    drawing.modelspace().add_3dface(_order(points).tolist())
    drawing.saveas(folder / "a.dxf")
    return folder / "a.dxf", {}


# ------------------------------------------------------------------------------------ layers


def _write_layer(name: str, column: str = "", *, of_polygons: bool = False) -> Any:
    """Write places with a column beside them, or polygons of four corners."""

    def write(points: Any, folder: Path) -> File:
        import geopandas
        import shapely

        shapes = list(map(shapely.Point, points[:, :2]))
        if of_polygons:
            shapes = [shapely.Polygon(_order(points))]
        columns = {column: points[:, 2]} if column else {}
        frame = geopandas.GeoDataFrame(columns, geometry=shapes, crs=CRS)
        return _save(frame, name, folder), {}

    return write


def _save(frame: Any, name: str, folder: Path) -> Path:
    path = folder / f"a{READ[name].suffixes[0]}"
    if name == "geoparquet":
        frame.to_parquet(path)
        return path
    path = path.with_suffix(".gml") if name == "vector" else path
    frame = frame.to_crs(4326) if name.startswith("geojson") else frame
    frame.to_file(path, **({"driver": _DRIVERS[name]} if name in _DRIVERS else {}))
    return path


def _write_adcirc(points: Any, folder: Path) -> File:
    rows = "".join(f"{k} {x} {y} {z}\n" for k, (x, y, z) in enumerate(_order(points).tolist(), 1))
    return _write(folder / "a.14", f"title\n1 4\n{rows}1 4 1 2 3 4\n")


def _write_selafin(name: str = "BOTTOM", *, n_times: int = 1) -> Any:
    def write(points: Any, folder: Path) -> File:
        rows = _order(points)
        frames = [(float(k), [rows[:, 2] + k]) for k in range(n_times)]
        path = folder / "a.slf"
        path.write_bytes(make_selafin(rows[:, :2], [[1, 2, 3, 4]], [(name, "M")], frames))
        return path, {}

    return write


_LAYERS = ("gpkg", "flatgeobuf", "shapefile", "geoparquet", "vector", "geojson", "geojsonseq")

DEPTHS = {
    "delimited": _write_header("Easting", "Northing", "Z (positive down)"),
    "raster": _write_cells(positive="down"),
    "adcirc": _write_adcirc,
    "selafin": _write_selafin("WATER DEPTH"),
    "ugrid": _write_ugrid(positive="down"),
    **{name: _write_layer(name, "depth") for name in _LAYERS},
}
ERRORS = {
    "delimited": _write_header("Easting", "Northing", "Elevation uncertainty"),
    "raster": _write_bands,
    "ugrid": _write_ugrid(standard_name="altitude standard_error"),
    "selafin": _write_selafin("ERROR"),
    **{name: _write_layer(name, "z_sd") for name in _LAYERS},
}
TIMES = {
    "delimited": _write_header("easting", "northing", "z 2019", "z 2020"),
    "raster": _write_cells(3, standard_name="altitude"),
    "ugrid": _write_ugrid(3, standard_name="altitude"),
    "selafin": _write_selafin(n_times=3),
}
QUADRILATERALS = {
    "ply": _write_quadrilateral("a.ply", _PLY),
    "obj": _write_quadrilateral("a.obj", "OBJf 1 2 3 4\n"),
    "off": _write_quadrilateral("a.off", "OFF\n4 1 0\nPOINTS4 0 1 2 3\n"),
    "2dm": _write_quadrilateral("a.2dm", "MESH2D\nNODESE4Q 1 1 2 3 4 1\n"),
    "adcirc": _write_adcirc,
    "selafin": _write_selafin(),
    "vtk": _write_with_meshio(".vtu"),
    "gmsh": _write_with_meshio(".msh"),
    "ugrid": lambda points, folder: _write_ugrid(standard_name="altitude")(_order(points), folder),
    "cityjson": _write_cityjson,
    "landxml": _write_landxml,
    "dxf": _write_dxf,
    **{name: _write_layer(name, of_polygons=True) for name in _LAYERS},
}


# --------------------------------------------------------------------- other contradictions


def write_above_ground(folder: Path) -> Path:
    """Write KML whose heights count from the ground."""
    marks = "".join(
        "<Placemark><Point><altitudeMode>relativeToGround</altitudeMode>"
        f"<coordinates>{-84.5 + 0.002 * i},{36.3 + 0.001 * i * i},{2 + i}</coordinates>"
        "</Point></Placemark>"
        for i in range(5)
    )
    path = folder / "a.kml"
    path.write_text(
        f'<kml xmlns="http://www.opengis.net/kml/2.2"><Document>{marks}</Document></kml>'
    )
    return path


def write_points_in_degrees(name: str, degrees: Any, folder: Path) -> File:
    """Write longitudes and latitudes, of which one has no image in a zone of UTM."""
    rows = degrees.copy()
    rows[3, 1] = 95.0
    if "source_crs" in READ[name].options("read"):
        return write_points(name, rows, folder), {"source_crs": "EPSG:4326"}
    if name == "raster":
        rows[:, :2] += [0.0, 58.0]
        path = write_points(name, rows, folder)
        path.with_suffix(".prj").write_text(ts.CRS.of("EPSG:4326").to_wkt("WKT1_ESRI"))
        return path, {}
    if name == "las":  # whose writer refuses such a latitude
        rows[3, :2] = [3.0, 0.0]
        survey = ts.Survey(points=rows, crs="EPSG:4326", elevation_unit="m")
        return Path(ts.write(survey, folder / f"a{READ[name].suffixes[0]}", format=name)), {}
    import geopandas
    import shapely

    shapes = list(map(shapely.Point, rows))
    return _save(geopandas.GeoDataFrame(geometry=shapes, crs="EPSG:4326"), name, folder), {}


def write_lines_in_feet(name: str, role: str, folder: Path) -> Path:
    """Write a line, or a polygon, at 320 m in feet."""
    ring = np.add([[5, 5], [40, 8], [30, 40], [5, 5]], [752700.0, 4024200.0])
    rows = np.column_stack([ring, np.full(4, 320.0 / FOOT)])
    how = {"crs": CRS, "elevation_unit": "ft"}
    if role == "breaklines":
        made = ts.Features.of_lines(rows[:3], [0, 3], **how)
    else:
        made = ts.Features.of_polygons(rows, [0, 4], [0, 1], **how)
    return Path(ts.write(made, folder / f"lines{READ[name].suffixes[0]}", format=name))
