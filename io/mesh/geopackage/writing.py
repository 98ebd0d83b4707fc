"""Write a TIN as a GeoPackage, by SQLite alone."""

from __future__ import annotations

import json
import sqlite3
from contextlib import closing
from typing import TYPE_CHECKING, Any

import numpy as np

from ....base.checks import as_flag
from ....base.errors import CrsError, WriteError
from ....base.sentences import FILE
from ....terrain.relief import aspect, slope
from ..common import format_unit, require_tin
from .existing_layers import Placing, adding_layers
from .pages import Column, fill_table, make_blobs, make_integers, make_reals, make_texts
from .records import describe_layer_columns, pack_tin
from .schema import (
    APPLICATION_ID,
    LAYERS,
    NO_CLOCK,
    NUMBERS,
    RECORD,
    TABLES,
    USER_VERSION,
    declare_layer,
    declare_numbers,
    declare_view,
    describe_crs,
    digest_arrays,
    digest_lines,
    make_chain_blobs,
    make_points,
    make_triangles,
)
from .styles import write_styles

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from ....base.arrays import AnyArray
    from ....base.progress import Tell
    from ....tin import TIN
    from .records import LayerColumn

_CHUNK = 1 << 16
"""Triangles in memory at a time, as geometries."""

_MOST_COLUMNS, _LONGEST_TEXTS = 40, 1024
"""Attributes, and characters of their texts, of vertices whose rows are made as arrays."""

_PAGE = 1 << 15
"""Bytes of a page: a fifth faster than SQLite's own 4096, and all names of tables in the first."""


def write(
    surface: TIN,
    path: Path,
    *,
    overwrite: bool = False,
    compact: bool = False,
    progress: Tell | None = None,
) -> None:
    """Write all that a TIN is as a GeoPackage; :func:`read` gives it back, bit for bit.

    Parameters
    ----------
    overwrite : bool
        Replace layers of the names below that another program wrote or changed.
    compact : bool
        Write triangles as a table of vertex numbers, and a view that makes polygons of it when a
        program asks for them, without slope and aspect: a quarter of the size, and all of the TIN.
        GDAL and QGIS show all layers; 1 to 5 us a triangle each time that they are read.

    Raises
    ------
    WriteError
        If the file cannot be written, or is open in another program; if it has layers of the names
        below that tinsmith did not write.

    Notes
    -----
    Layers: ``vertices`` (points with z, their numbers and attributes), ``triangles`` (polygons
    with the numbers ``a``, ``b``, ``c`` of their vertices, slope and aspect in degrees, and
    ``constrained``, of which bit 0 is that of the edge opposite ``a``), ``lines`` (kind, name and
    source), ``boundary`` (closed lines) and ``water`` (polygons with their elevation). The table
    ``tinsmith_tin`` holds the rest: the report, and what edits and undoing them need. Other layers
    of a file that is there already stay as they are. ``layer_styles`` has the styles in which QGIS
    draws these layers, triangles by elevation; styles that a user keeps there go first.
    """
    tin = require_tin(surface, format_name="a GeoPackage of a TIN")
    tell = progress or (lambda _: None)
    is_compact = as_flag("compact", compact)
    attributes = describe_layer_columns(tin.attributes, ("fid", "geom", "vertex"))
    with adding_layers(path, Placing(overwrite=as_flag("overwrite", overwrite))) as beside:
        try:
            with closing(sqlite3.connect(beside, isolation_level=None)) as file:
                srs = _write_content(file, tin, attributes, compact=is_compact)
                roots = dict(file.execute("SELECT name, rootpage FROM sqlite_schema"))
            with beside.open("r+b") as content:
                if _are_short(attributes):
                    fill_table(content, roots["vertices"], _list_vertices(tin, srs, attributes))
                tell(0.2)
                rows = _list_numbers(tin) if is_compact else _list_triangles(tin, srs, tell)
                fill_table(content, roots[NUMBERS if is_compact else "triangles"], rows)
                tell(1.0)
        except sqlite3.Error as error:
            raise WriteError(f"Cannot write {FILE}: {error}.") from error


def _write_content(
    file: sqlite3.Connection, tin: TIN, attributes: list[LayerColumn], *, compact: bool
) -> int:
    """Write all but the rows of large layers, and return the number of the CRS."""
    file.execute("PRAGMA journal_mode = OFF")  # the file takes its place when it is complete
    file.execute("PRAGMA synchronous = OFF")
    file.execute(f"PRAGMA page_size = {_PAGE}")
    file.execute(f"PRAGMA application_id = {APPLICATION_ID}")
    file.execute(f"PRAGMA user_version = {USER_VERSION}")
    file.execute("BEGIN")
    layers = {name: declare_layer(name) for name in LAYERS}
    if compact:
        layers |= {"triangles": declare_view(), NUMBERS: declare_numbers()}
    for declaration in (*TABLES, *layers.values()):
        file.execute(declaration)
    srs = _write_contents(file, tin)
    _write_lines(file, tin, srs)
    _write_record(file, tin)
    write_styles(file, tin)
    for column in attributes:
        file.execute(f"ALTER TABLE vertices ADD COLUMN {column.declaration}")
    if not _are_short(attributes):
        _insert_vertices(file, tin, srs, attributes)
    file.execute("COMMIT")
    return srs


def _insert_vertices(
    file: sqlite3.Connection, tin: TIN, srs: int, attributes: list[LayerColumn]
) -> None:
    """Write vertices row by row, whose rows may be longer than a page."""
    marks = ", ".join("?" * (3 + len(attributes)))
    for part in _divide(len(tin.points)):
        numbers = range(part.start, part.stop)
        blobs = map(bytes, make_points(tin.points[part], srs))
        parts = [column.values[part] for column in attributes]
        plain = [one.tolist() if isinstance(one, np.ndarray) else one for one in parts]
        file.executemany(
            f"INSERT INTO vertices VALUES ({marks})",
            zip((number + 1 for number in numbers), blobs, numbers, *plain, strict=True),
        )


def _are_short(attributes: list[LayerColumn]) -> bool:
    """Whether rows are made as arrays, which have the longest text in every row."""
    longest = sum(
        max(len(text or "") for text in column.values)
        for column in attributes
        if isinstance(column.values, list)
    )
    return len(attributes) <= _MOST_COLUMNS and longest <= _LONGEST_TEXTS


def _write_contents(file: sqlite3.Connection, tin: TIN) -> int:
    """Write the tables that every GeoPackage has, and return the number of the CRS."""
    rows = describe_crs(tin.crs)
    srs = rows[-1][1]
    marks = ", ".join("?" * 7)
    file.executemany(f"INSERT INTO gpkg_spatial_ref_sys VALUES ({marks})", rows)
    unit = format_unit(tin) or "an unknown unit"
    box = tin.bounds
    for name, (geometry, _) in LAYERS.items():
        row = (name, "features", name, f"Elevations in {unit}.", NO_CLOCK)
        file.execute(
            "INSERT INTO gpkg_contents VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
            (*row, box.xmin, box.ymin, box.xmax, box.ymax, srs),
        )
        file.execute(
            "INSERT INTO gpkg_geometry_columns VALUES (?, 'geom', ?, ?, 1, 0)",
            (name, geometry, srs),
        )
    file.execute(
        "INSERT INTO gpkg_contents (table_name, data_type, identifier, description, last_change) "
        "VALUES (?, 'attributes', ?, 'What tinsmith knows of the TIN beside the layers.', ?)",
        (RECORD, RECORD, NO_CLOCK),
    )
    file.execute(
        "INSERT INTO gpkg_extensions VALUES ('gpkg_spatial_ref_sys', 'definition_12_063', "
        "'gpkg_crs_wkt', 'http://www.geopackage.org/spec/#extension_crs_wkt', 'read-write')"
    )
    return srs


def _write_lines(file: sqlite3.Connection, tin: TIN, srs: int) -> None:
    chains = [tin.points[chain] for chain in tin.lines.chains()]
    kinds, names, sources = tin.lines.kinds, tin.lines.names, tin.lines.sources.tolist()
    blobs = make_chain_blobs(chains, srs, as_rings=False)
    file.executemany(
        "INSERT INTO lines (geom, kind, name, source) VALUES (?, ?, ?, ?)",
        zip(blobs, kinds, names, sources, strict=True),
    )
    rings = [tin.points[np.append(ring, ring[0])] for ring in tin.boundary]
    file.executemany(
        "INSERT INTO boundary (geom, ring) VALUES (?, ?)",
        zip(make_chain_blobs(rings, srs, as_rings=False), range(len(rings)), strict=True),
    )
    water = [
        (chain, name)
        for chain, kind, name in zip(chains, kinds, names, strict=True)
        if kind == "water" and len(chain) > 3 and (chain[0] == chain[-1]).all()
    ]
    shapes = make_chain_blobs([chain for chain, _ in water], srs, as_rings=True)
    file.executemany(
        "INSERT INTO water (geom, name, elevation) VALUES (?, ?, ?)",
        [
            (shape, name, float(chain[0, 2]))
            for shape, (chain, name) in zip(shapes, water, strict=True)
        ],
    )


def _write_record(file: sqlite3.Connection, tin: TIN) -> None:
    """Write what the layers do not show, with digests of it and of them."""
    document, arrays = pack_tin(tin)
    text = json.dumps(document, ensure_ascii=False, allow_nan=False)
    digests = {
        "mesh": digest_arrays(tin.points, tin.triangles, tin.constrained),
        "lines": digest_lines(file.execute("SELECT geom, kind, name FROM lines ORDER BY fid")),
        "record": digest_arrays(*arrays.values(), text=text),
    }
    rows: list[tuple[str, str, str, Any]] = [
        ("digests", "json", "", json.dumps(digests).encode()),
        ("document", "json", "", text.encode()),
    ]
    for name, array in arrays.items():
        stored = array.astype(array.dtype.newbyteorder("<"), copy=False)
        shape = " ".join(map(str, stored.shape))
        rows.append((name, stored.dtype.str, shape, np.ascontiguousarray(stored).tobytes()))
    file.executemany(f"INSERT INTO {RECORD} (name, type, shape, data) VALUES (?, ?, ?, ?)", rows)


def _divide(count: int) -> Iterator[slice]:
    return (slice(start, min(start + _CHUNK, count)) for start in range(0, count, _CHUNK))


def _list_vertices(tin: TIN, srs: int, attributes: list[LayerColumn]) -> Iterator[list[Column]]:
    largest = [_find_largest(column.values) for column in attributes]
    for part in _divide(len(tin.points)):
        numbers = np.arange(part.start, part.stop)
        yield [
            make_blobs(make_points(tin.points[part], srs)),
            make_integers(numbers, len(tin.points)),
            *(
                _make_column(column.values[part], most)
                for column, most in zip(attributes, largest, strict=True)
            ),
        ]


def _find_largest(values: AnyArray | list[str | None]) -> int:
    """Return the largest of whole numbers, for which a negative one counts as its complement."""
    if isinstance(values, list) or values.dtype.kind == "f":
        return 0
    return max(int(values.max()), ~int(values.min()))


def _make_column(values: AnyArray | list[str | None], largest: int) -> Column:
    if isinstance(values, list):
        return make_texts(values)
    return make_reals(values) if values.dtype.kind == "f" else make_integers(values, largest)


def _list_numbers(tin: TIN) -> Iterator[list[Column]]:
    """Yield the vertices of triangles, and which edges are constrained."""
    flags = tin.constrained @ np.array([1, 2, 4], np.uint8)
    for part in _divide(len(tin.triangles)):
        columns = (make_integers(column, len(tin.points)) for column in tin.triangles[part].T)
        yield [*columns, make_integers(flags[part], 7)]


def _list_triangles(tin: TIN, srs: int, tell: Tell) -> Iterator[list[Column]]:
    try:
        slopes, aspects = slope(tin), aspect(tin)
    except CrsError:
        unknown = np.full(len(tin.triangles), np.nan)
        slopes, aspects = unknown, unknown
    for part, numbers in zip(_divide(len(tin.triangles)), _list_numbers(tin), strict=True):
        yield [
            make_blobs(make_triangles(tin.points[tin.triangles[part]], srs)),
            *numbers,
            make_reals(slopes[part]),
            make_reals(aspects[part]),
        ]
        tell(0.2 + 0.8 * part.stop / len(tin.triangles))
