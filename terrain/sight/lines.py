"""Lines of sight between places on a surface, or above it, and eyes that see all around."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...base.checks import as_length, as_number
from ...base.errors import PointsError
from ...base.products import product
from ...base.results import Features
from ...base.sentences import counted
from ..surface import as_places, find_reference
from .rays import Rays, find_blocks, find_curvature

if TYPE_CHECKING:
    from ...base.arrays import Float64Array, Int64Array
    from ...tin import TIN


@product
def line_of_sight(
    tin: TIN,
    eyes: Any,
    targets: Any,
    *,
    eye_height: float = 0.0,
    target_height: float = 0.0,
    curvature: bool = False,
    refraction: float | None = None,
) -> Features:
    """Tell what is seen from where on a surface.

    Parameters
    ----------
    tin : TIN
    eyes, targets : (2,) or (k, 2) array, Features of points, shapes or a data frame
        CRS units; one eye for all targets, or as many eyes as targets.
    eye_height, target_height : float, optional
        Above the ground, in the unit of elevations.
    curvature : bool, optional
        Take the earth for a sphere with a radius of 6371 km; default a plane.
    refraction : float, optional
        Coefficient of refraction with ``curvature``; default 0.13.

    Returns
    -------
    Features
        A straight line from each eye to its target, with the columns ``eye`` and ``target``
        (numbers, from 0 on), ``visible``, ``distance`` in the plane, ``clearance`` (least height of
        the line above the edges and vertices between, negative if one blocks it, NaN if there is
        none), and ``block_x``, ``block_y``, ``block_distance``: where it first goes into the
        ground, NaN if it does not.

    Raises
    ------
    CrsError
        If coordinates are degrees, a CRS differs, or curvature is asked for and the unit of
        lengths is not known.
    OptionError
        If a height is no number from 0 on, or another option is none.
    PointsError
        If a place lies outside the surface, or an eye is its target.

    Notes
    -----
    Ground that only touches the line does not block it. Which edges the line crosses, and whether
    the ground there is above it, is decided exactly, for an eye and a target at the ground's
    elevation, rounded, plus their heights; with ``curvature`` in doubles. Where the line passes
    over a hole, or leaves the surface, nothing blocks it; ``notes`` tell that.

    Examples
    --------
    >>> import tinsmith as ts
    >>> ridge = [[0, 0, 0], [0, 4, 0], [4, 0, 2], [4, 4, 2], [8, 0, 0], [8, 4, 0]]
    >>> seen = ts.line_of_sight(ts.triangulate(ridge), [1, 2], [[3, 2], [7, 2]], eye_height=1)
    >>> seen.columns["visible"], seen.columns["block_x"]
    (array([ True, False]), array([nan, 2.5]))
    """
    reference = find_reference(tin, "Lines of sight")
    fall = find_curvature(reference, curvature, refraction)
    heights = as_height("eye_height", eye_height), as_height("target_height", target_height)
    from_xy, notes = as_places(tin, eyes, "the eyes")
    to_xy, said = as_places(tin, targets, "the targets")
    eye, target = _pair(len(from_xy), len(to_xy))
    rays = Rays(
        raise_places(tin, from_xy, heights[0])[eye], raise_places(tin, to_xy, heights[1])[target]
    )
    _require_apart(rays)
    found = find_blocks(tin, rays, fall)
    way = rays.targets - rays.eyes
    distances = np.hypot(way[:, 0], way[:, 1])
    places = rays.eyes + found.ratios[:, None] * way
    columns = {
        "eye": eye,
        "target": target,
        "visible": ~found.is_blocked,
        "distance": distances,
        "clearance": found.clearances,
        "block_x": places[:, 0],
        "block_y": places[:, 1],
        "block_distance": found.ratios * distances,
    }
    length = reference.units.length
    units = dict.fromkeys(("distance", "block_x", "block_y", "block_distance"), length)
    if found.leaves.any():
        count = int(found.leaves.sum())
        what = f"{counted(count, 'line')} of sight {'crosses' if count == 1 else 'cross'}"
        said += (f"{what} places without surface: nothing blocks sight there.",)
    return Features.of_lines(
        np.stack([rays.eyes, rays.targets], axis=1).reshape(-1, 3),
        2 * np.arange(len(eye) + 1),
        columns=columns,
        units={**units, "clearance": reference.elevation_unit},
        crs=tin.crs,
        elevation_unit=tin.elevation_unit,
        name="lines of sight",
        notes=[*reference.notes, *notes, *said],
    )


def as_height(option: str, value: Any) -> float:
    """Return a height above ground."""
    return as_number(option, value, "a height", least=0, unit="above the ground")


def raise_places(tin: TIN, xy: Float64Array, height: float) -> Float64Array:
    """Return places at a height above the ground, (k, 3)."""
    return np.column_stack([xy, tin.interpolate(xy) + height])


def _pair(eyes: int, targets: int) -> tuple[Int64Array, Int64Array]:
    if eyes not in (1, targets):
        raise PointsError(
            f"There are {counted(eyes, 'eye')} for {counted(targets, 'target')}: give one for all, "
            "or one for each."
        )
    number = np.arange(targets)
    return (np.zeros_like(number) if eyes == 1 else number), number


def _require_apart(rays: Rays) -> None:
    same = np.flatnonzero((rays.eyes[:, :2] == rays.targets[:, :2]).all(axis=1))
    if len(same):
        place = tuple(rays.eyes[same[0], :2].tolist())
        raise PointsError(
            f"Target {same[0]} lies where its eye is, at {place}: they must be apart.",
            rows=same[:5],
        )


class View(NamedTuple):
    """An eye, and how it sees."""

    eye: Float64Array
    target_height: float
    radius: float
    fall: float


def as_view(
    tin: TIN, eye: Any, heights: tuple[Any, Any], radius: Any, fall: float
) -> tuple[View, tuple[str, ...]]:
    """Return how an eye sees, from what a caller gives, and what is to be told about it."""
    above = as_height("eye_height", heights[0]), as_height("target_height", heights[1])
    reach = np.inf if radius is None else as_length("radius", radius, or_none=True)
    xy, notes = as_places(tin, eye, "the eye")
    if len(xy) != 1:
        raise PointsError(f"There are {len(xy)} eyes: a viewshed has one.")
    return View(raise_places(tin, xy, above[0])[0], above[1], reach, fall), notes


def measure_distances(points: Float64Array, eye: Float64Array) -> Float64Array:
    """Return the distances of points from the eye in the plane."""
    found: Float64Array = np.hypot(points[:, 0] - eye[0], points[:, 1] - eye[1])
    return found
