"""Mending flats: points along the skeletons of flat regions, with elevations between contours."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from ....base.checks import require_tin
from ....base.products import product
from ....base.progress import Progress
from ....base.sentences import counted
from .regions import CAPS, NARROWEST, find_regions
from .skeleton import find_shares, trace_skeleton

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from ....base.arrays import AnyArray, Float64Array
    from ....tin import TIN
    from .regions import Regions
    from .skeleton import Skeleton

ORIGIN = "origin"
"""The attribute that tells points that were added from those that were measured; with an underscore
behind where the survey has another one of this name."""

_GIVEN, _ADDED = "given", "added"


@product
def mend_flats(tin: TIN, *, progress: Callable[[float], None] | None = None) -> TIN:
    """Add points along ridges, valleys, peaks and pits where contours leave flat triangles.

    Parameters
    ----------
    tin : TIN
        With its contours as lines, such as those of
        ``ts.read("contours.gpkg", lines_as="breaklines")``.
    progress : callable, optional
        Called with the fraction done, ascending to 1.0, between the stages. What it raises ends
        the call.

    Returns
    -------
    TIN
        With the points added as the last rows. Its attribute ``"origin"`` is "added" for these and
        "given" for all rows before; ``report.notes`` count them, and the flat triangles left.

    Raises
    ------
    PointsError
        If what is given is no TIN.

    Notes
    -----
    The points are the skeletons of the flat regions [1]_ [2]_, here the middles of the edges across
    them [3]_. Along a ridge or a valley the elevation goes straight from the contour around
    the skeleton's tip to the next contour, branches likewise from where they leave it. On a peak or
    in a pit it goes on with the slope outside, s, and flattens out: at a distance r from the
    contour it is h (1 - exp(-s r / h)) beyond it, h being the interval. So every added point lies
    between its contour and the next one, never on either or beyond.

    It is an estimate: nothing in the contours tells how high a peak is. Regions are left flat where
    the contours around do not tell which way the ground goes; :func:`tinsmith.flats` shows them.

    References
    ----------
    .. [1] D. Thibault, C. M. Gold, Terrain reconstruction from contours by skeleton construction,
       GeoInformatica 4 (2000), doi:10.1023/A:1026509828354.
    .. [2] M. Dakowicz, C. M. Gold, Extracting meaningful slopes from terrain contours,
       International Journal of Computational Geometry and Applications 13 (2003),
       doi:10.1142/S0218195903001220.
    .. [3] L. Prasad, Morphological analysis of shapes, CNLS Newsletter 139, Los Alamos National
       Laboratory (1997).

    Examples
    --------
    >>> import tinsmith as ts
    >>> ring = [[0, 0], [30, 0], [30, 10], [0, 10], [0, 0]]
    >>> outer = [[-9, -9], [39, -9], [39, 19], [-9, 19], [-9, -9]]
    >>> lines = [[[x, y, z] for x, y in one] for one, z in ((ring, 5), (outer, 0))]
    >>> tin = ts.triangulate(ts.Survey(points=lines[0] + lines[1], breaklines=lines))
    >>> mended = ts.mend_flats(tin)
    >>> bool(5 < mended.points[:, 2].max() < 10)
    True
    >>> mended.attributes["origin"].tolist().count("added")
    1
    """
    require_tin(tin)
    done = Progress(progress)
    regions = find_regions(tin)
    done(0.2)
    skeleton = trace_skeleton(tin, regions)
    done(0.5)
    points = _lift(regions, skeleton)
    done(0.6)
    given = len(tin.vertex_of)
    mended = tin.to_tin()
    if len(points):
        mended.insert(points)
    annotated = _annotate(mended, regions, len(mended.vertex_of) - given)
    done.end()
    return annotated


def _lift(regions: Regions, skeleton: Skeleton) -> Float64Array:
    """Return the points of the skeletons that lie strictly between two elevations."""
    shares = find_shares(skeleton)
    of_node = skeleton.regions
    is_cap = np.isin(regions.kinds, CAPS)[of_node]
    interval = np.abs(regions.rises[of_node])
    with np.errstate(divide="ignore", invalid="ignore"):
        steepness = regions.slopes[of_node] * skeleton.radii / interval
    shares[is_cap] = -np.expm1(-steepness[is_cap])
    low = regions.elevations[of_node]
    z = low + shares * regions.rises[of_node]
    is_between = (shares > 0.0) & (shares < 1.0) & (z != low)
    is_between &= z != low + regions.rises[of_node]
    is_between &= skeleton.radii > NARROWEST * skeleton.widths
    found: Float64Array = np.column_stack([skeleton.xy, z])[is_between]
    return found


def _annotate(mended: TIN, regions: Regions, count: int) -> TIN:
    z = mended.points[mended.triangles, 2]
    left = int((z == z[:, :1]).all(axis=1).sum())
    note = (
        f"{counted(count, 'point')} {'was' if count == 1 else 'were'} added to "
        f"{counted(int((regions.region_of >= 0).sum()), 'flat triangle')} in "
        f"{counted(regions.size, 'region')}, at estimated elevations; {left:,} flat "
        f"{'triangle is' if left == 1 else 'triangles are'} left."
    )
    columns = _mark_added(mended.row_attributes, len(mended.vertex_of), count)
    report = replace(mended.report, notes=(*mended.report.notes, note))
    return mended.replace(row_attributes=columns, report=report)


def _mark_added(columns: Mapping[str, AnyArray], n_rows: int, count: int) -> dict[str, AnyArray]:
    """Return columns with one that tells which rows were added, now and earlier."""
    name = ORIGIN
    while name in columns and not np.isin(columns[name], [_GIVEN, _ADDED]).all():
        name += "_"
    origin = np.full(n_rows, _GIVEN)
    if name in columns:
        origin[: len(columns[name])] = columns[name]
    origin[n_rows - count :] = _ADDED
    return {**columns, name: origin}
