"""Where water runs on a TIN, and where it stands."""

from __future__ import annotations

from typing import Any

from qgis.core import QgsProcessing

from ..inputs import POINTS, Lines, Surface
from ..options import choice, number, switch
from ..styles import (
    style_catchments,
    style_channels,
    style_paths,
    style_pits,
    style_ridges,
    style_water,
)
from .base import CommandAlgorithm, Run

_PRODUCTS = {
    "depressions": style_water,
    "paths": style_paths,
    "pits": style_pits,
    "ponds": style_water,
    "ridges": style_ridges,
    "catchments": style_catchments,
    "accumulation": style_channels,
}


class FlowAlgorithm(CommandAlgorithm):
    """Find flow paths, catchments, pits, depressions, ponds and ridges."""

    verb = "flow"
    title = "Flow and ponds"
    summary = "Finds where water runs on a TIN, and where it stands, exactly."
    explanation = (
        "Paths of drops from places that you give, pits, depressions with the water they hold, "
        "ponds at a level, edges that are ridges or valleys, catchments of pits or of outlets, "
        "the area that drains through each channel. Water leaves the surface freely at its "
        "boundary. Lengths and areas are in units of the CRS."
    )
    surfaces = (Surface(),)
    lines = (
        Lines(
            "PLACES",
            "Places where drops fall, or outlets",
            "--points",
            "For paths, which need them, and for catchments; another CRS is reprojected.",
            kind=POINTS,
        ),
    )
    options = (
        choice("FIND", "Find", "--find", "What is made.", tuple(_PRODUCTS)),
        number("LEVEL", "Level of the water", "--level", "For ponds, which need it: an elevation."),
        number(
            "MIN_DEPTH",
            "Least depth",
            "--min-depth",
            "Of depressions, in the unit of elevations.",
            least=0.0,
        ),
        switch("NESTED", "Also nested ones", "--nested", "Depressions in larger ones."),
        number("MIN_ANGLE", "Least angle", "--min-angle", "Of ridges, in degrees.", least=0.0),
        number("MIN_AREA", "Least area", "--min-area", "That drains through a channel.", least=0.0),
    )

    def add_outputs(self) -> None:
        """Add the layer and the table."""
        self.add_layer_output("Flow", QgsProcessing.TypeVectorAnyGeometry)
        self.add_table_output("A row a feature.")

    def make(self, run: Run) -> dict[str, Any]:
        """Find."""
        product = self.parameterAsEnumString(run.parameters, "FIND", run.context) or "depressions"
        return self.make_layer(run, _PRODUCTS[product], "TABLE")
