"""The session of a TIN that is edited: its history, going back, and what is there now."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple, cast

import numpy as np

from ...base.checks import require_count
from ...base.errors import PointsError, TinsmithError
from ...base.interrupts import hold_interrupts
from ...base.records import require
from ...base.sentences import counted, inflect
from ..report import Edit
from .accounts import account_for_edits
from .arguments import copy_argument
from .changes import Change, NumberedInputs
from .existing_triangles import build_of_triangles, gather_inputs_of_triangles
from .mesh_editor import Editor, NotLocal, is_local
from .operations import LOCAL, OPERATIONS
from .rebuilding import Rebuild

if TYPE_CHECKING:
    from ...base.arrays import AnyArray
    from .._kernel import EditedMesh
    from ..building import BuildInputs, Version


class Origin(NamedTuple):
    """What a TIN was built from, and what was done to it since."""

    inputs: BuildInputs | None = None
    """What it was built from before all edits; None for one of existing triangles."""
    given: Version | None = None
    """Existing triangles before the first edit; None without edits."""
    edits: tuple[Edit, ...] = ()

    def _require_sound(self, version: Version) -> None:
        """Refuse stored edits of operations that there are not; arguments are judged when done."""
        told = (version, self.given or version)
        for edit in (*self.edits, *(edit for one in told for edit in one.report.edits)):
            require(isinstance(edit, Edit) and edit.operation in OPERATIONS, "the edits are none")


class Session:
    """The edits of a TIN: the inputs at the beginning, what was done to them, and where that led.

    The TIN is always the build of the inputs. Edits that reach no line are done in a mesh, for
    which :class:`.Editor` is kept; for all others everything is built anew beside what is there,
    and takes its place when it is complete. So an edit that fails changes nothing.

    It begins with a version and what that was built from, None for one of existing triangles:
    PointsError if these are no Delaunay triangulation.
    """

    def __init__(self, version: Version, build_inputs: BuildInputs | None) -> None:
        self.edits: list[Edit] = []
        self._changes: list[Change] = []
        self._given: Version | None = None if build_inputs is not None else version
        if build_inputs is None:
            build_inputs = gather_inputs_of_triangles(version)
            version = build_of_triangles(version, build_inputs)
        self._begin = NumberedInputs.of(build_inputs)
        self._version: Version | None = version
        self._inputs, self._n_applied = self._begin, 0
        self._editor: Editor | None = None

    @classmethod
    def resume(cls, origin: Origin, version: Version) -> Session:
        """Return the session of a TIN that was stored: its edits are done again.

        ``version`` is where they led; PointsError or LinesError if they lead elsewhere now.
        """
        given = origin.given
        if origin.inputs is not None:
            given = NumberedInputs.of(origin.inputs).build()
        session = cls(cast("Version", given), origin.inputs)
        for number, edit in enumerate(origin.edits):
            try:
                session.do(edit.operation, dict(edit.arguments))
            except (TypeError, LookupError, AttributeError) as error:
                raise PointsError(
                    f"The TIN cannot be edited: edit {number} ({edit.operation}) of its record has "
                    "the wrong arguments; triangulate its points first."
                ) from error
        found, wanted = session.now().triangulation, version.triangulation
        if not (
            _is_same(found.points, wanted.points) and _is_same(found.triangles, wanted.triangles)
        ):
            raise PointsError(
                "The TIN cannot be edited: the edits that its record names do not lead to it; "
                "triangulate its points first."
            )
        return session

    def origin(self) -> Origin:
        """Return what the TIN was before the edits, and the edits."""
        self.settle()
        given = None if not self.edits else self._given
        inputs = self._begin.build_inputs if self._given is None else None
        return Origin(inputs, given, tuple(self.edits))

    def copy(self) -> Session:
        """Return a session that goes on from here on its own."""
        other = Session.__new__(Session)
        other.__setstate__(self.__getstate__())
        return other

    def __getstate__(self) -> dict[str, Any]:
        self.settle()
        return {
            "edits": list(self.edits),
            "_changes": list(self._changes),
            "_given": self._given,
            "_begin": self._begin,
            "_version": self.now(),
        }

    def __setstate__(self, state: dict[str, Any]) -> None:
        vars(self).update(state)
        self._inputs, self._n_applied = self._begin, 0
        self._editor = None

    # ------------------------------------------------------------------ for TIN

    def version(self) -> Version:
        """Return the TIN after the edits."""
        self.settle()
        if self._given is not None and not self.edits:
            return self._given
        found, edits = self.now(), tuple(self.edits)
        if self._given is None:
            return replace(found, report=replace(found.report, edits=edits))
        own = np.append(found.vertex_of, np.int32(-1))  # rows of inputs, the given vertices
        vertex_of = np.append(own[self._given.vertex_of], own[self._begin.n_rows : -1])
        surface = found.triangulation
        counts = len(surface.points), len(surface.triangles)
        report = account_for_edits(self._given.report, vertex_of, *counts, edits)
        return replace(found, vertex_of=vertex_of, report=report)

    def do(self, name: str, arguments: dict[str, Any]) -> Any:
        """Do one of ``OPERATIONS`` and remember it; one that fails leaves everything as it was."""
        self.settle()
        do, before = OPERATIONS[name], self._version
        kept = {one: copy_argument(value) for one, value in arguments.items()}
        try:
            if self._editor is None and name in LOCAL:
                inputs = self.inputs()
                if is_local(inputs.build_inputs):
                    self._editor = Editor(self.now(), inputs)
            try:
                if self._editor is None or name not in LOCAL:
                    raise NotLocal
                done = do(self._editor, **arguments)
            except NotLocal:
                done = do(Rebuild(self.now, self.inputs()), **arguments)
        except TinsmithError:
            raise
        except BaseException:  # interrupted: the mesh may be half-way
            self._editor, self._version = None, before
            raise
        self._changes.append(done.change)
        self.edits.append(Edit(name, kept, done.notes))
        self._version = done.version
        if done.version is not None:
            self._editor = None
        return done.result

    def lend(self) -> EditedMesh | None:
        """Return what does edits of one vertex and logs them, until it is taken back."""
        if self._editor is None:
            return None
        self._editor.edited.lend()
        return self._editor.edited

    def count_added(self) -> list[int]:
        """Return how many rows each edit added to the inputs."""
        self.settle()
        return [len(change.added) for change in self._changes]

    def list_edits(self) -> tuple[Edit, ...]:
        """Return what was done, in order."""
        self.settle()
        return tuple(self.edits)

    def settle(self) -> None:
        """Write down the edits that were only logged; everything else asks for this first."""
        editor = self._editor
        if editor is None:
            return
        if editor.edited.logged:
            with hold_interrupts():  # what is taken from the log must arrive
                for edit, change in editor.take_log():
                    self.edits.append(edit)
                    self._changes.append(change)
                self._version = None
        if not editor.edited.is_sound:
            self._editor = None

    def undo(self, count: int) -> None:
        """Take back the last edits: build the inputs that were there before.

        Raises
        ------
        PointsError
            If there are not so many.
        OptionError
            If it is no whole number above 0.
        """
        self.settle()
        require_count("count", count)
        if count > len(self.edits):
            made = inflect(f"{len(self.edits)} [was|were] made", len(self.edits))
            raise PointsError(f"{counted(count, 'edit')} cannot be taken back: {made}.")
        left = len(self.edits) - count
        inputs = self._begin.after(self._changes[:left])
        version = inputs.build()
        del self.edits[left:], self._changes[left:]
        self._inputs, self._n_applied = inputs, left
        self._version, self._editor = version, None

    # ------------------------------------------------------------- for operations

    def now(self) -> Version:
        """Return the build of the inputs after the edits."""
        if self._version is None:
            editor = self._editor
            self._version = (
                self.inputs().build() if editor is None else editor.make_version(self.inputs)
            )
        return self._version

    def inputs(self) -> NumberedInputs:
        """Return what the TIN is the build of now."""
        self.settle()
        if self._n_applied < len(self._changes):
            self._inputs = self._inputs.after(self._changes[self._n_applied :])
            self._n_applied = len(self._changes)
        return self._inputs

    @property
    def count(self) -> int:
        """Number of vertices."""
        if self._editor is not None:
            return self._editor.count
        return len(self.now().triangulation.points)


def _is_same(one: AnyArray, other: AnyArray) -> bool:
    return one.shape == other.shape and one.tobytes() == other.tobytes()
