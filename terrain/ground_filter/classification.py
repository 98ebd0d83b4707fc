"""Which points are ground: seeds, a TIN densified from them, and what lies on it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.crs import assume_elevation_unit, require_projected
from ...base.errors import CrsError, PointsError
from ...base.georeference import describe_unknown
from ...base.progress import Progress
from ...base.sentences import counted
from ...tin import TIN, Survey, triangulate
from ...tin.validation import as_points
from .. import _kernel
from .frame import Frame, Units, lay_cells
from .parameters import Parameters
from .returns import Candidates, are_noise
from .seeds import find_low_noise, find_seeds
from .segments import link, list_continuing
from .surroundings import surround

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from numpy.typing import ArrayLike

    from ...base.arrays import BoolArray, Float64Array, UInt8Array
    from ...base.crs import CRS, Unit
    from ...base.policies import GroundReturns
    from ...base.progress import Tell
    from .frame import Cells

UNCLASSIFIED, GROUND, LOW_NOISE = 1, 2, 7
"""Classes of the ASPRS LAS specification 1.4."""

_ROUNDS = ((0.2, 0.6), (0.6, 1.0))
"""Stages of the whole in which the surface is made; in the second, above that of the first."""


@dataclass(frozen=True, eq=False, kw_only=True)
class GroundPoints:
    """Points with their classes: what :func:`tinsmith.ground` found.

    Attributes
    ----------
    given : Survey
        The points, as they were given.
    classification : (n,) uint8 array
        Classes of the ASPRS: 2 ground, 1 others, 7 low noise; points given as noise (7 and 18)
        keep their class.
    heights : (n,) float64 array
        Of the points above the surface of the ground, vertically, in the unit of elevations.
    parameters : mapping
        Those of the function, in metres and degrees.
    notes : tuple of str
        What was assumed, converted or left aside.

    Examples
    --------
    >>> import numpy as np
    >>> x, y = (axis.ravel() for axis in np.meshgrid(np.arange(30.0), np.arange(30.0)))
    >>> z = np.where((abs(x - 15) < 5) & (abs(y - 15) < 5), 6.0, 0.0)  # a house on a plane
    >>> found = ground(np.column_stack([x, y, z]))
    >>> found.counts
    {'ground': 819, 'others': 81, 'low noise': 0}
    >>> len(found.survey), float(found.tin.points[:, 2].max())
    (819, 0.0)
    """

    given: Survey
    classification: UInt8Array
    heights: Float64Array
    parameters: Mapping[str, Any]
    notes: tuple[str, ...]

    @property
    def is_ground(self) -> BoolArray:
        """Whether each point is ground."""
        return np.equal(self.classification, GROUND)

    @property
    def counts(self) -> dict[str, int]:
        """How many points there are of each class."""
        n_ground = int(np.count_nonzero(self.is_ground))
        n_noise = int(np.count_nonzero(self.classification == LOW_NOISE))
        n_others = len(self.classification) - n_ground - n_noise
        return {"ground": n_ground, "others": n_others, "low noise": n_noise}

    @property
    def classified(self) -> Survey:
        """All points, with the attribute "classification"."""
        attributes = {**self.given.attributes, "classification": self.classification}
        return replace(self.given, attributes=attributes, notes=self._all_notes)

    @cached_property
    def survey(self) -> Survey:
        """The points of the ground alone, with their attributes and all lines."""
        rows = np.flatnonzero(self.is_ground)
        whole = self.classified
        left_out = {"points that are not ground": len(whole) - len(rows)}
        return replace(
            whole,
            points=whole.points[rows],
            attributes={name: values[rows] for name, values in whole.attributes.items()},
            skipped={**whole.skipped, **{what: n for what, n in left_out.items() if n}},
            findings=(),
            row_sources=None if whole.row_sources is None else whole.row_sources.take(rows),
        )

    @cached_property
    def tin(self) -> TIN:
        """The TIN of the ground; :func:`tinsmith.triangulate` of the survey has options."""
        return triangulate(self.survey)

    @property
    def _all_notes(self) -> tuple[str, ...]:
        return tuple(dict.fromkeys([*self.given.notes, *self.notes]))

    def __repr__(self) -> str:
        counts = ", ".join(f"{n:,} {what}" for what, n in self.counts.items())
        return f"<GroundPoints: {counts}>"


def ground(
    points: Survey | ArrayLike,
    *,
    building: float = 40.0,
    cell: float = 1.0,
    terrain_slope: float = 0.12,
    iteration_angle: float = 20.0,
    iteration_distance: float = 1.4,
    edge_length: float = 5.0,
    tolerance: float = 0.3,
    horizontal_tolerance: float = 1.0,
    noise_depth: float = 1.0,
    returns: GroundReturns = "last",
    progress: Callable[[float], None] | None = None,
) -> GroundPoints:
    """Tell the points on the ground from those on buildings, plants and cars, and low noise.

    Parameters
    ----------
    points : Survey or (n, 3) array
        Lidar or photogrammetric points; an array is in metres. Of a survey the attributes
        ``return_number``, ``number_of_returns`` and ``classification`` are looked at.
    building : float
        Width of the largest building, metres. Wider ones stay in the ground.
    cell : float
        Side of the cells whose lowest points may be seeds, metres.
    terrain_slope : float
        Rise per length below which the lowest points are seeds without a doubt, and neighbours
        belong to one segment; steeper ground is found from the seeds around it.
    iteration_angle : float
        Largest angle at the nearest corner of its triangle under which a point is added, degrees.
    iteration_distance : float
        Largest distance of a point that is added from the plane of its triangle, metres.
    edge_length : float
        In triangles with shorter edges the angle is smaller in proportion, metres.
    tolerance, horizontal_tolerance : float
        At last all points are ground that lie no higher above the surface than the first, and the
        second times the surface's slope; metres.
    noise_depth : float
        Points deeper than that below all around them are low noise, metres.
    returns : {"last", "all"}
        Which returns of a pulse may be ground, where the attributes tell.
    progress : callable, optional
        Called with the fraction done, ascending to 1.0, between the steps below and as the TIN is
        densified. What it raises ends the call.

    Returns
    -------
    GroundPoints
        Classes of all points; ``survey`` and ``tin`` are those of the ground.

    Raises
    ------
    OptionError
        If a parameter has a value that it cannot have.
    PointsError
        If there are no points that may be ground, they are not finite, or lie too far apart for
        the cells.
    CrsError
        If the CRS of the survey measures in degrees.

    Notes
    -----
    1. Points below all around them are low noise, of those that may be ground.
    2. Seeds are the lowest points of cells that openings by growing windows leave in place.
    3. Segments of other lowest points that continue them without a step are seeds, too.
    4. The TIN of the seeds is densified: of each triangle the point nearest to its plane becomes a
       vertex, if it is near enough and seen under a small angle, until none is left.
    5. Steps 2 to 4 are done once more, the openings with heights above that surface.
    6. Points on the surface, within the tolerances, are ground.

    Lengths are converted from the units of the survey's CRS. The result depends on the set of
    points alone, not on their order. Bridges and cliffs, low walls and dense low plants cannot be
    told for certain: see docs/ground.md.

    References
    ----------
    P. Axelsson, "DEM generation from laser scanner data using adaptive TIN models", International
    Archives of Photogrammetry and Remote Sensing 33 B4 (2000). X. Zhao et al., "Improved
    progressive TIN densification filtering algorithm for airborne LiDAR data in forested areas",
    ISPRS Journal 117 (2016), doi:10.1016/j.isprsjprs.2016.03.016. T. Pingel, K. Clarke and
    W. McBride (2013), doi:10.1016/j.isprsjprs.2012.12.002. J. Zhang and X. Lin, "Filtering airborne
    LiDAR data by embedding smoothness-constrained segmentation in progressive TIN densification",
    ISPRS Journal 81 (2013), doi:10.1016/j.isprsjprs.2013.04.001.

    Examples
    --------
    >>> import numpy as np
    >>> x, y = (axis.ravel() for axis in np.meshgrid(np.arange(30.0), np.arange(30.0)))
    >>> z = np.where((abs(x - 15) < 5) & (abs(y - 15) < 5), 6.0, 0.0)  # a house on a plane
    >>> ground(np.column_stack([x, y, z]))
    <GroundPoints: 819 ground, 81 others, 0 low noise>
    """
    done = Progress(progress)
    parameters = Parameters(
        building=building,
        cell=cell,
        terrain_slope=terrain_slope,
        iteration_angle=iteration_angle,
        iteration_distance=iteration_distance,
        edge_length=edge_length,
        tolerance=tolerance,
        horizontal_tolerance=horizontal_tolerance,
        noise_depth=noise_depth,
        returns=returns,
    )
    survey = points if isinstance(points, Survey) else Survey(points=as_points(points))
    across, up, unit_notes = find_units(survey.crs, survey.elevation_unit)
    metric = _make_metric(as_points(survey.points), across, up)
    candidates = Candidates(parameters.returns)
    is_candidate = candidates.find(survey.attributes, len(survey))
    require_candidates(int(np.count_nonzero(is_candidate)), len(survey))
    width, height = metric[:, :2].max(axis=0).tolist()
    frame = Frame.of_all((width, height), parameters.cell, len(metric))
    classes, heights = classify(metric, is_candidate, frame, parameters, done)
    is_noise = are_noise(survey.attributes, len(survey))
    if is_noise.any():
        classes[is_noise] = survey.attributes["classification"][is_noise]
    found = GroundPoints(
        given=survey,
        classification=classes,
        heights=heights / up,
        parameters=parameters.to_dict(),
        notes=(*unit_notes, *candidates.notes),
    )
    done.end()
    return found


def find_units(
    crs: CRS | None, elevation_unit: Unit | None
) -> tuple[float, float, tuple[str, ...]]:
    """Return metres of the unit of eastings and of that of elevations, and what was assumed.

    Raises
    ------
    CrsError
        If the CRS measures in degrees, or in an unknown unit.
    """
    if crs is None:
        note = "The CRS is not known: coordinates are taken to be in metres, as the parameters are."
        across, up = 1.0, 1.0 if elevation_unit is None else elevation_unit.metres
        return across, up or 1.0, (note,)
    require_projected(
        crs,
        "The points are in {crs}, which measures in degrees, and the ground is found by lengths: "
        "bring them into a projected CRS first.",
    )
    unit = crs.horizontal_unit
    metres = None if unit is None else unit.metres
    if unit is None or metres is None:
        raise CrsError(
            f"The unit of {crs.label} is not known, and the ground is found by lengths in metres: "
            "declare a CRS whose unit is.",
            crs=crs,
        )
    vertical = assume_elevation_unit(crs, elevation_unit)
    notes = describe_unknown(crs, elevation_unit)
    up = metres if vertical is None or vertical.metres is None else vertical.metres
    if metres != 1.0:
        notes = (*notes, f"The parameters are in metres: converted to the {unit.name}.")
    return metres, up, notes


def _make_metric(points: Float64Array, across: float, up: float) -> Float64Array:
    """Return fresh points in metres from the least easting, northing and elevation."""
    if len(points) == 0:
        raise PointsError("There are no points: the ground is found among some.")
    return Units(points.min(axis=0), across, up).to_metric(points)


def require_candidates(count: int, total: int) -> None:
    """Refuse points none of which may be ground.

    Raises
    ------
    PointsError
    """
    if count == 0:
        raise PointsError(
            f"None of {counted(total, 'point')} may be ground: all are marked as noise or "
            "are not the last of their pulse."
        )


def classify(
    points: Float64Array,
    is_candidate: BoolArray,
    frame: Frame,
    parameters: Parameters,
    done: Progress,
) -> tuple[UInt8Array, Float64Array]:
    """Return the class of each point, and its height above the ground.

    Parameters
    ----------
    points : (n, 3) float64 array
        In metres, in the cells of the frame.
    is_candidate : (n,) bool array
        Which may be ground; at least one.
    frame : Frame
    parameters : Parameters
    done : Progress
    """
    is_taken = is_candidate.copy()
    cells = lay_cells(points, frame)
    is_low = find_low_noise(points, cells, is_taken, parameters, done.stage(0.0, 0.1))
    is_taken &= ~is_low
    heights, slopes = _find_surface(points, cells, is_taken, parameters, done, frame)
    sideways = parameters.horizontal_tolerance * slopes
    is_low |= is_taken & (heights < -(parameters.noise_depth + sideways))
    is_ground = is_taken & ~is_low & _lie_on(heights, slopes, parameters)
    classes = np.full(len(points), UNCLASSIFIED, np.uint8)
    classes[is_ground], classes[is_low] = GROUND, LOW_NOISE
    return classes, heights


def _find_surface(
    points: Float64Array,
    cells: Cells,
    is_taken: BoolArray,
    parameters: Parameters,
    done: Progress,
    frame: Frame,
) -> tuple[Float64Array, Float64Array]:
    """Return the height of each point above the surface of the ground, and its slope there."""
    lowest = cells.find_lowest(is_taken)
    ring = surround(frame, points[lowest])
    links = link(points[lowest], ring, parameters)
    is_seed, is_ground = np.zeros((2, len(lowest)), bool)
    heights = points[:, 2]
    for start, end in _ROUNDS:
        stage = Progress(done.stage(start, end))
        is_seed |= find_seeds(heights, cells, lowest, parameters, stage.stage(0.0, 0.3))
        is_ground |= is_seed
        is_seed |= list_continuing(links, is_ground)
        seeds = points[lowest[is_seed]]
        around = np.concatenate([seeds, surround(frame, seeds)])
        heights, slopes = _densify(
            points, cells, is_taken, around, parameters, stage.stage(0.4, 1.0)
        )
        is_ground = _lie_on(heights[lowest], slopes[lowest], parameters)
    return heights, slopes


def _densify(
    points: Float64Array,
    cells: Cells,
    is_taken: BoolArray,
    seeds: Float64Array,
    parameters: Parameters,
    progress: Tell | None,
) -> tuple[Float64Array, Float64Array]:
    order = cells.order
    heights, slopes = np.empty(len(points)), np.empty(len(points))
    tin = triangulate(seeds, threads=1)
    heights[order], slopes[order] = _kernel.densify(
        tin.points,
        tin.triangles,
        tin.neighbors,
        points[order],
        is_taken[order],
        float(np.sin(np.radians(parameters.iteration_angle))),
        parameters.iteration_distance,
        parameters.edge_length,
        progress,
    )
    return heights, slopes


def _lie_on(heights: Float64Array, slopes: Float64Array, parameters: Parameters) -> BoolArray:
    """Tell which points lie no higher above the surface than the tolerances allow."""
    is_on: BoolArray = heights <= parameters.tolerance + parameters.horizontal_tolerance * slopes
    return is_on
