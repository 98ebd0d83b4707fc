"""Write a TIN as a GeoPackage, by SQLite alone."""

from __future__ import annotations

import json
import sqlite3
from contextlib import closing
from itertools import islice
from typing import TYPE_CHECKING, Any

import numpy as np

from ....base.checks import as_flag
from ....base.errors import CrsError, WriteError
from ....base.sentences import FILE
from ....terrain.relief.gradients import aspect, slope
from ..common import format_unit, require_tin
from .containers import Placing, adding_layers
from .records import describe_layer_columns, pack_tin
from .schema import (
    APPLICATION_ID,
    LAYERS,
    NO_CLOCK,
    RECORD,
    TABLES,
    USER_VERSION,
    describe_crs,
    digest_arrays,
    digest_lines,
    make_chain_blobs,
    make_point_blobs,
    make_triangle_blobs,
)

if TYPE_CHECKING:
    from pathlib import Path

    from ....base.progress import Tell
    from ....tin import TIN

_CHUNK = 1 << 16
"""Triangles in memory at a time, as geometries."""

_PAGE = 1 << 15
"""Bytes of a page: a fifth faster than SQLite's own 4096, and all names of tables in the first."""


def write(
    surface: TIN, path: Path, *, overwrite: bool = False, progress: Tell | None = None
) -> None:
    """Write all that a TIN is as a GeoPackage; :func:`read` gives it back, bit for bit.

    Parameters
    ----------
    overwrite : bool
        Replace layers of the names below that another program wrote or changed.

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
    of a file that is there already stay as they are.
    """
    tin = require_tin(surface, format_name="a GeoPackage of a TIN")
    with adding_layers(path, Placing(overwrite=as_flag("overwrite", overwrite))) as beside:
        try:
            with closing(sqlite3.connect(beside, isolation_level=None)) as file:
                _write_content(file, tin, progress or (lambda _: None))
        except sqlite3.Error as error:
            raise WriteError(f"Cannot write {FILE}: {error}.") from error


def _write_content(file: sqlite3.Connection, tin: TIN, progress: Tell) -> None:
    file.execute("PRAGMA journal_mode = OFF")  # the file takes its place when it is complete
    file.execute("PRAGMA synchronous = OFF")
    file.execute(f"PRAGMA page_size = {_PAGE}")
    file.execute(f"PRAGMA application_id = {APPLICATION_ID}")
    file.execute(f"PRAGMA user_version = {USER_VERSION}")
    file.execute("BEGIN")
    for table in TABLES:
        file.execute(table)
    srs = _write_contents(file, tin)
    _write_lines(file, tin, srs)
    _write_record(file, tin)
    columns = describe_layer_columns(tin.attributes, ("fid", "geom", "vertex"))
    for declaration, _ in columns:
        file.execute(f"ALTER TABLE vertices ADD COLUMN {declaration}")
    values = [iter(column) for _, column in columns]
    marks = ", ".join("?" * (3 + len(columns)))
    for start in range(0, len(tin.points), _CHUNK):
        points = tin.points[start : start + _CHUNK]
        numbers = range(start, start + len(points))
        blobs = make_point_blobs(points, srs)
        parts = [islice(column, len(points)) for column in values]
        file.executemany(
            f"INSERT INTO vertices VALUES ({marks})",
            zip(range(start + 1, start + len(points) + 1), blobs, numbers, *parts, strict=True),
        )
    progress(0.2)
    _write_triangles(file, tin, srs, progress)
    file.execute("COMMIT")
    progress(1.0)


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


def _write_triangles(file: sqlite3.Connection, tin: TIN, srs: int, progress: Tell) -> None:
    try:
        slopes, aspects = slope(tin), aspect(tin)
    except CrsError:
        unknown = np.full(len(tin.triangles), np.nan)
        slopes, aspects = unknown, unknown
    flags = tin.constrained @ np.array([1, 2, 4], np.uint8)
    for start in range(0, len(tin.triangles), _CHUNK):
        part = slice(start, start + _CHUNK)
        corners = tin.triangles[part]
        columns = [*corners.T, flags[part], slopes[part], aspects[part]]
        file.executemany(
            "INSERT INTO triangles VALUES (?, ?, ?, ?, ?, ?, ?, ?)",
            zip(
                range(start + 1, start + len(corners) + 1),
                make_triangle_blobs(tin.points[corners], srs),
                *(column.tolist() for column in columns),
                strict=True,
            ),
        )
        progress(0.2 + 0.8 * (start + len(corners)) / len(tin.triangles))
