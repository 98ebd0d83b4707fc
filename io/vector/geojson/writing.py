"""GeoJSON (RFC 7946): triangles, points, edges, lines or hull of a surface, for any GIS."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ....base.atomic import replacing
from ....base.errors import WriteError
from ....base.policies import FeatureKind
from ....base.results import Features
from ....base.sentences import FILE, counted
from ....terrain.relief.gradients import aspect, measure_areas, measure_ring_area, slope
from ....tin import Survey
from ..surface_features import choose_kind
from .coordinates import Places, format_positions, keep_in_crs, project_to_wgs84, require_one_piece
from .features import write_features
from .lines import (
    format_edge_properties,
    format_lines,
    gather_edge_flags,
    group_rings,
    list_line_vertices,
    measure_signed_area,
    require_lines,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

    from ....base.arrays import BoolArray, Float64Array, Int32Array
    from ....base.progress import Tell
    from ....tin import TIN

__all__ = ["write"]

_BATCH = 16_384
_LARGEST = 2**63
_FEATURE = '{"type":"Feature","properties":%s,"geometry":{"type":"%s","coordinates":%s}}'
_TRIANGLE = _FEATURE % (
    '{"id":%d,"slope":%.4f,"aspect":%.4f,"area":%.9g}',
    "Polygon",
    "[[%s,%s,%s,%s]]",
)
_EDGE = _FEATURE % ('{"id":%d,%s}', "LineString", "[%s,%s]")
_POINT = _FEATURE % ("%s", "Point", "%s")
_HULL = _FEATURE % ('{"id":%d,"area":%.12g}', "Polygon", "[%s]")


def write(
    surface: TIN | Survey | Features,
    path: Path,
    *,
    kind: FeatureKind | None = None,
    projected: bool = False,
    progress: Tell | None = None,
) -> None:
    """Write a surface, the points of a survey, or features as GeoJSON.

    The CRS must be known, unless ``projected``.

    Parameters
    ----------
    kind : {"triangles", "points", "edges", "lines", "hull"}, optional
        One Polygon a triangle with the properties ``id``, ``slope`` and ``aspect`` (degrees; null
        where there is none) and ``area`` (in the plane, square metres); one Point a vertex, or a
        point of the survey with its attributes; one LineString an edge with ``constrained`` and
        ``kind`` (that of its line: hard, soft, boundary, hole, water; null if none is known); one
        LineString a line with ``kind``, ``name`` and ``source`` (its number in the input); or the
        outline, holes included, with its ``area``. Default triangles, of a survey points.
    projected : bool
        Leave the coordinates in the CRS, every digit kept, and name it in the ``crs`` member of
        the 2008 specification: not RFC 7946, but GDAL and QGIS understand it. Default WGS 84
        longitude and latitude with 9 decimals, elevation in metres with 6.

    Raises
    ------
    CrsError
        If the CRS is not known, or puts points outside the Earth.
    OptionError
        If there is no such kind.
    FormatError
        If features are asked for a kind, a survey for triangles, or a TIN without lines for lines.
    WriteError
        If the file cannot be written, a coordinate is not finite, or the surface crosses the
        antimeridian.

    Notes
    -----
    RFC 7946 means metres above the ellipsoid by the third number. The vertical datum is changed
    only where the CRS is a compound or 3D one (and PROJ has the geoid grid at hand); all other
    elevations keep their datum, and become metres. If their unit is not known they are taken to be
    in that of the eastings (metres above degrees), and the member ``elevations`` says so where that
    is not the metre. With ``projected`` elevations stay as they are, and the member
    ``elevation_unit`` names their unit if it is known. Slope is that of the true surface, as
    :func:`tinsmith.slope` gives it. Areas are in CRS units squared where the CRS is not
    known.

    The file is written in batches; beside the surface itself memory holds about 100 bytes for
    each vertex.
    """
    chosen = choose_kind(surface, kind)
    if isinstance(surface, Features):
        write_features(surface, path, projected=projected, progress=progress)
        return
    if chosen == "lines" and not isinstance(surface, Survey):
        require_lines(surface)
    _require_finite_points(surface.points)
    place = keep_in_crs if projected else project_to_wgs84
    places = place(surface)
    if isinstance(surface, Survey) or chosen == "points":
        used, total = places.xyz, len(surface.points)
        features = _format_points(surface, places)
    else:
        corners = places.xyz[surface.triangles, 0]
        if places.crs_member is None:
            require_one_piece(corners)
        used = places.xyz[_find_used_vertices(surface, chosen)]
        total = len(surface.triangles)
        features = _SURFACE_FEATURES[chosen](surface, places)
    with replacing(path, binary=False) as file:
        file.write(_format_head(places, used))
        separator = "\n"
        for done, batch in features:
            file.write(separator + batch)
            separator = ",\n"
            if progress is not None:
                progress(min(1.0, done / max(total, 1)))
        file.write("\n]}\n")


def _require_finite_points(points: Float64Array) -> None:
    wrong = ~np.isfinite(points).all(axis=1)
    if wrong.any():
        row, count = int(np.argmax(wrong)), int(wrong.sum())
        raise WriteError(
            f"Cannot write {FILE}: {counted(count, 'point')} "
            f"{'is' if count == 1 else 'are'} not finite (first: point "
            f"{row}, {points[row].tolist()}), and JSON has only finite numbers."
        )


def _format_head(places: Places, used: Float64Array) -> str:
    lines = ['"type":"FeatureCollection"']
    if places.crs_member is not None:
        lines.append(f'"crs":{places.crs_member}')
    lines += [f"{json.dumps(name)}:{json.dumps(text)}" for name, text in places.members]
    if len(used):
        bbox = [*used.min(axis=0).tolist(), *used.max(axis=0).tolist()]
        lines.append(f'"bbox":{json.dumps(bbox)}')
    return "{" + ",\n".join(lines) + ',\n"features":['


def _find_used_vertices(tin: TIN, kind: str) -> BoolArray:
    used = np.zeros(len(tin.points), np.bool_)
    used[np.concatenate(list_line_vertices(tin)) if kind == "lines" else tin.triangles] = True
    return used


def _iterate_slices(count: int) -> Iterator[tuple[int, slice]]:
    """Cut a count into slices, each with the number done after it."""
    for start in range(0, count, _BATCH):
        stop = min(start + _BATCH, count)
        yield stop, slice(start, stop)


# -------------------------------------------------------------------------- triangles


class _Measures(NamedTuple):
    """Slope and aspect (degrees, NaN for none) and area (square metres) of each triangle."""

    slope: Float64Array
    aspect: Float64Array
    area: Float64Array


def _measure_triangles(tin: TIN) -> _Measures:
    # As written, a hair west of north must not become the full circle.
    falls = np.round(aspect(tin), 4) % 360.0
    return _Measures(slope(tin), falls, measure_areas(tin))


def _format_triangles(tin: TIN, places: Places) -> Iterator[tuple[int, str]]:
    positions = format_positions(places.xyz)
    measures = _measure_triangles(tin)
    for done, part in _iterate_slices(len(tin.triangles)):
        triangles = tin.triangles[part]
        if places.crs_member is None:  # else the coordinates, and so the order, are the TIN's own
            triangles = _turn_counter_clockwise(triangles, places.xyz)
        first, second, third = triangles.T
        start = positions[first].tolist()
        rows = zip(
            range(part.start, part.stop),
            measures.slope[part].tolist(),
            measures.aspect[part].tolist(),
            measures.area[part].tolist(),
            start,
            positions[second].tolist(),
            positions[third].tolist(),
            start,
            strict=True,
        )
        # JSON has no NaN; no other text of these features holds the letters ":nan".
        yield done, ",\n".join(map(_TRIANGLE.__mod__, rows)).replace(":nan", ":null")


def _turn_counter_clockwise(triangles: Int32Array, xyz: Float64Array) -> Int32Array:
    """Turn the triangles that the written coordinates show clockwise."""
    a, b, c = (xyz[triangles[:, k], :2] for k in range(3))
    ab, ac = b - a, c - a
    clockwise = ab[:, 0] * ac[:, 1] < ab[:, 1] * ac[:, 0]
    return np.where(clockwise[:, None], triangles[:, ::-1], triangles)


# ------------------------------------------------------------------------------ edges


def _format_edges(tin: TIN, places: Places) -> Iterator[tuple[int, str]]:
    positions = format_positions(places.xyz)
    words = format_edge_properties(tin, gather_edge_flags(tin))
    across = np.arange(len(tin.triangles), dtype=np.int32)[:, None]
    once = (tin.neighbors < 0) | (tin.neighbors > across)
    written = 0
    for done, part in _iterate_slices(len(tin.triangles)):
        here = once[part]
        starts = positions[tin.triangles[part][:, [1, 2, 0]][here]]
        ends = positions[tin.triangles[part][:, [2, 0, 1]][here]]
        ids = range(written, written + len(starts))
        rows = zip(ids, words[part][here], starts, ends, strict=True)
        if len(starts):
            yield done, ",\n".join(map(_EDGE.__mod__, rows))
        written += len(starts)


def _format_lines(tin: TIN, places: Places) -> Iterator[tuple[int, str]]:
    yield len(tin.triangles), ",\n".join(format_lines(tin, format_positions(places.xyz)))


# ------------------------------------------------------------------------------- hull


def _format_hull(tin: TIN, places: Places) -> Iterator[tuple[int, str]]:
    positions = format_positions(places.xyz)
    features = []
    for number, rings in enumerate(group_rings(tin)):
        area = sum(measure_ring_area(tin.crs, tin.points[ring]) for ring in rings)
        turned = [_close_ring(ring, places.xyz, k == 0) for k, ring in enumerate(rings)]
        written = ",".join(f"[{','.join(positions[ring])}]" for ring in turned)
        features.append(_HULL % (number, area, written))
    yield len(tin.triangles), ",\n".join(features)


def _close_ring(ring: Int32Array, xyz: Float64Array, counter_clockwise: bool) -> Int32Array:
    closed = np.append(ring, ring[0])
    return closed if (measure_signed_area(xyz[ring]) > 0) == counter_clockwise else closed[::-1]


# ----------------------------------------------------------------------------- points


def _format_points(surface: TIN | Survey, places: Places) -> Iterator[tuple[int, str]]:
    attributes = surface.attributes
    names = [json.dumps(str(name)) for name in attributes if name != "id"]
    columns = [np.asarray(column) for name, column in attributes.items() if name != "id"]
    ids = np.asarray(attributes.get("id", np.arange(len(places.xyz))))
    properties = "{" + ",".join(f"{name.replace('%', '%%')}:%s" for name in ['"id"', *names]) + "}"
    for done, part in _iterate_slices(len(places.xyz)):
        values = zip(
            *(map(_format_json, column[part].tolist()) for column in (ids, *columns)), strict=True
        )
        rows = zip(map(properties.__mod__, values), format_positions(places.xyz[part]), strict=True)
        yield done, ",\n".join(map(_POINT.__mod__, rows))


def _format_json(value: Any) -> str:
    """Return a value of an attribute as JSON; what JSON has no word for becomes text or null."""
    if value is None or value != value:  # NaN and NaT
        return "null"
    if isinstance(value, float) and not np.isfinite(value):
        return "null"
    is_plain = isinstance(value, bool | int | float | str)
    if isinstance(value, int) and not -_LARGEST <= value < _LARGEST:
        is_plain = False  # no reader of JSON is bound to take more than 64 bits
    return json.dumps(value if is_plain else str(value))


_SURFACE_FEATURES: dict[str, Callable[[TIN, Places], Iterator[tuple[int, str]]]] = {
    "triangles": _format_triangles,
    "edges": _format_edges,
    "lines": _format_lines,
    "hull": _format_hull,
}
