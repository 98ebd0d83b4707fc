"""Triangulate: elevation points become a TIN."""

from __future__ import annotations

from typing import TYPE_CHECKING, get_args

import numpy as np

from . import _kernel
from .duplicates import DuplicatePolicy, merge_rows
from .errors import PointsError
from .points import as_points
from .report import Report
from .surface import TIN
from .survey import Survey
from .threads import thread_count

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

__all__ = ["triangulate"]


def triangulate(
    points: Survey | ArrayLike,
    *,
    duplicates: DuplicatePolicy = "mean",
    snap: float = 0.0,
    threads: int | None = None,
    crs: str | None = None,
) -> TIN:
    """Build the Delaunay TIN of a set of elevation points.

    The triangulation is grown: from every open edge to the point that sees it under the largest
    angle [1]_. Ties between cocircular points are broken by the points' own coordinates, so the
    result is a function of the point *set*: the same for every order of the rows.

    Parameters
    ----------
    points : Survey or (n, 3) array
        Easting, northing, elevation, CRS units.
    duplicates : {"mean", "first", "last", "lowest", "highest", "error"}
        Elevation of the vertex that stands for several rows at one place.
    snap : float
        Merge points no further apart than this, CRS units. Afterwards all vertices are more than
        ``snap`` apart, and no point has moved by more. 0 merges exact duplicates only.
    threads : int, optional
        Number of threads; default every core, where it pays. The result is the same.
    crs : str, optional
        Coordinate reference system; default the survey's own.

    Returns
    -------
    TIN

    Raises
    ------
    PointsError
        If a coordinate is not finite or outside the exact range, if fewer than three places are
        distinct, if all are collinear, or (``duplicates="error"``) if two rows coincide; if an
        option is none of the allowed.

    Notes
    -----
    Exact for coordinates of magnitude 0 or 6e-61 to 1e75. Time and memory grow linearly.

    References
    ----------
    .. [1] "Research on Algorithm of the Point Set in the Plane Based on Delaunay Triangulation".

    Examples
    --------
    >>> triangulate([[0, 0, 5], [4, 0, 6], [4, 3, 7], [0, 3, 8], [2, 1, 9]])
    <TIN: 5 vertices, 4 triangles, z 5 to 9, crs unknown>
    """
    _require_options(duplicates, snap)
    survey = points if isinstance(points, Survey) else Survey(points=np.empty((0, 3)))
    _require_no_lines(survey)
    xyz = as_points(points.points if isinstance(points, Survey) else points, threads=threads)
    if len(xyz) < 3:
        raise PointsError(
            f"{len(xyz)} points cannot make a TIN: at least three not collinear ones are needed."
        )
    n_threads = thread_count(threads, len(xyz))
    kept_row = _kernel.snap(xyz, float(snap)) if snap > 0 else None
    growth = _kernel.grow(xyz if kept_row is None else _kept(xyz, kept_row), threads=n_threads)
    merged = merge_rows(xyz, growth.kept_row if kept_row is None else kept_row, duplicates)
    return TIN(
        points=merged.points,
        triangles=growth.triangles,
        neighbors=growth.neighbors,
        constrained=np.zeros(growth.triangles.shape, np.bool_),
        vertex_of=merged.vertex_of,
        report=Report(
            n_rows=len(xyz),
            n_vertices=len(merged.points),
            n_triangles=len(growth.triangles),
            duplicates=duplicates,
            snap=float(snap),
            skipped=survey.skipped,
            notes=survey.notes,
            **merged.account,
        ),
        crs=crs if crs is not None else survey.crs,
    )


def _kept(xyz: NDArray[np.float64], kept_row: NDArray[np.int32]) -> NDArray[np.float64]:
    kept: NDArray[np.float64] = xyz[kept_row == np.arange(len(xyz), dtype=np.int32)]
    return kept


def _require_options(duplicates: str, snap: float) -> None:
    allowed = get_args(DuplicatePolicy)
    if duplicates not in allowed:
        raise PointsError(f"Invalid duplicates '{duplicates}': one of {', '.join(allowed)}.")
    if not (isinstance(snap, int | float | np.number) and 0 <= snap < np.inf):
        raise PointsError(f"Invalid snap {snap!r}: a distance >= 0 in CRS units is needed.")


def _require_no_lines(survey: Survey) -> None:
    if survey.has_lines:
        raise PointsError(
            "The survey holds breaklines, boundaries, holes or water, which this version cannot "
            "force into the TIN: pass survey.points to triangulate the points alone."
        )
