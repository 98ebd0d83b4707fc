"""What a LandXML file holds, as it stands in it: northing before easting, ids as written."""

from __future__ import annotations

from array import array
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any
from xml.sax.saxutils import quoteattr

import numpy as np

if TYPE_CHECKING:
    from ....base.arrays import Float64Array, Int64Array

FEATURE = "tinsmith"
"""Name of such a feature."""

ELEVATION_UNIT = "elevationUnit"
"""Of the CRS: ``UNKNOWN`` if the unit of elevations is not known."""

UNKNOWN = "unknown"
KIND = "kind"
"""Of a line: what it is, where that is no hard breakline."""

PRIORITY = "priority"
LINE = "line"
"""Of a line: which line of its TIN it is."""

SOURCE = "source"
"""Of a line: the line that it comes from, counted as in a TIN."""


SPIRALS = {
    "clothoid": "clothoid",
    "bloss": "bloss",
    "revBloss": "bloss",
    "cosine": "cosine",
    "revCosine": "cosine",
    "sinusoid": "sinusoid",
    "revSinusoid": "sinusoid",
    "biquadratic": "biquadratic",
    "revBiquadratic": "biquadratic",
    "cubic": "cubic parabola",
    "cubicParabola": "cubic parabola",
    "japaneseCubic": "cubic parabola",
    "sineHalfWave": "sine half-wave",
}
"""Types of spirals, and what they are called here; the first of a kind is written."""


@dataclass(slots=True, eq=False)
class Line:
    """A breakline, boundary or contour."""

    element: str
    """One of "Breakline", "Boundary", "Contour" and "DataPoints"."""
    attributes: dict[str, str]
    line: int
    """Of the file."""
    coordinates: list[Float64Array] = field(default_factory=list)
    """Each (k, 2) or (k, 3), northing, easting, and elevation where there is one; a list for each
    PntList.
    """
    properties: dict[str, str] = field(default_factory=dict)
    """Of its ``Feature``."""


@dataclass(slots=True, eq=False)
class Surface:
    """A surface: its definition and its source data."""

    name: str
    number: int
    """In the file, from 1."""
    line: int
    kind: str = ""
    """``surfType``, "" without a definition."""
    ids: list[Int64Array] = field(default_factory=list)
    """Each (n,)."""
    points: list[Float64Array] = field(default_factory=list)
    """Each (n, 3), northing, easting, elevation; NaN in a row that refers to a survey point."""
    references: dict[int, str] = field(default_factory=dict)
    """The survey point by name that a row refers to."""
    faces: list[Int64Array] = field(default_factory=list)
    """Each (m, 3), ids of the visible faces."""
    sides: array[int] = field(default_factory=lambda: array("B"))
    """The sides of each visible face that are breaklines, one bit each."""
    n_hidden: int = 0
    n_visible: int = 0
    lines: list[Line] = field(default_factory=list)
    chains: list[tuple[str, dict[str, str], int]] = field(default_factory=list)
    """Names of survey points that lines join, attributes and line of the file."""
    point_files: list[str] = field(default_factory=list)
    n_walls: int = 0
    """Retaining walls."""
    is_kept: bool = True
    """Whether points and faces are gathered."""

    @property
    def has_source(self) -> bool:
        """Whether there are source data with coordinates."""
        return any(line.coordinates for line in self.lines) or bool(self.chains)

    @property
    def label(self) -> str:
        """What sentences call it."""
        return f"'{self.name}'" if self.name else f"number {self.number}, without a name"


@dataclass(slots=True)
class Points:
    """The survey points."""

    coordinates: array[float] = field(default_factory=lambda: array("d"))
    """Northing, easting, elevation, one after the other; NaN for what is missing."""
    names: list[str] = field(default_factory=list)
    descriptions: list[str] = field(default_factory=list)
    codes: list[str] = field(default_factory=list)
    groups: list[str] = field(default_factory=list)
    states: list[str] = field(default_factory=list)
    references: dict[int, str] = field(default_factory=dict)
    """The point by name that a row refers to."""
    excluded: set[int] = field(default_factory=set)
    """Rows that are marked as not for a surface."""

    def __len__(self) -> int:
        return len(self.names)

    @property
    def rows(self) -> Float64Array:
        """Northing, easting, elevation of each."""
        return np.array(self.coordinates, np.float64).reshape(-1, 3)


@dataclass(slots=True)
class Content:
    """A whole file."""

    version: str = ""
    units: list[tuple[str, dict[str, Any]]] = field(default_factory=list)
    """Either "Metric" or "Imperial" with its attributes, as often as they stand there."""
    system: dict[str, str] = field(default_factory=dict)
    """Attributes of ``CoordinateSystem``."""
    system_properties: dict[str, str] = field(default_factory=dict)
    """Of its ``Feature``."""
    surfaces: list[Surface] = field(default_factory=list)
    points: Points = field(default_factory=Points)
    others: dict[str, int] = field(default_factory=dict)
    """How many elements there are of each kind that is not read, such as plan features."""


def quote(text: str) -> str:
    """Return a text as the value of an attribute, without letters that XML does not have."""
    plain = "".join(one if one.isprintable() else " " for one in text)
    return quoteattr(plain.encode("utf-8", "replace").decode("utf-8"))
