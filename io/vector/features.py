"""Features of a vector file through GDAL: geometries, columns and CRS, or one clear sentence.

Those of DXF drawings come through the reader of drawings: blocks, arcs and elevations too. Members
of a GeoJSON file are read of which GDAL does not tell: a CRS of ``null``, a unit of elevations.
"""

from __future__ import annotations

import json
import re
import sqlite3
import struct
from contextlib import closing
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...base import optional
from ...base.crs import CRS
from ...base.errors import OptionError, ReadError
from ...base.sentences import FILE, counted
from ...tin import TIN
from ..cad.dxf import ELEVATION_PROPERTY, UNKNOWN, ModelSpace, read_model_space
from ..cad.signatures import is_dxf, is_landxml
from ..isolated import (
    choose_limits,
    open_ordinary_file,
    require_local,
    run_isolated,
    translate_system_errors,
)
from ..registry import HEAD_BYTES, find_reference_kind
from .layers import Layer, name_apart, name_columns
from .signatures import is_parquet
from .well_known_binary import replace_surfaces

if TYPE_CHECKING:
    from pathlib import Path

    from ...base.arrays import AnyArray, Int64Array, ObjectArray
    from ...base.crs import CRS

_FOLDERS = (".gdb",)
"""Suffixes of formats that are folders."""

_DRAWING = ".dxf"
_PARQUET = (".parquet", ".geoparquet")
_ABOVE_GROUND = ("relativeToGround", "clampToGround", "relativeToSeaFloor", "clampToSeaFloor")
_SHAPEFILE = b"\x00\x00\x27\x0a"


def read_features(
    path: Path, *, layer: str | None = None, where: str | None = None, lines_only: bool = False
) -> Layer:
    """Read the features of one layer of a vector file that GDAL reads.

    Parameters
    ----------
    path : Path
    layer : str, optional
        Needed if several layers have geometry.
    where : str, optional
        Condition on the columns, as in SQL.
    lines_only : bool
        Leave the points and texts of a drawing aside, and refuse TINs.

    Raises
    ------
    MissingExtraError
        If pyogrio, or for a drawing ezdxf, is not installed.
    ReadError
        If the file or layer is missing, damaged, empty, or no vector file.
    """
    require_local(path)
    with open_ordinary_file(path) as local:
        features = _read_layer(local, layer, where, lines_only=lines_only)
    if local == path:
        return features
    notes = tuple(note.replace(local.name, path.name) for note in features.notes)
    return features._replace(path=path, notes=notes)


def _read_layer(path: Path, layer: str | None, where: str | None, *, lines_only: bool) -> Layer:
    if path.suffix.lower() not in (*_PARQUET, _DRAWING):
        optional.require("pyogrio", "Reading vector files")
    content = _require_whole_file(path)
    if is_dxf(content) or path.suffix.lower() == _DRAWING:
        return read_drawing_layer(path, layer=layer, where=where, lines_only=lines_only)
    if is_landxml(content):
        return _read_design(path, layer, where)
    library = "pyarrow" if is_parquet(content) else "pyogrio"
    optional.require(library, "Reading vector files")
    head = read_json_members(content, path)
    child = "parquet.child" if is_parquet(content) else "gdal_child"
    parts = [one for one in path.iterdir() if one.is_file()] if path.is_dir() else [path]
    size = sum(one.stat().st_size for one in parts)
    value, arrays = run_isolated(
        f"{__package__}.{child}:read_features",
        {"path": str(path.absolute()), "layer": layer, "where": where},
        path=path,
        limits=choose_limits(size),
    )
    if len(arrays["numbers"]) == 0:
        raise ReadError(f"{FILE} has no features{_describe_part(value['layer'], where)}.")
    crs = None if head.names_no_crs else CRS.of(value["crs"])
    in_metres = head.is_json and crs is not None and crs.is_geographic  # by RFC 7946
    unit = value["elevation_unit"] or head.elevation_unit or ("metre" if in_metres else "")
    return _drop_heights_above_ground(
        make_layer(path, value | {"elevation_unit": unit}, arrays, crs, has_surfaces=not lines_only)
    )


def make_layer(
    path: Path,
    value: dict[str, Any],
    arrays: dict[str, AnyArray],
    crs: CRS | None,
    *,
    has_surfaces: bool = True,
) -> Layer:
    """Return what a child read as a layer, without features that have no geometry."""
    columns = {}
    for k, name in enumerate(name_columns(value["names"])):
        texts = value["texts"].get(str(k))
        column = arrays[f"column {k}"] if texts is None else np.array(texts, object)
        columns[name] = column
    found = Layer(
        path,
        arrays["numbers"],
        _parse_shapes(arrays, has_surfaces=has_surfaces),
        columns,
        crs,
        tuple(value.get("notes", ())),
        tuple(name_apart(value["names"])),
        value["elevation_unit"] or "",
    )
    return _drop_without_geometry(found)


def _read_design(path: Path, layer: str | None, where: str | None) -> Layer:
    from ..cad.landxml import read

    if where is not None:
        raise OptionError("where", where, "None for LandXML, whose lines have no columns")
    found = read(path, surface=layer)
    lines = [] if isinstance(found, TIN) else [*found.breaklines]
    if isinstance(found, TIN) or not lines:
        what = "a surface" if isinstance(found, TIN) else "points"
        raise ReadError(f"{FILE} holds {what}, and no contours or breaklines.")
    shapely = optional.load("shapely")
    coords = [np.asarray(getattr(line, "coords", line)) for line in lines]
    shapes = np.empty(len(coords), object)
    shapes[:] = [shapely.LineString(one) for one in coords]
    names = np.array([getattr(line, "name", "") for line in lines], object)
    unit = "" if found.elevation_unit is None else found.elevation_unit.text
    numbers = np.arange(len(coords))
    return Layer(
        path, numbers, shapes, {"name": names}, found.crs, tuple(found.notes), ("name",), unit
    )


def _drop_heights_above_ground(features: Layer) -> Layer:
    """Leave heights of KML aside that are none above the sea: its altitude modes tell."""
    modes = features.find_column("altitudemode")
    if modes is None:
        return features
    shapely = optional.load("shapely")
    has_z = shapely.has_z(features.geometries)
    stated = np.array([str(mode or "") for mode in modes.tolist()], object)
    is_above_ground = np.isin(stated, _ABOVE_GROUND) & has_z
    silent = int((has_z & (stated == "")).sum())
    if silent:
        note = (
            f"'{features.path.name}': {counted(silent, 'feature')} with heights and without an "
            "altitudeMode, for which KML ignores them: they are taken as elevations."
        )
        features = features._replace(notes=(*features.notes, note))
    if not is_above_ground.any():
        return features
    shapes = features.geometries.copy()
    shapes[is_above_ground] = shapely.force_2d(shapes[is_above_ground])
    named = sorted(set(stated[is_above_ground].tolist()))
    note = (
        f"'{features.path.name}': heights of {counted(int(is_above_ground.sum()), 'feature')} are "
        f"no elevations, by their altitudeMode {' and '.join(named)}, and are left out."
    )
    return features._replace(geometries=shapes, notes=(*features.notes, note))


def _require_whole_file(path: Path) -> bytes:
    """Return the first bytes; refuse a file that is missing, empty, or a shapefile cut short."""
    with translate_system_errors(path):
        if path.is_dir():
            if path.suffix.lower() in _FOLDERS:
                return b""
            raise ReadError(f"{FILE} is a folder: name a file in it.")
        size = path.stat().st_size
        with path.open("rb") as file:
            head = file.read(HEAD_BYTES)
    if size == 0:
        raise ReadError(f"{FILE} is empty: there are no lines in it.")
    kind = find_reference_kind(head)
    if kind is not None:
        raise ReadError(f"{FILE} is {kind}: only files of lines themselves are read.")
    if head.startswith(_SHAPEFILE) and len(head) >= 28:
        (words,) = struct.unpack(">i", head[24:28])  # the length is counted in 16-bit words
        if size < 2 * words:
            raise ReadError(f"{FILE} is cut short: it has {size} of {2 * words} bytes.")
    if head.startswith(_SHAPEFILE):
        _require_index(path)
    return head


def _require_index(path: Path) -> None:
    """Refuse a shapefile without the part that tells where its features are."""
    if path.suffix.lower() == ".shp" and not any(
        path.with_suffix(one).exists() for one in (".shx", ".SHX")
    ):
        raise ReadError(
            f"{FILE} lacks its part '{path.with_suffix('.shx').name}', without which GDAL does "
            "not read it: put it beside, or let QGIS repair the file."
        )


def _describe_part(layer: str, where: str | None) -> str:
    return f" in layer '{layer}'" if where is None else f" where {where}"


def _parse_shapes(arrays: dict[str, AnyArray], *, has_surfaces: bool) -> ObjectArray:
    """Return geometries of shapely; TINs and the like as polygons where surfaces may be."""
    shapely = optional.load("shapely")
    wkb, lengths = arrays["wkb"].tobytes(), arrays["lengths"]
    ends = np.cumsum(np.maximum(lengths, 0))
    parts = zip((ends - np.maximum(lengths, 0)).tolist(), ends.tolist(), strict=True)
    geometries = np.array([wkb[start:end] or None for start, end in parts], object)
    with np.errstate(invalid="ignore"):  # what is not finite is refused later
        shapes: ObjectArray = shapely.from_wkb(geometries, on_invalid="ignore")
        wrong = shapely.is_missing(shapes) & (lengths >= 0)
        if has_surfaces and wrong.any():  # GEOS knows no TINs
            polygons = np.array([replace_surfaces(one) for one in geometries[wrong]], object)
            shapes[wrong] = shapely.from_wkb(polygons, on_invalid="ignore")
            wrong = shapely.is_missing(shapes) & (lengths >= 0)
    if wrong.any():
        raise ReadError(
            f"feature {arrays['numbers'][np.argmax(wrong)]} has a geometry of another "
            "kind: lines or polygons are needed."
        )
    return shapes


def _drop_without_geometry(features: Layer) -> Layer:
    shapely = optional.load("shapely")
    is_empty = shapely.is_missing(features.geometries) | shapely.is_empty(features.geometries)
    if not is_empty.any():
        return features
    if is_empty.all():
        raise ReadError(f"of {counted(len(is_empty), 'feature')}, none has a geometry.")
    count, first = int(is_empty.sum()), features.numbers[np.argmax(is_empty)]
    have = "feature has" if count == 1 else "features have"
    return features._replace(
        numbers=features.numbers[~is_empty],
        geometries=features.geometries[~is_empty],
        columns={name: column[~is_empty] for name, column in features.columns.items()},
        notes=(
            *features.notes,
            f"'{features.path.name}': {count} {have} no geometry (first: {first}).",
        ),
    )


_TAIL = 4096
_NO_CRS = re.compile(rb'"crs"\s*:\s*null')
_UNIT = re.compile(rb'"elevation_unit"\s*:\s*("(?:[^"\\\\]|\\\\.){0,200}")')
_FEATURES = re.compile(rb'"features"\s*:')


class Members(NamedTuple):
    """What a file says beside its features."""

    names_no_crs: bool = False
    """Whether it says that its CRS is not known, by the rule of 2008."""
    elevation_unit: str = ""
    """Empty if it names none."""
    is_json: bool = False


def read_json_members(head: bytes, path: Path) -> Members:
    """Look for members before and behind the features.

    Parameters
    ----------
    head : bytes
        The first bytes of the file; nothing is looked for in a file that is no JSON.
    path : Path
    """
    if not head.lstrip(b"\xef\xbb\xbf\x1e \t\r\n").startswith(b"{"):
        return Members()
    found = _FEATURES.search(head)
    around = head[: found.start()] if found else head
    with path.open("rb") as file:
        size = file.seek(0, 2)
        file.seek(max(0, size - _TAIL))
        tail = file.read().rpartition(b"]")[2]
    around += b"," + tail
    unit = _UNIT.search(around)
    stated = _decode(unit.group(1)) if unit else ""
    return Members(_NO_CRS.search(around) is not None, stated, True)


def _decode(text: bytes) -> str:
    try:
        return str(json.loads(text))
    except ValueError:
        return ""


_WHOLE = "entities"
"""What GDAL calls the one layer that it takes a drawing for."""

_MOST_STEPS = 1_000_000


def read_drawing_layer(
    path: Path, *, layer: str | None, where: str | None, lines_only: bool
) -> Layer:
    """Read the lines of a drawing, and its points unless they are not wanted.

    Parameters
    ----------
    path : Path
    layer : str, optional
        Names or patterns of layers, with commas between.
    where : str, optional
        Condition on the columns ``layer``, ``name`` and ``kind``, as in SQL.
    lines_only : bool

    Returns
    -------
    Layer
        With these columns; lines of plane entities without elevation have none.

    Raises
    ------
    MissingExtraError
        If ezdxf is not installed.
    ReadError
        If the file is damaged, there is nothing in it, or the condition is none.
    """
    try:
        drawing = read_model_space(path, layer=None if layer == _WHOLE else layer)
    except OptionError as error:
        raise ReadError(
            f"{FILE} has no layer '{layer}' with lines: there must be {error.allowed}."
        ) from error
    shapely = optional.load("shapely")
    shapes = [shapely.LineString(rows) for rows in drawing.lines]
    layers = drawing.arrays["line_layers"].tolist()
    stated = drawing.value["line_names"] or [[]] * len(shapes)
    stated = [[*one, "", ""][:2] for one in stated]
    if not lines_only:
        points = drawing.arrays["points"]
        shapes += list(shapely.points(points)) if len(points) else []
        layers += drawing.arrays["point_layers"].tolist()
        stated += [["", ""]] * len(points)
    texts = {
        "layer": [drawing.value["layers"][k] for k in layers],
        "name": [name for _, name in stated],
        "kind": [kind if kind in ("hard", "soft") else "" for kind, _ in stated],
    }
    packed = np.empty(len(shapes), object)
    packed[:] = shapes
    columns = {name: np.array(column, object) for name, column in texts.items()}
    called, arrays = drawing.path.name, drawing.arrays
    rest = [counted(len(arrays["faces"]), "face")] if len(arrays["faces"]) else []
    if lines_only and len(arrays["points"]):
        rest.append(counted(len(arrays["points"]), "point"))
    notes = [f"'{called}': not read: {' and '.join(rest)}."] if rest else []
    notes += [f"'{called}': {note}" for note in drawing.describe_left_out()]
    unit = drawing.stated.unit
    if unit is not None:
        notes.append(f"'{called}': coordinates are taken as they are, $INSUNITS says {unit.name}.")
    kept = np.arange(len(packed)) if where is None else _select_rows(columns, where)
    if len(kept) == 0:
        part = f" where {where}" if where is not None else " that are lines" * lines_only
        raise ReadError(f"{FILE} has no features{part}.")
    return Layer(
        path,
        kept,
        packed[kept],
        {name: column[kept] for name, column in columns.items()},
        drawing.stated.crs,
        tuple(notes),
        elevation_unit=_find_elevation_unit(drawing),
    )


def _find_elevation_unit(drawing: ModelSpace) -> str:
    crs, unit = drawing.stated.crs, drawing.stated.unit
    if crs is None or unit is None or crs.horizontal_unit != unit:
        return ""
    return "" if dict(drawing.value["properties"]).get(ELEVATION_PROPERTY) == UNKNOWN else unit.text


def _select_rows(columns: dict[str, AnyArray], where: str) -> Int64Array:
    """Return the rows that a condition chooses, by SQLite on a table in memory."""
    names = ", ".join(columns)
    rows = zip(*(column.tolist() for column in columns.values()), strict=True)
    with closing(sqlite3.connect(":memory:")) as base:
        base.execute(f"CREATE TABLE drawing ({names})")
        marks = ", ".join("?" * len(columns))
        base.executemany(f"INSERT INTO drawing VALUES ({marks})", rows)
        base.set_progress_handler(lambda: 1, _MOST_STEPS * 100)
        try:
            found = base.execute(f"SELECT rowid FROM drawing WHERE ({where}) ORDER BY rowid")
            return np.array([row[0] - 1 for row in found], np.int64)
        except (sqlite3.Error, sqlite3.Warning) as error:
            raise ReadError(
                f"the condition {where!r} is none on the columns {names}: {error}."
            ) from error
