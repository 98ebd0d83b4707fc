"""The commands by subject, each with its line in the help, which loads none of them."""

from __future__ import annotations

__all__ = ["SECTIONS", "SUMMARIES"]

SECTIONS = {
    "Surfaces": {
        "build": "Build a TIN from elevation points.",
        "info": "Describe a file of points or a TIN.",
        "check": "Check that a TIN is sound and Delaunay.",
        "inspect": "Check points for blunders.",
        "view": "Show a TIN in 3D: in a window, as a page, as a picture.",
        "compare": "Compare the paper's algorithms with the exact kernel.",
        "refine": "Make a finite element mesh of a TIN.",
        "simplify": "Leave out points that a TIN within a tolerance can do without.",
        "grade": "Grade a pad into a TIN, with side slopes to where they meet it.",
        "paste": "Put one TIN in the place of a part of another.",
        "ground": "Tell the ground from buildings, plants and noise.",
        "edit": "Change a TIN by a script of edits.",
        "convert": "Write points or a TIN in another format.",
        "formats": "List the formats that can be read and written.",
    },
    "Products": {
        "contours": "Draw contour lines, bands or labels of a TIN.",
        "slope": "Divide a TIN into classes of slope or aspect.",
        "hillshade": "Shade a TIN by the light of a low sun, as a raster.",
        "profile": "Cut surfaces along a line: tables, cross sections, a picture.",
        "volume": "Measure cut and fill, or how much a pond holds.",
        "diff": "Subtract one surface from another: TIN, zones, statistics, map.",
        "drape": "Lay points, lines or polygons on a TIN.",
        "interpolate": "Find the elevations of a surface at the points of a CSV file.",
        "raster": "Turn a surface into a raster: elevation, slope, aspect, hillshade.",
        "flow": "Find flow paths, catchments, pits, depressions, ponds and ridges.",
        "sight": "Find what is seen from where: lines of sight, viewsheds.",
        "plan": "Draw a plan on paper, true to scale: PDF, SVG, PNG.",
    },
    "Shell": {
        "completion": "Write the script by which a shell completes commands and options.",
    },
}

SUMMARIES = {name: summary for commands in SECTIONS.values() for name, summary in commands.items()}
