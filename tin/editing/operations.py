"""Edit operations: the arguments of each, checked, and who carries it out: a mesh, or a build."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

from ...base.checks import is_whole_number
from ...base.errors import LinesError, choice
from ...base.policies import CrossingPolicy, DuplicatePolicy
from ...base.sentences import shown
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

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from ...base.policies import BreaklineKind
    from .changes import Done
    from .mesh_editor import Editor
    from .rebuilding import Rebuild


@dataclass(eq=False)
class Operation:
    """One edit with its arguments, not yet done."""

    operation: ClassVar[str]
    is_of_vertices: ClassVar[bool] = True
    """Whether a mesh can do it where no line is near."""

    def do(self, tin: Any) -> Done:
        """Check the arguments, and change the mesh or build the TIN of the changed inputs.

        Raises
        ------
        NotLocal
            If a mesh cannot do it; nothing has changed then.
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


@dataclass(eq=False)
class Insert(Operation):
    """Further points."""

    operation: ClassVar[str] = "insert"

    points: ArrayLike
    duplicates: DuplicatePolicy = "last"

    def do(self, tin: Editor | Rebuild) -> Done:
        """Insert them."""
        xyz = as_new_points(self.points)
        return tin.insert(xyz, choice("duplicates", self.duplicates, DuplicatePolicy))


@dataclass(eq=False)
class Remove(Operation):
    """Vertices that go."""

    operation: ClassVar[str] = "remove"

    vertices: ArrayLike

    def do(self, tin: Editor | Rebuild) -> Done:
        """Remove them."""
        return tin.remove(require_distinct(as_vertices(self.vertices, tin.count)))


@dataclass(eq=False)
class Move(Operation):
    """A vertex at another place."""

    operation: ClassVar[str] = "move"

    vertex: int
    point: ArrayLike

    def do(self, tin: Editor | Rebuild) -> Done:
        """Move it."""
        return tin.move(as_vertices([self.vertex], tin.count), as_point(self.point))


@dataclass(eq=False)
class SetElevation(Operation):
    """Vertices at other elevations."""

    operation: ClassVar[str] = "set_elevation"

    vertices: ArrayLike
    z: ArrayLike

    def do(self, tin: Editor | Rebuild) -> Done:
        """Set them."""
        numbers = as_vertices(self.vertices, tin.count)
        return tin.set_elevations(numbers, as_vertex_elevations(self.z, len(numbers)))


@dataclass(eq=False)
class Flip(Operation):
    """The other diagonal of the two triangles at an edge."""

    operation: ClassVar[str] = "flip"

    a: int
    b: int

    def do(self, tin: Editor | Rebuild) -> Done:
        """Flip it."""
        return tin.flip(as_ends(self.a, self.b, tin.count))


@dataclass(eq=False)
class AddBreakline(Operation):
    """A further breakline."""

    operation: ClassVar[str] = "add_breakline"
    is_of_vertices: ClassVar[bool] = False

    coords: ArrayLike
    kind: BreaklineKind = "hard"
    priority: int = 0
    name: str = ""
    crossing: CrossingPolicy = "split"

    def do(self, tin: Rebuild) -> Done:
        """Add it."""
        line = Breakline(self.coords, kind=self.kind, priority=self.priority, name=self.name)
        return tin.add_breakline(line, choice("crossing", self.crossing, CrossingPolicy))


@dataclass(eq=False)
class RemoveBreakline(Operation):
    """A breakline that goes."""

    operation: ClassVar[str] = "remove_breakline"
    is_of_vertices: ClassVar[bool] = False

    number: int

    def do(self, tin: Rebuild) -> Done:
        """Remove it."""
        if not is_whole_number(self.number):
            raise LinesError(f"Invalid breakline {shown(self.number)}: a whole number is needed.")
        return tin.remove_breakline(int(self.number))


OPERATIONS: dict[str, type[Operation]] = {
    kind.operation: kind
    for kind in (Insert, Remove, Move, SetElevation, Flip, AddBreakline, RemoveBreakline)
}
"""The operations by the names of the methods of a TIN that do them."""
