"""GeoPackages that several programs write to in turn, with failures between."""

from __future__ import annotations

import sqlite3
from contextlib import closing
from pathlib import Path
from tempfile import TemporaryDirectory
from unittest.mock import patch

import geopandas
import numpy as np
import shapely

import tinsmith as ts
from tinsmith.io.mesh.geopackage import existing_layers

from .campaign import Campaign, Case

_NAMES = ("contours", "slope", "parcels", "roads", "lines", "a b", "select")
_WORDS = ("ours", "append", "overwrite", "tin", "theirs", "edited", "fails")


def generate(rng: np.random.Generator) -> Case:
    """Up to a dozen writes of tinsmith and others to a few layers of one file."""
    count = int(rng.integers(2, 12))
    return {
        "steps": [[str(rng.choice(_WORDS)), str(rng.choice(_NAMES))] for _ in range(count)],
        "epsg": [int(code) for code in rng.choice([32616, 2056, 4326], 2)],
        "seed": int(rng.integers(2**31)),
    }


def examine(case: Case) -> str:
    """After each step, layers of others are as they wrote them, and the last of ours is there."""
    rng = np.random.default_rng(case["seed"])
    theirs: dict[str, list[tuple]] = {}
    refused = 0
    with TemporaryDirectory() as folder:
        path = Path(folder, "project.gpkg")
        for word, name in case["steps"]:
            if word in ("theirs", "edited"):
                if word == "edited" or not _has(path, name):
                    before = _dump(path, name) if _has(path, name) else None
                    _write_theirs(path, name, case["epsg"][0], append=before is not None)
                    if _dump(path, name) != before:  # a layer without features has none to add
                        theirs[name] = _dump(path, name)
                continue
            try:
                tin, features = _make_ours(rng, case["epsg"][1])
                _write_ours(path, word, name, tin, features)
            except ts.WriteError:
                refused += 1
            else:
                if word == "overwrite":
                    theirs.pop(name, None)
            for kept, rows in theirs.items():
                assert _dump(path, kept) == rows, f"the layer {kept} of others was changed"
            assert {one.name for one in Path(folder).iterdir()} <= {path.name}, "files are left"
            _require_sound(path)
    return "refused" if refused else "written"


def _make_ours(rng: np.random.Generator, epsg: int) -> tuple[ts.TIN, ts.Features]:
    scale = 0.001 if epsg == 4326 else 1.0
    points = np.column_stack([scale * rng.integers(0, 30, (30, 2)), rng.random(30)])
    words = np.array(["EP", "kerb", "", "Böschung " * 9])[rng.integers(0, 4, 30)]
    attributes = {"code": words, "number": rng.integers(-9, 300, 30)} if rng.random() < 0.5 else {}
    survey = ts.Survey(points=points, attributes=attributes, crs=epsg)
    tin = ts.triangulate(survey)
    return tin, ts.contours(tin, 0.2)


def _write_ours(path: Path, word: str, name: str, tin: ts.TIN, features: ts.Features) -> None:
    if word == "tin":
        ts.write(tin, path, compact=bool(len(tin.points) % 2))
        assert ts.read(path) == tin
        shapes = geopandas.read_file(path, layer="triangles").geometry
        rings = shapely.get_coordinates(shapes, include_z=True).reshape(-1, 4, 3)
        assert (rings[:, :3] == tin.points[tin.triangles]).all(), "the polygons are others"
    elif word == "fails":
        with patch.object(
            existing_layers, "_register", side_effect=sqlite3.OperationalError("full")
        ):
            ts.write(features, path, layer=name)
    else:
        options = {} if word == "ours" else {word: True}
        ts.write(features, path, layer=name, **options)
        assert len(geopandas.read_file(path, layer=name)) >= len(features)


def _write_theirs(path: Path, name: str, epsg: int, *, append: bool) -> None:
    frame = geopandas.GeoDataFrame({"n": [1]}, geometry=[shapely.Point(1, 2)], crs=epsg)
    if append:
        frame = geopandas.read_file(path, layer=name, rows=1)
    frame.to_file(path, layer=name, mode="a" if path.exists() else "w", driver="GPKG")


def _has(path: Path, name: str) -> bool:
    if not path.exists():
        return False
    with closing(sqlite3.connect(path)) as file:
        found = file.execute("SELECT 1 FROM gpkg_contents WHERE table_name = ?", (name,))
        return found.fetchone() is not None


def _dump(path: Path, name: str) -> list[tuple]:
    with closing(sqlite3.connect(path)) as file:
        rows = file.execute(f'SELECT * FROM "{name}"').fetchall()
        said = file.execute("SELECT * FROM gpkg_contents WHERE table_name = ?", (name,)).fetchall()
        index = f"rtree_{name}_geom"  # which layers of a TIN have not
        if file.execute("SELECT 1 FROM sqlite_master WHERE name = ?", (index,)).fetchone():
            rows += file.execute(f'SELECT * FROM "{index}" ORDER BY id').fetchall()
        return [*rows, *said]


def _require_sound(path: Path) -> None:
    if not path.exists():
        return
    with closing(sqlite3.connect(path)) as file:
        assert file.execute("PRAGMA integrity_check").fetchall() == [("ok",)]
        assert file.execute("PRAGMA foreign_key_check").fetchall() == []


CAMPAIGNS = (
    Campaign("containers", "layers of several programs in one GeoPackage", generate, examine),
)
