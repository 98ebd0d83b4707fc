"""Features as a table of Arrow, with geometries as GeoArrow has them.

References
----------
GeoArrow format 0.2, https://geoarrow.org/format.html: native encodings, interleaved coordinates.
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import optional
from ..errors import OptionError
from .columns import UNKNOWN_UNIT, unit_text

if TYPE_CHECKING:
    from .features import Features

_GEOMETRY = "geometry"
_NESTING = {
    "Point": (),
    "LineString": ("vertices",),
    "MultiLineString": ("vertices", "linestrings"),
    "Polygon": ("vertices", "rings"),
    "MultiPolygon": ("vertices", "rings", "polygons"),
}
"""What the members of each level are called, from the coordinates up."""

_LARGEST_OFFSET = 2**31 - 1


def build_table(features: Features) -> Any:
    """Return a ``pyarrow.Table`` of the columns, and of the geometries in column ``geometry``.

    Raises MissingExtraError if pyarrow is not installed, OptionError if a column is called
    ``geometry``.
    """
    pa = optional.load("pyarrow", "Handing features over as Arrow")
    if _GEOMETRY in features.columns:
        raise OptionError(
            "column", _GEOMETRY, allowed="called otherwise: geometries have this name"
        )
    arrays = [pa.array(values) for values in features.columns.values()]
    fields = [
        pa.field(
            name,
            array.type,
            metadata={"unit": unit_text(features.units, name)} if name in features.units else None,
        )
        for name, array in zip(features.columns, arrays, strict=True)
    ]
    geometries = _build_geometries(pa, features)
    crs: dict[str, Any] = {}
    if features.crs is not None:
        crs = {"crs": features.crs.to_pyproj().to_json_dict(), "crs_type": "projjson"}
    extension = {  # what tells readers that a column has geometries, and their CRS
        "ARROW:extension:name": f"geoarrow.{features.geometry_type.lower()}",
        "ARROW:extension:metadata": json.dumps(crs),
    }
    fields.append(pa.field(_GEOMETRY, geometries.type, False, metadata=extension))
    about = {"name": features.name}
    if features.has_elevations:
        unit = features.elevation_unit
        about["elevation_unit"] = UNKNOWN_UNIT if unit is None else unit.name
    about["notes"] = json.dumps(list(features.notes))
    return pa.Table.from_arrays([*arrays, geometries], schema=pa.schema(fields, metadata=about))


def _build_geometries(pa: Any, features: Features) -> Any:
    """Return lists in lists of coordinates, with offsets of 32 bits where they fit."""
    size = features.coordinates.shape[1]
    names = _NESTING[features.geometry_type]
    built = pa.FixedSizeListArray.from_arrays(
        pa.array(features.coordinates.ravel()),
        type=pa.list_(pa.field("xyz"[:size], pa.float64(), False), size),
    )
    for name, offsets in zip(names, features.offsets, strict=True):
        member = pa.field(name, built.type, False)
        if offsets[-1] > _LARGEST_OFFSET:
            kind, numbers, array = pa.large_list(member), offsets, pa.LargeListArray
        else:
            kind, numbers, array = pa.list_(member), offsets.astype(np.int32), pa.ListArray
        built = array.from_arrays(pa.array(numbers), built, type=kind)
    return built
