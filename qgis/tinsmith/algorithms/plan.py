"""Plans true to scale."""

from __future__ import annotations

from typing import Any

from qgis.core import QgsProcessingParameterFile

from ..inputs import Lines, Surface
from ..options import choice, describe, number, text
from .base import SHEETS, CommandAlgorithm, Run


class PlanAlgorithm(CommandAlgorithm):
    """Draw a surface on sheets of paper."""

    verb = "plan"
    title = "Plan"
    summary = "Draws a scaled plan of a TIN: contours, lines, points, grid, title block, legend."
    explanation = (
        "Without a scale the largest usual one is taken with which everything fits. Rows and "
        "strips are several sheets with match lines and an index: pages of a PDF, or files beside "
        "each other. Other options, such as the text of the grid, go behind the rest."
    )
    surfaces = (Surface(),)
    lines = (Lines("AXIS", "Axis", "--axis", "A layer of one line; strips go along it."),)
    options = (
        text("SCALE", "Scale", "--scale", "Such as 500 for 1:500; default what fits."),
        choice("LAYOUT", "Sheets", "--layout", "", ("single", "rows", "strips")),
        text("PAPER", "Paper", "--paper", "Such as A3, 'ARCH D', or 900x600 in millimetres."),
        number(
            "INTERVAL",
            "Interval of contours",
            "--interval",
            "In the unit of elevations; default a round number.",
            least=0.0,
        ),
        choice(
            "LABELS",
            "Elevations on contours",
            "--labels",
            "On every fifth contour, on all or on none.",
            ("index", "all", "none"),
        ),
        text("POINTS", "Points", "--points", "marks, or some of numbers,elevations,codes."),
        text("SPOTS", "Spot heights", "--spots", "peaks, or the spacing of a grid."),
        choice("GRID", "Grid", "--grid", "", ("crosses", "lines", "none"), advanced=True),
        number(
            "STATION_INTERVAL",
            "Stations of the axis every",
            "--station-interval",
            "",
            least=0.0,
            advanced=True,
        ),
        text("TITLE", "Title", "--title", "Default the name of the surface."),
        text("DATE", "Date", "--date", "As it is to be written.", advanced=True),
    )

    def add_outputs(self) -> None:
        """Add the title block and the drawing."""
        what = QgsProcessingParameterFile.File, "", None
        block = QgsProcessingParameterFile(
            "TITLE_BLOCK", "Title block", *what, True, "TOML file (*.toml)"
        )
        self.addParameter(describe(block, "What the office writes there.", "--title-block", True))
        self.add_file_output("OUTPUT", "Plan", SHEETS, "True to scale.")

    def make(self, run: Run) -> dict[str, Any]:
        """Draw."""
        block = self.parameterAsFile(run.parameters, "TITLE_BLOCK", run.context)
        chosen = [f"--title-block={block}"] if block else []
        paths, _ = self.run_command(run, "OUTPUT", chosen=chosen)
        return dict(paths)
