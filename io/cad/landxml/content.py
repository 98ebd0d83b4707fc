"""What a LandXML file holds, as it stands in it: northing before easting, ids as written."""

from __future__ import annotations

from array import array
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from ....arrays import Float64Array, Int64Array

__all__ = ["Content", "Line", "Points", "Surface"]


@dataclass(slots=True, eq=False)
class Line:
    """A breakline, boundary or contour.

    Attributes
    ----------
    element : str
        "Breakline", "Boundary", "Contour" or "DataPoints".
    attributes : dict of str to str
    line : int
        Of the file.
    coordinates : list of (k, 2) or (k, 3) arrays
        Northing, easting, and elevation where there is one; a list for each PntList.
    properties : dict of str to str
        Of its ``Feature``.
    """

    element: str
    attributes: dict[str, str]
    line: int
    coordinates: list[Float64Array] = field(default_factory=list)
    properties: dict[str, str] = field(default_factory=dict)


@dataclass(slots=True, eq=False)
class Surface:
    """A surface: its definition and its source data.

    Attributes
    ----------
    name : str
    number : int
        In the file, from 1.
    line : int
    kind : str
        ``surfType``, "" without a definition.
    ids : list of (n,) int64 arrays
    points : list of (n, 3) float64 arrays
        Northing, easting, elevation; NaN in a row that refers to a survey point.
    references : dict of int to str
        The survey point by name that a row refers to.
    faces : list of (m, 3) int64 arrays
        Ids of the visible faces.
    sides : array of unsigned bytes
        The sides of each visible face that are breaklines, one bit each.
    n_faces, n_hidden, n_visible : int
    lines : list of Line
    chains : list of (str, dict, int)
        Names of survey points that lines join, attributes and line of the file.
    point_files : list of str
    n_walls : int
        Retaining walls.
    is_kept : bool
        Whether points and faces are gathered.
    """

    name: str
    number: int
    line: int
    kind: str = ""
    ids: list[Int64Array] = field(default_factory=list)
    points: list[Float64Array] = field(default_factory=list)
    references: dict[int, str] = field(default_factory=dict)
    faces: list[Int64Array] = field(default_factory=list)
    sides: array[int] = field(default_factory=lambda: array("B"))
    n_hidden: int = 0
    n_visible: int = 0
    lines: list[Line] = field(default_factory=list)
    chains: list[tuple[str, dict[str, str], int]] = field(default_factory=list)
    point_files: list[str] = field(default_factory=list)
    n_walls: int = 0
    is_kept: bool = True

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
    """The survey points.

    Attributes
    ----------
    coordinates : array of double
        Northing, easting, elevation, one after the other; NaN for what is missing.
    names, descriptions, codes, groups, states : list of str
    references : dict of int to str
        The point by name that a row refers to.
    excluded : set of int
        Rows that are marked as not for a surface.
    """

    coordinates: array[float] = field(default_factory=lambda: array("d"))
    names: list[str] = field(default_factory=list)
    descriptions: list[str] = field(default_factory=list)
    codes: list[str] = field(default_factory=list)
    groups: list[str] = field(default_factory=list)
    states: list[str] = field(default_factory=list)
    references: dict[int, str] = field(default_factory=dict)
    excluded: set[int] = field(default_factory=set)

    def __len__(self) -> int:
        return len(self.names)

    @property
    def rows(self) -> Float64Array:
        """Northing, easting, elevation of each."""
        return np.array(self.coordinates, np.float64).reshape(-1, 3)


@dataclass(slots=True)
class Content:
    """A whole file.

    Attributes
    ----------
    version : str
    units : list of (str, dict)
        "Metric" or "Imperial" with its attributes, as often as they stand there.
    system : dict of str to str
        Attributes of ``CoordinateSystem``.
    system_properties : dict of str to str
        Of its ``Feature``.
    surfaces : list of Surface
    points : Points
    others : dict of str to int
        How many elements there are of each kind that is not read, such as plan features.
    """

    version: str = ""
    units: list[tuple[str, dict[str, Any]]] = field(default_factory=list)
    system: dict[str, str] = field(default_factory=dict)
    system_properties: dict[str, str] = field(default_factory=dict)
    surfaces: list[Surface] = field(default_factory=list)
    points: Points = field(default_factory=Points)
    others: dict[str, int] = field(default_factory=dict)
