"""GeoParquet 1.1: features as a table with a column of geometries.

References
----------
GeoParquet Specification 1.1.0 (2024), https://geoparquet.org.
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base import optional
from ...base.atomic import replacing_path
from ...base.errors import WriteError
from ...base.sentences import FILE
from .ogr import describe, encode_geometries
from .surface_features import make_features
from .well_known_binary import encode_equal_shapes

if TYPE_CHECKING:
    from pathlib import Path

    from ...base.arrays import AnyArray
    from ...base.policies import FeatureKind
    from ...base.results import Features
    from .surface_features import Writable

_GEOMETRY = "geometry"
_GROUP_ROWS = 65_536
_MOST_BYTES = 2**31 - 1
"""What the offsets of one column of Arrow reach."""


def write(surface: Writable, path: Path, *, kind: FeatureKind | None = None) -> None:
    """Write a kind of parts of a surface, or features, as GeoParquet, as well-known binary.

    Parameters
    ----------
    kind : {"triangles", "points", "edges", "lines", "hull"}, optional
        Of a TIN; default triangles.

    Raises
    ------
    MissingExtraError
        If pyarrow is not installed.
    WriteError
        If the file cannot be written, or a column is called ``geometry``.

    Notes
    -----
    Coordinates and numbers are the same. The CRS is PROJJSON, ``null`` if it is not known; units
    and notes are metadata of the file.
    """
    features = make_features(surface, kind)
    pyarrow = optional.load("pyarrow", f"Writing {FILE}")
    parquet = optional.load("pyarrow.parquet", f"Writing {FILE}")
    if _GEOMETRY in features.columns:
        raise WriteError(
            f"Cannot write {FILE}: a column '{_GEOMETRY}' is GeoParquet's own: rename it."
        )
    columns = {name: _make_column(pyarrow, values) for name, values in features.columns.items()}
    equal = encode_equal_shapes(features)
    if equal is None or equal.nbytes > _MOST_BYTES:
        columns[_GEOMETRY] = pyarrow.array(encode_geometries(features), pyarrow.binary())
    else:
        size = equal.dtype.itemsize
        offsets = np.arange(0, equal.nbytes + 1, size, dtype=np.int32)
        buffers = [None, pyarrow.py_buffer(offsets), pyarrow.py_buffer(equal.view(np.uint8))]
        columns[_GEOMETRY] = pyarrow.Array.from_buffers(pyarrow.binary(), len(equal), buffers)
    table = pyarrow.table(columns)
    metadata = {"geo": json.dumps(_describe_geometry(features)), **describe(features)}
    with replacing_path(path) as new:
        parquet.write_table(
            table.replace_schema_metadata(metadata), new, row_group_size=_GROUP_ROWS
        )


def _make_column(pyarrow: Any, values: AnyArray) -> Any:
    """Return a column of Arrow; texts and gaps as they are."""
    if values.dtype.kind in "OU":
        return pyarrow.array(values.tolist(), pyarrow.string())
    return pyarrow.array(np.ascontiguousarray(values))


def _describe_geometry(features: Features) -> dict[str, Any]:
    kind = features.geometry_type + (" Z" if features.has_elevations else "")
    crs = None if features.crs is None else json.loads(features.crs.to_pyproj().to_json())
    column: dict[str, Any] = {"encoding": "WKB", "geometry_types": [kind], "crs": crs}
    if len(features.coordinates):
        low, high = features.coordinates.min(axis=0), features.coordinates.max(axis=0)
        if np.isfinite([*low, *high]).all():
            column["bbox"] = [*low.tolist(), *high.tolist()]
    return {"version": "1.1.0", "primary_column": _GEOMETRY, "columns": {_GEOMETRY: column}}
