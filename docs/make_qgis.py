"""Make the pictures of qgis.md: a dialog of the plugin, and maps of what its algorithms make.

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
    QgsCoordinateReferenceSystem,
    QgsFeature,
    QgsGeometry,
    QgsMapRendererParallelJob,
    QgsMapSettings,
    QgsProcessingContext,
    QgsProcessingFeedback,
    QgsProject,
    QgsRectangle,
    QgsVectorLayer,
)
from qgis.PyQt.QtCore import QPoint, QSize
from qgis.PyQt.QtGui import QColor, QFont, QImage, QPainter

HERE = Path(__file__).parent
SURVEY = HERE.parent / "sample_data" / "site_survey.csv"
CRS = "EPSG:32616"
MAP_SIZE = QSize(1200, 860)
MAP_DPI = 110
DIALOG_SIZE = (900, 860)
PANEL_SIZE = QSize(600, 430)
CAPTION = 34
"""Pixels above a panel."""
EYE = f"752760,4024262 [{CRS}]"
PAD = (
    "752740 4024290, 752790 4024290, 752790 4024322, 752768 4024322, 752768 4024308, 752740 4024308"
)
SPOILT = {40: 6.0, 700: -4.0, 1200: 2950.0, 1900: 9.0}
"""Rows of the survey, and what is added to their elevations."""


def main(folder: Path = HERE) -> None:
    """Run algorithms, draw what they load, and the dialog of one."""
    app = start_qgis()
    with TemporaryDirectory() as made:
        survey, tin, contours = run_algorithms(Path(made))
        draw_map([contours, tin], folder / "qgis-map.png")
        draw_panels(list_panels(Path(made), tin), folder / "qgis-site.png")
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


def list_panels(folder: Path, tin) -> dict:
    """Make the layers of each panel, the first on top."""

    def make(name: str, output: str, given: dict | None = None, **parameters):
        surface = {"INPUT": tin.id()} if given is None else given
        return run(f"tinsmith:{name}", {**surface, **parameters, "OUTPUT": str(folder / output)})

    catchments = make("flow", "catchments.gpkg", FIND="catchments")
    channels = make("flow", "channels.gpkg", FIND="accumulation", MIN_AREA=100)
    hollows = make("flow", "hollows.gpkg", MIN_DEPTH=0.3)
    pits = make("flow", "pits.gpkg", FIND="pits")
    seen = make("sight", "seen.gpkg", EYE=EYE, EYE_HEIGHT=1.7)
    targets = add_memory_layer("Point", [f"Point({x} {y})" for x, y in list_targets()])
    lines = make("sight", "lines.gpkg", EYE=EYE, EYE_HEIGHT=1.7, TARGETS=targets.id())
    pad = add_memory_layer("Polygon", [f"Polygon(({PAD}, {PAD.split(',')[0]}))"])
    slopes = {"ELEVATION": 327, "CUT_SLOPE": 2, "FILL_SLOPE": 3}
    graded = make("grade", "graded.nc", PAD=pad.id(), **slopes)
    lifted = make("contours", "graded.gpkg", {"INPUT": graded.id()}, INTERVAL=0.5)
    spoilt = {"INPUT_FILE": spoil_survey(folder), "EXTRA": f"--crs {CRS} --codes"}
    suspects = make("inspect", "suspects.gpkg", spoilt)
    return {
        "Flow: catchments, channels, ponds, pits": [pits, channels, hollows, catchments],
        "Sight: the viewshed, and lines of sight": [lines, seen],
        "Grade a pad, and its contours": [lifted, graded],
        "Inspect points: suspects by certainty": [suspects, tin],
    }


def list_targets():
    """Return places around the eye."""
    x, y = map(float, EYE.split(" ")[0].split(","))
    return [(x + dx, y + dy) for dx in (-80, -40, 0, 40, 80) for dy in (-50, 45)]


def spoil_survey(folder: Path) -> str:
    """Write the survey with some elevations spoilt."""
    rows = [line.split(",") for line in SURVEY.read_text().splitlines()]
    for number, rise in SPOILT.items():
        rows[number][3] = f"{float(rows[number][3]) + rise:.3f}"
    path = folder / "spoilt.csv"
    path.write_text("\n".join(map(",".join, rows)) + "\n")
    return str(path)


def add_memory_layer(kind: str, shapes: list):
    """Add a layer of shapes, given as WKT, to the project."""
    layer = QgsVectorLayer(kind, kind, "memory")
    layer.setCrs(QgsCoordinateReferenceSystem(CRS))
    for shape in shapes:
        feature = QgsFeature()
        feature.setGeometry(QgsGeometry.fromWkt(shape))
        layer.dataProvider().addFeatures([feature])
    QgsProject.instance().addMapLayer(layer)
    return layer


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
    render_map(layers, MAP_SIZE, MAP_DPI).save(str(path))
    print(path)


def draw_panels(panels: dict, path: Path) -> None:
    """Draw maps in two columns, with their captions."""
    width, height = PANEL_SIZE.width(), PANEL_SIZE.height() + CAPTION
    image = QImage(2 * width, height * ((len(panels) + 1) // 2), QImage.Format_RGB32)
    image.fill(QColor("white"))
    painter = QPainter(image)
    painter.setFont(QFont("sans", 12))
    for number, (caption, layers) in enumerate(panels.items()):
        corner = QPoint(number % 2 * width, number // 2 * height)
        painter.drawText(corner + QPoint(14, CAPTION - 10), caption)
        painter.drawImage(corner + QPoint(0, CAPTION), render_map(layers, PANEL_SIZE, 80))
    painter.end()
    image.save(str(path))
    print(path)


def render_map(layers, size: QSize, dpi: int):
    """Return an image of layers, the first on top, over the extent of the last."""
    settings = QgsMapSettings()
    settings.setLayers(layers)
    settings.setDestinationCrs(layers[0].crs())
    settings.setBackgroundColor(QColor("white"))
    settings.setOutputSize(size)
    settings.setOutputDpi(dpi)
    extent = QgsRectangle(layers[-1].extent())
    extent.scale(1.04)
    settings.setExtent(extent)
    job = QgsMapRendererParallelJob(settings)
    job.start()
    job.waitForFinished()
    return job.renderedImage()


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
