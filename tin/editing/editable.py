"""Editable: the methods of a TIN that change it, its copies, and who may do what at a time.

A TIN holds a version, an immutable value, and since its first edit a session. An edit changes the
session alone; the next version is made of it when one is looked at, and takes the place of the old
one in one assignment. A reader holds on to one version, so it never sees half of an edit; a lock
lets one thread at a time into the session.

Most edits are of one vertex. While there is no version the session lends what does them in the
compiled core, each in one call that no other thread gets into; so they need no lock. Whoever enters
the session takes it back first, and from then on they wait for the lock like all others.
"""

from __future__ import annotations

from threading import RLock
from typing import TYPE_CHECKING, Any, Self, cast

import numpy as np

from ...base.crs import measure_angular_unit
from ...base.errors import CrsError, LinesError
from ...base.georeference import agree
from ...base.ranges import require_degrees
from ..building import Survey, require_crs
from ..constraints import Breakline
from ..validation import as_table, is_plain
from .arguments import as_array, scale_breakline, write_breakline
from .session import Origin, Session

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import ArrayLike

    from ...base.arrays import Float64Array, Int32Array, Int64Array
    from ...base.crs import CRS
    from ...base.policies import BreaklineKind, CrossingPolicy, DuplicatePolicy
    from .._kernel import EditedMesh
    from ..building import BuildInputs, Version
    from ..report import Edit

_ONE = np.zeros(1, np.int32)

_PLACES = {"points": "Points", "point": "Points", "coords": "Vertices of the breakline"}
"""Arguments of edits that are coordinates, and what errors call them."""


class Editable:
    """What a TIN can have done to it.

    Edits change the inputs; the TIN is the build of the inputs. After any edits it equals, to the
    last bit, what :func:`tinsmith.triangulate` gives with the same options for the rows and lines
    that are there then, in the order in which they came. Only ``vertex_of`` and the row numbers of
    the report keep counting removed rows: their vertex is -1, the others are in order.

    Parameters
    ----------
    version : Version
    inputs : BuildInputs or None
        What it was built from; None for one of existing triangles.
    """

    __slots__ = ("_inputs", "_lent", "_lock", "_origin", "_session", "_version")

    _crs: CRS | None

    def __init__(self, version: Version, inputs: BuildInputs | None) -> None:
        self._version: Version | None = version
        self._session: Session | None = None
        self._inputs = inputs
        self._origin: Origin | None = None
        self._lent: EditedMesh | None = None
        self._lock = RLock()

    @property
    def _current(self) -> Version:
        """The TIN between two edits."""
        version = self._version
        if version is not None:
            return version
        with self._lock:
            if self._version is None:
                self._version = self._open_session().version()
            return self._version

    @property
    def edits(self) -> tuple[Edit, ...]:
        """What was done to the TIN since it was built, in order."""
        with self._lock:
            if self._session is not None:
                return self._open_session().list_edits()
            return () if self._origin is None else self._origin.edits

    def _settle(self) -> tuple[Version, Origin]:
        """Return what the TIN is, and what it was before its edits."""
        with self._lock:
            version = self._current
            if self._session is not None:
                return version, self._session.origin()
            return version, self._origin or Origin(self._inputs)

    def _gather_inputs(self) -> BuildInputs | None:
        """Return what the TIN is the build of, edits included; None for existing triangles."""
        with self._lock:
            if self._inputs is None:
                return None
            if self._session is None and self._origin is None:
                return self._inputs
            return self._open_session().inputs().build_inputs

    def _list_rows(self) -> Int64Array | None:
        """Return the numbers of the rows that inputs have after edits; None for all of them."""
        with self._lock:
            if self._inputs is None or (self._session is None and self._origin is None):
                return None
            return self._open_session().inputs().rows

    def _resume(self, origin: Origin) -> None:
        """Go on as the TIN did that was stored; its edits are done again when one follows."""
        self._inputs = origin.inputs
        self._origin = origin if origin.edits else None

    # ------------------------------------------------------------------- copies

    def __copy__(self) -> Self:
        other = type(self).__new__(type(self))
        other.__setstate__(self.__getstate__())
        return other

    def __deepcopy__(self, memo: dict[int, Any]) -> Self:
        return self.__copy__()

    def __getstate__(self) -> dict[str, Any]:
        with self._lock:
            session = None if self._session is None else self._open_session().copy()
            return {
                "_version": self._current,
                "_session": session,
                "_inputs": self._inputs,
                "_origin": self._origin,
                **getattr(self, "__dict__", {}),  # of a subclass
            }

    def __setstate__(self, state: dict[str, Any]) -> None:
        for name, value in ({"_origin": None} | state).items():
            setattr(self, name, value)
        self._lent = None
        self._lock = RLock()

    # -------------------------------------------------------------------- edits

    def insert(
        self,
        points: Survey | ArrayLike,
        *,
        duplicates: DuplicatePolicy = "last",
        breaklines: Sequence[Any] = (),
        attributes: Mapping[str, ArrayLike] | None = None,
    ) -> Int32Array:
        """Insert points, in place, and lines with them.

        Parameters
        ----------
        points : Survey or (k, 3) array
            They become further rows of input; a point on a line becomes a vertex of it. Of a
            survey the breaklines and attributes come with its points, and elevations are converted
            to the unit of the TIN.
        duplicates : {"last", "first", "mean", "lowest", "highest", "error"}
            Elevation of a vertex that stands at one of the places already: all rows, and the given
            vertices of lines there, get it. Points that ``snap`` merges with others are treated as
            in the build.
        breaklines : sequence of Breakline, arrays or mappings
            Added behind those that are there, in one build with the points; a mapping has the
            arguments of a breakline by their names.
        attributes : mapping of str to (k,) array, optional
            Further columns of the points. A column that the TIN has not is missing in its own
            rows, one that is not among these is missing in the new ones.

        Returns
        -------
        (k,) int32 array
            The vertex of each point, -1 outside a clipped surface or where points are erased.
            Vertices of lines alone come behind those of points, and move up.

        Raises
        ------
        PointsError, LinesError, OptionError
            As :func:`tinsmith.triangulate`, or if a survey has rings (boundary, holes, erase,
            water), which cannot be inserted; then nothing has changed.
        CrsError
            If a survey is in another CRS, or one of both is not known; if it cannot be told
            whether elevations are in one unit.

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
        lent = self._lent
        if lent is not None:
            vertex = lent.insert_one(points, duplicates)
            if vertex >= 0:
                made = _ONE.copy()  # half the time of making an array of a list
                made[0] = vertex
                return made
        if isinstance(points, Survey):
            points, more = self._take_survey(points)
            breaklines = [*more["breaklines"], *breaklines]
            attributes = more["attributes"] | dict(attributes or {})
        given: dict[str, Any] = {"points": points, "duplicates": duplicates}
        if len(breaklines):
            given["breaklines"] = [write_breakline(one) for one in breaklines]
        if attributes:
            given["attributes"] = {name: np.array(attributes[name]) for name in attributes}
        vertices: Int32Array = self._edit("insert", **given)
        return vertices

    def _take_survey(self, survey: Survey) -> tuple[Float64Array, dict[str, Any]]:
        """Return the points of a survey to be inserted, its lines and columns."""
        rings = ("boundary", "holes", "erase", "water", "extent")
        for name in (one for one in rings if len(getattr(survey, one))):
            raise LinesError(
                f"The survey has {'an extent' if name == 'extent' else name}: of a survey points "
                "and breaklines can be inserted; its rings are for a build of all points."
            )
        factors = agree((cast("Any", self), survey), ("the TIN", "the survey")).factors
        if factors[0] != 1.0:
            raise CrsError(
                "The unit of elevations of the TIN is not known, and that of the survey is: "
                "declare that of the TIN first.",
                crs=self._crs,
            )
        lines = [one if isinstance(one, Breakline) else Breakline(one) for one in survey.breaklines]
        scale = (1.0, 1.0, factors[1])
        if factors[1] != 1.0:
            lines = [one if one.is_draped else scale_breakline(one, factors[1]) for one in lines]
        columns = {name: survey.attributes[name] for name in survey.attributes}
        return survey.points * scale, {"breaklines": lines, "attributes": columns}

    def _count_inserted(self) -> list[int]:
        """Return how many rows each edit added."""
        with self._lock:
            return self._open_session().count_added()

    def remove(self, vertices: ArrayLike) -> None:
        """Remove vertices, in place; those behind them move up, as in ``numpy.delete``.

        The rows there go, and a line that names the vertex runs straight on between the
        neighbours. Where lines cross at the place, a vertex is left for them.

        Parameters
        ----------
        vertices : int or (k,) int array

        Raises
        ------
        PointsError
            If there is no such vertex, or no triangle would be left.
        LinesError
            If a line would vanish, or the vertex was made by the build (where lines cross, are laid
            on the surface, or are split): it goes with its lines. Then nothing has changed.

        Examples
        --------
        >>> from tinsmith import triangulate
        >>> tin = triangulate([[0, 0, 5], [4, 0, 6], [4, 3, 7], [0, 3, 8], [2, 1, 9]])
        >>> tin.remove(4)
        >>> tin
        <TIN: 4 vertices, 2 triangles, z 5 to 8, crs unknown>
        """
        lent = self._lent
        if lent is None or not lent.remove_one(vertices):
            self._edit("remove", vertices=vertices)

    def move(self, vertex: int, point: ArrayLike) -> None:
        """Move a vertex, in place: the rows there, and the lines that name it.

        Parameters
        ----------
        vertex : int
        point : (3,) array

        Raises
        ------
        PointsError
            If there is no such vertex, or another one stands at the place.
        LinesError
            If the vertex was made by the build, or a build refuses the lines as they are then.
            Then nothing has changed.

        Examples
        --------
        >>> from tinsmith import triangulate
        >>> tin = triangulate([[0, 0, 5], [4, 0, 6], [4, 3, 7], [0, 3, 8], [2, 1, 9]])
        >>> tin.move(4, [2, 2, 9])
        >>> tin.points[4].tolist()
        [2.0, 2.0, 9.0]
        """
        lent = self._lent
        if lent is None or not lent.move_one(vertex, point):
            self._edit("move", vertex=vertex, point=point)

    def set_elevation(self, vertices: ArrayLike, z: ArrayLike) -> None:
        """Give vertices other elevations, in place.

        All rows, and the given vertices of lines there, get it; at a vertex that the build made
        (where lines cross, say) it becomes that of a row inserted there.

        Parameters
        ----------
        vertices : int or (k,) int array
        z : float or (k,) array

        Raises
        ------
        PointsError
            If there is no such vertex, or an elevation is not finite.
        LinesError
            If something else decides there, such as the level of water. Then nothing has changed.

        Examples
        --------
        >>> from tinsmith import triangulate
        >>> tin = triangulate([[0, 0, 5], [4, 0, 6], [4, 3, 7], [0, 3, 8], [2, 1, 9]])
        >>> tin.set_elevation([0, 4], [4, 10])
        >>> tin.points[:, 2].tolist()
        [4.0, 6.0, 7.0, 8.0, 10.0]
        """
        lent = self._lent
        if lent is None or not lent.set_elevation_of_one(vertices, z):
            self._edit("set_elevation", vertices=vertices, z=z)

    def flip(self, a: int, b: int) -> None:
        """Swap the diagonal of the two triangles at an edge, in place.

        The new edge is kept as a soft breakline named "flip", from the left of the old one to its
        right; flipping it again lets it go.

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

        Examples
        --------
        >>> from tinsmith import triangulate
        >>> tin = triangulate([[0, 0, 5], [4, 0, 6], [4, 3, 7], [0, 3, 8]])
        >>> tin.is_edge([1, 0], [3, 2]).tolist()
        [True, False]
        >>> tin.flip(1, 3)
        >>> tin.is_edge([1, 0], [3, 2]).tolist()
        [False, True]
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
            Make a vertex where it crosses another line, with the elevation of the one of higher
            priority or of the first, or refuse. ``edits[-1].notes`` tells both elevations. A TIN
            that was built with ``crossing="error"`` refuses in any case.

        Raises
        ------
        LinesError
            If the line is none, or crosses another and must not. Then nothing has changed.
        OptionError
            If kind, priority, name or crossing is none that is allowed.

        Examples
        --------
        >>> from tinsmith import triangulate
        >>> tin = triangulate([[0, 0, 5], [4, 0, 6], [4, 3, 7], [0, 3, 8], [2, 1, 9]])
        >>> tin.add_breakline([[0, 0, 5], [4, 3, 7]])
        >>> bool(tin.constrained.any()), tin.lines.vertices.tolist()
        (True, [0, 2])
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
        """Remove a breakline, in place, with the vertices that only it had.

        Lines and vertices behind them move up, as if it had never been given; ``vertex_of`` keeps
        its rows.

        Parameters
        ----------
        number : int
            As in ``lines.sources``.

        Raises
        ------
        LinesError
            If there is no such breakline.

        Examples
        --------
        >>> from tinsmith import triangulate
        >>> tin = triangulate([[0, 0, 5], [4, 0, 6], [4, 3, 7], [0, 3, 8], [2, 1, 9]])
        >>> tin.add_breakline([[0, 0, 5], [4, 3, 7]])
        >>> tin.remove_breakline(0)
        >>> bool(tin.constrained.any())
        False
        """
        self._edit("remove_breakline", number=number)

    def undo(self, count: int = 1) -> None:
        """Take back the last edits.

        Raises
        ------
        PointsError
            If there are not so many.
        OptionError
            If ``count`` is no whole number above 0.

        Examples
        --------
        >>> from tinsmith import triangulate
        >>> tin = triangulate([[0, 0, 5], [4, 0, 6], [4, 3, 7], [0, 3, 8], [2, 1, 9]])
        >>> tin.remove(4)
        >>> tin.undo()
        >>> len(tin.points)
        5
        """
        with self._lock:
            self._open_session().undo(count)
            self._version = None

    def _edit(self, operation: str, **arguments: Any) -> Any:
        for name in _PLACES.keys() & arguments.keys():
            if not is_plain(arguments[name]):
                require_crs(arguments[name], self._crs, f"{name} of the edit")
                arguments[name] = as_array(arguments[name])
            # refuse what is no longitude and latitude; what is no coordinates, the operation does
            if self._is_in_degrees:
                rows = np.array(as_table(arguments[name], "Points", least=2).values, ndmin=2)
                if rows.ndim == 2 and rows.shape[1] >= 2:
                    require_degrees(rows, self._crs, _PLACES[name])
        with self._lock:
            session = self._open_session()
            result = session.do(operation, arguments)
            if self._version is not None:
                self._version = None
            if not self._is_in_degrees:  # the core knows no CRS
                self._lent = session.lend()
            return result

    @property
    def _is_in_degrees(self) -> bool:
        return measure_angular_unit(self._crs) is not None

    def _open_session(self) -> Session:
        """Return the session, which nobody else has until the lock is let go."""
        if self._lent is not None:
            self._lent.take_back()
            self._lent = None
        if self._session is None:
            version = cast("Version", self._version)
            if self._origin is None:
                self._session = Session(version, self._inputs)
            else:
                self._session = Session.resume(self._origin, version)
        return self._session
