"""Features of a vector file through GDAL: geometries, columns and CRS, or one clear sentence."""

from __future__ import annotations

import struct
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base import optional
from ...base.crs import CRS
from ...base.errors import OptionError, ReadError
from ...base.sentences import FILE, counted
from ...tin import TIN
from ..cad.signatures import is_dxf, is_landxml
from ..isolated import choose_limits, run_isolated
from ..isolated.spooling import open_ordinary_file, require_local, translate_system_errors
from ..registry.signatures import HEAD_BYTES, find_reference_kind
from .drawings import read_drawing_layer
from .geojson.members import read_json_members
from .layers import Layer, name_apart, name_columns
from .signatures import is_parquet
from .well_known_binary import replace_surfaces

if TYPE_CHECKING:
    from pathlib import Path

    from ...base.arrays import AnyArray, ObjectArray
    from ...base.crs import CRS


__all__ = ["read_features"]


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
    child = "parquet_child" if is_parquet(content) else "gdal_child"
    value, arrays = run_isolated(
        f"{__package__}.{child}:read_features",
        {"path": str(path.absolute()), "layer": layer, "where": where},
        path=path,
        limits=choose_limits(_measure_folder(path)),
    )
    if len(arrays["numbers"]) == 0:
        raise ReadError(f"{FILE} has no features{_describe_part(value['layer'], where)}.")
    crs = None if head.names_no_crs else CRS.of(value["crs"])
    in_metres = head.is_json and crs is not None and crs.is_geographic  # by RFC 7946
    unit = value["elevation_unit"] or head.elevation_unit or ("metre" if in_metres else "")
    found = Layer(
        path,
        arrays["numbers"],
        _parse_shapes(arrays, has_surfaces=not lines_only),
        _decode_columns(value, arrays),
        crs,
        tuple(value.get("notes", ())),
        tuple(name_apart(value["names"])),
        unit,
    )
    return _drop_heights_above_ground(_drop_without_geometry(found))


def _read_design(path: Path, layer: str | None, where: str | None) -> Layer:
    """Read the lines of a LandXML file: contours and breaklines."""
    from ..cad.landxml.reading import read

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


def _decode_columns(value: dict[str, Any], arrays: dict[str, AnyArray]) -> dict[str, AnyArray]:
    """Return the columns by their names in lower case, see :func:`name_columns`."""
    columns = {}
    for k, name in enumerate(name_columns(value["names"])):
        texts = value["texts"].get(str(k))
        column = arrays[f"column {k}"] if texts is None else np.array(texts, object)
        columns[name] = column
    return columns


def _measure_folder(path: Path) -> int:
    """Return the bytes of a file, or of all files of a format that is a folder."""
    if not path.is_dir():
        return path.stat().st_size
    return sum(file.stat().st_size for file in path.iterdir() if file.is_file())


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
    """Leave out the features that have no geometry, and note them."""
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
