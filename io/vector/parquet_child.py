"""Features of a GeoParquet file through pyarrow, as the child process reads them."""

from __future__ import annotations

import json
from typing import Any

import numpy as np

from ...base import optional
from ...base.sentences import FILE
from ..isolated import Answer, Refusal
from .gdal_child import convert_to_texts, is_numeric, pack_geometries

__all__ = ["ENVIRONMENT", "prepare", "read_features"]

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
    from pyarrow import parquet

    if where is not None:
        raise Refusal(f"{FILE} is GeoParquet, which the option `where` does not choose from.")
    file = parquet.ParquetFile(path, memory_map=False, pre_buffer=False)
    metadata = file.schema_arrow.metadata or {}
    try:
        geo = json.loads(metadata[b"geo"])
        name = str(geo["primary_column"])
        column = dict(geo["columns"][name])
    except (KeyError, ValueError, TypeError) as error:
        raise Refusal(
            f"{FILE} is Parquet without a column of geometries that its metadata tell of."
        ) from error
    if layer not in (None, name):
        raise Refusal(f"{FILE} has no layer '{layer}': there is {name}.")
    table = file.read(use_threads=False)
    geometries = _encode(table.column(name), column)
    names = [one for one in table.column_names if one != name and _is_flat(table, one)]
    values = [_as_array(table.column(one)) for one in names]
    arrays = {"numbers": np.arange(len(geometries)), **pack_geometries(geometries)}
    arrays |= {f"column {k}": one for k, one in enumerate(values) if is_numeric(one)}
    texts = {str(k): convert_to_texts(one) for k, one in enumerate(values) if not is_numeric(one)}
    crs = column.get("crs", _DEGREES)
    if not (crs is None or isinstance(crs, str)):
        crs = json.dumps(crs)
    value = {"layer": name, "crs": crs, "names": names, "texts": texts}
    unit = metadata.get(b"elevation_unit", b"").decode("utf-8", "replace")
    return Answer(value | {"elevation_unit": unit or None}, arrays)


def _encode(values: Any, column: dict[str, Any]) -> list[bytes | None]:
    """Return geometries as well-known binary."""
    encoding = str(column.get("encoding", "")).lower()
    if encoding == "wkb":
        found: list[bytes | None] = values.to_pylist()
        if all(one is None or isinstance(one, bytes) for one in found):
            return found
    if encoding == "point":
        merged = values.combine_chunks()
        shapely = optional.load("shapely")
        names = [axis for axis in "xyz" if merged.type.get_field_index(axis) >= 0]
        xyz = np.stack([np.asarray(merged.field(axis), np.float64) for axis in names], axis=1)
        points = shapely.to_wkb(shapely.points(xyz), flavor="iso")
        gaps = np.asarray(merged.is_null())
        return [
            None if gap else one for one, gap in zip(points.tolist(), gaps.tolist(), strict=True)
        ]
    raise Refusal(
        f"{FILE} has geometries of the encoding '{encoding[:_WIDEST]}': WKB and point are read."
    )


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
