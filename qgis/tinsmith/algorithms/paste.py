"""Put TINs together, or keep a part of one."""

from __future__ import annotations

from typing import Any

from ..inputs import POLYGONS, Lines, Surface
from ..options import number, switch
from .base import CommandAlgorithm, Run


class PasteAlgorithm(CommandAlgorithm):
    """Put one TIN in the place of a part of another."""

    verb = "paste"
    title = "Paste TIN"
    summary = "Puts a TIN in the place of a part of another: a new survey in an old one, a design."
    explanation = (
        "Within the boundary of the patch the surface is that of the patch, elsewhere that of the "
        "base; beyond the base it adds to it. Elevations along the seam are those of the patch; "
        "the log tells by how much they differ."
    )
    surfaces = (Surface("BASE", "Base"), Surface("PATCH", "Patch"))

    def add_outputs(self) -> None:
        """Add the TIN, and counts for models."""
        self.add_mesh_output("Pasted TIN")
        self.add_counts()

    def make(self, run: Run) -> dict[str, Any]:
        """Paste."""
        return self.make_mesh(run, "Pasted TIN")

    def list_inputs(self, run: Run) -> list[str]:
        """Return all arguments but the outputs."""
        base, patch = self.surfaces
        return [self.verb, *run.list_tin(base), *run.list_tin(patch), *run.list_extra()]


class MergeAlgorithm(CommandAlgorithm):
    """Put TINs together to one."""

    verb = "merge"
    title = "Merge TINs"
    summary = "Puts TINs that lie beside each other, or over each other, together to one."
    explanation = (
        "Where they lie over each other the first counts. In the strip along its boundary the "
        "elevations go over into those of the next. The log tells how much they overlap, how far "
        "they are apart along the seam, and of gaps between them, which are left."
    )
    surfaces = (
        Surface("FIRST", "First"),
        Surface("SECOND", "Second"),
        Surface("THIRD", "Third", False),
    )
    options = (
        number("BLEND", "Width of the strip", "--blend", "In units of the CRS.", 0.0, least=0.0),
    )

    def add_outputs(self) -> None:
        """Add the TIN, and counts for models."""
        self.add_mesh_output("Merged TIN")
        self.add_counts()

    def make(self, run: Run) -> dict[str, Any]:
        """Merge."""
        return self.make_mesh(run, "Merged TIN")

    def list_inputs(self, run: Run) -> list[str]:
        """Return all arguments but the outputs."""
        given = [one for one in self.surfaces if self.found[one.name] is not None]
        files = [word for one in given for word in run.list_tin(one)]
        return [self.verb, *files, *run.list_options(self.options), *run.list_extra()]


class CoregisterAlgorithm(CommandAlgorithm):
    """Shift one TIN upon another."""

    verb = "coregister"
    title = "Coregister TIN"
    summary = "Shifts a TIN horizontally and vertically upon another, after Nuth and Kääb."
    explanation = (
        "The shift is found where the ground is the same in both; what has changed has no weight. "
        "The log tells the shift, and how the surfaces differ before and after it. Flat ground, "
        "and ground that slopes to one side alone, do not determine a shift and are refused."
    )
    surfaces = (Surface("SHIFTED", "Surface that is shifted"), Surface("REFERENCE", "Reference"))
    lines = (
        Lines("STABLE", "Stable ground", "--stable", "Where it is the same.", kind=POLYGONS),
        Lines("UNSTABLE", "Unstable ground", "--unstable", "Where it is not.", kind=POLYGONS),
    )
    options = (number("SPACING", "Side of a cell", "--spacing", "In units of the CRS.", least=0.0),)

    def add_outputs(self) -> None:
        """Add the TIN, and counts for models."""
        self.add_mesh_output("Shifted TIN")
        self.add_counts()

    def make(self, run: Run) -> dict[str, Any]:
        """Coregister."""
        return self.make_mesh(run, "Shifted TIN")

    def list_inputs(self, run: Run) -> list[str]:
        """Return all arguments but the outputs."""
        files = [word for one in self.surfaces for word in run.list_tin(one)]
        chosen = [*run.list_lines(self.lines), *run.list_options(self.options)]
        return [self.verb, *files, *chosen, *run.list_extra()]


class ClipAlgorithm(CommandAlgorithm):
    """Keep the part of a TIN inside polygons, or outside them."""

    verb = "clip"
    title = "Clip TIN"
    summary = "Keeps the part of a TIN inside polygons, or outside them, without changing it."
    explanation = (
        "Triangles inside stay as they are, those that a polygon crosses are divided along it; "
        "breaklines end there. The boundary of Build TIN triangulates the points inside anew, so "
        "that the surface changes along it."
    )
    surfaces = (Surface(),)
    lines = (
        Lines("POLYGONS", "Polygons", "--by", "What is clipped by.", kind=POLYGONS, required=True),
    )
    options = (switch("OUTSIDE", "Keep what is outside", "--outside", "In place of the inside."),)

    def add_outputs(self) -> None:
        """Add the TIN, and counts for models."""
        self.add_mesh_output("Clipped TIN")
        self.add_counts()

    def make(self, run: Run) -> dict[str, Any]:
        """Clip."""
        return self.make_mesh(run, "Clipped TIN")
