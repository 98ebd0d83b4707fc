"""Cut and fill between two surfaces, or a surface and a plane."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...base.errors import OptionError
from ...base.products import product
from ...base.progress import Progress
from ...base.results import Table
from ...base.sentences import inflect
from ...tin.validation import thread_count
from .. import _kernel
from ..surface import (
    Pieces,
    Surface,
    cut_pieces,
    find_common_reference,
    find_reference,
    require_finite,
)
from .planes import as_plane
from .regions import as_regions
from .uncertainty import add_errors, ask, find_detection

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import ArrayLike

    from ...base.arrays import Float64Array
    from ...base.progress import Tell
    from ...tin import TIN
    from ..surface import Reference
    from .error_models import ErrorModel
    from .planes import Plane

_ROUNDING = 1e-12
"""An area alone that is a smaller share of the whole is what the sums' rounding leaves."""


class Measured(NamedTuple):
    """Volumes, and what they were measured of."""

    table: Table
    reference: Reference
    names: list[str]
    sums: Float64Array
    """(k, sums), of each region, or of all there is."""
    first: Surface
    pieces: Pieces
    """The first surface in regions, or whole."""
    parts: Pieces | None
    """The regions, if there are any."""
    other: Surface | None
    """In the units of the first; None if there is a plane."""
    plane: Plane | None = None


@product
def volume(
    tin: TIN,
    other: TIN | None = None,
    *,
    base: float | ArrayLike | None = None,
    regions: Any = None,
    standard_error: float | str | ErrorModel | None = None,
    other_standard_error: float | str | ErrorModel | None = None,
    level_of_detection: float | None = None,
    confidence: float | None = None,
    threads: int | None = None,
    progress: Callable[[float], None] | None = None,
) -> Table:
    """Measure cut and fill from a surface to another one, or to a level or plane.

    Both triangulations are overlaid: no cell of a raster, no sampling. Fill is what lies between
    where the other surface, or the base, is above ``tin``; cut where it is below.

    Parameters
    ----------
    tin : TIN
        For example the ground as it is.
    other : TIN, optional
        For example the ground as it is to be.
    base : float or (3, 3) array, optional
        In place of another TIN: a level in the unit of elevations, or a plane, by three of its
        points (easting, northing, elevation).
    regions : polygons, optional
        Measure region by region: a mapping of names to polygons, :class:`Features`, a
        GeoDataFrame, or a sequence of polygons (of shapely, or rings). Of a polygon of several
        rings inside is what an odd number of them holds.
    standard_error : float, str or ErrorModel, optional
        Standard error of the elevations of ``tin``, in their unit: a number, the column of its
        vertices that has them, or an :class:`ErrorModel` of errors that are correlated or
        systematic. Errors of the two surfaces are independent. Default exact, if errors of the
        other one are given, which is noted.
    other_standard_error : float, str or ErrorModel, optional
        The same of ``other``.
    level_of_detection : float, optional
        Difference, in the unit of elevations, up to which a surface counts as unchanged: volumes
        beyond it are told beside the whole. Default none.
    confidence : float, optional
        In place of ``level_of_detection``: it is computed from the standard errors of both
        surfaces, such that one of so many differences is real, as 0.95. Where they vary, so does
        it.
    threads : int, optional
        Default every core, where it pays. The result is the same.
    progress : callable, optional
        Called with the fraction done, ascending to 1.0: finely while two TINs are overlaid, else
        between the stages. What it raises ends the call.

    Returns
    -------
    Table
        One row, or one for each region: ``region``; ``cut``, ``fill`` and ``net`` (fill less cut);
        ``area`` in the plane where both surfaces are, of it ``cut_area``, ``fill_area`` and
        ``unchanged_area``; ``surface_area`` and ``base_surface_area`` in space over the same;
        ``area_alone`` and ``base_area_alone``, where only ``tin`` or only the other one is;
        ``lowest``, ``highest`` and ``mean`` of the other less ``tin``. Volumes in the CRS's unit
        cubed; units that are not known are written so. With standard errors ``cut_error``,
        ``fill_error`` and ``net_error`` behind ``net``, the standard errors of these volumes. With
        a level of detection ``level_of_detection``, its mean if it varies, and of what differs by
        more ``thresholded_cut``, ``thresholded_fill``, ``thresholded_net``,
        ``thresholded_cut_area`` and ``thresholded_fill_area``.

    Raises
    ------
    OptionError
        If there is neither another TIN nor a base, or both; if the base is none. If a standard
        error is negative, or a column of the vertices is missing or has no value for one; if a
        level of detection is not above 0, or given with a confidence.
    CrsError
        If coordinates are degrees, the CRSs differ, or only one is known; if units of elevations
        cannot be told to be the same. Units that are known and differ are converted.
    LinesError
        If a region is no sound polygon.

    Notes
    -----
    Which triangles overlap, and where edges cross, is decided exactly; so is on which side of the
    other a surface lies at each corner, so that surfaces that agree have a volume of 0. Sums are
    exact and rounded once: for any order of triangles they are the same to the last bit, and with
    the TINs exchanged ``cut`` and ``fill`` change places. What remains are the roundings of single
    cells, some 1e-14 of each. Two TINs of a million points take some 5 s on one core.

    A net volume is linear in the elevations, cut and fill are as long as no cell changes from one
    to the other: standard errors are those of the linear function. That of cut is too small where
    there is hardly any cut but noise. The level of detection is z sqrt(s1² + s2²) of the standard
    errors of both surfaces with the quantile z of the normal distribution, 1.96 for 0.95 (Lane et
    al. 2003, Wheaton et al. 2010); thresholded volumes are whole where the difference exceeds it.

    References
    ----------
    S. N. Lane, R. M. Westaway, D. M. Hicks: Estimation of erosion and deposition volumes in a
    large, gravel-bed, braided river using synoptic remote sensing. Earth Surface Processes and
    Landforms 28 (2003), doi:10.1002/esp.483. J. M. Wheaton et al.: Accounting for uncertainty in
    DEMs from repeat topographic surveys. The same 35 (2010), doi:10.1002/esp.1886.

    Examples
    --------
    >>> import tinsmith as ts
    >>> ground = ts.triangulate([[0, 0, 5], [4, 0, 5], [4, 3, 8], [0, 3, 8]])
    >>> table = ts.volume(ground, base=6.5)
    >>> table["cut"], table["fill"], table["area"]
    (array([4.5]), array([4.5]), array([12.]))
    >>> ts.volume(ground, base=6.5, standard_error=0.05)["net_error"].round(3)
    array([0.316])
    """
    done = Progress(progress)
    asked = ask(
        standard_error, other_standard_error, level_of_detection, confidence, is_plane=other is None
    )
    share = 0.5 if asked.has_errors or asked.has_level else 1.0
    measuring = Progress(done.stage(0.0, share))
    measured = measure(tin, other, base, regions, threads, measuring)
    detection = find_detection(measured, asked, (tin, other))
    adding = Progress(done.stage(share, 1.0))
    table = add_errors(measured, asked, (tin, other), detection, adding)
    done.end()
    return table


def measure(
    tin: TIN,
    other: TIN | None,
    base: Any,
    regions: Any,
    threads: int | None,
    done: Progress,
    purpose: str = "Volumes",
) -> Measured:
    """Measure as :func:`volume` does, with what else the sums were made of.

    Raises OptionError, CrsError, LinesError as :func:`volume`.
    """
    if (other is None) == (base is None):
        given = "neither" if other is None else "both"
        raise OptionError("base", given, allowed="a level, a plane, or another TIN, one of them")
    if other is None:
        return _measure_to_plane(tin, base, regions, purpose)
    return _measure_between(tin, other, regions, threads, done, purpose)


def _measure_between(
    tin: TIN, other: TIN, regions: Any, threads: int | None, done: Progress, purpose: str
) -> Measured:
    reference, surface, second = find_common_reference(tin, other, purpose)
    names, pieces, parts, notes = _cut_into_regions(surface, regions, tin)
    workers = thread_count(threads, len(tin.points) + len(other.points))
    done(0.1)
    overlaying = done.stage(0.1, 0.9)
    sums = _sum_between(pieces, len(names), second, reference.up, workers, overlaying)
    done(0.9)
    own = _measure_areas(pieces, len(names))
    if parts is None:
        others = _measure_areas(_take_whole(second), 1)
    else:
        others = _sum_between(parts, len(names), second, reference.up, workers)[:, 0]
    alone = {
        "area_alone": subtract(own, sums[:, 0]),
        "base_area_alone": subtract(others, sums[:, 0]),
    }
    notes = (*notes, *describe_overlaps(parts, names))
    table = as_table(names, sums, alone, reference, notes)
    return Measured(table, reference, names, sums, surface, pieces, parts, second)


def _measure_to_plane(tin: TIN, base: Any, regions: Any, purpose: str) -> Measured:
    reference, plane = find_reference(tin, purpose), as_plane(base)
    surface = Surface(tin.triangulation.points, tin.triangulation.triangles)
    names, pieces, parts, notes = _cut_into_regions(surface, regions, tin)
    heights = plane.heights_above(pieces.surface.points)
    sums = _kernel.sum_heights(
        pieces.surface.points,
        pieces.surface.triangles,
        heights,
        pieces.groups,
        len(names),
        reference.up,
    )
    sums[:, 7] *= plane.steepness(reference.up)
    alone: dict[str, Float64Array] = {}
    if parts is not None:
        alone["base_area_alone"] = subtract(_measure_areas(parts, len(names)), sums[:, 0])
    notes = (*notes, *describe_overlaps(parts, names))
    table = as_table(names, sums, alone, reference, notes)
    return Measured(table, reference, names, sums, surface, pieces, parts, None, plane)


def _take_whole(surface: Surface) -> Pieces:
    return Pieces(surface, np.zeros(len(surface.triangles), np.int32))


def _cut_into_regions(
    surface: Surface, regions: Any, tin: TIN
) -> tuple[list[str], Pieces, Pieces | None, tuple[str, ...]]:
    """Return names of groups, the surface in them, the regions if there are any, and notes."""
    if regions is None:
        return ["all"], _take_whole(surface), None, ()
    names, parts, notes = as_regions(regions, tin.crs)
    return names, cut_pieces(surface, parts), parts, notes


def _sum_between(
    pieces: Pieces,
    count: int,
    other: Surface,
    up: float,
    threads: int,
    progress: Tell | None = None,
    *,
    is_other_apart: bool = True,
) -> Float64Array:
    return _kernel.sum_between(
        pieces.surface.points,
        pieces.surface.triangles,
        pieces.groups,
        count,
        other.points,
        other.triangles,
        up,
        is_other_apart,
        threads,
        progress,
    )


def _measure_areas(pieces: Pieces, count: int) -> Float64Array:
    return _kernel.sum_areas(pieces.surface.points, pieces.surface.triangles, pieces.groups, count)


def subtract(whole: Float64Array, part: Float64Array) -> Float64Array:
    """Return what is left of areas; nothing where it is what rounding leaves."""
    rest = whole - part
    return np.where(rest <= _ROUNDING * whole, 0.0, rest)


def describe_overlaps(parts: Pieces | None, names: list[str]) -> list[str]:
    """Tell how much regions overlap: what lies in several counts in each of them."""
    if parts is None or len(names) < 2:
        return []
    sums = _sum_between(parts, len(names), parts.surface, 1.0, 1, is_other_apart=False)
    doubled = subtract(sums[:, 0], _measure_areas(parts, len(names)))
    if not doubled.any():
        return []
    count = int(np.count_nonzero(doubled))
    overlap = inflect(f"{count} of the regions [overlaps|overlap]", count)
    return [
        f"{overlap} others, by {doubled.sum() / 2:.6g} in all: what lies in several is counted in "
        "each."
    ]


def as_table(
    names: list[str],
    sums: Float64Array,
    alone: dict[str, Float64Array],
    reference: Reference,
    notes: Sequence[str],
) -> Table:
    """Return volumes of the sums of groups, in the order of ``_kernel.SUMS``."""
    require_finite(sums)
    by_name = dict(zip(_kernel.SUMS, sums.T, strict=True))
    area, cut, fill = (by_name[name] for name in ("area", "cut", "fill"))
    with np.errstate(invalid="ignore", divide="ignore"):
        mean = (fill - cut) / area
    is_met = area > 0.0
    cut, fill = cut * reference.up, fill * reference.up
    unchanged = subtract(area, by_name["cut_area"] + by_name["fill_area"])
    columns: dict[str, Any] = {"region": np.array(names, object)}
    columns |= {"cut": cut, "fill": fill, "net": fill - cut, "area": area}
    columns |= {name: by_name[name] for name in ("cut_area", "fill_area")}
    columns |= {"unchanged_area": unchanged, "surface_area": by_name["surface_area"]}
    columns |= {"base_surface_area": by_name["other_surface_area"]} | alone
    for name, values in (*((n, by_name[n]) for n in ("lowest", "highest")), ("mean", mean)):
        columns[name] = np.where(is_met, values, np.nan)
    return Table(
        columns,
        units=_list_units(columns, reference),
        name="volumes",
        notes=[*reference.notes, *notes],
    )


def _list_units(columns: dict[str, Any], reference: Reference) -> dict[str, Any]:
    units: dict[str, Any] = {name: reference.units.area for name in columns if "area" in name}
    units |= dict.fromkeys(("cut", "fill", "net"), reference.units.volume)
    return units | dict.fromkeys(("lowest", "highest", "mean"), reference.elevation_unit)
