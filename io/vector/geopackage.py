"""GeoPackage: features as one layer."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..._atomic import replacing_files
from ...errors import WriteError
from ..mesh.geopackage.journals import require_closed
from .ogr import describe, write_layer

if TYPE_CHECKING:
    from pathlib import Path

    from ...terrain.results import Features

__all__ = ["write"]

_OWN_COLUMNS = ("fid", "geom")


def write(features: Features, path: Path) -> None:
    """Write features as a GeoPackage with one layer, named after the product.

    Raises
    ------
    WriteError
        If the file cannot be written, is open elsewhere, or a column is called ``fid`` or
        ``geom``, as GeoPackage calls its own.

    Notes
    -----
    Nothing is lost: coordinates and numbers are the same float64. Units of columns and of
    elevations, and notes, are metadata of the layer, a unit that is not known ``"unknown"``. NaN
    and missing texts are NULL.
    """
    _require_free(features, path)
    with replacing_files(path) as new:
        write_layer(features, new, path, driver="GPKG", metadata=describe(features))


def _require_free(features: Features, path: Path) -> None:
    """Refuse names that are taken, and a file that another program works on."""
    names = [name.casefold() for name in features.columns]
    for name in features.columns:
        if name.casefold() in _OWN_COLUMNS or names.count(name.casefold()) > 1:
            why = "GeoPackage's own" if name.casefold() in _OWN_COLUMNS else "there twice"
            raise WriteError(
                f"Cannot write '{path}': a column '{name}' is {why}, capitals aside: rename it.",
                path=path,
            )
    require_closed(path)
