"""What shows a lidar file, a folder of them, or a virtual point cloud that names them."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any
from urllib.parse import unquote

from ...base.errors import ReadError
from ...base.sentences import FILE
from ..isolated import require_local, translate_system_errors

if TYPE_CHECKING:
    from pathlib import Path

_MOST_BYTES = 1 << 28
"""Of a virtual point cloud, some thousand for each file that it names."""

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


def is_virtual_cloud(path: Path) -> bool:
    """Whether a file is a virtual point cloud (VPC), by its name."""
    return path.suffix.lower() == ".vpc"


def list_named_files(path: Path) -> list[Path]:
    """Return the files that a virtual point cloud names, in its order.

    It is a collection of items of STAC, as PDAL wrench and QGIS write it.

    References
    ----------
    https://github.com/PDAL/wrench/blob/main/vpc-spec.md
    """
    with translate_system_errors(path):
        if path.stat().st_size > _MOST_BYTES:
            raise ReadError(f"{FILE} is too large for a virtual point cloud.")
        content = path.read_bytes()
    try:
        items = json.loads(content)["features"]
        names = [str(_find_asset(item["assets"])["href"]) for item in items]
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
        raise ReadError(
            f"{FILE} is no virtual point cloud (VPC): it has no items with files, as STAC has them."
        ) from error
    if not names:
        raise ReadError(f"{FILE} names no files of points.")
    return [_locate(path, name) for name in dict.fromkeys(names)]


def _find_asset(assets: dict[str, Any]) -> Any:
    """Return the asset of points, by its role; older files call it "data" alone."""
    ours = (one for one in assets.values() if "data" in (one.get("roles") or ()))
    return next(ours, assets.get("data"))


def _locate(path: Path, name: str) -> Path:
    require_local(name)
    file = path.parent / unquote(name.removeprefix("file://"))
    if file.suffix.lower() not in SUFFIXES:
        raise ReadError(f"{FILE} names '{name}', which is no lidar file ({', '.join(SUFFIXES)}).")
    if not file.is_file():
        raise ReadError(f"{FILE} names '{name}', and there is no such file beside it.")
    return file
