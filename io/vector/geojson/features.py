"""Features as text of GeoJSON: coordinates in WGS 84 or the CRS's own, columns as properties."""

from __future__ import annotations

import json
from itertools import pairwise
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ....base import optional
from ....base.atomic import replacing
from ....base.crs import CRS, METRE
from ....base.errors import CrsError
from ....base.notes import warn
from ....base.results import unit_text
from ....base.sentences import FILE, coordinate, counted, inflect
from ...reprojection import reproject
from ..surface_features import make_features
from .antimeridian import (
    DEGREE_DECIMALS,
    HALF_TURN,
    TURN,
    Pieces,
    cut_at_antimeridian,
    find_west_and_east,
)
from .values import json_texts, properties_template

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
    from pathlib import Path

    from ....base.arrays import AnyArray, Float64Array, Int64Array, ObjectArray
    from ....base.crs import CRS, Unit
    from ....base.policies import FeatureKind
    from ....base.progress import Tell
    from ....base.results import Features, Kind
    from ..surface_features import Writable

_BATCH = 16_384


class Located(NamedTuple):
    """Points in their CRS."""

    points: Float64Array
    """(n, 3)."""
    crs: CRS | None
    elevation_unit: Unit | None


class Texts(NamedTuple):
    """Features of which positions and properties are written."""

    geometry: str
    """Their type."""
    positions: ObjectArray
    """(n,), each as JSON."""
    vertices: AnyArray
    """(k,), positions of the points, lines or rings, one after the other."""
    offsets: Sequence[AnyArray]
    """As :class:`Features` has them."""
    format_properties: Callable[[slice], Iterable[str]]
    cut: Mapping[int, str] = MappingProxyType({})
    """Geometries, as JSON, of features that are none of this type as they were cut."""

    def iterate(self) -> Iterator[tuple[float, list[str]]]:
        """Yield the texts of some features after others, with the fraction done."""
        count = len(self.offsets[-1]) - 1 if self.offsets else len(self.vertices)
        for start in range(0, count, _BATCH):
            stop = min(start + _BATCH, count)
            first, last = start, stop
            levels: list[AnyArray] = []
            for offsets in reversed(self.offsets):
                levels.insert(0, offsets[first : last + 1] - offsets[first])
                first, last = int(offsets[first]), int(offsets[last])
            pieces: list[str] = self.positions[self.vertices[first:last]].tolist()
            form, width = "%s", 1
            for level in levels:
                lengths = np.diff(level)
                if lengths[0] and (lengths == lengths[0]).all():  # all of one form
                    form = f"[{','.join([form] * int(lengths[0]))}]"
                    width *= int(lengths[0])
                    continue
                if form != "%s":
                    pieces = list(map(form.__mod__, zip(*[iter(pieces)] * width, strict=True)))
                pieces = [f"[{','.join(pieces[a:b])}]" for a, b in pairwise(level.tolist())]
                form, width = "%s", 1
            form = (
                '{"type":"Feature","properties":%s,"geometry":{"type":"'
                f'{self.geometry}","coordinates":{form}}}}}'
            )
            properties = list(self.format_properties(slice(start, stop)))
            rows = zip(properties, *[iter(pieces)] * width, strict=True)
            texts = list(map(form.__mod__, rows))
            for row in self.cut.keys() & range(start, stop):
                members = f'"properties":{properties[row - start]},"geometry":{self.cut[row]}'
                texts[row - start] = f'{{"type":"Feature",{members}}}'
            yield stop / count, texts


ELEVATION_DECIMALS = 6  # a micrometre


class Places(NamedTuple):
    """Coordinates as they are written."""

    xyz: Float64Array
    """(n, 3)."""
    crs_member: str | None = None
    """JSON text of the old-style ``crs`` member; None where RFC 7946 forbids one."""
    members: tuple[tuple[str, str], ...] = ()
    """Further members of the file, which tell the unit of elevations."""


def project_to_wgs84(points: Float64Array, crs: CRS | None, elevation_unit: Unit | None) -> Places:
    """Move points, (n, 3), to WGS 84 longitude, latitude and elevation in metres, rounded.

    Notes
    -----
    The elevation's datum is changed only where the CRS has a vertical part, and then only as far
    as PROJ finds the geoid grid; otherwise the elevation keeps its datum and only its unit
    becomes the metre.
    """
    if crs is None:
        raise CrsError(
            "The CRS of these points is not known, and GeoJSON is in WGS 84: declare it, for "
            'example `crs="EPSG:32616"`, or keep the coordinates as they are with `projected=True`.'
        )
    has_datum = crs.vertical_unit is not None
    target = CRS.of("EPSG:4979" if has_datum else "OGC:CRS84")
    found = reproject(points, crs, target, unit=elevation_unit, wanted=METRE, needs_datum=False)
    moved = found.points
    moved[:, :2] = np.round(moved[:, :2], DEGREE_DECIMALS)
    beyond = np.abs(moved[:, 0]) > HALF_TURN  # by rounding, or counted from Greenwich eastwards
    moved[beyond, 0] -= np.copysign(TURN, moved[beyond, 0])
    moved[beyond, 0] = np.round(moved[beyond, 0], DEGREE_DECIMALS)
    outside = (np.abs(moved[:, :2]) > (180.0, 90.0)).any(axis=1)
    if outside.any():
        row = int(np.argmax(outside))
        x, y = points[row, :2]
        count = int(outside.sum())
        raise CrsError(
            f"{counted(count, 'point')} {'is no place' if count == 1 else 'are no places'} on "
            f"Earth in this CRS (first: point {row} at {coordinate(x)}, {coordinate(y)}): "
            "longitudes of -180 to "
            "180 and latitudes of -90 to 90 are allowed; check that the CRS is the right one.",
            crs=crs,
        )
    moved[:, 2] = np.round(moved[:, 2], ELEVATION_DECIMALS)
    members: tuple[tuple[str, str], ...] = ()
    usual = crs.usual_elevation_unit
    if elevation_unit is None and usual is not None and usual != METRE:
        text = f"metres; their unit was not known and taken to be the {usual.name}, that of the CRS"
        members = (("elevations", text),)
    if found.quality.keeps_datum:
        text = f"metres; their datum is that of {crs.name}, as PROJ has no grid to the ellipsoid"
        members = (("elevations", text),)
    return Places(moved + 0.0, members=members)


def keep_in_crs(points: Float64Array, crs: CRS | None, elevation_unit: Unit | None) -> Places:
    """Keep points as they are, and name their CRS by the rule of 2008 (``null``: unknown)."""
    members = () if elevation_unit is None else (("elevation_unit", elevation_unit.name),)
    if crs is None:
        return Places(points, "null", members)
    authority = crs.to_authority()
    name = f"urn:ogc:def:crs:{authority[0]}::{authority[1]}" if authority else str(crs)
    return Places(points, json.dumps({"type": "name", "properties": {"name": name}}), members)


def format_positions(xyz: Float64Array) -> ObjectArray:
    """Return each position as JSON text, in the fewest digits that give the same double back.

    Parameters
    ----------
    xyz : (n, 3) or (n, 2) float64 array
    """
    position = f"[{','.join(['%r'] * xyz.shape[1])}]"
    written = np.empty(len(xyz), object)
    for start in range(0, len(xyz), _BATCH):
        batch = xyz[start : start + _BATCH]
        written[start : start + _BATCH] = list(
            map(position.__mod__, zip(*batch.T.tolist(), strict=True))
        )
    return written


def cut_places(
    kind: Kind,
    levels: tuple[AnyArray, ...],
    located: Located,
    places: Float64Array,
) -> Pieces:
    """Cut lines and polygons at the antimeridian, and tell of it.

    Parameters
    ----------
    kind : {"points", "lines", "polygons"}
    levels : tuple of int arrays
        As :class:`Features` has them.
    located : Located
        Points of all features, one after the other; NaN for an unknown elevation.
    places : (n, 3) float64 array
        Their longitudes, latitudes and elevations.
    """
    points, crs, unit = located

    def between(here: Int64Array, there: Int64Array, share: Float64Array) -> Float64Array:
        ways = points[here] + share[:, None] * (points[there] - points[here])
        gaps = np.isnan(ways[:, 2])
        ways[gaps, 2] = 0.0
        found = project_to_wgs84(ways, crs, unit).xyz
        found[gaps, 2] = np.nan
        return found

    is_geographic = crs is not None and crs.is_geographic
    pieces = cut_at_antimeridian(kind, levels, places, between, is_geographic=is_geographic)
    count = len(pieces.cut)
    if count:
        what = inflect(f"{counted(count, 'feature')} [crosses|cross]", count)
        parts = inflect("[was|were] cut there into parts, as RFC 7946 asks", count)
        warn(f"{FILE}: {what} the antimeridian and {parts}.")
    return pieces


def format_cut(pieces: Pieces) -> dict[int, str]:
    """Return the geometries of features that were cut as JSON."""
    shapely = optional.load("shapely")

    def format_line(line: object) -> str:
        return f"[{','.join(_format_known(shapely.get_coordinates(line, include_z=True)))}]"

    def format_part(part: object) -> str:
        rings = shapely.get_rings(part).tolist()
        return f"[{','.join(map(format_line, rings))}]" if rings else format_line(part)

    return {
        row: f'{{"type":"Multi{parts[0].geom_type}","coordinates":['
        f"{','.join(map(format_part, parts.tolist()))}]}}"
        for row, parts in pieces.cut.items()
    }


def find_box(xyz: Float64Array, spans: Float64Array | None) -> list[float]:
    """Return the numbers of a ``bbox``: west > east if it crosses the antimeridian.

    Parameters
    ----------
    xyz : (n, 2) or (n, 3) float64 array
    spans : (k, 2) float64 array or None
        Of the longitudes of features; None in another CRS.
    """
    low, high = xyz.min(axis=0).tolist(), xyz.max(axis=0).tolist()
    if spans is not None:
        low[0], high[0] = find_west_and_east(spans)
    return [*low, *high]


def write_collection(
    path: Path, members: Iterable[tuple[str, str]], features: Texts, progress: Tell | None
) -> None:
    """Write features behind members, whose values are JSON."""
    with replacing(path, binary=False) as file:
        lines = ['"type":"FeatureCollection"', *(f"{json.dumps(k)}:{text}" for k, text in members)]
        file.write("{" + ",\n".join(lines) + ',\n"features":[')
        separator = "\n"
        for done, written in features.iterate():
            file.write(separator + ",\n".join(written))
            separator = ",\n"
            if progress is not None:
                progress(done)
        file.write("\n]}\n")


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
    places = (keep_in_crs if projected else project_to_wgs84)(*located)
    texts, pieces = _format_features(features, places, located)
    members: list[tuple[str, Any]] = list(places.members) if features.has_elevations else []
    if features.units:
        members.append(("units", {k: unit_text(features.units, k) for k in features.units}))
    if features.notes:
        members.append(("notes", list(features.notes)))
    if len(places.xyz) and not (features.has_elevations and np.isnan(features.coordinates).any()):
        corners = places.xyz[:, : features.coordinates.shape[1]]
        members.append(("bbox", find_box(corners, None if pieces is None else pieces.spans)))
    first = [("name", json.dumps(features.name))] if features.name else []
    if places.crs_member is not None:
        first.append(("crs", places.crs_member))
    rest = ((name, json.dumps(value)) for name, value in members)
    write_collection(path, [*first, *rest], texts, progress)


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
    located = _locate(features)
    texts, _ = _format_features(features, project_to_wgs84(*located), located)
    with replacing(path, binary=False) as file:
        for done, written in texts.iterate():
            file.writelines(f"{line}\n" for line in written)
            if progress is not None:
                progress(done)


def _locate(features: Features) -> Located:
    """Return coordinates with elevations; 0 stands for those that are not known or not there."""
    points = np.zeros((len(features.coordinates), 3))
    points[:, : features.coordinates.shape[1]] = features.coordinates
    points[:, 2] = np.nan_to_num(points[:, 2])
    crs = features.crs
    if crs is not None and not features.has_elevations:
        crs = crs.horizontal
    return Located(points, crs, features.elevation_unit)


def _format_features(
    features: Features, places: Places, located: Located
) -> tuple[Texts, Pieces | None]:
    """Return features as texts; a position of unknown elevation has two numbers."""
    xyz, levels, pieces = places.xyz.copy(), features.offsets, None
    is_unknown = np.isnan(features.coordinates[:, 2]) if features.has_elevations else slice(None)
    xyz[is_unknown, 2] = np.nan
    if places.crs_member is None:
        located.points[is_unknown, 2] = np.nan
        pieces = cut_places(features.kind, levels, located, xyz)
        xyz, levels = pieces.xyz, pieces.levels
    vertices = np.arange(len(xyz))
    if features.kind == "polygons" and pieces is not None:
        vertices = turn_rings(vertices, levels, xyz)
    template = properties_template(list(features.columns))

    def format_properties(part: slice) -> Iterable[str]:
        columns = [json_texts(column[part]) for column in features.columns.values()]
        rows = zip(*columns, strict=True) if columns else [()] * (part.stop - part.start)
        return map(template.__mod__, rows)

    cut = {} if pieces is None else format_cut(pieces)
    kind, positions = features.geometry_type, _format_known(xyz)
    return Texts(kind, positions, vertices, levels, format_properties, cut), pieces


def _format_known(xyz: Float64Array) -> ObjectArray:
    """Return each position as JSON text, without an elevation that is NaN."""
    gaps = np.isnan(xyz[:, 2])
    positions = format_positions(xyz[:, :2] if gaps.all() else xyz)
    if not gaps.all():
        positions[gaps] = format_positions(xyz[gaps, :2])
    return positions


def turn_rings(vertices: AnyArray, levels: Sequence[AnyArray], xyz: Float64Array) -> Int64Array:
    """Return the vertices of closed rings, exterior ones counter-clockwise and holes clockwise.

    A map may be mirrored (westings), or a ring turn by rounding.

    Parameters
    ----------
    vertices : (k,) int array
        Rows of ``xyz``, one ring after the other.
    levels : sequence of int arrays
        Where rings and polygons begin.
    xyz : (n, 3) float64 array
    """
    offsets, polygons = levels[:2]
    turned = np.array(vertices, np.int64)
    if len(offsets) == 1:
        return turned
    is_exterior = np.zeros(len(offsets) - 1, np.bool_)
    is_exterior[polygons[:-1]] = True
    xy = xyz[vertices, :2]
    near = xy - np.repeat(xy[offsets[:-1]], np.diff(offsets), axis=0)
    steps = np.zeros(len(xy))
    steps[:-1] = near[:-1, 0] * near[1:, 1] - near[1:, 0] * near[:-1, 1]
    steps[offsets[1:] - 1] = 0.0  # from the end of one ring to the start of the next
    areas = np.add.reduceat(steps, offsets[:-1])
    for ring in np.flatnonzero((areas != 0) & ((areas > 0) != is_exterior)):
        part = slice(offsets[ring], offsets[ring + 1])
        turned[part] = turned[part][::-1]
    return turned
