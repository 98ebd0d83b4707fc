"""Build a TIN."""

from __future__ import annotations

from typing import Any

from qgis.core import (
    QgsProcessing,
    QgsProcessingException,
    QgsProcessingParameterFeatureSource,
    QgsProcessingParameterField,
    QgsProcessingParameterFile,
    QgsProcessingParameterRasterLayer,
)

from ..inputs import ANY_FILE, POLYGONS, Found, Lines, find_raster, list_point_arguments
from ..options import choice, crs, describe, elevation_unit, number, switch
from .base import CommandAlgorithm, Run

_STRIDE = number(
    "STRIDE",
    "DEM: take every Nth cell",
    "--stride",
    "In each direction.",
    default=1,
    least=1,
    integer=True,
    advanced=True,
)


class BuildAlgorithm(CommandAlgorithm):
    """Build the TIN of points or of a DEM, with lines."""

    verb = "build"
    title = "Build TIN"
    summary = "Builds the exact Delaunay TIN of elevation points, with breaklines and a boundary."
    explanation = (
        "Points come from a layer (selected features, if you wish), from a DEM, or from a file "
        "that is no layer, such as survey text or lidar. Elevations are the Z of the geometry or "
        "a field. Breaklines become edges of the surface; lines without Z are draped on it. "
        "Columns kind, priority and name of lines are honoured. Points in another CRS are "
        "reprojected, lines too; a TIN in degrees is refused: choose a projected CRS. Every row "
        "that is merged or left out is told in the log and in the report."
    )
    lines = (
        Lines(
            "BREAKLINES",
            "Breaklines",
            "--breaklines",
            "Lines that must be edges of the surface.",
        ),
        Lines(
            "SOFT_BREAKLINES",
            "Soft breaklines",
            "--soft-breaklines",
            "Lines that are edges but no breaks of slope.",
            advanced=True,
        ),
        Lines("BOUNDARY", "Boundary", "--boundary", "The surface ends there.", kind=POLYGONS),
        Lines("HOLES", "Holes", "--holes", "No surface inside.", kind=POLYGONS, advanced=True),
        Lines(
            "ERASE",
            "Areas to erase",
            "--erase",
            "Points inside are left out and spanned.",
            kind=POLYGONS,
            advanced=True,
        ),
        Lines("WATER", "Water", "--water", "Flat polygons.", kind=POLYGONS, advanced=True),
    )
    options = (
        number(
            "WATER_Z",
            "Height of the water",
            "--water-z",
            "Where the polygons have no Z.",
            advanced=True,
        ),
        switch(
            "DRAPE",
            "Take the heights of lines from the surface",
            "--drape",
            "Also of lines that have Z.",
            advanced=True,
        ),
        number(
            "WALLS",
            "Walls: lines this far apart",
            "--walls",
            "Of breaklines along one line with two heights the lower one is put this far aside.",
            least=0.0,
            advanced=True,
        ),
        crs(
            "CRS",
            "CRS of the TIN",
            "--crs",
            "Points in another CRS are reprojected; points without one are taken to be in this.",
        ),
        elevation_unit(),
        choice(
            "DUPLICATES",
            "Elevation where points share a place",
            "--duplicates",
            "'error' refuses such points.",
            ("mean", "first", "last", "lowest", "highest", "error"),
            advanced=True,
        ),
        number(
            "SNAP",
            "Merge points closer than",
            "--snap",
            "In units of the CRS; no point moves by more.",
            default=0.0,
            least=0.0,
            advanced=True,
        ),
        number(
            "MAX_EDGE",
            "Longest edge along the outside",
            "--max-edge",
            "Triangles with longer ones are dropped from the outside inwards; units of the CRS.",
            least=0.0,
        ),
        switch(
            "CODES",
            "Make lines of the points' codes",
            "--codes",
            "Of survey text, such as EP1 BEG, EP1, EP1 END.",
            advanced=True,
        ),
    )

    def add_inputs(self) -> None:
        """Add the three sources of points, of which one is needed."""
        points = QgsProcessingParameterFeatureSource(
            "POINTS", "Points", [QgsProcessing.TypeVectorPoint], None, True
        )
        column = QgsProcessingParameterField(
            "POINTS_Z_FIELD",
            "Field of elevations",
            None,
            "POINTS",
            QgsProcessingParameterField.Any,
            False,
            True,
        )
        dem = QgsProcessingParameterRasterLayer("DEM", "or a DEM", None, True)
        file = QgsProcessingParameterFile(
            "FILE", "or a file of points", QgsProcessingParameterFile.File, "", None, True, ANY_FILE
        )
        help_text = "Survey text, instruments, lidar, LandXML, DXF: what is no layer of QGIS."
        self.addParameter(
            describe(points, "A layer of points; selected features alone, if so set.")
        )
        self.addParameter(
            describe(column, "Without it the Z of the geometry is taken.", "--z-field")
        )
        self.addParameter(describe(dem, "A raster of elevations."))
        self.addParameter(describe(file, help_text))
        self.addParameter(_STRIDE.define())

    def add_outputs(self) -> None:
        """Add the TIN, its report, and counts for models."""
        self.add_mesh_output("TIN")
        help_text = (
            "Accounts for every row that is merged or left out, and every crossing of lines."
        )
        self.add_file_output("REPORT", "Report", "JSON (*.json)", help_text, optional=True)
        self.add_counts()

    def look(self, parameters: dict[str, Any], context: Any) -> None:
        """Find the one source of points that is given."""
        given = [name for name in ("POINTS", "DEM", "FILE") if parameters.get(name)]
        if len(given) != 1:
            raise QgsProcessingException(
                "One of these is needed: a layer of points, a DEM, or a file of points; "
                f"{' and '.join(given) or 'none'} given."
            )
        found = Found(source="POINTS")
        if given == ["DEM"]:
            found = find_raster(self, parameters, "DEM", context)
        elif given == ["FILE"]:
            found = Found(path=self.parameterAsFile(parameters, "FILE", context))
        self.found = {"POINTS": found}

    def make(self, run: Run) -> dict[str, Any]:
        """Build."""
        arguments = ["build", *self._list_points(run)]
        arguments += [*run.list_lines(self.lines), *run.list_options(self.options)]
        report = run.name_output("REPORT")
        if report:
            arguments.append(f"--report={report}")
        paths, named = run.list_outputs("OUTPUT")
        result = run.run([*arguments, *run.list_extra(), *named])
        self.load_later(run, paths["OUTPUT"], "TIN")
        counts = result["tin"]
        outputs = {"OUTPUT": paths["OUTPUT"]}
        outputs |= {"VERTICES": counts["vertices"], "TRIANGLES": counts["triangles"]}
        return {**outputs, "REPORT": report} if report else outputs

    def _list_points(self, run: Run) -> list[str]:
        found = self.found["POINTS"]
        assert found is not None
        if found.source:
            return list_point_arguments(
                self, run.parameters, "POINTS", run.context, run.files, run.feedback
            )
        is_dem = bool(run.parameters.get("DEM"))
        stride = run.list_options((_STRIDE,)) if is_dem else []
        own_crs = [f"--crs={found.crs}"] if found.crs and not run.parameters.get("CRS") else []
        return [found.path, *stride, *own_crs]
