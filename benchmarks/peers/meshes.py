"""The peers that read and write PLY."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

from tinsmith.tin import TIN

__all__ = ["MESH_PEERS", "MeshPeer"]

FLOAT32_STEP = 0.5
"""What a northing of 4,000 km may be off when it has passed through float32, metres."""


class MeshPeer(NamedTuple):
    """A library that reads points and triangles from a file, and writes a TIN.

    The steps are how far coordinates may be off after reading, and after writing.
    """

    module: str
    read: Callable[[Path], tuple[Any, Any]]
    write: Callable[[TIN, Path], Any]
    read_step: float = 0.0
    write_step: float = 0.0


def _read_by_pyvista(path: Path) -> tuple[Any, Any]:
    import pyvista

    mesh = pyvista.read(path)
    return mesh.points, mesh.regular_faces


def _write_by_pyvista(tin: TIN, path: Path) -> None:
    import pyvista

    pyvista.PolyData.from_regular_faces(tin.points, tin.triangles).save(path)


def _read_by_meshio(path: Path) -> tuple[Any, Any]:
    import meshio

    mesh = meshio.read(path)
    return mesh.points, mesh.cells_dict["triangle"]


def _write_by_meshio(tin: TIN, path: Path) -> None:
    import meshio

    meshio.Mesh(tin.points, {"triangle": tin.triangles}).write(path)


def _read_by_trimesh(path: Path) -> tuple[Any, Any]:
    import trimesh

    mesh = trimesh.load(path, process=False)
    return mesh.vertices, mesh.faces


def _write_by_trimesh(tin: TIN, path: Path) -> None:
    import trimesh

    trimesh.Trimesh(tin.points, tin.triangles, process=False).export(path)


MESH_PEERS = {
    "pyvista": MeshPeer("pyvista", _read_by_pyvista, _write_by_pyvista, FLOAT32_STEP, FLOAT32_STEP),
    "meshio": MeshPeer("meshio", _read_by_meshio, _write_by_meshio),
    "trimesh": MeshPeer("trimesh", _read_by_trimesh, _write_by_trimesh, write_step=FLOAT32_STEP),
}
"""The libraries by name."""
