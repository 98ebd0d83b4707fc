"""Features: points, lines or polygons with columns, as coordinates and offsets."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal, TypeAlias, TypedDict, Unpack

import numpy as np

from ..checks import as_floats, is_collection
from ..crs import CRS, Unit, require_one_unit, shorten_crs
from ..errors import OptionError
from ..notes import as_notes
from ..ranges import require_degrees
from ..sentences import counted
from ..types import Bounds
from .columns import Noted, as_columns, as_name, as_units, frozen_copy

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import ArrayLike

    from ..arrays import AnyArray, Float64Array, Int64Array, ObjectArray
    from ..crs import CrsLike, UnitLike
    from .columns import Units

Kind: TypeAlias = Literal["points", "lines", "polygons"]
_LEVELS: dict[Kind, int] = {"points": 0, "lines": 1, "polygons": 2}
_NAMES = {"points": "Point", "lines": "LineString", "polygons": "Polygon"}
_PARTS = {"points": "points", "lines": "lines", "polygons": "rings"}
_LEAST = {"lines": 2, "polygons": 4}
"""Points of a line, and of a closed ring with its first point repeated."""


class FeatureKeywords(TypedDict, total=False):
    """The keywords of :meth:`Features.of_points` and its like: fields of Features."""

    columns: Mapping[str, ArrayLike] | None
    units: Units | None
    crs: CrsLike | None
    elevation_unit: UnitLike | None
    name: str
    notes: Sequence[str]


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class Features(Noted):
    """Points, lines or polygons derived from a surface, with columns and units.

    Made by :meth:`of_points`, :meth:`of_lines` and :meth:`of_polygons`. Nothing in it can be
    changed; arrays that are read-only already are taken without a copy.

    Attributes
    ----------
    kind : {"points", "lines", "polygons"}
    coordinates : (n, 2) or (n, 3) float64 array
        Easting and northing in CRS units, elevation in ``elevation_unit``; NaN for an elevation
        that is not known.
    offsets : tuple of int64 arrays
        From the smallest pieces to features: none for points; for lines ``(offsets,)``, for
        polygons ``(ring_offsets, polygon_offsets)``, and one more where features have several
        parts. Piece ``k`` of a level is ``[offsets[k]:offsets[k + 1]]`` of the level below.
    columns : mapping of str to (n_features,) array
    units : mapping of str to Unit, str or None
        Of columns: a unit or its symbol, None if it is not known; a column without an entry has no
        unit.
    crs : CRS or None
    elevation_unit : Unit or None
        None if it is not known.
    name : str
        Of the product, for layers and captions.
    notes : tuple of str
        What was assumed or left out, in sentences.

    Examples
    --------
    >>> import tinsmith as ts
    >>> line = [[0, 0, 5], [4, 0, 5], [4, 3, 5]]
    >>> features = ts.Features.of_lines(
    ...     line, [0, 3], columns={"elevation": [5.0]}, units={"elevation": "m"}, crs="EPSG:32616"
    ... )
    >>> features
    <Features: 1 line, columns elevation, crs EPSG:32616>
    """

    kind: Kind
    coordinates: Float64Array
    offsets: tuple[Int64Array, ...] = ()
    columns: Mapping[str, AnyArray] = field(default_factory=dict)
    units: Units = field(default_factory=dict)
    crs: CRS | None = None
    elevation_unit: Unit | None = None
    name: str = ""
    notes: Sequence[str] = ()

    def __post_init__(self) -> None:
        keep = object.__setattr__
        keep(self, "coordinates", _as_coordinates(self.coordinates))
        keep(self, "offsets", _as_levels(self.kind, self.offsets, len(self.coordinates)))
        if self.kind == "polygons":
            _require_closed(self.coordinates, self.offsets[0])
        keep(self, "columns", as_columns(self.columns, len(self), "feature"))
        keep(self, "units", as_units(self.units, self.columns))
        crs = CRS.of(self.crs)
        require_degrees(self.coordinates, crs, "Coordinates")
        keep(self, "crs", crs)
        keep(self, "elevation_unit", require_one_unit(crs, Unit.of(self.elevation_unit)))
        keep(self, "name", as_name(self.name))
        keep(self, "notes", as_notes(self.notes))

    # ------------------------------------------------------------------ made of arrays

    @classmethod
    def of_points(
        cls,
        coordinates: ArrayLike,
        **options: Unpack[FeatureKeywords],
    ) -> Features:
        """Return points as features.

        Parameters
        ----------
        coordinates : (n, 2) or (n, 3) array
        columns : mapping of str to (n,) array, optional
        units : mapping of str to Unit, str or None, optional
        crs : CRS, str, int or pyproj.CRS, optional
        elevation_unit : Unit or str, optional
        name : str, optional
        notes : sequence of str, optional

        Raises
        ------
        OptionError
            If shapes do not fit, coordinates are not finite, or a unit or name is none.
        CrsError
            If the CRS is not known.

        Examples
        --------
        >>> import tinsmith as ts
        >>> ts.Features.of_points([[0, 0], [4, 3]], columns={"label": ["a", "b"]})
        <Features: 2 points, columns label, crs unknown>
        """
        return cls._of("points", coordinates, (), options)

    @classmethod
    def of_lines(
        cls,
        coordinates: ArrayLike,
        offsets: ArrayLike,
        feature_offsets: ArrayLike | None = None,
        **options: Unpack[FeatureKeywords],
    ) -> Features:
        """Return polylines as features.

        Parameters
        ----------
        coordinates : (n, 2) or (n, 3) array
        offsets : (k + 1,) array of int
            Line i is ``coordinates[offsets[i]:offsets[i + 1]]``, at least two points.
        feature_offsets : (m + 1,) array of int, optional
            Feature i has the lines ``feature_offsets[i]`` up to ``feature_offsets[i + 1]``; default
            one line a feature.
        columns, units, crs, elevation_unit, name, notes
            As in :meth:`of_points`.

        Raises
        ------
        OptionError, CrsError
            As :meth:`of_points`.

        Examples
        --------
        >>> import tinsmith as ts
        >>> ts.Features.of_lines([[0, 0], [1, 0], [1, 1], [2, 2]], [0, 2, 4], [0, 2])
        <Features: 1 feature of 2 lines, crs unknown>
        """
        return cls._of("lines", coordinates, (offsets, feature_offsets), options)

    @classmethod
    def of_polygons(
        cls,
        coordinates: ArrayLike,
        ring_offsets: ArrayLike,
        polygon_offsets: ArrayLike,
        feature_offsets: ArrayLike | None = None,
        **options: Unpack[FeatureKeywords],
    ) -> Features:
        """Return polygons as features.

        Parameters
        ----------
        coordinates : (n, 2) or (n, 3) array
        ring_offsets : (r + 1,) array of int
            Ring j is ``coordinates[ring_offsets[j]:ring_offsets[j + 1]]``, its first point repeated
            at the end.
        polygon_offsets : (k + 1,) array of int
            Polygon i has the rings ``polygon_offsets[i]`` up to ``polygon_offsets[i + 1]``: first
            the exterior, counter-clockwise, then holes, clockwise.
        feature_offsets : (m + 1,) array of int, optional
            Feature i has the polygons ``feature_offsets[i]`` up to ``feature_offsets[i + 1]``;
            default one polygon a feature.
        columns, units, crs, elevation_unit, name, notes
            As in :meth:`of_points`.

        Raises
        ------
        OptionError, CrsError
            As :meth:`of_points`.

        Examples
        --------
        >>> import tinsmith as ts
        >>> ring = [[0, 0], [4, 0], [0, 3], [0, 0]]
        >>> ts.Features.of_polygons(ring, [0, 4], [0, 1])
        <Features: 1 polygon, crs unknown>
        """
        return cls._of(
            "polygons", coordinates, (ring_offsets, polygon_offsets, feature_offsets), options
        )

    @classmethod
    def _of(
        cls, kind: Kind, coordinates: Any, offsets: tuple[Any, ...], options: FeatureKeywords
    ) -> Features:
        given: dict[str, Any] = {name: one for name, one in options.items() if one is not None}
        levels = tuple(level for level in offsets if level is not None)
        return cls(kind=kind, coordinates=coordinates, offsets=levels, **given)

    # ------------------------------------------------------------------ what it is

    @property
    def has_elevations(self) -> bool:
        """Whether coordinates have elevations."""
        return int(self.coordinates.shape[1]) == 3

    @property
    def is_multi(self) -> bool:
        """Whether features have several parts each, or may have."""
        return len(self.offsets) > _LEVELS[self.kind]

    @property
    def geometry_type(self) -> str:
        """Name of the geometries in GeoJSON and GIS: "LineString", "MultiPolygon"."""
        return ("Multi" if self.is_multi else "") + _NAMES[self.kind]

    @property
    def bounds(self) -> Bounds:
        """Bounds of the coordinates (at least one feature)."""
        return Bounds.of(self.coordinates)

    def __len__(self) -> int:
        return len(self.offsets[-1]) - 1 if self.offsets else len(self.coordinates)

    def __repr__(self) -> str:
        names = f", columns {', '.join(self.columns)}" if self.columns else ""
        title = f" {self.name}" if self.name else ""
        return f"<Features{title}: {self._count()}{names}, crs {shorten_crs(self.crs)}>"

    def _count(self) -> str:
        noun = self.kind[:-1]
        if not self.is_multi:
            return counted(len(self), noun)
        return f"{counted(len(self), 'feature')} of {counted(len(self.offsets[-2]) - 1, noun)}"

    # ------------------------------------------------------------------ other libraries

    def to_shapely(self) -> ObjectArray:
        """Return the geometries of shapely.

        Returns
        -------
        (n_features,) array of shapely.Geometry

        Examples
        --------
        >>> import tinsmith as ts
        >>> ts.Features.of_points([[1, 2, 3]]).to_shapely()[0].wkt
        'POINT Z (1 2 3)'
        """
        from .geometries import build_geometries

        return build_geometries(self)

    def to_geodataframe(self) -> Any:
        """Return a GeoDataFrame with the columns, geometries and CRS.

        Returns
        -------
        geopandas.GeoDataFrame
            Its ``attrs`` have ``name``, ``units``, ``elevation_unit`` and ``notes``.

        Raises
        ------
        MissingExtraError
            If geopandas is not installed.
        OptionError
            If a column is called ``geometry``.

        Examples
        --------
        >>> import tinsmith as ts
        >>> points = ts.Features.of_points([[1, 2, 3]], columns={"label": ["a"]}, crs="EPSG:32616")
        >>> points.to_geodataframe().crs.to_epsg()
        32616
        """
        from .geometries import build_frame

        return build_frame(self)

    @property
    def __geo_interface__(self) -> dict[str, Any]:
        """The features as GeoJSON-like values, in their own CRS."""
        from .geometries import build_collection

        return build_collection(self)

    def __arrow_c_stream__(self, requested_schema: object | None = None) -> object:
        """Return the features as a stream of Arrow, geometries as GeoArrow (needs pyarrow).

        GeoPandas, Polars, DuckDB, lonboard and pyarrow take an object that has this.
        """
        from .arrow import build_table

        stream: object = build_table(self).__arrow_c_stream__(requested_schema)
        return stream


# ------------------------------------------------------------------------ validation


def _as_coordinates(given: Any) -> Float64Array:
    array = as_floats(given)
    if array is None:
        raise OptionError(
            "coordinates", type(given).__name__, allowed="a table of numbers with equal rows"
        )
    if array.size == 0 and array.ndim == 1:
        array = np.empty((0, 2))
    if array.ndim != 2 or array.shape[1] not in (2, 3):
        raise OptionError("shape of coordinates", array.shape, allowed="(n, 2) or (n, 3)")
    if np.isfinite(array).all():
        return frozen_copy(array)
    bad = ~np.isfinite(array[:, :2]).all(axis=1) | np.isinf(array[:, 2:]).any(axis=1)
    if bad.any():
        row = int(bad.argmax())
        raise OptionError(
            f"row {row} of coordinates",
            tuple(array[row].tolist()),
            allowed="finite (an elevation may be NaN where it is not known)",
        )
    return frozen_copy(array)


def _as_levels(kind: Any, levels: Any, count: int) -> tuple[Int64Array, ...]:
    """Return the offsets of every level, each of which must cover the level below."""
    if not isinstance(kind, str) or kind not in _LEVELS:
        raise OptionError("kind", kind, allowed="one of points, lines, polygons")
    if not isinstance(levels, tuple | list | np.ndarray) or not is_collection(levels):
        raise OptionError("offsets", levels, allowed="a sequence of arrays")
    least = _LEAST.get(kind, 1)
    checked = []
    for number, level in enumerate(levels):
        offsets = _as_offsets(level, count, least, _PARTS[kind] if number == 0 else "parts")
        checked.append(offsets)
        count, least = len(offsets) - 1, 1
    if len(checked) - _LEVELS[kind] not in ((0,) if kind == "points" else (0, 1)):
        allowed = f"{_LEVELS[kind]}, and one more for features of several parts"
        what = f"number of offset arrays of {kind}"
        raise OptionError("offsets", len(checked), allowed=allowed, what=what)
    return tuple(checked)


def _as_offsets(given: Any, count: int, least: int, what: str) -> Int64Array:
    array = np.asarray(given)
    is_index = array.dtype.kind in "iu" and array.ndim == 1 and len(array) > 0
    if not is_index or array[0] != 0 or array[-1] != count:
        ends = (array[0].item(), array[-1].item()) if is_index else str(array.dtype)
        raise OptionError(
            f"offsets of {what}",
            ends,
            allowed=f"whole numbers that begin with 0 and end with {count}",
        )
    offsets = array.astype(np.int64, copy=array.dtype == np.int64 and array.flags.writeable)
    short = np.diff(offsets) < least
    if short.any():
        part = int(short.argmax())
        size = int(offsets[part + 1] - offsets[part])
        raise OptionError(f"length of {what[:-1]} {part}", size, allowed=f"{least} or more")
    return frozen_copy(offsets)


def _require_closed(coordinates: Float64Array, offsets: Int64Array) -> None:
    first, last = coordinates[offsets[:-1]], coordinates[offsets[1:] - 1]
    is_open = ((first != last) & ~(np.isnan(first) & np.isnan(last))).any(axis=1)
    if is_open.any():
        ring = int(is_open.argmax())
        raise OptionError(
            f"last point of ring {ring}",
            tuple(last[ring].tolist()),
            allowed=f"the first, {tuple(first[ring].tolist())}",
        )
