"""Sound files of meshes: ours, those of other programs, and forms that we do not write."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
from support.selafin_files import make_selafin

import tinsmith as ts

__all__ = ["MESH_MAKERS", "TILE"]

_DATA = Path(__file__).parents[1] / "data" / "meshes"
TILE = "15/33695/26068"


def _tin() -> Any:
    rng = np.random.default_rng(5)
    points = np.array([752_640.0, 4_024_180.0, 300.0]) + rng.random((14, 3)) * (40.0, 30.0, 9.0)
    line = [points[0] + (1.0, 2.0, 0.5), points[5] + (0.25, 0.5, 0.0)]
    return ts.triangulate(
        ts.Survey(points=points.round(3), crs="EPSG:32616"),
        breaklines=[ts.Breakline(np.round(line, 3), name="kerb")],
    )


def _write(folder: Path, *names: str) -> list[tuple[str, bytes]]:
    return [(name, ts.write(_tin(), folder / name).read_bytes()) for name in names]


def _read(pattern: str) -> list[tuple[str, bytes]]:
    return [(one.name, one.read_bytes()) for one in sorted(_DATA.glob(pattern))]


def _make_2dm(folder: Path) -> list[tuple[str, bytes]]:
    return [*_write(folder, "a.2dm"), *_read("*.2dm")]


def _make_adcirc(folder: Path) -> list[tuple[str, bytes]]:
    points = [[0, 0, 5], [4, 0, 6], [4, 3, 7], [0, 3, 8], [9, 1, 6]]
    rows = "".join(f"{7 * k} {x}.0D+00 {y} -{z}\n" for k, (x, y, z) in enumerate(points, 1))
    mixed = f"coast\n2 5\n{rows}1 4 7 14 21 28\n2 3 14 35 21\n1\n3\n3 0\n28\n7\n14\n"
    land = "2\n5\n2 20 = remark\n14\n35\n2 24\n35 7 2.5 1 1\n21 14 2.5 1 1\n"
    return [*_write(folder, "a.14"), ("hgrid.gr3", (mixed + land).encode())]


def _make_selafin(folder: Path) -> list[tuple[str, bytes]]:
    tin = _tin()
    names = [("FREE SURFACE", "M"), ("FOND", "M")]
    frames = [(k * 60.0, [tin.points[:, 2] + k, tin.points[:, 2]]) for k in range(2)]
    how = {"size": 4, "order": "<", "origin": (752_000, 4_024_000), "date": True}
    near = tin.points[:, :2] - how["origin"]
    single = make_selafin(near, tin.triangles + 1, names, frames, **how)
    return [*_write(folder, "a.slf"), ("single.slf", single)]


def _make_off(folder: Path) -> list[tuple[str, bytes]]:
    colors = b"COFF\n4 1 0\n0 0 5 9 0 0\n4 0 6 1 1 1\n4 3 7 1 1 1\n0 3 8 1 1 1\n4 0 1 2 3 9 9 9\n"
    return [*_write(folder, "a.off"), ("colours.off", colors)]


def _make_glb(folder: Path) -> list[tuple[str, bytes]]:
    found = []
    for frame in ("map", "local", "globe"):
        path = ts.write(_tin(), folder / f"{frame}.glb", frame=frame)
        found.append((path.name, path.read_bytes()))
    return found


def _make_cityjson(folder: Path) -> list[tuple[str, bytes]]:
    ((name, content),) = _write(folder, "a.city.json")
    city = json.loads(content)
    system = {"referenceSystem": "urn:ogc:def:crs:EPSG::32616"}
    older = {**city, "version": "1.0", "metadata": system}
    relief = city["CityObjects"]["terrain"]
    several = {**city, "CityObjects": {"a": relief, "b": {"type": "Road"}}}
    first = {**city, "CityObjects": {}, "vertices": []}
    feature = {"type": "CityJSONFeature", "id": "a", "CityObjects": {"a": relief},
               "vertices": city["vertices"]}  # fmt: skip
    sequence = "\n".join(map(json.dumps, (first, feature)))
    return [(name, content), ("older.city.json", json.dumps(older).encode()),
            ("features.jsonl", sequence.encode()),
            ("several.json", json.dumps(several).encode())]  # fmt: skip


def _make_ugrid(folder: Path) -> list[tuple[str, bytes]]:
    import netCDF4

    classic = folder / "classic.nc"
    tin = _tin()
    with netCDF4.Dataset(classic, "w", format="NETCDF3_CLASSIC") as data:
        for name, size in (("n", len(tin.points)), ("f", len(tin.triangles)), ("c", 4)):
            data.createDimension(name, size)
        mesh = data.createVariable("m", "i4")
        mesh.setncatts({"cf_role": "mesh_topology", "topology_dimension": 2})
        mesh.setncatts({"node_coordinates": "m_x m_y", "face_node_connectivity": "m_f"})
        for name, column in zip(("m_x", "m_y", "m_node_z"), tin.points.T, strict=True):
            data.createVariable(name, "f8", ("n",))[:] = column
        faces = data.createVariable("m_f", "i4", ("f", "c"), fill_value=-1)
        faces.start_index = 1
        faces[:] = np.pad(tin.triangles + 1, ((0, 0), (0, 1)), constant_values=-1)
    return [*_write(folder, "a.nc"), ("classic.nc", classic.read_bytes())]


def _make_esri_tin(folder: Path) -> list[tuple[str, bytes]]:
    return [
        (f"{name}/{one.name}", one.read_bytes())
        for name in ("esri_tin_dem", "esri_tin_holes")
        for one in sorted((_DATA / name).glob("*.adf"))
    ]


def _make_terrain(folder: Path) -> list[tuple[str, bytes]]:
    ts.write(_tin(), folder / "a", format="quantized-mesh", max_level=16)
    ts.write(_tin(), folder / "b", format="quantized-mesh", max_level=14, gzipped=True)
    ours = [max(one.rglob("*.terrain"), key=lambda tile: int(tile.parts[-3]))
            for one in (folder / "a", folder / "b")]  # fmt: skip
    named = [(f"{name}.terrain", one.read_bytes())
             for name, one in zip(("plain", "packed"), ours, strict=True)]  # fmt: skip
    return [*named, *_read("*.terrain")]


MESH_MAKERS = {
    "2dm": _make_2dm,
    "adcirc": _make_adcirc,
    "selafin": _make_selafin,
    "off": _make_off,
    "glb": _make_glb,
    "cityjson": _make_cityjson,
    "ugrid": _make_ugrid,
    "esritin": _make_esri_tin,
    "terrain": _make_terrain,
}
