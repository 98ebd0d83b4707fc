"""Points as LAS or LAZ, with scales that hold their coordinates."""

from __future__ import annotations

import datetime as dt
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...base import optional
from ...base.atomic import replacing
from ...base.checks import as_length
from ...base.crs import choose_wkt
from ...base.errors import WriteError
from ...base.notes import warn
from ...base.progress import Progress
from ...base.sentences import FILE, coordinate
from ...tin import TIN, Survey
from ..mesh import require_writable
from ..registry import warn_of_lost_attributes
from ..reprojection import require_kept

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from ...base.arrays import AnyArray, Float64Array, Int32Array
    from ...base.crs import CRS
    from ...base.progress import Tell

_FINEST = 6
"""Decimals that are written at most: a millionth of a CRS unit is below what anyone surveys."""

_COARSEST = -3
_LARGEST = 2**31 - 1
_ROUNDINGS = 4.0
"""Times the distance of two doubles by which a coordinate may differ and still be the same: the
product and the sum by which it is read are rounded."""

_POINT_FORMAT, _POINT_FORMAT_OF_COLOURS = 6, 7
_COLOURS = ("red", "green", "blue")
_CHUNK = 1_000_000
_NO_CLOCK = dt.date(1970, 1, 1)
_STANDARD = {
    "intensity": (0, 65535),
    "return_number": (0, 15),
    "number_of_returns": (0, 15),
    "synthetic": (0, 1),
    "key_point": (0, 1),
    "withheld": (0, 1),
    "overlap": (0, 1),
    "scanner_channel": (0, 3),
    "scan_direction_flag": (0, 1),
    "edge_of_flight_line": (0, 1),
    "classification": (0, 255),
    "user_data": (0, 255),
    "scan_angle": (-32768, 32767),
    "point_source_id": (0, 65535),
    "red": (0, 65535),
    "green": (0, 65535),
    "blue": (0, 65535),
}
"""Whole numbers that the format has a place for, and their range."""

_NAME_BYTES = 32
_EXTRA_TYPES = frozenset(("u1", "u2", "u4", "u8", "i1", "i2", "i4", "i8", "f4", "f8"))


class Scaling(NamedTuple):
    """How coordinates become whole numbers."""

    scales: Float64Array
    offsets: Float64Array
    """Both (3,)."""
    error: Float64Array
    """(3,), by how much the coordinates that are read differ most."""


def write(
    surface: TIN | Survey, path: Path, *, scale: float | None = None, progress: Tell | None = None
) -> None:
    """Write the points of a survey, or the vertices of a TIN, as LAS 1.4; ``.laz`` is compressed.

    Parameters
    ----------
    scale : float, optional
        Distance of neighbouring coordinates, in CRS units. Default on each axis the coarsest power
        of ten that gives every coordinate back, else the finest from a millionth on that holds the
        extent of the points in 32 bits.

    Raises
    ------
    MissingExtraError
        If laspy is not installed.
    WriteError
        If there are no points, a coordinate is not finite or has no place with this scale, or an
        attribute has values that its place in the format does not hold.
    OptionError
        If the scale is no positive number.

    Warns
    -----
    LossWarning
        For attributes that are texts, and elevations whose unit the CRS does not tell.

    Notes
    -----
    Attributes by the names of laspy take their places in the format, other numbers become extra
    bytes. The CRS is WKT in a variable-length record. The points of a TIN are its vertices; its
    triangles are not kept. The same points give the same bytes, and the date is 1970-01-01.
    """
    surface = require_writable(surface)
    laspy = optional.load("laspy", f"Writing {FILE}")
    _require_points(surface.points)
    scaling = _choose_scaling(
        surface.points, None if scale is None else as_length("scale", scale, or_none=True)
    )
    attributes = surface.attributes if isinstance(surface, Survey) else {}
    columns = choose_columns(attributes)
    header = make_header(laspy, scaling, columns, surface.crs)
    unit, crs = surface.elevation_unit, surface.crs
    stated = None if crs is None else crs.vertical_unit
    if unit is not None and stated is None:
        warn(
            f"{FILE} does not tell the unit of the elevations, the {unit}: its CRS has no "
            "vertical axis."
        )
    with replacing(path) as file:
        is_compressed = path.suffix.lower() == ".laz"
        with laspy.LasWriter(file, header, do_compress=is_compressed, closefd=False) as writer:
            write_points(laspy, writer, surface.points, columns, Progress(progress))
    require_crs(surface.crs, path)


def _require_points(points: Float64Array) -> None:
    if len(points) == 0:
        raise WriteError(f"Cannot write {FILE}: there are no points.")
    wrong = ~np.isfinite(points).all(axis=1)
    if wrong.any():
        row = int(np.argmax(wrong))
        raise WriteError(
            f"Cannot write {FILE}: point {row} is not finite, {points[row].tolist()}, and LAS "
            "has only finite coordinates."
        )


# ---------------------------------------------------------------------------- scales


def _choose_scaling(points: Float64Array, scale: float | None) -> Scaling:
    axes = [_scale_axis(points[:, k], scale, "xyz"[k]) for k in range(3)]
    return Scaling(*(np.array(column) for column in zip(*axes, strict=True)))


def _scale_axis(values: Float64Array, scale: float | None, axis: str) -> tuple[float, float, float]:
    """Return scale, offset and the largest error of one axis."""
    candidates = [10.0**-k for k in range(_COARSEST, _FINEST + 1)] if scale is None else [scale]
    enough = _ROUNDINGS * float(np.spacing(np.abs(values).max()))
    best: tuple[float, float, float] | None = None
    for one in candidates:
        tried = _try_scale(values, one)
        if tried is None:
            break  # a finer one holds even less
        best = tried
        if tried[2] <= enough:
            return tried
    if best is None:
        raise WriteError(
            f"Cannot write {FILE}: the {axis} coordinates reach from "
            f"{coordinate(values.min())} to "
            f"{coordinate(values.max())}, and with the scale {candidates[0]:g} 32 bits hold "
            "a length of "
            f"{2 * _LARGEST * candidates[0]:g}."
        )
    return best


def _try_scale(values: Float64Array, scale: float) -> tuple[float, float, float] | None:
    """Return scale, offset and error; None if the numbers would not fit into 32 bits."""
    low, high = float(values.min()), float(values.max())
    offset = 0.0
    if max(abs(low), abs(high)) / scale > _LARGEST:
        offset = float(np.floor(low / 2 + high / 2))
    if max(high - offset, offset - low) / scale > _LARGEST - 1:
        return None
    error = 0.0
    for start in range(0, len(values), _CHUNK):
        part = values[start : start + _CHUNK]
        again = _round_to_whole(part, scale, offset) * scale + offset
        error = max(error, float(np.abs(again - part).max()))
    return scale, offset, error


def _round_to_whole(values: Float64Array, scale: float, offset: float) -> Int32Array:
    return np.rint((values - offset) / scale).astype(np.int32)


# ------------------------------------------------------------------------ attributes


def choose_columns(attributes: Mapping[str, AnyArray]) -> dict[str, AnyArray]:
    """Return the attributes that the format holds, and tell of the others."""
    columns, texts = {}, []
    for name, given in attributes.items():
        values = np.asarray(given)
        if values.dtype.kind == "b":
            values = values.astype(np.uint8)
        if name == "gps_time" or (name not in _STANDARD and _fits_extra_bytes(name, values)):
            columns[name] = values
        elif name in _STANDARD and values.dtype.kind in "iuf":
            columns[name] = _require_range(name, values)
        else:
            texts.append(name)
    warn_of_lost_attributes(texts, "LAS has numbers, with names of 32 bytes")
    return columns


def _fits_extra_bytes(name: str, values: AnyArray) -> bool:
    is_plain = values.dtype.str[1:] in _EXTRA_TYPES and values.ndim == 1
    return is_plain and 0 < len(name.encode()) <= _NAME_BYTES and name not in ("X", "Y", "Z")


def _require_range(name: str, values: AnyArray) -> AnyArray:
    low, high = _STANDARD[name]
    fits = (values >= low) & (values <= high) & (values == np.rint(values))
    if not fits.all():
        row = int(np.argmin(fits))
        raise WriteError(
            f"Cannot write {FILE}: point {row} has the {name} {values[row]}, and LAS holds whole "
            f"numbers from {low} to {high} there."
        )
    return values


# ---------------------------------------------------------------------------- the file


def make_header(
    laspy: Any, scaling: Scaling, columns: Mapping[str, AnyArray], crs: CRS | None
) -> Any:
    """Return a header of laspy, with places for the attributes."""
    has_colours = any(name in columns for name in _COLOURS)
    header = laspy.LasHeader(
        version="1.4",
        point_format=_POINT_FORMAT_OF_COLOURS if has_colours else _POINT_FORMAT,
    )
    header.scales, header.offsets = scaling.scales, scaling.offsets
    header.creation_date, header.generating_software = _NO_CLOCK, "tinsmith"
    header.global_encoding.wkt = True
    standard = set(header.point_format.dimension_names)
    for name, values in columns.items():
        if name not in standard:
            header.add_extra_dim(laspy.ExtraBytesParams(name=name, type=values.dtype))
    if crs is not None:
        header.vlrs.append(laspy.vlrs.known.WktCoordinateSystemVlr(choose_wkt(crs)))
    return header


def write_points(
    laspy: Any,
    writer: Any,
    points: Float64Array,
    columns: Mapping[str, AnyArray],
    done: Progress,
) -> None:
    """Write points with their attributes behind those that are written already."""
    header = writer.header
    for start in range(0, len(points), _CHUNK):
        part = slice(start, start + _CHUNK)
        record = laspy.ScaleAwarePointRecord.zeros(len(points[part]), header=header)
        for k, axis in enumerate("XYZ"):
            scale, offset = float(header.scales[k]), float(header.offsets[k])
            record[axis] = _round_to_whole(points[part, k], scale, offset)
        if "number_of_returns" not in columns:
            ones = np.ones(len(record), np.uint8)
            record["return_number"], record["number_of_returns"] = ones, ones
        for name, values in columns.items():
            record[name] = values[part]
        writer.write_points(record)
        done((start + len(record)) / len(points))


def require_crs(crs: CRS | None, path: Path) -> None:
    """Read the CRS back as another program would, so that none is lost in silence."""
    if crs is None:
        return
    from .header import parse_header

    content = parse_header(path).find("LASF_Projection", 2112) or b""
    require_kept(crs, content.split(b"\0")[0].decode())
