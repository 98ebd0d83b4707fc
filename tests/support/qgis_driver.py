"""Run by the Python of QGIS: start it once, run algorithms one after the other, tell what came.

Arguments: the folder of the plugin's package, a file of jobs (JSON) and the file for the answers.
"""

from __future__ import annotations

import json
import os
import sys
import traceback
from pathlib import Path

from qgis.core import (
    QgsApplication,
    QgsCoordinateReferenceSystem,
    QgsExpression,
    QgsFeature,
    QgsGeometry,
    QgsMeshLayer,
    QgsProcessingContext,
    QgsProcessingFeatureSourceDefinition,
    QgsProcessingFeedback,
    QgsProject,
    QgsRasterLayer,
    QgsVectorLayer,
)


class Feedback(QgsProcessingFeedback):
    """Keeps what is said; cancels once a text is."""

    def __init__(self, cancel_at):
        super().__init__(False)
        self.said = []
        self.fractions = []
        self.cancel_at = cancel_at
        self.progressChanged.connect(self.fractions.append)

    def note(self, kind, text):
        self.said.append([kind, text])
        if self.cancel_at and self.cancel_at in text:
            self.cancel()

    def setProgressText(self, text):
        self.note("step", text)

    def pushInfo(self, text):
        self.note("info", text)

    def pushWarning(self, text):
        self.note("warning", text)

    def pushCommandInfo(self, text):
        self.note("command", text)

    def pushConsoleInfo(self, text):
        self.note("console", text)

    def reportError(self, error, fatalError=False):
        self.note("error", error)


MOST_SHAPES = 3


def make_layer(kind, crs, columns, features, name):
    """Return a layer in memory, of features as WKT with their attributes."""
    text = "&".join(f"field={column}" for column in columns)
    layer = QgsVectorLayer(f"{kind}?{text}", name, "memory")
    layer.setCrs(QgsCoordinateReferenceSystem(crs))
    made = []
    for wkt, attributes in features:
        feature = QgsFeature(layer.fields())
        feature.setGeometry(QgsGeometry.fromWkt(wkt))
        feature.setAttributes(attributes)
        made.append(feature)
    layer.dataProvider().addFeatures(made)
    return layer


def add_layers(project, layers):
    """Add layers to the project, each as what it says."""
    for name, one in layers.items():
        if "features" in one:
            layer = make_layer(one["kind"], one["crs"], one["columns"], one["features"], name)
            layer.selectByIds(one.get("selected", []))
        else:
            make = {"mesh": QgsMeshLayer, "raster": QgsRasterLayer, "vector": QgsVectorLayer}
            provider = {"mesh": "mdal", "raster": "gdal", "vector": "ogr"}[one["kind"]]
            layer = make[one["kind"]](one["path"], name, provider)
            if one.get("crs"):
                layer.setCrs(QgsCoordinateReferenceSystem(one["crs"]))
        assert layer.isValid(), name
        project.addMapLayer(layer)


def insert_selection(parameters):
    """Replace ``{"selected": layer}`` by the object that means its selected features."""
    return {
        key: QgsProcessingFeatureSourceDefinition(value["selected"], True)
        if isinstance(value, dict)
        else value
        for key, value in parameters.items()
    }


def run_job(job):
    """Run an algorithm and load its layers; return outputs, log, and what was loaded."""
    import processing
    from processing.core.ProcessingConfig import ProcessingConfig

    from tinsmith import process

    process._GRACE = job.get("grace", 10.0)
    os.environ.update(job.get("environment", {}))
    ProcessingConfig.setSettingValue("TINSMITH_COMMAND", job.get("command", ""))
    feedback = Feedback(job.get("cancel_at"))
    project = QgsProject.instance()
    before = set(project.mapLayers())
    answer = {"error": None, "outputs": {}}
    call = processing.runAndLoadResults if job.get("load") else processing.run
    context = QgsProcessingContext()
    context.setProject(project)
    try:
        found = call(
            job["algorithm"],
            insert_selection(job["parameters"]),
            feedback=feedback,
            context=context,
        )
        answer["outputs"] = {key: value for key, value in found.items() if is_plain(value)}
    except Exception as error:
        answer["error"] = str(error)
        answer["trace"] = traceback.format_exc()
    answer["log"] = feedback.said
    answer["fractions"] = feedback.fractions
    new = [project.mapLayer(name) for name in set(project.mapLayers()) - before]
    answer["layers"] = {layer.name(): describe_layer(layer) for layer in new}
    for layer in new:
        project.removeMapLayer(layer.id())
    return answer


def is_plain(value):
    return isinstance(value, (str, int, float, bool))


def describe_layer(layer):
    """Return what can be told of a layer and its style."""
    told = {"type": type(layer).__name__, "crs": layer.crs().authid(), "valid": layer.isValid()}
    if isinstance(layer, QgsVectorLayer):
        renderer = layer.renderer()
        told["count"] = layer.featureCount()
        told["labels"] = layer.labelsEnabled()
        told["shapes"] = [one.geometry().asWkt(17) for one in layer.getFeatures()][:MOST_SHAPES]
        told["renderer"] = renderer.type() if renderer else None
        if told["renderer"] == "singleSymbol":
            told["properties"] = describe_properties(renderer.symbol().symbolLayer(0))
        if told["renderer"] == "categorizedSymbol":
            told["field"] = renderer.classAttribute()
            rows = renderer.categories()  # kept while their symbols are asked
            told["legend"] = [one.label() for one in rows]
            told["colors"] = [one.symbol().color().name() for one in rows]
            told["widths"] = [
                one.symbol().width() for one in rows if hasattr(one.symbol(), "width")
            ]
            told["unclassified"] = sum(
                renderer.categoryIndexForValue(one[told["field"]]) < 0
                for one in layer.getFeatures()
            )
    elif isinstance(layer, QgsMeshLayer):
        scalars = layer.rendererSettings().scalarSettings(0)
        told["faces"] = layer.dataProvider().faceCount()
        told["range"] = [scalars.classificationMinimum(), scalars.classificationMaximum()]
        rows = scalars.colorRampShader().colorRampItemList()
        told["ramp"] = len(rows)
        told["colors"] = {str(one.value): one.color.name() for one in rows}
        told["edges"] = layer.rendererSettings().nativeMeshSettings().isEnabled()
    else:
        renderer = layer.renderer()
        told["renderer"] = renderer.type()
    return told


def describe_properties(layer):
    """Return the expressions that a layer of a symbol follows; they must be sound."""
    found = layer.dataDefinedProperties()
    properties = [found.property(key) for key in found.propertyKeys()]
    expressions = [one.expressionString() for one in properties if one.isActive()]
    assert not any(QgsExpression(one).hasParserError() for one in expressions), expressions
    return expressions


def describe_provider(registry):
    """Return the algorithms and their parameters."""
    provider = registry.providerById("tinsmith")
    return {
        "id": provider.id(),
        "settings_icon": not provider.icon().isNull(),
        "algorithms": {one.name(): describe_algorithm(one) for one in provider.algorithms()},
    }


def describe_algorithm(one):
    return {
        "help": one.shortHelpString(),
        "icon": [
            one.icon().isNull(),
            one.icon().pixmap(24, 24).toImage().pixelColor(12, 12).name(),
        ],
        "title": one.displayName(),
        "verb": getattr(one, "verb", ""),
        "parameters": [
            {
                "name": each.name(),
                "type": each.type(),
                "help": each.help(),
                "words": each.description(),
                "default": each.defaultValue() if is_plain(each.defaultValue()) else None,
                "choices": each.options() if hasattr(each, "options") else None,
            }
            for each in one.parameterDefinitions()
        ],
    }


def main():
    _, folder, jobs, answers = sys.argv
    app = QgsApplication([], True)
    app.initQgis()
    sys.path[:0] = [folder, "/usr/share/qgis/python/plugins"]
    from processing.core.Processing import Processing

    Processing.initialize()
    from tinsmith.plugin import TinsmithPlugin

    plugin = TinsmithPlugin(None)
    plugin.initProcessing()
    wanted = json.loads(Path(jobs).read_text())
    add_layers(QgsProject.instance(), wanted["layers"])
    told = {name: run_job(job) for name, job in wanted["jobs"].items()}
    told["provider"] = describe_provider(QgsApplication.processingRegistry())
    Path(answers).write_text(json.dumps(told))
    os._exit(0)  # QGIS crashes where layers are left as it ends


main()
