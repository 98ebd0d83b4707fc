"""Edit operations: the arguments of each, checked, for whoever carries it out: a mesh, or a build.

Each takes what does it and the arguments of the method of a TIN that has its name, and raises
NotLocal if a mesh cannot do it; nothing has changed then. A mesh does no other than ``LOCAL`` ones.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ...base.checks import is_whole_number
from ...base.errors import LinesError, choice
from ...base.policies import CrossingPolicy, DuplicatePolicy
from ...base.sentences import shown
from ..building import as_columns
from ..constraints import Breakline, as_sequence
from .arguments import (
    as_breakline,
    as_ends,
    as_new_points,
    as_point,
    as_vertex_elevations,
    as_vertices,
    require_distinct,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from numpy.typing import ArrayLike

    from .changes import Done
    from .mesh_editor import Editor
    from .rebuilding import Rebuild


def _insert(
    tin: Editor | Rebuild,
    points: ArrayLike,
    duplicates: DuplicatePolicy = "last",
    *,
    breaklines: Sequence[Any] = (),
    attributes: Mapping[str, Any] | None = None,
) -> Done:
    xyz = as_new_points(points)
    as_columns(attributes or {}, (len(xyz),))
    lines = tuple(map(as_breakline, as_sequence(breaklines, "breaklines")))
    return tin.insert(xyz, choice("duplicates", duplicates, DuplicatePolicy), lines)


def _remove(tin: Editor | Rebuild, vertices: ArrayLike) -> Done:
    return tin.remove(require_distinct(as_vertices(vertices, tin.count)))


def _move(tin: Editor | Rebuild, vertex: int, point: ArrayLike) -> Done:
    return tin.move(as_vertices([vertex], tin.count), as_point(point))


def _set_elevation(tin: Editor | Rebuild, vertices: ArrayLike, z: ArrayLike) -> Done:
    numbers = as_vertices(vertices, tin.count)
    return tin.set_elevations(numbers, as_vertex_elevations(z, len(numbers)))


def _flip(tin: Editor | Rebuild, a: int, b: int) -> Done:
    return tin.flip(as_ends(a, b, tin.count))


def _add_breakline(
    tin: Rebuild, coords: ArrayLike, crossing: CrossingPolicy = "split", **line: Any
) -> Done:
    made = Breakline(coords, **line)
    return tin.add_breakline(made, choice("crossing", crossing, CrossingPolicy))


def _remove_breakline(tin: Rebuild, number: int) -> Done:
    if not is_whole_number(number):
        raise LinesError(f"Invalid breakline {shown(number)}: a whole number is needed.")
    return tin.remove_breakline(int(number))


LOCAL: dict[str, Callable[..., Done]] = {
    "insert": _insert,
    "remove": _remove,
    "move": _move,
    "set_elevation": _set_elevation,
    "flip": _flip,
}
"""Operations on vertices, which a mesh can do where no line is near."""

OPERATIONS: dict[str, Callable[..., Done]] = {
    **LOCAL,
    "add_breakline": _add_breakline,
    "remove_breakline": _remove_breakline,
}
"""The operations by the names of the methods of a TIN that do them."""
