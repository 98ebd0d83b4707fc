"""Elevations of a surface: along features of a layer, and at points."""

from __future__ import annotations

from typing import Any

from qgis.core import QgsProcessing, QgsProcessingException

from ..inputs import Lines, PointTable, Surface
from ..options import choice, crs, file, interpolation, text
from .base import TABLE_FILES, CommandAlgorithm, Run


class DrapeAlgorithm(CommandAlgorithm):
    """Drape the features of a layer on a surface."""

    verb = "drape"
    title = "Drape on TIN"
    summary = "Drapes points, lines or polygons on a TIN: they get its elevations as Z."
    explanation = (
        "Lines and polygons get a vertex wherever they cross an edge of the TIN, so that they lie "
        "on it everywhere; columns are kept. Z that they have is replaced. A layer in another CRS "
        "is reprojected to that of the TIN."
    )
    surfaces = (Surface(),)
    lines = (
        Lines(
            "FEATURES",
            "Points, lines or polygons",
            "",
            "The layer that is draped.",
            kind=QgsProcessing.TypeVectorAnyGeometry,
            required=True,
        ),
    )
    options = (
        choice(
            "OUTSIDE",
            "Parts outside the surface",
            "--outside",
            "An error, vertices without an elevation (nan), or left out (cut; not of polygons).",
            ("error", "nan", "cut"),
        ),
    )

    def add_outputs(self) -> None:
        """Add the draped layer."""
        self.add_layer_output("Draped", QgsProcessing.TypeVectorAnyGeometry)

    def make(self, run: Run) -> dict[str, Any]:
        """Drape."""
        paths, _ = self.run_command(run, "OUTPUT")
        return dict(paths)

    def list_inputs(self, run: Run) -> list[str]:
        """Return all arguments but the outputs: the layer is no option, but the second file."""
        surface, *reading = run.list_surface(self.surfaces[0])
        features = run.list_lines(self.lines)[0].partition("=")[2]
        options = [*reading, *run.list_options(self.options), *run.list_extra()]
        return [self.verb, surface, features, *options]


class InterpolateAlgorithm(CommandAlgorithm):
    """Interpolate elevations of a surface at points."""

    verb = "interpolate"
    title = "Interpolate at points"
    summary = "Interpolates elevations of a TIN at the points of a layer, or of a CSV file."
    explanation = (
        "The table has a row for each point with all its columns, and the elevation in a new one; "
        "that of a layer begins with the coordinates and is loaded as points. Points outside the "
        "surface have no elevation, unless that of its nearest point is asked for. Drape on TIN "
        "makes points with Z."
    )
    surfaces = (Surface(),)
    lines = (PointTable("AT", "Points", "--at", "Another CRS is reprojected."),)
    options = (
        file(
            "AT_FILE",
            "or a CSV file of points",
            "--at",
            "Its first line names the columns, all of which are kept.",
            "CSV table (*.csv *.txt *.tsv)",
        ),
        crs(
            "AT_CRS",
            "CRS of the points of the file",
            "--at-crs",
            "That of the surface if empty.",
            advanced=True,
        ),
        interpolation(),
        choice(
            "EXTRAPOLATE",
            "Outside the surface",
            "--extrapolate",
            "No elevation, or that of the nearest point of the surface.",
            ("no elevation", "nearest"),
        ),
        text("COLUMN", "Name of the new column", "--column", "elevation if empty.", advanced=True),
    )

    def add_outputs(self) -> None:
        """Add the table, and counts for models."""
        self.add_file_output("OUTPUT", "Elevations", TABLE_FILES, "A row for each point.")
        self.add_loading("Load the table")
        self.add_numbers({"COUNT": "Points", "OUTSIDE": "Points outside the surface"})

    def look(self, parameters: dict[str, Any], context: Any) -> None:
        """Find the surface; points come from a layer or from a file."""
        super().look(parameters, context)
        has_layer = bool(parameters.get("AT"))
        has_file = bool(self.parameterAsFile(parameters, "AT_FILE", context))
        if has_layer == has_file:
            what = "a layer and a file are given, choose one of them"
            what = what if has_layer else "choose a layer or a file"
            raise QgsProcessingException(f"Points: {what}.")
        if has_layer and self.parameterAsCrs(parameters, "AT_CRS", context).isValid():
            raise QgsProcessingException(
                "CRS of the points of the file: the points are a layer, whose CRS is taken."
            )

    def make(self, run: Run) -> dict[str, Any]:
        """Interpolate."""
        paths, record = self.run_command(run, "OUTPUT")
        (points,) = self.lines
        place = points.find_place(self, run.parameters, run.context)
        self.load_later(run, paths["OUTPUT"], "Elevations", place=place)
        return {**paths, "COUNT": record["points"], "OUTSIDE": record["outside"]}
