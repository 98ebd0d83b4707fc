"""Points of vector layers as a survey, lines too if told how, triangles as a TIN.

Elevations are those of the geometry or of a column, never a guess between two that differ.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...base import optional
from ...base.crs import CRS, Unit
from ...base.errors import OptionError, ReadError, choice
from ...base.policies import LineReading
from ...base.sentences import FILE, counted
from ...tin import TIN, Breakline, Survey
from ...tin.screening import describe_elevations, parse_nodata
from ...tin.topology import find_offsets
from ..mesh import FileReference, join_places, make_tin
from ..registry import taking
from ..reprojection import place, settle_unit
from .elevations import find_elevation_unit, find_elevations
from .features import read_features
from .geojson import join_at_antimeridian
from .layers import Layer, list_lines, take_apart

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from ...base.arrays import AnyArray, BoolArray, Float64Array, Int64Array
    from ...base.crs import CrsLike, UnitLike
    from ...base.policies import FacePolicy

POINT, _LINE, _RING, _POLYGON = range(4)
_TRIANGLE_CORNERS = 4


@dataclass(frozen=True, slots=True)
class Asked:
    """The options of :func:`read`."""

    crs: CrsLike | None = None
    elevation_unit: UnitLike | None = None
    layer: str | None = None
    z_field: str | None = None
    where: str | None = None
    lines_as: LineReading | None = None
    nodata: float | Sequence[float] | None = None
    faces: FacePolicy = "most"

    @property
    def target(self) -> CRS | None:
        """The CRS that is wanted."""
        return CRS.of(self.crs)

    @property
    def declared(self) -> Unit | None:
        """The unit of elevations that the caller tells."""
        return Unit.of(self.elevation_unit)

    @property
    def marks(self) -> Float64Array:
        """Elevations that stand for none."""
        return parse_nodata(self.nodata)

    def describe_marks(self) -> ReadError:
        """Return the error of a layer of no elevation but these."""
        return ReadError(f"{FILE} has no elevation but nodata ({self.marks.tolist()}).")


@taking(Asked)
def read(path: Path, asked: Asked) -> Survey | TIN:
    """Read the points of a vector layer, or the triangles that another program wrote as polygons.

    Points are reprojected to ``crs``.

    Parameters
    ----------
    layer : str, optional
        Needed if several layers have geometry.
    z_field : str, optional
        Column that holds the elevations; "geometry" for the third coordinate. Needed if both are
        there and differ, or several columns could be meant.
    where : str, optional
        Condition on the columns, as in SQL.
    lines_as : {"points", "breaklines"}, optional
        Take the vertices of lines, and of polygons that are no triangles, as points, or the lines
        as breaklines too. Needed for a layer of them.

    Returns
    -------
    Survey or TIN
        A survey of points has the columns as attributes; points of one feature have its values
        each. ``skipped`` counts features without an elevation. A layer whose polygons are all
        triangles with elevations is a TIN: corners at one place are one vertex, triangles are
        those of the file.

    Raises
    ------
    ReadError
        If the file cannot be read, has several layers, kinds of geometry, or plausible elevations,
        or none.
    OptionError
        If there is no such column, or ``lines_as`` is none of its words.
    CrsError
        If the points cannot be brought into the CRS.
    MissingExtraError
        If pyogrio is not installed.
    """
    return read_layer(path, asked)


def read_layer(path: Path, asked: Asked) -> Survey | TIN:
    """Read a layer as :func:`read` does."""
    role = None if asked.lines_as is None else choice("lines_as", asked.lines_as, LineReading)
    features = read_features(path, layer=asked.layer, where=asked.where)
    features = join_at_antimeridian(features, asked.target)
    kinds = list_kinds(features)
    if kinds == {POINT}:
        return _make_survey(gather_points(features), features, asked)
    if role is None and kinds == {_POLYGON} and _are_triangles(features):
        return _make_triangles(features, asked)
    if POINT in kinds:
        raise ReadError(
            f"{FILE} holds both points and lines or polygons: one kind is needed; the option "
            "where chooses some features."
        )
    if role is None:
        what = "lines" if kinds == {_LINE} else "polygons"
        raise ReadError(
            f"{FILE} holds {what}, no points: the option `lines_as` takes their vertices as "
            "points, or them as breaklines."
        )
    return _make_line_survey(_gather_lines(features), features, asked, role)


class _Vertices(NamedTuple):
    """Vertices, the feature of each, and where single lines or rings begin and end."""

    xyz: Float64Array
    rows: Int64Array
    bounds: Int64Array
    has_z: BoolArray


# ----------------------------------------------------------------------- the geometry


def list_kinds(features: Layer) -> set[int]:
    """Return the kinds of single geometries, with collections taken apart."""
    shapely = optional.load("shapely")
    shapes, _ = take_apart(features)
    found = np.unique(shapely.get_type_id(shapes[~shapely.is_empty(shapes)])).tolist()
    return {_LINE if kind == _RING else int(kind) for kind in found}


def gather_points(features: Layer) -> _Vertices:
    """Return the points of features."""
    shapely = optional.load("shapely")
    xyz, rows = shapely.get_coordinates(features.geometries, include_z=True, return_index=True)
    has_z = shapely.has_z(features.geometries)[rows]
    return _Vertices(xyz, rows, np.arange(len(xyz) + 1), has_z)


def _gather_lines(features: Layer) -> _Vertices:
    """Return the vertices of lines and rings; the last of a closed one is left out of no line."""
    shapely = optional.load("shapely")
    lines, of_lines, _ = list_lines(features)
    xyz, line = shapely.get_coordinates(lines, include_z=True, return_index=True)
    bounds = find_offsets(shapely.get_num_coordinates(lines))
    return _Vertices(xyz, of_lines[line], bounds, shapely.has_z(lines)[line])


# ------------------------------------------------------------------------ the survey


class Taken(NamedTuple):
    """Points of features that have an elevation, as they are in the file."""

    points: Float64Array
    unit: Unit | None
    """Of their elevations."""
    rows: Int64Array
    """Of their features."""
    notes: tuple[str, ...]
    skipped: dict[str, int]


def take_points(vertices: _Vertices, features: Layer, asked: Asked) -> Taken:
    """Find the elevations of vertices; leave out those that have none."""
    wrong = ~np.isfinite(vertices.xyz[:, :2]).all(axis=1)
    if wrong.any():
        row = int(np.argmax(wrong))
        raise ReadError(
            f"{features.label(int(vertices.rows[row]))} has a coordinate that is not finite, "
            f"{vertices.xyz[row, :2].tolist()}: every coordinate must be a finite number."
        )
    found = find_elevations(
        features, vertices.xyz[:, 2], vertices.has_z, vertices.rows, asked.z_field
    )
    is_nodata = np.isin(found.z, asked.marks)
    keep = np.isfinite(found.z) & ~is_nodata
    skipped = {
        "features without an elevation": len(np.unique(vertices.rows[np.isnan(found.z)])),
        "nodata points": int(is_nodata.sum()),
    }
    unit = find_elevation_unit(features, asked.declared)
    return Taken(
        np.column_stack([vertices.xyz[keep, :2], found.z[keep]]),
        settle_unit(asked.declared, found.unit) if found.unit else unit,
        vertices.rows[keep],
        found.notes,
        {what: count for what, count in skipped.items() if count},
    )


def _make_survey(vertices: _Vertices, features: Layer, asked: Asked) -> Survey:
    taken = take_points(vertices, features, asked)
    if not len(taken.points):
        raise asked.describe_marks()
    placed = place(taken.points, source=features.crs, target=asked.target, unit=taken.unit)
    told = describe_elevations(taken.points[:, 2])
    return Survey(
        points=placed.points,
        attributes=collect_attributes(features, taken.rows),
        crs=placed.crs,
        elevation_unit=placed.elevation_unit,
        source=features.path.name,
        skipped=taken.skipped,
        notes=[*features.notes, *taken.notes, *told, *placed.notes],
    )


def collect_attributes(features: Layer, rows: Int64Array) -> dict[str, AnyArray]:
    """Return the columns under the names of the file."""
    names = features.names or tuple(features.columns)
    columns = zip(names, features.columns.values(), strict=True)
    return {name: column[rows] for name, column in columns}


def _make_line_survey(
    vertices: _Vertices, features: Layer, asked: Asked, role: LineReading
) -> Survey:
    """Return the vertices as points, those that close a ring once, and the lines if asked for."""
    is_open = ~_find_closing(vertices)
    if role == "points":
        xyz, rows, _, has_z = vertices
        return _make_survey(
            _Vertices(xyz[is_open], rows[is_open], vertices.bounds, has_z[is_open]), features, asked
        )
    survey = _make_survey(vertices, features, asked)
    if survey.skipped:
        raise ReadError(
            f"{counted(sum(survey.skipped.values()), 'feature')} without an "
            "elevation cannot be breaklines: the option `where` leaves them out."
        )
    breaklines = _make_breaklines(survey.points, vertices, features)
    attributes = {name: values[is_open] for name, values in survey.attributes.items()}
    points = survey.points[is_open]
    return replace(survey, points=points, attributes=attributes, breaklines=breaklines)


def _find_closing(vertices: _Vertices) -> BoolArray:
    """Return which vertices stand for the first of their line again."""
    starts, ends = vertices.bounds[:-1], vertices.bounds[1:] - 1
    closed = (vertices.xyz[starts, :2] == vertices.xyz[ends, :2]).all(axis=1) & (ends > starts)
    found = np.zeros(len(vertices.xyz), np.bool_)
    found[ends[closed]] = True
    return found


def _make_breaklines(points: Float64Array, vertices: _Vertices, features: Layer) -> list[Breakline]:
    rows = vertices.rows[vertices.bounds[:-1]]
    names = features.columns.get("name", np.full(len(features.numbers), None, object))[rows]
    lines = np.split(points, vertices.bounds[1:-1])
    return [
        Breakline(line, name="" if name is None or name != name else str(name))
        for line, name in zip(lines, names.tolist(), strict=True)
        if len(line) > 1
    ]


# -------------------------------------------------------------------------- triangles


def _are_triangles(features: Layer) -> bool:
    """Whether every polygon has three corners with elevations, and no island."""
    shapely = optional.load("shapely")
    shapes, _ = take_apart(features)
    return bool(
        shapely.has_z(shapes).all()
        and (shapely.get_num_coordinates(shapes) == _TRIANGLE_CORNERS).all()
        and (shapely.get_num_interior_rings(shapes) == 0).all()
    )


def _make_triangles(features: Layer, asked: Asked) -> TIN:
    """Return the TIN of triangles; corners at one place, to the last bit, are one vertex."""
    shapely = optional.load("shapely")
    if asked.z_field not in (None, "geometry"):
        raise OptionError("z_field", asked.z_field, "geometry, where polygons are triangles")
    if len(asked.marks):
        raise OptionError("nodata", asked.marks.tolist(), "none, where polygons are triangles")
    xyz = shapely.get_coordinates(features.geometries, include_z=True)
    corners = np.delete(xyz.reshape(-1, _TRIANGLE_CORNERS, 3), 3, axis=1).reshape(-1, 3)
    if not np.isfinite(corners).all():
        raise ReadError("a corner of a triangle is not finite.")
    points, numbers = join_places(corners)
    triangles = numbers.reshape(-1, 3)
    unit = find_elevation_unit(features, asked.declared)
    placed = place(points, source=features.crs, target=asked.target, unit=unit)
    tin = make_tin(
        placed.points,
        triangles,
        reference=FileReference(placed.crs, placed.elevation_unit),
        faces=asked.faces,
        looks_at_crs=False,
    )
    notes = [*features.notes, *placed.notes]
    if placed.points is not points:
        notes.append(f"Vertices were reprojected to {placed.crs}; the triangles are the file's.")
    return tin.replace(report=replace(tin.report, notes=[*tin.report.notes, *notes]))
