"""Contours of a TIN."""

from __future__ import annotations

from typing import Any

from qgis.core import QgsProcessing, QgsProcessingParameterEnum

from ..inputs import Surface
from ..options import describe, number, text
from ..styles import style_bands, style_contours, style_labels
from .base import CommandAlgorithm, Run

_PRODUCTS = {"lines": style_contours, "bands": style_bands, "labels": style_labels}
_LENGTHS = "In the unit of elevations."


class ContoursAlgorithm(CommandAlgorithm):
    """Trace contours."""

    verb = "contours"
    title = "Contours"
    summary = "Traces contour lines, the bands between them, or their labels."
    explanation = (
        "Give an interval or levels. Lines are closed or end at the boundary; index contours are "
        "drawn thicker and labelled. Smoothed and simplified lines do not touch one another. Bands "
        "are polygons, and exact; labels are points with a rotation."
    )
    surfaces = (Surface(),)
    options = (
        number("INTERVAL", "Interval between levels", "--interval", _LENGTHS, least=0.0),
        text("LEVELS", "or levels", "--levels", "With commas between, such as 320,322.5."),
        number("BASE", "A level from which others count", "--base", _LENGTHS, 0.0, advanced=True),
        number(
            "INDEX",
            "Every Nth is an index contour",
            "--index",
            "Counted from the base; 0 for none.",
            5,
            least=0,
            integer=True,
        ),
        number(
            "SMOOTH",
            "Round corners within",
            "--smooth",
            "The surface stays within this height of the level.",
            least=0.0,
        ),
        number("SIMPLIFY", "Drop points within", "--simplify", "Likewise.", least=0.0),
        number(
            "LABEL_SPACING",
            "Distance between labels of a line",
            "--label-spacing",
            "For labels; in units of the CRS.",
            least=0.0,
            advanced=True,
        ),
    )

    def add_outputs(self) -> None:
        """Add what is made, and the layer."""
        product = QgsProcessingParameterEnum(
            "PRODUCT", "Make", list(_PRODUCTS), False, "lines", False, True
        )
        self.addParameter(describe(product, "Contour lines, the bands between them, or labels."))
        self.add_layer_output("Contours", QgsProcessing.TypeVectorAnyGeometry)

    def make(self, run: Run) -> dict[str, Any]:
        """Trace."""
        product = self.parameterAsEnumString(run.parameters, "PRODUCT", run.context) or "lines"
        chosen = [] if product == "lines" else [f"--{product}"]
        return self.make_layer(run, _PRODUCTS[product], chosen=chosen)
