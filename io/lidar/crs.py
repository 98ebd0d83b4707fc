"""The CRS of a lidar file: WKT, or the keys of GeoTIFF, with the unit of its elevations.

References
----------
OGC GeoTIFF Standard 1.1 (2019), for the numbers of the keys. ASPRS, LAS Specification 1.4 - R15,
section 3.
"""

from __future__ import annotations

import struct
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...base.atomic import scratch_folder
from ...base.crs import CRS, FOOT, METRE, US_SURVEY_FOOT, Unit
from ...base.errors import CrsError, MissingExtraError, ReadError, TinsmithError
from ...base.sentences import coordinate
from ..isolated import run_isolated
from ..reprojection import transform_points

if TYPE_CHECKING:
    from .header import Header

_PROJECTION = "LASF_Projection"
_WKT, _KEYS, _DOUBLES, _TEXTS = 2112, 34735, 34736, 34737
_GEOGRAPHIC_KEY, _PROJECTED_KEY, _LINEAR_UNIT_KEY = 2048, 3072, 3076
_VERTICAL_KEY, _VERTICAL_UNIT_KEY = 4096, 4099
_USER_DEFINED = 32767
_SAME_UNIT = 1e-3
"""Feet of either kind differ by 2e-6, any other two units by far more."""

_DEGREE = 111_000.0
"""Metres, about."""

_RADII, _HIGHEST = (6.3e6, 6.42e6), 1e4
"""Metres from the centre of the Earth at its surface; elevations are below the latter."""

_NO_NAMES = ("", "unnamed", "unknown", "undefined", "none", "local", "user-defined")

_UNITS = {9001: METRE, 9002: FOOT, 9003: US_SURVEY_FOOT}
_IN_FEET = {(5703, US_SURVEY_FOOT): 6360, (5703, FOOT): 8228}
"""NAVD 88 in metres, as files name it whose elevations are in feet, and what they mean."""


class HeaderReference(NamedTuple):
    """What the coordinates of a file are measured in."""

    crs: CRS | None = None
    """None if the file names none."""
    unit: Unit | None = None
    """Of elevations, if it is told apart from the CRS."""
    notes: tuple[str, ...] = ()


def find_reference(header: Header, *, is_declared: bool) -> HeaderReference:
    """Return what the variable-length records of a file say of its coordinates.

    Parameters
    ----------
    header : Header
    is_declared : bool
        Whether the caller names a CRS, which stands in for one that cannot be understood.

    Raises
    ------
    CrsError
        If the file names a CRS that PROJ does not know.
    ReadError
        If it names two units for the same.
    MissingExtraError
        If only GDAL understands its keys, and rasterio is not installed.

    Notes
    -----
    Where a file has both WKT and keys of GeoTIFF, which older programs read, they must mean the
    same; keys with a projection of their own are not compared.
    """
    try:
        return _find_reference(header)
    except (CrsError, MissingExtraError, ReadError) as error:
        if not is_declared or _is_from_the_centre(header, error):
            raise _advise(header, error) from error
        reason = str(error).removeprefix(f"'{header.path}': ")
        note = f"'{header.path.name}' names a CRS that was not used: {reason}"
        return HeaderReference(notes=(note,))


def _find_reference(header: Header) -> HeaderReference:
    rows = _list_keys(header)
    keys = {key: value for key, place, _, value in rows if place == 0} if rows else None
    every = [CRS.of(text) for text in _read_texts(header)]
    named = [crs for crs in every if not _is_unnamed(crs)]
    if every and not named and keys is None:
        return HeaderReference(notes=(_describe_unnamed(every[0].horizontal_unit),))
    if not named:
        return HeaderReference() if keys is None else _interpret_keys(header, keys)
    for other in (*named[1:], *_find_plain_code(keys or {})):
        _require_agreement(named[0], other, header)
    vertical, unit = named[0].vertical_unit, _UNITS.get((keys or {}).get(_VERTICAL_UNIT_KEY, 0))
    if vertical is None or unit is None:
        return HeaderReference(named[0], unit)
    if abs(unit.metres / vertical.metres - 1.0) > _SAME_UNIT:  # type: ignore[operator]
        raise ReadError(
            f"'{header.path}' has elevations in {vertical.name} by its WKT and in {unit.name} by "
            "its keys of GeoTIFF: declare the CRS that is right.",
            path=header.path,
        )
    return HeaderReference(named[0])


def _read_texts(header: Header) -> list[str]:
    """Return the WKT of each record that has some, once."""
    contents = [
        one.content for one in header.records if (one.user, one.number) == (_PROJECTION, _WKT)
    ]
    texts = [one.split(b"\0")[0].decode("utf-8", "replace").strip() for one in contents]
    return list(dict.fromkeys(text for text in texts if text))


def _find_plain_code(keys: dict[int, int]) -> list[CRS]:
    """Return the CRS whose number the keys give, if they give one."""
    code = keys.get(_PROJECTED_KEY) or keys.get(_GEOGRAPHIC_KEY)
    return [] if code in (None, 0, _USER_DEFINED) else [CRS.of(f"EPSG:{code}")]


def _require_agreement(first: CRS, other: CRS, header: Header) -> None:
    """Refuse two CRSs of one file that put its middle more than a metre apart."""
    ours, theirs = first.horizontal, other.horizontal
    if ours.is_same(theirs):
        return
    middle = np.append(header.middle[:2], 0.0)[None, :]
    try:
        moved = transform_points(middle, ours, theirs)
        away = float(np.abs(moved - middle)[0, :2].max()) * (_DEGREE if theirs.is_geographic else 1)
    except CrsError:
        away = np.inf
    if not away <= 1.0:
        raise CrsError(
            f"'{header.path}' names two CRSs that differ: {ours.label} in its WKT, and "
            f"{theirs.label}.",
            crs=other,
        )


def _advise(header: Header, error: TinsmithError) -> TinsmithError:
    """Return an error that tells the coordinates too, by which a surveyor knows their CRS."""
    if not isinstance(error, CrsError):
        return error
    middle = ", ".join(coordinate(one) for one in header.middle.tolist())
    advice = f"declare the CRS of its coordinates, which are about ({middle})"
    if _is_from_the_centre(header, error):
        advice = (
            f"its coordinates, about ({middle}), are from the centre of the Earth indeed: another "
            "program must project them first"
        )
    return CrsError(f"{str(error).removesuffix('.')}; {advice}.", crs=error.crs)


def _is_from_the_centre(header: Header, error: TinsmithError) -> bool:
    """Whether a geocentric CRS has coordinates that can only be geocentric."""
    low, high = _RADII
    is_on_earth = low < float(np.linalg.norm(header.middle)) < high
    return "Geocentric" in str(error) and is_on_earth and abs(header.middle[2]) > _HIGHEST


def _list_keys(header: Header) -> list[tuple[int, int, int, int]]:
    """Return number, place, count and value of each key; some programs leave empty ones."""
    content = header.find(_PROJECTION, _KEYS) or b""
    if len(content) < 8:
        return []
    count = min(struct.unpack_from("<4H", content)[3], len(content) // 8 - 1)
    rows = [struct.unpack_from("<4H", content, 8 * (row + 1)) for row in range(count)]
    return sorted(row for row in rows if row[0])


def _interpret_keys(header: Header, keys: dict[int, int]) -> HeaderReference:
    code = keys.get(_PROJECTED_KEY) or keys.get(_GEOGRAPHIC_KEY)
    vertical = keys.get(_VERTICAL_KEY, 0)
    if code == _USER_DEFINED or (code is None and vertical == _USER_DEFINED):
        crs, unit = CRS.of(_ask_gdal(header)), _UNITS.get(keys.get(_VERTICAL_UNIT_KEY, 0))
        if not _is_unnamed(crs):
            return HeaderReference(crs, unit)
        linear = _UNITS.get(keys.get(_LINEAR_UNIT_KEY, 0))
        return HeaderReference(unit=unit, notes=(_describe_unnamed(linear),))
    if code is None or code == 0:
        return HeaderReference(unit=_UNITS.get(keys.get(_VERTICAL_UNIT_KEY, 0)))
    horizontal = CRS.of(f"EPSG:{code}")
    _require_unit(horizontal, _UNITS.get(keys.get(_LINEAR_UNIT_KEY, 0)), header.path)
    return _add_vertical(horizontal, vertical, _UNITS.get(keys.get(_VERTICAL_UNIT_KEY, 0)))


def _is_unnamed(crs: CRS) -> bool:
    """Whether it says no more than that coordinates are in a plane: neither where, nor its name."""
    return crs.to_pyproj().is_engineering and crs.name.strip().lower() in _NO_NAMES


def _describe_unnamed(unit: Unit | None) -> str:
    known = "" if unit is None else f" but its unit, the {unit.name}"
    return (
        f"The CRS of the file is user-defined, and nothing describes it{known}: it is taken for "
        "not known."
    )


def _require_unit(crs: CRS, unit: Unit | None, path: Path) -> None:
    """Refuse a unit of eastings beside a CRS with another one."""
    if unit is not None and not crs.is_geographic and unit != crs.horizontal_unit:
        raise ReadError(
            f"'{path}' names {crs.label}, whose unit is the {crs.horizontal_unit.name}, and the "
            f"{unit.name} as the unit of its eastings: declare the CRS that is right.",
            path=path,
        )


def _add_vertical(horizontal: CRS, code: int, unit: Unit | None) -> HeaderReference:
    """Add the vertical part that a key names, where the unit that is named fits it."""
    code = code if unit is None else _IN_FEET.get((code, unit), code)
    if code in (0, _USER_DEFINED):
        return HeaderReference(horizontal, unit)
    try:
        crs = CRS.of(f"{horizontal}+{code}")
    except CrsError:
        note = f"The vertical CRS of the file, number {code}, is not known: it was left aside."
        return HeaderReference(horizontal, unit, (note,))
    if unit is None or crs.vertical_unit == unit:
        return HeaderReference(crs)
    note = (
        f"The elevations of the file are said to be in {unit}, and its vertical CRS, number "
        f"{code}, is in another unit: only the unit was taken."
    )
    return HeaderReference(horizontal, unit, (note,))


def _ask_gdal(header: Header) -> str:
    """Return the CRS that a GeoTIFF of the same keys would have, as WKT."""
    with scratch_folder() as folder:
        picture = Path(folder, "keys.tif")
        picture.write_bytes(_make_picture(header))
        found = _read_crs(picture, header.path)
    if found is None:
        raise CrsError(
            f"'{header.path}': the keys of its CRS describe none that GDAL understands: declare "
            "the CRS."
        )
    return found


def _read_crs(picture: Path, path: Path) -> str | None:
    from ...base import optional

    optional.require("rasterio", f"Reading the CRS of '{path}'")
    found = run_isolated("tinsmith.io.raster.gdal_child:read_header", {"path": str(picture)},
                         path=path)  # fmt: skip
    text: str | None = found.value["crs"]
    return text


def _make_picture(header: Header) -> bytes:
    """Return a TIFF of one cell with the keys of the file."""
    shorts = [(256, 1), (257, 1), (258, 8), (259, 1), (262, 1), (277, 1), (278, 1), (279, 1)]
    tags = [(tag, 3, 1, struct.pack("<HH", value, 0)) for tag, value in shorts]
    tags.append((273, 4, 1, struct.pack("<I", 8)))
    body = b"II*\0" + struct.pack("<I", 0) + b"\0" * 8
    for number, kind, width in ((_KEYS, 3, 2), (_DOUBLES, 12, 8), (_TEXTS, 2, 1)):
        content = _pack_keys(header) if number == _KEYS else header.find(_PROJECTION, number)
        if content:
            content = content[: len(content) // width * width]
            tags.append((number, kind, len(content) // width, struct.pack("<I", len(body))))
            body += content + b"\0" * (-len(content) % 8)
    tags.append((33550, 12, 3, struct.pack("<I", len(body))))
    body += struct.pack("<3d", 1, 1, 0)
    tags.append((33922, 12, 6, struct.pack("<I", len(body))))
    body += struct.pack("<6d", 0, 0, 0, 1, 1, 0)
    directory = struct.pack("<H", len(tags))
    directory += b"".join(struct.pack("<HHI", *one[:3]) + one[3] for one in sorted(tags))
    return body[:4] + struct.pack("<I", len(body)) + body[8:] + directory + b"\0" * 4


def _pack_keys(header: Header) -> bytes:
    rows = _list_keys(header)
    return b"".join(struct.pack("<4H", *row) for row in [(1, 1, 0, len(rows)), *rows])
