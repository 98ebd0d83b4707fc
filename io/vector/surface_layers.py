"""TINs, surveys and features as layers of the formats of GIS: one kind of geometry a file."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...tin import Survey
from . import flatgeobuf, geopackage, shapefile
from .surface_features import make_features

if TYPE_CHECKING:
    from pathlib import Path
    from typing import TypeAlias

    from ...policies import FeatureKind
    from ...terrain.results import Features
    from ...tin import TIN

    Writable: TypeAlias = TIN | Survey | Features

__all__ = [
    "write_flatgeobuf",
    "write_geojson_sequence",
    "write_geopackage",
    "write_geoparquet",
    "write_shapefile",
]


def write_geopackage(surface: Features | Survey, path: Path) -> None:
    """Write features, or the points of a survey, as :func:`geopackage.write` does."""
    geopackage.write(make_features(surface, path, None), path)


def write_flatgeobuf(surface: Writable, path: Path, *, kind: FeatureKind | None = None) -> None:
    """Write a kind of parts of a surface, or features, as :func:`flatgeobuf.write` does.

    Parameters
    ----------
    surface : TIN, Survey or Features
    path : Path
    kind : {"triangles", "points", "edges", "lines", "hull"}, optional
        Of a TIN; default triangles.
    """
    is_survey = isinstance(surface, Survey)  # whose rows keep their order
    flatgeobuf.write(make_features(surface, path, kind), path, has_index=not is_survey)


def write_shapefile(surface: Writable, path: Path, *, kind: FeatureKind | None = None) -> None:
    """Write a kind of parts of a surface, or features, as :func:`shapefile.write` does.

    Parameters
    ----------
    surface : TIN, Survey or Features
    path : Path
    kind : {"triangles", "points", "edges", "lines", "hull"}, optional
        Of a TIN; default triangles, as PolygonZ.
    """
    shapefile.write(make_features(surface, path, kind), path)


def write_geoparquet(surface: Writable, path: Path, *, kind: FeatureKind | None = None) -> None:
    """Write a kind of parts of a surface, or features, as :func:`geoparquet.write` does.

    Parameters
    ----------
    surface : TIN, Survey or Features
    path : Path
    kind : {"triangles", "points", "edges", "lines", "hull"}, optional
        Of a TIN; default triangles.
    """
    from . import geoparquet

    geoparquet.write(make_features(surface, path, kind), path)


def write_geojson_sequence(
    surface: Writable, path: Path, *, kind: FeatureKind | None = None
) -> None:
    """Write a kind of parts of a surface, or features, as lines of GeoJSON, each a feature.

    Parameters
    ----------
    surface : TIN, Survey or Features
        Its CRS must be known: coordinates are WGS 84 longitude and latitude, elevations metres, as
        those of a GeoJSON file.
    path : Path
    kind : {"triangles", "points", "edges", "lines", "hull"}, optional
        Of a TIN; default triangles.
    """
    from .geojson.features import write_feature_lines

    write_feature_lines(make_features(surface, path, kind), path)
