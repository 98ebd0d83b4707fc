"""The words that options take, one list of each: for the library, its checkers and its commands.

Loads nothing: a command names them in its help before any library is there.
"""

from __future__ import annotations

from typing import Literal, TypeAlias

DuplicatePolicy: TypeAlias = Literal["mean", "first", "last", "lowest", "highest", "error"]
"""Which elevation several points at one place get."""

CrossingPolicy: TypeAlias = Literal["split", "error"]
"""Whether lines that cross get a vertex there, or are refused."""

TrimPolicy: TypeAlias = Literal["perimeter", "everywhere"]
"""Where triangles with too long an edge are dropped: from the outside inwards, or everywhere."""

CorrelationModel: TypeAlias = Literal["exponential", "spherical", "gaussian"]
"""How the correlation of errors falls with the distance."""

GroundReturns: TypeAlias = Literal["last", "all"]
"""Which returns of a pulse may be ground."""

BreaklineKind: TypeAlias = Literal["hard", "soft"]
"""Whether a line of edges is a break of the slope."""

LineKind: TypeAlias = Literal["hard", "soft", "boundary", "hole", "water"]
"""What a line in a TIN is."""

LineRole: TypeAlias = Literal["hard", "soft", "boundary", "hole", "erase", "water"]
"""What the line of a survey code becomes."""

CodeKind: TypeAlias = Literal[
    "hard",
    "soft",
    "boundary",
    "hole",
    "erase",
    "water",
    "building",
    "contour",
    "point",
    "exclude",
]
"""What a table of codes says of a code: the line that it makes, or none; "exclude" points are not
for the surface."""

ShotOrder: TypeAlias = Literal["number", "row"]
"""What gives the order of shots along the lines of field codes."""

CodeStyle: TypeAlias = Literal[
    "words",
    "dash",
    "slash",
    "dot",
    "star",
    "star-end",
    "civil3d",
    "carlson",
    "trimble",
    "leica",
    "cg",
]
"""How field codes are written."""

LineReading: TypeAlias = Literal["points", "breaklines"]
"""What the lines of a file of points are taken for: their vertices, or lines of the surface."""

FeatureKind: TypeAlias = Literal["triangles", "points", "edges", "lines", "hull"]
"""What a GeoJSON file shows of a surface."""

EmptyCircleRule: TypeAlias = Literal["angle", "open"]
"""How the paper's rule of the empty circle is read."""

DistanceRule: TypeAlias = Literal["circle", "ties"]
"""Among which points the paper's distance decides."""

FlowProduct: TypeAlias = Literal[
    "paths", "pits", "depressions", "ponds", "ridges", "catchments", "accumulation"
]
"""What is found where water runs on a surface."""

InterpolationMethod: TypeAlias = Literal["linear", "nearest", "laplace", "natural", "c1"]
"""What lies between the vertices of a TIN."""

Extrapolation: TypeAlias = Literal["nearest"]
"""What is taken for the elevation outside a surface."""

PlaneValue: TypeAlias = Literal["slope", "aspect", "hillshade"]
"""What is measured of a plane."""

NeighborhoodValue: TypeAlias = Literal[
    "profile-curvature",
    "plan-curvature",
    "tangential-curvature",
    "mean-curvature",
    "gaussian-curvature",
    "tri",
    "tpi",
    "roughness",
]
"""What is measured of a cell and its eight neighbours, and of no triangle."""

RasterValue: TypeAlias = Literal["elevation", PlaneValue, NeighborhoodValue]
"""What the cells of a raster hold."""

GridOperator: TypeAlias = Literal["horn", "zevenbergen-thorne", "riley", "wilson"]
"""How a value is computed from a cell and its eight neighbours."""

PointRasterValue: TypeAlias = Literal["count", "height"]
"""What the cells of a raster hold of points."""

CellValue: TypeAlias = Literal[RasterValue, PointRasterValue, "canopy"]
"""Either of them, or the surfaces above and below the canopy with its height."""

RasterSample: TypeAlias = Literal["center", "mean"]
"""Whether a cell holds the value at its centre, or the mean over it."""

SlopeUnit: TypeAlias = Literal["degrees", "percent", "ratio"]
"""How a slope is given: as an angle, or as rise over a run of 100 or of 1."""

SurfacePart: TypeAlias = Literal["triangle", "vertex"]
"""Of what a measure of the surface is given."""

OverviewMethod: TypeAlias = Literal["average", "nearest", "none"]
"""How the cells of a raster's smaller copies are found."""

CellType: TypeAlias = Literal[
    "float32", "float64", "int8", "int16", "int32", "uint8", "uint16", "uint32"
]
"""Types of the values of cells, as NumPy and GDAL call them."""

RasterCompression: TypeAlias = Literal["deflate", "none"]
"""How the cells of a GeoTIFF are packed, without loss."""

SimplificationHold: TypeAlias = Literal["points", "surface"]
"""Where simplification keeps within a tolerance: at the points given, or between them too."""

SimplificationSide: TypeAlias = Literal["both", "above", "below"]
"""On which side of the points a simplified surface may lie."""

CurvatureKind: TypeAlias = Literal["profile", "plan", "tangential", "mean", "gaussian"]
"""In which direction a surface is curved."""
OutsidePolicy: TypeAlias = Literal["error", "nan", "cut"]
"""What becomes of parts of features where there is no surface."""

ClippedPart: TypeAlias = Literal["inside", "outside"]
"""Which part of a surface clipping keeps."""

IfcVersion: TypeAlias = Literal["IFC4X3", "IFC4"]
"""The schema of a file of IFC."""

DrawingContent: TypeAlias = Literal["surface", "source", "points"]
"""What is read of a drawing: triangles, the points and lines that make a surface, or points."""

FacePolicy: TypeAlias = Literal["most", "all", "surface"]
"""Which triangles of a mesh are read: all but a few, all, or those that make a surface."""

DrawingVersion: TypeAlias = Literal["R2010", "R12"]
"""Which version of DXF is written."""

Tint: TypeAlias = Literal["elevation", "slope", "aspect", "plain"]
"""What the colours of a surface in 3D tell."""

PaperOrientation: TypeAlias = Literal["landscape", "portrait"]
"""How a sheet of paper lies."""

SheetLayout: TypeAlias = Literal["single", "rows", "strips"]
"""Which ground the sheets of a plan show: all on one, rows of sheets, strips along an axis."""

ContourLabeling: TypeAlias = Literal["index", "all", "none"]
"""Which contours have their elevation written on them."""

GridStyle: TypeAlias = Literal["crosses", "lines", "none"]
"""How the coordinate grid of a plan is drawn."""

TileEncoding: TypeAlias = Literal["terrarium", "mapbox"]
"""How the colours of a tile mean elevations."""

TileGaps: TypeAlias = Literal["lowest", "transparent"]
"""What the pixels of a tile without data show."""

SceneFrame: TypeAlias = Literal["map", "local", "globe"]
"""Where a scene in 3D has its surface."""

WaterFit: TypeAlias = Literal["lowest", "isotonic"]
"""How the level of flowing water follows its banks: never above them, or by least squares."""

FlowDirection: TypeAlias = Literal["guess", "along", "against"]
"""Which way water flows along a centreline: as the banks fall, as it is drawn, or against it."""
