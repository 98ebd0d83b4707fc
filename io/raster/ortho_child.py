"""Pictures with a place on the ground through rasterio, as the child process reads them.

The part over the surface is read, and made smaller where it has to be; its colours are brought to
8 bits, and its pixels to the CRS of the surface. The result is JPEG, or a format with opacity where
it is partly transparent.
"""

from __future__ import annotations

import warnings
from typing import Any, NamedTuple

import numpy as np

from ...base.crs import CRS
from ..isolated import Answer, Refusal, make_environment
from .gdal_child import prepare as prepare

ENVIRONMENT = make_environment()

_DRIVERS = ("GTiff", "PNG", "JPEG", "JP2OpenJPEG")
_OTHER_COLORS = {"cyan", "magenta", "yellow", "black", "hue", "saturation", "lightness"}
_OPAQUE = 255
_QUALITY = {"jpeg": {"quality": 92}, "webp": {"quality": 90}, "png": {}}
_DENSIFIED = 21
"""Places on each side of bounds that are transformed, for sides that become curves."""

_MARGIN = 2
"""Pixels around the part over the surface that are read too, for what is averaged at its edge."""


class _Source(NamedTuple):
    """An open picture, its path as the user wrote it, and what is to be told of it."""

    dataset: Any
    shown: str
    notes: list[str]


class _Bands(NamedTuple):
    """Numbers of the bands: of one grey or three colours, and of opacity if there is one."""

    colors: tuple[int, ...]
    alpha: int | None
    is_palette: bool


class _Picture(NamedTuple):
    """Red, green, blue and opacity, (4, rows, columns) uint8; their place; whether averaged."""

    colors: Any
    transform: Any
    is_reduced: bool


class _Target(NamedTuple):
    """What is wanted: WKT and bounds of the surface, most pixels, kind of what is transparent."""

    crs: str | None
    bounds: list[float]
    most_pixels: int
    transparent: str


class _Part(NamedTuple):
    """Of the whole picture: the columns and rows that are wanted."""

    left: int
    top: int
    width: int
    height: int


def read_picture(
    path: str,
    shown: str,
    *,
    crs: str | None,
    bounds: list[float],
    most_pixels: int,
    transparent: str,
) -> Answer:
    """Return the part of a picture over a surface, at most so many pixels wide and high.

    ``crs`` is the WKT of the surface's CRS, ``bounds`` are its west, south, east and north,
    ``transparent`` is the kind of the bytes where the picture is partly so, "png" or "webp".

    The value holds the ``kind`` of the bytes in the array ``content``, the ``shape`` and
    ``transform`` of the picture, the ``part`` of it that was read before it was made smaller
    (width, height), whether it has a CRS (``crs``), the CRS that it was warped from if any
    (``warped``), and what was taken for granted (``notes``). The array ``opacity`` is there where
    the picture is partly transparent.
    """
    import rasterio
    from rasterio.errors import NotGeoreferencedWarning, RasterioError

    try:
        with warnings.catch_warnings(), rasterio.Env():
            warnings.simplefilter("ignore", NotGeoreferencedWarning)
            with rasterio.DatasetReader(path, driver=_list_drivers()) as dataset:
                target = _Target(crs, bounds, most_pixels, transparent)
                return _read_source(_Source(dataset, shown, []), target)
    except RasterioError as error:
        raise RuntimeError(str(error.__cause__ or error)) from error


def _list_drivers() -> list[str]:
    import rasterio

    with rasterio.Env() as env:
        there = env.drivers()
    return [name for name in _DRIVERS if name in there]


def _read_source(source: _Source, target: _Target) -> Answer:
    place = source.dataset.transform
    if place.is_identity or place.determinant == 0:
        raise Refusal(f"'{source.shown}' has no place on the ground: it is not georeferenced.")
    bands = _choose_bands(source)
    own = _name_crs(source.dataset)
    is_elsewhere = own is not None and target.crs is not None and not CRS(own).is_same(target.crs)
    wanted = _find_bounds(source, own, target) if is_elsewhere else target.bounds
    part = _choose_part(source, wanted)
    picture = _read_part(source, bands, part, target.most_pixels)
    if is_elsewhere:
        picture = _warp(source, picture, own, target)
    kind = _choose_kind(picture.colors, bands, target.transparent)
    is_opaque = bool((picture.colors[3] == _OPAQUE).all())
    content = _encode(picture.colors[:3] if is_opaque else picture.colors, kind)
    value = {
        "kind": kind,
        "shape": list(picture.colors.shape[1:]),
        "transform": list(picture.transform[:6]),
        "part": [part.width, part.height],
        "is_reduced": picture.is_reduced,
        "is_warped": is_elsewhere,
        "crs": own,
        "notes": source.notes,
    }
    arrays = {"content": np.frombuffer(content, np.uint8)}
    return Answer(value, arrays if is_opaque else {**arrays, "opacity": picture.colors[3]})


def _name_crs(dataset: Any) -> str | None:
    """Return WKT of the horizontal CRS of a picture."""
    if not dataset.crs:
        return None
    return CRS(dataset.crs.to_wkt()).horizontal.to_wkt()


def _choose_bands(source: _Source) -> _Bands:
    dataset, shown = source.dataset, source.shown
    names = [one.name for one in dataset.colorinterp]
    if found := _OTHER_COLORS.intersection(names):
        raise Refusal(
            f"'{shown}' has colours as {', '.join(sorted(found))}: red, green and blue are needed."
        )
    alpha = names.index("alpha") + 1 if "alpha" in names else None
    rest = [number for number in range(1, dataset.count + 1) if number != alpha]
    colors = _choose_colors(names, rest, source)
    kinds = {dataset.dtypes[number - 1] for number in colors}
    if not kinds <= {"uint8", "uint16"}:
        raise Refusal(
            f"'{shown}' is no picture: it holds {min(kinds)} numbers, and colours of 8 or 16 bits "
            "(uint8, uint16) are needed."
        )
    return _Bands(colors, alpha, is_palette=names[colors[0] - 1] == "palette")


def _choose_colors(names: list[str], rest: list[int], source: _Source) -> tuple[int, ...]:
    """Return the bands of red, green and blue, or of grey."""
    if {"red", "green", "blue"} <= set(names):
        return tuple(names.index(color) + 1 for color in ("red", "green", "blue"))
    if len(rest) == 1:
        return (rest[0],)
    if len(rest) not in (3, 4):
        raise Refusal(
            f"'{source.shown}' is no picture: it has {len(rest)} bands, and does not say which "
            "are red, green and blue."
        )
    source.notes.append(
        f"'{source.shown}' does not say which of its {len(rest)} bands are red, green and blue: "
        "the first three are taken for them."
    )
    return tuple(rest[:3])


def _find_bounds(source: _Source, own: str | None, target: _Target) -> Any:
    """Return the bounds of the surface in the CRS of the picture."""
    from rasterio.warp import transform_bounds

    crs = _read_crs(target.crs), _read_crs(own)
    found = transform_bounds(*crs, *target.bounds, densify_pts=_DENSIFIED)
    if not np.isfinite(found).all():
        raise Refusal(
            f"'{source.shown}' shows nothing of the surface: its CRS does not reach there."
        )
    return found


def _read_crs(wkt: str | None) -> Any:
    from rasterio.crs import CRS as RasterCrs

    return RasterCrs.from_wkt(wkt)


def _choose_part(source: _Source, bounds: Any) -> _Part:
    """Return the whole picture, or the part over the surface where that is half of it or less."""
    west, south, east, north = bounds
    dataset = source.dataset
    inverse = ~dataset.transform
    corners = np.array([inverse * (x, y) for x in (west, east) for y in (south, north)])
    whole = np.array([dataset.width, dataset.height])
    first = np.clip(np.floor(corners.min(axis=0)), 0, whole)
    last = np.clip(np.ceil(corners.max(axis=0)), 0, whole)
    if not (first < last).all():
        raise Refusal(f"'{source.shown}' shows nothing of the surface: it lies elsewhere.")
    first = np.maximum(first - _MARGIN, 0).astype(int)
    last = np.minimum(last + _MARGIN, whole).astype(int)
    if 2 * np.prod(last - first, dtype=np.float64) > np.prod(whole, dtype=np.float64):
        first, last = np.zeros(2, int), whole
    return _Part(*(int(n) for n in (*first, *(last - first))))


def _read_part(source: _Source, bands: _Bands, part: _Part, most: int) -> _Picture:
    from rasterio.windows import Window

    factor = max(part.width, part.height, most) / most
    shape = (max(1, round(part.height / factor)), max(1, round(part.width / factor)))
    window = Window(part.left, part.top, part.width, part.height)
    opacity = _read_opacity(source.dataset, bands, window, shape)
    colors = _read_colors(source, bands, window, shape, opacity)
    transform = source.dataset.transform
    transform *= transform.translation(part.left, part.top)
    transform *= transform.scale(part.width / shape[1], part.height / shape[0])
    return _Picture(colors, transform, is_reduced=factor > 1)


def _read_opacity(dataset: Any, bands: _Bands, window: Any, shape: tuple[int, int]) -> Any:
    from rasterio.enums import Resampling

    if bands.alpha is None:
        return dataset.dataset_mask(window=window, out_shape=shape, resampling=Resampling.nearest)
    values = dataset.read(
        bands.alpha, window=window, out_shape=shape, resampling=Resampling.nearest
    )
    most = 255 if values.dtype == np.uint8 else max(int(values.max(initial=0)), 1)
    return _scale(values, most)


def _read_colors(
    source: _Source, bands: _Bands, window: Any, shape: tuple[int, int], opacity: Any
) -> Any:
    """Return red, green, blue and opacity, (4, rows, columns)."""
    from rasterio.enums import Resampling

    dataset = source.dataset
    how = Resampling.nearest if bands.is_palette else Resampling.average
    out = (len(bands.colors), *shape)
    values = dataset.read(list(bands.colors), window=window, out_shape=out, resampling=how)
    if bands.is_palette:
        colors = _look_up(values[0], dataset.colormap(bands.colors[0]))
        return np.concatenate([colors[:3], np.minimum(colors[3], opacity)[None]])
    colors = _scale(values, _find_white(source, bands, values[:, opacity > 0]))
    if dataset.tags(ns="IMAGE_STRUCTURE").get("MINISWHITE") == "YES":
        colors = 255 - colors
    colors = np.repeat(colors, 3, axis=0) if len(colors) == 1 else colors
    return np.concatenate([colors, opacity[None]])


def _look_up(indices: Any, palette: dict[int, tuple[int, ...]]) -> Any:
    table = np.zeros((1 << 16, 4), np.uint8)
    for index, color in palette.items():
        table[index] = color
    return np.moveaxis(table[indices], 2, 0)


def _find_white(source: _Source, bands: _Bands, values: Any) -> int:
    """Return the number that stands for white: the most that the bits of the colours hold."""
    known = source.dataset.tags(bands.colors[0], ns="IMAGE_STRUCTURE").get("NBITS")
    if known is not None and known.isdecimal():
        return int((1 << int(known)) - 1)
    if values.dtype == np.uint8:
        return 255
    most = int(values.max(initial=0))
    bits = max(8, most.bit_length())
    if bits < 16:
        source.notes.append(
            f"'{source.shown}' holds 16-bit colours up to {most:,}: they are taken for colours of "
            f"{bits} bits, of which {(1 << bits) - 1:,} is white."
        )
    return (1 << bits) - 1


def _scale(values: Any, most: int) -> Any:
    if values.dtype == np.uint8 and most == 255:
        return values
    scaled = (values.astype(np.uint32) * 255 + most // 2) // most
    return np.minimum(scaled, 255).astype(np.uint8)


def _warp(source: _Source, picture: _Picture, own: str | None, target: _Target) -> _Picture:
    """Bring a picture to the CRS of the surface, north up, within the surface's bounds."""
    from rasterio.enums import Resampling
    from rasterio.warp import reproject

    old, new = _read_crs(own), _read_crs(target.crs)
    place, shape, is_reduced = _choose_grid(source, picture, (old, new), target)
    colors = np.zeros((4, *shape), np.uint8)
    reproject(
        picture.colors,
        colors,
        src_transform=picture.transform,
        src_crs=old,
        dst_transform=place,
        dst_crs=new,
        src_alpha=4,
        dst_alpha=4,
        resampling=Resampling.bilinear,
    )
    return _Picture(colors, place, is_reduced=picture.is_reduced or is_reduced)


def _choose_grid(
    source: _Source, picture: _Picture, crs: tuple[Any, Any], target: _Target
) -> tuple[Any, tuple[int, int], bool]:
    """Return transform and shape of pixels north up, as large as those of a picture in its middle.

    GDAL's own choice goes through a virtual raster, whose driver is not loaded here.
    """
    from rasterio.transform import Affine, array_bounds
    from rasterio.warp import transform_bounds

    rows, columns = picture.colors.shape[1:]
    box = array_bounds(rows, columns, picture.transform)
    reach = np.array(transform_bounds(*crs, *box, densify_pts=_DENSIFIED))
    west, south = np.maximum(reach[:2], target.bounds[:2])
    east, north = np.minimum(reach[2:], target.bounds[2:])
    spans = np.array([east - west, north - south])
    pixel = _measure_pixel(picture, *crs)
    if not (np.isfinite([*spans, *pixel]).all() and (spans > 0).all() and (pixel > 0).all()):
        raise Refusal(f"'{source.shown}' cannot be brought to the CRS of the surface.")
    wanted = np.maximum(np.ceil(spans / pixel), 1.0)
    factor = max(wanted.max() / target.most_pixels, 1.0)
    width, height = (max(1, round(count / factor)) for count in wanted.tolist())
    place = Affine(spans[0] / width, 0.0, west, 0.0, -spans[1] / height, north)
    return place, (height, width), bool(factor > 1)


def _measure_pixel(picture: _Picture, old: Any, new: Any) -> Any:
    """Return width and height of a pixel in the middle of a picture, in another CRS."""
    from rasterio.warp import transform

    rows, columns = picture.colors.shape[1:]
    middle = np.array([columns / 2, rows / 2])
    places = [picture.transform * tuple(middle + step) for step in ((0, 0), (1, 0), (0, 1))]
    moved = np.array(transform(old, new, *zip(*places, strict=True)))
    return np.hypot(*(moved[:, 1:] - moved[:, :1]).T)


def _choose_kind(colors: Any, bands: _Bands, transparent: str) -> str:
    """Return the smallest kind that holds the picture: a drawing in few colours stays sharp."""
    import rasterio

    if (colors[3] < _OPAQUE).any():
        with rasterio.Env() as env:
            return transparent if transparent.upper() in env.drivers() else "png"
    return "png" if bands.is_palette else "jpeg"


def _encode(colors: Any, kind: str) -> bytes:
    """Return a picture in the format of a kind, with no file beside it."""
    from rasterio.io import MemoryFile

    profile: dict[str, Any] = {"driver": kind.upper(), "dtype": "uint8", "count": len(colors)}
    profile |= {"height": colors.shape[1], "width": colors.shape[2], **_QUALITY[kind]}
    with MemoryFile() as memory:
        with memory.open(**profile) as target:
            target.write(colors)
        return bytes(memory.read())
