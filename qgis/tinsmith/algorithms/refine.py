"""Refine a TIN."""

from __future__ import annotations

from typing import Any

from ..inputs import Surface
from ..options import number
from .base import CommandAlgorithm, Run


class RefineAlgorithm(CommandAlgorithm):
    """Add points to a TIN until its triangles are good."""

    verb = "refine"
    title = "Refine TIN"
    summary = "Adds points to a TIN until its triangles are good: a mesh for finite elements."
    explanation = (
        "Boundary, holes and breaklines stay, and the new points lie on the surface. Write .2dm "
        "or .nc for hydraulic models. Lengths and areas are in units of the CRS."
    )
    surfaces = (Surface(),)
    options = (
        number("MIN_ANGLE", "Least angle", "--min-angle", "In degrees, up to 33.", 25.0, least=0.0),
        number("MAX_AREA", "Largest triangle", "--max-area", "Its area.", least=0.0),
        number("MAX_SIDE", "Longest side", "--max-side", "Of a triangle.", least=0.0),
    )

    def add_outputs(self) -> None:
        """Add the mesh, and counts for models."""
        self.add_mesh_output("Refined TIN")
        self.add_counts()

    def make(self, run: Run) -> dict[str, Any]:
        """Refine."""
        return self.make_mesh(run, "Refined TIN")
