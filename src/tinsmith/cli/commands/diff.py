"""``tinsmith diff``: one surface subtracted from another."""

from __future__ import annotations

from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Any

import click

from ..options import (
    console_options,
    output_files,
    product_options,
    reading_options,
    triangulating_options,
)
from ..output.console import format_json
from ..paths import INPUT, make_title

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ...terrain import Difference, Table
    from ...tin import TIN
    from ..options import Reading, Triangulating, Writing
    from ..output.console import Console, Row
    from ..surfaces import Products

__all__ = ["diff"]


@click.command(short_help="Subtract one surface from another: TIN, zones, statistics, map.")
@click.argument("file", metavar="FILE", type=INPUT)
@click.argument("other", metavar="OTHER", type=INPUT)
@output_files
@click.option(
    "--zero-line",
    is_flag=True,
    help="Write the line between cut and fill to vector files, in place of the polygons.",
)
@click.option("--title", metavar="TEXT", help="Of the map; default the names of the files.")
@reading_options
@triangulating_options
@product_options
@console_options
def diff(
    file: Path,
    other: Path,
    outputs: tuple[Path, ...],
    zero_line: bool,
    title: str | None,
    reading: Reading,
    how: Triangulating,
    writing: Writing,
    console: Console,
) -> None:
    """Subtract the TIN in FILE from that in OTHER, exactly where both are.

    The difference is a TIN itself (.ply, .obj, .vtu ...) above 0 where OTHER is higher. Statistics,
    weighted by area, go to .csv or .json, the parts that are cut and filled to .gpkg, .geojson,
    .shp or .fgb, a map to .png.

    \b
    Example:
      tinsmith diff sample_data/site_survey.csv sample_data/design_pad.csv --codes -o pad.ply
    """  # noqa: D301 - click reads the control character
    from ...terrain import difference
    from ..surfaces import plan_products, read_surfaces, surface_inputs

    started = perf_counter()
    files = (file, other)
    kinds = ("TIN", "Table", "Features", "picture")
    inputs = surface_inputs(files, how)
    planned = plan_products(outputs, writing, inputs=inputs, console=console, kinds=kinds)
    surfaces = read_surfaces(files, reading, how, console)
    with console.steps() as steps, steps.step("Overlaying"):
        found = difference(*surfaces)
    _write(found, surfaces[0], planned, zero_line, title or _title(files), console)
    console.summarise(
        [
            *_fields(found, surfaces),
            ("Written", planned.text),
            ("Time", f"{perf_counter() - started:.2f} s"),
        ]
    )
    if console.as_json:
        console.emit(format_json(_facts(files, found, planned)))


def _title(files: Sequence[Path]) -> str:
    return f"Difference: {make_title(files[1])} less {make_title(files[0])}"


def _write(
    found: Difference,
    ground: TIN,
    planned: Products,
    zero_line: bool,
    title: str,
    console: Console,
) -> None:
    from ...terrain import earthwork_map

    planned.write("TIN", found.tin, console)
    if planned.holds("Table"):
        planned.write("Table", found.statistics, console)
    if planned.holds("Features"):
        planned.write("Features", found.zero_line if zero_line else found.zones, console)
    planned.draw(lambda: earthwork_map(found, ground=ground, title=title), console)


def _fields(found: Difference, surfaces: Sequence[TIN]) -> list[Row]:
    from ..output.line_summaries import mesh_counts

    table = found.statistics
    return [
        *zip(("First", "Other"), map(mesh_counts, surfaces), strict=True),
        ("Difference", mesh_counts(found.tin)),
        ("Mean", f"{_text(table, 'mean')}, root mean square {_text(table, 'rms')}"),
        ("Range", f"{_text(table, 'lowest')} to {_text(table, 'highest')}"),
        (
            "Middle",
            f"{_text(table, 'median')}, 90 % {_text(table, 'p05')} to {_text(table, 'p95')}",
        ),
        ("Area", _text(table, "area")),
        *(("Note", note) for note in found.notes),
    ]


def _text(table: Table, name: str) -> str:
    unit: Any = table.units.get(name)
    digits = 2 if name == "area" else 4
    return f"{table[name][0]:,.{digits}f} {getattr(unit, 'symbol', unit) or ''}".rstrip()


def _facts(files: Sequence[Path], found: Difference, planned: Products) -> dict[str, Any]:
    from ...terrain.results.columns import unit_text

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
        "outputs": [str(path) for path in planned.paths],
    }
