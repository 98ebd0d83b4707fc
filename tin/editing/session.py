"""Editing of a TIN: operations on its inputs, their history, going back and doing again."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple, cast, get_args

import numpy as np

from ...errors import LinesError, PointsError, TinsmithError
from ..building.constrained import CrossingPolicy
from ..building.duplicates import DuplicatePolicy
from ..constraints.breaklines import Breakline
from ..validation.options import is_whole_number, require_one_of, shown
from ..validation.points import as_elevations, as_points
from ..validation.tables import as_table, is_masked_array
from .changes import (
    AddLine,
    Change,
    DropLines,
    DropVertices,
    Inputs,
    LineChange,
    PutVertices,
    SetElevations,
    count_breaklines,
    has_own_heights,
)
from .existing_triangles import recipe_of_triangles, state_of_triangles
from .flipping import FLIP, flipped_edge, require_inner
from .mesh_editor import Editor, NotLocal, is_local, merged_elevation, occupied
from .state import State, build_state
from .version import Version

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from ..building.inputs import Recipe
    from ..constraints.breaklines import Lines
    from ..surface import TIN

__all__ = ["OPERATIONS", "Edit", "Session", "apply_edits"]

OPERATIONS = (
    "insert",
    "remove",
    "move",
    "set_z",
    "flip",
    "add_breakline",
    "remove_breakline",
)
"""Names of the methods of a TIN that change it."""


_ON_MESH = ("insert", "remove", "move", "set_z", "flip")


class Edit(NamedTuple):
    """One edit, as it can be written to a file and done again.

    Attributes
    ----------
    operation : str
        One of ``OPERATIONS``.
    arguments : dict
        Its arguments by name.
    notes : tuple of str
        What it met: lines that were crossed, with both heights.
    """

    operation: str
    arguments: dict[str, Any]
    notes: tuple[str, ...] = ()

    def to_dict(self) -> dict[str, Any]:
        """Return plain Python values, ready for JSON; :func:`apply_edits` takes them back."""
        plain = {name: _plain(value) for name, value in self.arguments.items()}
        return {"op": self.operation, **plain} | ({"notes": list(self.notes)} if self.notes else {})


def _plain(value: Any) -> Any:
    if isinstance(value, np.ndarray | np.generic):
        return value.tolist()
    return value


class Session:
    """The edits of a TIN: the inputs at the beginning, what was done to them, and where that led.

    The TIN is always the build of the inputs. Edits that reach no line are done in a mesh, for
    which :class:`.Editor` is kept; for all others everything is built anew beside what is there,
    and takes its place when it is complete. So an edit that fails changes nothing.

    Parameters
    ----------
    version : Version
        The TIN before its first edit.
    recipe : Recipe or None
        What it was built from; None for one of existing triangles.

    Raises
    ------
    PointsError
        If existing triangles are no Delaunay triangulation.
    """

    def __init__(self, version: Version, recipe: Recipe | None) -> None:
        self.edits: list[Edit] = []
        self._changes: list[Change] = []
        self._given: Version | None = None if recipe is not None else version
        if recipe is None:
            recipe = recipe_of_triangles(version)
            self._begin = Inputs.of(recipe)
            self._state: State | None = state_of_triangles(version, self._begin)
        else:
            self._begin = Inputs.of(recipe)
            self._state = State(
                version.triangulation, version.vertex_of, version.lines, version.report, None
            )
        self._inputs, self._n_applied = self._begin, 0
        self._editor: Editor | None = None

    def copy(self) -> Session:
        """Return a session that goes on from here on its own."""
        other = Session.__new__(Session)
        other.__setstate__(self.__getstate__())
        return other

    def __getstate__(self) -> dict[str, Any]:
        return {
            "edits": list(self.edits),
            "_changes": list(self._changes),
            "_given": self._given,
            "_begin": self._begin,
            "_state": self._now(),
        }

    def __setstate__(self, state: dict[str, Any]) -> None:
        vars(self).update(state)
        self._inputs, self._n_applied = self._begin, 0
        self._editor = None

    # ------------------------------------------------------------------ for TIN

    def version(self) -> Version:
        """Return the TIN after the edits."""
        if self._given is not None and not self.edits:
            return self._given
        state, edits = self._now(), tuple(self.edits)
        vertex_of, report = state.vertex_of_row, replace(state.report, edits=edits)
        if self._given is not None:
            vertex_of = self._of_given_rows(vertex_of)
            surface = state.triangulation
            report = self._given.report.after_edits(
                vertex_of, len(surface.points), len(surface.triangles), edits
            )
        return Version(
            triangulation=state.triangulation,
            vertex_of=vertex_of,
            lines=state.lines,
            report=report,
        )

    def _of_given_rows(self, vertex_of_row: NDArray[np.int32]) -> NDArray[np.int32]:
        """Return the vertices of the rows that existing triangles stand for, and of later ones."""
        given = cast("Version", self._given).vertex_of
        none = np.int32(-1)
        return np.append(np.append(vertex_of_row, none)[given], vertex_of_row[self._begin.n_rows :])

    def do(self, operation: str, arguments: dict[str, Any]) -> Any:
        """Do one edit and remember it; one that fails leaves everything as it was.

        Raises
        ------
        PointsError, LinesError
            As the methods of :class:`.TIN`.
        """
        if operation not in OPERATIONS:
            raise PointsError(f"Invalid edit '{operation}': one of {', '.join(OPERATIONS)}.")
        kept = {name: _kept(value) for name, value in arguments.items()}
        before = self._state
        try:
            done = self._on_mesh(operation, arguments)
            if done is None:
                done = getattr(self, f"_{operation}")(**arguments)
        except TinsmithError:
            raise
        except BaseException:  # interrupted: the mesh may be half-way
            self._editor, self._state = None, before
            raise
        self._changes.append(done.change)
        self.edits.append(Edit(operation, kept, done.notes))
        self._state = done.state
        if done.state is not None:
            self._editor = None
        return done.result

    def undo(self, count: int) -> None:
        """Take back the last edits: build the inputs that were there before.

        Raises
        ------
        PointsError
            If there are not so many.
        """
        if not is_whole_number(count) or count < 1:
            raise PointsError(f"Invalid count {shown(count)}: a whole number >= 1 is needed.")
        if count > len(self.edits):
            raise PointsError(f"{count} edits cannot be taken back: {len(self.edits)} were made.")
        left = len(self.edits) - count
        inputs = self._begin.after(self._changes[:left])
        state = build_state(inputs)
        del self.edits[left:], self._changes[left:]
        self._inputs, self._n_applied = inputs, left
        self._state, self._editor = state, None

    # ------------------------------------------------------------------ what is there

    def _now(self) -> State:
        """Return the TIN after the edits, and how it hangs together with its inputs."""
        if self._state is None:
            inputs = self._inputs_now()
            built = self._editor.state(inputs) if self._editor is not None else None
            self._state = build_state(inputs) if built is None else built
        return self._state

    def _inputs_now(self) -> Inputs:
        if self._n_applied < len(self._changes):
            self._inputs = self._inputs.after(self._changes[self._n_applied :])
            self._n_applied = len(self._changes)
        return self._inputs

    def _vertices(self, vertices: ArrayLike) -> NDArray[np.int64]:
        count = self._count()
        only = vertices[0] if isinstance(vertices, list) and len(vertices) == 1 else vertices
        if type(only) is int and 0 <= only < count:  # most edits: no arrays for one number
            return np.array([only], np.int64)
        try:
            numbers = np.atleast_1d(np.asarray(vertices))
        except Exception:
            numbers = np.empty(0, np.float64)
        if is_masked_array(vertices) or numbers.ndim != 1 or numbers.dtype.kind not in "iu":
            raise PointsError(f"Invalid vertices {shown(vertices)}: whole numbers are needed.")
        wrong = (numbers < 0) | (numbers >= count)
        if wrong.any():
            raise PointsError(
                f"There is no vertex {int(numbers[np.argmax(wrong)])}: numbers 0 to {count - 1} "
                "are allowed."
            )
        return numbers.astype(np.int64)

    def _ends(self, a: int, b: int) -> NDArray[np.int64]:
        ends = self._vertices([a, b])
        if ends[0] == ends[1]:
            raise PointsError("An edge has two different ends.")
        return ends

    def _count(self) -> int:
        """Count the vertices."""
        if self._editor is not None:
            return self._editor.count
        return len(self._now().triangulation.points)

    # ------------------------------------------------------------- edits of a mesh

    def _on_mesh(self, operation: str, arguments: dict[str, Any]) -> _Done | None:
        """Do an edit in the mesh; None if it reaches a line, or may."""
        if operation not in _ON_MESH:
            return None
        edit = getattr(self, f"_{operation}_on_mesh")
        if self._editor is None:
            inputs = self._inputs_now()
            if not is_local(inputs.recipe):
                return None
            self._editor = Editor(self._now(), inputs)
        try:
            done: _Done = edit(self._editor, **arguments)
        except NotLocal:
            return None
        return done

    def _insert_on_mesh(
        self, editor: Editor, points: ArrayLike, duplicates: DuplicatePolicy = "last"
    ) -> _Done:
        slots, change = editor.insert(as_points(points), _policy(duplicates))
        return _Done(change, result=editor.numbers(slots))

    def _remove_on_mesh(self, editor: Editor, vertices: ArrayLike) -> _Done:
        return _Done(editor.remove(editor.slots(_distinct(self._vertices(vertices)))))

    def _move_on_mesh(self, editor: Editor, vertex: int, point: ArrayLike) -> _Done:
        (slot,) = editor.slots(self._vertices([vertex])).tolist()
        return _Done(editor.move(slot, _one_point(point)))

    def _set_z_on_mesh(self, editor: Editor, vertices: ArrayLike, z: ArrayLike) -> _Done:
        numbers = self._vertices(vertices)
        return _Done(editor.set_z(editor.slots(numbers), _elevations(z, len(numbers))))

    def _flip_on_mesh(self, editor: Editor, a: int, b: int) -> _Done:
        first, second = editor.slots(self._ends(a, b)).tolist()
        return _Done(editor.flip(first, second))

    # ------------------------------------------------------------ edits of the inputs

    def _built(self, change: Change) -> State:
        """Build the TIN of the inputs after a change; nothing is changed yet."""
        return build_state(self._inputs_now().after([change]))

    def _insert(self, points: ArrayLike, duplicates: DuplicatePolicy = "last") -> _Done:
        xyz = as_points(points)
        state, inputs = self._now(), self._inputs_now()
        there = state.vertices_at(xyz[:, :2])
        own = np.where(there < 0, np.nan, state.triangulation.points[there, 2])
        z = _merged_elevations(xyz, own, _policy(duplicates))
        at_vertex = there >= 0
        change = _with_elevations(state, inputs, there[at_vertex], z[at_vertex])
        change = change._replace(added=np.column_stack([xyz[:, :2], z]))
        found = self._built(change)
        return _Done(change, found, found.vertex_of_row[len(found.vertex_of_row) - len(xyz) :])

    def _remove(self, vertices: ArrayLike) -> _Done:
        numbers = _distinct(self._vertices(vertices))
        state, inputs = self._now(), self._inputs_now()
        rows = np.flatnonzero(np.isin(state.vertex_of_row, numbers))
        of_lines = state.line_vertices(inputs)
        on_lines = np.flatnonzero(np.isin(of_lines, numbers))
        _require_given(numbers, state.vertex_of_row[rows], of_lines[on_lines], "removed")
        lines = (DropVertices(on_lines),) if len(on_lines) else ()
        change = Change(removed=rows, lines=lines)
        return _Done(change, self._built(change))

    def _move(self, vertex: int, point: ArrayLike) -> _Done:
        numbers, place = self._vertices([vertex]), _one_point(point)
        state, inputs = self._now(), self._inputs_now()
        (there,) = state.vertices_at(place[None, :2]).tolist()
        if there >= 0 and there != numbers[0]:
            raise occupied(there, *place[:2].tolist())
        rows = np.flatnonzero(np.isin(state.vertex_of_row, numbers))
        of_lines = state.line_vertices(inputs)
        on_lines = np.flatnonzero(of_lines == numbers[0])
        _require_given(numbers, state.vertex_of_row[rows], of_lines[on_lines], "moved")
        change = Change(
            moved=rows,
            places=np.tile(place, (len(rows), 1)),
            lines=(PutVertices(on_lines, place),) if len(on_lines) else (),
        )
        found = self._built(change)
        _require_elevations(found, place[None])
        return _Done(change, found)

    def _set_z(self, vertices: ArrayLike, z: ArrayLike) -> _Done:
        numbers = self._vertices(vertices)
        heights = np.broadcast_to(_elevations(z, len(numbers)), len(numbers))
        state, inputs = self._now(), self._inputs_now()
        change = _with_elevations(state, inputs, numbers, heights)
        made = numbers[~_has_own_elevation(state, inputs, numbers)]
        wanted = state.triangulation.points.copy()
        wanted[numbers, 2] = heights
        change = change._replace(added=wanted[np.unique(made)])
        found = self._built(change)
        _require_elevations(found, wanted[np.unique(numbers)])
        return _Done(change, found)

    def _flip(self, a: int, b: int) -> _Done:
        first, second = self._ends(a, b).tolist()
        state = self._now()
        change = Change(lines=(self._flipped(state, first, second),))
        return _Done(change, self._built(change))

    def _flipped(self, state: State, a: int, b: int) -> LineChange:
        """Return the line to be added, or those to be dropped."""
        surface = state.triangulation
        holds = (surface.triangles == a).any(axis=1) & (surface.triangles == b).any(axis=1)
        beside = np.flatnonzero(holds)
        require_inner(beside.tolist())
        own = _lines_along(state.lines, a, b)
        if own:
            if not all(state.lines.names[line] == FLIP for line in own):
                raise LinesError("The edge is one of a line, which must stay.")
            return DropLines(tuple(sorted({int(state.lines.sources[line]) for line in own})))
        corners = surface.triangles[beside]
        runs = ((corners == a) & (np.roll(corners, -1, axis=1) == b)).any(axis=1)  # its left side
        corners = corners[np.argsort(~runs)]
        left, right = corners[(corners != a) & (corners != b)].tolist()
        return AddLine(flipped_edge(surface.points[[a, b, left, right]]))

    def _add_breakline(
        self,
        coords: ArrayLike,
        kind: str = "hard",
        priority: int = 0,
        name: str = "",
        crossing: str = "split",
    ) -> _Done:
        line = Breakline(coords, kind=kind, priority=priority, name=name)  # type: ignore[arg-type]
        require_one_of("crossing", crossing, get_args(CrossingPolicy), LinesError)
        change = Change(lines=(AddLine(line),))
        inputs = self._inputs_now().after([change])
        found = build_state(inputs)
        number = count_breaklines(inputs.recipe.lines) - 1
        met = found.report.met_by(inputs.recipe.lines.label(number))
        if met and crossing == "error":
            raise LinesError(f'{met[0][:-1]}: crossing="error" allows none.')
        if line.is_draped and not found.lines.has_breakline(number):
            raise LinesError("The draped line lies outside the surface.")
        return _Done(change, found, notes=tuple(met))

    def _remove_breakline(self, number: int) -> _Done:
        if not is_whole_number(number):
            raise LinesError(f"Invalid breakline {shown(number)}: a whole number is needed.")
        if not 0 <= number < count_breaklines(self._inputs_now().recipe.lines):
            raise LinesError(f"There is no breakline {number}.")
        change = Change(lines=(DropLines((int(number),)),))
        return _Done(change, self._built(change))


class _Done(NamedTuple):
    """What an edit did to the inputs, and where that led; None if the mesh tells."""

    change: Change
    state: State | None = None
    result: Any = None
    notes: tuple[str, ...] = ()


# --------------------------------------------------------------------- arguments


def _kept(value: Any) -> Any:
    """Return an argument so that the caller's further use of it changes nothing."""
    if isinstance(value, list):
        return [_kept(one) if isinstance(one, list) else one for one in value]
    return value.copy() if isinstance(value, np.ndarray) else value


def _policy(policy: str) -> DuplicatePolicy:
    require_one_of("duplicates", policy, get_args(DuplicatePolicy))
    return cast("DuplicatePolicy", policy)


def _distinct(vertices: NDArray[np.int64]) -> NDArray[np.int64]:
    if len(vertices) > 1 and len(np.unique(vertices)) < len(vertices):
        raise PointsError("A vertex is named twice: it can be removed once.")
    return vertices


def _one_point(point: Any) -> NDArray[np.float64]:
    """Return a point given alone, or as a table of one row."""
    values, is_masked = as_table(point, "Points")
    if is_masked is not None:
        raise PointsError("The point is masked: one, easting, northing, elevation, is needed.")
    rows = as_points(np.atleast_2d(values))
    if len(rows) != 1:
        raise PointsError(
            f"There are {len(rows)} points: one, easting, northing, elevation, is needed."
        )
    place: NDArray[np.float64] = rows[0]
    return place


def _elevations(z: ArrayLike, count: int) -> NDArray[np.float64]:
    heights = as_elevations(z) + 0.0  # no -0.0
    if heights.ndim == 1 and len(heights) != count:
        raise PointsError(
            f"{heights.size} heights for {count} vertices: one each, or one for all, is needed."
        )
    return heights


# -------------------------------------------------------------------------- steps


def _merged_elevations(
    xyz: NDArray[np.float64], own: NDArray[np.float64], policy: DuplicatePolicy
) -> NDArray[np.float64]:
    """Return the elevation that each new row has in the end, given those of vertices there."""
    z = xyz[:, 2].copy()
    _, place = np.unique(xyz[:, :2], axis=0, return_inverse=True)
    place = place.reshape(-1)
    is_alone = (np.bincount(place)[place] == 1) & np.isnan(own)
    heights: dict[int, float] = {}
    for row in np.flatnonzero(~is_alone).tolist():
        here = heights.get(int(place[row]), float(own[row]))
        heights[int(place[row])] = (
            float(z[row]) if np.isnan(here) else merged_elevation(here, float(z[row]), policy)
        )
    for row in np.flatnonzero(~is_alone).tolist():
        z[row] = heights[int(place[row])]
    return z


def _with_elevations(
    state: State, inputs: Inputs, vertices: NDArray[Any], heights: NDArray[np.float64]
) -> Change:
    """Give the rows and the lines at vertices other elevations."""
    height_of = np.full(len(state.triangulation.points) + 1, np.nan)  # the last is of no vertex
    height_of[vertices] = heights
    wanted = height_of[state.vertex_of_row]
    rows = np.flatnonzero(~np.isnan(wanted))
    places = inputs.recipe.points[np.searchsorted(inputs.rows, rows)]
    places[:, 2] = wanted[rows]
    of_lines = height_of[state.line_vertices(inputs)]
    on_lines = np.flatnonzero(~np.isnan(of_lines) & has_own_heights(inputs.recipe.lines))
    lines = (SetElevations(on_lines, of_lines[on_lines]),) if len(on_lines) else ()
    return Change(moved=rows, places=places, lines=lines)


def _has_own_elevation(
    state: State, inputs: Inputs, vertices: NDArray[np.int64]
) -> NDArray[np.bool_]:
    """Tell which vertices stand for rows or for vertices of lines with elevations."""
    of_lines = state.line_vertices(inputs)[~np.isnan(inputs.recipe.lines.heights)]
    return np.isin(vertices, np.append(state.vertex_of_row, of_lines))


def _require_given(
    vertices: NDArray[np.int64], rows: NDArray[np.int32], lines: NDArray[np.int32], what: str
) -> None:
    made = vertices[~np.isin(vertices, np.append(rows, lines))]
    if len(made):
        raise LinesError(
            f"Vertex {int(made[0])} cannot be {what} on its own: it was made where lines cross, "
            "are laid on the surface or are split, and goes with them."
        )


def _require_elevations(found: State, wanted: NDArray[np.float64]) -> None:
    """Refuse an elevation that a water body or a line of higher priority overrules."""
    there = found.vertices_at(wanted[:, :2])
    points = found.triangulation.points[there]
    wrong = np.flatnonzero((there >= 0) & (points[:, 2] != wanted[:, 2]))
    if len(wrong):
        x, y, z = points[wrong[0]].tolist()
        raise LinesError(
            f"The vertex at x {x:g}, y {y:g} stays at elevation {z:g}: what counts more there, "
            "such as water, has it."
        )


def _lines_along(lines: Lines, a: int, b: int) -> list[int]:
    """Return the chains that take an edge."""
    steps = np.sort(lines.steps(), axis=1)
    chain = np.repeat(np.arange(len(lines)), np.diff(lines.offsets) - 1)
    found: list[int] = chain[(steps == sorted((a, b))).all(axis=1)].tolist()
    return found


def apply_edits(tin: TIN, edits: Iterable[Edit | Mapping[str, Any]]) -> None:
    """Do edits on a TIN, in their order.

    Parameters
    ----------
    tin : TIN
    edits : iterable of Edit or dict
        Dicts as :meth:`Edit.to_dict` gives them: ``{"op": "remove", "vertices": [3]}``.

    Raises
    ------
    PointsError, LinesError
        At the first edit that fails, with its number; those before it stay done.
    """
    for number, edit in enumerate(edits):
        operation, arguments = _taken_apart(edit, number)
        try:
            getattr(tin, operation)(**arguments)
        except TypeError:
            raise PointsError(
                f"Edit {number} ({operation}) has the wrong arguments: {', '.join(arguments)}."
            ) from None
        except TinsmithError as error:
            raise type(error)(f"Edit {number} ({operation}): {error}") from error


def _taken_apart(edit: Edit | Mapping[str, Any], number: int) -> tuple[str, dict[str, Any]]:
    if isinstance(edit, Edit):
        return edit.operation, edit.arguments
    arguments = {name: value for name, value in edit.items() if name not in ("op", "notes")}
    operation = edit.get("op")
    if operation not in OPERATIONS:
        raise PointsError(
            f"Edit {number} has op {shown(operation)}: one of {', '.join(OPERATIONS)} is needed."
        )
    return operation, arguments
