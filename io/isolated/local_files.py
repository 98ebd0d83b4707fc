"""Only files of this machine are read."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING

from ...base.errors import ReadError

if TYPE_CHECKING:
    import os

__all__ = ["require_local"]

_ELSEWHERE = re.compile(r"[A-Za-z][A-Za-z0-9+.-]+:/|/vsi[a-z0-9_]+/|\\vsi")
"""A scheme of two letters or more (one is a drive), or a virtual file system of GDAL."""


def require_local(path: str | os.PathLike[str]) -> None:
    """Refuse an address in the network, or in a virtual file system of GDAL.

    Raises
    ------
    ReadError

    Examples
    --------
    >>> require_local("survey.csv")
    """
    if _ELSEWHERE.match(str(path)):
        raise ReadError(
            f"'{path}' is an address, and only files of this machine are read: download it first, "
            "or let the option `remote` do so where points or a TIN are read.",
            path=Path(path),
        )
