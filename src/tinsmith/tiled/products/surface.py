"""The surface itself: a file of the triangles of each tile, with numbers of the whole."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.atomic import replacing
from ...base.errors import OptionError
from ...base.notes import collecting_warnings, join_alike, warn
from ...base.results import Features
from ...io import find_format
from ...io import write as write_file
from ...terrain.parts import are_owned
from ...tin import TIN
from ..numbering import NUMBER, number_vertices
from ..reading import open_store
from ..running import hash_file
from ..tasks import TileProduct, find_reference, save_arrays

if TYPE_CHECKING:
    from collections.abc import Mapping

    from ...base.arrays import Int64Array
    from ..reading import StoredPoints
    from ..running import Record
    from ..tasks import Part

INDEX = "surface.json"
"""What the folder holds, by which such a folder is known."""

_MESHES = ("ply", "tin")
"""Formats of triangles with their vertices, which have attributes."""
_FEATURES = ("geoparquet", "flatgeobuf")
"""Formats in which triangles are polygons, with columns."""
_OWN, _USED, _NUMBERS = ".own.rows", ".used.rows", ".numbers"
_VERTEX = "vertex"
"""Attribute of vertices: their number in the whole surface."""
_CORNERS = ("a", "b", "c")
"""Columns of triangles that are features: the numbers of their corners."""


def check_options(*, format: str, write: Mapping[str, Any] | None = None) -> dict[str, Any]:  # noqa: A002
    """Return plain options, or refuse a format that cannot hold the numbers of vertices."""
    chosen = find_format(format, "write")
    if chosen.name not in (*_MESHES, *_FEATURES):
        able = ", ".join((*_MESHES, *_FEATURES))
        raise OptionError("format", format, f"a format that keeps the numbers of vertices: {able}")
    given = dict(write or {})
    for name in given.keys() - {*chosen.options("write")}:
        raise OptionError("write", name, f"an option of the writer of {chosen.name} files")
    return {"format": chosen.name, "write": given}


def compute(part: Part) -> tuple[int, dict[str, Any], list[str]]:
    """Write the triangles that a tile owns, and the rows of its vertices."""
    job = part.job
    local = part.triangulate(job.tile.box)
    if not len(local.triangles):
        return 0, {}, []
    used, corners = np.unique(local.triangles[local.owned], return_inverse=True)
    names = save_arrays(
        part, points=local.points[used], triangles=corners.reshape(-1, 3).astype(np.int32)
    )
    own = local.numbers[are_owned(local.points, job.tile.box)]
    names += save_rows(part, {_OWN: own, _USED: local.numbers[used]})
    return len(local.points), {"triangles": len(corners.reshape(-1, 3))}, names


def save_rows(part: Part, files: Mapping[str, Int64Array]) -> list[str]:
    """Write rows of vertices of a tile to files by suffix, and return their names."""
    names = []
    for suffix, rows in files.items():
        names.append(f"{part.job.key}{suffix}")
        with replacing(part.folder / names[-1]) as file:
            file.write(rows.astype(NUMBER).data)
    return names


@dataclass(frozen=True)
class SurfaceParts:
    """The triangles of all tiles, in the folder of the run.

    Attributes
    ----------
    points : StoredPoints
    options : mapping
    records : mapping of str to Record
        Of the tiles that own triangles.
    folder : Path
        Of the run.
    count : int
        Vertices of the whole surface.
    index : str
        File by which a folder of them is known.
    """

    points: StoredPoints
    options: Mapping[str, Any]
    records: Mapping[str, Record]
    folder: Path
    count: int
    index: str = INDEX

    def write(self, folder: Path) -> None:
        """Write a file for each tile, and the index."""
        with collecting_warnings() as lost:
            entries = [self._write_part(*one, folder) for one in self.records.items()]
        for sentence in join_alike(lost):
            warn(sentence)
        box, crs, unit = self.points.bounds, self.points.crs, self.points.elevation_unit
        low, high = self.points.elevations
        index = {
            "format": self.options["format"],
            "vertices": self.count,
            "triangles": sum(entry["triangles"] for entry in entries),
            "bounds": [box.xmin, box.ymin, low, box.xmax, box.ymax, high],
            "crs": None if crs is None else str(crs),
            "horizontal_unit": None if crs is None else str(crs.horizontal_unit),
            "elevation_unit": None if unit is None else unit.text,
            "notes": list(self.points.notes),
            "files": entries,
        }
        with replacing(folder / INDEX, binary=False) as file:
            json.dump(index, file, indent=1)
            file.write("\n")

    def _write_part(self, key: str, record: Record, folder: Path) -> dict[str, Any]:
        chosen = find_format(self.options["format"], "write")
        path = folder / f"{key}{chosen.suffixes[0]}"
        tin = self._load(record)
        numbers = tin.attributes[_VERTEX]
        made = tin if chosen.name in _MESHES else _list_triangles(tin, numbers)
        write_file(made, path, format=chosen.name, **self.options["write"])
        low, high = tin.points.min(axis=0), tin.points.max(axis=0)
        return {
            "file": path.name,
            "bounds": [*low.tolist(), *high.tolist()],
            "vertices": len(tin.points),
            "triangles": len(tin.triangles),
            "bytes": path.stat().st_size,
            "blake2b": hash_file(path),
        }

    def _load(self, record: Record) -> TIN:
        """Return the triangles of a tile, its vertices with their numbers as an attribute."""
        with np.load(_find(self.folder, record, ".npz")) as found:
            arrays = dict(found)
        numbers = np.fromfile(_find(self.folder, record, _NUMBERS), NUMBER)
        fits = self.count <= np.iinfo(np.int32).max
        crs, unit = find_reference(self.options)
        return TIN.from_triangles(
            **arrays,
            crs=crs,
            elevation_unit=unit,
            attributes={_VERTEX: numbers.astype(np.int32) if fits else numbers},
        )


def _list_triangles(tin: TIN, numbers: Int64Array) -> Features:
    """Return the triangles as polygons, with the numbers of their corners."""
    count = len(tin.triangles)
    corners = numbers[tin.triangles]
    return Features.of_polygons(
        tin.points[tin.triangles[:, [0, 1, 2, 0]].ravel()],
        4 * np.arange(count + 1),
        np.arange(count + 1),
        columns={name: corners[:, k] for k, name in enumerate(_CORNERS)},
        crs=tin.crs,
        elevation_unit=tin.elevation_unit,
        name="triangles",
    )


def _find(folder: Path, record: Record, suffix: str) -> Path:
    """Return a file of a tile beside its arrays."""
    (arrays,) = (name for name in record.files if name.endswith(".npz"))
    return folder / f"{arrays.removesuffix('.npz')}{suffix}"


def join(
    points: StoredPoints, options: Mapping[str, Any], records: Mapping[str, Record], folder: Path
) -> SurfaceParts:
    """Give the vertices of all tiles their numbers in the whole."""
    every = [record for record in records.values() if record.files]
    own, used, made = (
        [_find(folder, record, suffix) for record in every] for suffix in (_OWN, _USED, _NUMBERS)
    )
    chunks = open_store(points.folder).chunks
    count = number_vertices(own, used, made, np.concatenate([chunk.firsts for chunk in chunks]))
    filled = {key: record for key, record in records.items() if record.values.get("triangles")}
    return SurfaceParts(points, options, filled, folder, count)


PRODUCT = TileProduct(check_options, compute, join, index=INDEX)
