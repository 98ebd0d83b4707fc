"""The formats of meshes."""

from typing import Any

from ..registry import signatures
from ..registry.format import Format

__all__ = ["FORMATS"]


def _make(name: str, description: str, *suffixes: str, module: str, **more: Any) -> Format:
    """Describe a format that a module here reads and writes."""
    where = f"{__package__}.{module}"
    ends: dict[str, Any] = {"read": f"{where}:read", "reads": ("TIN",), "write": f"{where}:write"}
    return Format(name=name, description=description, suffixes=suffixes, **ends, **more)


FORMATS = (
    _make(
        "tin",
        "A whole TIN as a GeoPackage (opens in QGIS, ArcGIS, GDAL)",
        ".gpkg",
        module="geopackage",
        writes=("TIN",),
        precision="Every number comes back bit for bit.",
        sniff=signatures.is_tin_geopackage,
    ),
    _make(
        "ply",
        "PLY mesh (opens in QGIS, CloudCompare, MeshLab)",
        ".ply",
        module="ply.file",
        sniff=signatures.is_ply,
    ),
    _make("obj", "Wavefront OBJ mesh", ".obj", module="obj", sniff=signatures.is_obj),
    _make("stl", "STL mesh", ".stl", module="stl", sniff=signatures.is_stl),
    _make(
        "vtk",
        "VTK XML mesh (opens in ParaView)",
        *(".vtp", ".vtu"),
        module="vtk",
        extra="view",
        sniff=signatures.is_vtk_xml,
    ),
    _make(
        "gmsh",
        "Gmsh mesh, with the edges of boundary and lines (for finite element programs)",
        ".msh",
        module="gmsh",
        extra="mesh",
        sniff=signatures.is_gmsh,
    ),
)
