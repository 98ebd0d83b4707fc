"""Read the TINRelief of CityJSON, of the versions 1.0 to 2.0, and of CityJSONSeq.

A sequence has a CityJSON object on the first line, and a feature with vertices on each other.

References
----------
https://www.cityjson.org/cityjsonseq/
"""

from __future__ import annotations

import json
import re
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ....base.errors import ReadError
from ....base.sentences import FILE
from ..common import Mesh, join_places, mesh_reader, read_content, require_vertices
from .writing import DecimalGrid

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from ....base.arrays import Float64Array, Int64Array

_VERSIONS = ("1.0", "1.1", "2.0")
_WITHOUT_TRANSFORM = "1.0"
"""The version in which vertices may be coordinates as they are."""
_SURFACES = ("CompositeSurface", "MultiSurface")
_URL = re.compile(
    r"(?:https?://www\.opengis\.net/def/crs/|urn:ogc:def:crs:)([A-Za-z]+)[/:][^/:]*[/:]([^/:]+)"
)
_SHOWN_NAMES = 8
_LARGEST_EXACT = 2**53


class _Relief(NamedTuple):
    """Polygons of a terrain: the vertices of each, one after the other."""

    corners: Int64Array
    offsets: Int64Array
    attributes: dict[str, Any]


@mesh_reader
def read(path: Path, *, surface: str | None = None, join: bool = False) -> Mesh:
    """Read the terrain of a CityJSON file, or of a sequence of features (CityJSONSeq).

    The CRS defaults to that of the metadata; the unit of elevations is known where tinsmith wrote
    the file. Vertices at the same place become one. Polygons of more than three corners are cut
    into triangles, and of several levels of detail the finest is read, which the report tells.

    Parameters
    ----------
    surface : str, optional
        Name of the TINRelief; needed where the file has several and they are not joined.
    join : bool
        Whether all of them become one TIN.
    """
    city, ranges = _parse(path)
    objects = _choose_objects(city, surface, join)
    notes: list[str] = []
    reliefs = [_collect(name, one, notes, ranges.get(name)) for name, one in objects.items()]
    points = _restore_vertices(city)
    corners = np.concatenate([one.corners for one in reliefs])
    lengths = np.concatenate([np.diff(one.offsets) for one in reliefs])
    offsets = np.concatenate([[0], np.cumsum(lengths)])
    if len(lengths) == 0:
        raise ReadError(f"{FILE} holds a TINRelief without any triangle.")
    require_vertices(corners, offsets, len(points))
    used = np.unique(corners)
    places, number = join_places(points[used])
    place = np.zeros(len(points), np.int64)
    place[used] = number
    points, corners = places, place[corners]
    metadata = city.get("metadata")
    stated = str(metadata.get("referenceSystem", "")) if isinstance(metadata, dict) else ""
    found = _URL.search(stated)
    crs = f"{found[1]}:{found[2]}" if found else stated.strip() or None
    own = reliefs[0].attributes
    kept = {name: own[name] for name in ("crs", "elevationUnit") if isinstance(own.get(name), str)}
    found_crs, found_unit = crs or kept.get("crs"), kept.get("elevationUnit")
    return Mesh(points, corners, offsets, crs=found_crs, elevation_unit=found_unit, notes=notes)


def _describe_damage(what: str) -> ReadError:
    return ReadError(f"{FILE} is a damaged CityJSON file: {what}.")


def _parse(path: Path) -> City:
    try:
        found = parse_city(read_content(path))
    except SequenceError as error:
        raise _describe_damage(str(error)) from error
    city = found.document
    if not isinstance(city, dict) or city.get("type") != "CityJSON":
        raise ReadError(f"{FILE} is no CityJSON file: its type is not 'CityJSON'.")
    version = str(city.get("version", ""))[:20]
    if not version.startswith(_VERSIONS):
        raise ReadError(
            f"{FILE} is CityJSON of version '{version}': {', '.join(_VERSIONS)} are read."
        )
    return found


def _choose_objects(
    city: dict[str, Any], surface: str | None, join: bool
) -> dict[str, dict[str, Any]]:
    every = city.get("CityObjects")
    if not isinstance(every, dict):
        raise _describe_damage("it has no CityObjects")
    found = {
        str(name): one
        for name, one in every.items()
        if isinstance(one, dict) and one.get("type") == "TINRelief"
    }
    if not found:
        raise ReadError(f"{FILE} holds no TINRelief among its city objects.")
    names = ", ".join(f"'{name[:40]}'" for name in list(found)[:_SHOWN_NAMES])
    names += ", ..." if len(found) > _SHOWN_NAMES else ""
    if surface is not None:
        if surface not in found:
            raise ReadError(f"{FILE} holds no TINRelief '{surface}': there is {names}.")
        return {surface: found[surface]}
    if len(found) > 1 and not join:
        raise ReadError(
            f"{FILE} holds {len(found)} objects TINRelief ({names}): name one as surface, or "
            "join them."
        )
    return found


def _collect(
    name: str, relief: dict[str, Any], notes: list[str], vertices: tuple[int, int] | None
) -> _Relief:
    """Return the polygons of the finest geometry of a terrain, of the vertices of its feature."""
    geometries = relief.get("geometry")
    geometries = geometries if isinstance(geometries, list) else []
    fitting = [one for one in geometries if isinstance(one, dict) and one.get("type") in _SURFACES]
    attributes = relief.get("attributes")
    attributes = attributes if isinstance(attributes, dict) else {}
    if not fitting:
        raise _describe_damage(f"TINRelief '{name[:40]}' has no CompositeSurface")
    fitting.sort(key=lambda one: str(one.get("lod", "")))
    if len(fitting) > 1:
        notes.append(
            f"TINRelief '{name[:40]}' has {len(fitting)} levels of detail: "
            f"{str(fitting[-1].get('lod'))[:20]} was read."
        )
    boundaries: Any = fitting[-1].get("boundaries")
    try:
        rings = [ring for (ring,) in boundaries]
        lengths = np.array([len(ring) for ring in rings], np.int64)
        flat = [corner for ring in rings for corner in ring]
    except (TypeError, ValueError):
        raise _describe_damage(
            f"the surfaces of '{name[:40]}' are no lists of one ring each"
        ) from None
    if not all(type(corner) is int and 0 <= corner < _LARGEST_EXACT for corner in flat):
        raise _describe_damage(
            f"a surface of '{name[:40]}' names a vertex that is no number from 0 on"
        )
    corners, lengths = np.array(flat, np.int64), lengths
    if vertices is not None:
        first, end = vertices
        if (corners >= end - first).any():
            raise _describe_damage(
                f"a surface of '{name[:40]}' names a vertex that its feature does not have"
            )
        corners = corners + first
    return _Relief(corners, np.concatenate([[0], np.cumsum(lengths)]), attributes)


def _restore_vertices(city: dict[str, Any]) -> Float64Array:
    try:
        vertices = np.array(city["vertices"], np.float64).reshape(-1, 3)
    except (KeyError, TypeError, ValueError, OverflowError):
        raise _describe_damage("its vertices are no list of three numbers each") from None
    transform = city.get("transform")
    if transform is None:
        if not str(city["version"]).startswith(_WITHOUT_TRANSFORM):
            raise _describe_damage(f"version {city['version']} needs a transform, and it has none")
        return vertices
    try:
        scale = np.array(transform["scale"], np.float64).reshape(3)
        translate = np.array(transform["translate"], np.float64).reshape(3)
    except (KeyError, TypeError, ValueError, OverflowError):
        raise _describe_damage(
            "its transform has no scale and translate of three numbers"
        ) from None
    with np.errstate(over="ignore", invalid="ignore"):  # what is not finite is refused later
        return np.column_stack([_scale(vertices[:, k], scale[k], translate[k]) for k in range(3)])


def _scale(values: Float64Array, scale: float, translate: float) -> Float64Array:
    """Return coordinates; exact decimals where the scale is one step of decimals."""
    digits = int(np.clip(-np.rint(np.log10(scale)), 0, 15)) if 0 < scale <= 1 else -1
    whole = translate == np.floor(translate) and np.isfinite(translate)
    largest = np.abs(values).max(initial=0.0) + abs(translate) * 10.0 ** max(digits, 0)
    if digits < 0 or not whole or scale != float(f"1e-{digits}") or largest >= _LARGEST_EXACT:
        return values * scale + translate
    if not (values == np.floor(values)).all():
        return values * scale + translate
    return DecimalGrid(digits, int(translate)).restore(values.astype(np.int64))


class SequenceError(Exception):
    """What is wrong with the text of a file, for the end of a sentence."""


class City(NamedTuple):
    """A city: the object of a file, with the objects and vertices of its features."""

    document: dict[str, Any]
    ranges: dict[str, tuple[int, int]]
    """Of each object of a feature, the vertices of that feature: the first, and behind the last."""


def parse_city(content: bytes) -> City:
    """Return the city of CityJSON, or of a sequence."""
    try:
        return City(json.loads(content), {})
    except json.JSONDecodeError as error:
        lines = list(_split(content))
        if len(lines) < 2 or not _is_object(lines[0][1]):
            raise SequenceError(f"line {error.lineno} is no JSON") from error
        return _join_features(lines)
    except (ValueError, RecursionError) as error:  # no UTF-8, endless numbers, endless brackets
        raise SequenceError("its text is no JSON") from error


def _split(content: bytes) -> Iterator[tuple[int, bytes]]:
    """Yield the lines that are not empty, with their numbers from 1."""
    for number, line in enumerate(content.split(b"\n"), start=1):
        text = line.strip(b" \t\r\x1e")  # the last is the separator of RFC 8142
        if text:
            yield number, text


def _is_object(line: bytes) -> bool:
    try:
        return isinstance(json.loads(line), dict)
    except (ValueError, RecursionError):
        return False


def _join_features(lines: list[tuple[int, bytes]]) -> City:
    city = _parse_line(*lines[0])
    objects, vertices = dict(_require(city, "CityObjects", dict, 1)), []
    vertices += _require(city, "vertices", list, 1)
    ranges = dict.fromkeys(objects, (0, len(vertices)))
    for number, line in lines[1:]:
        feature = _parse_line(number, line)
        if feature.get("type") != "CityJSONFeature":
            raise SequenceError(f"line {number} is no CityJSONFeature")
        first = len(vertices)
        vertices += _require(feature, "vertices", list, number)
        for name, one in _require(feature, "CityObjects", dict, number).items():
            if name in objects:
                raise SequenceError(f"line {number} has the object '{name[:40]}', which is there")
            objects[name], ranges[name] = one, (first, len(vertices))
    return City({**city, "CityObjects": objects, "vertices": vertices}, ranges)


def _parse_line(number: int, line: bytes) -> dict[str, Any]:
    try:
        found = json.loads(line)
    except (ValueError, RecursionError) as error:
        raise SequenceError(f"line {number} is no JSON") from error
    if not isinstance(found, dict):
        raise SequenceError(f"line {number} is no JSON object")
    return found


def _require(found: dict[str, Any], name: str, kind: type, number: int) -> Any:
    value = found.get(name)
    if not isinstance(value, kind):
        raise SequenceError(f"line {number} has no {name}")
    return value
