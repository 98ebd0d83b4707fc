"""The points on the ground, told from buildings, plants and noise."""

from __future__ import annotations

from typing import Any

from qgis.core import QgsProcessing

from ..inputs import Surface
from ..options import number, switch
from ..results import style_on_loading
from ..styles import style_ground
from .base import CommandAlgorithm, Run

_CLASSES = {"GROUND": "ground", "OTHERS": "others", "NOISE": "low noise"}


def _parameter(name: str, words: str, help_text: str, default: float) -> Any:
    """Return the option for a number that is seldom changed."""
    flag = f"--{name.lower().replace('_', '-')}"
    return number(name, words, flag, help_text, default, least=0.0, advanced=True)


class GroundAlgorithm(CommandAlgorithm):
    """Find the ground among points."""

    verb = "ground"
    title = "Ground points"
    summary = "Tells the ground from buildings, plants and noise among points of lidar or photos."
    explanation = (
        "By progressive densification of a TIN. Give a LAS or LAZ file as the file, or a layer of "
        "points. The points of the ground are loaded; all points with their classes (2 ground, 1 "
        "others, 7 low noise) go to LAS and LAZ files. Parameters are in metres, whatever the CRS."
    )
    surfaces = (Surface(words="Points", is_mesh=False),)
    options = (
        number(
            "BUILDING",
            "Width of the largest building",
            "--building",
            "In metres.",
            40.0,
            least=0.0,
        ),
        _parameter("CELL", "Side of a cell", "Metres; the lowest point of each is a seed.", 1.0),
        _parameter(
            "TERRAIN_SLOPE", "Slope of seeds", "Rise per length that needs no second look.", 0.12
        ),
        _parameter("ITERATION_ANGLE", "Largest angle", "Degrees, at the nearest corner.", 20.0),
        _parameter(
            "ITERATION_DISTANCE", "Largest distance", "Metres from the plane of the triangle.", 1.4
        ),
        _parameter(
            "EDGE_LENGTH", "Length of edges", "Metres; in smaller triangles angles are less.", 5.0
        ),
        _parameter("TOLERANCE", "Tolerance", "Metres above the surface that are ground.", 0.3),
        _parameter(
            "HORIZONTAL_TOLERANCE",
            "Horizontal tolerance",
            "Metres; times the slope it is added to the tolerance.",
            1.0,
        ),
        _parameter("NOISE_DEPTH", "Depth of noise", "Metres below all points around.", 1.0),
        switch(
            "ANY_RETURN",
            "Any return may be ground",
            "--any-return",
            "Not the last of its pulse alone.",
            advanced=True,
        ),
    )

    def add_outputs(self) -> None:
        """Add the points of the ground, all points with classes, and counts for models."""
        self.add_layer_output("Ground points", QgsProcessing.TypeVectorPoint)
        self.add_file_output(
            "CLASSIFIED",
            "All points with classes",
            "LAZ (*.laz);;LAS (*.las)",
            "With their attributes.",
            optional=True,
        )
        self.add_numbers({name: f"Points: {words}" for name, words in _CLASSES.items()})

    def make(self, run: Run) -> dict[str, Any]:
        """Classify."""
        paths, record = self.run_command(run, "OUTPUT", "CLASSIFIED", chosen=["--as-points"])
        style_on_loading(paths["OUTPUT"], style_ground, run.context)
        counts = record["classes"]
        return {**paths, **{name: counts.get(key, 0) for name, key in _CLASSES.items()}}
