"""Edits that were done: how they are written down, and done again."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from copy import copy
from typing import TYPE_CHECKING, Any

from ...base.errors import PointsError, TinsmithError
from ...base.sentences import shown
from ..report import Edit
from .operations import OPERATIONS

if TYPE_CHECKING:
    from .editable import Editable


def apply_edits(tin: Editable, edits: Iterable[Edit | Mapping[str, Any]]) -> None:
    """Do edits on a TIN, in their order.

    Dicts are as :meth:`Edit.to_dict` gives them: ``{"op": "remove", "vertices": [3]}``. Raises
    PointsError, LinesError or OptionError at the first edit that fails, with its number; those
    before it stay done.
    """
    for number, edit in enumerate(edits):
        operation, arguments = _take_apart(edit, number)
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


def _take_apart(edit: Edit | Mapping[str, Any], number: int) -> tuple[str, dict[str, Any]]:
    if isinstance(edit, Edit):
        return edit.operation, edit.arguments
    arguments = {name: value for name, value in edit.items() if name not in ("op", "notes")}
    name = edit.get("op")
    operation = name if isinstance(name, str) else ""
    if operation not in OPERATIONS:
        raise PointsError(
            f"Edit {number} has op {shown(name)}: one of {', '.join(OPERATIONS)} is needed."
        )
    return operation, arguments
