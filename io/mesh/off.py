"""Object File Format (OFF): vertices and faces as text, every digit kept, elevation up.

Comments keep the CRS, ``# crs: EPSG:32616``, and the unit of elevations where it is known,
``# elevation unit: US survey foot``. Which edges are constrained is lost.
"""

from __future__ import annotations

import re
from dataclasses import replace
from itertools import chain
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...base.atomic import replacing
from ...base.errors import ReadError
from ...base.sentences import FILE, counted
from . import common
from .common import Mesh, mesh_reader
from .text_rows import (
    TextRows,
    find_reference,
    format_rows,
    parse_integers,
    split_rows,
    write_batches,
    write_reference,
)

if TYPE_CHECKING:
    from pathlib import Path

    from ...base.arrays import Int64Array
    from ...base.progress import Tell
    from ...tin import TIN

_KEYWORD = re.compile(r"(ST)?(C)?(N)?(4)?(n)?OFF")


class _Counts(NamedTuple):
    vertices: int
    faces: int


@mesh_reader
def read(path: Path) -> Mesh:
    """Read the vertices and faces of an OFF file in text.

    CRS and unit default to those in the comments ``# crs: ...`` and ``# elevation unit: ...``.
    Polygons are cut into triangles; normals, colours and texture (NOFF, COFF, STOFF) are skipped. A
    file without faces gives a survey.
    """
    content = common.read_content(path)
    rows = _skip_keyword(split_rows(content))
    if not rows.texts:
        raise ReadError(f"{FILE} ends before the numbers of its vertices and faces.")
    first = rows.texts[0].split()
    if len(first) < 2:
        raise rows.describe_fault(0, "the numbers of vertices and of faces are needed")
    counts = _Counts(*parse_integers(first[:2], rows.lines[0]))
    if min(counts) < 0:
        raise rows.describe_fault(0, "a count is negative")
    if sum(counts) > len(rows) - 1:
        promised = counted(counts.vertices, "vertex", "vertices")
        raise ReadError(
            f"{FILE} ends too early: it promises {promised} and "
            f"{counted(counts.faces, 'face')}, and has {counted(len(rows) - 1, 'row')} for them."
        )
    vertices, polygons = rows.cut(1, counts.vertices + 1), rows.cut(counts.vertices + 1)
    points = vertices.parse_floats(slice(0, 3), "a vertex needs x, y and z")
    crs, unit = find_reference(content)
    mesh = Mesh(points, crs=crs, elevation_unit=unit)
    if not counts.faces:
        return mesh
    corners, offsets = _parse_faces(polygons.cut(0, counts.faces))
    return replace(mesh, corners=corners, offsets=offsets)


def _skip_keyword(rows: TextRows) -> TextRows:
    """Return what stands behind the keyword, which some programs put before the counts."""
    first = rows.texts[0].split() if rows.texts else [""]
    keyword = first[0]
    found = _KEYWORD.fullmatch(keyword)
    if "BINARY" in first:
        raise ReadError(
            f"{FILE} is a binary OFF file, and only those in text are read: save it as that."
        )
    if found is None:
        raise ReadError(
            f"{FILE} is no OFF file in text: it must begin with 'OFF', not '{keyword[:20]}'."
        )
    if found[4] or found[5]:
        raise ReadError(
            f"{FILE} is an OFF file of {keyword}, vertices in more than three dimensions, which "
            "are no TIN."
        )
    if len(first) > 1:
        return TextRows([" ".join(first[1:]), *rows.texts[1:]], rows.lines)
    return rows.cut(1)


def _parse_faces(rows: TextRows) -> tuple[Int64Array, Int64Array]:
    too_short = "a face has fewer corners than it promises"
    if all(text.startswith(("3 ", "3\t")) for text in rows.texts):
        corners = rows.parse_integers(slice(1, 4), too_short)
        return corners.ravel(), np.arange(0, corners.size + 1, 3)
    found: list[int] = []
    offsets = [0]
    for number, (text, line) in enumerate(zip(rows.texts, rows.lines, strict=True)):
        row = text.split()
        count = parse_integers(row[:1], line, what="a face begins with its number of corners")
        if not 0 <= count[0] <= len(row) - 1:
            raise rows.describe_fault(number, too_short)
        found += parse_integers(row[1 : count[0] + 1], line)
        offsets.append(len(found))
    return np.array(found, np.int64), np.array(offsets, np.int64)


def write(surface: TIN, path: Path, *, progress: Tell | None = None) -> None:
    """Write a TIN as OFF; :func:`read` gives the same vertices and triangles back."""
    tin = common.require_tin(surface, format_name="OFF")
    with replacing(path, binary=False) as file:
        file.write("OFF\n")
        write_reference(file, tin)
        file.write(f"{len(tin.points)} {len(tin.triangles)} 0\n")
        faces = format_rows("3 %d %d %d\n", tin.triangles)
        write_batches(file, tin, chain(format_rows("%r %r %r\n", tin.points), faces), progress)
