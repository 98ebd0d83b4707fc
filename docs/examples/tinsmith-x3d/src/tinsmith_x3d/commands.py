"""``tinsmith x3d-summary``: what an X3D file says of its surface."""

from __future__ import annotations

import click

__all__ = ["x3d_summary"]


@click.command(short_help="Tell what an X3D file says of its surface.")
@click.argument("file", type=click.Path(exists=True, dir_okay=False))
def x3d_summary(file: str) -> None:
    """Tell the CRS, the origin and the size of the surface in FILE."""
    from xml.etree import ElementTree as ET

    root = ET.parse(file).getroot()
    for meta in root.iter("meta"):
        click.echo(f"{meta.get('name', ''):8}{meta.get('content')}")
    for triangles in root.iter("IndexedTriangleSet"):
        points = triangles.find("Coordinate").get("point").split()
        corners = triangles.get("index").split()
        click.echo(f"surface {len(points) // 3:,} vertices, {len(corners) // 3:,} triangles")
