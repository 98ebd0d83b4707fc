"""Styles of results: contours with labels, classes in their colours, water, ramps of elevations."""

from __future__ import annotations

from typing import Any

from qgis.core import (
    NULL,
    QgsCategorizedSymbolRenderer,
    QgsColorRampShader,
    QgsFillSymbol,
    QgsGradientColorRamp,
    QgsGradientStop,
    QgsLineSymbol,
    QgsMarkerSymbol,
    QgsMeshDatasetIndex,
    QgsPalLayerSettings,
    QgsProperty,
    QgsRasterBandStats,
    QgsRasterShader,
    QgsRendererCategory,
    QgsSingleBandGrayRenderer,
    QgsSingleBandPseudoColorRenderer,
    QgsSingleSymbolRenderer,
    QgsSymbolLayer,
    QgsTextBufferSettings,
    QgsTextFormat,
    QgsUnitTypes,
    QgsVectorLayerSimpleLabeling,
)
from qgis.PyQt.QtGui import QColor

_BROWN = "#8c5a2b"
_TINTS = (
    (0.0, "#4d735d"),
    (0.25, "#709364"),
    (0.5, "#adac6c"),
    (0.75, "#dfc599"),
    (1.0, "#f3e9df"),
)
"""Hypsometric tints from low to high, those of ``interpolate_tints`` in terrain/drawing."""
_WATER = "#2f6fb0"
_CERTAINTIES = {"high": "#c62828", "medium": "#ef8f1c", "low": "#f4d03f"}
_SEEN = {True: "#2e8b3d", False: "#c4533f"}
_VIEWS = ("visible", "partly", "hidden")
_RIDGES = {"ridge": _BROWN, "valley": _WATER}
_GOLDEN_ANGLE = 137.5
"""Degrees between the hues of neighbours in a row, which makes them differ."""
_THINNEST, _THICKEST = 0.15, 1.8
"""Millimetres, of channels."""
_EARTHWORK = {"cut": "#c4533f", "fill": "#3b77b0", "unchanged": "#dddddd"}


def make_elevation_ramp() -> Any:
    """Return the ramp of elevations."""
    stops = [QgsGradientStop(at, QColor(color)) for at, color in _TINTS[1:-1]]
    return QgsGradientColorRamp(QColor(_TINTS[0][1]), QColor(_TINTS[-1][1]), False, stops)


# ---------------------------------------------------------------- meshes and rasters


def style_mesh(layer: Any) -> None:
    """Color a mesh by elevation, with its edges."""
    group = layer.datasetGroupMetadata(QgsMeshDatasetIndex(0, 0))
    _color_mesh(layer, _make_shader(group.minimum(), group.maximum(), make_elevation_ramp()))


def style_difference(layer: Any) -> None:
    """Color a mesh of differences from cut to fill, white where nothing has changed."""
    group = layer.datasetGroupMetadata(QgsMeshDatasetIndex(0, 0))
    reach = max(abs(group.minimum()), abs(group.maximum()))
    ends = (QColor(_EARTHWORK[kind]) for kind in ("cut", "fill"))
    ramp = QgsGradientColorRamp(*ends, False, [QgsGradientStop(0.5, QColor("white"))])
    _color_mesh(layer, _make_shader(-reach, reach, ramp))


def _color_mesh(layer: Any, shader: Any) -> None:
    """Color a mesh by its elevations, with its edges."""
    settings = layer.rendererSettings()
    scalars = settings.scalarSettings(0)
    scalars.setClassificationMinimumMaximum(shader.minimumValue(), shader.maximumValue())
    scalars.setColorRampShader(shader)
    settings.setScalarSettings(0, scalars)
    settings.setActiveScalarDatasetGroup(0)
    edges = settings.nativeMeshSettings()
    edges.setEnabled(True)
    edges.setColor(QColor(60, 60, 60, 90))
    edges.setLineWidth(0.1)
    settings.setNativeMeshSettings(edges)
    layer.setRendererSettings(settings)


def _make_shader(low: float, high: float, ramp: Any) -> Any:
    shader = QgsColorRampShader(low, high, ramp, QgsColorRampShader.Interpolated)
    shader.classifyColorRamp(6, -1)
    return shader


def style_raster(layer: Any) -> None:
    """Color a raster by the ramp of elevations."""
    provider = layer.dataProvider()
    found = provider.bandStatistics(1, QgsRasterBandStats.Min | QgsRasterBandStats.Max)
    shader = QgsRasterShader(found.minimumValue, found.maximumValue)
    ramp = _make_shader(found.minimumValue, found.maximumValue, make_elevation_ramp())
    shader.setRasterShaderFunction(ramp)
    renderer = QgsSingleBandPseudoColorRenderer(provider, 1, shader)
    renderer.setClassificationMin(found.minimumValue)
    renderer.setClassificationMax(found.maximumValue)
    layer.setRenderer(renderer)


def style_hillshade(layer: Any) -> None:
    """Show a hillshade in greys."""
    layer.setRenderer(QgsSingleBandGrayRenderer(layer.dataProvider(), 1))


# ---------------------------------------------------------------- vectors


def style_contours(layer: Any) -> None:
    """Draw index contours thicker, with their elevations along the lines."""
    widths = ((True, "0.5", "index contours"), (False, "0.2", "contours"))
    categories = [
        QgsRendererCategory(
            is_index, QgsLineSymbol.createSimple({"color": _BROWN, "width": width}), label
        )
        for is_index, width, label in widths
    ]
    layer.setRenderer(QgsCategorizedSymbolRenderer("is_index", categories))
    layer.setLabeling(QgsVectorLayerSimpleLabeling(_make_contour_labels(layer)))
    layer.setLabelsEnabled(True)


def _make_contour_labels(layer: Any) -> Any:
    """Return labels along the lines: of index contours, where there are any."""
    labels = QgsPalLayerSettings()
    has_index = any(one["is_index"] for one in layer.getFeatures())
    shown = 'CASE WHEN "is_index" THEN to_string("elevation") END'
    labels.fieldName = shown if has_index else 'to_string("elevation")'
    labels.isExpression = True
    labels.placement = QgsPalLayerSettings.Line
    labels.placementFlags = QgsPalLayerSettings.OnLine
    labels.repeatDistance = 80
    labels.setFormat(_make_text_format())
    return labels


def _make_text_format(color: str = _BROWN) -> Any:
    text = QgsTextFormat()
    text.setSize(7)
    text.setSizeUnit(QgsUnitTypes.RenderPoints)
    text.setColor(QColor(color))
    halo = QgsTextBufferSettings()
    halo.setEnabled(True)
    halo.setSize(0.7)
    halo.setColor(QColor("white"))
    text.setBuffer(halo)
    return text


def style_labels(layer: Any) -> None:
    """Write the labels that the command has placed, at their rotation."""
    labels = QgsPalLayerSettings()
    labels.fieldName = "text"
    labels.placement = QgsPalLayerSettings.OverPoint
    labels.displayAll = True
    turned = QgsPalLayerSettings.LabelRotation
    labels.dataDefinedProperties().setProperty(turned, QgsProperty.fromExpression('-"rotation"'))
    labels.setFormat(_make_text_format())
    layer.setLabeling(QgsVectorLayerSimpleLabeling(labels))
    layer.setLabelsEnabled(True)
    layer.renderer().symbol().setSize(0)


def style_bands(layer: Any) -> None:
    """Color the bands between contours by the ramp of elevations."""
    rows = {(one["from"], one["to"]) for one in layer.getFeatures()}
    rows_upwards = sorted(rows, key=lambda row: (row[0] != NULL, row[0] if row[0] != NULL else 0))
    ramp = make_elevation_ramp()
    categories = [
        _categorise(row[0], _name_band(*row), ramp.color(k / max(len(rows) - 1, 1)).name())
        for k, row in enumerate(rows_upwards)
    ]
    layer.setRenderer(QgsCategorizedSymbolRenderer("from", categories))


def _name_band(low: Any, high: Any) -> str:
    """Return the limits of a band; the lowest and the highest have one each."""
    if low == NULL or high == NULL:
        return f"below {high:g}" if low == NULL else f"above {low:g}"
    return f"{low:g} to {high:g}"


def style_classes(layer: Any) -> None:
    """Color classes as the command's own legend does."""
    rows = {one["class"]: (one["label"], one["color"]) for one in layer.getFeatures()}
    categories = [_categorise(key, label, color) for key, (label, color) in sorted(rows.items())]
    layer.setRenderer(QgsCategorizedSymbolRenderer("class", categories))


def style_earthwork(layer: Any) -> None:
    """Color what is cut and what is filled."""
    categories = [_categorise(kind, kind, color) for kind, color in _EARTHWORK.items()]
    layer.setRenderer(QgsCategorizedSymbolRenderer("kind", categories))


def _categorise(value: Any, label: str, color: str) -> Any:
    symbol = QgsFillSymbol.createSimple({"color": color, "outline_style": "no"})
    return QgsRendererCategory(value, symbol, label)


# ---------------------------------------------------------------- points and sight


def style_suspects(layer: Any) -> None:
    """Mark points that look like blunders by how certain that is, with the reason."""
    categories = [
        QgsRendererCategory(
            certainty,
            QgsMarkerSymbol.createSimple(
                {"color": color, "size": "3.4", "outline_color": "#3a3a3a", "outline_width": "0.3"}
            ),
            f"{certainty} certainty",
        )
        for certainty, color in _CERTAINTIES.items()
    ]
    layer.setRenderer(QgsCategorizedSymbolRenderer("certainty", categories))
    labels = QgsPalLayerSettings()
    labels.fieldName = "reason"
    labels.setFormat(_make_text_format("#3a3a3a"))
    layer.setLabeling(QgsVectorLayerSimpleLabeling(labels))
    layer.setLabelsEnabled(True)


def style_ground(layer: Any) -> None:
    """Draw the points of the ground as small dots."""
    symbol = {"color": _BROWN, "size": "0.7", "outline_style": "no"}
    layer.setRenderer(QgsSingleSymbolRenderer(QgsMarkerSymbol.createSimple(symbol)))


def style_viewshed(layer: Any) -> None:
    """Color what is seen, in part, and what is hidden, as the command's own legend does."""
    colors = {one["class"]: one["color"] for one in layer.getFeatures()}
    categories = [_categorise(name, name, colors[name]) for name in _VIEWS if name in colors]
    layer.setRenderer(QgsCategorizedSymbolRenderer("class", categories))


def style_sight_lines(layer: Any) -> None:
    """Draw lines of sight that are free, and those that something blocks."""
    labels = {True: "visible", False: "blocked"}
    categories = [
        QgsRendererCategory(seen, _make_line(color, 0.5), labels[seen])
        for seen, color in _SEEN.items()
    ]
    layer.setRenderer(QgsCategorizedSymbolRenderer("visible", categories))


def _make_line(color: str, width: float) -> Any:
    return QgsLineSymbol.createSimple({"color": color, "width": str(width), "capstyle": "round"})


# ---------------------------------------------------------------- water


def style_water(layer: Any) -> None:
    """Fill standing water, with its shore."""
    symbol = {"color": "47,111,176,120", "outline_color": _WATER, "outline_width": "0.4"}
    layer.setRenderer(QgsSingleSymbolRenderer(QgsFillSymbol.createSimple(symbol)))


def style_paths(layer: Any) -> None:
    """Draw the paths of drops."""
    layer.setRenderer(QgsSingleSymbolRenderer(_make_line(_WATER, 0.6)))


def style_pits(layer: Any) -> None:
    """Mark pits by triangles that point down."""
    symbol = {"name": "triangle", "angle": "180", "color": _WATER, "size": "2.6"}
    symbol |= {"outline_color": "white", "outline_width": "0.2"}
    layer.setRenderer(QgsSingleSymbolRenderer(QgsMarkerSymbol.createSimple(symbol)))


def style_ridges(layer: Any) -> None:
    """Tell ridges from valleys."""
    categories = [
        QgsRendererCategory(kind, _make_line(color, 0.4), kind) for kind, color in _RIDGES.items()
    ]
    layer.setRenderer(QgsCategorizedSymbolRenderer("kind", categories))


def style_catchments(layer: Any) -> None:
    """Fill each catchment with a hue of its own."""
    symbol = QgsFillSymbol.createSimple({"outline_color": "#4a4a4a", "outline_width": "0.3"})
    hue = f"color_hsva(($id * {_GOLDEN_ANGLE}) % 360, 45, 90, 150)"
    _set_by_expression(symbol, QgsSymbolLayer.PropertyFillColor, hue)
    layer.setRenderer(QgsSingleSymbolRenderer(symbol))


def style_channels(layer: Any) -> None:
    """Draw channels the thicker, the more drains through them."""
    symbol = _make_line(_WATER, _THINNEST)
    largest = layer.maximumValue(layer.fields().lookupField("area")) or 1.0
    width = f'{_THINNEST} + {_THICKEST - _THINNEST} * sqrt("area" / {largest!r})'
    _set_by_expression(symbol, QgsSymbolLayer.PropertyStrokeWidth, width)
    layer.setRenderer(QgsSingleSymbolRenderer(symbol))


def _set_by_expression(symbol: Any, what: Any, expression: str) -> None:
    """Have a property of a symbol follow the features."""
    symbol.symbolLayer(0).setDataDefinedProperty(what, QgsProperty.fromExpression(expression))
