"""TIN: the triangulated surface, with its measures and queries."""

from __future__ import annotations

from dataclasses import Field, FrozenInstanceError, make_dataclass
from typing import TYPE_CHECKING, Any, ClassVar, Never

import numpy as np

from ..crs import CRS, Unit, require_one_unit, scale_elevations, shorten_crs
from ..errors import PointsError
from . import _kernel, topology
from .constraints.breaklines import Lines
from .editing.editable import Editable
from .editing.version import Version
from .report import Report
from .triangulation import Triangulation
from .validation.points import as_points, as_xy

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from ..crs import CrsLike, UnitLike
    from .building.inputs import Recipe
    from .types import Bounds
    from .voronoi.diagram import Voronoi


__all__ = ["TIN"]

_ARGUMENTS = (
    "points",
    "triangles",
    "neighbors",
    "constrained",
    "vertex_of",
    "report",
    "lines",
    "crs",
    "elevation_unit",
)


class TIN(Editable):
    """A triangulated irregular network: one height for every place inside its hull.

    Built by :func:`tinsmith.triangulate`, or from existing triangles by
    :meth:`TIN.from_triangles`. All arrays are read-only; edits replace them by others.

    Attributes
    ----------
    points : (n, 3) float64 array
        Easting, northing, elevation of the vertices, in the order given.
    triangles : (m, 3) int32 array
        Vertices of each triangle, counter-clockwise seen from above.
    neighbors : (m, 3) int32 array
        The triangle across the edge opposite each corner; -1 outside.
    constrained : (m, 3) bool array
        Whether that edge is a breakline, boundary or hole.
    vertex_of : (n_input,) int32 array
        The vertex that stands for each input row.
    report : Report
        What became of every input row.
    lines : Lines
        Breaklines, boundary, holes and water, as chains of vertices.
    crs : CRS or None
        Coordinate reference system.
    elevation_unit : Unit or None
        Unit of elevations; None if it is not known.

    Notes
    -----
    Several threads may read and edit one TIN. Each attribute and each method sees the TIN as it was
    between two edits; for several attributes that belong together take ``tin.triangulation``, or a
    copy first. Copies (``copy.copy``, ``copy.deepcopy``, pickles) share nothing that changes: each
    is edited on its own, and takes back the edits made before it was copied.
    """

    __slots__ = ("__weakref__", "_crs", "_elevation_unit")

    # ``dataclasses.replace(tin, crs=...)`` makes a TIN that differs in some arguments.
    __dataclass_fields__: ClassVar[dict[str, Field[Any]]] = vars(
        make_dataclass("Arguments", _ARGUMENTS, kw_only=True)
    )["__dataclass_fields__"]

    def __init__(
        self,
        *,
        points: NDArray[np.float64],
        triangles: NDArray[np.int32],
        neighbors: NDArray[np.int32],
        constrained: NDArray[np.bool_],
        vertex_of: NDArray[np.int32],
        report: Report,
        lines: Lines | None = None,
        crs: CrsLike | None = None,
        elevation_unit: UnitLike | None = None,
        inputs: Recipe | None = None,
    ) -> None:
        system = CRS.of(crs)
        unit = require_one_unit(system, Unit.of(elevation_unit))
        triangulation = Triangulation(
            points=points, triangles=triangles, neighbors=neighbors, constrained=constrained
        )
        version = Version(
            triangulation=triangulation,
            vertex_of=vertex_of,
            report=report,
            lines=Lines() if lines is None else lines,
        )
        super().__init__(version, inputs)
        self._crs = system
        self._elevation_unit = unit

    @classmethod
    def from_triangles(
        cls,
        points: ArrayLike,
        triangles: ArrayLike,
        *,
        constrained: ArrayLike | None = None,
        crs: CrsLike | None = None,
        z_unit: UnitLike | None = None,
    ) -> TIN:
        """Make a TIN of triangles that exist already, for example those of a file.

        Parameters
        ----------
        points : (n, 3) array, CRS units
        triangles : (m, 3) int array
            Vertex numbers; clockwise triangles are turned round.
        constrained : (m, 3) bool array, optional
            Flags of the edge opposite each corner as given; default none.
        crs : CRS, str, int or pyproj.CRS, optional
        z_unit : Unit or str, optional
            Unit of the elevations; default that of the CRS's vertical axis, else not known.

        Raises
        ------
        CrsError
            If the CRS is unknown.
        OptionError
            If ``z_unit`` is unknown, or another than that of the CRS's vertical axis.
        PointsError
            If a vertex number is out of range, a triangle has no area, or triangles overlap
            along an edge.

        Examples
        --------
        >>> tin = TIN.from_triangles([[0, 0, 1], [1, 0, 2], [0, 1, 3]], [[0, 1, 2]])
        >>> tin
        <TIN: 3 vertices, 1 triangle, z 1 to 3, crs unknown>
        """
        system = CRS.of(crs)
        unit = require_one_unit(system, Unit.of(z_unit))
        xyz = as_points(points)
        corners = _as_triangles(triangles, len(xyz))
        flags = _as_flags(constrained, len(corners))
        corners, flags = _turned_counter_clockwise(xyz, corners, flags)
        return cls(
            points=xyz,
            triangles=corners,
            neighbors=topology.neighbors_of(corners, len(xyz)),
            constrained=flags,
            vertex_of=np.arange(len(xyz), dtype=np.int32),
            report=Report(n_rows=len(xyz), n_vertices=len(xyz), n_triangles=len(corners)),
            crs=system,
            elevation_unit=unit,
        )

    def __setattr__(self, name: str, value: Never) -> None:
        if not name.startswith("_"):
            raise FrozenInstanceError(f"cannot assign to '{name}' of a TIN: edits change it")
        super().__setattr__(name, value)

    # ---------------------------------------------------------------- arrays

    @property
    def triangulation(self) -> Triangulation:
        """Points, triangles, neighbours and flags that belong together; never changed."""
        return self._current.triangulation

    @property
    def points(self) -> NDArray[np.float64]:
        """Easting, northing, elevation of the vertices, (n, 3) array."""
        return self._current.triangulation.points

    @property
    def triangles(self) -> NDArray[np.int32]:
        """Vertices of each triangle, counter-clockwise, (m, 3) array."""
        return self._current.triangulation.triangles

    @property
    def neighbors(self) -> NDArray[np.int32]:
        """The triangle across the edge opposite each corner, (m, 3) array; -1 outside."""
        return self._current.triangulation.neighbors

    @property
    def constrained(self) -> NDArray[np.bool_]:
        """Whether that edge is a breakline, boundary or hole, (m, 3) array."""
        return self._current.triangulation.constrained

    @property
    def vertex_of(self) -> NDArray[np.int32]:
        """The vertex that stands for each input row, (n_input,) array; -1 for none."""
        return self._current.vertex_of

    @property
    def report(self) -> Report:
        """What became of every input row."""
        return self._current.report

    @property
    def lines(self) -> Lines:
        """Breaklines, boundary, holes and water, as chains of vertices."""
        return self._current.lines

    @property
    def crs(self) -> CRS | None:
        """Coordinate reference system."""
        return self._crs

    @property
    def elevation_unit(self) -> Unit | None:
        """Unit of elevations; None if it is not known."""
        return self._elevation_unit

    def __getstate__(self) -> dict[str, Any]:
        return super().__getstate__() | {"_crs": self._crs, "_elevation_unit": self._elevation_unit}

    @property
    def _reference(self) -> dict[str, Any]:
        return {"crs": self._crs, "elevation_unit": self._elevation_unit}

    def replace(self, **changes: Any) -> TIN:
        """Return a TIN that differs in some arguments of the constructor; it has no edits.

        Examples
        --------
        >>> tin = TIN.from_triangles([[0, 0, 1], [1, 0, 2], [0, 1, 3]], [[0, 1, 2]])
        >>> tin.replace(crs="EPSG:32616").crs
        CRS('EPSG:32616')
        """
        version = self._current
        given = {name: getattr(version.triangulation, name) for name in _ARGUMENTS[:4]}
        given |= {name: getattr(version, name) for name in _ARGUMENTS[4:7]}
        return type(self)(**(given | self._reference | changes))

    # ---------------------------------------------------------------- measures

    @property
    def bounds(self) -> Bounds:
        """Bounds of the vertices."""
        return self._current.triangulation.bounds

    @property
    def edges(self) -> NDArray[np.int32]:
        """Every edge once, (k, 2) vertex pairs."""
        return self._current.triangulation.edges

    @property
    def rings(self) -> list[NDArray[np.int32]]:
        """Boundary rings as vertex numbers, the surface on the left; the outer one first."""
        return list(self._current.triangulation.rings)

    @property
    def hull(self) -> NDArray[np.int32]:
        """Vertices of the outer boundary, counter-clockwise, each once."""
        return self._current.triangulation.rings[0]

    @property
    def triangle_areas(self) -> NDArray[np.float64]:
        """Area of each triangle in the plane, (m,) array, CRS units squared."""
        return self._current.triangulation.triangle_areas

    @property
    def triangle_surface_areas(self) -> NDArray[np.float64]:
        """Area of each triangle in space, (m,) array, CRS units squared, elevations converted.

        Raises CrsError where coordinates are longitude and latitude.
        """
        scale = scale_elevations(self.crs, self.elevation_unit)
        return self._current.triangulation.surface_areas(scale)

    @property
    def area(self) -> float:
        """Area in the plane, CRS units squared."""
        return float(self.triangle_areas.sum())

    @property
    def surface_area(self) -> float:
        """Area in space, CRS units squared, elevations converted to them."""
        return float(self.triangle_surface_areas.sum())

    # ---------------------------------------------------------------- queries

    def locate(self, xy: ArrayLike) -> NDArray[np.int32]:
        """Find the triangle that holds each place.

        Parameters
        ----------
        xy : (k, 2) array, CRS units

        Returns
        -------
        (k,) int32 array
            Triangle number, -1 outside the surface; on an edge or a vertex the smallest number
            of the triangles that meet there. Decided by exact predicates.

        Raises
        ------
        PointsError
            If ``xy`` has another shape, or a coordinate is infinite or too large. NaN is outside.
        """
        return self._current.triangulation.locator.locate(as_xy(xy))

    def interpolate(self, xy: ArrayLike) -> NDArray[np.float64]:
        """Interpolate the elevation linearly at each place.

        Parameters
        ----------
        xy : (k, 2) array, CRS units

        Returns
        -------
        (k,) float64 array
            Elevation, NaN outside the surface; at a vertex exactly the vertex's own.

        Raises
        ------
        PointsError
            As :meth:`locate`.
        """
        return self._current.triangulation.locator.interpolate(as_xy(xy))

    # ---------------------------------------------------------------- dual

    def voronoi(
        self, *, boundary: Bounds | ArrayLike | None = None, pad: float | None = None
    ) -> Voronoi:
        """Build the Voronoi diagram of the vertices: for each the places nearest to it.

        Two vertices are joined by an edge of the Delaunay triangulation where their cells share
        a side [1]_.

        Parameters
        ----------
        boundary : Bounds or (k, 2) array, optional
            What the cells are clipped to: a rectangle, or the corners of a ring, convex or not,
            CRS units.
        pad : float, optional
            Without a boundary, the bounds of the vertices are taken, this far outwards on every
            side, CRS units. Default: a tenth of their longer side.

        Returns
        -------
        Voronoi
            One cell for each vertex, in their order; of vertices at one place the first has it.

        Raises
        ------
        PointsError
            If ``pad`` is no distance, or given together with a boundary.
        LinesError
            If the boundary has fewer than three corners, coordinates that are not finite, no
            area, or touches itself.

        Notes
        -----
        The diagram is that of the vertices alone, the dual of their Delaunay triangulation, which
        is built anew: constraints, clipping and other triangles of the TIN have no part in it.
        Where more than three cells meet (as in every raster), exact predicates tell, and the
        corner is the same in all of them; there are no sides of length zero. Corners are rounded
        to coordinates, circumcentres far outside the boundary never enter. Time and memory grow
        as n log n; a ring, other than bounds that hold all vertices, takes shapely.

        References
        ----------
        .. [1] R. Sibson, "Locally equiangular triangulations", The Computer Journal 21 (1978),
           243-245. https://doi.org/10.1093/comjnl/21.3.243

        Examples
        --------
        >>> tin = TIN.from_triangles([[0, 0, 1], [4, 0, 2], [0, 4, 3]], [[0, 1, 2]])
        >>> tin.voronoi(pad=0).areas
        array([4., 6., 6.])
        """
        from .voronoi.diagram import voronoi

        return voronoi(self, boundary=boundary, pad=pad)

    def __repr__(self) -> str:
        surface = self._current.triangulation
        count = len(surface.triangles)
        z = surface.points[:, 2]
        return (
            f"<TIN: {len(surface.points)} vertices, {count} triangle{'s' * (count != 1)}, "
            f"z {z.min():g} to {z.max():g}, crs {shorten_crs(self.crs)}>"
        )


def _as_triangles(triangles: ArrayLike, n_vertices: int) -> NDArray[np.int32]:
    try:
        given = np.asarray(triangles)
    except ValueError:
        raise PointsError("Triangles have rows of unequal length: three integers a row.") from None
    if given.ndim != 2 or given.shape[1] != 3 or len(given) == 0:
        raise PointsError(
            f"Triangles have shape {given.shape}: they must be (m, 3) vertex numbers, m >= 1."
        )
    if given.dtype.kind not in "iu":
        raise PointsError(f"Triangles are {given.dtype}: vertex numbers must be integers.")
    wrong = ((given < 0) | (given >= n_vertices)).any(axis=1)
    if wrong.any():
        row = int(np.argmax(wrong))
        raise PointsError(
            f"Triangle {row} has the vertices {given[row].tolist()}: "
            f"numbers 0 to {n_vertices - 1} are allowed.",
            rows=np.flatnonzero(wrong)[:5],
        )
    return np.ascontiguousarray(given, np.int32)


def _as_flags(constrained: ArrayLike | None, n_triangles: int) -> NDArray[np.bool_]:
    if constrained is None:
        return np.zeros((n_triangles, 3), np.bool_)
    try:
        flags = np.array(constrained, np.bool_)
    except ValueError:
        raise PointsError("Edge flags have rows of unequal length: three flags a row.") from None
    if flags.shape != (n_triangles, 3):
        raise PointsError(
            f"Edge flags have shape {flags.shape}: one row of three a triangle is needed, "
            f"({n_triangles}, 3)."
        )
    return flags


def _turned_counter_clockwise(
    points: NDArray[np.float64], triangles: NDArray[np.int32], flags: NDArray[np.bool_]
) -> tuple[NDArray[np.int32], NDArray[np.bool_]]:
    xy = points[:, :2]
    turn = _kernel.orientation(*(np.ascontiguousarray(xy[triangles[:, k]]) for k in range(3)))
    flat = turn == 0
    if flat.any():
        row, count = int(np.argmax(flat)), int(flat.sum())
        what = "triangle has" if count == 1 else "triangles have"
        raise PointsError(
            f"{count} {what} no area in the plane (first: triangle {row}, "
            f"vertices {triangles[row].tolist()}): a TIN needs triangles seen from above.",
            rows=np.flatnonzero(flat)[:5],
        )
    clockwise = turn < 0
    triangles, flags = triangles.copy(), flags.copy()
    triangles[clockwise] = triangles[clockwise][:, [0, 2, 1]]
    flags[clockwise] = flags[clockwise][:, [0, 2, 1]]
    return triangles, flags
