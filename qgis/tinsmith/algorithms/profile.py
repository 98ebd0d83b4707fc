"""Profiles and cross sections."""

from __future__ import annotations

from typing import Any

from qgis.core import QgsProcessing, QgsProcessingParameterVectorDestination

from ..inputs import Lines, Surface
from ..options import describe, number
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
