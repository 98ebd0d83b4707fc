"""The formats of tables."""

from ..registry import Format


def _make(
    name: str,
    description: str,
    *suffixes: str,
    writes: tuple[str, ...] = ("Table",),
    losses: str,
    precision: str = "Every number is kept bit for bit.",
) -> Format:
    """Describe a format that tables are written in, with every number."""
    return Format(
        name=name,
        description=description,
        suffixes=suffixes,
        write=f"{__package__}.{name}_tables:write",
        writes=writes,
        precision=precision,
        losses=losses,
        is_text=True,
    )


FORMATS = (
    _make(
        *("csv", "CSV (RFC 4180) with units in the header", ".csv", ".tsv", ".txt"),
        writes=("Table", "Features"),
        losses="Notes and the CRS.",
        precision="Every number is kept bit for bit, unless decimals= rounds it.",
    ),
    _make("json", "JSON with units", ".json", losses=""),
)
