"""GeoJSON (RFC 7946): triangles, points, edges, lines or hull of a surface, for any GIS."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import numpy as np

from ....base.errors import WriteError
from ....base.policies import FeatureKind
from ....base.results import Features
from ....base.sentences import FILE, counted
from ....tin import Survey
from ..surface_features import choose_kind, list_parts
from .antimeridian import HALF_TURN
from .features import (
    Located,
    Texts,
    cut_places,
    find_box,
    format_cut,
    format_positions,
    keep_in_crs,
    project_to_wgs84,
    turn_rings,
    write_collection,
    write_features,
)
from .values import json_texts

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    from ....base.arrays import AnyArray
    from ....base.progress import Tell
    from ....tin import TIN
    from ..surface_features import Parts
    from .antimeridian import Pieces
    from .features import Places

_LARGEST = 2**63
_FORMS = {
    "triangles": {"slope": "%.4f", "aspect": "%.4f", "area": "%.9g"},
    "hull": {"area": "%.12g"},
}
"""How numbers are written that are no longer exact."""


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
        If the file cannot be written, a coordinate is not finite, or a ring holds a pole.

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

    What crosses the antimeridian is cut there, as section 3.1.9 asks, into a MultiPolygon or
    MultiLineString, of which a LossWarning tells: at the place where the straight way in the CRS
    crosses it, with the elevation that is linear between its ends; the members ``bbox`` then have
    west > east. Reading joins the parts again, in a CRS whose map goes on there.

    The file is written in batches; beside the surface itself memory holds about 100 bytes for
    each vertex.
    """
    chosen = choose_kind(surface, kind)
    if isinstance(surface, Features):
        write_features(surface, path, projected=projected, progress=progress)
        return
    wrong = ~np.isfinite(surface.points).all(axis=1)
    if wrong.any():
        row, count = int(np.argmax(wrong)), int(wrong.sum())
        raise WriteError(
            f"Cannot write {FILE}: {counted(count, 'point')} "
            f"{'is' if count == 1 else 'are'} not finite (first: point "
            f"{row}, {surface.points[row].tolist()}), and JSON has only finite numbers."
        )
    parts = None
    if not isinstance(surface, Survey) and chosen != "points":
        parts = list_parts(surface, chosen)
    place = keep_in_crs if projected else project_to_wgs84
    places = place(surface.points, surface.crs, surface.elevation_unit)
    used, pieces = places.xyz, None
    spans = used[:, [0, 0]] if places.crs_member is None else None
    if parts is None or isinstance(surface, Survey):
        texts = _format_points(surface, places)
    else:
        vertices = parts.vertices
        used = used[np.unique(vertices if chosen == "lines" else surface.triangles)]
        if spans is not None and np.ptp(used[:, 0]) > HALF_TURN:
            located = Located(surface.points[vertices], surface.crs, surface.elevation_unit)
            pieces = cut_places(parts.kind, parts.offsets, located, places.xyz[vertices])
            spans = pieces.spans
        texts = _format_parts(chosen, parts, places, pieces)
    members = [] if places.crs_member is None else [("crs", places.crs_member)]
    members += [(name, json.dumps(text)) for name, text in places.members]
    if len(used):
        members.append(("bbox", json.dumps(find_box(used, spans))))
    write_collection(path, members, texts, progress)


def _format_parts(kind: str, parts: Parts, places: Places, pieces: Pieces | None) -> Texts:
    columns, forms = dict(parts.columns), dict(_FORMS.get(kind, {}))
    if pieces is None:
        vertices, levels, xyz = parts.vertices, parts.offsets, places.xyz
    else:
        vertices, levels, xyz = np.arange(len(pieces.xyz)), pieces.levels, pieces.xyz
    if kind == "triangles":
        # As written, a hair west of north must not become the full circle.
        columns["aspect"] = np.round(columns["aspect"], 4) % 360.0
    elif kind == "lines" and len(columns) == 1:
        unknown = np.full(len(columns["id"]), None, object)
        columns |= {"kind": unknown, "name": np.full(len(unknown), ""), "source": unknown}
    if kind == "hull" or (kind == "triangles" and pieces is not None):
        vertices = turn_rings(vertices, levels, xyz)
    elif kind == "triangles" and places.crs_member is None:  # else the order is the TIN's own
        triangles = vertices.reshape(-1, 4)[:, :3]
        a, b, c = (places.xyz[triangles[:, k], :2] for k in range(3))
        ab, ac = b - a, c - a
        clockwise = ab[:, 0] * ac[:, 1] < ab[:, 1] * ac[:, 0]
        triangles = np.where(clockwise[:, None], triangles[:, ::-1], triangles)
        vertices = triangles[:, [0, 1, 2, 0]].ravel()
    form = ",".join(f'"{name}":{forms.get(name, "%s")}' for name in columns)

    def format_properties(part: slice) -> Iterable[str]:
        values = [
            column[part].tolist() if name in forms or name == "id" else json_texts(column[part])
            for name, column in columns.items()
        ]
        texts = map(f"{{{form}}}".__mod__, zip(*values, strict=True))
        if any(np.isnan(columns[name][part]).any() for name in forms):  # JSON has no NaN
            return (text.replace(":nan", ":null") for text in texts)
        return texts

    geometry = {"lines": "LineString", "polygons": "Polygon"}[parts.kind]
    cut = {} if pieces is None else format_cut(pieces)
    return Texts(geometry, format_positions(xyz), vertices, levels, format_properties, cut)


def _format_points(surface: TIN | Survey, places: Places) -> Texts:
    attributes = surface.attributes
    names = [json.dumps(str(name)) for name in attributes if name != "id"]
    numbers = np.arange(len(places.xyz))
    columns: list[AnyArray] = [np.asarray(attributes.get("id", numbers))]
    columns += [np.asarray(column) for name, column in attributes.items() if name != "id"]
    form = ",".join(f"{name.replace('%', '%%')}:%s" for name in ['"id"', *names])

    def format_properties(part: slice) -> Iterable[str]:
        texts = (map(_format_json, column[part].tolist()) for column in columns)
        return map(f"{{{form}}}".__mod__, zip(*texts, strict=True))

    return Texts("Point", format_positions(places.xyz), numbers, (), format_properties)


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
