"""Points that look like blunders."""

from __future__ import annotations

from typing import Any

from qgis.core import QgsProcessing

from ..inputs import Lines, Surface
from ..results import style_on_loading
from ..styles import style_suspects
from .base import PICTURES, CommandAlgorithm, Run


class InspectAlgorithm(CommandAlgorithm):
    """Check points for blunders."""

    verb = "inspect"
    title = "Inspect points"
    summary = "Finds points that look like blunders, and says why."
    explanation = (
        "Each point is compared with the surface that the others make without it. Told are spikes "
        "and pits, elevations that stand for none, factors of ten and of feet, swapped axes, "
        "points far from all others, point numbers and places that occur twice, and lines that "
        "cross at different heights. Nothing is changed."
    )
    surfaces = (Surface(words="Points"),)
    lines = (
        Lines(
            "BREAKLINES",
            "Breaklines",
            "--breaklines",
            "Lines of the surface: a kerb or a wall is no blunder.",
            advanced=True,
        ),
    )

    def add_outputs(self) -> None:
        """Add the layer, the table, the map, and the number of findings."""
        self.add_layer_output("Suspects", QgsProcessing.TypeVectorPoint)
        self.add_table_output("A row a finding.")
        self.add_file_output("PICTURE", "Map", PICTURES, "The points drawn.", optional=True)
        self.add_numbers({"SUSPECTS": "Findings"})

    def make(self, run: Run) -> dict[str, Any]:
        """Check."""
        paths, record = self.run_command(run, "OUTPUT", "TABLE", "PICTURE")
        style_on_loading(paths["OUTPUT"], style_suspects, run.context)
        return {**paths, "SUSPECTS": len(record["blunders"])}
