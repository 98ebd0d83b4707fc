"""Surveys and TINs in another CRS."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, overload

import numpy as np

from ...base.crs import CRS, Unit
from ...base.errors import CrsError, OptionError
from ...base.products import product
from ...base.sentences import height
from ...tin import TIN, Breakline, Surface, Survey, Water
from .transformation import find_conversion_factor
from .transformation import reproject as reproject_points

if TYPE_CHECKING:
    from collections.abc import Callable

    from ...base.arrays import Float64Array
    from ...base.crs import CrsLike, UnitLike

_FLAT = 1e-3
"""By how much the corners of water may differ in elevation after a change of the vertical datum."""


@overload
def reproject(surface: TIN, crs: CrsLike, *, elevation_unit: UnitLike | None = None) -> TIN: ...
@overload
def reproject(
    surface: Survey, crs: CrsLike, *, elevation_unit: UnitLike | None = None
) -> Survey: ...
@overload
def reproject(
    surface: TIN | Survey, crs: CrsLike, *, elevation_unit: UnitLike | None = None
) -> TIN | Survey: ...
@product
def reproject(
    surface: TIN | Survey, crs: CrsLike, *, elevation_unit: UnitLike | None = None
) -> TIN | Survey:
    """Return a survey or TIN in another CRS.

    Parameters
    ----------
    surface : Survey or TIN
        Its CRS must be known.
    crs : CRS, str, int or pyproj.CRS
        CRS wanted.
    elevation_unit : Unit or str, optional
        Unit of the elevations, where the surface does not know it.

    Returns
    -------
    Survey or TIN
        As was given. A TIN that was built here is built anew of its reprojected rows and lines, so
        that it is Delaunay in the new CRS; one of existing triangles, such as those of a file,
        keeps them. Notes tell what was done to elevations, and which grids PROJ lacks.

    Raises
    ------
    CrsError
        If a CRS is not known, no transformation exists, points lie outside its domain, elevations
        cannot be brought to the vertical datum wanted, or a TIN would be in degrees.
    OptionError
        If the unit is unknown, or another than the surface's own, or the surface is none.

    Notes
    -----
    Where both CRSs have a vertical axis PROJ changes the datum, with the grids that are on this
    machine; nothing is fetched. Otherwise elevations keep their datum, and only their unit becomes
    that of the target. ``max_edge`` and ``snap`` of a build are converted where the unit of the
    eastings changes.

    Examples
    --------
    >>> import tinsmith as ts
    >>> points = [[751428, 4020862, 1032], [751438, 4020862, 1031], [751428, 4020872, 1030]]
    >>> survey = ts.Survey(points=points, crs="EPSG:32616", elevation_unit="m")
    >>> moved = ts.reproject(survey, "EPSG:32617")
    >>> moved.points[0].round(2).tolist()
    [212642.56, 4021976.76, 1032.0]
    """
    if not isinstance(surface, Surface | Survey):
        raise OptionError("surface", surface, "a TIN or a Survey")
    source, target = surface.crs, CRS.of(crs)
    declared = Unit.of(elevation_unit)
    own = surface.elevation_unit
    if own is not None and declared is not None and own != declared:
        raise OptionError(
            "elevation_unit",
            declared.name,
            f"{own.name}, as the points have",
            what="unit of elevations",
        )
    unit = own or declared
    if source is None or target is None:
        raise CrsError(
            "The CRS of these points is not known, so they cannot be reprojected: declare it first."
        )
    if isinstance(surface, Survey):
        return _move_survey(surface, source, target, unit)
    if target.is_geographic:
        raise CrsError(
            f"{target.label} measures in degrees, and a TIN needs a projected CRS.", crs=target
        )
    placed = reproject_points(surface.points, source, target, unit=unit)
    along, across = source.horizontal_unit, target.horizontal_unit

    def move(points: Float64Array) -> Float64Array:
        return reproject_points(points, source, target, unit=unit).points

    moved = surface.transform(
        move, crs=target, elevation_unit=placed.unit, length=find_conversion_factor(along, across)
    )
    if not placed.notes:
        return moved
    return moved._with_report(notes=(*moved.report.notes, *placed.notes))


def _move_survey(survey: Survey, source: CRS, target: CRS, unit: Unit | None) -> Survey:
    placed = reproject_points(survey.points, source, target, unit=unit)

    def move(points: Float64Array) -> Float64Array:
        return reproject_points(points, source, target, unit=unit).points

    return replace(
        survey,
        points=placed.points,
        crs=target,
        elevation_unit=placed.unit,
        notes=[*survey.notes, *placed.notes],
        **_Mover(move, target).move_lines(survey),
    )


def scale_survey(survey: Survey, factor: float, unit: Unit | None) -> Survey:
    """Return a survey whose elevations, those of lines included, are multiplied by a factor.

    Parameters
    ----------
    survey : Survey
    factor : float
    unit : Unit or None
        Of the elevations then; None leaves it as it is.
    """
    if factor == 1.0:
        return replace(survey, elevation_unit=unit or survey.elevation_unit)

    def move(points: Float64Array) -> Float64Array:
        moved: Float64Array = points * np.array([1.0, 1.0, factor])
        return moved

    lines = _Mover(move, None).move_lines(survey)
    return replace(survey, points=move(survey.points), elevation_unit=unit, **lines)


class _Mover:
    """Lines of a survey, moved as its points are."""

    def __init__(self, move: Callable[[Float64Array], Float64Array], target: CRS | None) -> None:
        self._move = move
        self._target = target

    def move_lines(self, survey: Survey) -> dict[str, Any]:
        """Return the lines and rings of a survey, by what they are."""
        return {
            "breaklines": [self.move_line(line) for line in survey.breaklines],
            "boundary": [self.move_region(one) for one in survey.boundary],
            "holes": [self.move_region(one) for one in survey.holes],
            "erase": [self.move_region(one) for one in survey.erase],
            "water": [self.move_water(one) for one in survey.water],
            "extent": [self.move_ring(one) for one in survey.extent],
        }

    def move_ring(self, ring: Any) -> Float64Array:
        """Move an array of two or three columns."""
        given = np.asarray(ring, np.float64)
        if given.shape[1] == 3:
            return self._move(given)
        level = np.column_stack([given, np.zeros(len(given))])
        return self._move(level)[:, :2].copy()

    def move_line(self, line: Any) -> Any:
        """Move a breakline or its coordinates."""
        if isinstance(line, Breakline):
            coords = self.move_ring(line.coords)
            return Breakline(coords, kind=line.kind, priority=line.priority, name=line.name)
        return self.move_ring(line)

    def move_region(self, region: Any) -> Any:
        """Move a ring, or a list of rings."""
        if isinstance(region, list | tuple) and np.ndim(region[0]) == 2:
            return [self.move_ring(ring) for ring in region]
        return self.move_ring(region)

    def move_water(self, water: Water) -> Water:
        """Move a polygon of water, which must stay flat."""
        corners = np.column_stack([water.ring, np.full(len(water.ring), water.z)])
        moved = self._move(corners)
        if self._target is not None and np.ptp(moved[:, 2]) > _FLAT:
            raise CrsError(
                f"Water at {height(water.z)} would not be flat in the vertical datum of "
                f"{self._target.label}: name the horizontal part of the CRS alone.",
                crs=self._target,
            )
        return Water(moved[:, :2], float(moved[:, 2].mean()), name=water.name)
