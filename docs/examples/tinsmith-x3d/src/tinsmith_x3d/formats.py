"""What the format is; nothing heavy is loaded to know that."""

from tinsmith import Format

__all__ = ["X3D"]

X3D = Format(
    name="x3d",
    description="X3D 4.0: a scene (opens in browsers, Blender, MeshLab)",
    suffixes=(".x3d",),
    write="tinsmith_x3d.writing:write",
    writes=("TIN",),
    is_text=True,
    precision="Coordinates are relative to a corner of the site, in the digits of doubles.",
    relative_rounding=1e-15,
    losses="Which edges are constrained, lines and the report.",
    loses=("constrained", "lines", "notes", "report"),
)
