"""Refine a TIN, or simplify it."""

from __future__ import annotations

from typing import Any

from ..inputs import POINTS, Lines, Surface
from ..options import choice, number
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


class SimplifyAlgorithm(CommandAlgorithm):
    """Leave out points that a TIN can do without."""

    verb = "simplify"
    title = "Simplify TIN"
    summary = "Leaves out points of a TIN, or of a DEM, that the surface can do without."
    explanation = (
        "None of the points is farther than the tolerance from the new surface in elevation. "
        "Boundary, holes, breaklines and water stay; voids of a DEM stay voids."
    )
    surfaces = (Surface(),)
    lines = (
        Lines(
            "KEEP",
            "Points that stay",
            "--keep",
            "Such as benchmarks: each must be one of the surface.",
            kind=POINTS,
            advanced=True,
        ),
    )
    options = (
        number(
            "TOLERANCE",
            "Tolerance",
            "--tolerance",
            "Farthest that a point may be above or below, in the unit of elevations.",
            least=0.0,
        ),
        choice(
            "SIDE",
            "Where the surface may lie",
            "--side",
            "Above: nowhere below a point, such as a sea bed for navigation; below: nowhere above.",
            ("both", "above", "below"),
            advanced=True,
        ),
        number("POINTS", "or so many points", "--points", "That are left.", least=3, integer=True),
    )

    def add_outputs(self) -> None:
        """Add the TIN, and counts for models."""
        self.add_mesh_output("Simplified TIN")
        self.add_counts()

    def make(self, run: Run) -> dict[str, Any]:
        """Simplify."""
        return self.make_mesh(run, "Simplified TIN")
