"""Origin: what a TIN was before its edits, and the edits, so that they can be taken back."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from ..building.inputs import BuildInputs
    from ..report import Edit
    from .version import Version

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
