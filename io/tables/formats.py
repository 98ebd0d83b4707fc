"""The formats of tables."""

from ..registry.format import Format

__all__ = ["FORMATS"]

FORMATS = (
    Format(
        name="csv",
        description="CSV (RFC 4180) with units in the header",
        suffixes=(".csv", ".tsv", ".txt"),
        write="tinsmith.io.tables.csv_tables:write",
        writes=("Table", "Features"),
        precision="Every number is kept bit for bit.",
        losses="Notes and the CRS.",
    ),
    Format(
        name="json",
        description="JSON with units",
        suffixes=(".json",),
        write="tinsmith.io.tables.json_tables:write",
        writes=("Table",),
        precision="Every number is kept bit for bit.",
        losses="",
    ),
)
