"""The commands by subject, each with its line in the help, which loads none of them."""

from __future__ import annotations

SECTIONS = {
    "Surfaces": {
        "build": "Build a TIN from elevation points.",
        "info": "Describe a file of points or a TIN.",
        "check": "Check that a TIN is valid and Delaunay.",
        "inspect": "Check points for blunders.",
        "view": "Show a TIN in 3D: window, page or picture.",
        "compare": "Compare the paper's algorithms with the exact kernel.",
        "refine": "Make a finite element mesh of a TIN.",
        "simplify": "Leave out points of a TIN or raster within a tolerance.",
        "grade": "Grade a pad into a TIN, with side slopes to the daylight line.",
        "corridor": "Carry a cross section along an axis, with side slopes to the ground.",
        "paste": "Replace a part of one TIN by another.",
        "merge": "Put TINs beside and over each other together, by priority.",
        "clip": "Keep the part of a TIN inside polygons, or outside.",
        "coregister": "Shift a TIN horizontally and vertically upon another.",
        "ground": "Classify ground, other points and low noise of lidar.",
        "edit": "Edit a TIN by a script.",
        "convert": "Write points or a TIN in another format.",
        "formats": "List the formats that can be read and written.",
    },
    "Products": {
        "contours": "Draw contour lines, bands or labels of a TIN.",
        "slope": "Divide a TIN into classes of slope or aspect.",
        "hillshade": "Write a hillshade raster of a TIN.",
        "profile": "Compute profiles and cross sections: tables, 3D lines, pictures.",
        "alignment": "Describe an alignment; stations and offsets of points.",
        "sections": "Compute volumes between cross sections, and mass haul.",
        "stakeout": "List points to set out: elevations, cut and fill, stations.",
        "volume": "Compute cut and fill, or stage-storage tables of ponds.",
        "diff": "Subtract one surface from another: TIN, zones, statistics, map.",
        "drape": "Drape points, lines or polygons on a TIN.",
        "interpolate": "Interpolate elevations at the points of a CSV file.",
        "raster": "Rasterize a TIN or points: elevation, slope, curvature, canopy.",
        "flow": "Find flow paths, catchments, pits, depressions, ponds and ridges.",
        "sight": "Compute lines of sight and viewsheds.",
        "plan": "Draw a scaled plan: PDF, SVG, PNG.",
    },
    "Rivers": {
        "riverbed": "Interpolate a river bed between cross sections, along the channel.",
        "hydroflatten": "Make a stream level from bank to bank, and fall downstream.",
    },
    "Shell": {
        "completion": "Write the completion script of a shell.",
    },
}

FOLDERS = {name: heading.lower() for heading, commands in SECTIONS.items() for name in commands}
"""Of each command the folder of its module, which has the name of its subject."""

SUMMARIES = {name: summary for commands in SECTIONS.values() for name, summary in commands.items()}
