"""The formats of lidar."""

from pathlib import Path

from ..registry import SURFACES, Format
from .signatures import is_lidar, is_lidar_folder, is_virtual_cloud, list_named_files


def _list_named(path: Path) -> list[Path]:
    return list_named_files(path) if is_virtual_cloud(path) else []


FORMATS = (
    Format(
        name="las",
        description="Lidar: LAS 1.0 to 1.4, LAZ and COPC",
        suffixes=(".las", ".laz"),
        read="tinsmith.io.lidar.reading:read",
        stream="tinsmith.io.lidar.reading:stream",
        describe="tinsmith.io.lidar.boxes:describe",
        read_box="tinsmith.io.lidar.boxes:read_box",
        write="tinsmith.io.lidar.writing:write",
        writes=SURFACES,
        precision=(
            "Coordinates are whole multiples of a power of ten, the coarsest that keeps each of "
            "them; else of a millionth of a CRS unit, or of the resolution of 32 bits."
        ),
        rounding=5.1e-7,
        relative_rounding=1.2e-9,
        losses=(
            "Of a TIN all but its vertices; lines and text attributes of a survey; the "
            "unit of elevations where the CRS has no vertical axis."
        ),
        loses=(
            *("elevation unit", "triangles", "constrained", "lines", "survey lines"),
            *("attributes", "notes", "report"),
        ),
        holds_classes=True,
        sniff=is_lidar,
        sniff_folder=is_lidar_folder,
        find_sources=_list_named,
    ),
)
