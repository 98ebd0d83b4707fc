"""TIN: the triangulated surface, with its measures and queries."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from . import _kernel, topology
from .errors import PointsError
from .lines import Lines
from .points import as_points, as_xy
from .report import Report
from .types import Bounds

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from .constrained import CrossingPolicy
    from .duplicates import DuplicatePolicy
    from .editing import Edit, History
    from .lines import BreaklineKind
    from .model import Model
    from .regions import Surface

__all__ = ["TIN"]

Scalar = TypeVar("Scalar", bound=np.generic)


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class TIN:
    """A triangulated irregular network: one height for every place inside its hull.

    Built by :func:`tinsmith.triangulate`, or from existing triangles by
    :meth:`TIN.from_triangles`. All arrays are read-only.

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
    crs : str or None
        Coordinate reference system, as authority code or WKT.
    """

    points: NDArray[np.float64]
    triangles: NDArray[np.int32]
    neighbors: NDArray[np.int32]
    constrained: NDArray[np.bool_]
    vertex_of: NDArray[np.int32]
    report: Report = field(repr=False)
    lines: Lines = field(default_factory=Lines, repr=False)
    crs: str | None = None

    def __post_init__(self) -> None:
        self._seal()

    def _seal(self) -> None:
        for array in (
            self.points,
            self.triangles,
            self.neighbors,
            self.constrained,
            self.vertex_of,
        ):
            array.flags.writeable = False

    @classmethod
    def from_triangles(
        cls,
        points: ArrayLike,
        triangles: ArrayLike,
        *,
        constrained: ArrayLike | None = None,
        crs: str | None = None,
    ) -> TIN:
        """Make a TIN of triangles that exist already, for example those of a file.

        Parameters
        ----------
        points : (n, 3) array, CRS units
        triangles : (m, 3) int array
            Vertex numbers; clockwise triangles are turned round.
        constrained : (m, 3) bool array, optional
            Flags of the edge opposite each corner as given; default none.
        crs : str, optional

        Raises
        ------
        PointsError
            If a vertex number is out of range, a triangle has no area, or triangles overlap
            along an edge.

        Examples
        --------
        >>> tin = TIN.from_triangles([[0, 0, 1], [1, 0, 2], [0, 1, 3]], [[0, 1, 2]])
        >>> tin
        <TIN: 3 vertices, 1 triangle, z 1 to 3, crs unknown>
        """
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
            crs=crs,
        )

    # ---------------------------------------------------------------- measures

    @cached_property
    def bounds(self) -> Bounds:
        """Bounds of the vertices."""
        return Bounds.of(self.points)

    @cached_property
    def edges(self) -> NDArray[np.int32]:
        """Every edge once, (k, 2) vertex pairs."""
        return _read_only(topology.edges(self.triangles, self.neighbors))

    @cached_property
    def rings(self) -> list[NDArray[np.int32]]:
        """Boundary rings as vertex numbers, the surface on the left; the outer one first."""
        rings = topology.boundary_rings(self.triangles, self.neighbors)
        west = [self.points[ring, 0].min() for ring in rings]
        return [_read_only(rings[i]) for i in np.argsort(west, kind="stable")]

    @property
    def hull(self) -> NDArray[np.int32]:
        """Vertices of the outer boundary, counter-clockwise, each once."""
        return self.rings[0]

    @cached_property
    def triangle_areas(self) -> NDArray[np.float64]:
        """Area of each triangle in the plane, (m,) array, CRS units squared."""
        first, second = self._edge_vectors()
        return _read_only(0.5 * (first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]))

    @cached_property
    def triangle_surface_areas(self) -> NDArray[np.float64]:
        """Area of each triangle in space, (m,) array, CRS units squared."""
        first, second = self._edge_vectors()
        return _read_only(0.5 * np.linalg.norm(np.cross(first, second), axis=1))

    @property
    def area(self) -> float:
        """Area in the plane, CRS units squared."""
        return float(self.triangle_areas.sum())

    @property
    def surface_area(self) -> float:
        """Area in space, CRS units squared."""
        return float(self.triangle_surface_areas.sum())

    def _edge_vectors(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        origin = self.points[self.triangles[:, 0]]
        return (
            self.points[self.triangles[:, 1]] - origin,
            self.points[self.triangles[:, 2]] - origin,
        )

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
        return self._locator.locate(as_xy(xy))

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
        return self._locator.interpolate(as_xy(xy))

    @cached_property
    def _locator(self) -> _kernel.Locator:
        return _kernel.Locator(self.points, self.triangles, self.neighbors)

    # ------------------------------------------------------------------- edits

    @property
    def edits(self) -> tuple[Edit, ...]:
        """What was done to the TIN since it was built, in order."""
        return tuple(self._history.edits) if "_history" in self.__dict__ else ()

    def insert(
        self, points: ArrayLike, *, duplicates: DuplicatePolicy = "last"
    ) -> NDArray[np.int32]:
        """Insert points, in place.

        Parameters
        ----------
        points : (k, 3) array
            They become further rows of input; a point on a line becomes a vertex of it.
        duplicates : {"last", "first", "mean", "lowest", "highest", "error"}
            Elevation of a vertex that stands at one of the places already.

        Returns
        -------
        (k,) int32 array
            The vertex of each point (-1 outside a clipped surface).

        Raises
        ------
        PointsError
            As :func:`tinsmith.triangulate`; then nothing has changed.

        Examples
        --------
        >>> from tinsmith import triangulate
        >>> tin = triangulate([[0, 0, 5], [4, 0, 6], [4, 3, 7], [0, 3, 8]])
        >>> tin.insert([[2, 1, 9]])
        array([4], dtype=int32)
        >>> tin
        <TIN: 5 vertices, 4 triangles, z 5 to 9, crs unknown>
        >>> tin.undo()
        >>> tin
        <TIN: 4 vertices, 2 triangles, z 5 to 8, crs unknown>
        """
        made: NDArray[np.int32] = self._edit("insert", points=points, duplicates=duplicates)
        return made

    def remove(self, vertices: ArrayLike) -> None:
        """Remove vertices, in place; those behind them move up, as in ``numpy.delete``.

        A line through a vertex runs straight on between the neighbours.

        Parameters
        ----------
        vertices : int or (k,) int array

        Raises
        ------
        PointsError
            If there is no such vertex, or no triangle would be left.
        LinesError
            If a line would vanish, or cross another. Then nothing has changed.
        """
        self._edit("remove", vertices=vertices)

    def move(self, vertex: int, point: ArrayLike) -> None:
        """Move a vertex, in place, and the lines through it.

        Parameters
        ----------
        vertex : int
        point : (3,) array

        Raises
        ------
        PointsError
            If there is no such vertex, or another one stands at the place.
        LinesError
            If a line would cross another. Then nothing has changed.
        """
        self._edit("move", vertex=vertex, point=point)

    def set_z(self, vertices: ArrayLike, z: ArrayLike) -> None:
        """Give vertices other elevations, in place.

        Parameters
        ----------
        vertices : int or (k,) int array
        z : float or (k,) array

        Raises
        ------
        PointsError
            If there is no such vertex, or an elevation is not finite.
        """
        self._edit("set_z", vertices=vertices, z=z)

    def flip(self, a: int, b: int) -> None:
        """Swap the diagonal of the two triangles at an edge, in place.

        The new edge is kept as a soft breakline named "flip"; flipping it again lets it go.

        Parameters
        ----------
        a, b : int
            Ends of the edge.

        Raises
        ------
        PointsError
            If there is no such inner edge, or the triangles are no convex quadrilateral.
        LinesError
            If it is the edge of another line.
        """
        self._edit("flip", a=a, b=b)

    def add_breakline(
        self,
        coords: ArrayLike,
        *,
        kind: BreaklineKind = "hard",
        priority: int = 0,
        name: str = "",
        crossing: CrossingPolicy = "split",
    ) -> None:
        """Add a breakline, in place.

        Parameters
        ----------
        coords : (k, 3) array, or (k, 2) to drape it
        kind, priority, name
            As in :class:`.Breakline`.
        crossing : {"split", "error"}
            Make a vertex where it crosses another line, with the height of the one of higher
            priority or of the older one, or refuse. ``edits[-1].notes`` tells both heights.

        Raises
        ------
        LinesError
            If the line is none, or crosses another and must not. Then nothing has changed.
        """
        self._edit(
            "add_breakline",
            coords=coords,
            kind=kind,
            priority=priority,
            name=name,
            crossing=crossing,
        )

    def remove_breakline(self, number: int) -> None:
        """Remove a breakline, in place; its vertices stay as points.

        Parameters
        ----------
        number : int
            As in ``lines.sources``.

        Raises
        ------
        LinesError
            If there is no such breakline.
        """
        self._edit("remove_breakline", number=number)

    def undo(self, count: int = 1) -> None:
        """Take back the last edits.

        Raises
        ------
        PointsError
            If there are not so many.
        """
        history = self._open_history()
        try:
            history.undo(count)
        finally:
            self._forget()

    def _edit(self, operation: str, **arguments: Any) -> Any:
        history = self._open_history()
        try:
            return history.do(operation, arguments)
        finally:
            self._forget()

    def _open_history(self) -> History:
        if "_history" not in self.__dict__:
            from .editing import History

            self.__dict__["_history"] = History(self, self.__dict__.get("_model"))
        history: History = self.__dict__["_history"]
        return history

    @property
    def _history(self) -> History:
        return self._open_history()

    def remember(self, model: Model) -> None:
        """Keep what the TIN was built from, for edits (for builders)."""
        self.__dict__["_model"] = model

    def renew(
        self,
        surface: Surface,
        lines: Lines,
        vertex_of: NDArray[np.int32],
        *,
        edits: tuple[Edit, ...],
    ) -> None:
        """Take the arrays that edits led to (for the history)."""
        before: Report = self.__dict__["report_before"]
        report = before.after_edits(vertex_of, len(surface.points), len(surface.triangles), edits)
        self.__dict__.update(
            points=surface.points,
            triangles=surface.triangles,
            neighbors=surface.neighbors,
            constrained=surface.constrained,
            vertex_of=vertex_of,
            lines=lines,
            report=report,
        )
        self._seal()

    def _forget(self) -> None:
        """Drop arrays that an edit made old; they come back when they are looked at."""
        self.__dict__.setdefault("report_before", self.__dict__.get("report"))
        for name in [*_RENEWED, *_DERIVED]:
            self.__dict__.pop(name, None)

    def __getattr__(self, name: str) -> Any:
        """Make an array that an edit made old."""
        if name in _RENEWED and "_history" in self.__dict__:
            self.__dict__["_history"].refresh(self)
            return self.__dict__[name]
        raise AttributeError(f"'TIN' object has no attribute '{name}'")

    def __repr__(self) -> str:
        count = len(self.triangles)
        z = self.points[:, 2]
        crs = "unknown" if self.crs is None else self.crs
        return (
            f"<TIN: {len(self.points)} vertices, {count} triangle{'s' * (count != 1)}, "
            f"z {z.min():g} to {z.max():g}, crs {crs if len(crs) <= 24 else crs[:21] + '...'}>"
        )


_RENEWED = (
    "points",
    "triangles",
    "neighbors",
    "constrained",
    "vertex_of",
    "lines",
    "report",
)
_DERIVED = tuple(name for name, value in vars(TIN).items() if isinstance(value, cached_property))


def _read_only(array: NDArray[Scalar]) -> NDArray[Scalar]:
    array.flags.writeable = False
    return array


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
        row = int(np.argmax(flat))
        raise PointsError(
            f"{int(flat.sum())} triangles have no area in the plane (first: triangle {row}, "
            f"vertices {triangles[row].tolist()}): a TIN needs triangles seen from above.",
            rows=np.flatnonzero(flat)[:5],
        )
    clockwise = turn < 0
    triangles, flags = triangles.copy(), flags.copy()
    triangles[clockwise] = triangles[clockwise][:, [0, 2, 1]]
    flags[clockwise] = flags[clockwise][:, [0, 2, 1]]
    return triangles, flags
