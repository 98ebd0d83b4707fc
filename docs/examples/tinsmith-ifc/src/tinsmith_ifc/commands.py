"""``tinsmith ifc-summary``: what an IFC file says of its site."""

from __future__ import annotations

import click

__all__ = ["ifc_summary"]


@click.command(short_help="Tell what an IFC file says of its site.")
@click.argument("file", type=click.Path(exists=True, dir_okay=False))
def ifc_summary(file: str) -> None:
    """Tell the schema, CRS, origin and size of the surface in FILE."""
    import ifcopenshell

    model = ifcopenshell.open(file)
    for conversion in model.by_type("IfcMapConversion"):
        origin = (conversion.Eastings, conversion.Northings, conversion.OrthogonalHeight)
        click.echo(f"CRS     {conversion.TargetCRS.Name}")
        click.echo(f"Origin  {', '.join(f'{value:g}' for value in origin)}")
    for faces in model.by_type("IfcTriangulatedFaceSet"):
        click.echo(
            f"Surface {len(faces.Coordinates.CoordList):,} vertices, "
            f"{len(faces.CoordIndex):,} triangles"
        )
