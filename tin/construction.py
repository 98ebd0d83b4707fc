"""Triangulate: elevation points, and lines, become a TIN."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from ..base.progress import Progress
from .building import BuildOptions, Survey, assemble, gather_inputs, separate_walls
from .surface import TIN

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from ..base.crs import CrsLike, UnitLike
    from ..base.policies import CrossingPolicy, DuplicatePolicy, TrimPolicy
    from ..base.types import GeometriesLike, PointsLike
    from .constraints import Breakline, Water


def triangulate(
    points: Survey | PointsLike,
    *,
    breaklines: Sequence[Breakline | ArrayLike] | GeometriesLike = (),
    boundary: Sequence[Any] | GeometriesLike = (),
    holes: Sequence[Any] | GeometriesLike = (),
    erase: Sequence[Any] | GeometriesLike = (),
    water: Sequence[Water] | GeometriesLike = (),
    max_edge: float | None = None,
    trim: TrimPolicy = "perimeter",
    crossing: CrossingPolicy = "split",
    walls: float | None = None,
    conforming: bool = False,
    duplicates: DuplicatePolicy = "mean",
    snap: float = 0.0,
    threads: int | None = None,
    crs: CrsLike | None = None,
    elevation_unit: UnitLike | None = None,
    progress: Callable[[float], None] | None = None,
) -> TIN:
    """Build the Delaunay TIN of a set of elevation points, and of lines that must be its edges.

    The triangulation is grown: from every open edge to the point that sees it under the largest
    angle [1]_. Ties between cocircular points are broken by the points' own coordinates, so the
    result is a function of the point *set*: the same for every order of the rows. With lines it is
    the constrained Delaunay triangulation, a function of the sets of points and lines.

    Parameters
    ----------
    points : Survey or (n, 3) array
        Easting and northing in CRS units, elevation. A survey's own lines are used as well. A
        structured array, data frame or mapping is taken by its columns' names (x, y, z; easting,
        northing, elevation; lon, lat, height), points of shapely, GeoPandas or a
        ``__geo_interface__`` by their coordinates. Masked rows are left out, and named in the
        report.
    breaklines : sequence of Breakline or arrays, or geometries
        Polylines that must be edges: (k, 3) arrays hard ones, (k, 2) arrays draped on the surface
        of everything that has elevations, with a vertex wherever they cross an edge of it. Here and
        for other lines, geometries are those of shapely, a GeoSeries or GeoDataFrame, Features, or
        whatever has a ``__geo_interface__``; each part counts as a line. Their columns ``kind``,
        ``priority`` and ``name`` are honoured.
    boundary : sequence of (k, 2) or (k, 3) arrays, or polygons
        Rings: only the surface inside is kept; a ring within a ring cuts out an island. Draped if
        without elevations; what lies beyond the surface of the points is left out. The points are
        triangulated with the rings; :func:`tinsmith.clip` cuts a finished surface and does not
        change it.
    holes : sequence of (k, 2) or (k, 3) arrays, or polygons
        Rings: the surface inside is cut away. Each ring is a region of its own; one with islands,
        which stay, is a polygon: of shapely or whatever has a ``__geo_interface__``, or a sequence
        of rings, inside being what an odd number of them holds.
    erase : sequence of (k, 2) arrays, or polygons
        Rings: the points strictly inside are left out, and the surface spans them. As for holes, a
        polygon's islands stay.
    water : sequence of Water, or geometries
        Flat polygons: points and parts of breaklines inside are left out, all vertices on the ring
        are put at its elevation. That of a geometry is in a column ``z``, ``level``, ``elevation``
        or ``height``, else that of its corners, if all are equal.
    max_edge : float, optional
        Drop triangles at edges longer than this that are no lines, CRS units.
    trim : {"perimeter", "everywhere"}
        Drop them from the outside inwards only, or wherever they are.
    crossing : {"split", "error"}
        Where lines cross between their vertices, make a vertex with the elevation of the line of
        higher priority, or of the first; of a line that crosses itself the lower one; or refuse.
        Both elevations are in the report.
    walls : float, optional
        Breaklines along one line in the plane, with the same vertices, whose elevations differ are
        walls and faces of kerbs: the upper one stays, the lower one is moved by this to the side
        where the ground is lower, CRS units. Default none: of two elevations at a vertex that of
        the line of higher priority, or of the first, counts.
    conforming : bool
        Split the segments of lines until every edge is Delaunay, constrained or not. Refused if
        that takes more than 50 new vertices for each vertex, and 20,000 in all.
    duplicates : {"mean", "first", "last", "lowest", "highest", "error"}
        Elevation of the vertex that stands for several rows at one place. A line with elevations of
        its own counts more than the points.
    snap : float
        Merge points no further apart than this, CRS units, and bend lines onto points no further
        away. Afterwards all vertices are more than ``snap`` apart, and no point has moved by more.
        0 merges exact duplicates only.
    threads : int, optional
        Number of threads; default every core, where it pays. The result is the same.
    crs : CRS, str, int or pyproj.CRS, optional
        Coordinate reference system of the points: a code ("EPSG:32616"), number, WKT; default that
        of the survey, points or lines.
    elevation_unit : Unit or str, optional
        Unit of all elevations ("m", "ft", "US survey foot"), lines included; default the survey's
        own, else that of the CRS's vertical axis, else not known.
    progress : callable, optional
        Called with the fraction done, ascending to 1.0, on the calling thread: finely while the
        triangulation is grown, else between the stages. What it raises ends the call.

    Returns
    -------
    TIN

    Raises
    ------
    PointsError
        If names of columns do not tell the coordinates, if a coordinate is not finite or outside
        the exact range, if fewer than three places are distinct, if all are collinear, or
        (``duplicates="error"``) if two rows coincide.
    CrsError
        If the CRS is unknown, or another than that of the survey, the points or the lines; if walls
        are asked for and coordinates are angles.
    OptionError
        If an option is none of the allowed; if ``elevation_unit`` is unknown, or another than the
        one that survey or CRS give.
    LinesError
        If a line has too few vertices or coordinates that are not finite, if a ring crosses
        itself, if lines cross and must not, if a hole lies outside, or if no triangle is left; if
        the lines of a wall cross, or points do not tell its lower side.

    Notes
    -----
    Exact for coordinates of magnitude 0 or 6e-61 to 1e75. Time and memory grow linearly with the
    points. A place where lines cross is rounded to coordinates once; from there on both lines run
    through that vertex exactly.

    A TIN has one elevation at each place: the lines of a wall are a distance apart, the lower one
    at least, and by at most some roundings of coordinates more. Where both have one elevation, as
    where a wall ends, they meet.

    References
    ----------
    .. [1] "Research on Algorithm of the Point Set in the Plane Based on Delaunay Triangulation".

    Examples
    --------
    >>> triangulate([[0, 0, 5], [4, 0, 6], [4, 3, 7], [0, 3, 8], [2, 1, 9]])
    <TIN: 5 vertices, 4 triangles, z 5 to 9, crs unknown>
    >>> square = [[0, 0, 5], [4, 0, 6], [4, 4, 7], [0, 4, 8]]
    >>> triangulate(square, breaklines=[[[0, 0, 5], [4, 4, 7]]]).lines
    <Lines: 1 hard, 0 soft, 0 boundary, 0 hole, 0 water; 2 vertices>
    """
    done = Progress(progress)
    options = BuildOptions(
        max_edge=max_edge,
        trim=trim,
        crossing=crossing,
        conforming=conforming,
        duplicates=duplicates,
        snap=snap,
        threads=threads,
    )
    inputs = gather_inputs(
        points,
        options,
        breaklines=breaklines,
        boundary=boundary,
        holes=holes,
        erase=erase,
        water=water,
        crs=crs,
        elevation_unit=elevation_unit,
    )
    if walls is not None:
        inputs = separate_walls(inputs, walls, _measure)
    tin = TIN._of(
        assemble(inputs, done),
        inputs,
        crs=inputs.crs,
        elevation_unit=inputs.elevation_unit,
        row_attributes=points.attributes if isinstance(points, Survey) else {},
    )
    done.end()
    return tin


def _measure(points: Any, places: Any) -> Any:
    """Return elevations of the surface of points at places."""
    return triangulate(points).interpolate(places, method="linear")
