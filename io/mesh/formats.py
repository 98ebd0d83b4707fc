"""The formats of meshes."""

from ..registry import signatures
from ..registry.format import Format

__all__ = ["FORMATS"]

FORMATS = (
    Format(
        name="tin",
        description="A whole TIN as a GeoPackage (opens in QGIS, ArcGIS, GDAL)",
        suffixes=(".gpkg",),
        read="tinsmith.io.mesh.geopackage:read",
        reads=("TIN",),
        write="tinsmith.io.mesh.geopackage:write",
        writes=("TIN",),
        precision="Every number comes back bit for bit.",
        losses="",
        sniff=signatures.is_tin_geopackage,
    ),
    Format(
        name="ply",
        description="PLY mesh (opens in QGIS, CloudCompare, MeshLab)",
        suffixes=(".ply",),
        read="tinsmith.io.mesh.ply.file:read",
        reads=("TIN",),
        write="tinsmith.io.mesh.ply.file:write",
        sniff=signatures.is_ply,
        precision="Every number comes back bit for bit.",
        losses="The report and its notes, and what undoing edits needs; of points, attributes that "
        "are no numbers.",
        loses=("attributes", "notes", "report"),
    ),
    Format(
        name="obj",
        description="Wavefront OBJ mesh",
        suffixes=(".obj",),
        read="tinsmith.io.mesh.obj:read",
        reads=("TIN",),
        write="tinsmith.io.mesh.obj:write",
        sniff=signatures.is_obj,
        writes=("TIN",),
        precision="Every number comes back bit for bit.",
        losses="Which edges are constrained, lines and the report.",
        loses=("constrained", "lines", "notes", "report"),
    ),
    Format(
        name="stl",
        description="STL mesh",
        suffixes=(".stl",),
        read="tinsmith.io.mesh.stl:read",
        reads=("TIN",),
        write="tinsmith.io.mesh.stl:write",
        sniff=signatures.is_stl,
        writes=("TIN",),
        precision="Coordinates are rounded to float32 after an origin is subtracted: to a sixteen "
        "millionth of the extent.",
        relative_rounding=6e-8,
        losses="The order of vertices and triangles, which edges are constrained, lines and the "
        "report.",
        loses=("order", "constrained", "lines", "notes", "report"),
    ),
    Format(
        name="vtk",
        description="VTK XML mesh (opens in ParaView)",
        suffixes=(".vtp", ".vtu"),
        read="tinsmith.io.mesh.vtk:read",
        reads=("TIN",),
        write="tinsmith.io.mesh.vtk:write",
        extra="view",
        sniff=signatures.is_vtk_xml,
        writes=("TIN",),
        precision="Every number comes back bit for bit.",
        losses="Names and kinds of lines, and the report.",
        loses=("lines", "notes", "report"),
    ),
    Format(
        name="gmsh",
        description="Gmsh mesh, with the edges of rim and lines (for finite element programs)",
        suffixes=(".msh",),
        read="tinsmith.io.mesh.gmsh:read",
        reads=("TIN",),
        write="tinsmith.io.mesh.gmsh:write",
        extra="mesh",
        sniff=signatures.is_gmsh,
        writes=("TIN",),
        precision="Every number comes back bit for bit.",
        losses="The CRS and the unit of elevations; lines are named groups of edges, which are "
        "read as constrained edges; the report.",
        loses=("crs", "elevation unit", "lines", "notes", "report"),
    ),
)
