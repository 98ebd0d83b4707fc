"""Grade a pad into a TIN, or a corridor along an axis; river beds and flowing water."""

from __future__ import annotations

from typing import Any

from qgis.core import QgsProcessingParameterFile

from ..inputs import POLYGONS, Lines, Surface
from ..options import choice, describe, number, switch, text
from .base import CommandAlgorithm, Run

_TABLES = "Tables (*.csv *.txt *.json)"
_RATIO = "Horizontal over vertical: 2 is 2:1."


class GradeAlgorithm(CommandAlgorithm):
    """Grade a pad into the ground."""

    verb = "grade"
    title = "Grade a pad"
    summary = "Grades a pad into a TIN, with side slopes to where they meet the ground."
    explanation = (
        "Slopes rise from the edge of the pad through cuts and fall over fills, to the daylight "
        "line. Cut and fill are told; Cut and fill shows where they are. The pad is the one "
        "polygon of its layer, or the one that is selected. In balance, its elevation is that at "
        "which the cut makes the fill."
    )
    surfaces = (Surface(words="Ground"),)
    lines = (
        Lines("PAD", "Pad", "--pad", "A layer of one polygon.", kind=POLYGONS, required=True),
        Lines(
            "FIXED",
            "Fixed regions",
            "--fixed",
            "The ground stays, or the level in a column z, level, elevation or height.",
            kind=POLYGONS,
            advanced=True,
        ),
    )
    options = (
        number(
            "ELEVATION",
            "Elevation of the pad",
            "--elevation",
            "In the unit of elevations; that of its corners if empty.",
        ),
        number("CUT_SLOPE", "Slope of cuts", "--cut-slope", _RATIO, least=0.0, required=True),
        number("FILL_SLOPE", "Slope of fills", "--fill-slope", _RATIO, least=0.0, required=True),
        text(
            "GRADIENT",
            "Gradient of the pad",
            "--gradient",
            "Rise to the east and to the north, such as 0.02,0; level if empty.",
            advanced=True,
        ),
        switch("BALANCE", "In balance", "--balance", "Find the elevation, in place of giving it."),
        number(
            "SHRINK_FACTOR",
            "Shrink factor",
            "--shrink-factor",
            "Compacted fill that a volume of cut makes; in balance only.",
            default=1.0,
            least=0.0,
        ),
    )

    def add_outputs(self) -> None:
        """Add the TIN, volumes and counts for models."""
        self.add_mesh_output("Graded TIN")
        self.add_numbers({"CUT": "Cut", "FILL": "Fill"})
        self.add_counts()

    def make(self, run: Run) -> dict[str, Any]:
        """Grade."""
        return self.make_mesh(run, "Graded TIN", ("cut", "fill"))


class CorridorAlgorithm(CommandAlgorithm):
    """Carry a cross section along an axis."""

    verb = "corridor"
    title = "Corridor"
    summary = (
        "Carries a cross section along an axis, with side slopes to where they meet the ground."
    )
    explanation = (
        "The axis is a layer of one line in space, whose elevations are the profile; the command "
        "takes alignments of LandXML, too. The template is a text file with a row for each part of "
        "the cross section, from the axis outwards. Cut and fill are told, and in the log the "
        "stations where a bend is sharper than the template is wide."
    )
    surfaces = (Surface(words="Ground"),)
    lines = (Lines("LINE", "Axis", "", "A layer of one line in space.", required=True),)
    options = (
        number("START", "First station", "--start", "From the start of the axis.", advanced=True),
        number("END", "Last station", "--end", "From the start of the axis.", advanced=True),
        number("INTERVAL", "Interval of sections", "--interval", "", least=0.0, advanced=True),
    )

    def add_outputs(self) -> None:
        """Add the template, the TIN, volumes and counts for models."""
        what = QgsProcessingParameterFile.File, "", None
        template = QgsProcessingParameterFile("TEMPLATE", "Template", *what, False, _TABLES)
        words = "A row for each part, from the axis outwards; templates by station have a station."
        self.addParameter(describe(template, words))
        name = "SUPERELEVATION"
        turns = QgsProcessingParameterFile(name, "Superelevation", *what, True, _TABLES)
        words = "Station, left and right: slopes of parts that turn."
        self.addParameter(describe(turns, words, "--superelevation", True))
        self.add_mesh_output("Corridor")
        self.add_numbers({"CUT": "Cut", "FILL": "Fill"})
        self.add_counts()

    def make(self, run: Run) -> dict[str, Any]:
        """Lay out."""
        return self.make_mesh(run, "Corridor", ("cut", "fill"))

    def list_inputs(self, run: Run) -> list[str]:
        """Return all arguments but the outputs."""
        ground, *options = run.list_surface(self.surfaces[0])
        axis = run.list_lines(self.lines)[0].partition("=")[2]
        template = self.parameterAsFile(run.parameters, "TEMPLATE", run.context)
        words = [self.verb, ground, axis, template, *options]
        turns = self.parameterAsFile(run.parameters, "SUPERELEVATION", run.context)
        if turns:
            words.append(f"--superelevation={turns}")
        return [*words, *run.list_options(self.options), *run.list_extra()]


class RiverbedAlgorithm(CommandAlgorithm):
    """Interpolate a river bed between cross sections."""

    verb = "riverbed"
    title = "River bed"
    summary = "Interpolates the bed of a river between cross sections, along the channel."
    explanation = (
        "Sections are lines with elevations, the centreline a layer of one line downstream. "
        "Between two sections elevations are linear along the channel at the same share of the "
        "width, or of each part between ends, banks and thalweg. Surveyed points stay as they are."
    )
    lines = (
        Lines("SECTIONS", "Cross sections", "", "Lines with elevations.", required=True),
        Lines("LINE", "Centreline", "", "A layer of one line.", required=True),
        Lines("BANKS", "Banks", "--banks", "Two lines, which every section crosses."),
        Lines("THALWEG", "Thalweg", "--thalweg", "The line of the deepest flow."),
    )
    options = (
        number(
            "SPACING", "Step along the channel", "--spacing", "At most.", least=0.0, required=True
        ),
        switch("OMIT_RETURNS", "Leave out returns", "--omit-returns", "Of the track of a boat."),
    )

    def add_outputs(self) -> None:
        """Add the TIN, and counts for models."""
        self.add_mesh_output("River bed")
        self.add_counts()

    def make(self, run: Run) -> dict[str, Any]:
        """Interpolate."""
        return self.make_mesh(run, "River bed")

    def list_inputs(self, run: Run) -> list[str]:
        """Return all arguments but the outputs."""
        files = [word.partition("=")[2] for word in run.list_lines(self.lines[:2])]
        chosen = [*run.list_lines(self.lines[2:]), *run.list_options(self.options)]
        return [self.verb, *files, *chosen, *run.list_extra()]


class HydroflattenAlgorithm(CommandAlgorithm):
    """Make flowing water level across, and fall downstream."""

    verb = "hydroflatten"
    title = "Hydro-flatten a stream"
    summary = "Makes a stream level from bank to bank, and fall downstream."
    explanation = (
        "At each station of the centreline the water has one level, nowhere above the ground at "
        "the shore, nor higher than upstream. Build TIN flattens lakes."
    )
    surfaces = (Surface(),)
    lines = (
        Lines("STREAM", "Stream", "--stream", "Islands as holes.", kind=POLYGONS, required=True),
        Lines("CENTRELINE", "Centreline", "--centreline", "Default that in the middle."),
    )
    options = (
        number(
            "SPACING", "Distance of lines across", "--spacing", "At most.", least=0.0, required=True
        ),
        choice("FIT", "Levels", "--fit", "Below the shores, or nearest.", ("lowest", "isotonic")),
        choice(
            "DOWNSTREAM",
            "Downstream",
            "--downstream",
            "As the shores fall, along the centreline, or against it.",
            ("guess", "along", "against"),
        ),
    )

    def add_outputs(self) -> None:
        """Add the TIN, and counts for models."""
        self.add_mesh_output("Flattened TIN")
        self.add_counts()

    def make(self, run: Run) -> dict[str, Any]:
        """Flatten."""
        return self.make_mesh(run, "Flattened TIN")
