"""GeoJSON of products: features with their columns as properties."""

from __future__ import annotations

import json
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ....base.atomic import replacing
from ....base.errors import WriteError
from ....base.results.columns import unit_text
from ....base.sentences import FILE
from ..surface_features import make_features
from .coordinates import format_positions, keep_in_crs, project_to_wgs84
from .values import json_texts, properties_template

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from ....base.arrays import Float64Array, Int64Array, ObjectArray
    from ....base.crs import CRS, Unit
    from ....base.policies import FeatureKind
    from ....base.progress import Tell
    from ....base.results import Features
    from ..surface_features import Writable
    from .coordinates import Places

__all__ = ["write_feature_lines", "write_features"]

_BATCH = 16_384
_HALF_TURN = 180.0


class _Located(NamedTuple):
    """Coordinates with what they are measured in, as :func:`project_to_wgs84` takes them."""

    points: Float64Array
    crs: CRS | None
    elevation_unit: Unit | None


def write_features(
    features: Features, path: Path, *, projected: bool = False, progress: Tell | None = None
) -> None:
    """Write features as GeoJSON; options and errors are those of :func:`.writing.write`.

    As a surface's GeoJSON: longitude and latitude with 9 decimals, elevations in metres with 6. A
    position whose elevation is not known has two numbers. Columns stay in their own units, which
    the member ``units`` names (``"unknown"`` if they are not known); exterior rings run
    counter-clockwise.
    """
    located = _locate(features)
    places = (keep_in_crs if projected else project_to_wgs84)(located)
    if places.crs_member is None:
        _require_one_side(places.xyz, features)
    with replacing(path, binary=False) as file:
        file.write(_format_head(features, places))
        separator = "\n"
        for done, written in _iterate_batches(features, places):
            file.write(separator + ",\n".join(written))
            separator = ",\n"
            if progress is not None:
                progress(done / len(features))
        file.write("\n]}\n")


def write_feature_lines(
    surface: Writable, path: Path, *, kind: FeatureKind | None = None, progress: Tell | None = None
) -> None:
    """Write a kind of parts of a surface, or features, as lines of GeoJSON, each a feature.

    The CRS must be known: coordinates are WGS 84 longitude and latitude, elevations metres, as
    those of a GeoJSON file.

    Parameters
    ----------
    kind : {"triangles", "points", "edges", "lines", "hull"}, optional
        Of a TIN; default triangles.
    """
    features = make_features(surface, kind)
    places = project_to_wgs84(_locate(features))
    _require_one_side(places.xyz, features)
    with replacing(path, binary=False) as file:
        for done, written in _iterate_batches(features, places):
            file.writelines(f"{line}\n" for line in written)
            if progress is not None:
                progress(done / len(features))


def _iterate_batches(features: Features, places: Places) -> Iterator[tuple[int, list[str]]]:
    """Yield the texts of some features after others, with the number done."""
    geometries = _format_geometries(features, places)
    template = properties_template(list(features.columns))
    for start in range(0, len(features), _BATCH):
        part = slice(start, min(start + _BATCH, len(features)))
        columns = [json_texts(column[part]) for column in features.columns.values()]
        rows = zip(*columns, strict=True) if columns else [()] * (part.stop - start)
        yield part.stop, list(map(_format_feature, map(template.__mod__, rows), geometries[part]))


def _locate(features: Features) -> _Located:
    """Return coordinates with elevations; 0 stands for those that are not known or not there."""
    points = np.zeros((len(features.coordinates), 3))
    points[:, : features.coordinates.shape[1]] = features.coordinates
    has_gaps = bool(np.isnan(points[:, 2]).any())
    if has_gaps:
        points[:, 2] = np.nan_to_num(points[:, 2])
    crs = features.crs
    if crs is not None and not features.has_elevations:
        crs = crs.horizontal
    return _Located(points, crs, features.elevation_unit)


def _format_head(features: Features, places: Places) -> str:
    lines = ['"type":"FeatureCollection"']
    if features.name:
        lines.append(f'"name":{json.dumps(features.name)}')
    if places.crs_member is not None:
        lines.append(f'"crs":{places.crs_member}')
    if features.has_elevations:
        lines += [f"{json.dumps(name)}:{json.dumps(text)}" for name, text in places.members]
    units = {name: unit_text(features.units, name) for name in features.units}
    if units:
        lines.append(f'"units":{json.dumps(units)}')
    if features.notes:
        lines.append(f'"notes":{json.dumps(list(features.notes))}')
    if len(places.xyz) and not (features.has_elevations and np.isnan(features.coordinates).any()):
        corners = places.xyz[:, : features.coordinates.shape[1]]
        box = [*corners.min(axis=0).tolist(), *corners.max(axis=0).tolist()]
        lines.append(f'"bbox":{json.dumps(box)}')
    return "{" + ",\n".join(lines) + ',\n"features":['


def _format_feature(properties: str, geometry: str) -> str:
    return f'{{"type":"Feature","properties":{properties},"geometry":{geometry}}}'


# ------------------------------------------------------------------------- geometries


def _format_positions(features: Features, places: Places) -> ObjectArray:
    """Return each position, with two numbers where its elevation is not known."""
    if not features.has_elevations:
        return format_positions(places.xyz[:, :2])
    written = format_positions(places.xyz)
    gaps = np.isnan(features.coordinates[:, 2])
    written[gaps] = format_positions(places.xyz[gaps, :2])
    return written


def _format_geometries(features: Features, places: Places) -> list[str]:
    """Return the geometry of each feature."""
    positions = _format_positions(features, places)
    if features.kind == "polygons" and places.crs_member is None:
        positions = positions[_turned(features, places.xyz)]
    pieces: list[str] = positions.tolist()
    for offsets in features.offsets:
        pieces = [f"[{','.join(pieces[a:b])}]" for a, b in pairwise(offsets.tolist())]
    kind = features.geometry_type
    return [f'{{"type":"{kind}","coordinates":{piece}}}' for piece in pieces]


def _turned(features: Features, xyz: Float64Array) -> Int64Array:
    """Return the order of points in which exterior rings run counter-clockwise, holes clockwise.

    A map may be mirrored (westings), or a ring turn by rounding.
    """
    offsets, polygons = features.offsets[:2]
    order = np.arange(len(xyz))
    if len(offsets) == 1:
        return order
    is_exterior = np.zeros(len(offsets) - 1, np.bool_)
    is_exterior[polygons[:-1]] = True
    areas = _measure_rings(xyz[:, :2], offsets)
    for ring in np.flatnonzero((areas != 0) & ((areas > 0) != is_exterior)):
        part = slice(offsets[ring], offsets[ring + 1])
        order[part] = order[part][::-1]
    return order


def _measure_rings(xy: Float64Array, offsets: Int64Array) -> Float64Array:
    """Return twice the signed area of each closed ring, positive counter-clockwise."""
    near = xy - np.repeat(xy[offsets[:-1]], np.diff(offsets), axis=0)
    steps = np.zeros(len(xy))
    steps[:-1] = near[:-1, 0] * near[1:, 1] - near[1:, 0] * near[:-1, 1]
    steps[offsets[1:] - 1] = 0.0  # from the end of one ring to the start of the next
    sums: Float64Array = np.add.reduceat(steps, offsets[:-1])
    return sums


def _require_one_side(xyz: Float64Array, features: Features) -> None:
    """Refuse a line or ring that jumps from one end of the longitudes to the other."""
    if not features.offsets or len(xyz) == 0:
        return
    jumps = np.abs(np.diff(xyz[:, 0])) > _HALF_TURN
    jumps[features.offsets[0][1:-1] - 1] = False
    if jumps.any():
        what = features.kind[:-1]
        number = int(np.searchsorted(features.offsets[0], jumps.argmax(), side="right")) - 1
        raise WriteError(
            f"Cannot write {FILE}: {what if what == 'line' else 'ring'} {number} crosses the "
            "antimeridian or holds a pole, which longitude and latitude cannot show in one piece; "
            "keep the coordinates of the CRS with `projected=True`."
        )
