"""Surveys and TINs in another CRS."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, overload

import numpy as np

from ...base.crs import CRS, Unit, require_projected
from ...base.errors import CrsError, OptionError
from ...base.products import product
from ...tin import TIN, Surface, Survey
from ...tin.building import move_survey
from .transformation import find_conversion_factor
from .transformation import reproject as reproject_points

if TYPE_CHECKING:
    from ...base.arrays import Float64Array
    from ...base.crs import CrsLike, UnitLike


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
    require_projected(target, "{crs} measures in degrees, and a TIN needs a projected CRS.")
    placed = reproject_points(surface.points, source, target, unit=unit)
    notes = [*placed.notes, *_describe_return(source, target)]
    along, across = source.horizontal_unit, target.horizontal_unit

    def move(points: Float64Array) -> Float64Array:
        return reproject_points(points, source, target, unit=unit).points

    moved = surface.transform(
        move, crs=target, elevation_unit=placed.unit, length=find_conversion_factor(along, across)
    )
    return moved.with_notes(notes) if notes else moved


def _move_survey(survey: Survey, source: CRS, target: CRS, unit: Unit | None) -> Survey:
    placed = reproject_points(survey.points, source, target, unit=unit)

    def move(points: Float64Array) -> Float64Array:
        return reproject_points(points, source, target, unit=unit).points

    return move_survey(
        survey,
        move,
        points=placed.points,
        crs=target,
        elevation_unit=placed.unit,
        notes=[*survey.notes, *placed.notes, *_describe_return(source, target)],
    )


def _describe_return(source: CRS, target: CRS) -> list[str]:
    """Tell where coordinates on the ground, of which other notes speak, were brought to."""
    if not source.horizontal.to_pyproj().is_derived or source.is_same(target):
        return []
    return [f"Coordinates were brought from {source.label} to {target.label}."]


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

    return move_survey(survey, move, elevation_unit=unit)
