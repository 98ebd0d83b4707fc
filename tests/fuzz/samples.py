"""Sound files of every format that is read, made by our writers, other libraries and by hand."""

from __future__ import annotations

import os
import sqlite3
import tempfile
import warnings
from contextlib import closing
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

import tinsmith as ts

from .mesh_samples import MESH_MAKERS
from .vector_samples import VECTOR_MAKERS

__all__ = ["MEMORY", "sample_files"]

MEMORY = "/dev/shm" if os.access("/dev/shm", os.W_OK) else None
"""Where files cost microseconds; on a disk each folder may take a hundredth of a second."""

CRS = "EPSG:32616"
CORNER = np.array([752_640.0, 4_024_180.0, 300.0])


@cache
def sample_files(kind: str) -> tuple[tuple[str, bytes], ...]:
    """Return names and contents of the sound files of a kind of format."""
    with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return tuple(_MAKERS[kind](Path(folder)))


def _tin() -> Any:
    rng = np.random.default_rng(5)
    points = CORNER + rng.random((14, 3)) * (40.0, 30.0, 9.0)
    line = [points[0] + (1.0, 2.0, 0.5), points[5] + (0.25, 0.5, 0.0)]
    return ts.triangulate(
        ts.Survey(points=points.round(3), crs=CRS), breaklines=[ts.Breakline(np.round(line, 3))]
    )


def _ours(folder: Path, *names: str) -> list[tuple[str, bytes]]:
    return [(name, ts.write(_tin(), folder / name).read_bytes()) for name in names]


def _by_hand(kind: str, encoding: str) -> bytes:
    order = ">" if "big" in encoding else "<"
    tin = _tin()
    head = (
        f"{kind}\nformat {encoding} 1.0\ncomment made by hand\n"
        f"element vertex {len(tin.points)}\nproperty double x\nproperty double y\n"
        f"property double z\nproperty uchar class\nelement face {len(tin.triangles)}\n"
        "property list uchar int vertex_index\nend_header\n"
    ).encode()
    if encoding == "ascii":
        rows = [f"{x!r} {y!r} {z!r} 2" for x, y, z in tin.points.tolist()]
        rows += [f"3 {a} {b} {c}" for a, b, c in tin.triangles.tolist()]
        return head + ("\n".join(rows) + "\n").encode()
    vertices = np.zeros(len(tin.points), [("xyz", f"{order}f8", 3), ("class", "u1")])
    vertices["xyz"] = tin.points
    faces = np.zeros(len(tin.triangles), [("n", "u1"), ("corners", f"{order}i4", 3)])
    faces["n"], faces["corners"] = 3, tin.triangles
    return head + vertices.tobytes() + faces.tobytes()


def _ply(folder: Path) -> list[tuple[str, bytes]]:
    import trimesh

    tin = _tin()
    mesh = trimesh.Trimesh(tin.points, tin.triangles, process=False)
    cloud = ts.write(ts.Survey(points=tin.points, attributes={"id": np.arange(len(tin.points))}),
                     folder / "cloud.ply").read_bytes()  # fmt: skip
    return [
        *_ours(folder, "ours.ply"),
        ("trimesh.ply", mesh.export(file_type="ply")),
        ("text.ply", _by_hand("ply", "ascii")),
        ("pdal.ply", _by_hand("ply ", "binary_little_endian")),
        ("big.ply", _by_hand("ply", "binary_big_endian")),
        ("cloud.ply", cloud),
    ]


def _obj(folder: Path) -> list[tuple[str, bytes]]:
    import trimesh

    tin = _tin()
    mesh = trimesh.Trimesh(tin.points, tin.triangles, process=False)
    quads = b"# quads\nv 0 0 1\nv 1 0 2\nv 1 1 3\nv 0 1 4\nv 2 0 1\nv 2 1 1\n"
    quads += b"f 1/1 2/2 3/3 4/4\nf -5 -2 \\\n-1 -4\n"
    return [
        *_ours(folder, "ours.obj"),
        ("trimesh.obj", mesh.export(file_type="obj").encode()),
        ("quads.obj", quads),
    ]


def _stl(folder: Path) -> list[tuple[str, bytes]]:
    import trimesh

    tin = _tin()
    mesh = trimesh.Trimesh(tin.points - CORNER, tin.triangles, process=False)
    return [*_ours(folder, "ours.stl"), ("trimesh.stl", mesh.export(file_type="stl"))]


def _vtk(folder: Path) -> list[tuple[str, bytes]]:
    import meshio
    import pyvista

    tin = _tin()
    mesh = meshio.Mesh(tin.points, [("triangle", tin.triangles)])
    for name, binary in (("meshio-text.vtu", False), ("meshio.vtu", True)):
        meshio.vtu.write(str(folder / name), mesh, binary=binary)
    pyvista.PolyData.from_regular_faces(tin.points, tin.triangles).save(
        str(folder / "text.vtp"), binary=False
    )
    names = ("meshio-text.vtu", "meshio.vtu", "text.vtp")
    others = [(name, (folder / name).read_bytes()) for name in names]
    return [*_ours(folder, "ours.vtp", "ours.vtu"), *others]


def _gmsh(folder: Path) -> list[tuple[str, bytes]]:
    import meshio

    tin = _tin()
    mesh = meshio.Mesh(tin.points, [("triangle", tin.triangles)])
    found = _ours(folder, "ours.msh")
    for name, version, binary in (("b22.msh", "2.2", True), ("t41.msh", "4.1", False),
                                  ("b41.msh", "4.1", True)):  # fmt: skip
        meshio.gmsh.write(str(folder / name), mesh, fmt_version=version, binary=binary)
        found.append((name, (folder / name).read_bytes()))
    return found


def _raster(folder: Path) -> list[tuple[str, bytes]]:
    import rasterio
    from rasterio.transform import Affine

    place = {"transform": Affine(5, 0, CORNER[0], 0, -5, CORNER[1]), "crs": CRS, "count": 1}
    cells = (np.arange(20 * 24).reshape(20, 24) * 7 % 50 + 300).astype("float32")
    kinds = {
        "plain.tif": ("GTiff", "float32", {}),
        "tiled.tif": ("GTiff", "int16", {"tiled": True, "blockxsize": 16, "blockysize": 16,
                                         "compress": "deflate", "predictor": 2, "nodata": 301}),
        "lzw.tif": ("GTiff", "float32", {"compress": "lzw", "nodata": 301.0}),
        "a.img": ("HFA", "float32", {}),
        "a.bt": ("BT", "int16", {}),
        "a.asc": ("AAIGrid", "float32", {}),
        "a.rst": ("RST", "float32", {}),
    }  # fmt: skip
    for name, (driver, dtype, how) in kinds.items():
        size = {"width": 24, "height": 20, "dtype": dtype}
        with rasterio.open(folder / name, "w", driver=driver, **size, **place, **how) as dataset:
            dataset.write(cells.astype(dtype), 1)
    return [(name, (folder / name).read_bytes()) for name in kinds]


def _vectors(folder: Path) -> list[tuple[str, bytes]]:
    import pyogrio
    import shapely

    lines = [shapely.LineString(CORNER + np.array([[0, 0, 1], [9, k, 2], [20, 1, 3.5]]))
             for k in range(4)]  # fmt: skip
    drivers = {
        ".gpkg": "GPKG",
        ".shp": "ESRI Shapefile",
        ".fgb": "FlatGeobuf",
        ".dxf": "DXF",
        ".geojson": "GeoJSON",
        ".geojsons": "GeoJSONSeq",
        ".gml": "GML",
        ".kml": "KML",
        ".gpx": "GPX",
        ".mif": "MapInfo File",
    }
    for suffix, driver in drivers.items():
        degrees = suffix in (".kml", ".gpx")
        shapes = [shapely.force_2d(shapely.transform(line, lambda xyz: xyz * 1e-5)) if degrees
                  else line for line in lines]  # fmt: skip
        columns = (
            {} if suffix in (".dxf", ".gpx") else {"name": list("abcd"), "priority": [0, 1, 2, 3]}
        )
        pyogrio.raw.write(
            str(folder / f"a{suffix}"),
            geometry=shapely.to_wkb(np.array(shapes, object)),
            field_data=[
                np.array(values, object if name == "name" else None)
                for name, values in columns.items()
            ],
            fields=list(columns),
            geometry_type="LineString" + (" Z" if shapes[0].has_z else ""),
            crs="EPSG:4326" if degrees else CRS,
            driver=driver,
            **({"layer": "routes"} if suffix == ".gpx" else {}),
        )
    wkt = "\n".join(f'"{line.wkt}",{k}' for k, line in enumerate(lines))
    found = [(f"a{suffix}", (folder / f"a{suffix}").read_bytes()) for suffix in drivers]
    return [*found, ("a.csv", f"WKT,priority\n{wkt}\n".encode())]


def _delimited(folder: Path) -> list[tuple[str, bytes]]:
    rows = _tin().points.tolist()
    csv = "id,easting,northing,elevation\n"
    csv += "".join(f"{k},{x},{y},{z}\n" for k, (x, y, z) in enumerate(rows))
    xyz = "".join(f"{x} {y} {z}\n" for x, y, z in rows)
    comma = "x;y;z\n" + "".join(f"{x};{y};{z}\n".replace(".", ",") for x, y, z in rows)
    texts = {"a.csv": csv, "a.xyz": xyz, "comma.txt": comma}
    return [(name, text.encode()) for name, text in texts.items()]


def _las(folder: Path) -> list[tuple[str, bytes]]:
    from support.lidar_files import make_cloud, write_copc

    for name, version, form in (("old.las", "1.2", 1), ("new.las", "1.4", 6), ("old.laz", "1.2", 3),
                                ("new.laz", "1.4", 7)):  # fmt: skip
        make_cloud(60, version=version, point_format=form).write(folder / name)
    ts.write(ts.Survey(points=_tin().points, crs=CRS), folder / "ours.laz")
    write_copc(folder / "tree.copc.laz", make_cloud(60))
    return [(one.name, one.read_bytes()) for one in sorted(folder.iterdir())]


def _survey() -> Any:
    tin = _tin()
    ring = CORNER[:2] + np.array([[1, 1], [35, 2], [34, 27], [2, 26]])
    return ts.Survey(
        points=tin.points,
        breaklines=[ts.Breakline(tin.points[[0, 5]] + 0.25, kind="soft", name="edge")],
        boundary=[ring],
        attributes={"description": np.array(["EP1"] * len(tin.points), object)},
        crs=CRS,
    )


def _landxml(folder: Path) -> list[tuple[str, bytes]]:
    tin, survey = _tin(), _survey()
    surface = ts.write(tin, folder / "a.xml").read_bytes()
    points = ts.write(survey, folder / "b.xml").read_bytes()
    contours = ts.write(ts.contours(tin, interval=2), folder / "source-c.xml").read_bytes()
    text = surface.decode()
    head, tail = text.split("<Surfaces>")
    bare = f"{head.split('<CoordinateSystem')[0]}<Surfaces>{tail}"
    grouped = bare.replace("<F>", '<F n="1 2 0">', 3).replace("<F>", '<F i="1">', 2)
    return [
        ("surface.xml", surface),
        ("points.xml", points),
        ("source-contours.xml", contours),
        ("source-lines.xml", surface),
        ("grouped.xml", grouped.encode()),
        ("wide.xml", text.replace("UTF-8", "UTF-16").encode("utf-16")),
    ]


def _dxf(folder: Path) -> list[tuple[str, bytes]]:
    import ezdxf

    tin, survey = _tin(), _survey()
    for version in ("R2010", "R12"):
        ts.write(tin, folder / f"tin-{version}.dxf", version=version)
        ts.write(survey, folder / f"survey-{version}.dxf", version=version)
    document = ezdxf.new("R12")
    block = document.blocks.new("A")
    block.add_point((1, 2, 3))
    block.add_polyline3d([(0, 0, 1), (5, 5, 2)])
    space = document.modelspace()
    space.add_blockref("A", (9, 9, 9), dxfattribs={"column_count": 3, "column_spacing": 4})
    space.add_polyline2d([(0, 0, 1), (9, 0, 0)], format="xyb")
    space.add_arc((0, 0, 1), 5, 10, 80)
    space.add_polyface().append_faces([tin.points[one].tolist() for one in tin.triangles[:6]])
    for name, form in (("blocks", "asc"), ("binary", "bin")):
        document.saveas(folder / f"{name}.dxf", fmt=form)
    entities = [_keep_entities(path.read_bytes()) for path in sorted(folder.glob("*-R12.dxf"))]
    found = [(path.name, path.read_bytes()) for path in sorted(folder.glob("*.dxf"))]
    return [*found, ("bare-survey.dxf", entities[0]), ("bare-tin.dxf", entities[1])]


def _keep_entities(content: bytes) -> bytes:
    """Return a drawing with nothing but its entities, where damage meets more of them."""
    start = content.index(b"ENTITIES") - len(b"  0\nSECTION\n  2\n")
    return content[start:]


def _whole_tin(folder: Path) -> list[tuple[str, bytes]]:
    """Return GeoPackages of small pages, as dense as SQLite makes them."""
    edited = _tin()
    edited.insert([np.add(CORNER, (20.0, 15.0, 3.0))])
    files = []
    count = len(_tin().vertex_of)
    columns = {
        "number": np.arange(count),
        "code": [f"EP{i}" for i in range(count)],
        "mixed": [1, None, "x"] + [2.5] * (count - 3),
        "day": np.zeros(count, "M8[D]"),
    }
    named = _tin().replace(row_attributes=columns)
    tins = {"ours": _tin(), "edited": edited, "named": named, "compact": named}
    for name, tin in tins.items():
        path = ts.write(tin, folder / f"{name}.gpkg", compact=name == "compact")
        with closing(sqlite3.connect(path, isolation_level=None)) as file:
            file.execute("PRAGMA page_size = 512")
            file.execute("VACUUM")
        files.append((path.name, path.read_bytes()))
    return files


def _instruments(folder: Path) -> list[tuple[str, bytes]]:
    rows = [
        [round(value, 3) for value in row] for row in (_tin().points - (752_000, 0, 0)).tolist()
    ]
    words = [(81, 0), (82, 1), (83, 2)]
    gsi8 = gsi16 = ""
    sdr = f"00NM{'SDR33 V04-04.02':<20}{'05-Nov-20 08:00':<16}211111\n"
    sdr += "".join(f"{cell:<16}" for cell in ("02TPS", "0", "0", "0", "1.5")) + "\n"
    sdr += "07TP" + "".join(f"{cell:<16}" for cell in ("S", "B", "0", "0")) + "\n03NM1.5\n"
    dc = f"00NM{'SC V10-70':<16}{'1021':<4}{'05-Jan-26 12:20':<16}111111\n"
    reduced = ""
    for k, row in enumerate(rows, start=1):
        cells = " ".join(f"{i}..00+{round(row[j] * 1e3) % 10**8:08d}" for i, j in words)
        gsi8 += f"11{k:04d}+{k:08d} {cells} 71....+00000EP1 \r\n"
        cells = " ".join(f"{i}..06+{round(row[j] * 1e4):016d}" for i, j in words)
        gsi16 += f"*11{k:04d}+{k:016d} {cells} \r\n"
        sdr += "08TP" + "".join(f"{cell:<16}" for cell in (k, row[1], row[0], row[2], "EP1")) + "\n"
        dc += "69KI" + "".join(f"{cell:<16}" for cell in (k, row[1], row[0], row[2], "EP1"))
        dc += f"11\n66KI{k + 1000:>16}{-37.1:<16}{-69.5:<16}{12.5:<16}\n"
        shot = ("S", 100 + k, 20 + k, 100, 10 * k, "GS")
        sdr += "09F1" + "".join(f"{cell:<16}" for cell in shot) + "\n"
        grid = f"<North>{row[1]}</North><East>{row[0]}</East><Elevation>{row[2]}</Elevation>"
        reduced += f"<Point><Name>{k}</Name><Code>EP1</Code><Grid>{grid}</Grid></Point>\n"
    jxl = f"<?xml version='1.0'?><JOBFile><Reductions>\n{reduced}</Reductions></JOBFile>\n"
    texts = {"a.gsi": gsi8, "b.gsi": gsi16, "a.sdr": sdr, "a.jxl": jxl, "a.dc": dc}
    return [(name, text.encode()) for name, text in texts.items()]


def _archive(folder: Path) -> list[tuple[str, bytes]]:
    text = (
        'null -999\nmodel "a"\nfull_tin { name "t" points { -9 -9 0  -9 9 0  9 9 0  9 -9 0\n'
        "0 0 5  0x1.4p+3 0 6  0 10 7  10 10 8 } triangles { 5 7 6  6 7 8  1 5 6 }\n"
        'nulling { 2 2 1 } }\nstring super { name "k" breakline line attributes {\n'
        'text "line_kind" "soft" integer "line_source" 2 } data_3d { 0 0 5  10 0 6 } }\n'
    )
    strings = (
        'string 4d { data { 7 7 8 "tree"  8 8 null "" } }\nstring super { closed true z 4\n'
        "data_2d { 0 0  9 0  9 9 } geometry_data { straight { } arc { radius 5 } } }\n"
        "string polyline { data { 0 0 1 12 0  20 0 1 0 0 } }\nstring text { x 1 }\n"
    )
    return [*_ours(folder, "a.12da"), ("full.12da", text.encode()),
            ("strings.12da", strings.encode())]  # fmt: skip


_MAKERS = {
    "tin": _whole_tin,
    "ply": _ply,
    "obj": _obj,
    "stl": _stl,
    "vtk": _vtk,
    "gmsh": _gmsh,
    "raster": _raster,
    "vectors": _vectors,
    "delimited": _delimited,
    "las": _las,
    **VECTOR_MAKERS,
    "instruments": _instruments,
    **MESH_MAKERS,
    "landxml": _landxml,
    "dxf": _dxf,
    "12da": _archive,
}
