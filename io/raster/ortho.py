"""An ortho for a surface: the part of a picture over it, in its CRS, small enough to be drawn."""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base import optional
from ...base.crs import CRS
from ...base.errors import OptionError, ReadError
from ...base.notes import warn
from ...base.sentences import FILE
from ...terrain.viewer import Ortho
from ..isolated import Limits, choose_limits, require_local, run_isolated
from ..reprojection import reproject

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from ...tin import TIN

_SECONDS = 60.0
"""Of processor time beyond those of the file's size: a small file can unpack to many pixels."""

_BYTES_PER_PIXEL = 32


def read_ortho(
    source: str | os.PathLike[str],
    tins: Sequence[TIN],
    *,
    most_pixels: int,
    transparent: str = "png",
    beyond: str = "the tints by elevation stay there",
) -> Ortho:
    """Read the picture to drape over surfaces of one CRS.

    Parameters
    ----------
    source : path-like
        A GeoTIFF in any CRS, or a PNG, JPEG or JPEG 2000 file with its place: colours, grey or a
        palette of 8 or 16 bits, with or without opacity, a mask or a nodata value.
    tins : sequence of TIN
    most_pixels : int
        Greatest width and height.
    transparent : {"png", "webp"}
        Kind of picture where a part is transparent.
    beyond : str
        What becomes of the surface beyond the picture, for the sentence that tells of it.

    Raises
    ------
    OptionError
        If it is no path.
    ReadError
        If the file is missing, damaged, no picture, or has no place on the ground; or shows none of
        the surface.
    CrsError
        If the picture cannot be brought to the CRS of the surface.
    MissingExtraError
        If rasterio is not installed.

    Warns
    -----
    LossWarning
        If the picture is warped or made smaller, does not reach over all of the surface, or
        something is taken for granted that it does not tell.
    """
    path = as_picture_path(source, "ortho")
    optional.require("rasterio", "Reading a picture to drape")
    crs = None if tins[0].crs is None else tins[0].crs.horizontal
    value, arrays = _ask_child(path, tins, crs, most_pixels, transparent)
    opacity = arrays.get("opacity")
    ortho = Ortho(
        path=path,
        content=arrays["content"].tobytes(),
        kind=value["kind"],
        shape=tuple(value["shape"]),
        transform=tuple(value["transform"]),
        opacity=opacity,
    )
    gap = ortho.measure_gap(tins)
    noted = [
        *value["notes"],
        *_describe_placement(value, tins, crs),
        *_describe_size(value, most_pixels),
    ]
    if gap > 0.0:
        noted.append(f"'{path}' does not reach over {gap:.1%} of the vertices: {beyond}.")
    for sentence in noted:
        warn(sentence)
    return replace(ortho, gap=gap, notes=tuple(noted))


def as_picture_path(source: object, option: str) -> Path:
    """Return the path of a picture on this machine, or refuse it.

    Parameters
    ----------
    source : object
    option : str
        Name of the parameter.
    """
    if not isinstance(source, str | os.PathLike):
        raise OptionError(option, source, "the path of a GeoTIFF, PNG or JPEG file")
    require_local(source)
    path = Path(source)
    if path.is_dir():
        raise ReadError(f"'{path}' is a folder: name a picture in it.", path=path)
    try:
        path.open("rb").close()
    except OSError as error:
        raise ReadError(f"Cannot read '{path}': {error.strerror or error}.", path=path) from error
    return path


def _ask_child(
    path: Path, tins: Sequence[TIN], crs: CRS | None, most_pixels: int, transparent: str
) -> tuple[dict[str, Any], dict[str, Any]]:
    used = [tin.points[np.unique(tin.triangles), :2] for tin in tins]
    low = np.min([one.min(axis=0) for one in used], axis=0)
    high = np.max([one.max(axis=0) for one in used], axis=0)
    wanted = {
        "path": os.path.abspath(path),  # noqa: PTH100 - no link is followed
        "shown": str(path),
        "crs": None if crs is None else crs.to_wkt(),
        "bounds": [*low.tolist(), *high.tolist()],
        "most_pixels": most_pixels,
        "transparent": transparent,
    }
    usual = choose_limits(path.stat().st_size)
    memory = usual.memory + _BYTES_PER_PIXEL * most_pixels**2
    limits = Limits(usual.seconds + _SECONDS, memory)
    function = f"{__package__}.ortho_child:read_picture"
    value, arrays = run_isolated(function, wanted, path=path, limits=limits)
    return value, arrays


def _describe_placement(
    value: dict[str, Any], tins: Sequence[TIN], crs: CRS | None
) -> Iterator[str]:
    """Yield what was done, or taken for granted, to place a picture."""
    known = CRS.of(value["crs"])
    if value["is_warped"]:
        assert known is not None
        assert crs is not None
        yield f"{FILE} was warped from {known.label} to {crs.label}."
        quality = reproject(tins[0].points[tins[0].triangles[0]], crs, known, unit=None).quality
        if quality.note:
            yield quality.note
    elif known is None and crs is not None:
        yield f"{FILE} names no CRS: it is taken to be in that of the surface, {crs.label}."
    elif known is not None and crs is None:
        yield f"The surface has no CRS: it is taken to be in that of {FILE}, {known.label}."


def _describe_size(value: dict[str, Any], most_pixels: int) -> Iterator[str]:
    """Yield the loss of detail, where pixels were averaged."""
    width, height = value["part"]
    rows, columns = value["shape"]
    if value["is_reduced"]:
        yield (
            f"{FILE} was made smaller, from {width} x {height} to {columns} x {rows} pixels: "
            f"{most_pixels:,} in a row are the most that is drawn."
        )
