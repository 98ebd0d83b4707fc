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
    ),
)
