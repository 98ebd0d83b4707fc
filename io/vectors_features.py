"""Features of a vector file through GDAL: geometries, columns and CRS, or one clear sentence."""

from __future__ import annotations

import re
import struct
import warnings
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..tin import MissingExtraError
from .crs import normalised
from .errors import ReadError
from .spooling import as_sentence, ordinary_file

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from numpy.typing import NDArray

__all__ = ["Features", "read_features"]

_FOLDERS = (".gdb",)
"""Suffixes of formats that are folders."""

_SHAPEFILE = b"\x00\x00\x27\x0a"
_GDAL_SOURCE = re.compile(r"^\S+\.cpp, \d+: ")


class Features(NamedTuple):
    """What a layer holds.

    Attributes
    ----------
    path : Path
    numbers : (n,) int64 array
        Feature numbers as GDAL counts them.
    geometries : (n,) object array
        Shapely geometries, none of them missing or empty.
    columns : dict of str to (n,) array
        By their names in lower case.
    crs : str or None
    notes : tuple of str
        What was left out.
    """

    path: Path
    numbers: NDArray[np.int64]
    geometries: NDArray[np.object_]
    columns: dict[str, NDArray[Any]]
    crs: str | None
    notes: tuple[str, ...]

    def label(self, row: int) -> str:
        """Return what a feature is called in sentences."""
        return f"'{self.path}': feature {self.numbers[row]}"


def read_features(path: Path, *, layer: str | None = None, where: str | None = None) -> Features:
    """Read the features of one layer of a vector file that GDAL reads.

    Parameters
    ----------
    path : Path
    layer : str, optional
        Needed if several layers have geometry.
    where : str, optional
        Condition on the columns, as in SQL.

    Raises
    ------
    MissingExtraError
        If pyogrio is not installed.
    ReadError
        If the file or layer is missing, damaged, empty, or no vector file.
    """
    with ordinary_file(path) as local:
        features = _read_layer(local, layer, where)
    if local == path:
        return features
    notes = tuple(note.replace(local.name, path.name) for note in features.notes)
    return features._replace(path=path, notes=notes)


def _read_layer(path: Path, layer: str | None, where: str | None) -> Features:
    raw = _pyogrio().raw
    _require_whole_file(path)
    with _gdal_sentences(path):
        chosen = _chosen_layer(path, layer)
        meta, numbers, geometries, values = raw.read(
            path, layer=chosen, where=where, return_fids=True
        )
    if len(numbers) == 0:
        raise ReadError(f"'{path}' has no features{_where_text(chosen, where)}.", path=path)
    names = [str(name).lower() for name in meta["fields"]]
    return _with_geometry(
        Features(
            path,
            np.asarray(numbers, np.int64),
            _shapes(geometries, numbers, path),
            dict(zip(names, values, strict=True)),
            normalised(meta["crs"]),
            (),
        )
    )


def _pyogrio() -> Any:
    try:
        import pyogrio
    except ImportError as error:
        raise MissingExtraError(
            "pyogrio", extra="vector", purpose="Reading vector files"
        ) from error
    return pyogrio


def _require_whole_file(path: Path) -> None:
    """Refuse a file that is missing, empty, or a shapefile shorter than it says."""
    try:
        if path.is_dir():
            if path.suffix.lower() in _FOLDERS:
                return
            raise ReadError(f"'{path}' is a folder: name a file in it.", path=path)
        size = path.stat().st_size
        with path.open("rb") as file:
            head = file.read(28)
    except ReadError:
        raise
    except OSError as error:
        raise as_sentence(path, error) from error
    if size == 0:
        raise ReadError(f"'{path}' is empty: there are no lines in it.", path=path)
    if head.startswith(_SHAPEFILE) and len(head) == 28:
        (words,) = struct.unpack(">i", head[24:])  # the length is counted in 16-bit words
        if size < 2 * words:
            raise ReadError(
                f"'{path}' is cut short: it has {size} of {2 * words} bytes.", path=path
            )


@contextmanager
def _gdal_sentences(path: Path) -> Iterator[None]:
    """Turn what GDAL raises or warns of damage into a sentence."""
    from pyogrio.errors import DataSourceError

    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            yield
    except DataSourceError as error:
        if "not recognized" in str(error):
            raise ReadError(f"'{path}' is no vector file that GDAL knows.", path=path) from error
        raise ReadError(f"'{path}' cannot be read: {_reason(error)}.", path=path) from error
    except (RuntimeError, ValueError, IndexError) as error:
        if isinstance(error, ReadError):
            raise
        raise ReadError(f"'{path}' cannot be read: {_reason(error)}.", path=path) from error


def _reason(error: Exception) -> str:
    text = " ".join(str(error).split("; ")[-1].split())
    return _GDAL_SOURCE.sub("", text).rstrip(".") or type(error).__name__


def _chosen_layer(path: Path, layer: str | None) -> str:
    layers = [str(name) for name, kind in _pyogrio().list_layers(path) if kind is not None]
    if not layers:
        raise ReadError(f"'{path}' has no layer with geometry, or is damaged.", path=path)
    if layer is None and len(layers) > 1:
        raise ReadError(
            f"'{path}' has {len(layers)} layers: name one of {', '.join(layers)} "
            f"('{path}:{layers[0]}', or the option layer).",
            path=path,
        )
    if layer is not None and layer not in layers:
        raise ReadError(
            f"'{path}' has no layer '{layer}' with geometry: there is {', '.join(layers)}.",
            path=path,
        )
    return layers[0] if layer is None else layer


def _where_text(layer: str, where: str | None) -> str:
    return f" in layer '{layer}'" if where is None else f" where {where}"


def _shapes(
    geometries: NDArray[np.object_], numbers: NDArray[np.int64], path: Path
) -> NDArray[np.object_]:
    import shapely

    shapes: NDArray[np.object_] = shapely.from_wkb(geometries, on_invalid="ignore")
    wrong = shapely.is_missing(shapes) & np.array([one is not None for one in geometries])
    if wrong.any():
        raise ReadError(
            f"'{path}': feature {numbers[np.argmax(wrong)]} has a geometry of another kind: "
            "lines or polygons are needed.",
            path=path,
        )
    return shapes


def _with_geometry(features: Features) -> Features:
    """Leave out the features that have no geometry, and note them."""
    import shapely

    is_empty = shapely.is_missing(features.geometries) | shapely.is_empty(features.geometries)
    if not is_empty.any():
        return features
    if is_empty.all():
        raise ReadError(
            f"'{features.path}': none of its {len(is_empty)} features has a geometry.",
            path=features.path,
        )
    count, first = int(is_empty.sum()), features.numbers[np.argmax(is_empty)]
    have = "feature has" if count == 1 else "features have"
    return features._replace(
        numbers=features.numbers[~is_empty],
        geometries=features.geometries[~is_empty],
        columns={name: column[~is_empty] for name, column in features.columns.items()},
        notes=(f"'{features.path.name}': {count} {have} no geometry (first: {first}).",),
    )
