"""Places given to a command as a vector file of points."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .output.failures import Failure
from .paths import Named

if TYPE_CHECKING:
    from pathlib import Path

    from ..terrain import Features
    from ..tin import TIN

__all__ = ["name_places", "read_places"]


def name_places(path: Path | None, flag: str) -> list[Named]:
    """Return the file that an option gives, if it does, for the list of inputs."""
    from ..io.vector.survey_lines import split_layer

    return [] if path is None else [Named(split_layer(path)[0], f"the file of {flag}")]


def read_places(given: Path, tin: TIN) -> Features:
    """Return the points of a vector file, reprojected to the CRS of a TIN.

    Raises
    ------
    Failure
        If it holds anything else than points.
    """
    from ..io.vector.geometries import read_geometries
    from ..io.vector.survey_lines import split_layer

    path, layer = split_layer(given)
    found = read_geometries(path, crs=tin.crs, layer=layer)
    if found.kind != "points":
        raise Failure(f"'{path}' has {found.kind}: points are needed.")
    return found
