"""Grade a pad into a TIN."""

from __future__ import annotations

from typing import Any

from ..inputs import POLYGONS, Lines, Surface
from ..options import number, switch, text
from .base import CommandAlgorithm, Run

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
    lines = (Lines("PAD", "Pad", "--pad", "A layer of one polygon.", kind=POLYGONS, required=True),)
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
