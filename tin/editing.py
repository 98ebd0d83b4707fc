"""Editing of a TIN in place: operations, their history, going back and doing again.

Edits go to an :class:`.Editor` that is kept with the TIN; the TIN's arrays are made anew when they
are next looked at.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from copy import copy
from typing import TYPE_CHECKING, Any, NamedTuple, get_args

import numpy as np

from . import _kernel, topology
from .draping import drape
from .duplicates import DuplicatePolicy
from .editor import Editor
from .errors import LinesError, PointsError, TinsmithError
from .line_set import gather_lines
from .lines import Breakline
from .model import Clip, LineInfo, Model
from .options import is_one_of, is_whole_number, shown
from .pieces import Pieces
from .points import as_elevations, as_points
from .regions import Surface
from .tables import as_table
from .threads import thread_count
from .triangulation import Triangulation
from .version import Version

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from .surface import TIN

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
    """The edits of a TIN: its editor, what was done, and where it began.

    Parameters
    ----------
    tin : TIN
        Its arrays are read now, and not again.
    model : Model or None
        What the TIN was built from; None for one of existing triangles.
    """

    def __init__(self, tin: TIN, model: Model | None) -> None:
        self.edits: list[Edit] = []
        self._report = tin.report
        self._threads = thread_count(None, len(tin.points))
        hull = Surface(tin.points, tin.triangles, tin.neighbors, tin.constrained)
        self._begin = _model_of(tin) if model is None else model
        self._kept = self._begin
        self._done_since = 0
        is_whole = self._begin.clip.is_none
        is_sure = is_whole and model is not None
        self._editor = Editor(self._begin, hull if is_sure else None, threads=self._threads)
        if model is None:
            _require_same(self._editor.refreshed().surface, hull)
        if not is_whole:
            self._editor.refreshed()

    def copy(self) -> Session:
        """Return a session that goes on from here on its own."""
        other = copy(self)
        other.edits = list(self.edits)
        other._restore()
        return other

    def __getstate__(self) -> dict[str, Any]:
        return {name: value for name, value in vars(self).items() if name != "_editor"}

    def __setstate__(self, state: dict[str, Any]) -> None:
        vars(self).update(state)
        self._restore()

    # ------------------------------------------------------------------ for TIN

    def version(self) -> Version:
        """Return the TIN after the edits."""
        found = self._editor.refreshed()
        self._kept, self._done_since = found.model, len(self.edits)
        surface, vertex_of = found.surface, found.vertex_of
        return Version(
            triangulation=Triangulation(**surface._asdict()),
            vertex_of=vertex_of,
            lines=found.lines,
            report=self._report.after_edits(
                vertex_of, len(surface.points), len(surface.triangles), tuple(self.edits)
            ),
        )

    def do(self, operation: str, arguments: dict[str, Any]) -> Any:
        """Do one edit and remember it; one that fails leaves everything as it was.

        Raises
        ------
        PointsError, LinesError
            As the methods of :class:`.TIN`.
        """
        try:
            result, notes = self._run(operation, arguments)
        except BaseException:
            self._restore()
            raise
        self.edits.append(Edit(operation, arguments, notes))
        return result

    def undo(self, count: int) -> None:
        """Take back the last edits, by doing the others again from the beginning."""
        if not is_whole_number(count) or count < 1:
            raise PointsError(f"Invalid count {shown(count)}: a whole number >= 1 is needed.")
        if count > len(self.edits):
            raise PointsError(f"{count} edits cannot be taken back: {len(self.edits)} were made.")
        del self.edits[len(self.edits) - count :]
        self._kept, self._done_since = self._begin, 0
        self._restore()

    # ------------------------------------------------------------------ running

    def _restore(self) -> None:
        """Start again from the model that was last complete."""
        self._editor = Editor(self._kept, threads=self._threads)
        if self._editor.is_clipped:
            self._editor.refreshed()
        for edit in self.edits[self._done_since :]:
            self._run(edit.operation, edit.arguments)

    def _run(self, operation: str, arguments: dict[str, Any]) -> tuple[Any, tuple[str, ...]]:
        if operation not in OPERATIONS:
            raise PointsError(f"Invalid edit '{operation}': one of {', '.join(OPERATIONS)}.")
        notes: list[str] = []
        result = getattr(self, f"_{operation}")(notes, **arguments)
        if self._editor.is_clipped:
            result = self._after_clipping(operation, result)
        return result, tuple(notes)

    def _after_clipping(self, operation: str, result: Any) -> Any:
        """Make a clipped surface anew: some of its vertices may have come or gone."""
        found = self._editor.refreshed()
        if operation == "insert":
            return found.vertex_of[len(found.vertex_of) - len(result) :]
        return result

    def _slots(self, vertices: ArrayLike) -> NDArray[np.int32]:
        count = self._editor.count
        only = vertices[0] if isinstance(vertices, list) and len(vertices) == 1 else vertices
        if type(only) is int and 0 <= only < count:  # most edits: no arrays for one number
            return self._editor.slots(np.array([only], np.int64))
        try:
            numbers = np.atleast_1d(np.asarray(vertices))
        except Exception:
            numbers = np.empty(0, np.float64)
        is_masked = isinstance(vertices, np.ma.MaskedArray)
        if is_masked or numbers.ndim != 1 or numbers.dtype.kind not in "iu":
            raise PointsError(f"Invalid vertices {shown(vertices)}: whole numbers are needed.")
        wrong = (numbers < 0) | (numbers >= count)
        if wrong.any():
            raise PointsError(
                f"There is no vertex {int(numbers[np.argmax(wrong)])}: numbers 0 to {count - 1} "
                "are allowed."
            )
        return self._editor.slots(numbers.astype(np.int64))

    # --------------------------------------------------------------- operations

    def _insert(
        self, _: list[str], points: ArrayLike, duplicates: DuplicatePolicy = "last"
    ) -> NDArray[np.int32]:
        xyz = as_points(points)
        if not is_one_of(duplicates, get_args(DuplicatePolicy)):
            allowed = ", ".join(get_args(DuplicatePolicy))
            raise PointsError(f"Invalid duplicates {shown(duplicates)}: one of {allowed}.")
        slots = self._editor.insert(xyz, duplicates)
        return slots if self._editor.is_clipped else self._editor.numbers(slots)

    def _remove(self, _: list[str], vertices: ArrayLike) -> None:
        slots = self._slots(vertices)
        if len(slots) > 1 and len(np.unique(slots)) < len(slots):
            raise PointsError("A vertex is named twice: it can be removed once.")
        self._editor.remove(slots)

    def _move(self, _: list[str], vertex: int, point: ArrayLike) -> None:
        (slot,) = self._slots([vertex]).tolist()
        self._editor.move(slot, _one_point(point))

    def _set_z(self, _: list[str], vertices: ArrayLike, z: ArrayLike) -> None:
        slots = self._slots(vertices)
        heights = as_elevations(z)
        if heights.ndim == 1 and len(heights) != len(slots):
            raise PointsError(
                f"{heights.size} heights for {len(slots)} vertices: one each, or one for all, "
                "is needed."
            )
        self._editor.set_z(slots, heights)

    def _flip(self, _: list[str], a: int, b: int) -> None:
        first, second = self._slots([a, b]).tolist()
        if first == second:
            raise PointsError("An edge has two different ends.")
        self._editor.flip(first, second)

    def _add_breakline(
        self,
        notes: list[str],
        coords: ArrayLike,
        kind: str = "hard",
        priority: int = 0,
        name: str = "",
        crossing: str = "split",
    ) -> None:
        line = Breakline(coords, kind=kind, priority=priority, name=name)  # type: ignore[arg-type]
        if not is_one_of(crossing, ("split", "error")):
            raise LinesError(f"Invalid crossing {shown(crossing)}: one of split, error.")
        for xyz in self._with_heights(line):
            clean = as_points(xyz)
            info = LineInfo(line.kind, name=line.name, priority=float(line.priority))
            notes += self._editor.add_line(clean, info, splits=crossing == "split")

    def _with_heights(self, line: Breakline) -> list[NDArray[np.float64]]:
        checked = gather_lines([line], (), (), ())
        if not line.is_draped:
            return [line.coords]
        laid = drape(self._editor.hull(), checked, threads=self._threads).lines
        rows = np.column_stack([laid.xy, laid.heights])
        parts = np.split(rows, laid.offsets[1:-1])
        if not any(len(part) > 1 for part in parts):
            raise LinesError("The draped line lies outside the surface.")
        return [part for part in parts if len(part) > 1]

    def _remove_breakline(self, _: list[str], number: int) -> None:
        if not is_whole_number(number):
            raise LinesError(f"Invalid breakline {shown(number)}: a whole number is needed.")
        self._editor.remove_line(int(number))


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
    point_alone: NDArray[np.float64] = rows[0]
    return point_alone


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


# ------------------------------------------------- TINs made of existing triangles


def _model_of(tin: TIN) -> Model:
    """Take flagged edges for soft breaklines, and the rim for the boundary if it is not convex."""
    triangle, corner = np.nonzero(tin.constrained)
    start, end = topology.ends(tin.triangles, triangle, corner)
    once = (tin.neighbors[triangle, corner] < triangle) | (start < end)
    steps = np.unique(np.sort(np.stack([start, end], axis=1)[once], axis=1), axis=0)
    rim = [tin.points[ring, :2] for ring in tin.rings]
    is_whole = len(rim) == 1 and _is_convex(rim[0])
    infos = [LineInfo("soft", source) for source in range(len(steps))]
    chains = [step.tolist() for step in steps]
    if not is_whole:
        chains += [[*ring.tolist(), int(ring[0])] for ring in tin.rings]
        infos += [LineInfo("boundary") for _ in tin.rings]
    return Model(
        points=tin.points,
        pieces=Pieces.of_chains(chains, range(len(chains))),
        infos=tuple(infos),
        clip=Clip(has_rim=not is_whole),
        vertex_of=tin.vertex_of,
    )


def _is_convex(ring: NDArray[np.float64]) -> bool:
    a, b, c = (np.ascontiguousarray(np.roll(ring, -k, axis=0)) for k in range(3))
    return bool((_kernel.orientation(a, b, c) >= 0).all())


def _require_same(found: Surface, given: Surface) -> None:
    if len(found.triangles) == len(given.triangles):
        own, theirs = (_as_set(surface.triangles) for surface in (found, given))
        if (own == theirs).all():
            return
    raise PointsError(
        "The TIN is not the Delaunay triangulation of its points and lines that edits must keep: "
        "triangulate its points first."
    )


def _as_set(triangles: NDArray[np.int32]) -> NDArray[np.int32]:
    first = np.argmin(triangles, axis=1)
    rolled = np.take_along_axis(triangles, (first[:, None] + np.arange(3)) % 3, axis=1)
    return rolled[np.lexsort(rolled.T[::-1])]
