"""Features through pyogrio, into whole files or none."""

from __future__ import annotations

import os
import warnings
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base import optional
from ...base.atomic import replacing_files
from ...base.errors import WriteError
from ...base.results import UNKNOWN_UNIT, build_geometries, unit_text
from ...base.sentences import FILE
from ...tin import Survey
from ..reprojection import require_kept
from .surface_features import make_features
from .well_known_binary import encode_equal_shapes

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence
    from pathlib import Path

    from ...base.arrays import AnyArray, BoolArray, ObjectArray
    from ...base.policies import FeatureKind
    from ...base.results import Features
    from .surface_features import Writable

_NO_CLOCK = "1970-01-01T00:00:00.000Z"
"""Time that GDAL writes as the present one, so that the same features give the same bytes."""


def write_layer(
    features: Features,
    path: Path,
    shown: Path,
    *,
    driver: str,
    names: Sequence[str] | None = None,
    metadata: Mapping[str, str] | None = None,
    geometries: ObjectArray | None = None,
    geometry_type: str | None = None,
    dataset_options: Mapping[str, str] | None = None,
    **options: str,
) -> None:
    """Write features as one layer of a new file, called as the product, else as ``shown``.

    Sentences call the file ``shown``, too. ``names`` of columns are given if the format needs
    others, ``geometries``, (n,) well-known binary, and their type if they are others than those of
    the features; ``metadata`` and further options of creation are those of the layer.

    Raises
    ------
    MissingExtraError
        If pyogrio is not installed.
    WriteError
        If it cannot be written, or GDAL had to change a value.
    """
    pyogrio = optional.load("pyogrio", f"Writing '{shown}'")
    if geometry_type is None:
        geometry_type = features.geometry_type + (" Z" if features.has_elevations else "")
    columns = [_as_field(name, values) for name, values in features.columns.items()]
    with _translate_faults(), _without_clock():
        pyogrio.raw.write(
            os.fspath(path),
            encode_geometries(features) if geometries is None else geometries,
            columns,
            list(features.columns) if names is None else list(names),
            field_mask=[_find_missing(values) for values in columns],
            driver=driver,
            layer=features.name or shown.stem,
            geometry_type=geometry_type,
            crs=None if features.crs is None else features.crs.to_wkt(),
            encoding="UTF-8",
            promote_to_multi=False,
            layer_metadata=None if metadata is None else dict(metadata),
            dataset_options=dataset_options,
            layer_options=options,
        )
        _require_last(pyogrio, path, len(features))
        found = pyogrio.read_info(path)["crs"] if features.crs is not None else None
    require_kept(features.crs, found)


def write_flatgeobuf(surface: Writable, path: Path, *, kind: FeatureKind | None = None) -> None:
    """Write a kind of parts of a surface, or features, as FlatGeobuf, named after the product.

    A spatial index gives features another order; points of a survey have none and stand in their
    own. Coordinates and numbers are the same float64. Units of columns and of elevations, and
    notes, are metadata of the layer.

    Parameters
    ----------
    kind : {"triangles", "points", "edges", "lines", "hull"}, optional
        Of a TIN; default triangles.
    """
    features = make_features(surface, kind)
    how: dict[str, Any] = {"SPATIAL_INDEX": "NO"} if isinstance(surface, Survey) else {}
    with replacing_files(path) as new:
        write_layer(features, new, path, driver="FlatGeobuf", metadata=describe(features), **how)


def _require_last(pyogrio: Any, path: Path, count: int) -> None:
    """Read the last feature: GDAL does not say when a disk is full as it closes a file."""
    if count == 0:
        return
    _, _, geometries, _ = pyogrio.raw.read(path, skip_features=count - 1)
    if len(geometries) != 1:
        raise OSError("the file that GDAL wrote is not complete (is the disk full?)")


def describe(features: Features) -> dict[str, str]:
    """Return units and notes as metadata of a layer.

    Returns
    -------
    dict of str to str
        ``elevation_unit`` of the coordinates, ``unit of <column>``, and ``notes``; a unit that is
        not known is "unknown".
    """
    metadata = {}
    if features.has_elevations:
        unit = features.elevation_unit
        metadata["elevation_unit"] = UNKNOWN_UNIT if unit is None else unit.name
    metadata |= {f"unit of {name}": unit_text(features.units, name) for name in features.units}
    if features.notes:
        metadata["notes"] = " ".join(features.notes)
    return metadata


def require_int64(name: str, values: AnyArray) -> None:
    """Refuse whole numbers that GDAL would wrap around."""
    if values.dtype == np.uint64 and len(values) and values.max() > np.iinfo(np.int64).max:
        raise WriteError(
            f"Cannot write {FILE}: column '{name}' holds {values.max()}, and "
            f"{np.iinfo(np.int64).max} is the largest whole number of the format."
        )


def encode_geometries(features: Features) -> ObjectArray:
    """Return geometries as well-known binary of the ISO kind."""
    equal = encode_equal_shapes(features)
    if equal is not None:
        return equal.astype(object)
    shapely = optional.load("shapely")
    dimension = 3 if features.has_elevations else 2
    geometries = build_geometries(features)
    written: Any = shapely.to_wkb(geometries, output_dimension=dimension, flavor="iso")
    return np.asarray(written, object)


def _as_field(name: str, values: AnyArray) -> AnyArray:
    require_int64(name, values)
    if values.dtype.kind == "U":
        return values.astype(object)
    if values.dtype.kind == "f" and values.dtype.itemsize not in (4, 8):
        return values.astype(np.float32 if values.dtype.itemsize == 2 else np.float64)
    narrow = {np.dtype(np.int8): np.int16, np.dtype(np.uint64): np.int64}
    return values.astype(narrow.get(values.dtype, values.dtype))


def _find_missing(values: AnyArray) -> BoolArray | None:
    if values.dtype.kind == "O":
        gaps = np.array([value is None for value in values], np.bool_)
        return gaps if gaps.any() else None
    return None


@contextmanager
def _translate_faults() -> Iterator[None]:
    """Turn what GDAL says into a sentence, also where it only warns that a value was changed."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error", RuntimeWarning)
            warnings.filterwarnings("ignore", message="'crs' was not provided")
            warnings.filterwarnings("ignore", message="Measured")  # of an empty shapefile
            yield
    except (RuntimeError, RuntimeWarning, ValueError, OSError) as error:
        reason = " ".join(str(error).split()).rstrip(".") or type(error).__name__
        raise WriteError(f"Cannot write {FILE}: {reason}.") from error


@contextmanager
def _without_clock() -> Iterator[None]:
    """Let GDAL write a fixed time."""
    pyogrio = optional.load("pyogrio", "Writing features")
    before = pyogrio.get_gdal_config_option("OGR_CURRENT_DATE")
    pyogrio.set_gdal_config_options({"OGR_CURRENT_DATE": _NO_CLOCK})
    try:
        yield
    finally:
        pyogrio.set_gdal_config_options({"OGR_CURRENT_DATE": before})
