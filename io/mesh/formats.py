"""The formats of meshes."""

from typing import Any

from ..registry import signatures
from ..registry.format import Format

__all__ = ["FORMATS"]

_EXACT = "Every number comes back bit for bit."


def _make(name: str, description: str, *suffixes: str, module: str, **more: Any) -> Format:
    """Describe a format that a module here reads and writes."""
    where = f"{__package__}.{module}"
    ends: dict[str, Any] = {"read": f"{where}:read", "reads": ("TIN",), "write": f"{where}:write"}
    return Format(name=name, description=description, suffixes=suffixes, **(ends | more))


FORMATS = (
    _make(
        "tin",
        "A whole TIN as a GeoPackage (opens in QGIS, ArcGIS, GDAL)",
        ".gpkg",
        module="geopackage",
        writes=("TIN",),
        precision=_EXACT,
        sniff=signatures.is_tin_geopackage,
    ),
    _make(
        "ply",
        "PLY mesh (opens in QGIS, CloudCompare, MeshLab)",
        ".ply",
        module="ply.file",
        sniff=signatures.is_ply,
        precision=_EXACT,
        losses="The report and its notes, and what undoing edits needs; of points, attributes that "
        "are no numbers.",
        loses=("attributes", "notes", "report"),
    ),
    _make(
        *("obj", "Wavefront OBJ mesh", ".obj"),
        module="obj",
        sniff=signatures.is_obj,
        writes=("TIN",),
        precision=_EXACT,
        losses="Which edges are constrained, lines and the report.",
        loses=("constrained", "lines", "notes", "report"),
    ),
    _make(
        *("stl", "STL mesh", ".stl"),
        module="stl",
        sniff=signatures.is_stl,
        writes=("TIN",),
        precision="Coordinates are rounded to float32 after an origin is subtracted: to a sixteen "
        "millionth of the extent.",
        relative_rounding=6e-8,
        losses="The order of vertices and triangles, which edges are constrained, lines and the "
        "report.",
        loses=("order", "constrained", "lines", "notes", "report"),
    ),
    _make(
        *("vtk", "VTK XML mesh (opens in ParaView)", ".vtp", ".vtu"),
        module="vtk",
        extra="view",
        sniff=signatures.is_vtk_xml,
        writes=("TIN",),
        precision=_EXACT,
        losses="Names and kinds of lines, and the report.",
        loses=("lines", "notes", "report"),
    ),
    _make(
        "gmsh",
        "Gmsh mesh, with the edges of boundary and lines (for finite element programs)",
        ".msh",
        module="gmsh",
        extra="mesh",
        sniff=signatures.is_gmsh,
        writes=("TIN",),
        precision=_EXACT,
        losses="The CRS and the unit of elevations; lines are named groups of edges, which are "
        "read as constrained edges; the report.",
        loses=("crs", "elevation unit", "lines", "notes", "report"),
    ),
)
