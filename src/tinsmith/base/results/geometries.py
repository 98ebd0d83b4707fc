"""Features as geometries of shapely, of GeoPandas, and as Python's own values."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from .. import optional
from ..errors import OptionError
from .columns import unit_text

if TYPE_CHECKING:
    from ..arrays import AnyArray, ObjectArray
    from .features import Features


def build_geometries(features: Features) -> ObjectArray:
    """Return the geometries of shapely, one a feature."""
    shapely = optional.load("shapely")
    kind = shapely.GeometryType[features.geometry_type.upper()]
    levels: Any = features.offsets or None
    made: ObjectArray = shapely.from_ragged_array(kind, features.coordinates, levels)
    return made


def build_frame(features: Features) -> Any:
    """Return a GeoDataFrame of features, as :meth:`Features.to_geodataframe` describes it."""
    geopandas = optional.load("geopandas", "Turning features into a GeoDataFrame")
    if "geometry" in features.columns:
        raise OptionError(
            "column", "geometry", allowed="called otherwise, as a GeoDataFrame has one of that name"
        )
    frame = geopandas.GeoDataFrame(
        {name: values.copy() for name, values in features.columns.items()},
        geometry=build_geometries(features),
        crs=None if features.crs is None else features.crs.to_pyproj(),
    )
    frame.attrs |= {
        "name": features.name,
        "units": {name: unit_text(features.units, name) for name in features.units},
        "elevation_unit": None if features.elevation_unit is None else features.elevation_unit.name,
        "notes": list(features.notes),
    }
    return frame


def build_collection(features: Features) -> dict[str, Any]:
    """Return features as the ``__geo_interface__`` has them."""
    mapping = optional.load("shapely.geometry").mapping
    names = list(features.columns)
    columns = [_as_plain_values(values) for values in features.columns.values()]
    rows = zip(*columns, strict=True) if columns else [()] * len(features)
    return {
        "type": "FeatureCollection",
        "features": [
            {
                "type": "Feature",
                "properties": dict(zip(names, row, strict=True)),
                "geometry": mapping(geometry),
            }
            for row, geometry in zip(rows, build_geometries(features), strict=True)
        ],
    }


def _as_plain_values(values: AnyArray) -> list[Any]:
    """Return values of Python, None for NaN."""
    plain: list[Any] = values.tolist()
    if values.dtype.kind == "f" and np.isnan(values).any():
        return [None if value != value else value for value in plain]
    return plain
