"""Features of a GeoParquet file through pyarrow, as the child process reads them."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any

import numpy as np

from ....base import optional
from ....base.sentences import FILE
from ...isolated import Answer, Refusal
from ..gdal_child import convert_to_texts, is_numeric, pack_geometries

ENVIRONMENT = {"ARROW_DEFAULT_MEMORY_POOL": "system", "OMP_NUM_THREADS": "1"}

_DEGREES = "OGC:CRS84"
"""CRS of a file that does not speak of it, by the specification."""

_WIDEST = 20
"""Columns of coordinates that a native encoding of points may have; x, y, z, m."""


def prepare() -> None:
    """Load the library."""
    import pyarrow.parquet  # noqa: F401 - loaded here, before memory is limited


def read_features(path: str, *, layer: str | None, where: str | None) -> Answer:
    """Return the features of a file, as :func:`gdal_child.read_features` does."""
    file = _open(path, where)
    return _pack(file, file.read(use_threads=False), layer, 0)


def _open(path: str, where: str | None) -> Any:
    from pyarrow import parquet

    if where is not None:
        raise Refusal(f"{FILE} is GeoParquet, which the option `where` does not choose from.")
    return parquet.ParquetFile(path, memory_map=False, pre_buffer=False)


def read_groups(
    path: str, *, layer: str | None, where: str | None, groups: list[int] | None
) -> Iterator[Answer]:
    """Yield the features of groups of rows, all by default, as :func:`read_features` does."""
    file = _open(path, where)
    first = 0
    for number in range(file.num_row_groups):
        count = file.metadata.row_group(number).num_rows
        if groups is None or number in groups:
            yield _pack(file, file.read_row_group(number, use_threads=False), layer, first)
        first += count


def read_statistics(path: str, *, layer: str | None, where: str | None) -> Answer:
    """Return what the metadata of a file say: rows, CRS, bounds, and those of groups of rows.

    The array ``boxes``, (n, 4), has NaN for groups whose bounds are not told.
    """
    file = _open(path, where)
    metadata = file.schema_arrow.metadata or {}
    name, column = _find_geometry(metadata)
    _require_layer(layer, name)
    box = column.get("bbox")
    groups = [file.metadata.row_group(k) for k in range(file.num_row_groups)]
    sides = _name_sides(name, column)
    boxes = np.array([_find_box(one, sides) for one in groups], np.float64).reshape(-1, 4)
    value = {
        "layer": name,
        "count": int(file.metadata.num_rows),
        "crs": _find_crs(column),
        "bbox": [float(one) for one in box] if isinstance(box, list) else None,
        "elevation_unit": _find_unit(metadata),
    }
    return Answer(value, {"boxes": boxes})


def _name_sides(name: str, column: dict[str, Any]) -> list[str]:
    """Return the columns that hold west, south, east and north of each geometry."""
    if str(column.get("encoding", "")).lower() == "point":
        return [f"{name}.{axis}" for axis in "xyxy"]
    try:
        sides = column["covering"]["bbox"]
        return [".".join(sides[side]) for side in ("xmin", "ymin", "xmax", "ymax")]
    except (KeyError, TypeError):
        return []


def _find_box(group: Any, sides: list[str]) -> list[float]:
    """Return the bounds of a group of rows by the statistics of columns."""
    columns = [group.column(k) for k in range(group.num_columns)]
    known = {one.path_in_schema: one.statistics for one in columns if one.is_stats_set}
    found = [one for one in map(known.get, sides) if one is not None and one.has_min_max]
    if len(found) != 4:
        return [float("nan")] * 4
    return [float(one.min) for one in found[:2]] + [float(one.max) for one in found[2:]]


def _require_layer(layer: str | None, name: str) -> None:
    if layer not in (None, name):
        raise Refusal(f"{FILE} has no layer '{layer}': there is {name}.")


def _find_unit(metadata: dict[bytes, bytes]) -> str | None:
    return metadata.get(b"elevation_unit", b"").decode("utf-8", "replace") or None


def _pack(file: Any, table: Any, layer: str | None, first: int) -> Answer:
    """Return rows of a table as features, numbered from the first of them on."""
    metadata = file.schema_arrow.metadata or {}
    name, column = _find_geometry(metadata)
    _require_layer(layer, name)
    geometries = _encode(table.column(name), column)
    names = [one for one in table.column_names if one != name and _is_flat(table, one)]
    values = [_as_array(table.column(one)) for one in names]
    arrays = {"numbers": np.arange(len(geometries)) + first, **pack_geometries(geometries)}
    arrays |= {f"column {k}": one for k, one in enumerate(values) if is_numeric(one)}
    texts = {str(k): convert_to_texts(one) for k, one in enumerate(values) if not is_numeric(one)}
    value = {"layer": name, "crs": _find_crs(column), "names": names, "texts": texts}
    return Answer(value | {"elevation_unit": _find_unit(metadata)}, arrays)


def _find_geometry(metadata: dict[bytes, bytes]) -> tuple[str, dict[str, Any]]:
    """Return the name of the column of geometries and what is said of it."""
    try:
        geo = json.loads(metadata[b"geo"])
        name = str(geo["primary_column"])
        return name, dict(geo["columns"][name])
    except (KeyError, ValueError, TypeError) as error:
        raise Refusal(
            f"{FILE} is Parquet without a column of geometries that its metadata tell of."
        ) from error


def _find_crs(column: dict[str, Any]) -> str | None:
    if "crs" not in column:
        return _DEGREES
    crs = column["crs"]
    return None if crs is None else crs if isinstance(crs, str) else json.dumps(crs)


def _encode(values: Any, column: dict[str, Any]) -> list[bytes | None]:
    """Return geometries as well-known binary."""
    encoding = str(column.get("encoding", "")).lower()
    if encoding == "wkb":
        found: list[bytes | None] = values.to_pylist()
        if all(one is None or isinstance(one, bytes) for one in found):
            return found
    if encoding == "point":
        return _encode_points(values.combine_chunks())
    raise Refusal(
        f"{FILE} has geometries of the encoding '{encoding[:_WIDEST]}': WKB and point are read."
    )


def _encode_points(values: Any) -> list[bytes | None]:
    shapely = optional.load("shapely")
    names = [axis for axis in "xyz" if values.type.get_field_index(axis) >= 0]
    xyz = np.stack([np.asarray(values.field(axis), np.float64) for axis in names], axis=1)
    points = shapely.to_wkb(shapely.points(xyz), flavor="iso")
    gaps = np.asarray(values.is_null())
    return [None if gap else one for one, gap in zip(points.tolist(), gaps.tolist(), strict=True)]


def _is_flat(table: Any, name: str) -> bool:
    """Whether a column holds single values: boxes of geometries are none."""
    import pyarrow as pa

    return not pa.types.is_nested(table.schema.field(name).type)


def _as_array(values: Any) -> Any:
    """Return a column as numbers, NaN for gaps, or as Python's values."""
    import pyarrow as pa

    kind = values.type
    if pa.types.is_floating(kind) or (
        (pa.types.is_integer(kind) or pa.types.is_boolean(kind)) and not values.null_count
    ):
        return values.combine_chunks().to_numpy(zero_copy_only=False)
    if pa.types.is_integer(kind):
        return np.array([np.nan if one is None else one for one in values.to_pylist()], np.float64)
    return np.array([*values.to_pylist(), None], object)[:-1]
