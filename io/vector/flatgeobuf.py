"""FlatGeobuf: features as one layer with a spatial index."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ...base.atomic import replacing_files
from .ogr import describe, write_layer

if TYPE_CHECKING:
    from pathlib import Path

    from ...base.results import Features

__all__ = ["write"]


def write(features: Features, path: Path, *, has_index: bool = True) -> None:
    """Write features as FlatGeobuf, named after the product.

    A spatial index gives features another order; without one they stand in their own. Coordinates
    and numbers are the same float64. Units of columns and of elevations, and notes, are metadata of
    the layer.
    """
    how: dict[str, Any] = {} if has_index else {"SPATIAL_INDEX": "NO"}
    with replacing_files(path) as new:
        write_layer(features, new, path, driver="FlatGeobuf", metadata=describe(features), **how)
