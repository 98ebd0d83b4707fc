"""What the first bytes of a file, or the names in a folder, say about its mesh format."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path

__all__ = ["TIN_FILES", "is_2dm", "is_cityjson", "is_esri_tin", "is_off"]

TIN_FILES = ("tnxy.adf", "tnz.adf", "tnod.adf", "tedg.adf", "tmsk.adf", "tmsx.adf", "thul.adf",
             "tdenv.adf", "tdenv9.adf", "tnodinfo.adf", "teval.adf")  # fmt: skip
"""Names of the files in the folder of an Esri TIN; grids of Esri have others."""

_OFF = re.compile(rb"\s*(?:ST)?C?N?4?n?OFF\s")
_CITYJSON = re.compile(rb'"type"\s*:\s*"CityJSON"')


def is_2dm(head: bytes) -> bool:
    """Whether the file is a 2DM mesh."""
    return head.removeprefix(b"\xef\xbb\xbf").lstrip().startswith(b"MESH2D")


def is_off(head: bytes) -> bool:
    """Whether the file is an OFF mesh: its keyword."""
    return _OFF.match(head) is not None


def is_cityjson(head: bytes) -> bool:
    """Whether the file is CityJSON."""
    return head.lstrip(b"\xef\xbb\xbf \t\r\n").startswith(b"{") and (
        _CITYJSON.search(head) is not None
    )


def is_esri_tin(folder: Path) -> bool:
    """Whether a folder is an Esri TIN."""
    return all((folder / name).is_file() for name in TIN_FILES[:3])
