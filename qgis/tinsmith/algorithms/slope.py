"""Classes of slope and aspect."""

from __future__ import annotations

from typing import Any

from qgis.core import QgsProcessing

from ..inputs import Surface
from ..options import choice, switch, text
from ..styles import style_classes
from .base import CommandAlgorithm, Run


class SlopeAlgorithm(CommandAlgorithm):
    """Divide a TIN into classes of slope or aspect."""

    verb = "slope"
    title = "Slope classes"
    summary = "Divides a TIN into classes of slope, or of aspect, as polygons."
    explanation = "The areas of the classes are in the layer, and in a table if you want one."
    surfaces = (Surface(),)
    options = (
        choice(
            "UNIT",
            "Unit of slopes",
            "--unit",
            "An angle, or the rise over a run of 100 or of 1.",
            ("degrees", "percent", "ratio"),
        ),
        text(
            "BREAKS",
            "Limits between the classes",
            "--breaks",
            "With commas between, in that unit, such as 5,15,30; usual ones if empty.",
        ),
        switch("ASPECT", "Aspect instead", "--aspect", "The direction in which it falls."),
    )

    def add_outputs(self) -> None:
        """Add the polygons and the table."""
        self.add_layer_output("Slope classes", QgsProcessing.TypeVectorPolygon)
        self.add_table_output("A row a class.", "Table of areas")

    def make(self, run: Run) -> dict[str, Any]:
        """Classify."""
        return self.make_layer(run, style_classes, "TABLE")
