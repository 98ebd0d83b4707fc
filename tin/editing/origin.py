"""Origin: what a TIN was before its edits, and the edits, so that they can be taken back."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from ...base.records import require
from ..report import Edit
from .operations import OPERATIONS

if TYPE_CHECKING:
    from ..building.inputs import BuildInputs
    from ..building.version import Version

__all__ = ["Origin"]


class Origin(NamedTuple):
    """What a TIN was built from, and what was done to it since.

    Attributes
    ----------
    inputs : BuildInputs or None
        What it was built from before all edits; None for one of existing triangles.
    given : Version or None
        Existing triangles before the first edit; None without edits.
    edits : tuple of Edit
    """

    inputs: BuildInputs | None = None
    given: Version | None = None
    edits: tuple[Edit, ...] = ()

    def _require_sound(self, version: Version) -> None:
        """Refuse stored edits of operations that there are not; arguments are judged when done."""
        told = (version, self.given or version)
        for edit in (*self.edits, *(edit for one in told for edit in one.report.edits)):
            require(isinstance(edit, Edit) and edit.operation in OPERATIONS, "the edits are none")
