"""The formats of drawings and design data."""

from ..registry.format import SURFACES, Format
from . import signatures

__all__ = ["FORMATS"]

FORMATS = (
    Format(
        name="landxml",
        description="LandXML (Civil 3D, Carlson, 12d, Trimble)",
        suffixes=(".xml", ".landxml"),
        read="tinsmith.io.cad.landxml.reading:read",
        reads=("TIN", "Survey"),
        write="tinsmith.io.cad.landxml.writing:write",
        writes=(*SURFACES, "Features"),
        precision="Coordinates are kept bit for bit.",
        losses="One unit for coordinates and elevations; of a survey attributes other than number, "
        "description and code, and erased areas; notes and report; vertices of no "
        "triangle.",
        loses=("elevation unit", "erased areas", "attributes", "notes", "report"),
        sniff=signatures.is_landxml,
    ),
    Format(
        name="dxf",
        description="DXF drawing (AutoCAD and other CAD)",
        suffixes=(".dxf",),
        read="tinsmith.io.cad.dxf.reading:read",
        reads=("TIN", "Survey"),
        write="tinsmith.io.cad.dxf.writing:write",
        writes=(*SURFACES, "Features"),
        precision="Coordinates are kept bit for bit.",
        losses="One unit for coordinates and elevations; the numbers of vertices; attributes of "
        "points but number and description; columns of features; notes and report. R12 has no "
        "CRS.",
        loses=("elevation unit", "order", "attributes", "notes", "report"),
        extra="cad",
        sniff=signatures.is_dxf,
    ),
)
