"""What is seen from a place on a TIN."""

from __future__ import annotations

from typing import Any

from qgis.core import QgsProcessing

from ..inputs import POINTS, Lines, Place, Surface
from ..options import number, switch
from ..styles import style_sight_lines, style_viewshed
from .base import CommandAlgorithm, Run

_UP = "Above the ground, in the unit of elevations."


class SightAlgorithm(CommandAlgorithm):
    """Draw lines of sight, or a viewshed."""

    verb = "sight"
    title = "Sight"
    summary = "Finds what is seen from a place on a TIN: the viewshed, or lines of sight."
    explanation = (
        "Without targets the viewshed: what is visible and what is hidden. With targets a line to "
        "each, visible or blocked, and where. Ground that only touches a line of sight does not "
        "block it."
    )
    surfaces = (Surface(),)
    lines = (
        Place("EYE", "Eye", "--eye", "--from", "A place on the map; another CRS is reprojected."),
        Lines(
            "TARGETS",
            "Targets",
            "--targets",
            "Points, for lines of sight; without them the viewshed.",
            kind=POINTS,
        ),
    )
    options = (
        number("EYE_HEIGHT", "Height of the eye", "--eye-height", _UP, 0.0, least=0.0),
        number("TARGET_HEIGHT", "Height of targets", "--target-height", _UP, 0.0, least=0.0),
        number(
            "RADIUS",
            "Radius of the viewshed",
            "--radius",
            "In units of the CRS; any distance if empty.",
            least=0.0,
        ),
        switch("CURVATURE", "Mind that the earth is a sphere", "--curvature", "", advanced=True),
        number(
            "REFRACTION",
            "Coefficient of refraction",
            "--sight-refraction",
            "With the earth as a sphere; 0.13 if empty.",
            advanced=True,
        ),
    )

    def add_outputs(self) -> None:
        """Add the layer and the table."""
        self.add_layer_output("Sight", QgsProcessing.TypeVectorAnyGeometry)
        self.add_table_output("A row a class, or a target.")

    def make(self, run: Run) -> dict[str, Any]:
        """Look."""
        style = style_sight_lines if run.parameters.get("TARGETS") else style_viewshed
        return self.make_layer(run, style, "TABLE")
