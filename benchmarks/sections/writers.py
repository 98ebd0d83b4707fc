"""Writing files beside the peers: from one TIN to files of the same content, in turn.

Everything between the TIN and the file is timed: reprojection, geometries, text.
"""

from __future__ import annotations

import json
import sys
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

import tinsmith as ts
from tinsmith.base.arrays import AnyArray, Float64Array
from tinsmith.io import transform_points
from tinsmith.terrain.relief.gradients import aspect, slope
from tinsmith.tin import TIN

from ..datasets.points import make_points
from ..measure import OURS, Outcome, Result, alternate, find_median
from ..peers.exchange import (
    read_triangles,
    write_drawing_with_ezdxf,
    write_triangles_with_arrow,
    write_triangles_with_pyogrio,
    write_with_trimesh,
)
from ..peers.landxml import read_with_etree, write_with_etree
from ..peers.meshes import MESH_PEERS

__all__ = ["SECTION", "run"]

SECTION = "writers"
CRS = "EPSG:32616"
WGS84 = "EPSG:4326"
DEGREE_STEP, METRE_STEP = 1.01e-9, 1.01e-6
"""How far coordinates written with 9 and 6 decimals may differ."""

DIGIT_STEP = 1.01e-8
"""GDAL takes a last digit after a row of zeros for rounding noise and drops it."""


class Writer(NamedTuple):
    """A peer: what must be installed, how it writes, what to know, how far degrees may differ."""

    module: str
    write: Callable[[TIN, Path], Any]
    note: str = ""
    step: float = DEGREE_STEP


def run(n_triangles: int, *, repeats: int = 3) -> Outcome:
    """Measure the writing of a TIN of about ``n_triangles`` triangles in several formats.

    An AssertionError says that a peer's file holds something else than ours.
    """
    outcome = Outcome()
    points = make_points("uniform", n_triangles // 2)
    tin = ts.triangulate(points, crs=CRS)
    with tempfile.TemporaryDirectory() as name:
        for task in _TASKS:
            print(f"writers: {task.__name__[1:]}, {n_triangles:,}", file=sys.stderr, flush=True)
            task(Trial(Path(name), tin, repeats, outcome))
    return outcome


class Trial(NamedTuple):
    """A TIN that is written to a folder in several formats, and what becomes of it."""

    folder: Path
    tin: TIN
    repeats: int
    outcome: Outcome

    def measure(self, task: str, suffix: str, peers: dict[str, Writer]) -> dict[str, Path]:
        """Time tinsmith and the peers that are installed; return the files."""
        tin, folder = self.tin, self.folder
        present = self.outcome.present({tool: peer.module for tool, peer in peers.items()})
        paths = {tool: folder / f"{tool.replace(' ', '_')}{suffix}" for tool in (OURS, *present)}
        _warm_up(folder / f"small{suffix}", [peers[tool] for tool in present])
        calls: dict[str, Callable[[], Any]] = {OURS: lambda: ts.write(tin, paths[OURS])}
        calls |= {tool: _prepare_writing(peers[tool], tin, paths[tool]) for tool in present}
        _, runs = alternate(calls, self.repeats)
        for tool in calls:
            note = peers[tool].note if tool in peers else ""
            count, seconds = len(tin.triangles), find_median(runs[tool])
            size = {"bytes": paths[tool].stat().st_size}
            self.outcome.results.append(
                Result(SECTION, task, tool, count, seconds, tuple(runs[tool]), note, size)
            )
        return paths


def _warm_up(path: Path, peers: list[Writer]) -> None:
    """Let everybody import what they need."""
    tin = ts.triangulate(make_points("uniform", 200), crs=CRS)
    ts.write(tin, path)
    for peer in peers:
        peer.write(tin, path)


def _prepare_writing(peer: Writer, tin: TIN, path: Path) -> Callable[[], Any]:
    return lambda: peer.write(tin, path)


# ----------------------------------------------------------------------- GeoJSON


class Feature(NamedTuple):
    """What one triangle is written as."""

    ring: list[list[float]]
    properties: dict[str, float | int | None]


def _measure_geojson(trial: Trial) -> None:
    peers = {
        "pyogrio (GDAL)": Writer(
            "pyogrio", _write_with_pyogrio, "36.146000007 becomes 36.146", step=DIGIT_STEP
        ),
        "json.dump": Writer("json", _write_with_json),
    }
    task = "triangles, GeoJSON (RFC 7946)"
    paths = trial.measure(task, ".geojson", peers)
    ours = _parse_features(paths.pop(OURS))
    assert len(ours[0]) == len(trial.tin.triangles)
    for tool, path in paths.items():
        _require_same(ours, _parse_features(path), peers[tool].step)


def _parse_features(path: Path) -> tuple[Float64Array, Float64Array]:
    """Return rings, (m, 4, 3), and properties, (m, 4), of a file, with its bytes dropped."""
    with path.open("rb") as file:
        features = json.load(file)["features"]
    rings = np.array([feature["geometry"]["coordinates"][0] for feature in features])
    names = ("id", "slope", "aspect", "area")
    properties = [[feature["properties"][name] for name in names] for feature in features]
    return rings, np.array(properties, np.float64)  # null becomes NaN


def _require_same(
    ours: tuple[Float64Array, Float64Array], theirs: tuple[Float64Array, Float64Array], step: float
) -> None:
    assert ours[0].shape == theirs[0].shape
    np.testing.assert_allclose(ours[0][..., :2], theirs[0][..., :2], rtol=0, atol=step)
    np.testing.assert_allclose(ours[0][..., 2], theirs[0][..., 2], rtol=0, atol=METRE_STEP)
    np.testing.assert_allclose(ours[1], theirs[1], rtol=1e-6, atol=1e-3)


def _write_with_pyogrio(tin: TIN, path: Path) -> None:
    import pyogrio.raw
    import shapely

    places = transform_points(tin.points, CRS, WGS84)
    polygons = shapely.polygons(places[tin.triangles][:, [0, 1, 2, 0]])
    properties = _collect_properties(tin)
    pyogrio.raw.write(
        path,
        shapely.to_wkb(polygons),
        list(properties.values()),
        list(properties),
        geometry_type="Polygon Z",
        crs=WGS84,
        driver="GeoJSON",
        layer_options={"RFC7946": "YES", "COORDINATE_PRECISION": "9"},
    )


def _collect_properties(tin: TIN) -> dict[str, AnyArray]:
    return {
        "id": np.arange(len(tin.triangles), dtype=np.int32),
        "slope": slope(tin),
        "aspect": aspect(tin),
        "area": tin.triangle_areas,
    }


def _write_with_json(tin: TIN, path: Path) -> None:
    with path.open("w", encoding="ascii") as file:
        content = {"type": "FeatureCollection", "features": list(_iterate_features(tin))}
        json.dump(content, file, allow_nan=False)


def _iterate_features(tin: TIN) -> Iterator[dict[str, Any]]:
    places = transform_points(tin.points, CRS, WGS84)
    places = np.column_stack([places[:, :2].round(9), places[:, 2].round(6)])
    rings = places[tin.triangles][:, [0, 1, 2, 0]].tolist()
    properties = {name: values.tolist() for name, values in _collect_properties(tin).items()}
    for ring, *values in zip(rings, *properties.values(), strict=True):
        yield {
            "type": "Feature",
            "properties": dict(zip(properties, values, strict=True)),
            "geometry": {"type": "Polygon", "coordinates": [ring]},
        }


# --------------------------------------------------------------------------- PLY


def _measure_ply(trial: Trial) -> None:
    peers = {
        tool: Writer(peer.module, peer.write, "coordinates become float32" * bool(peer.write_step))
        for tool, peer in MESH_PEERS.items()
    }
    paths = trial.measure("surface, binary PLY", ".ply", peers)
    written = ts.read(paths.pop(OURS))
    np.testing.assert_array_equal(written.points, trial.tin.points)
    np.testing.assert_array_equal(written.triangles, trial.tin.triangles)
    assert written.crs == trial.tin.crs
    # Each is read by itself: with float32 coordinates triangles collapse, which is no TIN.
    for tool, path in paths.items():
        points, triangles = MESH_PEERS[tool].read(path)
        np.testing.assert_allclose(
            points, trial.tin.points, rtol=0, atol=MESH_PEERS[tool].write_step
        )
        np.testing.assert_array_equal(triangles, trial.tin.triangles)


# ----------------------------------------------------------------------- LandXML


def _measure_landxml(trial: Trial) -> None:
    peers = {"xml.etree": Writer("xml", write_with_etree, "no CRS")}
    paths = trial.measure("surface, LandXML", ".xml", peers)
    for path in paths.values():
        points, triangles = read_with_etree(path)
        np.testing.assert_array_equal(points, trial.tin.points)
        np.testing.assert_array_equal(triangles, trial.tin.triangles)


# ---------------------------------------------------------------------------- layers


def _measure_layers(trial: Trial) -> None:
    """Write triangles as layers; a GeoPackage of ours holds the whole TIN."""
    through = Writer("pyogrio", write_triangles_with_pyogrio, "polygons with a number")
    arrow = Writer("geopandas", write_triangles_with_arrow, "polygons with a number")
    wanted = _sort_triangles(trial.tin.points[trial.tin.triangles])
    for task, suffix, tool, peer in (
        ("whole TIN, GeoPackage", ".gpkg", "pyogrio, shapely", through),
        ("triangles, FlatGeobuf", ".fgb", "pyogrio, shapely", through),
        ("triangles, shapefile", ".shp", "pyogrio, shapely", through),
        ("triangles, GeoParquet", ".parquet", "geopandas", arrow),
    ):
        paths = trial.measure(task, suffix, {tool: peer})
        for path in paths.values():
            np.testing.assert_array_equal(_sort_triangles(read_triangles(path)), wanted)


def _sort_triangles(corners: Float64Array) -> Float64Array:
    """Return triangles in one order, whatever the order and the first corner of each."""
    first = np.lexsort((corners[..., 1], corners[..., 0]), axis=1)
    corners = np.take_along_axis(corners, first[..., None], axis=1)
    flat = corners.reshape(len(corners), 9)
    return flat[np.lexsort(flat.T[::-1])]


# ------------------------------------------------------------------ drawings and meshes


def _measure_drawing(trial: Trial) -> None:
    peers = {"ezdxf": Writer("ezdxf", write_drawing_with_ezdxf, "no CRS, no layers")}
    paths = trial.measure("3DFACEs, DXF R2010", ".dxf", peers)
    wanted = _sort_triangles(trial.tin.points[trial.tin.triangles])
    for path in paths.values():
        found = ts.read(path, crs=CRS)
        np.testing.assert_array_equal(_sort_triangles(found.points[found.triangles]), wanted)


def _measure_meshes(trial: Trial) -> None:
    """Write meshes that few programs write: each is read back, GLB by trimesh."""
    viewer = {"trimesh": Writer("trimesh", write_with_trimesh, "no normals, colours, CRS")}
    paths = trial.measure("surface, GLB", ".glb", viewer)
    for path in paths.values():
        assert _count_faces(path) == len(trial.tin.triangles)
    for task, suffix in (("surface, 2DM", ".2dm"), ("surface, UGRID", ".nc")):
        (path,) = trial.measure(task, suffix, {}).values()
        np.testing.assert_array_equal(ts.read(path).triangles, trial.tin.triangles)


def _count_faces(path: Path) -> int:
    """Return the faces of a GLB file, a third of the indices that its header tells of."""
    content = path.read_bytes()
    header = json.loads(content[20 : 20 + int.from_bytes(content[12:16], "little")])
    pieces = [one for mesh in header["meshes"] for one in mesh["primitives"]]
    return sum(header["accessors"][one["indices"]]["count"] for one in pieces) // 3


_TASKS = (
    _measure_geojson,
    _measure_ply,
    _measure_landxml,
    _measure_layers,
    _measure_drawing,
    _measure_meshes,
)
