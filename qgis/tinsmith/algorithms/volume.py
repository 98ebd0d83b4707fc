"""Volumes: cut and fill, the difference of two surfaces, and what a pond holds."""

from __future__ import annotations

from typing import Any

from qgis.core import (
    QgsProcessing,
    QgsProcessingOutputNumber,
    QgsProcessingParameterVectorDestination,
)

from ..inputs import POLYGONS, Lines, Surface
from ..options import Option, describe, number, text
from ..results import style_on_loading
from ..styles import style_difference, style_earthwork
from .base import PICTURES, REPORTS, TABLE_FILES, CommandAlgorithm, Run

_MEASURED = {"CUT": "cut", "FILL": "fill", "NET": "net", "AREA": "area"}
_DIFFERS = {"CUT": "Cut", "FILL": "Fill", "MEAN": "Mean", "RMS": "Root mean square"}
_GROUND = Surface(words="Ground")
_ERROR = "A number in the unit of elevations, or the column of the points that has it."


def _list_errors(first: str, name: str, second: str) -> tuple[Option, ...]:
    """Return the options of errors, of a first surface and, by a name of its own, a second."""
    return (
        text("ERROR", f"Standard error of the {first}", "--standard-error", _ERROR),
        text(name, f"Standard error of the {second}", "--other-standard-error", _ERROR),
        number(
            "RANGE",
            "Range of correlated errors",
            "--correlation-range",
            "Distance over which errors of points are correlated; independent if empty.",
            least=0.0,
            advanced=True,
        ),
        number(
            "SYSTEMATIC",
            f"Systematic error of the {first}",
            "--systematic",
            f"Standard error of a shift of the whole {first}.",
            least=0.0,
            advanced=True,
        ),
        number(
            "LEVEL_OF_DETECTION",
            "Level of detection",
            "--level-of-detection",
            "Difference up to which the surface counts as unchanged.",
            least=0.0,
        ),
        number(
            "CONFIDENCE",
            "or its confidence",
            "--confidence",
            "Such as 0.95: the level is computed from the standard errors.",
            least=0.0,
        ),
    )


class VolumeAlgorithm(CommandAlgorithm):
    """Measure cut and fill."""

    verb = "volume"
    title = "Cut and fill"
    summary = "Measures cut and fill from the ground to a design, or to a level."
    explanation = (
        "Both triangulations are overlaid, exactly. Fill is where the design, or the level, is "
        "above the ground, cut where it is below; net is fill less cut. With regions there is a "
        "row for each in the table. With the standard errors of elevations volumes get theirs. "
        "What differs by no more than the level of detection is unchanged in zones and map."
    )
    surfaces = (_GROUND, Surface("DESIGN", "Design", False))
    lines = (Lines("REGIONS", "Regions", "--regions", "Polygons to measure in.", kind=POLYGONS),)
    options = (
        number("BASE", "or a level", "--base", "Elevation in place of a design."),
        *_list_errors("ground", "DESIGN_ERROR", "design"),
    )

    def add_outputs(self) -> None:
        """Add the table, the zones, a map, a report, and sums for models."""
        self.add_file_output("OUTPUT", "Volumes", TABLE_FILES, "A row a region.")
        self.add_loading("Load the table")
        self.addParameter(_define_zones())
        self.add_file_output("PICTURE", "Map", PICTURES, "Cut and fill drawn.", optional=True)
        self.add_file_output("REPORT", "Report", REPORTS, "On paper, to sign.", optional=True)
        for name, word in _MEASURED.items():
            self.addOutput(QgsProcessingOutputNumber(name, word.capitalize()))

    def make(self, run: Run) -> dict[str, Any]:
        """Measure."""
        paths, named = run.list_outputs("OUTPUT", "ZONES", "PICTURE", "REPORT")
        arguments = ["volume", *self._list_surfaces(run), *run.list_lines(self.lines)]
        arguments += [*run.list_options(self.options), *run.list_extra(), *named]
        rows = run.run(arguments)["rows"]
        self.load_later(run, paths["OUTPUT"], "Volumes")
        if "ZONES" in paths:
            style_on_loading(paths["ZONES"], style_earthwork, run.context)
        sums = {name: sum(row[word] for row in rows) for name, word in _MEASURED.items()}
        return {**paths, **sums}

    def _list_surfaces(self, run: Run) -> list[str]:
        ground, design = self.surfaces
        if self.found[design.name] is None:
            return run.list_surface(ground)
        return [*run.list_tin(ground), *run.list_tin(design)]


class DifferenceAlgorithm(CommandAlgorithm):
    """Subtract one surface from another."""

    verb = "diff"
    title = "Difference of TINs"
    summary = "Subtracts the surface before from that after, exactly, where both exist."
    explanation = (
        "The difference is a TIN, whose elevations are above 0 where the surface after is higher: "
        "a later survey less an earlier one, or a design less the ground. The mesh is colored from "
        "cut to fill, white where nothing has changed. The table has statistics weighted by area: "
        "mean, root mean square, quantiles, NMAD. With a level of detection, or standard errors "
        "and a confidence, what differs by no more is unchanged in zones and map."
    )
    surfaces = (Surface("BEFORE", "Before"), Surface("AFTER", "After"))
    options = _list_errors("surface before", "AFTER_ERROR", "surface after")

    def add_outputs(self) -> None:
        """Add the difference, the zones, statistics, a map, and numbers for models."""
        self.add_mesh_output("Difference")
        self.addParameter(_define_zones())
        self.add_table_output("Statistics, weighted by area.")
        self.add_file_output("PICTURE", "Map", PICTURES, "Cut and fill drawn.", optional=True)
        self.add_numbers(_DIFFERS)
        self.add_counts()

    def make(self, run: Run) -> dict[str, Any]:
        """Subtract."""
        paths, record = self.run_command(run, "OUTPUT", "ZONES", "TABLE", "PICTURE")
        self.load_later(run, paths["OUTPUT"], "Difference", style_difference)
        if "ZONES" in paths:
            style_on_loading(paths["ZONES"], style_earthwork, run.context)
        told = {**record, **record["statistics"]}
        names = (*_DIFFERS, "VERTICES", "TRIANGLES")
        return {**paths, **{name: told[name.lower()] for name in names}}

    def list_inputs(self, run: Run) -> list[str]:
        """Return all arguments but the outputs."""
        files = [word for one in self.surfaces for word in run.list_tin(one)]
        return [self.verb, *files, *run.list_options(self.options), *run.list_extra()]


def _define_zones() -> Any:
    """Return the output of zones, which is not made unless it is named."""
    made = QgsProcessingParameterVectorDestination(
        "ZONES", "Zones of cut and fill", QgsProcessing.TypeVectorPolygon, None, True, True
    )
    return describe(made, "Polygons of what is cut and what is filled.")


class StorageAlgorithm(CommandAlgorithm):
    """Tabulate what a pond holds at each level."""

    verb = "volume"
    title = "Stage-storage table"
    summary = "Tabulates area and volume of the water that stands on a TIN at each level."
    explanation = "Rows whose water reaches the boundary are marked: there it would run off."
    surfaces = (_GROUND,)
    lines = (Lines("REGIONS", "Region", "--regions", "Where water stands.", kind=POLYGONS),)
    options = (
        number("LEVEL", "Level", "--level", "Elevation of one row."),
        number("INTERVAL", "or a row at multiples of", "--interval", "Of this height.", least=0.0),
    )

    def name(self) -> str:
        return "stagestorage"

    def add_outputs(self) -> None:
        """Add the table."""
        self.add_file_output("OUTPUT", "Stages", TABLE_FILES, "A row a level.")
        self.add_loading("Load the table")

    def make(self, run: Run) -> dict[str, Any]:
        """Tabulate."""
        paths, _ = self.run_command(run, "OUTPUT", chosen=["--stage-storage"])
        self.load_later(run, paths["OUTPUT"], "Stages")
        return dict(paths)
