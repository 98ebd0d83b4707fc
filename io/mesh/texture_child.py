"""Pictures with a georeference through rasterio, as the child process reads them."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np

from ..isolated import Answer, Refusal
from ..isolated.gdal import make_environment

__all__ = ["ENVIRONMENT", "prepare", "read_picture"]

ENVIRONMENT = make_environment()
_DRIVERS = ("GTiff", "PNG", "JPEG", "JP2OpenJPEG")
_MOST_CELLS = 1 << 28


def prepare() -> None:
    """Load the library, and make sure that no driver is loaded that follows references."""
    from ..raster.gdal_child import prepare as prepare_gdal

    prepare_gdal()


def read_picture(path: str, shown: str, *, most_pixels: int) -> Answer:
    """Return a picture as PNG or JPEG, at most so wide and high.

    Parameters
    ----------
    path : str
    shown : str
        The path as the user wrote it, for sentences.
    most_pixels : int

    Returns
    -------
    Answer
        The value holds the ``kind`` of the bytes in the array ``content``, "png" or "jpeg",
        ``width`` and ``height`` of the whole picture, ``shape`` as returned, its ``transform``
        (null where there is none) and ``crs``.
    """
    import rasterio
    from rasterio.errors import NotGeoreferencedWarning, RasterioError

    try:
        with warnings.catch_warnings(), rasterio.Env():
            warnings.simplefilter("ignore", NotGeoreferencedWarning)
            with rasterio.DatasetReader(path, driver=_list_drivers()) as dataset:
                return _read_dataset(dataset, shown, most_pixels)
    except RasterioError as error:
        raise RuntimeError(str(error.__cause__ or error)) from error


def _list_drivers() -> list[str]:
    import rasterio

    with rasterio.Env() as env:
        there = env.drivers()
    return [name for name in _DRIVERS if name in there]


def _read_dataset(dataset: Any, shown: str, most_pixels: int) -> Answer:
    if set(dataset.dtypes) != {"uint8"} or dataset.count not in (1, 3, 4):
        raise Refusal(
            f"'{shown}' is no picture for a texture: it has {dataset.count} "
            f"{'band' if dataset.count == 1 else 'bands'} of {dataset.dtypes[0]}, and 1, 3 or 4 of "
            "8-bit colours are needed."
        )
    factor = max(dataset.width, dataset.height, most_pixels) / most_pixels
    shape = (max(1, round(dataset.height / factor)), max(1, round(dataset.width / factor)))
    colors = _read_colors(dataset, shape)
    has_alpha = colors.shape[0] == 4 and bool((colors[3] < 255).any())
    kind = "png" if has_alpha else "jpeg"
    content = _encode(colors if has_alpha else colors[:3], kind)
    transform = None if dataset.transform.is_identity else list(dataset.transform[:6])
    value = {
        "kind": kind,
        "width": dataset.width,
        "height": dataset.height,
        "shape": list(shape),
        "transform": transform,
        "crs": dataset.crs.to_wkt() if dataset.crs else None,
    }
    return Answer(value, {"content": np.frombuffer(content, np.uint8)})


def _read_colors(dataset: Any, shape: tuple[int, int]) -> Any:
    """Return red, green, blue and opacity, (4, rows, columns)."""
    from rasterio.enums import ColorInterp, Resampling

    is_palette = dataset.colorinterp[0] == ColorInterp.palette
    how = Resampling.nearest if is_palette else Resampling.average
    bands = dataset.read(out_shape=(dataset.count, *shape), resampling=how)
    if is_palette:
        table = np.zeros((256, 4), np.uint8)
        for index, color in dataset.colormap(1).items():
            if 0 <= index < 256:
                table[index] = color
        return np.moveaxis(table[bands[0]], 2, 0)
    colors = bands[:3] if dataset.count > 1 else np.repeat(bands[:1], 3, axis=0)
    opacity = bands[3] if dataset.count == 4 else dataset.dataset_mask(
        out_shape=shape, resampling=Resampling.nearest)  # fmt: skip
    return np.concatenate([colors, opacity[None]])


def _encode(colors: Any, kind: str) -> bytes:
    """Return a picture in the format of a kind, with no file beside it."""
    from rasterio.io import MemoryFile

    profile: dict[str, Any] = {"driver": kind.upper(), "dtype": "uint8", "count": len(colors)}
    profile |= {"height": colors.shape[1], "width": colors.shape[2]}
    if kind == "jpeg":
        profile |= {"quality": 92}
    with MemoryFile() as memory:
        with memory.open(**profile) as target:
            target.write(colors)
        return bytes(memory.read())
