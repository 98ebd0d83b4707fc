"""Volumes between cross sections with mass haul, and points to set out."""

from __future__ import annotations

from typing import Any

from qgis.core import QgsProcessing, QgsProcessingParameterVectorDestination

from ..inputs import POINTS, Lines, Surface
from ..options import describe, number, switch, text
from .base import PICTURES, SHEETS, TABLE_FILES, CommandAlgorithm, Run


class SectionsAlgorithm(CommandAlgorithm):
    """Measure cut and fill section by section along an axis."""

    verb = "sections"
    title = "Section volumes and mass haul"
    summary = "Measures cut and fill between two surfaces, section by section along an axis."
    explanation = (
        "Each section has its areas; from one to the next there are the volumes between both "
        "surfaces, those of the mean areas and of Simpson's rule, then the ordinate of mass haul. "
        "The axis is a layer of one line; the command takes alignments of LandXML, too."
    )
    surfaces = (Surface(words="Ground"), Surface("DESIGN", "Design"))
    lines = (Lines("LINE", "Axis", "--line", "A layer of one line.", required=True),)
    options = (
        number(
            "INTERVAL",
            "Interval of sections",
            "--interval",
            "Along the axis.",
            least=0.0,
            required=True,
        ),
        number(
            "WIDTH",
            "Width of sections",
            "--width",
            "Half of it to either side.",
            least=0.0,
            required=True,
        ),
        number("START", "Station where the axis begins", "--start", "", 0.0, advanced=True),
        number(
            "SHRINK", "Compacted fill of a volume of cut", "--shrink-factor", "", 1.0, least=0.0
        ),
        number("SWELL", "Loose volume of a volume of cut", "--swell-factor", "", 1.0, least=0.0),
    )

    def add_outputs(self) -> None:
        """Add the table, the diagram and the drawn sections."""
        self.add_file_output("OUTPUT", "Table", TABLE_FILES, "A row for each section.")
        self.add_loading("Load the table")
        self.add_file_output("PICTURE", "Mass haul", PICTURES, "The diagram.", optional=True)
        self.add_file_output("SHEETS", "Section sheets", SHEETS, "True to scale.", optional=True)

    def make(self, run: Run) -> dict[str, Any]:
        """Measure."""
        files = [word for one in self.surfaces for word in run.list_tin(one)]
        arguments = ["sections", *files, *run.list_lines(self.lines)]
        paths, named = run.list_outputs("OUTPUT", "PICTURE", "SHEETS")
        run.run([*arguments, *run.list_options(self.options), *run.list_extra(), *named])
        self.load_later(run, paths["OUTPUT"], "Section volumes")
        return dict(paths)


class StakeoutAlgorithm(CommandAlgorithm):
    """List design elevations, cut and fill at points."""

    verb = "stakeout"
    title = "Stakeout"
    summary = "Lists points to set out: elevations of a design, cut and fill, stations and offsets."
    explanation = (
        "Each point of a layer gets the elevation of the design; with the ground cut and fill, "
        "with an axis its station and offset. A point beyond the design stays in the list, and is "
        "named with the reason. The command sets out points along alignments, too."
    )
    surfaces = (Surface(words="Design"), Surface("GROUND", "Ground", False))
    lines = (
        Lines("POINTS", "Points", "--at", "A layer.", kind=POINTS, required=True),
        Lines("LINE", "Axis", "--line", "A layer of one line: for stations and offsets."),
    )
    options = (
        text("LAYOUT", "Columns by letters", "--layout", "Such as PNEZDCF; default all."),
        switch("TO_GROUND", "Coordinates on the ground", "--to-ground", "", advanced=True),
    )

    def add_outputs(self) -> None:
        """Add the list and the points."""
        self.add_file_output("OUTPUT", "List", TABLE_FILES, "A row for each point.")
        self.add_loading("Load the list")
        made = QgsProcessingParameterVectorDestination(
            "LAYER", "Points to set out", QgsProcessing.TypeVectorPoint, None, True, True
        )
        self.addParameter(describe(made, "The points at the elevations of the design."))

    def make(self, run: Run) -> dict[str, Any]:
        """List."""
        design, ground = self.surfaces
        arguments = ["stakeout", *run.list_tin(design), *run.list_lines(self.lines)]
        if self.found[ground.name] is not None:
            arguments += ["--ground", *run.list_tin(ground)]
        paths, named = run.list_outputs("OUTPUT", "LAYER")
        run.run([*arguments, *run.list_options(self.options), *run.list_extra(), *named])
        self.load_later(run, paths["OUTPUT"], "Stakeout")
        return dict(paths)
