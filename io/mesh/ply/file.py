"""PLY: meshes and point clouds, written so that QGIS reads them and nothing of a TIN is lost.

Written is binary little-endian with double coordinates, the face list ``vertex_indices``, and the
CRS in a header line ``comment crs: EPSG:32616`` (WKT where there is no code), with its unit for
programs that know no CRS: ``comment horizontal unit: metre``. A line ``comment elevation unit: US
survey foot`` keeps the unit of elevations where it is known. Constrained edges
and the lines that they are of are edges of the file (see ``lines.py``). Files of earlier versions,
which are read too, have the face properties ``constrained_0`` to ``constrained_2``, 1 where the
edge opposite that corner is constrained; they are written still where an edge is constrained on
one side only.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ....base.atomic import replacing
from ....base.errors import ReadError
from ....base.sentences import FILE, counted
from ....tin import TIN, Surface, Survey
from ...registry import warn_of_lost_attributes
from .. import common
from ..common import Mesh, flag_edges, mesh_reader
from .body import Ragged, read_tables
from .header import parse_header
from .lines import (
    ENDS,
    format_line_comments,
    read_lines,
    require_edges,
    take_edges,
)

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence
    from pathlib import Path

    from ....base.arrays import AnyArray, Float64Array, Int32Array
    from ....base.crs import CRS, Unit
    from ....base.progress import Tell
    from ....tin.constraints import Lines
    from .body import Table
    from .header import Header

_FLAGS = ("constrained_0", "constrained_1", "constrained_2")
_LIST = ("count", "corners")
"""Length and items of the list of a face's vertices, as they lie in a row."""

_COORDINATES = ("x", "y", "z")
_VERTEX = np.dtype([(name, "<f8") for name in _COORDINATES])
_FACE = np.dtype([(_LIST[0], "u1"), (_LIST[1], "<i4", (3,))])
_LARGEST_INTEGER = 2**53
_TYPE_NAMES = {
    "i1": "char",
    "u1": "uchar",
    "i2": "short",
    "u2": "ushort",
    "i4": "int",
    "u4": "uint",
}


@mesh_reader
def read(path: Path) -> Mesh:
    """Read a PLY file, text or binary of either byte order.

    CRS and unit default to those named in the header. Polygons and strips are cut into triangles,
    and further vertex properties become attributes; other properties and elements are skipped. A
    file without faces gives a survey.
    """
    content = common.read_content(path)
    header = parse_header(content)
    names = {"vertex", "face", *STRIPS, *(("edge",) if header.lines is not None else ())}
    tables = read_tables(content, header, names)
    vertices = tables.get("vertex")
    if vertices is None or not set(_COORDINATES) <= vertices.columns.keys():
        raise ReadError(f"{FILE} has no element 'vertex' with x, y and z.")
    columns = [vertices.columns[name] for name in _COORDINATES]
    with np.errstate(invalid="ignore"):
        points = np.stack(columns, axis=1).astype(np.float64)
    notes = common.describe_single_precision(points, vertices.columns["x"].dtype)
    mesh = Mesh(
        points,
        attributes={
            name: np.array(column, column.dtype.newbyteorder("="))
            for name, column in vertices.columns.items()
            if name not in _COORDINATES
        },
        crs=header.crs,
        elevation_unit=header.elevation_unit,
        notes=notes,
    )
    found = find_faces(tables)
    if found is None:
        return replace(mesh, notes=[*notes, *_describe_skipped(header)])
    faces = tables.get("face")
    own = {} if faces is None else faces.columns
    flagged = [own[name] for name in _FLAGS if name in own]
    flags = np.stack(flagged, axis=1) != 0 if len(flagged) == len(_FLAGS) else None
    mesh = replace(mesh, corners=found.items, offsets=found.offsets, constrained=flags)
    if header.lines is None or "edge" not in tables:
        return mesh
    edges = require_edges(tables["edge"], len(points))
    lines = read_lines(header.lines, edges)
    return replace(mesh, constrained_edges=edges, add_lines=lambda tin: _add_lines(tin, lines))


def _add_lines(tin: TIN, lines: Lines) -> TIN:
    segments = lines.segments()
    is_edge = tin.is_edge(segments[:, 0], segments[:, 1])
    if not is_edge.all():
        row = int(np.argmin(is_edge))
        raise ReadError(
            f"edge {row}, of a line, joins vertices {segments[row].tolist()}, which are "
            "no edge of a triangle."
        )
    return tin.replace(lines=lines)


def _describe_skipped(header: Header) -> list[str]:
    return [
        f"Not read: {counted(element.count, 'row')} of '{element.name[:40]}'."
        for element in header.elements
        if element.count and element.name != "vertex"
    ]


STRIPS = ("tristrips", "tristrip")
"""Elements whose rows are strips of triangles."""

_LISTS = ("vertex_indices", "vertex_index")
_RESTART = -1
"""What stands between two strips of one row."""


def find_faces(tables: Mapping[str, Table]) -> Ragged | None:
    """Return the vertices of the faces, whole numbers, those of strips behind the others.

    Returns
    -------
    Ragged
        None if there are no faces.
    """
    parts = []
    for name in ("face", *STRIPS):
        found = _find_list(tables.get(name), name)
        if found is not None:
            items = found.items
            if items.dtype.kind == "f" and not (np.abs(items) < 2.0**53).all():
                raise ReadError("a face names a vertex that is no number.")
            whole = items.astype(np.int64)
            if (whole != items).any():
                raise ReadError("a face names a vertex that is no whole number.")
            found = found._replace(items=whole)
            parts.append(found if name == "face" else _cut_strips(found))
    if not parts:
        return None
    lengths = np.concatenate([np.diff(one.offsets) for one in parts])
    offsets = np.concatenate([[0], np.cumsum(lengths)])
    return Ragged(np.concatenate([one.items for one in parts]), offsets)


def _find_list(table: Table | None, element: str) -> Ragged | None:
    if table is None:
        return None
    found = next((table.lists[name] for name in _LISTS if name in table.lists), None)
    if found is None and _has_rows(table):
        others = ", ".join(f"'{name[:40]}'" for name in (*table.lists, *table.columns))
        raise ReadError(
            f"the rows of '{element}' have the properties {others}, and their vertices "
            f"must be a list {' or '.join(_LISTS)}."
        )
    return None if found is None or len(found.offsets) == 1 else found


def _has_rows(table: Table) -> bool:
    lengths = [len(one.offsets) - 1 for one in table.lists.values()]
    return any([*lengths, *(len(one) for one in table.columns.values())])


def _cut_strips(strips: Ragged) -> Ragged:
    """Return the triangles of strips; those that only lead from one to the next have no area."""
    items = np.asarray(strips.items)
    row = np.repeat(np.arange(len(strips.offsets) - 1), np.diff(strips.offsets))
    part = row + np.cumsum(items == _RESTART)  # a number for each strip
    _, first, owner = np.unique(part, return_index=True, return_inverse=True)
    place = np.arange(len(items)) - (first + (items[first] == _RESTART))[owner]
    a, b, c = items[:-2], items[1:-1], items[2:]
    whole = (place[2:] >= 2) & (a != b) & (b != c) & (a != c)
    turned = place[2:] % 2 == 1
    triangles = np.stack([np.where(turned, b, a), np.where(turned, a, b), c], axis=1)[whole]
    return Ragged(triangles.ravel(), 3 * np.arange(len(triangles) + 1))


def write(surface: TIN | Survey, path: Path, *, progress: Tell | None = None) -> None:
    """Write a TIN, or the points of a survey, as binary PLY; :func:`read` gives it back.

    Of the attributes of points those that are numbers are written (whole numbers beyond 32 bits as
    double); PLY has no text.
    """
    surface = common.require_writable(surface)
    columns, lost = _select_number_columns(surface.attributes)
    if isinstance(surface, Survey):
        warn_of_lost_attributes(lost, "PLY has doubles, and names of one ASCII word")
    body = {"vertex": _pack_vertices(surface.points, columns)}
    comments: list[str] = []
    if isinstance(surface, Surface):
        edges = take_edges(surface)
        body["face"] = _pack_faces(surface, edges)
        if len(edges):
            comments = format_line_comments(surface)
            body["edge"] = np.ascontiguousarray(edges, "<i4").view([(name, "<i4") for name in ENDS])
    with replacing(path) as file:
        elements = {name: (rows.dtype, len(rows)) for name, rows in body.items()}
        file.write(_format_header(surface, comments, elements))
        for number, rows in enumerate(body.values(), start=1):
            file.write(rows.data)
            if progress is not None:
                progress(number / len(body))


class SurfaceBlocks(NamedTuple):
    """A surface that is larger than memory, without lines and attributes.

    Attributes
    ----------
    n_points, n_triangles : int
    points : iterable of (k, 3) float64 arrays
    triangles : iterable of (k, 3) int32 arrays
    crs : CRS or None
    elevation_unit : Unit or None
    """

    n_points: int
    n_triangles: int
    points: Iterable[Float64Array]
    triangles: Iterable[Int32Array]
    crs: CRS | None = None
    elevation_unit: Unit | None = None


def write_blocks(surface: SurfaceBlocks, path: Path) -> None:
    """Write the file that :func:`write` makes of the same surface in memory."""
    counts = {"vertex": (_VERTEX, surface.n_points), "face": (_FACE, surface.n_triangles)}
    with replacing(path) as file:
        file.write(_format_header(surface, [], counts))
        for points in surface.points:
            file.write(_pack_vertices(points, {}).data)
        for triangles in surface.triangles:
            file.write(_pack_triangles(triangles, ()).data)


def _format_header(
    surface: TIN | Survey | SurfaceBlocks,
    comments: Sequence[str],
    elements: Mapping[str, tuple[np.dtype[Any], int]],
) -> bytes:
    """Return the header of a file, up to the first row."""
    lines = ["ply", "format binary_little_endian 1.0"]
    if surface.crs is not None:
        lines.append(f"comment crs: {common.format_crs(surface.crs)}")
        along = surface.crs.horizontal_unit
        if along.metres is not None:
            lines.append(f"comment horizontal unit: {along.name}")
    unit = surface.elevation_unit
    if unit is not None and unit.text:
        lines.append(f"comment elevation unit: {unit.text}")
    lines += comments
    for name, (dtype, count) in elements.items():
        lines.append(f"element {name} {count}")
        if name == "face":
            lines.append("property list uchar int vertex_indices")
        lines += [
            f"property {_TYPE_NAMES.get(dtype[column].str[1:], 'double')} {column}"
            for column in dtype.names or ()
            if name != "face" or column not in _LIST
        ]
    return ("\n".join([*lines, "end_header"]) + "\n").encode()


def _pack_vertices(points: Float64Array, columns: dict[str, AnyArray]) -> AnyArray:
    fields = [*_VERTEX.descr]
    fields += [(name, column.dtype.newbyteorder("<").str) for name, column in columns.items()]
    rows = np.empty(len(points), fields)
    for name, column in zip(_COORDINATES, points.T, strict=True):
        rows[name] = column
    for name, column in columns.items():
        rows[name] = column
    return rows


def _select_number_columns(attributes: Any) -> tuple[dict[str, AnyArray], list[str]]:
    """Return the attributes that PLY can hold, under names of one word, and names of the others."""
    columns: dict[str, AnyArray] = {}
    lost = []
    for given, values in attributes.items():
        column = np.asarray(values)
        name = "_".join(str(given).split())
        is_free = name.isascii() and name not in (*_COORDINATES, *columns)
        fits = column.dtype.kind not in "iu" or bool(
            ((column >= -_LARGEST_INTEGER) & (column <= _LARGEST_INTEGER)).all()
        )
        if column.dtype.kind not in "biuf" or not is_free or not fits:
            lost.append(str(given))
            continue
        if column.dtype.kind == "b":
            column = column.astype(np.uint8)
        columns[name] = column if column.dtype.str[1:] in _TYPE_NAMES else column.astype(np.float64)
    return columns, lost


def _pack_faces(tin: TIN, edges: AnyArray) -> AnyArray:
    """Return the rows of the faces, with flags only where the edges do not tell them."""
    is_stated = (flag_edges(tin.triangles, edges, len(tin.points)) == tin.constrained).all()
    flags = () if is_stated else _FLAGS
    rows = _pack_triangles(tin.triangles, flags)
    for k, name in enumerate(flags):
        rows[name] = tin.constrained[:, k]
    return rows


def _pack_triangles(triangles: Int32Array, flags: Sequence[str]) -> AnyArray:
    """Return rows of faces, with columns for flags, which are not filled."""
    rows = np.empty(len(triangles), [*_FACE.descr, *((name, "u1") for name in flags)])
    rows[_LIST[0]] = 3
    rows[_LIST[1]] = triangles
    return rows
