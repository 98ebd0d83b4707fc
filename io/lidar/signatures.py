"""What shows a lidar file, or a folder of them."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path

__all__ = ["SUFFIXES", "is_lidar", "is_lidar_folder", "list_tiles"]

SUFFIXES = (".las", ".laz")


def is_lidar(head: bytes) -> bool:
    """Whether the file is LAS, LAZ or COPC."""
    return head.startswith(b"LASF")


def is_lidar_folder(folder: Path) -> bool:
    """Whether a folder holds lidar tiles."""
    return bool(list_tiles(folder))


def list_tiles(folder: Path) -> list[Path]:
    """Return the lidar files of a folder, in the order of their names; not those of folders in it.

    Hidden files, such as those that a system keeps beside others, are none.
    """
    return sorted(
        file
        for file in folder.iterdir()
        if file.suffix.lower() in SUFFIXES and not file.name.startswith(".") and file.is_file()
    )
