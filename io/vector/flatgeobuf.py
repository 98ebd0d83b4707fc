"""FlatGeobuf: features as one layer with a spatial index."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ...base.atomic import replacing_files
from ...tin import Survey
from .ogr import describe, write_layer
from .surface_features import make_features

if TYPE_CHECKING:
    from pathlib import Path

    from ...base.policies import FeatureKind
    from .surface_features import Writable

__all__ = ["write"]


def write(surface: Writable, path: Path, *, kind: FeatureKind | None = None) -> None:
    """Write a kind of parts of a surface, or features, as FlatGeobuf, named after the product.

    A spatial index gives features another order; points of a survey have none and stand in their
    own. Coordinates and numbers are the same float64. Units of columns and of elevations, and
    notes, are metadata of the layer.

    Parameters
    ----------
    kind : {"triangles", "points", "edges", "lines", "hull"}, optional
        Of a TIN; default triangles.
    """
    features = make_features(surface, kind)
    how: dict[str, Any] = {"SPATIAL_INDEX": "NO"} if isinstance(surface, Survey) else {}
    with replacing_files(path) as new:
        write_layer(features, new, path, driver="FlatGeobuf", metadata=describe(features), **how)
