"""Options of meshes: what to read of a file, how to write it for viewers and printers."""

from __future__ import annotations

import click

from .paths import INPUT

__all__ = ["MESH_READING", "MESH_WRITING"]

MESH_READING = (
    click.option(
        "--join",
        is_flag=True,
        default=None,
        help="Make one TIN of all surfaces of a CityJSON file.",
    ),
    click.option(
        "--variable",
        metavar="NAME",
        help="Variable of a UGRID file that holds the elevations of its nodes.",
    ),
    click.option(
        "--tile",
        metavar="LEVEL/COLUMN/ROW",
        help="Where a quantized-mesh tile lies, if its path does not tell.",
    ),
)

MESH_WRITING = (
    click.option(
        "--multipatch",
        is_flag=True,
        help="Write a shapefile of one MultiPatch, the surface that ArcGIS knows, not of polygons.",
    ),
    click.option(
        "--ortho",
        "--texture",
        "texture",
        metavar="FILE",
        type=INPUT,
        help="Drape a picture over a GLB or OBJ file: a GeoTIFF in any CRS, or a PNG or JPEG file "
        "with a world file beside it.",
    ),
    click.option(
        "--solid",
        is_flag=True,
        help="Close an STL file with a base and walls, for 3D printing.",
    ),
    click.option(
        "--thickness",
        metavar="LENGTH",
        type=float,
        help="Of the base of --solid below the lowest vertex: millimetres with --scale or --size, "
        "else CRS units.",
    ),
    click.option(
        "--scale",
        metavar="N",
        type=float,
        help="Make an STL model of 1:N in millimetres.",
    ),
    click.option(
        "--size",
        metavar="MM",
        type=float,
        help="Make an STL model whose longer side has so many millimetres.",
    ),
    click.option(
        "--exaggeration",
        metavar="FACTOR",
        type=float,
        help="Factor on the elevations of a GLB file or an STL model.",
    ),
    click.option(
        "--precision",
        metavar="STEP",
        type=float,
        help="Step of the coordinates of a CityJSON file, such as 0.001; default every digit.",
    ),
    click.option(
        "--max-level",
        metavar="N",
        type=click.IntRange(min=0),
        help="Finest level of quantized-mesh tiles; default as fine as the TIN.",
    ),
    click.option(
        "--gzipped",
        is_flag=True,
        help="Compress quantized-mesh tiles.",
    ),
)
