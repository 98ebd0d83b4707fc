"""The formats of meshes."""

from typing import Any

from ..registry import SURFACES, Format, Loss, signatures
from .signatures import (
    TIN_FILES,
    is_2dm,
    is_adcirc,
    is_cityjson,
    is_esri_tin,
    is_glb,
    is_gzipped_tile,
    is_off,
    is_quantized_mesh,
    is_selafin,
    is_tile_folder,
)

_LOSSES = "Which edges are constrained, lines, attributes and the report"
_LOSES: tuple[Loss, ...] = ("constrained", "lines", "attributes", "notes", "report")
"""What formats of nothing but vertices and triangles do not hold."""


def _make(name: str, description: str, *suffixes: str, module: str, **more: Any) -> Format:
    """Describe a format of TINs that a module here reads and writes, exactly if nothing is said."""
    where = f"{__package__}.{module}"
    usual: dict[str, Any] = {"read": f"{where}:read", "reads": ("TIN",), "write": f"{where}:write"}
    usual |= {"writes": ("TIN",), "precision": "Every number is kept bit for bit."}
    return Format(name=name, description=description, suffixes=suffixes, **(usual | more))


FORMATS = (
    _make(
        "tin",
        "A whole TIN as a GeoPackage (opens in QGIS, ArcGIS, GDAL)",
        ".gpkg",
        module="geopackage",
        side_files={"": ("*-wal", "*-shm", "*-journal")},
        sniff=signatures.is_tin_geopackage,
        sniff_file=signatures.has_tin_among_layers,
    ),
    _make(
        "ply",
        "PLY mesh (opens in CloudCompare, MeshLab, Blender)",
        ".ply",
        module="ply.file",
        sniff=signatures.is_ply,
        writes=SURFACES,
        losses="The report and its notes, and the history of edits; of points, their lines and "
        "attributes that are not numbers.",
        loses=("survey lines", "attributes", "notes", "report"),
    ),
    _make(
        *("obj", "Wavefront OBJ mesh", ".obj"),
        module="obj",
        is_text=True,
        side_files={"": (".mtl",)},
        sniff=signatures.is_obj,
        losses=f"{_LOSSES}.",
        loses=_LOSES,
    ),
    _make(
        *("stl", "STL mesh", ".stl"),
        module="stl",
        sniff=signatures.is_stl,
        precision="Coordinates are rounded to float32 after subtracting an origin: 1/16,000,000 "
        "of the extent.",
        relative_rounding=6e-8,
        losses="The order of vertices and triangles, which edges are constrained, lines, "
        "attributes and the report.",
        loses=("order", *_LOSES),
    ),
    _make(
        *("vtk", "VTK XML mesh (opens in ParaView)", ".vtp", ".vtu"),
        module="vtk",
        is_text=True,
        sniff=signatures.is_vtk_xml,
        losses="Names and kinds of lines, attributes, and the report.",
        loses=("lines", "attributes", "notes", "report"),
    ),
    _make(
        "gmsh",
        "Gmsh mesh, with the edges of boundary and lines (for finite element programs)",
        ".msh",
        module="gmsh",
        is_text=True,
        extra="mesh",
        sniff=signatures.is_gmsh,
        losses="The CRS and the unit of elevations; lines are named groups of edges, which are "
        "read as constrained edges; attributes; the report.",
        loses=("crs", "elevation unit", "lines", "attributes", "notes", "report"),
    ),
    _make(
        "2dm",
        "2DM mesh of SMS (for hydraulic models; opens in QGIS)",
        ".2dm",
        module="hydraulic.sms",
        is_text=True,
        losses="The CRS and the unit of elevations; names and kinds of lines; attributes; the "
        "report.",
        loses=("crs", "elevation unit", "lines", "attributes", "notes", "report"),
        sniff=is_2dm,
    ),
    _make(
        *("adcirc", "Mesh of ADCIRC (fort.14) and SCHISM (hgrid.gr3)", ".14", ".gr3"),
        module="hydraulic.adcirc",
        is_text=True,
        losses="The CRS and the unit of elevations; lines other than open and land boundaries; "
        "which edges are constrained; attributes; the report.",
        loses=("crs", "elevation unit", *_LOSES),
        sniff=is_adcirc,
    ),
    _make(
        *("selafin", "Selafin of TELEMAC (opens in QGIS)", ".slf", ".ser"),
        module="hydraulic.selafin",
        precision="Every number is kept bit for bit; rounded to float32 where that is asked for.",
        losses=f"The CRS; {_LOSSES[0].lower()}{_LOSSES[1:]}.",
        loses=("crs", *_LOSES),
        sniff=is_selafin,
    ),
    _make(
        "ugrid",
        "UGRID mesh in netCDF (for Delft3D FM and xugrid; opens in QGIS)",
        ".nc",
        module="ugrid",
        losses="Names of lines (lines are joined again from edges), attributes, and the report.",
        loses=("lines", "attributes", "notes", "report"),
        extra="mesh",
        sniff=signatures.is_ugrid,
    ),
    Format(
        name="esri-tin",
        description="Esri TIN (a folder of .adf files, of ArcGIS)",
        suffixes=(),
        read="tinsmith.io.mesh.esri_tin:read",
        reads=("TIN",),
        sniff_folder=is_esri_tin,
        part_names=TIN_FILES,
    ),
    _make(
        *("cityjson", "CityJSON 2.0 with a TINRelief", ".city.json", ".cityjson"),
        module="city_json.reading",
        is_text=True,
        write="tinsmith.io.mesh.city_json.writing:write",
        precision="Decimals are kept bit for bit, other numbers to the last digit of float64; or "
        "to the precision asked for.",
        rounding=2e-9,
        losses=f"{_LOSSES}; vertices of no triangle.",
        loses=_LOSES,
        sniff=is_cityjson,
    ),
    Format(
        name="quantized-mesh",
        description="Quantized-mesh 1.0 tiles (a folder with layer.json, for Cesium)",
        suffixes=(),
        write="tinsmith.io.mesh.quantized_mesh.writing:write",
        sniff_folder=is_tile_folder,
        writes=("TIN",),
        precision="Horizontally 1/1000 of an edge of usual length; vertically a millimetre or "
        "1/32,767 of the range of elevations in a tile.",
        losses="The surface is cut into tiles in longitude and latitude, without lines and "
        "attributes; one tile is read at a time.",
        loses=("crs", "elevation unit", "triangles", *_LOSES),
    ),
    Format(
        name="terrain",
        description="One tile of quantized-mesh 1.0",
        suffixes=(".terrain",),
        read="tinsmith.io.mesh.quantized_mesh.reading:read",
        reads=("TIN",),
        sniff=is_quantized_mesh,
        sniff_file=is_gzipped_tile,
    ),
    _make(
        *("glb", "GLB, binary glTF 2.0 (for viewers, browsers, game engines)", ".glb"),
        module="gltf.reading",
        write="tinsmith.io.mesh.gltf.writing:write",
        precision="1/16,000,000 of the extent, relative to an origin stored in the file.",
        relative_rounding=6e-8,
        losses=f"{_LOSSES}; vertices of no triangle.",
        loses=_LOSES,
        sniff=is_glb,
    ),
    _make(
        "off",
        "Object File Format mesh",
        ".off",
        module="off",
        is_text=True,
        losses=f"{_LOSSES}.",
        loses=_LOSES,
        sniff=is_off,
    ),
)
