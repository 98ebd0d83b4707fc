"""The triangulated surface: what can be asked of it, TIN, and snapshots of TINs."""

from __future__ import annotations

from dataclasses import FrozenInstanceError, fields, replace
from typing import TYPE_CHECKING, Any, Never, Self, cast, overload

import numpy as np

from ..base.crs import CRS, Unit, require_lengths, require_one_unit, scale_elevations, shorten_crs
from ..base.errors import choice
from ..base.lazy import call_method, make_html_repr, raise_missing
from ..base.notes import join_notes
from ..base.policies import Extrapolation, FeatureKind, InterpolationMethod
from ..base.ranges import describe_span, require_degrees
from ..base.sentences import counted
from ..base.types import seal
from . import topology
from .building import (
    Attributes,
    Version,
    as_columns,
    as_row_attributes,
    assemble,
    join_columns,
    move_inputs,
    move_points,
    require_crs,
    require_move,
)
from .constraints import Lines
from .editing import Editable, Origin
from .report import LEFT_OUT, Report
from .triangulation import Triangulation
from .validation import (
    as_flags,
    as_pairs,
    as_places,
    as_points,
    as_rows,
    as_triangles,
    as_vertex,
    as_vertex_pairs,
    as_xy,
    turn_counter_clockwise,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from numpy.typing import ArrayLike

    from ..base.arrays import AnyArray, BoolArray, Float64Array, Int32Array
    from ..base.crs import CrsLike, UnitLike
    from ..base.types import Bounds, PointsLike
    from .building import BuildInputs
    from .report import Edit
    from .voronoi import Voronoi


class Surface:
    """What can be asked of a triangulated surface: a :class:`TIN`, or a snapshot of one.

    It has everything that reads and nothing that edits. Products take a surface, and begin from a
    snapshot of it (:meth:`snapshot`), so that an edit in another thread cannot reach them. Its
    attributes are those of :class:`TIN`.

    Examples
    --------
    >>> import tinsmith as ts
    >>> tin = ts.triangulate([[0, 0, 5], [4, 0, 6], [4, 3, 7], [0, 3, 8]])
    >>> isinstance(tin, Surface), isinstance(tin.snapshot(), Surface)
    (True, True)
    """

    __slots__ = ()

    _crs: CRS | None
    _elevation_unit: Unit | None
    _row_attributes: Mapping[str, AnyArray]
    _source: str
    _name: str

    @property
    def _current(self) -> Version:
        """What the surface is between two edits."""
        raise NotImplementedError

    def _keep(self) -> TIN:
        """Return a TIN that nobody edits."""
        raise NotImplementedError

    def _settle(self) -> tuple[Version, Origin]:
        """Return what the surface is, and what it was before its edits."""
        return self._keep()._settle()

    def _gather_inputs(self) -> BuildInputs | None:
        """Return what it is the build of, edits included; None for existing triangles."""
        return self._keep()._gather_inputs()

    def _with_version(self, version: Version) -> TIN:
        """Return a TIN of existing triangles, with the CRS, the unit and the rows of this one."""
        return TIN._of(
            version,
            crs=self._crs,
            elevation_unit=self._elevation_unit,
            row_attributes=self._gather_row_attributes(),
        )

    def snapshot(self) -> Snapshot:
        """Return the surface as it is now, which no edit changes.

        Examples
        --------
        >>> tin = TIN.from_triangles([[0, 0, 1], [1, 0, 2], [0, 1, 3]], [[0, 1, 2]])
        >>> before = tin.snapshot()
        >>> tin.set_elevation(0, 9.0)
        >>> before.points[0].tolist(), tin.points[0].tolist()
        ([0.0, 0.0, 1.0], [0.0, 0.0, 9.0])
        """
        return Snapshot(self._keep())

    def to_tin(self) -> TIN:
        """Return a TIN of the surface, to be edited on its own.

        Examples
        --------
        >>> tin = TIN.from_triangles([[0, 0, 1], [1, 0, 2], [0, 1, 3]], [[0, 1, 2]])
        >>> other = tin.snapshot().to_tin()
        >>> other.set_elevation(0, 9.0)
        >>> tin == other
        False
        """
        return self._keep().copy()

    @property
    def source(self) -> str:
        """Name of the file that it was read from, else of that of its points; empty if of none."""
        return self._source or self._current.report.source

    @property
    def name(self) -> str:
        """Name that the file gives it, as LandXML does; empty if none."""
        return self._name

    @property
    def edits(self) -> tuple[Edit, ...]:
        """What was done to the surface since it was built, in order."""
        return self._keep().edits

    @property
    def notes(self) -> tuple[str, ...]:
        """What who uses the surface should know, in sentences.

        What the reader assumed and left out, how far merged points differ, and what looks wrong
        with the surface: blunders, lines at other elevations than the ground, gaps. Products have
        them among their own notes. They are found once for each version of a TIN.

        Examples
        --------
        >>> import tinsmith as ts
        >>> x, y = np.divmod(np.arange(100.0), 10)
        >>> z = 320 + 0.01 * x * y
        >>> z[33] = 0
        >>> len(ts.triangulate(np.column_stack([x, y, z])).notes)
        1
        """
        still = self.snapshot()
        version = still._current
        if version.notes is None:
            inputs = still._gather_inputs()
            is_trimmed = inputs is not None and inputs.is_trimmed
            with np.errstate(over="ignore", invalid="ignore"):  # of elevations beyond all real ones
                found = call_method("Surface.findings", still, gaps=not is_trimmed)
            version.keep_notes(tuple(dict.fromkeys([*version.report.sentences(), *found])))
        return cast("tuple[str, ...]", version.notes)

    # ---------------------------------------------------------------- arrays

    @property
    def triangulation(self) -> Triangulation:
        """Points, triangles, neighbours and flags that belong together; never changed."""
        return self._current.triangulation

    @property
    def points(self) -> Float64Array:
        """Easting, northing, elevation of the vertices, (n, 3) array."""
        return self._current.triangulation.points

    @property
    def triangles(self) -> Int32Array:
        """Vertices of each triangle, counter-clockwise, (m, 3) array."""
        return self._current.triangulation.triangles

    @property
    def neighbors(self) -> Int32Array:
        """The triangle across the edge opposite each corner, (m, 3) array; -1 outside."""
        return self._current.triangulation.neighbors

    @property
    def constrained(self) -> BoolArray:
        """Whether that edge is a breakline, boundary or hole, (m, 3) array."""
        return self._current.triangulation.constrained

    @property
    def vertex_of(self) -> Int32Array:
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

    @property
    def attributes(self) -> Mapping[str, AnyArray]:
        """Further columns of the vertices, such as ``"number"``, those of the survey.

        The value of a vertex is that of the first row that it stands for. Vertices that no such
        row gave, but lines and edits, have none: NaN among numbers, an empty text among texts,
        else None.

        Examples
        --------
        >>> import tinsmith as ts
        >>> points = [[0, 0, 5], [4, 0, 6], [4, 3, 7], [0, 3, 8]]
        >>> survey = ts.Survey(points=points, attributes={"number": [11, 12, 13, 14]})
        >>> tin = ts.triangulate(survey)
        >>> tin.remove(1)
        >>> tin.attributes["number"]
        array([11, 13, 14])
        """
        version = self._current
        return Attributes(self._gather_row_attributes(), lambda: version.first_rows)

    @property
    def row_attributes(self) -> Mapping[str, AnyArray]:
        """Further columns of the input rows; those that edits inserted come behind them."""
        return dict(self._gather_row_attributes())

    def _gather_row_attributes(self) -> Mapping[str, AnyArray]:
        """Return the columns of the rows, and of those that were inserted with columns."""
        edits = self.edits
        if not any(one.arguments.get("attributes") for one in edits):
            return self._row_attributes
        counts = self._keep()._count_inserted()
        n_own = len(self._current.vertex_of) - sum(counts)
        own = dict(Attributes(self._row_attributes, lambda: np.arange(n_own)))
        more = [as_columns(one.arguments.get("attributes") or {}, None) for one in edits]
        return join_columns([own, *more], [n_own, *counts])

    def replace(self, **changes: Any) -> TIN:
        """Return a TIN that differs in some arguments of the constructor; it has no edits.

        Examples
        --------
        >>> tin = TIN.from_triangles([[0, 0, 1], [1, 0, 2], [0, 1, 3]], [[0, 1, 2]])
        >>> tin.replace(crs="EPSG:32616").crs
        CRS('EPSG:32616')
        """
        return self._keep()._replace(changes)

    def transform(
        self,
        function: Callable[[Float64Array], Float64Array],
        *,
        crs: CrsLike | None = None,
        elevation_unit: UnitLike | None = None,
        length: float = 1.0,
    ) -> TIN:
        """Return the TIN of moved points; :func:`tinsmith.reproject` moves them to another CRS.

        Parameters
        ----------
        function : callable
            Takes (n, 3) points and returns where they are then, in the same order.
        crs : CRS, str, int or pyproj.CRS, optional
            Of the moved points; default not known.
        elevation_unit : Unit or str, optional
            Unit of their elevations; default that of the CRS's vertical axis, else not known.
        length : float
            Factor of lengths in the plane, for ``max_edge`` and ``snap`` of the build.

        Returns
        -------
        TIN
            Where it was built here, edits included, it is built anew of the moved rows and lines
            with the same options, and is Delaunay there. Existing triangles, such as those of a
            file, are kept as they are.

        Raises
        ------
        CrsError, OptionError
            If the CRS or unit is unknown, the function is none, or the length is no number above 0.
        PointsError
            If the function does not return as many points, or a triangle that is kept has no area
            any more or covers others.
        LinesError
            If a line vanishes, or a ring crosses itself.

        Examples
        --------
        >>> tin = TIN.from_triangles([[0, 0, 1], [1, 0, 2], [0, 1, 3]], [[0, 1, 2]])
        >>> tin.transform(lambda points: points + [10.0, 20.0, 0.0]).bounds.xmin
        10.0
        """
        moved = self._keep()._transform(function, crs, elevation_unit, length)
        return moved.with_source(self._source).with_name(self._name)

    # ---------------------------------------------------------------- measures

    @property
    def bounds(self) -> Bounds:
        """Bounds of the vertices."""
        return self._current.triangulation.bounds

    @property
    def edges(self) -> Int32Array:
        """Every edge once, (k, 2) vertex pairs."""
        return self._current.triangulation.edges

    @property
    def boundary(self) -> list[Int32Array]:
        """Rings of vertices around the surface, which is on their left; an outer one first.

        A surface of several parts, or with holes, has several.
        """
        return list(self._current.triangulation.rings)

    rings = boundary

    @property
    def hull(self) -> Int32Array:
        """Vertices on the convex hull, counter-clockwise, those within its edges too.

        The same as the boundary only where the surface fills its hull.
        """
        return self._current.triangulation.hull

    @property
    def triangle_areas(self) -> Float64Array:
        """Area of each triangle in the plane, (m,) array, CRS units squared.

        Raises CrsError where coordinates are longitude and latitude.
        """
        require_lengths(self.crs)
        return self._current.triangulation.triangle_areas

    @property
    def triangle_surface_areas(self) -> Float64Array:
        """Area of each triangle in space, (m,) array, CRS units squared, elevations converted.

        Raises CrsError where coordinates are longitude and latitude.
        """
        scale = scale_elevations(self.crs, self.elevation_unit)
        return self._current.triangulation.surface_areas(scale)

    @property
    def area(self) -> float:
        """Area in the plane, CRS units squared.

        Raises CrsError where coordinates are longitude and latitude.
        """
        require_lengths(self.crs)
        return self._current.triangulation.area

    @property
    def surface_area(self) -> float:
        """Area in space, CRS units squared, elevations converted to them."""
        return float(self.triangle_surface_areas.sum())

    @property
    def triangle_normals(self) -> Float64Array:
        """Upward unit normal of each triangle, (m, 3) array; elevations in CRS units.

        Raises CrsError where coordinates are longitude and latitude.

        Examples
        --------
        >>> tin = TIN.from_triangles([[0, 0, 0], [4, 0, 3], [0, 4, 0]], [[0, 1, 2]])
        >>> tin.triangle_normals
        array([[-0.6,  0. ,  0.8]])
        """
        scale = scale_elevations(self.crs, self.elevation_unit)
        return seal(_with_length_one(self._current.triangulation.normals(scale)))

    @property
    def vertex_normals(self) -> Float64Array:
        """Upward unit normal at each vertex, (n, 3) array; elevations in CRS units.

        It is the mean of the normals of its triangles, weighted by their areas in space; NaN at a
        vertex that no triangle has. Raises CrsError where coordinates are longitude and latitude.

        Examples
        --------
        >>> roof = [[0, 0, 0], [4, 0, 3], [4, 4, 3], [8, 0, 0]]
        >>> tin = TIN.from_triangles(roof, [[0, 1, 2], [1, 3, 2]])
        >>> tin.vertex_normals[1]
        array([0., 0., 1.])
        """
        scale = scale_elevations(self.crs, self.elevation_unit)
        return seal(_with_length_one(self._current.triangulation.vertex_normals(scale)))

    # ---------------------------------------------------------------- queries

    def locate(self, xy: ArrayLike) -> Int32Array:
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

        Examples
        --------
        >>> tin = TIN.from_triangles([[0, 0, 1], [4, 0, 2], [0, 4, 3]], [[0, 1, 2]])
        >>> tin.locate([[1, 1], [3, 3]])
        array([ 0, -1], dtype=int32)
        """
        require_crs(xy, self._crs, "points")
        return self._current.triangulation.locator.locate(as_xy(xy))

    @overload
    def interpolate(
        self,
        xy: float,
        y: float,
        *,
        method: InterpolationMethod = ...,
        extrapolate: Extrapolation | None = ...,
        threads: int | None = ...,
    ) -> float: ...
    @overload
    def interpolate(
        self,
        xy: PointsLike,
        y: ArrayLike | None = ...,
        *,
        method: InterpolationMethod = ...,
        extrapolate: Extrapolation | None = ...,
        threads: int | None = ...,
    ) -> Float64Array: ...
    def interpolate(
        self,
        xy: Any,
        y: Any = None,
        *,
        method: InterpolationMethod = "linear",
        extrapolate: Extrapolation | None = None,
        threads: int | None = None,
    ) -> Any:
        """Interpolate the elevation at each place.

        Parameters
        ----------
        xy : (k, 2) array, CRS units
            Or (2,), one place; with ``y`` eastings alone, a number or an array.
        y : float or array, optional
            Northings, of the same shape, or that broadcasts with it.
        method : {"linear", "nearest", "laplace", "natural", "c1"}
            What lies between the vertices:

            - "linear": the triangles;
            - "nearest": at each place the elevation of the nearest vertex;
            - "natural": natural neighbours, weighted by the areas that the place's Voronoi cell
              takes from theirs [1]_: smooth but at vertices, and never beyond the neighbours'
              elevations;
            - "laplace": natural neighbours, weighted by the length of the side that both cells
              share over the distance [2]_: about the same, a little faster and less smooth;
            - "c1": a patch over each triangle, with one gradient at each vertex, estimated by
              bending the edges least [3]_, [4]_: smooth everywhere, but it may overshoot.
        extrapolate : {"nearest"}, optional
            Outside the surface take the elevation at the nearest place of its boundary; with
            ``method="nearest"`` that of the nearest vertex. Default: NaN. Of several places or
            vertices at the same distance the westernmost counts, of several of these the
            southernmost, for ``method="nearest"`` inside too: the order of points and triangles
            changes nothing.
        threads : int, optional
            Default: every core, where it pays. The result is the same for any number.

        Returns
        -------
        (k,) float64 array
            Elevation, NaN outside the surface; at a vertex exactly the vertex's own. For one place
            a number; for eastings and northings of another shape an array of it.

        Raises
        ------
        OptionError
            If ``method`` or ``extrapolate`` is none of the words.
        PointsError
            As :meth:`locate`, if eastings and northings do not fit, or if ``threads`` is no whole
            number above 0.

        Notes
        -----
        Breaklines, boundary, holes and water are edges across which neither natural neighbours nor
        gradients look: on them every method but "nearest" is linear from vertex to vertex, and the
        slope may break there. So natural neighbours weigh as in the Voronoi diagram with obstacles
        [5]_. A soft breakline is no such edge: its vertices count, and the surface is smooth
        across it. "linear", "natural", "laplace" and "c1" reproduce planes. Natural neighbours are
        those in the constrained Delaunay triangulation of the vertices, whatever the triangles.

        What a method needs is made once for each version of the TIN, when it is first asked for.

        References
        ----------
        .. [1] R. Sibson, "A brief description of natural neighbour interpolation", Interpreting
           Multivariate Data (1981), 21-36.
        .. [2] V. Belikov, V. Ivanov, V. Kontorovich, S. Korytnik and A. Semenov, "The
           non-Sibsonian interpolation", Computational Mathematics and Mathematical Physics 37
           (1997), 9-15.
        .. [3] G. M. Nielson, "A method for interpolating scattered data based upon a minimum norm
           network", Mathematics of Computation 40 (1983), 253-271.
           https://doi.org/10.1090/S0025-5718-1983-0679444-7
        .. [4] G. M. Nielson, "The side-vertex method for interpolation in triangles", Journal of
           Approximation Theory 25 (1979), 318-336.
           https://doi.org/10.1016/0021-9045(79)90020-0
        .. [5] R. Seidel, "Constrained Delaunay triangulations and Voronoi diagrams with obstacles",
           1978-1988 Ten Years IIG (1988), 178-191.

        Examples
        --------
        >>> tin = TIN.from_triangles([[0, 0, 1], [4, 0, 2], [0, 4, 3]], [[0, 1, 2]])
        >>> tin.interpolate([[4, 0], [2, 0], [3, 3]])
        array([2. , 1.5, nan])
        >>> tin.interpolate([[3, 3]], method="natural", extrapolate="nearest")
        array([2.5])
        >>> tin.interpolate(1, 1)
        1.75
        """
        choice("method", method, InterpolationMethod)
        if extrapolate is not None:
            choice("extrapolate", extrapolate, Extrapolation)
        is_one, shape = False, None
        if y is None:
            require_crs(xy, self._crs, "points")
            places, is_one = as_places(xy)
        else:
            places, shape = as_pairs(xy, y)
        elevations = self._current.interpolator.interpolate(
            places, method, extrapolate=extrapolate is not None, threads=threads
        )
        if shape is not None:
            return elevations.reshape(shape) if shape else float(elevations.reshape(()))
        return elevations.reshape(())[()] if is_one else elevations

    def closest_vertex(self, xy: ArrayLike) -> Int32Array:
        """Find the vertex nearest to each place, in the plane.

        Parameters
        ----------
        xy : (k, 2) array, CRS units

        Returns
        -------
        (k,) int32 array
            Vertex number; of several at the same distance the smallest. Decided by exact
            predicates, also outside the surface and in its holes. -1 where ``xy`` is NaN.

        Raises
        ------
        PointsError
            As :meth:`locate`.

        Notes
        -----
        The vertices' own Delaunay triangulation is built once for each version of the TIN, in
        memory and time as :func:`tinsmith.triangulate`; a place then takes as long as looking at
        the neighbours of a few vertices.

        Examples
        --------
        >>> tin = TIN.from_triangles([[0, 0, 1], [4, 0, 2], [0, 4, 3]], [[0, 1, 2]])
        >>> tin.closest_vertex([[3, 1], [2, 2], [-9, 9]])
        array([1, 0, 2], dtype=int32)
        """
        require_crs(xy, self._crs, "points")
        return self._current.triangulation.nearest.find(as_xy(xy))

    # ---------------------------------------------------------------- connections

    def vertex_triangles(self, vertex: int) -> Int32Array:
        """Return the triangles around a vertex, counter-clockwise.

        Parameters
        ----------
        vertex : int

        Returns
        -------
        (k,) int32 array
            From the boundary to the boundary, or else from the smallest number; empty for a vertex
            that no triangle has. Where parts of the surface touch in the vertex, part after part.

        Raises
        ------
        PointsError
            If there is no such vertex.

        See Also
        --------
        TIN.neighbors : the triangles beside each triangle.

        Examples
        --------
        >>> square = [[0, 0, 1], [4, 0, 2], [4, 4, 3], [0, 4, 4]]
        >>> tin = TIN.from_triangles(square, [[0, 1, 2], [0, 2, 3]])
        >>> tin.vertex_triangles(0)
        array([0, 1], dtype=int32)
        """
        surface = self._current.triangulation
        return surface.turn_about(as_vertex(vertex, len(surface.points)))[0]

    def vertex_neighbors(self, vertex: int) -> Int32Array:
        """Return the vertices that edges join to a vertex, counter-clockwise.

        Parameters
        ----------
        vertex : int

        Returns
        -------
        (k,) int32 array
            In the order of :meth:`vertex_triangles`, each once.

        Raises
        ------
        PointsError
            If there is no such vertex.

        Examples
        --------
        >>> square = [[0, 0, 1], [4, 0, 2], [4, 4, 3], [0, 4, 4]]
        >>> tin = TIN.from_triangles(square, [[0, 1, 2], [0, 2, 3]])
        >>> tin.vertex_neighbors(0)
        array([1, 2, 3], dtype=int32)
        """
        surface = self._current.triangulation
        return surface.turn_about(as_vertex(vertex, len(surface.points)))[1]

    def edge_triangles(self, a: ArrayLike, b: ArrayLike) -> Int32Array:
        """Return the triangles on the two sides of edges.

        Parameters
        ----------
        a, b : int or int arrays
            Ends of each edge; shapes are broadcast.

        Returns
        -------
        (..., 2) int32 array
            The triangle on the left of the way from ``a`` to ``b``, and the one on its right; -1
            where there is none: outside, or on both sides if it is no edge.

        Raises
        ------
        PointsError
            If there is no such vertex, or the shapes do not fit.

        Examples
        --------
        >>> square = [[0, 0, 1], [4, 0, 2], [4, 4, 3], [0, 4, 4]]
        >>> tin = TIN.from_triangles(square, [[0, 1, 2], [0, 2, 3]])
        >>> tin.edge_triangles([0, 0, 1], [2, 1, 3])
        array([[ 1,  0],
               [ 0, -1],
               [-1, -1]], dtype=int32)
        """
        surface = self._current.triangulation
        return surface.find_edges(*as_vertex_pairs(a, b, len(surface.points)))

    def is_edge(self, a: ArrayLike, b: ArrayLike) -> BoolArray:
        """Tell which pairs of vertices are joined by an edge.

        Parameters
        ----------
        a, b : int or int arrays
            Shapes are broadcast.

        Returns
        -------
        bool array
            Of the shape of ``a`` and ``b``.

        Raises
        ------
        PointsError
            As :meth:`edge_triangles`.

        Examples
        --------
        >>> square = [[0, 0, 1], [4, 0, 2], [4, 4, 3], [0, 4, 4]]
        >>> tin = TIN.from_triangles(square, [[0, 1, 2], [0, 2, 3]])
        >>> tin.is_edge(0, [1, 2, 3])
        array([ True,  True,  True])
        >>> bool(tin.is_edge(1, 3))
        False
        """
        return seal(np.asarray((self.edge_triangles(a, b) != topology.NO_NEIGHBOR).any(axis=-1)))

    # ---------------------------------------------------------------- dual

    def voronoi(
        self, *, boundary: Bounds | ArrayLike | None = None, pad: float | None = None
    ) -> Voronoi:
        """Build the Voronoi diagram of the vertices: :func:`tinsmith.voronoi` of this TIN.

        Examples
        --------
        >>> tin = TIN.from_triangles([[0, 0, 1], [4, 0, 2], [0, 4, 3]], [[0, 1, 2]])
        >>> tin.voronoi(pad=0).areas
        array([4., 6., 6.])
        """
        from .voronoi import divide_plane

        return replace(divide_plane(self.points, boundary=boundary, pad=pad), crs=self.crs)

    def __repr__(self) -> str:
        surface = self._current.triangulation
        count = len(surface.triangles)
        z = surface.points[:, 2]
        name = type(self).__name__
        return (
            f"<{name}: {len(surface.points):,} vertices, {counted(count, 'triangle')}, "
            f"z {z.min():g} to {z.max():g}, crs {shorten_crs(self.crs)}>"
        )

    def _repr_html_(self) -> str:
        return make_html_repr(self)

    if not TYPE_CHECKING:  # which would take any name for an attribute

        def __getattr__(self, name: str) -> Any:
            raise_missing(self, name)

    # ---------------------------------------------------------------- as a value

    def __len__(self) -> int:
        return len(self.triangles)

    def __eq__(self, other: object) -> bool:
        """Whether both are the same surface, whatever rows and edits they come from."""
        if not isinstance(other, Surface):
            return NotImplemented
        one, two = self._current, other._current
        mine, theirs = one.triangulation, two.triangulation
        return (
            (self.crs, self.elevation_unit) == (other.crs, other.elevation_unit)
            and np.array_equal(mine.points, theirs.points)
            and np.array_equal(mine.triangles, theirs.triangles)
            and np.array_equal(mine.constrained, theirs.constrained)
            and one.lines.is_same(two.lines)
            and _have_same_values(
                Attributes(self._gather_row_attributes(), lambda: one.first_rows),
                Attributes(other._gather_row_attributes(), lambda: two.first_rows),
            )
        )

    # Edits change it.
    __hash__ = None  # type: ignore[assignment]

    # ---------------------------------------------------------------- other libraries

    def to_crs(self, crs: CrsLike, *, elevation_unit: UnitLike | None = None) -> TIN:
        """Return the TIN in another CRS: :func:`tinsmith.reproject` of it.

        Examples
        --------
        >>> import tinsmith as ts
        >>> points = [[751428, 4020862, 1032], [751438, 4020862, 1031], [751428, 4020872, 1030]]
        >>> ts.triangulate(points, crs="EPSG:32616").to_crs("EPSG:32617").bounds.xmin
        212642.559...
        """
        moved: TIN = call_method("TIN.to_crs", self.snapshot(), crs, elevation_unit=elevation_unit)
        return moved

    def to_geodataframe(self, kind: FeatureKind = "triangles") -> Any:
        """Return its parts as a GeoDataFrame: :func:`tinsmith.to_features` of it.

        Parameters
        ----------
        kind : {"triangles", "points", "edges", "lines", "hull"}

        Returns
        -------
        geopandas.GeoDataFrame

        Examples
        --------
        >>> import tinsmith as ts
        >>> tin = ts.triangulate([[0, 0, 5], [4, 0, 6], [4, 3, 7], [0, 3, 8]])
        >>> float(tin.to_geodataframe().area.sum())
        12.0
        """
        return call_method("TIN.to_geodataframe", self.snapshot(), kind)

    def plot(
        self,
        ax: Any = None,
        *,
        values: str | ArrayLike | None = "elevation",
        edges: bool | None = None,
        lines: bool = True,
        colorbar: bool = True,
        **options: Any,
    ) -> Any:
        """Draw it in plan with matplotlib.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Default: new ones of ``matplotlib.pyplot``.
        values : {"elevation", "slope"}, or (n,) or (m,) array, optional
            What the colours show: elevations, slopes in degrees, a number for each vertex or for
            each triangle; None for no colours.
        edges : bool, optional
            Whether to draw the edges; default up to 5,000 triangles.
        lines : bool
            Whether to draw breaklines, boundary, holes and water.
        colorbar : bool
            Whether to draw a scale of the colours beside new axes.
        **options
            Of ``Axes.tripcolor``: ``cmap``, ``vmin``, ``alpha``.

        Returns
        -------
        matplotlib.axes.Axes

        Raises
        ------
        MissingExtraError
            If matplotlib is not installed.
        OptionError
            If ``values`` is none of these.

        Examples
        --------
        >>> import matplotlib.figure
        >>> import tinsmith as ts
        >>> tin = ts.triangulate([[0, 0, 5], [4, 0, 6], [4, 3, 7], [0, 3, 8]])
        >>> axes = tin.plot(matplotlib.figure.Figure().add_subplot())
        >>> axes.get_xlabel()
        'easting'
        """
        return call_method(
            "TIN.plot",
            self.snapshot(),
            ax,
            values=values,
            edges=edges,
            lines=lines,
            colorbar=colorbar,
            **options,
        )

    @property
    def __geo_interface__(self) -> dict[str, Any]:
        """The triangles as GeoJSON-like values, in their own CRS."""
        collection: dict[str, Any] = call_method("TIN.__geo_interface__", self.snapshot())
        return collection

    def __arrow_c_stream__(self, requested_schema: object | None = None) -> object:
        """Return the triangles as a stream of Arrow, as :class:`tinsmith.Features` has them."""
        stream: object = call_method("TIN.__arrow_c_stream__", self.snapshot(), requested_schema)
        return stream


class TIN(Editable, Surface):
    """A triangulated irregular network: one elevation for every place inside its boundary.

    Built by :func:`tinsmith.triangulate`, or from existing triangles by
    :meth:`TIN.from_triangles`. All arrays are read-only; edits replace them by others. What the
    class is made of are the attributes of the same names.

    Notes
    -----
    Several threads may read and edit one TIN. Each attribute and each method sees the TIN as it was
    between two edits; for several attributes that belong together take ``tin.triangulation``, or a
    copy first. Copies (``copy.copy``, ``copy.deepcopy``, pickles) share nothing that changes: each
    is edited on its own, and takes back the edits made before it was copied.

    ``len`` is the number of triangles. Two TINs are equal if they are the same surface to the last
    bit: vertices, triangles, lines, attributes, CRS and unit; report and edits do not count. What
    can be edited has no hash. As ``__geo_interface__`` and stream of Arrow it is its triangles.

    Examples
    --------
    >>> import tinsmith as ts
    >>> tin = ts.triangulate([[0, 0, 5], [4, 0, 6], [4, 3, 7], [0, 3, 8]])
    >>> tin
    <TIN: 4 vertices, 2 triangles, z 5 to 8, crs unknown>
    >>> tin.area, tin.bounds.width
    (12.0, 4.0)
    """

    __slots__ = ("__weakref__", "_crs", "_elevation_unit", "_name", "_row_attributes", "_source")

    def __init__(
        self,
        *,
        points: Float64Array,
        triangles: Int32Array,
        neighbors: Int32Array,
        constrained: BoolArray,
        vertex_of: Int32Array,
        report: Report,
        lines: Lines | None = None,
        crs: CrsLike | None = None,
        elevation_unit: UnitLike | None = None,
        row_attributes: Mapping[str, ArrayLike] | None = None,
    ) -> None:
        version = Version(
            triangulation=Triangulation(points, triangles, neighbors, constrained),
            vertex_of=vertex_of,
            report=report,
            lines=Lines() if lines is None else lines,
        )
        self._begin(version, None, CRS.of(crs), Unit.of(elevation_unit), row_attributes or {})

    @classmethod
    def _of(
        cls,
        version: Version,
        inputs: BuildInputs | None = None,
        *,
        crs: CRS | None,
        elevation_unit: Unit | None,
        row_attributes: Mapping[str, ArrayLike],
    ) -> Self:
        """Return the TIN of a version, and of what it was built from."""
        made = cls.__new__(cls)
        made._begin(version, inputs, crs, elevation_unit, row_attributes)
        return made

    def _begin(
        self,
        version: Version,
        inputs: BuildInputs | None,
        crs: CRS | None,
        unit: Unit | None,
        row_attributes: Mapping[str, ArrayLike],
    ) -> None:
        self._crs, self._elevation_unit = crs, require_one_unit(crs, unit)
        require_degrees(version.triangulation.points, crs, "Points")
        describe_span(version.triangulation.points, crs, "Points")
        super().__init__(version, inputs)
        self._row_attributes = as_row_attributes(row_attributes, len(version.vertex_of))
        self._source = self._name = ""

    @classmethod
    def from_triangles(
        cls,
        points: ArrayLike,
        triangles: ArrayLike,
        *,
        constrained: ArrayLike | None = None,
        crs: CrsLike | None = None,
        elevation_unit: UnitLike | None = None,
        attributes: Mapping[str, ArrayLike] | None = None,
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
        elevation_unit : Unit or str, optional
            Unit of the elevations; default that of the CRS's vertical axis, else not known.
        attributes : mapping of str to (n,) array, optional
            Further columns of the points.

        Raises
        ------
        CrsError
            If the CRS is unknown.
        OptionError
            If ``elevation_unit`` is unknown, or another than that of the CRS's vertical axis; if an
            attribute has not one value for each point.
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
        unit = require_one_unit(system, Unit.of(elevation_unit))
        xyz = as_points(points)
        corners = as_triangles(triangles, len(xyz))
        flags = as_flags(constrained, len(corners))
        corners, flags = turn_counter_clockwise(xyz, corners, flags)
        return cls(
            points=xyz,
            triangles=corners,
            neighbors=topology.neighbors_of(corners, len(xyz)),
            constrained=flags,
            vertex_of=np.arange(len(xyz), dtype=np.int32),
            report=Report(
                n_rows=len(xyz),
                n_vertices=len(xyz),
                n_triangles=len(corners),
                notes=describe_span(xyz, system, "Points"),
            ),
            crs=system,
            elevation_unit=unit,
            row_attributes=as_columns(attributes or {}, (len(xyz),)),
        )

    def with_source(self, source: str) -> TIN:
        """Return a copy that names the file that it was read from.

        Examples
        --------
        >>> tin = TIN.from_triangles([[0, 0, 1], [1, 0, 2], [0, 1, 3]], [[0, 1, 2]])
        >>> tin.with_source("site.obj").source
        'site.obj'
        """
        other = self.copy()
        other._source = str(source)
        return other

    def with_name(self, name: str) -> TIN:
        """Return a copy of another name, which LandXML files keep.

        Examples
        --------
        >>> tin = TIN.from_triangles([[0, 0, 1], [1, 0, 2], [0, 1, 3]], [[0, 1, 2]])
        >>> tin.with_name("Existing ground").name
        'Existing ground'
        """
        other = self.copy()
        other._name = str(name)
        return other

    def with_notes(self, notes: Sequence[str]) -> TIN:
        """Return the TIN with further notes in its report, in front; edits can be taken back.

        Examples
        --------
        >>> tin = TIN.from_triangles([[0, 0, 1], [1, 0, 2], [0, 1, 3]], [[0, 1, 2]])
        >>> tin.with_notes(["Two files were joined."]).report.notes
        ('Two files were joined.',)
        """
        joined = join_notes(notes, self.report.notes)
        return self if joined == tuple(self.report.notes) else self._with_report(notes=joined)

    def with_reason(self, rows: ArrayLike, why: str) -> TIN:
        """Return the TIN with another reason in its report for rows that were left out.

        ``why`` is one of the reasons that reports give; of other rows there is nothing to say.

        Raises
        ------
        OptionError
            If rows are no whole numbers, or it is another reason.

        Examples
        --------
        >>> tin = TIN.from_triangles([[0, 0, 1], [1, 0, 2], [0, 1, 3], [1, 1, 4]],
        ...                          [[0, 1, 2], [1, 3, 2]])
        >>> tin.remove([3])
        >>> tin.with_reason([3], "looks like a blunder").report.to_dict()["left_out"]
        {'looks like a blunder': [3]}
        """
        version, origin = self._settle()
        report = version.report.with_reason(as_rows(rows), choice("why", why, LEFT_OUT))
        other = self._replace({"report": report, "row_attributes": self._row_attributes})
        other._resume(origin)
        return other

    def _with_report(self, **changes: Any) -> TIN:
        version, origin = self._settle()
        given, inputs = origin.given, origin.inputs
        if given is not None:
            given = replace(given, report=replace(given.report, **changes))
        if inputs is not None:
            inputs = replace(inputs, **changes)
        told = replace(version.report, **changes)
        other = self._replace({"report": told, "row_attributes": self._row_attributes})
        other._resume(Origin(inputs, given, origin.edits))
        return other

    def _resume(self, origin: Origin) -> None:
        super()._resume(origin)
        if not origin.edits:
            return
        given, inputs = origin.given, origin.inputs
        count = len(inputs.points) if given is None and inputs is not None else 0
        count = len(given.vertex_of) if given is not None else count
        columns = self._row_attributes.items()  # those of inserted rows are in the edits
        self._row_attributes = {name: seal(column[:count]) for name, column in columns}

    def _replace(self, changes: dict[str, Any]) -> TIN:
        version = self._current
        surface = version.triangulation
        given = {one.name: getattr(surface, one.name) for one in fields(surface)}
        given |= {"vertex_of": version.vertex_of, "report": version.report, "lines": version.lines}
        made = type(self)(**(given | self._reference | changes))
        made._source, made._name = self._source, self._name
        return made

    def _transform(
        self,
        function: Callable[[Float64Array], Float64Array],
        crs: CrsLike | None,
        elevation_unit: UnitLike | None,
        length: float,
    ) -> TIN:
        system = CRS.of(crs)
        unit = require_one_unit(system, Unit.of(elevation_unit))
        require_move(function, length)
        inputs = self._gather_inputs()
        if inputs is None:
            moved = move_points(self.points.copy(), function)
            # the same triangles at other places, all turned round where the map is mirrored
            made = type(self).from_triangles(
                moved, self.triangles, constrained=self.constrained, crs=system, elevation_unit=unit
            )
            return made.replace(
                vertex_of=self.vertex_of,
                report=self.report,
                lines=self.lines,
                row_attributes=self._gather_row_attributes(),
            )
        rows = self._list_rows()
        inputs = inputs.with_sources_of(rows)
        inputs = move_inputs(inputs, function, length=length, crs=system, elevation_unit=unit)
        attributes = self._gather_row_attributes()
        if rows is not None:  # those left after edits
            attributes = dict(Attributes(attributes, lambda: rows))
        return type(self)._of(
            assemble(inputs), inputs, crs=system, elevation_unit=unit, row_attributes=attributes
        )

    def __setattr__(self, name: str, value: Never) -> None:
        if not name.startswith("_"):
            raise FrozenInstanceError(f"cannot assign to '{name}' of a TIN: edits change it")
        super().__setattr__(name, value)

    def __getstate__(self) -> dict[str, Any]:
        own = ("_crs", "_elevation_unit", "_name", "_row_attributes", "_source")
        return super().__getstate__() | {name: getattr(self, name) for name in own}

    def __setstate__(self, state: dict[str, Any]) -> None:
        super().__setstate__({"_row_attributes": {}, "_source": "", "_name": ""} | state)

    @property
    def _reference(self) -> dict[str, Any]:
        return {
            "crs": self._crs,
            "elevation_unit": self._elevation_unit,
            "row_attributes": self._gather_row_attributes(),
        }

    def copy(self) -> Self:
        """Return a copy that is edited on its own, and takes back the edits made before.

        Examples
        --------
        >>> tin = TIN.from_triangles([[0, 0, 1], [1, 0, 2], [0, 1, 3]], [[0, 1, 2]])
        >>> other = tin.copy()
        >>> other.set_elevation(0, 9.0)
        >>> tin == other
        False
        """
        return self.__copy__()

    def _keep(self) -> TIN:
        return self.__copy__()


class Snapshot(Surface):
    """A TIN as it was at one time: what products begin from. Made by :meth:`TIN.snapshot`.

    It is asked like a TIN, and has no edits; :meth:`to_tin` makes a TIN of it that can be edited.

    Parameters
    ----------
    tin : TIN
        That nobody edits.

    Examples
    --------
    >>> tin = TIN.from_triangles([[0, 0, 1], [1, 0, 2], [0, 1, 3]], [[0, 1, 2]])
    >>> tin.snapshot()
    <Snapshot: 3 vertices, 1 triangle, z 1 to 3, crs unknown>
    """

    __slots__ = (
        *("__weakref__", "_crs", "_elevation_unit", "_name", "_row_attributes", "_source", "_tin"),
    )

    def __init__(self, tin: TIN) -> None:
        self._tin = tin
        self._crs = tin._crs
        self._elevation_unit = tin._elevation_unit
        self._row_attributes = tin._row_attributes
        self._source = tin._source
        self._name = tin._name

    @property
    def _current(self) -> Version:
        return self._tin._current

    def _keep(self) -> TIN:
        return self._tin

    def snapshot(self) -> Snapshot:
        """Return itself: it never changes.

        Examples
        --------
        >>> tin = TIN.from_triangles([[0, 0, 1], [1, 0, 2], [0, 1, 3]], [[0, 1, 2]])
        >>> still = tin.snapshot()
        >>> still.snapshot() is still
        True
        """
        return self

    def __reduce__(self) -> tuple[Any, ...]:
        return (Snapshot, (self._tin,))

    def __copy__(self) -> Snapshot:
        return self

    def __deepcopy__(self, memo: dict[int, Any]) -> Snapshot:
        return self


def _have_same_values(one: Mapping[str, AnyArray], other: Mapping[str, AnyArray]) -> bool:
    """Whether columns have the same names and values; what is missing is the same."""
    if list(one) != list(other):
        return False
    pairs = [(one[name], other[name]) for name in one]
    return all(
        first.dtype == second.dtype
        and np.array_equal(first, second, equal_nan=first.dtype.kind == "f")
        for first, second in pairs
    )


def _with_length_one(vectors: Float64Array) -> Float64Array:
    """Return vectors scaled to length 1; NaN for those without a direction."""
    longest = np.abs(vectors).max(axis=1, keepdims=True)
    scaled = np.divide(vectors, longest, out=np.full_like(vectors, np.nan), where=longest > 0)
    unit: Float64Array = scaled / np.linalg.norm(scaled, axis=1, keepdims=True)
    return unit
