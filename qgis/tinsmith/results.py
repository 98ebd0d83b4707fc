"""Results: layers are loaded with a style, also those that Processing does not load itself."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from osgeo import gdal
from qgis.core import (
    QgsMeshLayer,
    QgsProcessingContext,
    QgsProcessingLayerPostProcessorInterface,
    QgsProcessingUtils,
    QgsVectorLayer,
)

from .styles import style_mesh

if TYPE_CHECKING:
    from collections.abc import Callable

_MESHES = (".ply", ".nc", ".2dm")
_TABLES = (".csv", ".tsv")
_VECTORS = (".gpkg", ".geojson", ".fgb", ".shp", ".dxf", *_TABLES)

_UNKNOWN = "unknown"
_SYMBOLS = {"metre": "m", "foot": "ft", "US survey foot": "US ft"}

_EDGES_ALONE = (
    "QGIS colors the breaklines alone of a PLY mesh that has any: write .nc, .gpkg or .2dm to see "
    "its faces colored."
)


class Styler(QgsProcessingLayerPostProcessorInterface):
    """Styles a layer once it is loaded."""

    kept: list[Styler] = []  # noqa: RUF012 - QGIS holds them without owning them
    """Those that QGIS may still call."""

    def __init__(self, style: Callable[[Any], None]) -> None:
        super().__init__()
        self._style = style
        Styler.kept.append(self)

    def postProcessLayer(self, layer: Any, context: Any, feedback: Any) -> None:
        """Style the layer."""
        self._style(layer)
        layer.triggerRepaint()
        if self in Styler.kept:
            Styler.kept.remove(self)


def name_layer(path: str, title: str, unit: str) -> str:
    """Return the name of a layer: its file, if the user named one, and the unit of elevations."""
    is_temporary = Path(QgsProcessingUtils.tempFolder()) in Path(path).parents
    name = title if is_temporary else Path(path).stem
    return f"{name} ({unit})" if unit else name


def find_unit(record: dict[str, Any]) -> str:
    """Return the unit of elevations that the result of a command tells, or nothing."""
    tin = record.get("tin") or {}
    found = (tin.get("units") or {}).get("vertical")
    found = found or (record.get("units") or {}).get("elevation") or _UNKNOWN
    return "" if found == _UNKNOWN else _SYMBOLS.get(found, found)


def rename_on_loading(path: str, unit: str, context: Any) -> None:
    """Name a layer that Processing is to load after its file."""
    if context.willLoadLayerOnCompletion(path):
        details = context.layerToLoadOnCompletionDetails(path)
        details.name = name_layer(path, details.name, unit)


def style_on_loading(path: str, style: Callable[[Any], None], context: Any) -> None:
    """Have a layer styled, if Processing is to load it."""
    if context.willLoadLayerOnCompletion(path):
        context.layerToLoadOnCompletionDetails(path).setPostProcessor(Styler(style))


class PlaceColumns(NamedTuple):
    """Columns of a table that hold coordinates, and their CRS."""

    x: str
    y: str
    crs: Any


def load_file(
    path: str,
    output: str,
    context: Any,
    feedback: Any,
    *,
    name: str,
    style: Callable[[Any], None] = style_mesh,
    place: PlaceColumns | None = None,
) -> None:
    """Have a file loaded that is no output layer of Processing: a mesh, a table, any other.

    A mesh gets the style; a table is loaded as points by its columns of coordinates.

    Nothing is loaded where no project is open, or if QGIS has no layer for such a file.
    """
    project = context.project()
    layer = None if project is None else open_layer(path, name, place)
    if layer is None:
        return
    context.temporaryLayerStore().addMapLayer(layer)
    details = QgsProcessingContext.LayerDetails(name, project, output)
    if isinstance(layer, QgsMeshLayer):
        if layer.dataProvider().edgeCount() > 0:
            feedback.pushWarning(_EDGES_ALONE)
        details.setPostProcessor(Styler(style))
    context.addLayerToLoadOnCompletion(layer.id(), details)


def open_layer(path: str, name: str, place: PlaceColumns | None = None) -> Any:
    """Return a file as a layer, or None if QGIS has none for it; libraries print nothing."""
    gdal.PushErrorHandler("CPLQuietErrorHandler")
    try:
        if place is not None and Path(path).suffix.lower() in _TABLES:
            return _open_points(path, name, place)
        return _open_layer(path, name)
    finally:
        gdal.PopErrorHandler()


def _open_points(path: str, name: str, place: PlaceColumns) -> Any:
    """Return a table as a layer of points, or None if QGIS cannot open it."""
    how = QgsVectorLayer.LayerOptions()
    how.skipCrsValidation = True  # else QGIS may ask for the CRS, which a table has not
    columns = f"option:X_POSSIBLE_NAMES={place.x}|option:Y_POSSIBLE_NAMES={place.y}"
    layer = QgsVectorLayer(f"{path}|{columns}", name, "ogr", how)
    layer.setCrs(place.crs)
    return layer if layer.isValid() else None


def _open_layer(path: str, name: str) -> Any:
    suffix = Path(path).suffix.lower()
    layer = None
    if suffix == ".nc":
        gdal.OpenEx(path, gdal.OF_RASTER)  # else HDF5 prints what MDAL's other readers miss
    if suffix in _MESHES:
        layer = QgsMeshLayer(path, name, "mdal")
    elif suffix in _VECTORS:
        layer = QgsVectorLayer(_choose_part(path, suffix), name, "ogr")
    return layer if layer is not None and layer.isValid() else None


def _choose_part(path: str, suffix: str) -> str:
    """Return what to open of a file: of a TIN in a GeoPackage its triangles."""
    if suffix == ".gpkg":
        whole = QgsVectorLayer(path, "parts", "ogr")  # kept while its provider is asked
        parts = whole.dataProvider().subLayers() if whole.isValid() else []
        if any(part.split("!!::!!")[1] == "triangles" for part in parts):
            return f"{path}|layername=triangles"
    return path
