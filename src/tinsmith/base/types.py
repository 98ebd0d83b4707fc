"""Small value types that replace bare tuples, and what keeps arrays read-only in them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from operator import index
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


class Affine(NamedTuple):
    """A geotransform in the order of rasterio's ``Affine``.

    Easting is ``a * column + b * row + c``, northing ``d * column + e * row + f``, where whole
    numbers of columns and rows are the corners of cells.
    """

    a: float
    b: float
    c: float
    d: float
    e: float
    f: float

    def apply(self, column: Any, row: Any) -> tuple[Any, Any]:
        """Return easting and northing of places counted in columns and rows."""
        return (
            column * self.a + row * self.b + self.c,
            column * self.d + row * self.e + self.f,
        )

    def invert(self) -> Affine:
        """Return the transform from easting and northing to columns and rows."""
        a, b, c, d, e, f = self
        area = a * e - b * d
        return Affine(
            *(e / area, -b / area, (b * f - c * e) / area),
            *(-d / area, a / area, (c * d - a * f) / area),
        )

    def locate(self, x: Any, y: Any) -> tuple[Any, Any]:
        """Return columns and rows of places, counted from the corner of the first cell."""
        if self.b == 0.0 == self.d:
            return (x - self.c) / self.a, (y - self.f) / self.e
        east, north, area = x - self.c, y - self.f, self.a * self.e - self.b * self.d
        return (
            (self.e * east - self.b * north) / area,
            (self.a * north - self.d * east) / area,
        )


class CellStorage(NamedTuple):
    """How cells are kept in files where nothing else is asked for.

    Attributes
    ----------
    dtype : str
        Such as "float32".
    nodata : float or None
        Value of cells without data; None for that of the raster.
    """

    dtype: str
    nodata: float | None = None


_MOST_DRIFT = 1e-3
"""Of a cell: so much the last cell may be off if cells are said to be square."""


@dataclass(frozen=True, slots=True, repr=False)
class Grid:
    """A regular grid of cells; in the usual one, north up, row 0 is the northernmost.

    Attributes
    ----------
    bounds : Bounds
        Outer edges of the outermost cells; of a rotated or sheared grid the box around them.
    shape : tuple of int
        (rows, columns).
    spacing : float or (float, float)
        Side of a square cell, CRS units; of other cells the lengths of their sides along a row and
        along a column.
    transform : Affine, optional
        Six numbers a, b, c, d, e, f, as rasterio has them: easting is ``a * column + b * row + c``
        and northing ``d * column + e * row + f``. Default north up, from bounds and spacing.

    Examples
    --------
    >>> Grid(Bounds(0.0, 0.0, 3.0, 4.0), shape=(8, 6), spacing=0.5).shape
    (8, 6)
    >>> grid = Grid.of_transform((2.0, 0.0, 10.0, 0.0, 1.0, 20.0), shape=(3, 4))
    >>> grid.bounds, grid.spacing, grid.is_north_up
    (Bounds(xmin=10.0, ymin=20.0, xmax=18.0, ymax=23.0), (2.0, 1.0), False)
    """

    bounds: Bounds
    shape: tuple[int, int]
    spacing: float | tuple[float, float]
    transform: Affine = None  # type: ignore[assignment]  # set below

    def __post_init__(self) -> None:
        if self.transform is None:
            object.__setattr__(self, "transform", self._find_usual_transform())
        elif not isinstance(self.transform, Affine):
            object.__setattr__(self, "transform", as_affine(self.transform))

    @classmethod
    def of_transform(cls, transform: Sequence[float], shape: Sequence[int]) -> Grid:
        """Return the grid of a raster, from its geotransform in the order of rasterio.

        Parameters
        ----------
        transform : six numbers
            a, b, c, d, e, f: cells may be rectangles, rotated or sheared, and rows may run from
            south to north.
        shape : (int, int)
            Rows and columns.

        Raises
        ------
        OptionError
            If numbers are missing or not finite, cells have no area, or there is none.

        Examples
        --------
        >>> turned = Grid.of_transform((0.6, 0.8, 10.0, 0.8, -0.6, 20.0), shape=(3, 4))
        >>> turned.spacing, turned.is_north_up
        (1.0, False)
        """
        affine, (rows, columns) = as_affine(transform), _as_shape(shape)
        x, y = affine.apply(
            np.array([0.0, columns, 0.0, columns]), np.array([0.0, 0.0, rows, rows])
        )
        if not (np.isfinite(x).all() and np.isfinite(y).all()):
            raise OptionError("transform", tuple(transform), "one whose corners are finite")
        bounds = Bounds(float(x.min()), float(y.min()), float(x.max()), float(y.max()))
        return cls(bounds, (rows, columns), _find_spacing(affine, max(rows, columns)), affine)

    @property
    def cell_size(self) -> tuple[float, float]:
        """Lengths of the sides of a cell along a row and along a column."""
        return measure_sides(self.transform)

    @property
    def is_north_up(self) -> bool:
        """Whether rows run to the east, and columns to the south."""
        return self.is_aligned and self.transform.a > 0.0 > self.transform.e

    @property
    def is_aligned(self) -> bool:
        """Whether the sides of cells run along the axes of the CRS, in either direction."""
        return self.transform.b == 0.0 == self.transform.d

    def _find_usual_transform(self) -> Affine:
        size = self.spacing if isinstance(self.spacing, tuple) else (self.spacing, self.spacing)
        try:
            width, height = (float(side) for side in size)
            west, north = float(self.bounds.xmin), float(self.bounds.ymax)
        except (TypeError, ValueError, AttributeError):  # refused where the grid is used
            return Affine(*[float("nan")] * 6)
        return Affine(width, 0.0, west, 0.0, -height, north)

    def __repr__(self) -> str:
        usual = self.transform == self._find_usual_transform()
        more = "" if usual else f", transform={tuple(self.transform)!r}"
        return f"Grid(bounds={self.bounds!r}, shape={self.shape!r}, spacing={self.spacing!r}{more})"


def as_affine(transform: Any) -> Affine:
    """Return a geotransform whose cells have an area.

    Raises OptionError for other things, numbers that are not finite, and a determinant of 0.
    """
    try:
        numbers = [float(number) for number in tuple(transform)[:6]]
    except (TypeError, ValueError, OverflowError):
        numbers = []
    if len(numbers) != 6 or not np.isfinite(numbers).all():
        raise OptionError("transform", transform, "six finite numbers, as rasterio has them")
    affine = Affine(*numbers)
    width, height = measure_sides(affine)
    area = abs(affine.a * affine.e - affine.b * affine.d)
    if not (np.isfinite(area) and area > _LEAST_SINE * width * height > 0.0):
        raise OptionError("transform", tuple(numbers), "one whose cells have an area")
    return affine


def _as_shape(shape: Any) -> tuple[int, int]:
    try:
        rows, columns = (index(side) for side in shape)
    except (TypeError, ValueError):
        rows = columns = 0
    if rows < 1 or columns < 1:
        raise OptionError("shape of the grid", shape, "1 or more rows and columns")
    return rows, columns


_LEAST_SINE = 2.0**-40
"""Of the angle between the sides of a cell, below which rounding leaves no area."""


def measure_sides(affine: Affine) -> tuple[float, float]:
    """Return the lengths of the sides of a cell along a row and along a column."""
    return math.hypot(affine.a, affine.d), math.hypot(affine.b, affine.e)


def _find_spacing(affine: Affine, count: int) -> float | tuple[float, float]:
    """Return the side of cells that are square within a grid of so many; else both sides."""
    width, height = measure_sides(affine)
    slant = abs(affine.a * affine.b + affine.d * affine.e) / width  # of the side of a column
    is_square = max(abs(width - height), slant) * count <= _MOST_DRIFT * width
    return width if is_square else (width, height)


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
