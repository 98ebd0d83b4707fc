"""Convert a TIN or points to another format."""

from __future__ import annotations

from typing import Any

from ..inputs import Surface
from ..options import crs
from .base import MESH_FILES, CommandAlgorithm, Run


class ConvertAlgorithm(CommandAlgorithm):
    """Write a TIN or points in another format."""

    verb = "convert"
    title = "Convert TIN"
    summary = "Writes a TIN as a TIN, or points as points, in another format."
    explanation = (
        "The suffix of the output chooses the format: .gpkg, .ply, .nc, .2dm, .xml (LandXML), "
        ".dxf, .12da, .ifc, .14, .gr3, .slf, .obj, .stl, .glb, .geojson, .shp, .fgb, .csv, "
        ".laz and more, as 'tinsmith formats' lists. "
        "A TIN is not reprojected, since its triangles would be no Delaunay triangles there."
    )
    surfaces = (Surface(words="TIN or points"),)
    options = (
        crs("TO_CRS", "Reproject points to", "--to-crs", "The input must name its CRS."),
        crs("CRS", "CRS of an input that names none", "--crs", "Of a file.", advanced=True),
    )

    def add_outputs(self) -> None:
        """Add the file."""
        kinds = MESH_FILES.replace(";;Any", ";;GeoJSON (*.geojson);;Any")
        self.add_file_output("OUTPUT", "Converted", kinds, "Its suffix chooses the format.")
        self.add_loading("Load the result as a layer, where QGIS has one")

    def make(self, run: Run) -> dict[str, Any]:
        """Convert."""
        paths, _ = self.run_command(run, "OUTPUT")
        self.load_later(run, paths["OUTPUT"], "Converted")
        return dict(paths)
