"""What writers of text meshes share: comments of the CRS and unit, and rows in batches."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .common import format_crs, format_unit

if TYPE_CHECKING:
    from collections.abc import Iterable
    from typing import IO

    from ...base.progress import Tell
    from ...tin import TIN

__all__ = ["BATCH", "write_batches", "write_reference"]

BATCH = 65_536
"""Rows that are formatted at once."""


def write_reference(file: IO[str], tin: TIN) -> None:
    """Write the CRS and the unit of elevations as comments, those that are known."""
    if tin.crs is not None:
        file.write(f"# crs: {format_crs(tin.crs)}\n")
    if unit := format_unit(tin):
        file.write(f"# elevation unit: {unit}\n")


def write_batches(
    file: IO[str], tin: TIN, batches: Iterable[tuple[int, str]], progress: Tell | None
) -> None:
    """Write the rows of all vertices and triangles, which come with their count."""
    total = len(tin.points) + len(tin.triangles)
    done = 0
    for count, batch in batches:
        file.write(batch)
        done += count
        if progress is not None:
            progress(done / total)
