"""Make the pictures of qgis.md: a dialog of the plugin, and a map of what its algorithms make.

Run ``/usr/bin/python3 docs/make_qgis.py [FOLDER]`` with the Python of QGIS and the command tinsmith
on PATH; no screen is needed.
"""

from __future__ import annotations

import os
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")

from qgis.core import (
    QgsApplication,
    QgsMapRendererParallelJob,
    QgsMapSettings,
    QgsProcessingContext,
    QgsProcessingFeedback,
    QgsProject,
    QgsRectangle,
)
from qgis.PyQt.QtCore import QSize
from qgis.PyQt.QtGui import QColor

HERE = Path(__file__).parent
SURVEY = HERE.parent / "sample_data" / "site_survey.csv"
CRS = "EPSG:32616"
MAP_SIZE = QSize(1200, 860)
MAP_DPI = 110
DIALOG_SIZE = (900, 860)


def main(folder: Path = HERE) -> None:
    """Run two algorithms, draw what they load, and the dialog of one."""
    app = start_qgis()
    with TemporaryDirectory() as made:
        survey, tin, contours = run_algorithms(Path(made))
        draw_map([contours, tin], folder / "qgis-map.png")
        draw_dialog("tinsmith:build", {"POINTS": survey.id(), "MAX_EDGE": 39}, folder)
    del app
    sys.stdout.flush()
    os._exit(0)  # QGIS crashes where layers are left as it ends


def start_qgis():
    """Start QGIS with Processing and the plugin."""
    app = QgsApplication([], True)
    app.initQgis()
    plugins = Path(QgsApplication.pkgDataPath()) / "python" / "plugins"
    sys.path[:0] = [str(HERE.parent / "qgis"), str(plugins)]
    from processing.core.Processing import Processing
    from processing.gui.AlgorithmDialog import AlgorithmDialog  # noqa: F401 - registers widgets

    from tinsmith.plugin import TinsmithPlugin

    Processing.initialize()
    app.plugin = TinsmithPlugin(None)
    app.plugin.initProcessing()
    return app


def run_algorithms(folder: Path):
    """Make layers of the sample's points, its TIN and its contours, as they are loaded."""
    given = {"INPUT_FILE": str(SURVEY), "CRS": CRS, "OUTPUT": str(folder / "site_survey.gpkg")}
    survey = run("tinsmith:convert", given)
    survey.setName("site_survey")
    tin = run(
        "tinsmith:build",
        {
            "FILE": str(SURVEY),
            "CRS": CRS,
            "EXTRA": "--codes",
            "MAX_EDGE": 39,
            "OUTPUT": str(folder / "site.nc"),
        },
    )
    given = {"INPUT": tin.id(), "INTERVAL": 0.5, "OUTPUT": str(folder / "contours.gpkg")}
    return survey, tin, run("tinsmith:contours", given)


def run(name: str, parameters: dict):
    """Run an algorithm; return the layer that it loads."""
    import processing

    project = QgsProject.instance()
    before = set(project.mapLayers())
    context = QgsProcessingContext()
    context.setProject(project)
    feedback = QgsProcessingFeedback()
    processing.runAndLoadResults(name, parameters, feedback=feedback, context=context)
    (new,) = set(project.mapLayers()) - before
    return project.mapLayer(new)


def draw_map(layers, path: Path) -> None:
    """Draw layers, the first on top."""
    settings = QgsMapSettings()
    settings.setLayers(layers)
    settings.setDestinationCrs(layers[0].crs())
    settings.setBackgroundColor(QColor("white"))
    settings.setOutputSize(MAP_SIZE)
    settings.setOutputDpi(MAP_DPI)
    extent = QgsRectangle(layers[-1].extent())
    extent.scale(1.04)
    settings.setExtent(extent)
    job = QgsMapRendererParallelJob(settings)
    job.start()
    job.waitForFinished()
    job.renderedImage().save(str(path))
    print(path)


def draw_dialog(name: str, parameters: dict, folder: Path) -> None:
    """Draw the dialog of an algorithm as it opens."""
    from processing.gui.AlgorithmDialog import AlgorithmDialog

    algorithm = QgsApplication.processingRegistry().createAlgorithmById(name)
    dialog = AlgorithmDialog(algorithm)
    dialog.setParameters(parameters)
    dialog.resize(*DIALOG_SIZE)
    dialog.show()
    for _ in range(20):
        QgsApplication.processEvents()
    path = folder / "qgis-dialog.png"
    dialog.grab().save(str(path))
    print(path)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else HERE)
