"""What SQLite keeps beside a GeoPackage that is in use."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ....base.errors import WriteError
from ....base.sentences import FILE

if TYPE_CHECKING:
    from pathlib import Path

__all__ = ["require_closed"]

_ENDS = ("-wal", "-journal")
"""SQLite would play what is in these into any file of that name."""


def require_closed(path: Path) -> None:
    """Refuse to write a GeoPackage that another program works on.

    Raises
    ------
    WriteError
        If it does.
    """
    for end in _ENDS:
        journal = path.with_name(path.name + end)
        if journal.exists():
            raise WriteError(
                f"Cannot write {FILE}: it is open in another program, as '{journal.name}' beside "
                "it shows; close it there first."
            )
