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
        help="Join all surfaces of a CityJSON file to one TIN.",
    ),
    click.option(
        "--variable",
        metavar="NAME",
        help="Variable of a UGRID file that holds the elevations of its nodes.",
    ),
    click.option(
        "--tile",
        metavar="LEVEL/COLUMN/ROW",
        help="Position of a quantized-mesh tile, if its path does not contain it.",
    ),
)

MESH_WRITING = (
    click.option(
        "--multipatch",
        is_flag=True,
        help="Write a shapefile with one MultiPatch, the surface type of ArcGIS, instead of "
        "polygons.",
    ),
    click.option(
        "--ortho",
        metavar="FILE",
        type=INPUT,
        help="Drape an image over a GLB or OBJ file: a GeoTIFF in any CRS, or a PNG or JPEG file "
        "with a world file beside it.",
    ),
    click.option(
        "--name", "surface_name", metavar="NAME", help="Name of the surface in a LandXML file."
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
        help="Thickness of the base of --solid below the lowest vertex: millimetres with --scale "
        "or --size, else CRS units.",
    ),
    click.option(
        "--scale",
        metavar="N",
        type=float,
        help="Write an STL model at 1:N in millimetres.",
    ),
    click.option(
        "--size",
        metavar="MM",
        type=float,
        help="Write an STL model whose longer side has this length in millimetres.",
    ),
    click.option(
        "--exaggeration",
        metavar="FACTOR",
        type=float,
        help="Vertical exaggeration of a GLB file or an STL model.",
    ),
    click.option(
        "--precision",
        metavar="STEP",
        type=float,
        help="Resolution of the coordinates of a CityJSON file, such as 0.001; default all digits.",
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
