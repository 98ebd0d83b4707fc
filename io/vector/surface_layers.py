"""TINs, surveys and features as layers of the formats of GIS: one kind of geometry a file."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...base.errors import FormatError
from ...base.results import Features
from ...base.sentences import FILE
from ...tin import Survey
from ..mesh.common import require_tin
from . import flatgeobuf, geopackage, shapefile
from .surface_features import make_features, make_whole_surface

if TYPE_CHECKING:
    from pathlib import Path
    from typing import TypeAlias

    from ...base.policies import FeatureKind
    from ...base.progress import Tell
    from ...tin import TIN

    Writable: TypeAlias = TIN | Survey | Features

__all__ = [
    "write_flatgeobuf",
    "write_geojson_sequence",
    "write_geopackage",
    "write_geoparquet",
    "write_shapefile",
]


def write_geopackage(
    surface: Features | Survey,
    path: Path,
    *,
    layer: str | None = None,
    append: bool = False,
    overwrite: bool = False,
) -> None:
    """Write features, or the points of a survey, as :func:`geopackage.write` does.

    Parameters
    ----------
    layer : str, optional
        Name of the layer; default that of the product.
    append : bool
        Add to the features of the layer, which tinsmith wrote.
    overwrite : bool
        Replace the layer also if another program wrote or changed it.
    """
    features = make_features(surface, None)
    geopackage.write(features, path, layer=layer, append=append, overwrite=overwrite)


def write_flatgeobuf(surface: Writable, path: Path, *, kind: FeatureKind | None = None) -> None:
    """Write a kind of parts of a surface, or features, as :func:`flatgeobuf.write` does.

    Parameters
    ----------
    kind : {"triangles", "points", "edges", "lines", "hull"}, optional
        Of a TIN; default triangles.
    """
    is_survey = isinstance(surface, Survey)  # whose rows keep their order
    flatgeobuf.write(make_features(surface, kind), path, has_index=not is_survey)


def write_shapefile(
    surface: Writable, path: Path, *, kind: FeatureKind | None = None, multipatch: bool = False
) -> None:
    """Write a kind of parts of a surface, or features, as :func:`shapefile.write` does.

    Parameters are those of :func:`write_flatgeobuf`, triangles being PolygonZ; and:

    Parameters
    ----------
    multipatch : bool
        Write all triangles of a TIN as one MultiPatch, without slope, aspect and area.

    Raises
    ------
    FormatError
        If a MultiPatch is asked for of something else than the triangles of a TIN.
    """
    if not multipatch:
        shapefile.write(make_features(surface, kind), path)
    elif kind in (None, "triangles") and not isinstance(surface, Features):
        tin = require_tin(surface, format_name="a MultiPatch")
        shapefile.write_multipatch(make_whole_surface(tin), path)
    else:
        raise FormatError(
            f"Cannot write {FILE}: a MultiPatch holds the triangles of a TIN, no "
            f"{'features' if isinstance(surface, Features) else kind}."
        )


def write_geoparquet(surface: Writable, path: Path, *, kind: FeatureKind | None = None) -> None:
    """Write a kind of parts of a surface, or features, as :func:`geoparquet.write` does.

    Parameters are those of :func:`write_flatgeobuf`.
    """
    from . import geoparquet

    geoparquet.write(make_features(surface, kind), path)


def write_geojson_sequence(
    surface: Writable, path: Path, *, kind: FeatureKind | None = None, progress: Tell | None = None
) -> None:
    """Write a kind of parts of a surface, or features, as lines of GeoJSON, each a feature.

    The CRS must be known: coordinates are WGS 84 longitude and latitude, elevations metres, as
    those of a GeoJSON file. Parameters are those of :func:`write_flatgeobuf`; ``progress`` is
    called with the fraction done.
    """
    from .geojson.features import write_feature_lines

    write_feature_lines(make_features(surface, kind), path, progress=progress)
