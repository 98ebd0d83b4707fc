"""``tinsmith diff``: one surface subtracted from another."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..command import command
from ..parameters import input_file, output_files
from ..paths import make_title
from ..request import surface_options

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ...terrain import Difference, Table
    from ...tin import TIN
    from ..output.console import Row
    from ..products import Products
    from ..request import Request

__all__ = ["diff"]


@command
@input_file("file")
@input_file("other")
@output_files
@click.option(
    "--zero-line",
    is_flag=True,
    help="Write the line between cut and fill to vector files, in place of the polygons.",
)
@click.option("--title", metavar="TEXT", help="Title of the map; default the names of the files.")
@surface_options()
def diff(
    file: Path,
    other: Path,
    zero_line: bool,
    title: str | None,
    request: Request,
) -> None:
    """Subtract the TIN in FILE from that in OTHER, exactly, where both exist.

    The difference is itself a TIN (.ply, .obj, .vtu ...), above 0 where OTHER is higher.
    Statistics, weighted by area, go to .csv or .json, the parts that are cut and filled to .gpkg,
    .geojson, .shp or .fgb, a map to .png.

    \b
    Example:
      tinsmith diff sample_data/site_survey.csv sample_data/design_pad.csv --codes -o pad.ply
    """  # noqa: D301 - click reads the control character
    from ...terrain import difference

    files = (file, other)
    inputs = request.list_inputs(*files)
    planned = request.plan_products(inputs, "TIN", "Table", "Features", "picture")
    surfaces = request.read_tins(files)
    with request.step("Overlaying") as progress:
        found = difference(*surfaces, progress=progress)
    _write(found, surfaces[0], planned, zero_line, title or _make_title(files))
    rows = _summarise_difference(found, surfaces)
    request.finish(planned, rows, lambda: _describe_difference(files, found))


def _make_title(files: Sequence[Path]) -> str:
    return f"Difference: {make_title(files[1])} less {make_title(files[0])}"


def _write(found: Difference, ground: TIN, planned: Products, zero_line: bool, title: str) -> None:
    from ...terrain import earthwork_map

    planned.write("TIN", found.tin)
    if planned.holds("Table"):
        planned.write("Table", found.statistics)
    if planned.holds("Features"):
        planned.write("Features", found.zero_line if zero_line else found.zones)
    planned.draw(lambda: earthwork_map(found, ground=ground, title=title))


def _summarise_difference(found: Difference, surfaces: Sequence[TIN]) -> list[Row]:
    from ..output.line_summaries import mesh_counts

    table = found.statistics
    return [
        *zip(("First", "Other"), map(mesh_counts, surfaces), strict=True),
        ("Difference", mesh_counts(found.tin)),
        ("Mean", f"{_format(table, 'mean')}, root mean square {_format(table, 'rms')}"),
        ("Range", f"{_format(table, 'lowest')} to {_format(table, 'highest')}"),
        (
            "Middle",
            f"{_format(table, 'median')}, 90 % {_format(table, 'p05')} to {_format(table, 'p95')}",
        ),
        ("Area", _format(table, "area")),
        *(("Note", note) for note in found.notes),
    ]


def _format(table: Table, name: str) -> str:
    unit: Any = table.units.get(name)
    digits = 2 if name == "area" else 4
    return f"{table[name][0]:,.{digits}f} {getattr(unit, 'symbol', unit) or ''}".rstrip()


def _describe_difference(files: Sequence[Path], found: Difference) -> dict[str, Any]:
    from ...base.results.columns import unit_text

    table = found.statistics
    return {
        "inputs": [str(file) for file in files],
        "statistics": {name: values[0] for name, values in table.columns.items()},
        "units": {name: unit_text(table.units, name) for name in table.units},
        "cut": found.cut,
        "fill": found.fill,
        "vertices": len(found.tin.points),
        "triangles": len(found.tin.triangles),
        "notes": list(found.notes),
    }
