"""Lines with elevations in GeoPackages, such as contours and breaklines. Needs no Blender."""

from __future__ import annotations

import re
import sqlite3
from contextlib import closing
from pathlib import Path
from typing import Any

import numpy as np

from .ply import Content, Line
from .reference import Reference, Refused, Unit

_HEADERS = {0: 8, 1: 40, 2: 56, 3: 56, 4: 72}
"""Bytes before the geometry, by the kind of its envelope (GeoPackage 1.3, table 6)."""
_WITH_Z = {1002: "line", 1005: "lines", 2**31 + 2: "line", 2**31 + 5: "lines"}
_ELEVATIONS = re.compile(r"Elevations in (.+)\.")
_METADATA = re.compile(r'<MDI key="elevation_unit">([^<]+)</MDI>')
_UNIT = re.compile(r'^UNIT\["([^"]+)",([-+0-9.eE]+)')


def read(path: Path) -> Content:
    """Read all layers of lines.

    Raises
    ------
    Refused
        If there are none, or they have no elevations; if their CRS or units are not one.
    """
    try:
        with closing(sqlite3.connect(f"{path.absolute().as_uri()}?mode=ro", uri=True)) as file:
            layers = file.execute(
                "SELECT table_name, column_name, srs_id FROM gpkg_geometry_columns WHERE "
                "geometry_type_name IN ('LINESTRING', 'MULTILINESTRING') ORDER BY table_name"
            ).fetchall()
            if not layers:
                raise Refused(f"'{path.name}' has no layer of lines.")
            found = {_read_reference(file, name, srs) for name, _, srs in layers}
            if len(found) != 1:
                raise Refused(f"The layers of '{path.name}' differ in CRS or units.")
            lines = [line for name, column, _ in layers for line in _read_layer(file, name, column)]
    except (sqlite3.Error, ValueError, TypeError, LookupError, AttributeError) as error:
        raise Refused(f"'{path.name}' is no GeoPackage that can be read: {error}.") from error
    if not lines:
        raise Refused(f"The layers of lines in '{path.name}' are empty.")
    return Content(found.pop(), lines=lines)


def _read_layer(file: sqlite3.Connection, name: str, column: str) -> list[Line]:
    table = _quote(name)
    columns = [one for _, one, *_ in file.execute(f"PRAGMA table_info({table})")]
    titles = [one for one in ("elevation", "name", "kind") if one in columns]
    asked = ", ".join(_quote(one) for one in (column, *titles))
    made = []
    for blob, *values in file.execute(f"SELECT {asked} FROM {table} ORDER BY rowid"):
        if blob is None:
            continue
        told = dict(zip(titles, values, strict=True))
        for points in parse_geometry(blob, name):
            title = told.get("name") or (
                f"{told['elevation']:g}" if isinstance(told.get("elevation"), float) else ""
            )
            made.append(Line(str(told.get("kind") or name), str(title), points))
    return made


def parse_geometry(blob: bytes, layer: str) -> list[Any]:
    """Return the lines of a geometry as (n, 3) float64 arrays."""
    try:
        if blob[:2] != b"GP":
            raise ValueError("no geometry of a GeoPackage")
        at = _HEADERS[(blob[3] >> 1) & 7]
        found, end = _parse_lines(blob, at, layer)
        if end != len(blob):
            raise ValueError("it is longer than it says")
    except (ValueError, LookupError) as error:
        raise Refused(f"A geometry of the layer '{layer}' is damaged ({error}).") from error
    return found


def _parse_lines(blob: bytes, at: int, layer: str) -> tuple[list[Any], int]:
    order = "<" if blob[at] else ">"
    kind, count = (int(one) for one in np.frombuffer(blob, f"{order}u4", 2, at + 1))
    at += 9
    if kind not in _WITH_Z:
        raise Refused(
            f"The layer '{layer}' has geometries without elevations, or that are no lines: drape "
            "them by 'tinsmith drape'."
        )
    if _WITH_Z[kind] == "line":
        points = np.frombuffer(blob, f"{order}f8", 3 * count, at).reshape(count, 3)
        if not np.isfinite(points).all():
            raise ValueError("coordinates that are no numbers")
        return [points.astype(np.float64)], at + 24 * count
    parts = []
    for _ in range(count):
        found, at = _parse_lines(blob, at, layer)
        parts += found
    return parts, at


def _read_reference(file: sqlite3.Connection, layer: str, srs: int) -> Reference:
    row = file.execute(
        "SELECT organization, organization_coordsys_id, definition FROM gpkg_spatial_ref_sys "
        "WHERE srs_id = ?",
        (srs,),
    ).fetchone()
    organization, code, wkt = row or ("NONE", srs, "")
    is_known = str(wkt).startswith(("PROJCS", "COMPD_CS"))
    if str(wkt).startswith("GEOGCS"):
        raise Refused(f"The layer '{layer}' is in degrees: reproject it by 'tinsmith convert'.")
    crs = str(wkt) if str(organization).upper() == "NONE" else f"{organization}:{code}"
    return Reference(
        crs if is_known else "",
        find_unit(wkt) if is_known else None,
        _find_elevation_unit(file, layer),
    )


def find_unit(wkt: str) -> Unit | None:
    """Return the unit of eastings and northings that WKT 1 tells: the one right inside PROJCS."""
    start, depth, is_quoted = wkt.find("PROJCS["), 0, False
    for at in range(max(start, 0), len(wkt)):
        letter = wkt[at]
        is_quoted ^= letter == '"'
        if is_quoted:
            continue
        depth += (letter == "[") - (letter == "]")
        found = _UNIT.match(wkt[at : at + 200]) if depth == 1 and letter == "U" else None
        if found:
            metres = float(found[2])
            return Unit.find(found[1]) or Unit(found[1], metres)
        if depth == 0 and letter == "]":
            break
    return None


def _find_elevation_unit(file: sqlite3.Connection, layer: str) -> Unit | None:
    (said,) = file.execute(
        "SELECT description FROM gpkg_contents WHERE table_name = ?", (layer,)
    ).fetchone() or ("",)
    found = _ELEVATIONS.fullmatch(said or "")
    if (
        found is None
        and file.execute(
            "SELECT 1 FROM sqlite_master WHERE name = 'gpkg_metadata_reference'"
        ).fetchone()
    ):
        rows = file.execute(
            "SELECT metadata FROM gpkg_metadata JOIN gpkg_metadata_reference ON id = md_file_id "
            "WHERE table_name = ?",
            (layer,),
        )
        found = next(filter(None, (_METADATA.search(text) for (text,) in rows)), None)
    return Unit.find(found[1]) if found else None


def _quote(name: str) -> str:
    return '"' + name.replace('"', '""') + '"'
