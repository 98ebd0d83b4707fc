"""A surface as a raster."""

from __future__ import annotations

from typing import Any

from qgis.core import QgsProcessingParameterRasterDestination, QgsProcessingParameterRasterLayer

from ..inputs import Surface, find_raster
from ..options import choice, describe, interpolation, number, switch
from ..styles import style_hillshade, style_raster
from .base import CommandAlgorithm, Run


class RasterAlgorithm(CommandAlgorithm):
    """Turn a TIN into a raster."""

    verb = "raster"
    title = "Raster of a TIN"
    summary = "Turns a TIN into a raster of elevation, slope, aspect, hillshade or curvature."
    explanation = (
        "Give the side of a cell, or a raster whose cells are taken. Cells outside the surface "
        "have no data. The raster may be larger than memory."
    )
    surfaces = (Surface(),)
    options = (
        number("SPACING", "Side of a cell", "--spacing", "In units of the CRS.", least=0.0),
        choice(
            "VALUE",
            "What the cells hold",
            "--value",
            "Slope and aspect in degrees, hillshade from 1 to 255. Of each cell and its neighbours "
            "curvatures, ruggedness (tri), topographic position (tpi) and roughness. Of points "
            "also their count in a cell, how high the highest is above the ground, and (canopy) "
            "three bands: the surface of the highest, the ground, and the height between.",
            (
                "elevation",
                "slope",
                "aspect",
                "hillshade",
                "profile-curvature",
                "plan-curvature",
                "tangential-curvature",
                "mean-curvature",
                "gaussian-curvature",
                "tri",
                "tpi",
                "roughness",
                "count",
                "height",
                "canopy",
            ),
        ),
        choice(
            "OPERATOR",
            "Computed of neighbouring cells",
            "--operator",
            "Slope, aspect and hillshade by Horn or Zevenbergen and Thorne, as gdaldem has them, "
            "in place of those of the surface; ruggedness by Riley or Wilson.",
            ("as usual", "horn", "zevenbergen-thorne", "riley", "wilson"),
            advanced=True,
        ),
        switch(
            "FIND_GROUND",
            "Find the ground among the points",
            "--find-ground",
            "For height and canopy, where no class of the points is chosen.",
        ),
        switch(
            "COMPUTE_EDGES",
            "Compute edges",
            "--compute-edges",
            "Values of cells and their neighbours also at the rim and beside cells without data.",
            advanced=True,
        ),
        interpolation(),
        choice(
            "AT",
            "Value of a cell",
            "--at",
            "That at its centre, or the mean over it.",
            ("center", "mean"),
            advanced=True,
        ),
        number("AZIMUTH", "Azimuth of the light", "--azimuth", "Degrees.", 315.0, advanced=True),
        number("ALTITUDE", "Altitude of the light", "--altitude", "Degrees.", 45.0, advanced=True),
    )

    def add_outputs(self) -> None:
        """Add the raster whose cells are taken, and the one that is made."""
        like = QgsProcessingParameterRasterLayer("LIKE", "or a raster with the cells", None, True)
        self.addParameter(describe(like, "Its cells are taken.", "--like"))
        made = QgsProcessingParameterRasterDestination("OUTPUT", "Raster")
        self.addParameter(describe(made, "GeoTIFF, or ASC."))

    def look(self, parameters: dict[str, Any], context: Any) -> None:
        """Find the surface, and the raster whose cells are taken."""
        super().look(parameters, context)
        self._like = ""
        if parameters.get("LIKE"):
            self._like = find_raster(self, parameters, "LIKE", context).path

    def make(self, run: Run) -> dict[str, Any]:
        """Rasterize."""
        like = [f"--like={self._like}"] if self._like else []
        is_light = self.parameterAsEnumString(run.parameters, "VALUE", run.context) == "hillshade"
        return self.make_layer(run, style_hillshade if is_light else style_raster, chosen=like)
