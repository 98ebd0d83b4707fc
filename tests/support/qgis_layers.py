"""Vector layers as QGIS opens them, in a process of the system's own Python."""

from __future__ import annotations

from typing import Any

from .qgis_meshes import run_in_qgis

__all__ = ["open_layers_in_qgis"]

_OPEN = """
import json, os, sys
from qgis.core import (QgsApplication, QgsExpressionContextUtils, QgsRenderContext,
                       QgsVectorLayer)
app = QgsApplication([], False)
app.initQgis()
told = {}

def count_unclassified(layer, features):
    # Those for which the style has no symbol.
    if layer.renderer() is None:
        return None
    context = QgsRenderContext()
    context.expressionContext().appendScope(QgsExpressionContextUtils.layerScope(layer))
    renderer = layer.renderer().clone()
    renderer.startRender(context, layer.fields())
    lost = 0
    for one in features:
        context.expressionContext().setFeature(one)
        lost += renderer.symbolForFeature(one, context) is None
    renderer.stopRender(context)
    return lost

for path in sys.argv[1:]:
    whole = QgsVectorLayer(path, "layer", "ogr")
    names = [one.split("!!::!!")[1] for one in whole.dataProvider().subLayers()]
    layers = told[path] = {}
    for name in names:
        layer = QgsVectorLayer(path + "|layername=" + name, name, "ogr")
        features = list(layer.getFeatures())
        rows = [[v.x(), v.y(), v.z()] for one in features for v in one.geometry().vertices()]
        layers[name] = {
            "valid": layer.isValid(),
            "count": layer.featureCount(),
            "crs": layer.crs().authid(),
            "kind": sorted({one.geometry().constGet().geometryType() for one in features
                            if one.hasGeometry()}),
            "renderer": layer.renderer().type() if layer.renderer() else None,
            "unclassified": count_unclassified(layer, features),
            "legend": [one.label() for one in layer.renderer().legendSymbolItems()]
                      if layer.renderer() else [],
            "fields": layer.fields().names(),
            "vertices": [row if row[2] == row[2] else [row[0], row[1], None] for row in rows],
        }
print("ANSWER" + json.dumps(told), flush=True)
os._exit(0)  # QGIS crashes where layers are left as it ends
"""


def open_layers_in_qgis(paths: Any, folder: Any) -> dict[str, dict[str, Any]]:
    """Return what QGIS tells of each layer of each file, by the names of files and layers."""
    told = run_in_qgis(_OPEN, [str(path) for path in paths], folder)
    return {path.name: told[str(path)] for path in paths}
