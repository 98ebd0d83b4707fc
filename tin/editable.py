"""Editable: the methods of a TIN that change it in place, and how its arrays follow.

The arrays of a TIN are attributes. An edit drops them, and they are made anew when they are next
looked at; arrays that were handed out before stay as they were.
"""

from __future__ import annotations

from functools import cache, cached_property
from typing import TYPE_CHECKING, Any, cast

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from .constrained import CrossingPolicy
    from .duplicates import DuplicatePolicy
    from .editing import Edit, History
    from .lines import BreaklineKind, Lines
    from .model import Model
    from .regions import Surface
    from .report import Report
    from .surface import TIN

__all__ = ["Editable"]

_RENEWED = (
    "points",
    "triangles",
    "neighbors",
    "constrained",
    "vertex_of",
    "lines",
    "report",
)


@cache
def _derived(owner: type) -> tuple[str, ...]:
    """Return the names of what a class computes once from its arrays."""
    return tuple(
        name
        for base in owner.__mro__
        for name, value in vars(base).items()
        if isinstance(value, cached_property)
    )


class Editable:
    """What a TIN can have done to it."""

    points: NDArray[np.float64]
    triangles: NDArray[np.int32]
    neighbors: NDArray[np.int32]
    constrained: NDArray[np.bool_]
    vertex_of: NDArray[np.int32]

    def seal(self) -> None:
        """Make the arrays read-only (for builders)."""
        for array in (
            self.points,
            self.triangles,
            self.neighbors,
            self.constrained,
            self.vertex_of,
        ):
            array.flags.writeable = False

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

            self.__dict__["_history"] = History(cast("TIN", self), self.__dict__.get("_model"))
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
        self.seal()

    def _forget(self) -> None:
        """Drop arrays that an edit made old; they come back when they are looked at."""
        if "triangles" not in self.__dict__:
            return  # nobody has looked since the last edit
        self.__dict__.setdefault("report_before", self.__dict__.get("report"))
        for name in (*_RENEWED, *_derived(type(self))):  # type: ignore[arg-type]
            self.__dict__.pop(name, None)

    def __getattr__(self, name: str) -> Any:
        """Make an array that an edit made old."""
        if name in _RENEWED and "_history" in self.__dict__:
            self.__dict__["_history"].refresh(self)
            return self.__dict__[name]
        raise AttributeError(f"'TIN' object has no attribute '{name}'")
