"""The formats of survey text."""

from ..registry import Format

FORMATS = (
    Format(
        name="delimited",
        description="Delimited text: survey points as CSV, TXT, XYZ",
        suffixes=(".csv", ".txt", ".xyz", ".tsv", ".pts", ".dat", ".pnt"),
        is_text=True,
        read="tinsmith.io.delimited.survey_text:read",
        stream="tinsmith.io.delimited.survey_text:stream",
        write="tinsmith.io.delimited.survey_text:write",
        precision="Every number is kept bit for bit.",
        losses="Of a TIN all but its vertices; lines of a survey; the CRS; in .xyz and .pts also "
        "attributes and the unit of elevations.",
        loses=(
            *("crs", "elevation unit", "triangles", "constrained", "lines"),
            *("survey lines", "attributes", "notes", "report"),
        ),
    ),
)
