"""Layers with colours and widths, names of properties and extended data, units (``$INSUNITS``)."""

from __future__ import annotations

from ....base.crs import FOOT, METRE, US_SURVEY_FOOT, Unit

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
    "POINT_CUT_FILL": 1,
    "CONTOURS": 32,
    "INDEX_CONTOURS": 34,
    "CONTOUR_LABELS": 7,
    "CONSTRAINED_EDGES": 9,
    "LINES": 7,
    "POLYGONS": 7,
}
"""Colours by AutoCAD's index."""

HEAVY = {"INDEX_CONTOURS": 35}
"""Widths of lines in hundredths of a millimetre, where they are not the usual one."""


UNIT_OF_CODE = {
    1: Unit.of("in"),
    2: FOOT,
    3: Unit("Statute mile", "mi", 1609.344),
    4: Unit.of("mm"),
    5: Unit.of("cm"),
    6: METRE,
    7: Unit.of("km"),
    10: Unit.of("yd"),
    14: Unit.of("dm"),
    21: US_SURVEY_FOOT,
}
"""Units of lengths that surveys have; 0 stands for none."""


def find_code(unit: Unit | None) -> int:
    """Return the number of a unit, 0 for one that DXF does not have."""
    return next((code for code, one in UNIT_OF_CODE.items() if one == unit), 0)
