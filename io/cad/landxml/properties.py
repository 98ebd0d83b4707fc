"""Names of the features and properties in which the writer keeps what LandXML has no place for."""

__all__ = ["ELEVATION_UNIT", "FEATURE", "KIND", "LINE", "PRIORITY", "SOURCE", "UNKNOWN"]

FEATURE = "tinsmith"
"""Name of such a feature."""

ELEVATION_UNIT = "elevationUnit"
"""Of the CRS: ``UNKNOWN`` if the unit of elevations is not known."""

UNKNOWN = "unknown"
KIND = "kind"
"""Of a line: what it is, where that is no hard breakline."""

PRIORITY = "priority"
LINE = "line"
"""Of a line: which line of its TIN it is."""

SOURCE = "source"
"""Of a line: the line that it comes from, counted as in a TIN."""
