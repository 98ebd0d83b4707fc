"""The formats of drawings and design data."""

from typing import Any

from ..registry import SURFACES, Format
from . import signatures


def _make(name: str, description: str, *suffixes: str, **more: Any) -> Format:
    """Describe a format that the package of its name reads and writes."""
    where = f"{__package__}.{name}"
    ends: dict[str, Any] = {"read": f"{where}.reading:read", "reads": ("TIN", "Survey")}
    ends |= {"write": f"{where}.writing:write", "writes": (*SURFACES, "Features")}
    ends["is_text"] = True
    ends["precision"] = "Coordinates are kept bit for bit."
    return Format(name=name, description=description, suffixes=suffixes, **(ends | more))


FORMATS = (
    _make(
        *("landxml", "LandXML (Civil 3D, Carlson, 12d, Trimble)", ".xml", ".landxml"),
        writes=(*SURFACES, "Features", "Alignment"),
        precision="Coordinates are kept bit for bit, or to the decimals asked for.",
        losses="One unit for coordinates and elevations; of a survey attributes other than number, "
        "description and code, and erased areas; notes and report; vertices of no "
        "triangle.",
        loses=("elevation unit", "erased areas", "attributes", "notes", "report"),
        sniff=signatures.is_landxml,
    ),
    _make(
        *("12da", "Archive of 12d Model", ".12da"),
        read=f"{__package__}.archive_12d.reading:read",
        write=f"{__package__}.archive_12d.writing:write",
        writes=SURFACES,
        losses="The CRS and the units; attributes of points; notes and report; vertices of no "
        "triangle.",
        loses=("crs", "elevation unit", "attributes", "notes", "report"),
        sniff=signatures.is_12da,
    ),
    Format(
        name="ifc",
        description="IFC 4.3 or IFC 4 terrain (for BIM programs)",
        suffixes=(".ifc",),
        write=f"{__package__}.ifc.writing:write",
        writes=("TIN",),
        is_text=True,
        precision="Coordinates are relative to a corner of the surface, in the digits of doubles.",
        relative_rounding=1e-15,
        losses="One unit for coordinates and elevations; in IFC 4 which edges are constrained, but "
        "for those of lines; notes and report.",
        loses=("elevation unit", "attributes", "notes", "report"),
    ),
    _make(
        *("dxf", "DXF drawing (AutoCAD and other CAD)", ".dxf"),
        losses="One unit for coordinates and elevations; the numbers of vertices; attributes of "
        "points but number and description; columns of features; notes and report. R12 has no "
        "CRS.",
        loses=("elevation unit", "order", "attributes", "notes", "report"),
        sniff=signatures.is_dxf,
    ),
)
