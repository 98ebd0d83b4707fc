"""Edits that were done: how they are written down, and done again."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from copy import copy
from typing import TYPE_CHECKING, Any, NamedTuple

from ..._sentences import shown
from ...errors import PointsError, TinsmithError
from .arguments import as_plain_dict
from .operations import OPERATIONS

if TYPE_CHECKING:
    from ..surface import TIN

__all__ = ["Edit", "apply_edits"]


class Edit(NamedTuple):
    """One edit, as it can be written to a file and done again.

    Attributes
    ----------
    operation : str
        The name of a method of a TIN: one of ``OPERATIONS``.
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
        plain = as_plain_dict(self.operation, self.arguments)
        return plain | ({"notes": list(self.notes)} if self.notes else {})


def apply_edits(tin: TIN, edits: Iterable[Edit | Mapping[str, Any]]) -> None:
    """Do edits on a TIN, in their order.

    Parameters
    ----------
    tin : TIN
    edits : iterable of Edit or dict
        Dicts as :meth:`Edit.to_dict` gives them: ``{"op": "remove", "vertices": [3]}``.

    Raises
    ------
    PointsError, LinesError, OptionError
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
            numbered = copy(error)
            numbered.args = (f"Edit {number} ({operation}): {error}",)
            raise numbered from error


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
