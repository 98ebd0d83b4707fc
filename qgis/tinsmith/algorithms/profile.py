"""Profiles, cross sections, and plans true to scale."""

from __future__ import annotations

from typing import Any

from qgis.core import (
    QgsProcessing,
    QgsProcessingParameterFile,
    QgsProcessingParameterVectorDestination,
)

from ..inputs import Lines, Surface
from ..options import choice, describe, number, text
from .base import PICTURES, SHEETS, TABLE_FILES, CommandAlgorithm, Run

_SECTIONS = (
    number("SECTION_INTERVAL", "Cross sections: interval", "", "Along the line.", least=0.0),
    number("SECTION_WIDTH", "Cross sections: width", "", "Square to the line.", least=0.0),
)


class ProfileAlgorithm(CommandAlgorithm):
    """Cut one or two surfaces along lines."""

    verb = "profile"
    title = "Profile"
    summary = "Cuts one or two TINs along lines, or square to them."
    explanation = (
        "The table has a row wherever a line crosses an edge of a TIN, with the elevations of all "
        "of them. With an interval and a width of cross sections, these are cut instead; then "
        "they can be written as lines in space, too."
    )
    surfaces = (Surface(), Surface("SECOND", "Second surface", False))
    lines = (
        Lines(
            "LINE", "Lines", "--line", "Where to cut; another CRS is reprojected.", required=True
        ),
    )
    options = (
        number(
            "INTERVAL",
            "Also a row every",
            "--interval",
            "At every multiple of this station.",
            least=0.0,
        ),
        number("START", "Station where a line begins", "--start", "", 0.0, advanced=True),
    )

    def add_outputs(self) -> None:
        """Add sections, tables, pictures and lines."""
        for option in _SECTIONS:
            self.addParameter(option.define())
        self.add_file_output("OUTPUT", "Table", TABLE_FILES, "Stations and elevations.")
        self.add_loading("Load the table")
        self.add_file_output("PICTURE", "Picture", PICTURES, "The profile drawn.", optional=True)
        made = QgsProcessingParameterVectorDestination(
            "SECTIONS", "Cross sections as lines", QgsProcessing.TypeVectorLine, None, True, False
        )
        self.addParameter(describe(made, "Lines in space, of cross sections alone."))
        self.add_file_output("SHEETS", "Sheets", SHEETS, "True to scale.", optional=True)

    def make(self, run: Run) -> dict[str, Any]:
        """Cut."""
        arguments = ["profile", *self._list_surfaces(run), *run.list_lines(self.lines)]
        arguments += [*run.list_options(self.options), *self._list_sections(run)]
        paths, named = run.list_outputs("OUTPUT", "PICTURE", "SECTIONS", "SHEETS")
        run.run([*arguments, *run.list_extra(), *named])
        self.load_later(run, paths["OUTPUT"], "Profile")
        return dict(paths)

    def _list_surfaces(self, run: Run) -> list[str]:
        first, second = self.surfaces
        if self.found[second.name] is None:
            return run.list_surface(first)
        return [*run.list_tin(first), *run.list_tin(second)]

    def _list_sections(self, run: Run) -> list[str]:
        """Return the option of cross sections, whose two numbers stand behind it."""
        given = [part.removeprefix("=") for part in run.list_options(_SECTIONS)]
        return ["--sections", *given] if given else []


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
