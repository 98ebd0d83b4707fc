"""Small value types that replace bare tuples, and what keeps arrays read-only in them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol, TypeAlias, TypeVar

import numpy as np

from .errors import OptionError

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import ArrayLike

    from .arrays import BoolArray, Float64Array, Int32Array, Int64Array


class SupportsGeoInterface(Protocol):
    """What has geometries as mappings: those of shapely, GeoPandas, and many others."""

    @property
    def __geo_interface__(self) -> Any:
        """As GeoJSON has them."""


GeometriesLike: TypeAlias = "SupportsGeoInterface | Mapping[str, Any]"
PointsLike: TypeAlias = "ArrayLike | SupportsGeoInterface | Mapping[str, Any]"

Array = TypeVar("Array", bound="np.ndarray[Any, Any]")


class Finding(NamedTuple):
    """What was found odd in points, and where.

    Attributes
    ----------
    kind : str
        A few words, the same for each of a kind.
    rows : tuple of int
        Rows of the points, from 0.
    sentence : str
    """

    kind: str
    rows: tuple[int, ...]
    sentence: str

    def to_dict(self) -> dict[str, Any]:
        """Return plain Python values, ready for JSON."""
        return {"kind": self.kind, "rows": list(self.rows), "sentence": self.sentence}


class RowSources(NamedTuple):
    """Where the rows of points come from: files, and lines of text in them.

    Attributes
    ----------
    files : tuple of str
    file_of : (n,) int32 array
        The file of each row, as an index.
    lines : (n,) int64 array
        Its line, counted from 1 as an editor does; 0 where that is not known.
    """

    files: tuple[str, ...]
    file_of: Int32Array
    lines: Int64Array

    @classmethod
    def of_file(cls, name: str, lines: Int64Array) -> RowSources:
        """Return the sources of rows that are lines of one file."""
        return cls((name,), np.zeros(len(lines), np.int32), np.asarray(lines, np.int64))

    @classmethod
    def join(
        cls, parts: Sequence[RowSources | None], names: Sequence[str], counts: Sequence[int]
    ) -> RowSources:
        """Return the sources of the rows of several surveys with these names, one by one."""
        known = [
            part or cls.of_file(name, np.zeros(count, np.int64))
            for part, name, count in zip(parts, names, counts, strict=True)
        ]
        starts = np.cumsum([0, *(len(one.files) for one in known)]).tolist()
        return cls(
            tuple(name for one in known for name in one.files),
            np.concatenate(
                [one.file_of + start for one, start in zip(known, starts, strict=False)]
            ),
            np.concatenate([one.lines for one in known]),
        )

    def take(self, rows: Int64Array | BoolArray) -> RowSources:
        """Return the sources of some rows."""
        return self._replace(file_of=self.file_of[rows], lines=self.lines[rows])

    def find(self, row: int) -> tuple[str, int]:
        """Return file and line of a row; an empty text and 0 if they are not known."""
        if not 0 <= row < len(self.lines):
            return "", 0
        return self.files[int(self.file_of[row])], int(self.lines[row])


@dataclass(frozen=True, slots=True)
class Bounds:
    """An axis-aligned rectangle, in CRS units.

    Attributes
    ----------
    xmin, ymin, xmax, ymax : float
        West, south, east and north limit.

    Examples
    --------
    >>> Bounds(0.0, 0.0, 3.0, 4.0).diagonal
    5.0
    """

    xmin: float
    ymin: float
    xmax: float
    ymax: float

    @classmethod
    def of(cls, points: Float64Array) -> Bounds:
        """Return the bounds of ``points``, an (n, 2) or (n, 3) array with n >= 1.

        Examples
        --------
        >>> Bounds.of(np.array([[0.0, 1.0], [3.0, 5.0]]))
        Bounds(xmin=0.0, ymin=1.0, xmax=3.0, ymax=5.0)
        """
        try:
            xy = np.asarray(points, np.float64)
        except (TypeError, ValueError, OverflowError):
            xy = np.empty(0)
        if xy.ndim != 2 or xy.shape[1] < 2 or len(xy) == 0:
            raise OptionError("points", points, "an (n, 2) or (n, 3) array of one row or more")
        x, y = xy[:, 0], xy[:, 1]  # one after the other: extremes along rows of two are slow
        return cls(float(x.min()), float(y.min()), float(x.max()), float(y.max()))

    @property
    def width(self) -> float:
        """Extent from west to east."""
        return self.xmax - self.xmin

    @property
    def height(self) -> float:
        """Extent from south to north."""
        return self.ymax - self.ymin

    @property
    def diagonal(self) -> float:
        """Length of the diagonal."""
        return float(np.hypot(self.width, self.height))

    @property
    def center(self) -> tuple[float, float]:
        """Easting and northing of the middle."""
        return (self.xmin + self.width / 2, self.ymin + self.height / 2)


@dataclass(frozen=True, slots=True)
class Grid:
    """A regular grid of cells; row 0 is the northernmost.

    Attributes
    ----------
    bounds : Bounds
        Outer edges of the outermost cells.
    shape : tuple of int
        (rows, columns).
    spacing : float
        Side of one square cell, CRS units.

    Examples
    --------
    >>> Grid(Bounds(0.0, 0.0, 3.0, 4.0), shape=(8, 6), spacing=0.5).shape
    (8, 6)
    """

    bounds: Bounds
    shape: tuple[int, int]
    spacing: float


def seal(array: Array) -> Array:
    """Make an array read-only."""
    array.flags.writeable = False
    return array


class Frozen:
    """Base of frozen dataclasses that hold arrays, alone or in named tuples.

    What is computed once and kept in the instance (``cached_property``) is left out of pickles.
    """

    def __post_init__(self) -> None:
        for value in self.__dict__.values():
            if isinstance(value, np.ndarray):
                value.setflags(write=False)
            elif isinstance(value, tuple):
                for array in value:
                    if isinstance(array, np.ndarray):
                        array.setflags(write=False)

    def __getstate__(self) -> dict[str, Any]:
        fields: dict[str, Any] = type(self).__dict__["__dataclass_fields__"]
        return {name: self.__dict__[name] for name in fields}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        Frozen.__post_init__(self)
