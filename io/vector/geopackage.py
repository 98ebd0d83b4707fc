"""GeoPackage: features as one layer."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...base.atomic import folder_beside
from ...base.checks import as_flag
from ...base.errors import OptionError, WriteError
from ...base.sentences import FILE
from ..mesh.geopackage.existing_layers import MARK, Placing, adding_layers
from .ogr import describe, write_layer
from .surface_features import make_features

if TYPE_CHECKING:
    from ...base.results import Features
    from ...tin import Survey

_VERSION = "1.3"
"""That of whole TINs; the triggers of 1.4 are unknown to GDAL and its validator before 3.7."""

_OWN_COLUMNS = ("fid", "geom")
_RESERVED = re.compile(r"(gpkg|rtree|sqlite)_", re.IGNORECASE)


def write(
    surface: Features | Survey,
    path: Path,
    *,
    layer: str | None = None,
    append: bool = False,
    overwrite: bool = False,
) -> None:
    """Write features, or points of a survey, as a layer of a GeoPackage; other layers stay.

    Parameters
    ----------
    layer : str, optional
        Name of the layer; default that of the product. One that tinsmith wrote is replaced.
    append : bool
        Add to the features of such a layer, whose columns and CRS must be the same.
    overwrite : bool
        Replace the layer also if another program wrote or changed it.

    Raises
    ------
    OptionError
        If the name of the layer is none, or both to append and to overwrite is asked for.
    WriteError
        If the file cannot be written, is open elsewhere, or a column is called ``fid`` or
        ``geom``, as GeoPackage calls its own; if there is a layer of the name that tinsmith did
        not write, or that was changed since.

    Notes
    -----
    Nothing is lost: coordinates and numbers are the same float64. Units of columns and of
    elevations, and notes, are metadata of the layer, a unit that is not known ``"unknown"``. NaN
    and missing texts are NULL.
    """
    features = make_features(surface, None)
    names = [name.casefold() for name in features.columns]
    for name in features.columns:
        if name.casefold() in _OWN_COLUMNS or names.count(name.casefold()) > 1:
            why = "GeoPackage's own" if name.casefold() in _OWN_COLUMNS else "there twice"
            raise WriteError(
                f"Cannot write {FILE}: a column '{name}' is {why}, capitals aside: rename it."
            )
    placing = Placing(as_flag("overwrite", overwrite), as_flag("append", append))
    if placing.append and placing.overwrite:
        raise OptionError("append", append, "False where overwrite is True")
    named = features if layer is None else replace(features, name=_as_layer(layer))
    metadata = describe(features) | {MARK: "tinsmith"}
    with (
        adding_layers(path, placing) as beside,
        folder_beside(beside.with_name(path.name)) as folder,
    ):
        new = Path(folder, path.name)
        version = {"VERSION": _VERSION}
        write_layer(named, new, path, driver="GPKG", metadata=metadata, dataset_options=version)
        new.replace(beside)


def _as_layer(layer: Any) -> str:
    if not isinstance(layer, str) or not layer.strip() or _RESERVED.match(layer):
        raise OptionError(
            "layer", layer, "a name that does not begin with gpkg_, rtree_ or sqlite_"
        )
    return layer
