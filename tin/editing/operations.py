"""Edit operations: what each does to the inputs of a TIN, or to its mesh where no line is near."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple, Protocol

import numpy as np

from ...base.checks import is_whole_number
from ...base.errors import LinesError, choice
from ...base.policies import CrossingPolicy, DuplicatePolicy
from ...base.sentences import coordinate, height, shown
from ..constraints.breaklines import Breakline
from ..report import Edit
from .arguments import (
    as_ends,
    as_new_points,
    as_point,
    as_vertex_elevations,
    as_vertices,
    copy_argument,
    require_distinct,
)
from .changes import (
    AddLine,
    Change,
    DropLines,
    DropVertices,
    LineChange,
    NumberedInputs,
    PutVertices,
    SetElevations,
    count_breaklines,
    has_own_elevations,
)
from .flipping import FLIP, make_flipped_edge, require_inner
from .mesh_editor import Editor, explain_occupied, merge_elevations

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from ...base.arrays import AnyArray, BoolArray, Float64Array, Int32Array, Int64Array
    from ...base.policies import BreaklineKind
    from ..building.version import Version
    from ..constraints.breaklines import Lines

__all__ = [
    "OPERATIONS",
    "AddBreakline",
    "Done",
    "Edited",
    "Flip",
    "Insert",
    "MeshOperation",
    "Move",
    "Operation",
    "Remove",
    "RemoveBreakline",
    "SetElevation",
]


class Edited(Protocol):
    """A TIN that is being edited, as operations see it."""

    @property
    def count(self) -> int:
        """Number of vertices."""
        ...

    def now(self) -> Version:
        """Return the TIN as it is."""
        ...

    def inputs(self) -> NumberedInputs:
        """Return what it is the build of."""
        ...


class Done(NamedTuple):
    """What an edit did to the inputs, and where that led; None if the mesh tells."""

    change: Change
    version: Version | None = None
    result: Any = None
    notes: tuple[str, ...] = ()


@dataclass(eq=False)
class Operation:
    """One edit with its arguments, not yet done."""

    operation: ClassVar[str]

    def apply(self, tin: Edited) -> Done:
        """Build the TIN of the changed inputs.

        Raises
        ------
        PointsError, LinesError
            As the methods of :class:`.TIN`.
        """
        raise NotImplementedError

    def arguments(self) -> dict[str, Any]:
        """Return copies of the arguments by name."""
        return {name: copy_argument(value) for name, value in vars(self).items()}

    def to_dict(self) -> dict[str, Any]:
        """Return plain Python values, ready for JSON."""
        return Edit(self.operation, self.arguments()).to_dict()


class MeshOperation(Operation):
    """An operation that is done in a mesh where it reaches no line."""

    def apply_to_mesh(self, editor: Editor) -> Done:
        """Change the mesh.

        Raises
        ------
        NotLocal
            If it reaches a line; nothing has changed then.
        PointsError, LinesError
            As the methods of :class:`.TIN`.
        """
        raise NotImplementedError


@dataclass(eq=False)
class Insert(MeshOperation):
    """Further points."""

    operation: ClassVar[str] = "insert"

    points: ArrayLike
    duplicates: DuplicatePolicy = "last"

    def apply(self, tin: Edited) -> Done:
        """Build the TIN of the changed inputs."""
        xyz = as_new_points(self.points)
        version, inputs = tin.now(), tin.inputs()
        there = version.triangulation.vertices_at(xyz[:, :2])
        own = np.where(there < 0, np.nan, version.triangulation.points[there, 2])
        z = _merge_new_elevations(xyz, own, choice("duplicates", self.duplicates, DuplicatePolicy))
        at_vertex = there >= 0
        change = _change_elevations(version, inputs, there[at_vertex], z[at_vertex])
        change = change._replace(added=np.column_stack([xyz[:, :2], z]))
        found = inputs.after([change]).build()
        return Done(change, found, found.vertex_of[len(found.vertex_of) - len(xyz) :])

    def apply_to_mesh(self, editor: Editor) -> Done:
        """Change the mesh, if no line is near."""
        slots, change = editor.insert(
            as_new_points(self.points), choice("duplicates", self.duplicates, DuplicatePolicy)
        )
        return Done(change, result=editor.numbers(slots))


@dataclass(eq=False)
class Remove(MeshOperation):
    """Vertices that go."""

    operation: ClassVar[str] = "remove"

    vertices: ArrayLike

    def apply(self, tin: Edited) -> Done:
        """Build the TIN of the changed inputs."""
        numbers = require_distinct(as_vertices(self.vertices, tin.count))
        version, inputs = tin.now(), tin.inputs()
        rows = np.flatnonzero(np.isin(version.vertex_of, numbers))
        of_lines = inputs.find_line_vertices(version)
        on_lines = np.flatnonzero(np.isin(of_lines, numbers))
        _require_given(numbers, version.vertex_of[rows], of_lines[on_lines], "removed")
        lines = (DropVertices(on_lines),) if len(on_lines) else ()
        change = Change(removed=rows, lines=lines)
        return Done(change, inputs.after([change]).build())

    def apply_to_mesh(self, editor: Editor) -> Done:
        """Change the mesh, if no line is near."""
        numbers = require_distinct(as_vertices(self.vertices, editor.count))
        return Done(editor.remove(editor.slots(numbers)))


@dataclass(eq=False)
class Move(MeshOperation):
    """A vertex at another place."""

    operation: ClassVar[str] = "move"

    vertex: int
    point: ArrayLike

    def apply(self, tin: Edited) -> Done:
        """Build the TIN of the changed inputs."""
        numbers, point = as_vertices([self.vertex], tin.count), as_point(self.point)
        version, inputs = tin.now(), tin.inputs()
        (there,) = version.triangulation.vertices_at(point[None, :2]).tolist()
        if there >= 0 and there != numbers[0]:
            raise explain_occupied(there, *point[:2].tolist())
        rows = np.flatnonzero(np.isin(version.vertex_of, numbers))
        of_lines = inputs.find_line_vertices(version)
        on_lines = np.flatnonzero(of_lines == numbers[0])
        _require_given(numbers, version.vertex_of[rows], of_lines[on_lines], "moved")
        change = Change(
            moved=rows,
            points=np.tile(point, (len(rows), 1)),
            lines=(PutVertices(on_lines, point),) if len(on_lines) else (),
        )
        found = inputs.after([change]).build()
        _require_elevations(found, point[None])
        return Done(change, found)

    def apply_to_mesh(self, editor: Editor) -> Done:
        """Change the mesh, if no line is near."""
        (slot,) = editor.slots(as_vertices([self.vertex], editor.count)).tolist()
        return Done(editor.move(slot, as_point(self.point)))


@dataclass(eq=False)
class SetElevation(MeshOperation):
    """Vertices at other elevations."""

    operation: ClassVar[str] = "set_elevation"

    vertices: ArrayLike
    z: ArrayLike

    def apply(self, tin: Edited) -> Done:
        """Build the TIN of the changed inputs."""
        numbers = as_vertices(self.vertices, tin.count)
        elevations = np.array(as_vertex_elevations(self.z, len(numbers)))
        version, inputs = tin.now(), tin.inputs()
        change = _change_elevations(version, inputs, numbers, elevations)
        made = numbers[~_has_own_elevation(version, inputs, numbers)]
        wanted = version.triangulation.points.copy()
        wanted[numbers, 2] = elevations
        change = change._replace(added=wanted[np.unique(made)])
        found = inputs.after([change]).build()
        _require_elevations(found, wanted[np.unique(numbers)])
        return Done(change, found)

    def apply_to_mesh(self, editor: Editor) -> Done:
        """Change the mesh, if no line is near."""
        numbers = as_vertices(self.vertices, editor.count)
        return Done(
            editor.set_elevations(editor.slots(numbers), as_vertex_elevations(self.z, len(numbers)))
        )


@dataclass(eq=False)
class Flip(MeshOperation):
    """The other diagonal of the two triangles at an edge."""

    operation: ClassVar[str] = "flip"

    a: int
    b: int

    def apply(self, tin: Edited) -> Done:
        """Build the TIN of the changed inputs."""
        first, second = as_ends(self.a, self.b, tin.count).tolist()
        version = tin.now()
        change = Change(lines=(_flip_line(version, first, second),))
        return Done(change, tin.inputs().after([change]).build())

    def apply_to_mesh(self, editor: Editor) -> Done:
        """Change the mesh, if no line is near."""
        first, second = editor.slots(as_ends(self.a, self.b, editor.count)).tolist()
        return Done(editor.flip(first, second))


@dataclass(eq=False)
class AddBreakline(Operation):
    """A further breakline."""

    operation: ClassVar[str] = "add_breakline"

    coords: ArrayLike
    kind: BreaklineKind = "hard"
    priority: int = 0
    name: str = ""
    crossing: CrossingPolicy = "split"

    def apply(self, tin: Edited) -> Done:
        """Build the TIN of the changed inputs."""
        line = Breakline(self.coords, kind=self.kind, priority=self.priority, name=self.name)
        choice("crossing", self.crossing, CrossingPolicy)
        change = Change(lines=(AddLine(line),))
        inputs = tin.inputs().after([change])
        found = inputs.build()
        number = count_breaklines(inputs.build_inputs.lines) - 1
        crossings = found.report.describe_crossings(inputs.build_inputs.lines.label(number))
        if crossings and self.crossing == "error":
            raise LinesError(f'{crossings[0][:-1]}: `crossing="error"` allows none.')
        if line.is_draped and not found.lines.has_breakline(number):
            raise LinesError("The draped line lies outside the surface.")
        return Done(change, found, notes=tuple(crossings))


@dataclass(eq=False)
class RemoveBreakline(Operation):
    """A breakline that goes."""

    operation: ClassVar[str] = "remove_breakline"

    number: int

    def apply(self, tin: Edited) -> Done:
        """Build the TIN of the changed inputs."""
        if not is_whole_number(self.number):
            raise LinesError(f"Invalid breakline {shown(self.number)}: a whole number is needed.")
        if not 0 <= self.number < count_breaklines(tin.inputs().build_inputs.lines):
            raise LinesError(f"There is no breakline {self.number}.")
        change = Change(lines=(DropLines((int(self.number),)),))
        return Done(change, tin.inputs().after([change]).build())


OPERATIONS: dict[str, type[Operation]] = {
    kind.operation: kind
    for kind in (Insert, Remove, Move, SetElevation, Flip, AddBreakline, RemoveBreakline)
}
"""The operations by the names of the methods of a TIN that do them."""


def _flip_line(version: Version, a: int, b: int) -> LineChange:
    """Return the line to be added, or those to be dropped."""
    surface = version.triangulation
    holds = (surface.triangles == a).any(axis=1) & (surface.triangles == b).any(axis=1)
    beside = np.flatnonzero(holds)
    require_inner(beside.tolist())
    own = _find_lines_along(version.lines, a, b)
    if own:
        if not all(version.lines.names[line] == FLIP for line in own):
            raise LinesError("The edge is one of a line, which must stay.")
        return DropLines(tuple(sorted({int(version.lines.sources[line]) for line in own})))
    corners = surface.triangles[beside]
    runs = ((corners == a) & (np.roll(corners, -1, axis=1) == b)).any(axis=1)  # its left side
    corners = corners[np.argsort(~runs)]
    left, right = corners[(corners != a) & (corners != b)].tolist()
    return AddLine(make_flipped_edge(surface.points[[a, b, left, right]]))


def _merge_new_elevations(
    xyz: Float64Array, own: Float64Array, policy: DuplicatePolicy
) -> Float64Array:
    """Return the elevation that each new row has in the end, given those of vertices there."""
    z = xyz[:, 2].copy()
    _, place = np.unique(xyz[:, :2], axis=0, return_inverse=True)
    place = place.reshape(-1)
    is_alone = (np.bincount(place)[place] == 1) & np.isnan(own)
    elevations: dict[int, float] = {}
    for row in np.flatnonzero(~is_alone).tolist():
        here = elevations.get(int(place[row]), float(own[row]))
        elevations[int(place[row])] = (
            float(z[row]) if np.isnan(here) else merge_elevations(here, float(z[row]), policy)
        )
    for row in np.flatnonzero(~is_alone).tolist():
        z[row] = elevations[int(place[row])]
    return z


def _change_elevations(
    version: Version, inputs: NumberedInputs, vertices: AnyArray, elevations: Float64Array
) -> Change:
    """Give the rows and the lines at vertices other elevations."""
    elevation_of = np.full(
        len(version.triangulation.points) + 1, np.nan
    )  # the last is of no vertex
    elevation_of[vertices] = elevations
    wanted = elevation_of[version.vertex_of]
    rows = np.flatnonzero(~np.isnan(wanted))
    points = inputs.build_inputs.points[np.searchsorted(inputs.rows, rows)]
    points[:, 2] = wanted[rows]
    of_lines = elevation_of[inputs.find_line_vertices(version)]
    on_lines = np.flatnonzero(~np.isnan(of_lines) & has_own_elevations(inputs.build_inputs.lines))
    lines = (SetElevations(on_lines, of_lines[on_lines]),) if len(on_lines) else ()
    return Change(moved=rows, points=points, lines=lines)


def _has_own_elevation(version: Version, inputs: NumberedInputs, vertices: Int64Array) -> BoolArray:
    """Tell which vertices stand for rows or for vertices of lines with elevations."""
    of_lines = inputs.find_line_vertices(version)[~np.isnan(inputs.build_inputs.lines.elevations)]
    return np.isin(vertices, np.append(version.vertex_of, of_lines))


def _require_given(vertices: Int64Array, rows: Int32Array, lines: Int32Array, what: str) -> None:
    made = vertices[~np.isin(vertices, np.append(rows, lines))]
    if len(made):
        raise LinesError(
            f"Vertex {int(made[0])} cannot be {what} on its own: it was made where lines cross, "
            "are laid on the surface or are split, and goes with them."
        )


def _require_elevations(found: Version, wanted: Float64Array) -> None:
    """Refuse an elevation that a water body or a line of higher priority overrules."""
    there = found.triangulation.vertices_at(wanted[:, :2])
    points = found.triangulation.points[there]
    wrong = np.flatnonzero((there >= 0) & (points[:, 2] != wanted[:, 2]))
    if len(wrong):
        x, y, z = points[wrong[0]].tolist()
        raise LinesError(
            f"The vertex at x {coordinate(x)}, y {coordinate(y)} stays at elevation "
            f"{height(z)}: what counts more there, "
            "such as water, has it."
        )


def _find_lines_along(lines: Lines, a: int, b: int) -> list[int]:
    """Return the chains that take an edge."""
    segments = np.sort(lines.segments(), axis=1)
    found: list[int] = lines.segment_chains()[(segments == sorted((a, b))).all(axis=1)].tolist()
    return found
