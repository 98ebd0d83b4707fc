"""The formats of survey text."""

from ..registry.format import Format

__all__ = ["FORMATS"]

FORMATS = (
    Format(
        name="delimited",
        description="Delimited text: survey points as CSV, TXT, XYZ",
        suffixes=(".csv", ".txt", ".xyz", ".tsv", ".pts", ".dat", ".pnt"),
        read="tinsmith.io.delimited.survey_text:read",
        write="tinsmith.io.delimited.survey_text:write",
        precision="Every number comes back bit for bit.",
        losses="Points alone: of a TIN its vertices, without triangles and lines; of a survey no "
        "lines. The CRS is not kept; in .xyz and .pts neither attributes nor the unit of "
        "elevations.",
        loses=(
            *("crs", "elevation unit", "triangles", "constrained", "lines"),
            *("survey lines", "attributes", "notes", "report"),
        ),
    ),
)
