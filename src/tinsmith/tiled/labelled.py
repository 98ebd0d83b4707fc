"""Files of points with classes: their names, and how they come into the folder that was named."""

from __future__ import annotations

import shutil
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from ..base.atomic import replacing
from ..io.lidar import NamedFile, write_virtual_cloud

if TYPE_CHECKING:
    from ..base.crs import CRS


def name_files(files: list[Path]) -> list[str]:
    """Return names of files that are written, each once; an octree is written as plain LAZ."""
    names: list[str] = []
    taken: set[str] = set()
    for file in files:
        stem = file.stem.removesuffix(".copc").removesuffix(".COPC")
        suffix = file.suffix.lower()
        name, number = f"{stem}{suffix}", 1
        while name.lower() in taken:
            number += 1
            name = f"{stem}-{number}{suffix}"
        taken.add(name.lower())
        names.append(name)
    return names


@dataclass(frozen=True)
class GroundTiles:
    """Files of classified points, in the folder of a run until they are moved.

    Attributes
    ----------
    files : tuple of NamedFile
    counts : dict of int to int
        Points of each class, of those that were written.
    crs : CRS or None
    notes : tuple of str
    """

    files: tuple[NamedFile, ...]
    counts: dict[int, int]
    crs: CRS | None
    notes: tuple[str, ...]

    def move(self, folder: Path) -> Path:
        """Move the files to a folder, and write the virtual point cloud that names them.

        Returns
        -------
        Path
            The virtual point cloud; the folder where the CRS is not known, without which there is
            none.

        Raises
        ------
        WriteError
        """
        placed = [_move(one, folder) for one in self.files]
        if self.crs is None:
            return folder
        path = folder / f"{folder.absolute().name}.vpc"
        write_virtual_cloud(path, placed, self.crs)
        return path


def _move(one: NamedFile, folder: Path) -> NamedFile:
    target = folder / one.path.name
    try:
        one.path.replace(target)
    except OSError:  # on another disk
        with replacing(target) as file, one.path.open("rb") as made:
            shutil.copyfileobj(made, file)
    return NamedFile(target, one.count, one.low, one.high)
