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
    ),
    Format(
        name="obj",
        description="Wavefront OBJ mesh",
        suffixes=(".obj",),
        read="tinsmith.io.mesh.obj:read",
        reads=("TIN",),
        write="tinsmith.io.mesh.obj:write",
        sniff=signatures.is_obj,
    ),
    Format(
        name="stl",
        description="STL mesh",
        suffixes=(".stl",),
        read="tinsmith.io.mesh.stl:read",
        reads=("TIN",),
        write="tinsmith.io.mesh.stl:write",
        sniff=signatures.is_stl,
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
    ),
)
