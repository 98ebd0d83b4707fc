"""Members of a GeoJSON file that GDAL does not tell of: a CRS of ``null``, a unit of elevations."""

from __future__ import annotations

import json
import re
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from pathlib import Path

__all__ = ["Members", "read_json_members"]

_TAIL = 4096
_NO_CRS = re.compile(rb'"crs"\s*:\s*null')
_UNIT = re.compile(rb'"elevation_unit"\s*:\s*("(?:[^"\\\\]|\\\\.){0,200}")')
_FEATURES = re.compile(rb'"features"\s*:')


class Members(NamedTuple):
    """What a file says beside its features."""

    names_no_crs: bool = False
    """Whether it says that its CRS is not known, by the rule of 2008."""
    elevation_unit: str = ""
    """Empty if it names none."""
    is_json: bool = False


def read_json_members(head: bytes, path: Path) -> Members:
    """Look for members before and behind the features.

    Parameters
    ----------
    head : bytes
        The first bytes of the file; nothing is looked for in a file that is no JSON.
    path : Path
    """
    if not head.lstrip(b"\xef\xbb\xbf\x1e \t\r\n").startswith(b"{"):
        return Members()
    found = _FEATURES.search(head)
    around = head[: found.start()] if found else head
    around += b"," + _read_tail(path)
    unit = _UNIT.search(around)
    stated = _decode(unit.group(1)) if unit else ""
    return Members(_NO_CRS.search(around) is not None, stated, True)


def _read_tail(path: Path) -> bytes:
    """Return what stands behind the last feature."""
    with path.open("rb") as file:
        size = file.seek(0, 2)
        file.seek(max(0, size - _TAIL))
        return file.read().rpartition(b"]")[2]


def _decode(text: bytes) -> str:
    try:
        return str(json.loads(text))
    except ValueError:
        return ""
