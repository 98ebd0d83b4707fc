"""What the format is; nothing heavy is loaded to know that."""

from tinsmith import Format

__all__ = ["IFC"]

IFC = Format(
    name="ifc",
    description="IFC 4: a georeferenced site (opens in BIM programs)",
    suffixes=(".ifc",),
    write="tinsmith_ifc.writing:write",
    writes=("TIN",),
    precision="Coordinates are relative to a corner of the site, in the digits of doubles.",
    relative_rounding=1e-15,
    losses="Which edges are constrained, lines and the report.",
    loses=("constrained", "lines", "notes", "report"),
)
