"""Combined factor: from distances on the ground to those of a projected grid, and back."""

from __future__ import annotations

import math
import warnings
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, TypeVar, cast, overload

import numpy as np

from ....base import optional
from ....base.checks import as_number, require_tin
from ....base.crs import CRS, METRE, Unit, assume_elevation_unit, require_projected
from ....base.errors import CrsError, OptionError, PointsError
from ....base.notes import as_notes
from ....base.products import product
from ....base.results import Features
from ....base.sentences import coordinate, height
from ....tin import TIN, Survey
from ....tin.building import move_survey
from ..alignments import Alignment, as_numbers
from .ground_crs import derive_ground_crs
from .scaling import require_places, scale_alignment

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from ....base.arrays import Float64Array
    from ....base.crs import CrsLike, UnitLike

    Place = TypeVar("Place", TIN, Survey, Alignment, Features)

_NEEDS_LENGTHS = "Coordinates in {crs} are angles: a combined factor is that of a projected CRS."
_LEAST, _MOST = 0.5, 2.0
_REACH = 200.0
"""Metres to either side of a point, between which a scale is measured: to about 1e-9."""
_SAME_SCALE = 1e-7
"""Pseudo-Mercator has a scale of a sphere, 0.3 % off on its ellipsoid."""
_LOWEST, _HIGHEST = -12_000.0, 100_000.0
"""Metres: what is no height above the ellipsoid."""


@dataclass(frozen=True, eq=False)
class CombinedFactor:
    """Distances of a projected grid over distances on the ground, about a base point.

    Attributes
    ----------
    combined : float
        A distance on the grid over the same on the ground: below 1 high above the ellipsoid.
    base : (float, float)
        Easting and northing of the point that has the same coordinates on the grid and on the
        ground, CRS units; (0, 0) scales the coordinates themselves.
    crs : CRS, optional
        Of the grid.
    grid_scale : float, optional
        Scale factor of the projection at the base: grid over ellipsoid; None if it is not known.
    elevation_factor : float, optional
        Ellipsoid over ground, R / (R + h); None if it is not known.
    notes : sequence of str
        What was assumed.

    Raises
    ------
    OptionError
        If the factor is none from 0.5 to 2, the base is none, or the factor is not the product of
        the other two.
    CrsError
        If the CRS is unknown, or its coordinates are angles.

    Notes
    -----
    A place on the ground is ``base + (grid - base) / combined``; elevations stay. One factor holds
    for the surroundings of the base: it changes with the place and with the height, by 0.157 ppm a
    metre of height.

    Examples
    --------
    >>> import tinsmith as ts
    >>> factor = ts.CombinedFactor(0.9998, base=(1000.0, 2000.0))
    >>> factor.to_ground([[1999.8, 2000.0]])
    array([[2000., 2000.]])
    """

    combined: float
    base: tuple[float, float] = field(kw_only=True)
    crs: CRS | None = field(default=None, kw_only=True)
    grid_scale: float | None = field(default=None, kw_only=True)
    elevation_factor: float | None = field(default=None, kw_only=True)
    notes: Sequence[str] = field(default=(), kw_only=True)

    def __post_init__(self) -> None:
        keep = object.__setattr__
        keep(self, "combined", _as_factor("combined", self.combined))
        keep(self, "base", _as_base(self.base))
        keep(self, "crs", CRS.of(self.crs))
        keep(self, "notes", as_notes(self.notes))
        require_projected(self.crs, _NEEDS_LENGTHS)
        parts = self.grid_scale, self.elevation_factor
        for name, value in zip(("grid_scale", "elevation_factor"), parts, strict=True):
            if value is not None:
                keep(self, name, _as_factor(name, value))
        if None not in parts and not math.isclose(math.prod(parts), self.combined, rel_tol=1e-9):  # type: ignore[arg-type]
            allowed = "the product of grid_scale and elevation_factor"
            raise OptionError("combined", self.combined, allowed)

    @cached_property
    def ground_crs(self) -> CRS | None:
        """CRS of coordinates on the ground, derived from that of the grid; None if it is not known.

        It is a derived projected CRS (WKT2) with the affine transformation, from which PROJ finds
        the way back to the grid. Formats that hold codes or WKT1 alone cannot name it.
        """
        if self.crs is None:
            return None
        return derive_ground_crs(self.crs, self.combined, self.base)

    @property
    def parts_per_million(self) -> float:
        """By how much a distance on the ground is longer than on the grid, millionths of it."""
        return (1.0 / self.combined - 1.0) * 1e6

    @overload
    def to_ground(self, places: Place) -> Place: ...
    @overload
    def to_ground(self, places: ArrayLike) -> Float64Array: ...
    def to_ground(self, places: Any) -> Any:
        """Return places of the grid where they are on the ground.

        Parameters
        ----------
        places : (n, 2) or (n, 3) array, TIN, Survey, Features or Alignment
            CRS units.

        Returns
        -------
        (n, 2) or (n, 3) float64 array, TIN, Survey, Features or Alignment
            As was given. Its CRS is :attr:`ground_crs`, never that of the grid.

        Raises
        ------
        CrsError
            If they are in another CRS than the factor, or one of both is not known.
        OptionError
            If they are none of these, or an alignment has vertical curves that are arcs.

        Notes
        -----
        A TIN that was built here is built anew of its scaled rows and lines. Stations of an
        alignment become lengths on the ground from its start on.

        Examples
        --------
        >>> import tinsmith as ts
        >>> factor = ts.CombinedFactor(0.5, base=(0.0, 0.0))
        >>> factor.to_ground([[1.0, 2.0, 7.0]])
        array([[2., 4., 7.]])
        """
        return self._move(places, 1.0 / self.combined, is_to_ground=True)

    @overload
    def to_grid(self, places: Place) -> Place: ...
    @overload
    def to_grid(self, places: ArrayLike) -> Float64Array: ...
    def to_grid(self, places: Any) -> Any:
        """Return places on the ground where they are on the grid.

        Parameters
        ----------
        places : (n, 2) or (n, 3) array, TIN, Survey, Features or Alignment
            CRS units. Their CRS is :attr:`ground_crs`, or not known.

        Returns
        -------
        (n, 2) or (n, 3) float64 array, TIN, Survey, Features or Alignment
            As was given, in the CRS of the grid.

        Raises
        ------
        CrsError
            If they are in another CRS, such as that of the grid.
        OptionError
            As :meth:`to_ground`.

        Examples
        --------
        >>> import tinsmith as ts
        >>> factor = ts.CombinedFactor(0.5, base=(0.0, 0.0))
        >>> factor.to_grid([[2.0, 4.0]])
        array([[1., 2.]])
        """
        return self._move(places, self.combined, is_to_ground=False)

    def _move(self, places: Any, factor: float, *, is_to_ground: bool) -> Any:
        source, target = self.crs, self.ground_crs
        if not is_to_ground:
            source, target = target, source
        base = np.array(self.base)

        def move(points: Float64Array) -> Float64Array:
            moved = points.copy()
            moved[:, :2] = base + (points[:, :2] - base) * factor
            return moved

        if not isinstance(places, TIN | Survey | Features | Alignment):
            return move(require_places(places))
        self._require_source(places.crs, source, is_to_ground=is_to_ground)
        notes = [*places.notes, *self._describe(is_to_ground=is_to_ground)]
        unit = places.elevation_unit
        if isinstance(places, TIN):
            moved = places.transform(move, crs=target, elevation_unit=unit, length=factor)
            return moved.with_notes(notes)
        if isinstance(places, Survey):
            return move_survey(places, move, crs=target, elevation_unit=unit, notes=notes)
        if isinstance(places, Features):
            coordinates = move(places.coordinates)
            return replace(places, coordinates=coordinates, crs=target, notes=notes)
        return scale_alignment(places, factor, base, crs=target, notes=notes)

    def _require_source(
        self, theirs: CRS | None, source: CRS | None, *, is_to_ground: bool
    ) -> None:
        what = "coordinates on the grid" if is_to_ground else "coordinates on the ground"
        if theirs is None and source is not None and is_to_ground:
            raise CrsError(
                f"The CRS of the places is not known, and the factor is for {source.label}: name "
                "it, for coordinates are never mixed on a guess.",
                crs=source,
            )
        if theirs is None:
            return
        if source is None or not theirs.horizontal.is_same(source.horizontal):
            wanted = "a CRS that is not known" if source is None else source.label
            raise CrsError(
                f"The CRS of the places is {theirs.label}, and {what} are needed, in {wanted}.",
                crs=theirs,
            )

    def _describe(self, *, is_to_ground: bool) -> list[str]:
        east, north = (coordinate(one) for one in self.base)
        where = f"by the combined factor {self.combined:.10g} about {east}, {north}"
        if not is_to_ground:
            return [f"Coordinates were brought from the ground to the grid {where}.", *self.notes]
        none = "" if self.crs is not None else " They have no CRS: that of the grid is not known."
        return [
            f"Coordinates were brought from the grid to the ground {where}; lengths are those on "
            f"the ground.{none}",
            *self.notes,
        ]


@product
def combined_factor(
    where: TIN | Survey | CrsLike,
    *,
    point: ArrayLike | None = None,
    elevation: float | None = None,
    elevation_unit: UnitLike | None = None,
    undulation: float | None = None,
) -> CombinedFactor:
    """Compute the combined factor of a grid at a place and a height.

    Parameters
    ----------
    where : TIN, Survey, CRS, str, int or pyproj.CRS
        A projected CRS, or a surface or survey that is in one.
    point : (2,) array, optional
        Easting and northing, CRS units; default the middle of the bounds of the surface or survey.
    elevation : float, optional
        Mean elevation of the ground; default the mean of the surface, by area, or of the points.
    elevation_unit : Unit or str, optional
        Of ``elevation`` and ``undulation``; default that of the surface or survey, else the usual
        one of the CRS.
    undulation : float, optional
        Height of the geoid above the ellipsoid there. Without it elevations are taken as heights
        above the ellipsoid, which a note says, unless the CRS says that they are.

    Returns
    -------
    CombinedFactor
        ``grid_scale`` is that of the projection (PROJ); ``elevation_factor`` is R / (R + h) with
        the geometric mean of both radii of curvature of the ellipsoid.

    Raises
    ------
    OptionError
        If a number is none, or point or elevation are missing.
    CrsError
        If the CRS is not known, its coordinates are angles, it is not conformal, so that its scale
        depends on the direction, or the point is outside its domain.

    References
    ----------
    J. P. Snyder: Map projections, a working manual, USGS Professional Paper 1395 (1987).

    Examples
    --------
    >>> import tinsmith as ts
    >>> factor = ts.combined_factor(
    ...     "EPSG:32616", point=(500_000.0, 4_000_000.0), elevation=300.0, undulation=-30.0
    ... )
    >>> round(factor.grid_scale, 8), round(factor.elevation_factor, 8)
    (0.9996, 0.99995763)
    """
    places: Any = where if isinstance(where, Survey) or hasattr(where, "triangles") else None
    crs = CRS.of(cast("CrsLike", where)) if places is None else _find_crs(places)
    if crs is None:
        raise CrsError("The CRS is not known, and a scale factor is that of a projected CRS.")
    require_projected(crs, _NEEDS_LENGTHS)
    base = _as_base(_find_middle(places) if point is None else point)
    own = None if places is None else places.elevation_unit
    unit = Unit.of(elevation_unit) or own or assume_elevation_unit(crs, None) or METRE
    if own is not None and unit != own and elevation is None:
        raise OptionError("elevation_unit", unit.name, f"{own.name}, as the surface has")
    mean = _find_mean_elevation(places) if elevation is None else as_number("elevation", elevation)
    above = 0.0 if undulation is None else as_number("undulation", undulation)
    metres = (mean + above) * (unit.metres or 1.0)
    as_number("elevation", metres, "a height", least=_LOWEST, most=_HIGHEST, unit="metres")
    grid, radius = _measure_grid(crs, base)
    up = radius / (radius + metres)
    notes = _describe_height(crs, mean, unit, undulation)
    return CombinedFactor(
        grid * up, base=base, crs=crs, grid_scale=grid, elevation_factor=up, notes=notes
    )


# ---------------------------------------------------------------- what callers give


def _as_factor(name: str, value: Any) -> float:
    return as_number(name, value, "a factor", least=_LEAST, most=_MOST)


def _as_base(given: Any) -> tuple[float, float]:
    values = as_numbers("point", given)
    if len(values) != 2:
        raise OptionError("point", given, "an easting and a northing")
    east, north = values.tolist()
    return east, north


def _find_crs(places: Any) -> CRS | None:
    if not isinstance(places, Survey):
        require_tin(places)
    elif not len(places):
        raise PointsError("The survey has no point, from which a mean elevation would be.")
    crs: CRS | None = places.crs
    return crs


def _find_middle(places: Any) -> Any:
    if places is None:
        raise OptionError("point", None, "an easting and a northing, where there is no surface")
    return places.bounds.center


def _find_mean_elevation(places: Any) -> float:
    """Return the mean elevation, of a surface by area."""
    if places is None:
        raise OptionError("elevation", None, "a finite number, where there is no surface")
    if isinstance(places, Survey):
        return float(places.points[:, 2].mean())
    means = places.points[places.triangles, 2].mean(axis=1)
    return float(np.average(means, weights=places.triangle_areas))


# ---------------------------------------------------------------- what the earth is like


def _measure_grid(crs: CRS, base: tuple[float, float]) -> tuple[float, float]:
    """Return the scale factor at a place, and the mean radius of the ellipsoid there, metres."""
    pyproj = optional.load("pyproj", "A scale factor")
    flat = crs.horizontal.to_pyproj()
    geodetic: Any = flat.geodetic_crs
    turn = pyproj.Transformer.from_crs(flat, geodetic, always_xy=True)
    east, north = turn.transform(*base)
    if not (math.isfinite(east) and math.isfinite(north)):
        place = ", ".join(coordinate(one) for one in base)
        raise CrsError(f"The point {place} lies outside the domain of {crs.label}.", crs=crs)
    to_radians = float(geodetic.axis_info[0].unit_conversion_factor)
    longitude, latitude = (one * to_radians for one in (east, north))
    ellipsoid: Any = flat.ellipsoid
    major, minor = float(ellipsoid.semi_major_metre), float(ellipsoid.semi_minor_metre)
    bulge = 1.0 - (1.0 - (minor / major) ** 2) * math.sin(latitude) ** 2
    scales = _measure_scales(pyproj, flat, (longitude, latitude))
    if scales is None:
        raise CrsError(f"PROJ knows no scale factors of {crs.label}.", crs=crs)
    measured = _measure_around(turn, flat, base)
    off = max(abs(one - scales.meridional_scale) for one in measured)
    if off > _SAME_SCALE:
        raise CrsError(
            f"{crs.label} is not conformal there: its scale depends on the direction, from "
            f"{min(measured):.6f} to {max(measured):.6f}.",
            crs=crs,
        )
    return float(scales.meridional_scale), minor / bulge


def _measure_around(turn: Any, flat: Any, base: tuple[float, float]) -> list[float]:
    """Return lengths on the grid over geodesics of the ellipsoid, in three directions."""
    geodesics = flat.get_geod()
    unit = float(flat.axis_info[0].unit_conversion_factor)
    half = _REACH / unit
    found = []
    for angle in (0.0, math.pi / 4, math.pi / 2):
        step = half * math.cos(angle), half * math.sin(angle)
        ends = [
            [one + sign * part for sign in (-1, 1)] for one, part in zip(base, step, strict=True)
        ]
        longitudes, latitudes = turn.transform(*ends)
        *_, length = geodesics.inv(
            *(values[k] for k in range(2) for values in (longitudes, latitudes))
        )
        found.append(2.0 * _REACH / length)
    return found


def _measure_scales(pyproj: Any, flat: Any, place: tuple[float, float]) -> Any:
    """Return the factors of PROJ; None if it has none."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)  # on what PROJ texts lose, datums
            projection = pyproj.Proj(flat)
        return projection.get_factors(*place, radians=True, errcheck=True)
    except (pyproj.exceptions.ProjError, pyproj.exceptions.CRSError):
        return None


def _describe_height(crs: CRS, mean: float, unit: Unit, undulation: float | None) -> list[str]:
    text = f"The elevation factor is that of a mean elevation of {height(mean)} {unit.symbol}"
    if undulation is not None:
        return [f"{text} and an undulation of {height(undulation)} {unit.symbol}."]
    if crs.vertical_unit is not None and not crs.to_pyproj().is_compound:
        return [f"{text} above the ellipsoid."]
    return [
        f"{text}; the geoid's undulation is not known, and the elevation was taken as a height "
        "above the ellipsoid: 30 m of undulation change the factor by 4.7 ppm."
    ]
