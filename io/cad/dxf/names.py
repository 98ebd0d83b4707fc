"""Names that drawings have from here: layers with their colours, properties, extended data."""

__all__ = ["APPLICATION", "CONSTRAINED", "CRS_PROPERTY", "ELEVATION_PROPERTY", "LAYERS", "UNKNOWN"]

APPLICATION = "TINSMITH"
"""Whose extended data keep the names and kinds of lines, numbers and descriptions of points."""

CONSTRAINED = "constrained"
"""Kind of edges that are constrained, but belong to no line."""

CRS_PROPERTY = "CRS"
ELEVATION_PROPERTY = "Elevation unit"
UNKNOWN = "unknown"

LAYERS = {
    "TIN": 8,
    "BREAKLINES": 1,
    "SOFT_BREAKLINES": 30,
    "BOUNDARY": 5,
    "HOLES": 6,
    "ERASE": 9,
    "WATER": 4,
    "POINTS": 3,
    "POINT_NUMBERS": 2,
    "POINT_ELEVATIONS": 7,
    "POINT_DESCRIPTIONS": 9,
    "CONTOURS": 32,
    "INDEX_CONTOURS": 34,
    "CONSTRAINED_EDGES": 9,
    "LINES": 7,
    "POLYGONS": 7,
}
"""Colours by AutoCAD's index."""
