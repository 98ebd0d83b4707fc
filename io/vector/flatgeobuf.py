"""FlatGeobuf: features as one layer with a spatial index."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..._atomic import replacing_files
from .ogr import describe, write_layer

if TYPE_CHECKING:
    from pathlib import Path

    from ...terrain.results import Features

__all__ = ["write"]


def write(features: Features, path: Path) -> None:
    """Write features as FlatGeobuf, named after the product.

    Parameters and errors are those of every writer, see :class:`.Format`.

    Notes
    -----
    Coordinates and numbers are the same float64. Features stand in the order of the spatial index,
    not in their own. Units of columns and of elevations, and notes, are metadata of the layer.
    """
    with replacing_files(path) as new:
        write_layer(features, new, path, driver="FlatGeobuf", metadata=describe(features))
